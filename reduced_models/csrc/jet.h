/* Values with two partial derivatives, by approach u and rate v at the end of a step: reduced_models.elements.jet. */
#ifndef JET_H
#define JET_H

#include <math.h>

typedef struct {
    double x, u, v;
} Jet;

static inline Jet jet(double x, double u, double v)
{
    Jet r;
    r.x = x;
    r.u = u;
    r.v = v;
    return r;
}

static inline Jet plus(Jet a, Jet b)
{
    return jet(a.x + b.x, a.u + b.u, a.v + b.v);
}

static inline Jet minus(Jet a, Jet b)
{
    return jet(a.x - b.x, a.u - b.u, a.v - b.v);
}

/* Mean of a number and a jet. */
static inline Jet half(double c, Jet a)
{
    return jet(0.5 * (c + a.x), 0.5 * a.u, 0.5 * a.v);
}

static inline Jet times(Jet a, Jet b)
{
    return jet(a.x * b.x, a.u * b.x + a.x * b.u, a.v * b.x + a.x * b.v);
}

static inline Jet over(Jet a, Jet b)
{
    const double x = a.x / b.x;
    return jet(x, (a.u - x * b.u) / b.x, (a.v - x * b.v) / b.x);
}

/* Square root of a jet > 0. */
static inline Jet root(Jet a)
{
    const double x = sqrt(a.x);
    return jet(x, 0.5 * a.u / x, 0.5 * a.v / x);
}

/* A value that depends on one jet, with slope `by`; on three, with its slope along each. */
static inline Jet through(double x, double by, Jet a)
{
    return jet(x, by * a.u, by * a.v);
}

static inline Jet through3(double x, double by_a, Jet a, double by_b, Jet b, double by_c, Jet c)
{
    return jet(x, by_a * a.u + by_b * b.u + by_c * c.u, by_a * a.v + by_b * b.v + by_c * c.v);
}

#endif
