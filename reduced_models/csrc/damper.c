/* Forces of a squeeze film damper; see damper.h. In a frame along the displacement, (r, t), the integrals run over angles theta of
 * the film, or over Sommerfeld's gamma: 1 - e cos theta = (1 - e^2)/(1 + e cos gamma). */
#include "damper.h"

#include <math.h>
#include <string.h>

static const double two_pi = 6.283185307179586;

/* Integrals of a weight over n n, its components rr, rt, tt, and of its derivative by u over n n n, rrr, rrt, rtt, ttt. */
typedef struct {
    double second[3], third[4];
} Moments;

/* An end of the film: its angle and Sommerfeld's. */
typedef struct {
    double c, s, H, cos, sin, gamma;
} End;

static End end_of(double e, double c, double s)
{
    End end;
    end.c = c;
    end.s = s;
    end.H = 1.0 - e * c;
    end.cos = (c - e) / end.H;
    end.sin = sqrt(1.0 - e * e) * s / end.H;
    end.gamma = atan2(end.sin, end.cos);
    return end;
}

/* Adds `sign` times the indefinite integrals with weight H^-3 at an end. */
static void add_open(double e, const End *end, double sign, Moments *m)
{
    const double b = 1.0 - e * e, root = sqrt(b), c = end->cos, s = end->sin, k = e + c;
    const double half = 0.5 * (end->gamma + s * c), other = 0.5 * (end->gamma - s * c); /* of cos^2, of sin^2 */
    m->second[0] += sign * (e * e * end->gamma + 2.0 * e * s + half) / (b * b * root);
    m->second[1] -= sign * 0.5 * k * k / (b * b);
    m->second[2] += sign * other / (b * root);
    m->third[0] += 3.0 * sign * (e * e * e * end->gamma + 3.0 * e * e * s + 3.0 * e * half + s - s * s * s / 3.0) / (b * b * b * root);
    m->third[1] -= sign * k * k * k / (b * b * b);
    m->third[2] += 3.0 * sign * (e * other + s * s * s / 3.0) / (b * b * root);
    m->third[3] += 3.0 * sign * (c * c * c / 3.0 - c) / (b * b);
}

/* The same with weight (H^-2 + H^-1)/2, whose derivative is H^-3 + H^-2/2. */
static void add_sealed(double e, const End *end, double sign, Moments *m)
{
    const double b = 1.0 - e * e, root = sqrt(b), c = end->c, s = end->s, H = end->H, gamma = end->gamma, k = c - e;
    m->second[0] += sign * (0.5 * gamma / (b * root) + 0.5 * s * (c * (1.0 + H) - k / b) / (H * H));
    m->second[1] -= sign * 0.5 * c * c / H;
    m->second[2] += sign * (0.5 * gamma / root - 0.5 * s * c / H);
    m->third[0] += sign
                   * (0.5 * s / (H * b * b) + 1.5 * e * gamma / (b * b * root) + c * c * s * (1.0 + 0.5 * H) / (H * H * H)
                      + 0.5 * s * (1.0 - 2.0 * e * k / b - 2.0 * c * k / H) / (b * H * H));
    m->third[1] -= sign * 0.5 * c * c * c / (H * H);
    m->third[2] += sign * (0.5 * s / (H * b) + 0.5 * e * gamma / (b * root) - 0.5 * c * c * s / (H * H));
    m->third[3] -= sign * 0.5 * c * (3.0 - 2.0 * e * c - c * c) / (H * H);
}

/* Over the half circle that (r, t) points to, or, with `whole`, the whole. Without a direction half of the whole, the mean of all
 * halves. */
static Moments moments(double e, double r, double t, int whole, void (*add)(double, const End *, double, Moments *))
{
    const double size = hypot(r, t);
    Moments m;
    End first, last;
    memset(&m, 0, sizeof m);
    if (whole || !(size > 0.0)) {
        first = last = end_of(e, 1.0, 0.0);
        last.gamma += whole ? two_pi : 0.5 * two_pi;
    } else {
        first = end_of(e, t / size, -r / size);
        last = end_of(e, -t / size, r / size);
        if (last.gamma < first.gamma) {
            last.gamma += two_pi;
        }
    }
    add(e, &last, 1.0, &m);
    add(e, &first, -1.0, &m);
    return m;
}

/* m times a vector; n times it, for its component r or t. */
static void by_second(const Moments *m, const double x[2], double y[2])
{
    y[0] = m->second[0] * x[0] + m->second[1] * x[1];
    y[1] = m->second[1] * x[0] + m->second[2] * x[1];
}

static void by_third(const Moments *m, int component, const double x[2], double y[2])
{
    const double *third = m->third + component;
    y[0] = third[0] * x[0] + third[1] * x[1];
    y[1] = third[1] * x[0] + third[2] * x[1];
}

double damper_eccentricity(const Damper *d, const double q[2])
{
    return hypot(q[0], q[1]) / d->clearance;
}

/* Turns a matrix of the frame along (c, s) into that of x and y. */
static void turn(double c, double s, const double m[4], double turned[4])
{
    const double a = c * m[0] - s * m[2], b = c * m[1] - s * m[3], f = s * m[0] + c * m[2], g = s * m[1] + c * m[3];
    turned[0] = a * c - b * s;
    turned[1] = a * s + b * c;
    turned[2] = f * c - g * s;
    turned[3] = f * s + g * c;
}

void damper_press(const Damper *d, const double q[2], const double v[2], double force[2], double stiffness[4], double damping[4])
{
    const double size = hypot(q[0], q[1]), far = size / d->clearance;
    const double c = size > 0.0 ? q[0] / size : 1.0, s = size > 0.0 ? q[1] / size : 0.0;
    const double rate[2] = {c * v[0] + s * v[1], c * v[1] - s * v[0]};
    const int held = far > 1.0 - THINNEST, whole = d->cavitates == 0.0;
    const double e = held ? 1.0 - THINNEST : far;
    double pushed[2] = {0.0, 0.0}, slopes[4] = {0.0, 0.0, 0.0, 0.0}, damped[4] = {0.0, 0.0, 0.0, 0.0}, part[2];
    int i, k;
    if (d->open > 0.0) {
        const Moments m = moments(e, rate[0], rate[1], whole, add_open);
        by_second(&m, rate, part);
        for (i = 0; i < 2; i++) {
            pushed[i] += d->open * part[i];
            for (k = 0; k < 2; k++) {
                damped[2 * i + k] += d->open * m.second[i + k];
            }
        }
        for (k = 0; k < 2; k++) {
            by_third(&m, k, rate, part);
            slopes[k] += d->open * part[0];
            slopes[2 + k] += d->open * part[1];
        }
    }
    if (d->sealed > 0.0) {
        const double n = 2.0 + e * e, share = 2.0 / n, g[2] = {rate[0], share * rate[1]};
        const double by_u[2][2] = {{0.0, -4.0 * e * rate[1] / (n * n)}, {e * rate[1] / n, e * rate[0] / n}}; /* of g */
        const Moments m = moments(e, g[0], g[1], whole, add_sealed);
        by_second(&m, g, part);
        for (i = 0; i < 2; i++) {
            pushed[i] += d->sealed * part[i];
            damped[2 * i] += d->sealed * m.second[i];
            damped[2 * i + 1] += d->sealed * share * m.second[i + 1];
        }
        for (k = 0; k < 2; k++) {
            double changed[2];
            by_third(&m, k, g, part);
            by_second(&m, by_u[k], changed);
            slopes[k] += d->sealed * (part[0] + changed[0]);
            slopes[2 + k] += d->sealed * (part[1] + changed[1]);
        }
    }
    for (i = 0; i < 2; i++) {
        slopes[2 * i] *= held ? 0.0 : 1.0 / d->clearance;
        slopes[2 * i + 1] *= held ? e / size : 1.0 / d->clearance;
    }
    turn(c, s, slopes, stiffness);
    turn(c, s, damped, damping);
    force[0] = c * pushed[0] - s * pushed[1] + d->stiffness * q[0];
    force[1] = s * pushed[0] + c * pushed[1] + d->stiffness * q[1];
    stiffness[0] += d->stiffness;
    stiffness[3] += d->stiffness;
}

void damper_forces(const Damper *d, size_t count, const double q[], const double v[], double force[], double stiffness[],
                   double damping[])
{
    size_t k;
    for (k = 0; k < count; k++) {
        damper_press(d, q + 2 * k, v + 2 * k, force + 2 * k, stiffness + 4 * k, damping + 4 * k);
    }
}
