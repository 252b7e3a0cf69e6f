/* Contact elements with a film memory, of reduced_models.elements.film_contact: the film law of film_law.c in the
 * units of the FMU. The states are those of continuous time: inlet, fast part, chain. Equations in README.md. */
#include <math.h>
#include <string.h>

#include "film_law.h"
#include "film_tables.h"
#include "validity.h"

enum { FILM_RATES = DIRECT - 1 + LAGS, FILM_SIZE = INLET + FILM_RATES }; /* states of film_rates and of film_step */

static const FilmLaw own_film = {CURVE_NODES, GAIN_ROWS, LAGS, film_x, film_y, film_slope, film_u, film_gain_x, film_gains,
                                 LAG_RATE, INLET_RATE, FAST_RATE, INLET_SATURATION, RIM};

/* Entries of the cache: the static curve where it was last asked for. */
enum { KNOWN, REST_U, REST_X, REST_G, REST_G_U };

enum { MOST_PARTS = 64 };         /* of a step */
static const double smooth = 0.02; /* change of theta, and of phi's slope, within a step that needs no check */

static const Fault fine = {FINE, NULL};

/* ---- units ---- */

static double own_approach(double approach)
{
    return approach / SCALE_LENGTH;
}

static double own_rate(double rate)
{
    return rate / SCALE_LENGTH * SCALE_TIME;
}

static const double stiffness_unit = SCALE_FORCE / SCALE_LENGTH;
static const double damping_unit = SCALE_FORCE / SCALE_LENGTH * SCALE_TIME;

/* ---- static curve, kept where it was evaluated last ---- */

/* Where it was last asked for; 0 if it never was. */
static int known(const Model *m, Rest *rest)
{
    rest->u = m->cache[REST_U];
    rest->x = m->cache[REST_X];
    rest->g = m->cache[REST_G];
    rest->g_u = m->cache[REST_G_U];
    return m->cache[KNOWN] > 0.0;
}

static void rest_at(const Model *m, double u, Rest *rest)
{
    if (!known(m, rest)) {
        film_static(&own_film, u, NULL, rest);
    } else if (rest->u != u) {
        film_static(&own_film, u, rest, rest);
    }
}

static void keep_rest(Model *m, const Rest *rest)
{
    m->cache[KNOWN] = 1.0;
    m->cache[REST_U] = rest->u;
    m->cache[REST_X] = rest->x;
    m->cache[REST_G] = rest->g;
    m->cache[REST_G_U] = rest->g_u;
}

/* ---- outputs ---- */

/* What the core's variables have of force and tangents, in the units of the FMU; 0 if something is not finite. */
static int is_finite(const FilmForce *found)
{
    return isfinite(found->argument) && isfinite(found->force * SCALE_FORCE)
           && isfinite(found->stiffness * stiffness_unit) && isfinite(found->damping * damping_unit);
}

static void show(Model *m, double approach, double rate, const Rest *rest, const FilmForce *now,
                 const FilmForce *step)
{
    m->input[VR_approach] = approach;
    m->input[VR_rate] = rate;
    m->indicator[0] = now->argument;
    m->value[VR_force] = now->force * SCALE_FORCE;
    m->value[VR_stiffness] = now->stiffness * stiffness_unit;
    m->value[VR_damping] = now->damping * damping_unit;
    m->value[VR_step_stiffness] = step->stiffness * stiffness_unit;
    m->value[VR_step_damping] = step->damping * damping_unit;
    keep_rest(m, rest);
    model_watch(m);
}

static const char too_large[] = "the force is too large for a floating-point number";

Fault model_prepare(Model *m)
{
    (void)m; /* all coefficients are constants, which were checked at export */
    return fine;
}

Fault model_evaluate(Model *m)
{
    Rest rest;
    FilmForce now;
    int k;
    rest_at(m, own_approach(m->input[VR_approach]), &rest);
    now = film_now(&own_film, &m->value[FIRST_STATE], &rest, own_rate(m->input[VR_rate]));
    for (k = 0; k < FILM_RATES; k++) {
        if (!isfinite(m->value[FIRST_STATE + k])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    if (!is_finite(&now)) {
        return fault(DISCARD, too_large);
    }
    show(m, m->input[VR_approach], m->input[VR_rate], &rest, &now, &now);
    return fine;
}

Fault model_rates(Model *m)
{
    double rates[FILM_RATES];
    Rest rest;
    int k;
    rest_at(m, own_approach(m->input[VR_approach]), &rest);
    film_rates(&own_film, &m->value[FIRST_STATE], &rest, own_rate(m->input[VR_rate]), rates);
    for (k = 0; k < FILM_RATES; k++) {
        if (!isfinite(rates[k] / SCALE_TIME)) {
            return fault(DISCARD, "a derivative of the film's states is too large for a floating-point number");
        }
    }
    for (k = 0; k < FILM_RATES; k++) {
        m->value[FIRST_DERIVATIVE + k] = rates[k] / SCALE_TIME;
    }
    return fine;
}

/* ---- steps ---- */

/* The state of film_step at the start of a step or of a part of one. */
static void begin(double state[FILM_SIZE], const Rest *rest, double v)
{
    state[THETA] = sqrt(rest->g);
    state[RATE] = state[THETA] * v;
    state[APPROACH] = rest->u;
}

/* Goes through a step in equal parts, from `first` to `last`, whose rest goes to `rest`; 0 if the approach is too large. */
static int walk(const Motion *motion, double h, int parts, double first[FILM_SIZE], double last[FILM_SIZE],
                 Rest *rest, FilmStep *found)
{
    const Path *approach = &motion->input[VR_approach], *rate = &motion->input[VR_rate];
    const double part = h / parts;
    double other[FILM_SIZE];
    double *from = first, *to = parts % 2 == 1 ? last : other;
    int i;
    for (i = 1; i <= parts; i++) {
        const double t = i * part;
        double u = approach->end, v = rate->end;
        if (i < parts && motion->known) {
            u = approach->start + t * (approach->slope + 0.5 * t * approach->bend);
            v = rate->start + t * rate->slope;
        }
        if (own_approach(u) != rest->u) {
            film_static(&own_film, own_approach(u), rest, rest);
        }
        if (!isfinite(rest->g)) {
            return 0;
        }
        film_step(&own_film, from, to, part / SCALE_TIME, rest, own_rate(v), found);
        from = to;
        to = to == last ? other : last;
    }
    return 1;
}

/* How far a step is from one in which every filter is advanced exactly: theta and the slope of phi would be constant. */
static double unevenness(const double before[FILM_SIZE], const double after[FILM_SIZE])
{
    const double ratio = fabs(after[THETA] / before[THETA] - 1.0);
    const double bend = INLET_SATURATION * fabs(after[INLET] - before[INLET]);
    return ratio > bend ? ratio : bend;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    double first[FILM_SIZE], state[FILM_SIZE];
    Rest start, rest;
    FilmStep found;
    int parts, k;
    if (!(h / SCALE_TIME >= SHORTEST_STEP)) {
        return fault(REFUSE, "the step size is too small for the film");
    }
    rest_at(m, own_approach(motion->input[VR_approach].start), &start);
    if (!isfinite(start.g)) {
        return fault(DISCARD, too_large);
    }
    begin(first, &start, own_rate(motion->input[VR_rate].start));
    memcpy(&first[INLET], &m->value[FIRST_STATE], FILM_RATES * sizeof first[0]);
    if (!known(m, &rest)) { /* else both ends are sought from there, which a processor does at once */
        rest = start;
    }
    if (!walk(motion, h, 1, first, state, &rest, &found)) {
        return fault(DISCARD, too_large);
    }
    if (motion->known && unevenness(first, state) > smooth) {
        for (parts = 2; parts <= MOST_PARTS; parts *= 2) {
            const double coarse = found.step.argument;
            double scale;
            rest = start;
            if (!walk(motion, h, parts, first, state, &rest, &found)) {
                return fault(DISCARD, too_large);
            }
            scale = fabs(found.step.argument) > rest.g ? fabs(found.step.argument) : rest.g;
            if (fabs(found.step.argument - coarse) <= tolerance * scale) {
                break;
            }
        }
    }
    for (k = 0; k < FILM_SIZE; k++) {
        if (!isfinite(state[k])) {
            return fault(DISCARD, too_large);
        }
    }
    if (!is_finite(&found.step) || !is_finite(&found.now)) {
        return fault(DISCARD, too_large);
    }
    memcpy(&m->value[FIRST_STATE], &state[INLET], FILM_RATES * sizeof state[0]);
    show(m, motion->input[VR_approach].end, motion->input[VR_rate].end, &rest, &found.now, &found.step);
    return fine;
}

/* ---- derivatives ---- */

void model_direction(const Model *m, const double seed[], double along[])
{
    const double du = own_approach(seed[VR_approach]), dv = own_rate(seed[VR_rate]);
    const double *states = &m->value[FIRST_STATE], *ds = &seed[FIRST_STATE];
    double change[FILM_RATES], force, stiffness, damping;
    FilmInstant now;
    Rest rest;
    int k;
    rest_at(m, own_approach(m->input[VR_approach]), &rest);
    film_instant(&own_film, states, &rest, own_rate(m->input[VR_rate]), &now);
    force = now.by[0] * du + now.by[1] * dv;
    stiffness = now.second[0][0] * du + now.second[0][1] * dv;
    damping = now.second[1][0] * du + now.second[1][1] * dv;
    for (k = 0; k < FILM_RATES; k++) {
        force += now.by_state[k] * ds[k];
        stiffness += now.second_state[0][k] * ds[k];
        damping += now.second_state[1][k] * ds[k];
    }
    along[VR_force] = force * SCALE_FORCE;
    along[VR_stiffness] = stiffness * stiffness_unit;
    along[VR_damping] = damping * damping_unit;
    film_rates_along(&own_film, states, &rest, own_rate(m->input[VR_rate]), du, dv, ds, change);
    for (k = 0; k < FILM_RATES; k++) {
        along[FIRST_DERIVATIVE + k] = change[k] / SCALE_TIME;
    }
}
