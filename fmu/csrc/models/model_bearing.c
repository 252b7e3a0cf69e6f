/* The FMU of a ball bearing, or of several on one shaft: forces on their inner rings under a given motion. Its states are those of model
 * exchange; in steps they are those of the end of the step. bearing_data.h has the bearings and where each one is. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bearing.h"
#include "model.h"

enum { FREEDOMS = N_DIRECTIONS, VELOCITY = FREEDOMS, SPEED = 2 * FREEDOMS }; /* inputs; those before are the place */

/* A bearing on the shaft: references of its first output, of its flags, of its first state and of the first output of its balls; of
 * its parameters clearance, offset, cage_angle_start and film, or -1; where its numbers and indicators begin; its motion from the
 * given one. */
typedef struct {
    const Bearing *own;
    int output, flags, state, ball, setting[4], cache, indicator;
    double ties[MOST_DIRECTIONS][FREEDOMS];
} Seat;

#include "bearing_data.h"

static const Fault fine = {FINE, NULL};

/* Outputs and states, or their changes along a direction; either may be NULL. */
typedef struct {
    double *value, *along;
} Shown;

static int put(Shown to, int reference, const Dual values[], int count)
{
    int i;
    for (i = 0; i < count; i++) {
        if (to.value != NULL) {
            to.value[reference + i] = values[i].x;
        }
        if (to.along != NULL) {
            to.along[reference + i] = values[i].d;
        }
    }
    return reference + count;
}

/* The motion of a bearing's inner ring against its outer one. */
static void ring_of(const Seat *s, const double given[], double ring[])
{
    int i, j;
    for (i = 0; i < s->own->directions; i++) {
        ring[i] = 0.0;
        for (j = 0; j < FREEDOMS; j++) {
            ring[i] += s->ties[i][j] * given[j];
        }
    }
}

/* Outputs of a bearing, and those of all its balls. */
static void show(const Seat *s, Shown to, int wet, Dual omega, const Dual force[], const BallOutputs balls[])
{
    Dual outputs[MOST_OUTPUTS];
    int k, next = s->ball;
    put(to, s->output, outputs, bearing_outputs(s->own, wet, omega, force, balls, outputs));
    for (k = 0; k < s->own->balls; k++) {
        next = put(to, next, outputs, ball_outputs(s->own, wet, omega, &balls[k], outputs));
    }
}

/* Forces on the shaft of several bearings, from those on their inner rings. */
static void show_sums(Shown to)
{
#if BEARINGS > 1
    double *const parts[] = {to.value, to.along};
    int b, i, j, k;
    for (k = 0; k < 2; k++) {
        for (j = 0; j < FREEDOMS && parts[k] != NULL; j++) {
            double sum = k == 0 ? constant_force[j] : 0.0;
            for (b = 0; b < BEARINGS; b++) {
                for (i = 0; i < seats[b].own->directions; i++) {
                    sum += seats[b].ties[i][j] * parts[k][seats[b].output + i];
                }
            }
            parts[k][FIRST_FORCE + j] = sum;
        }
    }
    if (to.value != NULL) {
        to.value[VR_outside_validity] = 0.0;
        for (b = 0; b < BEARINGS; b++) {
            to.value[VR_outside_validity] = fmax(to.value[VR_outside_validity], to.value[seats[b].flags]);
        }
    }
#else
    (void)to;
#endif
}

static void show_contacts(const Seat *s, Model *m, const BallOutputs balls[])
{
    const int races = s->own->inertia > 0.0 ? 2 : 1;
    int k, race;
    for (k = 0; k < s->own->balls && N_CONTACTS > 0; k++) {
        for (race = 0; race < races; race++) {
            m->indicator[s->indicator + k * races + race] = balls[k].film[race];
        }
    }
}

/* At the end of a step, or at rest. */
static void show_step(Model *m)
{
    const Shown to = {m->value, NULL};
    int b, j;
    for (b = 0; b < BEARINGS; b++) {
        const Seat *s = &seats[b];
        const double *state = &m->cache[s->cache];
        BallOutputs balls[MOST_BALLS];
        Dual force[MOST_DIRECTIONS];
        for (j = 0; j < s->own->directions; j++) {
            force[j] = number(state[seat_place(s->own, 0) + (size_t)j]);
        }
        bearing_balls(s->own, state, balls);
        show(s, to, is_wet(s->own, state), number(head_of(state)->omega), force, balls);
        show_contacts(s, m, balls);
        bearing_states_of_step(s->own, state, &m->value[s->state]);
    }
    show_sums(to);
}

/* ---- the interface of the core ---- */

Fault model_prepare(Model *m)
{
    const double *value = m->value;
    const char *reason = NULL;
    int b, end = 0;
    for (b = 0; b < BEARINGS && reason == NULL; b++) {
        const Seat *s = &seats[b];
        BearingSettings settings;
        const int *at = s->setting;
        if (end != s->cache || bearing_work_size(s->own) > N_WORK || s->own->balls > MOST_BALLS) {
            return fault(REFUSE, "this FMU is damaged");
        }
        end += (int)bearing_state_size(s->own);
        if (end > N_CACHE) {
            return fault(REFUSE, "this FMU is damaged");
        }
        settings.clearance = at[0] >= 0 ? value[at[0]] : 0.0;
        settings.offset = at[1] >= 0 ? value[at[1]] : 0.0;
        settings.cage_angle = value[at[2]];
        settings.film = value[at[3]];
        reason = bearing_start(s->own, &settings, &m->cache[s->cache]);
    }
    return fault(REFUSE, reason == NULL && end != N_CACHE ? "this FMU is damaged" : reason);
}

/* All bearings at rest. */
static const char *rest(const double inputs[], double cache[])
{
    const char *reason = NULL;
    int b;
    for (b = 0; b < BEARINGS && reason == NULL; b++) {
        const Seat *s = &seats[b];
        double work[N_WORK], force[MOST_DIRECTIONS], q[MOST_DIRECTIONS];
        ring_of(s, inputs, q);
        reason = bearing_check(s->own, q, inputs[SPEED]);
        if (reason == NULL) {
            reason = bearing_rest(s->own, &cache[s->cache], work, inputs[SPEED], q, force);
        }
    }
    return reason;
}

/* ---- continuous time ---- */

/* States of a bearing, rates and forces, with their changes along a direction. */
typedef struct {
    Dual states[MOST_STATES], rates[MOST_STATES], force[MOST_DIRECTIONS];
    RingMotion ring;
    BallOutputs balls[MOST_BALLS];
} InTime;

/* What follows from the inputs and these values, along `seed` (NULL: no direction); at the start from the inputs alone. */
static const char *in_time(const Seat *s, const Model *m, const double *seed, InTime *t)
{
    const int starts = m->stage == STARTING, states = bearing_states(s->own);
    double work[N_WORK], state[N_CACHE], motion[4][MOST_DIRECTIONS] = {{0.0}};
    const char *reason;
    int i;
    for (i = 0; i < 2; i++) {
        ring_of(s, &m->input[i * FREEDOMS], motion[i]);
        if (seed != NULL) {
            ring_of(s, &seed[i * FREEDOMS], motion[2 + i]);
        }
    }
    reason = bearing_check(s->own, motion[0], m->input[SPEED]);
    if (reason != NULL) {
        return reason;
    }
    for (i = 0; i < s->own->directions; i++) {
        t->ring.q[i] = dual(motion[0][i], motion[2][i]);
        t->ring.v[i] = dual(motion[1][i], motion[3][i]);
    }
    t->ring.omega = dual(m->input[SPEED], seed != NULL ? seed[SPEED] : 0.0);
    for (i = 0; i < states; i++) {
        t->states[i] = dual(m->value[s->state + i], seed != NULL && !starts ? seed[s->state + i] : 0.0);
    }
    memcpy(state, &m->cache[s->cache], bearing_state_size(s->own) * sizeof state[0]);
    return bearing_rates(s->own, state, work, &t->ring, starts, t->states, t->rates, t->force, t->balls);
}

/* Where the rates of a bearing's states are. */
static int rates_of(const Seat *s)
{
    return s->state - FIRST_STATE + FIRST_DERIVATIVE;
}

static void show_rates(const Seat *s, Model *m, const InTime *t)
{
    int i;
    for (i = 0; i < bearing_states(s->own); i++) {
        m->value[rates_of(s) + i] = t->rates[i].x;
    }
}

/* Outputs and derivatives of model exchange: with the states that were set, at the start with those at rest. */
static Fault evaluate_in_time(Model *m)
{
    const char *reason = NULL;
    Model next = *m;
    const Shown to = {next.value, NULL};
    int b, i;
    if (m->stage == STARTING) {
        reason = rest(m->input, next.cache);
        for (b = 0; b < BEARINGS; b++) {
            bearing_states_of_step(seats[b].own, &next.cache[seats[b].cache], &next.value[seats[b].state]);
        }
    }
    for (i = 0; i < N_STATES && reason == NULL; i++) {
        if (!isfinite(next.value[FIRST_STATE + i])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    for (b = 0; b < BEARINGS && reason == NULL; b++) {
        const Seat *s = &seats[b];
        InTime t;
        reason = in_time(s, &next, NULL, &t);
        if (reason == NULL) {
            show_rates(s, &next, &t);
            show(s, to, is_wet(s->own, &next.cache[s->cache]), t.ring.omega, t.force, t.balls);
            show_contacts(s, &next, t.balls);
        }
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    show_sums(to);
    *m = next;
    return fine;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    const Shown to = {NULL, along};
    int b;
    for (b = 0; b < BEARINGS; b++) {
        const Seat *s = &seats[b];
        const int states = bearing_states(s->own);
        InTime t;
        if (in_time(s, m, seed, &t) != NULL) {
            return; /* not of an evaluated model */
        }
        put(to, s->state, t.states, states);
        put(to, rates_of(s), t.rates, states);
        show(s, to, is_wet(s->own, &m->cache[s->cache]), t.ring.omega, t.force, t.balls);
    }
    show_sums(to);
}

/* ---- steps ---- */

/* In steps: before the first one at rest where the inputs are; then outputs are those of the last, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    double cache[N_CACHE];
    const char *reason;
    if (m->stage != IN_STEPS) {
        return evaluate_in_time(m);
    }
    if (head_of(m->cache)->h > 0.0) {
        return fine;
    }
    memcpy(cache, m->cache, sizeof cache);
    reason = rest(m->input, cache);
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    memcpy(m->cache, cache, sizeof cache);
    show_step(m);
    return fine;
}

Fault model_rates(Model *m)
{
    int b;
    for (b = 0; b < BEARINGS && m->stage == IN_STEPS; b++) {
        InTime t;
        const char *reason = in_time(&seats[b], m, NULL, &t);
        if (reason != NULL) {
            return fault(DISCARD, reason);
        }
        show_rates(&seats[b], m, &t);
    }
    return fine;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    double inputs[N_INPUTS], work[N_WORK], force[MOST_DIRECTIONS], q[MOST_DIRECTIONS], v[MOST_DIRECTIONS];
    int b, j;
    (void)tolerance;
    for (j = 0; j < N_INPUTS; j++) {
        inputs[j] = motion->input[j].end;
    }
    for (b = 0; b < BEARINGS; b++) {
        const Seat *s = &seats[b];
        double *state = &m->cache[s->cache];
        const char *reason;
        ring_of(s, inputs, q);
        ring_of(s, &inputs[VELOCITY], v);
        reason = bearing_check(s->own, q, inputs[SPEED]);
        if (reason == NULL) {
            bearing_begin(s->own, state, work, h, inputs[SPEED]);
            reason = bearing_press(s->own, state, work, q, v, force);
        }
        if (reason != NULL) {
            return fault(DISCARD, reason);
        }
        bearing_accept(s->own, state, work);
    }
    show_step(m);
    memcpy(m->input, inputs, sizeof inputs);
    return fine;
}

unsigned long long model_outside(const Model *m)
{
    unsigned long long found = 0;
    int b;
    for (b = 0; b < BEARINGS; b++) {
        const double *flags = &m->value[seats[b].flags];
        const unsigned long long own = (flags[1] != 0.0 ? TOO_FAST : 0U) | (flags[2] != 0.0 ? OVERLOADED : 0U);
        found |= own << (2 * b);
    }
    return found;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    unsigned long long fast = 0;
    int b;
    (void)m;
    for (b = 0; b < BEARINGS; b++) {
        fast |= which >> (2 * b) & TOO_FAST;
    }
    snprintf(text, size, "%s", fast == 0 ? "" : " speed above the tables;");
    for (b = 0; b < BEARINGS; b++) {
        if ((which >> (2 * b) & OVERLOADED) != 0) {
            const size_t end = strlen(text);
#if BEARINGS > 1
            snprintf(text + end, size - end, " a ball of bearing[%d] carries more than the tables have;", b + 1);
#else
            snprintf(text + end, size - end, " a ball carries more than the tables have;");
#endif
        }
    }
    text[strlen(text) - 1] = '\0';
}
