/* Contact elements with a film memory, of reduced_models.elements.film_contact: the film law of film_law.c in the
 * units of the FMU. The states are those of continuous time: inlet, fast part, chain. Equations in README.md. */
#include <math.h>
#include <string.h>

#include "film_law.h"
#include "validity.h"
#include "film_tables.h"

enum { FILM_RATES = DIRECT - 1 + LAGS, FILM_SIZE = INLET + FILM_RATES }; /* states of film_rates and of film_step */

/* Entries of the cache: the static curve where it was last asked for. With a speed as an input, which is for co-simulation alone, then
 * the states of the film, and its speeds. */
enum { KNOWN, REST_U, REST_X, REST_G, REST_G_U, FILM_STATES, STARTED = FILM_STATES + FILM_RATES, HISTORY };

#if SPEEDS > 0
#define SPEED_OF(input) ((input)[VR_u_sum])
#define SPEED_AT_START(motion) ((motion)->input[VR_u_sum].start)
#define SPEED_BEFORE(present) ((present)->history.speed)

/* The law of the present film, its unit of time, and the history of the speed that it follows from. */
typedef struct {
    FilmLaw law;
    double time, room[LAW_ROOM(CURVE_NODES, GAIN_ROWS, LAGS)];
    SpeedHistory history;
} Present;

static const FilmSpeeds range = {SPEEDS, film_speeds, film_laws};

static double *states_of(Model *m)
{
    return &m->cache[FILM_STATES];
}

/* Before the first step surfaces have always been at the speed of the inputs. */
static void present_of(const Model *m, double speed, Present *p)
{
    if (m->cache[STARTED] > 0.0) {
        memcpy(&p->history, &m->cache[HISTORY], sizeof p->history);
    } else {
        p->history = speed_constant(&range, speed / SCALE_SPEED);
    }
    p->law = speed_law(&range, &p->history, p->room);
    p->time = SCALE_TIME / p->history.pace;
}

/* Begins a part of a step, h long, whose end is a share of the whole; returns its length in own time. */
static double begin_part(const Motion *motion, double h, double from, double share, double state[], Present *p)
{
    const double speed = from + share * (motion->input[VR_u_sum].end / SCALE_SPEED - from);
    double own;
    p->law = speed_begin(&range, speed, h / SCALE_TIME, state, &p->history, p->room, &own);
    p->time = SCALE_TIME / p->history.pace;
    return own;
}

static void keep_speed(Model *m, const Motion *motion, const Present *p)
{
    m->cache[STARTED] = 1.0;
    memcpy(&m->cache[HISTORY], &p->history, sizeof p->history);
    m->input[VR_u_sum] = motion->input[VR_u_sum].end;
}
#else
#define SPEED_OF(input) 0.0
#define SPEED_AT_START(motion) 0.0
#define SPEED_BEFORE(present) 0.0

typedef struct {
    FilmLaw law;
    double time;
} Present;

static const FilmLaw own_film = {CURVE_NODES, GAIN_ROWS, LAGS, film_x, film_y, film_slope, film_u, film_gain_x, film_gains,
                                 LAG_RATE, INLET_RATE, FAST_RATE, INLET_SATURATION, RIM};

static double *states_of(Model *m)
{
    return &m->value[FIRST_STATE];
}

static void present_of(const Model *m, double speed, Present *p)
{
    (void)m;
    (void)speed;
    p->law = own_film;
    p->time = SCALE_TIME;
}

static double begin_part(const Motion *motion, double h, double from, double share, double state[], Present *p)
{
    (void)motion;
    (void)from;
    (void)share;
    (void)state;
    return h / p->time;
}
#endif

enum { MOST_PARTS = 64 };         /* of a step */
static const double smooth = 0.02; /* change of theta, and of phi's slope, within a step that needs no check */

static const Fault fine = {FINE, NULL};

/* ---- units ---- */

static double own_approach(double approach)
{
    return approach / SCALE_LENGTH;
}

static double own_rate(double rate, double time)
{
    return rate / SCALE_LENGTH * time;
}

static const double stiffness_unit = SCALE_FORCE / SCALE_LENGTH;

static double damping_unit(double time)
{
    return SCALE_FORCE / SCALE_LENGTH * time;
}

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

static void rest_at(const Model *m, const FilmLaw *law, double u, Rest *rest)
{
    if (SPEEDS > 0 || !known(m, rest)) { /* of another law */
        film_static(law, u, NULL, rest);
    } else if (rest->u != u) {
        film_static(law, u, rest, rest);
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
static int is_finite(const FilmForce *found, double time)
{
    return isfinite(found->argument) && isfinite(found->force * SCALE_FORCE)
           && isfinite(found->stiffness * stiffness_unit) && isfinite(found->damping * damping_unit(time));
}

static void show(Model *m, double approach, double rate, double time, const Rest *rest, const FilmForce *now,
                 const FilmForce *step)
{
    m->input[VR_approach] = approach;
    m->input[VR_rate] = rate;
    m->indicator[0] = now->argument;
    m->value[VR_force] = now->force * SCALE_FORCE;
    m->value[VR_stiffness] = now->stiffness * stiffness_unit;
    m->value[VR_damping] = now->damping * damping_unit(time);
    m->value[VR_step_stiffness] = step->stiffness * stiffness_unit;
    m->value[VR_step_damping] = step->damping * damping_unit(time);
    keep_rest(m, rest);
    model_watch(m);
}

static const char too_large[] = "the force is too large for a floating-point number";

Fault model_prepare(Model *m)
{
    (void)m; /* all coefficients are constants, which were checked at export */
#if SPEEDS > 0
    if (HISTORY + sizeof(SpeedHistory) / sizeof(double) != N_CACHE) {
        return fault(REFUSE, "this FMU is damaged");
    }
#endif
    return fine;
}

/* With a speed as an input, that of the end of the next step: until then the film is as it was. */
Fault model_evaluate(Model *m)
{
    const double *states = states_of(m);
    Present p;
    Rest rest;
    FilmForce now;
    int k;
    present_of(m, SPEED_OF(m->input), &p);
    rest_at(m, &p.law, own_approach(m->input[VR_approach]), &rest);
    now = film_now(&p.law, states, &rest, own_rate(m->input[VR_rate], p.time));
    for (k = 0; k < FILM_RATES; k++) {
        if (!isfinite(states[k])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    if (!is_finite(&now, p.time)) {
        return fault(DISCARD, too_large);
    }
    show(m, m->input[VR_approach], m->input[VR_rate], p.time, &rest, &now, &now);
    return fine;
}

#if SPEEDS == 0
Fault model_rates(Model *m)
{
    double rates[FILM_RATES];
    Rest rest;
    int k;
    rest_at(m, &own_film, own_approach(m->input[VR_approach]), &rest);
    film_rates(&own_film, &m->value[FIRST_STATE], &rest, own_rate(m->input[VR_rate], SCALE_TIME), rates);
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
#else
Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}
#endif

/* ---- steps ---- */

/* The state of film_step at the start of a step or of a part of one. */
static void begin(double state[FILM_SIZE], const Rest *rest, double v)
{
    state[THETA] = sqrt(rest->g);
    state[RATE] = state[THETA] * v;
    state[APPROACH] = rest->u;
}

/* Goes through a step in equal parts, from `first` to `last`, whose rest goes to `rest`; 0 if the approach is too large. */
static int walk(const Motion *motion, double h, int parts, const double first[FILM_SIZE], double last[FILM_SIZE], Present *p,
                Rest *rest, FilmStep *found)
{
    const Path *approach = &motion->input[VR_approach], *rate = &motion->input[VR_rate];
    const double part = h / parts, speed = SPEED_BEFORE(p);
    double from[FILM_SIZE];
    int i;
    memcpy(last, first, FILM_SIZE * sizeof last[0]);
    for (i = 1; i <= parts; i++) {
        const double t = i * part;
        double u = approach->end, v = rate->end, own;
        if (i < parts && motion->known) {
            u = approach->start + t * (approach->slope + 0.5 * t * approach->bend);
            v = rate->start + t * rate->slope;
        }
        memcpy(from, last, sizeof from);
        own = begin_part(motion, part, speed, (double)i / parts, from, p);
        if (SPEEDS > 0) {
            film_static(&p->law, own_approach(u), NULL, rest);
        } else if (own_approach(u) != rest->u) {
            film_static(&p->law, own_approach(u), rest, rest);
        }
        if (!isfinite(rest->g)) {
            return 0;
        }
        film_step(&p->law, from, last, own, rest, own_rate(v, p->time), found);
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
    Present before, p;
    Rest start, rest;
    FilmStep found;
    int parts, k;
    present_of(m, SPEED_AT_START(motion), &before);
    if (!(h / before.time >= SHORTEST_STEP)) {
        return fault(REFUSE, "the step size is too small for the film");
    }
    rest_at(m, &before.law, own_approach(motion->input[VR_approach].start), &start);
    if (!isfinite(start.g)) {
        return fault(DISCARD, too_large);
    }
    begin(first, &start, own_rate(motion->input[VR_rate].start, before.time));
    memcpy(&first[INLET], states_of(m), FILM_RATES * sizeof first[0]);
    if (!known(m, &rest)) { /* else both ends are sought from there, which a processor does at once */
        rest = start;
    }
    p = before;
    if (!walk(motion, h, 1, first, state, &p, &rest, &found)) {
        return fault(DISCARD, too_large);
    }
    if (motion->known && unevenness(first, state) > smooth) {
        for (parts = 2; parts <= MOST_PARTS; parts *= 2) {
            const double coarse = found.step.argument;
            double scale;
            rest = start;
            p = before;
            if (!walk(motion, h, parts, first, state, &p, &rest, &found)) {
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
    if (!is_finite(&found.step, p.time) || !is_finite(&found.now, p.time)) {
        return fault(DISCARD, too_large);
    }
    memcpy(states_of(m), &state[INLET], FILM_RATES * sizeof state[0]);
#if SPEEDS > 0
    keep_speed(m, motion, &p);
#endif
    show(m, motion->input[VR_approach].end, motion->input[VR_rate].end, p.time, &rest, &found.now, &found.step);
    return fine;
}

/* ---- derivatives ---- */

#if SPEEDS == 0
void model_direction(const Model *m, const double seed[], double along[])
{
    const double du = own_approach(seed[VR_approach]), dv = own_rate(seed[VR_rate], SCALE_TIME);
    const double *states = &m->value[FIRST_STATE], *ds = &seed[FIRST_STATE];
    double change[FILM_RATES], force, stiffness, damping;
    FilmInstant now;
    Rest rest;
    int k;
    rest_at(m, &own_film, own_approach(m->input[VR_approach]), &rest);
    film_instant(&own_film, states, &rest, own_rate(m->input[VR_rate], SCALE_TIME), &now);
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
    along[VR_damping] = damping * damping_unit(SCALE_TIME);
    film_rates_along(&own_film, states, &rest, own_rate(m->input[VR_rate], SCALE_TIME), du, dv, ds, change);
    for (k = 0; k < FILM_RATES; k++) {
        along[FIRST_DERIVATIVE + k] = change[k] / SCALE_TIME;
    }
}
#else
void model_direction(const Model *m, const double seed[], double along[])
{
    (void)m; /* for co-simulation alone, without partial derivatives */
    (void)seed;
    (void)along;
}
#endif
