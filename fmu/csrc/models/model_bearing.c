/* The FMU of a ball bearing: force on the inner ring under a given motion of it. Its states are those of model exchange; in steps they
 * are those of the end of the step. config.h has CLEARANCE and OFFSET, references of these parameters or -1. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bearing.h"
#include "bearing_data.h"
#include "model.h"

enum { FREEDOMS = N_DIRECTIONS, VELOCITY = FREEDOMS, SPEED = 2 * FREEDOMS }; /* inputs; those before are the place */

static const Fault fine = {FINE, NULL};

/* Outputs and states of a bearing, or their changes along a direction; either may be NULL. */
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

/* Outputs, and those of all balls. */
static void show(Shown to, int wet, Dual omega, const Dual force[], const BallOutputs balls[BALLS])
{
    Dual outputs[MOST_OUTPUTS];
    int k, next = FIRST_BALL;
    put(to, FIRST_FORCE, outputs, bearing_outputs(&bearing, wet, omega, force, balls, outputs));
    for (k = 0; k < BALLS; k++) {
        next = put(to, next, outputs, ball_outputs(&bearing, wet, omega, &balls[k], outputs));
    }
}

static void show_contacts(Model *m, const BallOutputs balls[BALLS])
{
    const int per_ball = N_CONTACTS / BALLS;
    int k, race;
    for (k = 0; k < BALLS; k++) {
        for (race = 0; race < per_ball; race++) {
            m->indicator[k * per_ball + race] = balls[k].film[race];
        }
    }
}

/* At the end of a step, or at rest. */
static void show_step(Model *m)
{
    const Shown to = {m->value, NULL};
    BallOutputs balls[BALLS];
    Dual force[FREEDOMS];
    int j;
    for (j = 0; j < FREEDOMS; j++) {
        force[j] = number(m->cache[seat_place(&bearing, 0) + (size_t)j]);
    }
    bearing_balls(&bearing, m->cache, balls);
    show(to, is_wet(&bearing, m->cache), number(head_of(m->cache)->omega), force, balls);
    show_contacts(m, balls);
    bearing_states_of_step(&bearing, m->cache, &m->value[FIRST_STATE]);
}

/* ---- the interface of the core ---- */

Fault model_prepare(Model *m)
{
    const double *value = m->value;
    BearingSettings settings;
    if (bearing_state_size(&bearing) != N_CACHE || bearing_work_size(&bearing) != N_WORK) {
        return fault(REFUSE, "this FMU is damaged");
    }
    settings.clearance = CLEARANCE >= 0 ? value[CLEARANCE] : 0.0;
    settings.offset = OFFSET >= 0 ? value[OFFSET] : 0.0;
    settings.cage_angle = value[VR_cage_angle_start];
    settings.film = value[VR_film];
    return fault(REFUSE, bearing_start(&bearing, &settings, m->cache));
}

static const char *rest(const double inputs[], double state[])
{
    double work[N_WORK], force[FREEDOMS];
    const char *reason = bearing_check(&bearing, inputs, inputs[SPEED]);
    return reason != NULL ? reason : bearing_rest(&bearing, state, work, inputs[SPEED], inputs, force);
}

/* ---- continuous time ---- */

/* States, rates and forces, with their changes along a direction. */
typedef struct {
    Dual states[N_STATES], rates[N_STATES], force[FREEDOMS];
    RingMotion ring;
    BallOutputs balls[BALLS];
} InTime;

/* What follows from the inputs and these states, along `seed` (NULL: no direction); at the start from the inputs alone. */
static const char *in_time(const Model *m, const double states[], const double *seed, InTime *t)
{
    const int starts = m->stage == STARTING;
    const char *reason = bearing_check(&bearing, m->input, m->input[SPEED]);
    double work[N_WORK], state[N_CACHE];
    int i, j;
    if (reason != NULL) {
        return reason;
    }
    for (j = 0; j < FREEDOMS; j++) {
        t->ring.q[j] = dual(m->input[j], seed != NULL ? seed[j] : 0.0);
        t->ring.v[j] = dual(m->input[VELOCITY + j], seed != NULL ? seed[VELOCITY + j] : 0.0);
    }
    t->ring.omega = dual(m->input[SPEED], seed != NULL ? seed[SPEED] : 0.0);
    for (i = 0; i < N_STATES; i++) {
        t->states[i] = dual(states[i], seed != NULL && !starts ? seed[FIRST_STATE + i] : 0.0);
    }
    memcpy(state, m->cache, sizeof state);
    return bearing_rates(&bearing, state, work, &t->ring, starts, t->states, t->rates, t->force, t->balls);
}

static void show_rates(Model *m, const InTime *t)
{
    int i;
    for (i = 0; i < N_STATES; i++) {
        m->value[FIRST_DERIVATIVE + i] = t->rates[i].x;
    }
}

/* Outputs and derivatives of model exchange: with the states that were set, at the start with those at rest. */
static Fault evaluate_in_time(Model *m)
{
    const Shown to = {m->value, NULL};
    const char *reason = NULL;
    Model next = *m;
    InTime t;
    int i;
    if (m->stage == STARTING) {
        reason = rest(m->input, next.cache);
        bearing_states_of_step(&bearing, next.cache, &next.value[FIRST_STATE]);
    }
    for (i = 0; i < N_STATES && reason == NULL; i++) {
        if (!isfinite(next.value[FIRST_STATE + i])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    if (reason == NULL) {
        reason = in_time(&next, &next.value[FIRST_STATE], NULL, &t);
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    *m = next;
    show_rates(m, &t);
    show(to, is_wet(&bearing, m->cache), t.ring.omega, t.force, t.balls);
    show_contacts(m, t.balls);
    return fine;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    const Shown to = {NULL, along};
    InTime t;
    if (in_time(m, &m->value[FIRST_STATE], seed, &t) != NULL) {
        return; /* not of an evaluated model */
    }
    put(to, FIRST_STATE, t.states, N_STATES);
    put(to, FIRST_DERIVATIVE, t.rates, N_STATES);
    show(to, is_wet(&bearing, m->cache), t.ring.omega, t.force, t.balls);
}

/* ---- steps ---- */

/* In steps: before the first one at rest where the inputs are; then outputs are those of the last, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    double state[N_CACHE];
    const char *reason;
    if (m->stage != IN_STEPS) {
        return evaluate_in_time(m);
    }
    if (head_of(m->cache)->h > 0.0) {
        return fine;
    }
    memcpy(state, m->cache, sizeof state);
    reason = rest(m->input, state);
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    memcpy(m->cache, state, sizeof state);
    show_step(m);
    return fine;
}

Fault model_rates(Model *m)
{
    if (m->stage == IN_STEPS) {
        InTime t;
        const char *reason = in_time(m, &m->value[FIRST_STATE], NULL, &t);
        if (reason != NULL) {
            return fault(DISCARD, reason);
        }
        show_rates(m, &t);
    }
    return fine;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    double inputs[N_INPUTS], work[N_WORK], force[FREEDOMS];
    const char *reason;
    int j;
    (void)tolerance;
    for (j = 0; j < N_INPUTS; j++) {
        inputs[j] = motion->input[j].end;
    }
    reason = bearing_check(&bearing, inputs, inputs[SPEED]);
    if (reason == NULL) {
        bearing_begin(&bearing, m->cache, work, h, inputs[SPEED]);
        reason = bearing_press(&bearing, m->cache, work, inputs, &inputs[VELOCITY], force);
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    bearing_accept(&bearing, m->cache, work);
    show_step(m);
    memcpy(m->input, inputs, sizeof inputs);
    return fine;
}

unsigned long long model_outside(const Model *m)
{
    return (m->value[VR_outside_speed] != 0.0 ? TOO_FAST : 0U) | (m->value[VR_outside_load] != 0.0 ? OVERLOADED : 0U);
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    (void)m;
    snprintf(text, size, "%s%s", (which & TOO_FAST) == 0 ? "" : " speed above the tables;",
             (which & OVERLOADED) == 0 ? "" : " a ball carries more than the tables have;");
    text[strlen(text) - 1] = '\0';
}
