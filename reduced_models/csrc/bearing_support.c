/* A ball bearing as a support of a rotor; see bearing_support.h. In continuous time work has the states, their rates and the balls'
 * state behind that of a step. */
#include "bearing_support.h"

#include <string.h>

enum { MOST_BALLS = 64 };

static const Bearing *bearing_of(const void *own)
{
    return (const Bearing *)own;
}

const char *bearing_support_start(const void *own, const double parameters[], double state[])
{
    BearingSettings settings;
    settings.clearance = parameters[0];
    settings.offset = parameters[1];
    settings.cage_angle = parameters[2];
    settings.film = parameters[3];
    return bearing_start(bearing_of(own), &settings, state);
}

const char *bearing_support_rest(const void *own, double state[], double work[], double omega, const double q[], const double v[],
                                 double force[])
{
    const Bearing *b = bearing_of(own);
    const char *reason = bearing_check(b, q, omega);
    (void)v;
    return reason != NULL ? reason : bearing_rest(b, state, work + 1, omega, q, force);
}

void bearing_support_begin(const void *own, const double state[], double work[], double h, double omega)
{
    work[0] = omega;
    bearing_begin(bearing_of(own), state, work + 1, h, omega);
}

const char *bearing_support_press(const void *own, const double state[], double work[], const double q[], const double v[],
                                  double force[])
{
    const char *reason = bearing_within(bearing_of(own), q);
    return reason != NULL ? reason : bearing_press(bearing_of(own), state, work + 1, q, v, force);
}

void bearing_support_slopes(const void *own, const double work[], double stiffness[], double damping[])
{
    bearing_slopes(bearing_of(own), work + 1, stiffness, damping);
}

const char *bearing_support_accept(const void *own, double state[], double work[])
{
    bearing_accept(bearing_of(own), state, work + 1);
    return NULL;
}

double bearing_support_torque(const void *own, const double state[], const double outputs[])
{
    const Bearing *b = bearing_of(own);
    BallOutputs balls[MOST_BALLS];
    double last[MOST_OUTPUTS];
    if (outputs != NULL) {
        return bearing_torque(b, outputs);
    }
    bearing_outputs_of_step(b, state, balls, last);
    return bearing_torque(b, last);
}

static void show_indicators(const Bearing *b, const BallOutputs balls[], double indicators[])
{
    const int races = b->inertia > 0.0 ? 2 : 1;
    int k, race;
    for (k = 0; k < b->balls; k++) {
        for (race = 0; race < races; race++) {
            indicators[k * races + race] = balls[k].film[race];
        }
    }
}

void bearing_support_show(const void *own, const double state[], double outputs[], double states[], double indicators[])
{
    const Bearing *b = bearing_of(own);
    BallOutputs balls[MOST_BALLS];
    bearing_outputs_of_step(b, state, balls, outputs);
    bearing_states_of_step(b, state, states);
    if (indicators != NULL) {
        show_indicators(b, balls, indicators);
    }
}

/* States, rates and forces with their changes, in continuous time. */
static const char *in_time(const Bearing *b, const double state[], double work[], const SupportMotion *motion,
                           const double states[], const SupportMotion *change, const double changes[], Dual **rates,
                           Dual force[], BallOutputs balls[])
{
    const int n = bearing_states(b);
    const size_t size = bearing_state_size(b);
    double *moved = work + 1 + bearing_work_size(b);
    Dual *moving = (Dual *)(void *)(moved + size);
    RingMotion ring;
    const char *reason = bearing_check(b, motion->q, motion->omega);
    int i;
    *rates = moving + n;
    if (reason != NULL) {
        return reason;
    }
    for (i = 0; i < b->directions; i++) {
        ring.q[i] = dual(motion->q[i], change != NULL ? change->q[i] : 0.0);
        ring.v[i] = dual(motion->v[i], change != NULL ? change->v[i] : 0.0);
    }
    ring.omega = dual(motion->omega, change != NULL ? change->omega : 0.0);
    for (i = 0; i < n; i++) {
        moving[i] = dual(states[i], change != NULL ? changes[i] : 0.0);
    }
    memcpy(moved, state, size * sizeof state[0]);
    return bearing_rates(b, moved, work + 1, &ring, 0, moving, *rates, force, balls);
}

const char *bearing_support_evaluate(const void *own, double state[], double work[], const SupportMotion *motion,
                                     const double states[], double outputs[], double indicators[], double force[],
                                     double rates[])
{
    const Bearing *b = bearing_of(own);
    BallOutputs balls[MOST_BALLS];
    Dual made[MOST_OUTPUTS], pressed[MOST_DIRECTIONS], *moving;
    const char *reason = in_time(b, state, work, motion, states, NULL, NULL, &moving, pressed, balls);
    int i, count;
    if (reason != NULL) {
        return reason;
    }
    count = bearing_outputs(b, is_wet(b, state), number(motion->omega), pressed, balls, made);
    for (i = 0; i < count; i++) {
        outputs[i] = made[i].x;
    }
    for (i = 0; i < b->directions; i++) {
        force[i] = pressed[i].x;
    }
    for (i = 0; i < bearing_states(b); i++) {
        rates[i] = moving[i].x;
    }
    show_indicators(b, balls, indicators);
    return NULL;
}

void bearing_support_along(const void *own, const double state[], double work[], const SupportMotion *motion,
                           const double states[], const SupportMotion *change, const double changes[], double outputs[],
                           double force[], double rates[])
{
    const Bearing *b = bearing_of(own);
    BallOutputs balls[MOST_BALLS];
    Dual made[MOST_OUTPUTS], pressed[MOST_DIRECTIONS], *moving;
    int i, count;
    memset(force, 0, (size_t)b->directions * sizeof force[0]);
    if (in_time(b, state, work, motion, states, change, changes, &moving, pressed, balls) != NULL) {
        return; /* not where it was evaluated */
    }
    count = bearing_outputs(b, is_wet(b, state), dual(motion->omega, change->omega), pressed, balls, made);
    for (i = 0; i < count; i++) {
        outputs[i] = made[i].d;
    }
    for (i = 0; i < b->directions; i++) {
        force[i] = pressed[i].d;
    }
    for (i = 0; i < bearing_states(b); i++) {
        rates[i] = moving[i].d;
    }
}

void bearing_support(const Bearing *b, Support *support)
{
    const Support made = {b, b->directions, 0, 0, bearing_state_size(b), 1 + bearing_work_size(b), BEARING_SUPPORT};
    *support = made;
}
