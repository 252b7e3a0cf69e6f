/* Numbers with their derivative along one direction, so that every formula is said once. */
#ifndef DUAL_H
#define DUAL_H

#include <math.h>

typedef struct {
    double x, d;
} Dual;

static inline Dual dual(double x, double d)
{
    Dual r;
    r.x = x;
    r.d = d;
    return r;
}

static inline Dual number(double x)
{
    return dual(x, 0.0);
}

static inline Dual add(Dual a, Dual b)
{
    return dual(a.x + b.x, a.d + b.d);
}

static inline Dual sub(Dual a, Dual b)
{
    return dual(a.x - b.x, a.d - b.d);
}

static inline Dual mul(Dual a, Dual b)
{
    return dual(a.x * b.x, a.d * b.x + a.x * b.d);
}

static inline Dual over(Dual a, Dual b)
{
    const double x = a.x / b.x;
    return dual(x, (a.d - x * b.d) / b.x);
}

static inline Dual times(double c, Dual a)
{
    return dual(c * a.x, c * a.d);
}

static inline Dual plus(Dual a, double c)
{
    return dual(a.x + c, a.d);
}

/* Of a number > 0. */
static inline Dual root(Dual a)
{
    const double x = sqrt(a.x);
    return dual(x, 0.5 * a.d / x);
}

/* a^n of a number > 0. */
static inline Dual power(Dual a, Dual n)
{
    const double x = pow(a.x, n.x);
    return dual(x, x * (n.x * a.d / a.x + (n.d != 0.0 ? n.d * log(a.x) : 0.0)));
}

static inline Dual logarithm(Dual a)
{
    return dual(log(a.x), a.d / a.x);
}

/* A value that depends on one number, with slope `by`. */
static inline Dual chained(double x, double by, Dual a)
{
    return dual(x, by * a.d);
}

static inline Dual level(Dual a)
{
    const double t = tanh(a.x);
    return dual(t, (1.0 - t * t) * a.d);
}

#endif
