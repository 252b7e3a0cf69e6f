/* What an FMU can tell of its master; see master.h.
 *
 * A master sets place x and rate v of step n and gets the force F[n]. A mass that holds its forces over a step has
 *
 *     m (v[n+1] - v[n])/h = P[n] + F[n - d],    (x[n+1] - x[n])/h = (v[n] + v[n+1])/2 + s (v[n+1] - v[n])/2
 *
 * with d = 0 where the mass steps after the FMU has its new motion (serial), 1 where both step at once (parallel), 1/2 and 3/2
 * where a mean of two forces acts, -1/2 with the rates that velocity Verlet expects; s = 0 where the mass goes through its step
 * exactly, 1 with symplectic Euler. The force does the right work with lead = d + (1 - s)/2. P, all other forces, is not known:
 * those that are constant vanish in differences, and so do those with a harmonic part, of any frequency w, where the second
 * difference of these is added to e = 2 - 2 cos(w h) times themselves. The delay with which F then explains the changes of v to
 * rounding is that of the master; where no delay does so alone, none is told. */
#include "master.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#ifndef LEAD_OF_INPUTS

static const int rate_of[N_INPUTS] = INPUT_RATES;
static const double delays[DELAYS] = {-0.5, 0.0, 0.5, 1.0, 1.5};

enum {
    FILLING = 6,      /* steps until all differences are there */
    SMALLEST = 64,    /* steps of the first window; each has twice as many as the one before */
    LARGEST = 512,    /* of a window; then the smallest again */
    WINDOWS = 2,      /* that agree on a delay */
    SKEW_WINDOWS = 4, /* that agree on a skew alone */
    REPEATS = 8       /* of 32 steps that were made again with other inputs */
};

static const double skew_error = 0.05;  /* of a skew */
static const double skew_noise = 0.15;  /* what is missed beside it, in changes of the rate: w h/2 with velocity Verlet */
static const double lead_error = 0.2;   /* of a lead, that goes unmentioned */
static const double separation = 300.0; /* what the best delay leaves unexplained is smaller than with any other by this factor */
static const double unexplained = 0.01; /* of the changes of the rate, at most */
static const double alike = 0.01;       /* inertias of two windows */
static const double rounding = 1e-15;   /* of squares */

static double product_at(Product p, double e)
{
    return p.one + e * (p.e + e * p.ee);
}

static void add_product(Product *p, double bend_a, double a, double bend_b, double b)
{
    p->one += bend_a * bend_b;
    p->e += bend_a * b + a * bend_b;
    p->ee += a * b;
}

static void clear_window(Master *m)
{
    int k;
    for (k = 0; k < N_INPUTS; k++) {
        Course *c = &m->course[k];
        memset(&c->squares, 0, sizeof c->squares);
        memset(c->products, 0, sizeof c->products);
        memset(c->drives_squared, 0, sizeof c->drives_squared);
        c->shares = c->change_squares = c->missed_squares = 0.0;
    }
    m->unclear = 0;
}

/* ---- a step ---- */

static void add_step(Course *c, double place, double rate, double force, double h, int summed)
{
    const double change = rate - c->rate, missed = (place - c->place) / h - 0.5 * (rate + c->rate);
    const double difference = change - c->change, bend = difference - 2.0 * c->changes[0] + c->changes[1];
    const double acting[DELAYS] = {1.5 * c->force[0] - 0.5 * c->force[1], c->force[0], 0.5 * (c->force[0] + c->force[1]), c->force[1],
                                   0.5 * (c->force[1] + c->force[2])};
    int d;
    if (summed) {
        c->shares += missed * 0.5 * change;
        c->change_squares += 0.25 * change * change;
        c->missed_squares += missed * missed;
        add_product(&c->squares, bend, c->changes[0], bend, c->changes[0]);
    }
    for (d = 0; d < DELAYS; d++) {
        double *drive = c->drives[d];
        const double now = acting[d] - c->acting[d], turn = now - 2.0 * drive[0] + drive[1];
        if (summed) {
            add_product(&c->products[d], bend, c->changes[0], turn, drive[0]);
            add_product(&c->drives_squared[d], turn, drive[0], turn, drive[0]);
        }
        drive[1] = drive[0];
        drive[0] = now;
        c->acting[d] = acting[d];
    }
    c->changes[1] = c->changes[0];
    c->changes[0] = difference;
    c->change = change;
    c->rate = rate;
    c->place = place;
    c->force[2] = c->force[1];
    c->force[1] = c->force[0];
    c->force[0] = force;
}

/* ---- the end of a window ---- */

typedef struct {
    double left, inertia; /* share of the changes of the rate that is not explained; change of the rate by a force */
} Fit;

static Fit fit_at(const Course *c, int d, double e)
{
    const double ff = product_at(c->drives_squared[d], e), zf = product_at(c->products[d], e);
    const double left = product_at(c->squares, e) - (ff > 0.0 ? zf * zf / ff : 0.0);
    Fit fit;
    fit.inertia = ff > 0.0 ? zf / ff : 0.0;
    fit.left = c->squares.one > 0.0 && left > rounding * c->squares.one ? left / c->squares.one : rounding;
    return fit;
}

/* With other forces that are constant. */
static Fit fit_constant(const Course *c, int d)
{
    const double ff = c->drives_squared[d].ee, zf = c->products[d].ee, zz = c->squares.ee;
    const double left = zz - (ff > 0.0 ? zf * zf / ff : 0.0);
    Fit fit;
    fit.inertia = ff > 0.0 ? zf / ff : 0.0;
    fit.left = zz > 0.0 && left > rounding * zz ? left / zz : rounding;
    return fit;
}

/* With other forces that grow or fall straight, or along a parabola. */
static Fit fit_smooth(const Course *c, int d)
{
    return fit_at(c, d, 0.0);
}

/* With a harmonic part of them: the best e, on a grid and between its neighbours by the golden section. */
static Fit fit_harmonic(const Course *c, int d)
{
    enum { POINTS = 81, CUTS = 40 };
    static const double step = 1.122018454301963, golden = 0.6180339887498949; /* 10^(1/20) */
    const double scale = c->squares.ee > 0.0 ? sqrt(c->squares.one / c->squares.ee) : 0.0;
    double e = 1e-3 * scale, best = e, low, high, least = 2.0;
    int i;
    for (i = 0; i < POINTS; i++, e *= step) {
        const double left = fit_at(c, d, e).left;
        if (left < least) {
            least = left;
            best = e;
        }
    }
    low = best / step;
    high = best * step;
    for (i = 0; i < CUTS; i++) {
        const double below = high - golden * (high - low), above = low + golden * (high - low);
        if (fit_at(c, d, below).left < fit_at(c, d, above).left) {
            high = above;
        } else {
            low = below;
        }
    }
    return fit_at(c, d, 0.5 * (low + high));
}

/* The delay that alone explains the changes of the rate, and the inertia with it; -1 for none. */
static int only_delay(const Course *c, Fit (*fit)(const Course *c, int d), double sign, double *inertia)
{
    const double allowed = unexplained * unexplained;
    double least = 2.0, next = 2.0;
    int d, found = -1;
    for (d = 0; d < DELAYS; d++) {
        const Fit f = fit(c, d);
        if (f.left < least) {
            next = least;
            least = f.left;
            found = d;
            *inertia = sign * f.inertia;
        } else if (f.left < next) {
            next = f.left;
        }
    }
    return least < allowed && next > separation * separation * least && *inertia > 0.0 ? found : -1;
}

static void judge_delay(Course *c, double sign)
{
    double inertia = 0.0;
    int d = only_delay(c, fit_constant, sign, &inertia);
    d = d < 0 ? only_delay(c, fit_smooth, sign, &inertia) : d;
    d = d < 0 ? only_delay(c, fit_harmonic, sign, &inertia) : d;
    if (d < 0) {
        return;
    }
    c->agreed = c->agreed > 0 && d == c->delay && fabs(inertia - c->inertia) < alike * inertia ? c->agreed + 1 : 1;
    c->delay = d;
    c->inertia = inertia;
}

/* How the displacement goes on; returns whether that is clear. */
static int judge_skew(Course *c)
{
    const double bb = c->change_squares, skew = bb > 0.0 ? c->shares / bb : 0.0;
    const double left = c->missed_squares - skew * c->shares;
    if (!(bb > 0.0 && left < skew_noise * skew_noise * bb)) {
        return 0;
    }
    c->skewed = fabs(skew - c->skew) < skew_error ? c->skewed + 1 : 1;
    c->agreed = c->skewed > 1 ? c->agreed : 0;
    c->skew = skew;
    return 1;
}

/* ---- words ---- */

static const char *say(Master *m, char *text, size_t size, const char *what, const char *right, double set)
{
    m->told = 1;
    snprintf(text, size, "%s: " LEAD_NAME " must be %s, with %g the damping is wrong", what, right, set);
    return text;
}

static const char *mass_of(double skew)
{
    return fabs(skew - 1.0) < 2.0 * skew_error   ? "its mass goes on by symplectic Euler"
           : fabs(skew + 1.0) < 2.0 * skew_error ? "its mass goes on by explicit Euler"
           : fabs(skew) < 2.0 * skew_error       ? "its mass holds the force"
                                                 : "its rates are those of other times";
}

static const char *warn_of_course(Master *m, const Course *c, double lead, char *text, size_t size)
{
    static const char *const order[DELAYS] = {"serial and looks half a step ahead", "serial", "serial and takes the mean of two forces", "parallel",
                                              "parallel and takes the mean of two forces"};
    const double late = 0.5 * (1.0 - c->skew);
    char what[120], right[80];
    if (c->agreed >= WINDOWS) {
        const double wanted = delays[c->delay] + late;
        if (fabs(wanted - lead) > lead_error && wanted > -lead_error && wanted < MOST_LEAD + lead_error) {
            snprintf(what, sizeof what, "this master is %s, %s", order[c->delay], mass_of(c->skew));
            snprintf(right, sizeof right, "%g", fabs(floor(20.0 * wanted + 0.5) / 20.0));
            return say(m, text, size, what, right, lead);
        }
    } else if (c->skewed >= SKEW_WINDOWS && fabs(fabs(c->skew) - 1.0) < 2.0 * skew_error
               && (lead < late - lead_error || lead > late + 1.0 + lead_error)) {
        snprintf(what, sizeof what, "of this master %s", mass_of(c->skew));
        snprintf(right, sizeof right, "%g if it is parallel, %g if it is serial", floor(late + 1.5), floor(late + 0.5));
        return say(m, text, size, what, right, lead);
    }
    return NULL;
}

/* ---- the interface ---- */

static int differ(const Master *m, const State *s)
{
    int k;
    for (k = 0; k < N_INPUTS; k++) {
        if (rate_of[k] >= 0 && (m->inputs[k] != s->given[0][k] || m->inputs[rate_of[k]] != s->given[0][rate_of[k]])) {
            return 1;
        }
    }
    return 0;
}

const char *master_warning(Master *m, const State *s, char *text, size_t size)
{
    static const double same = 1e-6; /* of a step: equal ones, as masters add them up */
    const double start = s->given_time[0], h = s->time - start, lead = s->model.value[VR_LEAD];
    const int equal = fabs(h - m->length) < same * h, again = equal && fabs(start - m->start) < same * h;
    const int summed = equal && !again && m->steps >= FILLING;
    const char *warning = NULL;
    int k, ends;
    if (m->told) {
        return NULL;
    }
    m->repeats = m->repeats << 1 | (again && differ(m, s) ? 1ULL : 0ULL);
    if (lead > lead_error && count_bits(m->repeats & 0xffffffffULL) >= REPEATS) {
        return say(m, text, size, "this master makes steps again with other inputs", "0", lead);
    }
    if (!equal || again || m->steps == 0) {
        m->steps = 0;
        m->size = SMALLEST;
        clear_window(m);
    }
    m->unclear |= s->read_early & 2;
    m->start = start;
    m->length = h;
    memcpy(m->inputs, s->given[0], sizeof m->inputs);
    m->steps++;
    ends = m->steps >= FILLING + m->size;
    for (k = 0; k < N_INPUTS; k++) {
        Course *c = &m->course[k];
        if (force_on[k] < 0) {
            continue;
        }
        add_step(c, s->given[0][k], s->given[0][rate_of[k]], s->model.value[force_on[k]], h, summed);
        if (ends && !m->unclear) {
            if (judge_skew(c)) {
                judge_delay(c, FORCE_SIGN);
            }
            if (warning == NULL) {
                warning = warn_of_course(m, c, lead, text, size);
            }
        }
    }
    if (ends) {
        m->steps = FILLING;
        m->size = m->size < LARGEST ? 2 * m->size : SMALLEST;
        clear_window(m);
    }
    return warning;
}

#else

const char *master_warning(Master *m, const State *s, char *text, size_t size)
{
    (void)m, (void)s, (void)text, (void)size;
    return NULL;
}

#endif

void master_goes_back(Master *m)
{
    m->steps = 0;
}

void master_is_unclear(Master *m)
{
    m->unclear = 1;
}
