/* A squeeze film damper as a support of a rotor; see damper.h. Its state is what it shows of the end of the last step: the force on it
 * and the eccentricity ratio. Work has these of the step, then the slopes. */
#include <math.h>
#include <string.h>

#include "damper.h"

enum { FORCE, ECCENTRICITY = 2, STIFFNESS = DAMPER_SIZE, DAMPING = STIFFNESS + 4 };

static const char *const touches = "the journal of a squeeze film damper touches its housing: the eccentricity ratio is 1 or more";

static const Damper *damper_of(const void *own)
{
    return (const Damper *)own;
}

/* Where the journal is; work has what follows. */
static void press(const Damper *d, const double q[], const double v[], double work[], double force[])
{
    damper_press(d, q, v, force, work + STIFFNESS, work + DAMPING);
    memcpy(work + FORCE, force, 2 * sizeof work[0]);
    work[ECCENTRICITY] = damper_eccentricity(d, q);
}

static const char *contact(const double numbers[])
{
    return numbers[ECCENTRICITY] >= 1.0 ? touches : NULL;
}

const char *damper_support_start(const void *own, const double parameters[], double state[])
{
    (void)own, (void)parameters;
    memset(state, 0, DAMPER_SIZE * sizeof state[0]);
    return NULL;
}

const char *damper_support_rest(const void *own, double state[], double work[], double omega, const double q[], const double v[],
                                double force[])
{
    (void)omega;
    press(damper_of(own), q, v, work, force);
    memcpy(state, work, DAMPER_SIZE * sizeof state[0]);
    return contact(state);
}

void damper_support_begin(const void *own, const double state[], double work[], double h, double omega)
{
    (void)own, (void)state, (void)work, (void)h, (void)omega;
}

const char *damper_support_press(const void *own, const double state[], double work[], const double q[], const double v[],
                                 double force[])
{
    (void)state;
    press(damper_of(own), q, v, work, force);
    return NULL;
}

void damper_support_slopes(const void *own, const double work[], double stiffness[], double damping[])
{
    (void)own;
    memcpy(stiffness, work + STIFFNESS, 4 * sizeof work[0]);
    memcpy(damping, work + DAMPING, 4 * sizeof work[0]);
}

const char *damper_support_accept(const void *own, double state[], double work[])
{
    (void)own;
    memcpy(state, work, DAMPER_SIZE * sizeof state[0]);
    return contact(state);
}

double damper_support_torque(const void *own, const double state[], const double outputs[])
{
    (void)own, (void)state, (void)outputs; /* the journal does not turn */
    return 0.0;
}

void damper_support_show(const void *own, const double state[], double outputs[], double states[], double indicators[])
{
    (void)own, (void)states;
    outputs[0] = -state[FORCE];
    outputs[1] = -state[FORCE + 1];
    outputs[2] = state[ECCENTRICITY];
    outputs[3] = state[ECCENTRICITY] > 1.0 - THINNEST;
    if (indicators != NULL) {
        indicators[0] = 1.0 - state[ECCENTRICITY];
    }
}

const char *damper_support_evaluate(const void *own, double state[], double work[], const SupportMotion *motion,
                                    const double states[], double outputs[], double indicators[], double force[], double rates[])
{
    (void)states, (void)rates;
    press(damper_of(own), motion->q, motion->v, work, force);
    memcpy(state, work, DAMPER_SIZE * sizeof state[0]);
    damper_support_show(own, state, outputs, NULL, indicators);
    return contact(state);
}

void damper_support_along(const void *own, const double state[], double work[], const SupportMotion *motion, const double states[],
                          const SupportMotion *change, const double changes[], double outputs[], double force[], double rates[])
{
    const Damper *d = damper_of(own);
    const double *q = motion->q, *dq = change->q, *dv = change->v, size = hypot(q[0], q[1]);
    double pushed[2];
    int i;
    (void)state, (void)states, (void)changes, (void)rates;
    press(d, q, motion->v, work, pushed);
    for (i = 0; i < 2; i++) {
        const double *K = work + STIFFNESS + 2 * i, *C = work + DAMPING + 2 * i;
        force[i] = K[0] * dq[0] + K[1] * dq[1] + C[0] * dv[0] + C[1] * dv[1];
        outputs[i] = -force[i];
    }
    outputs[2] = size > 0.0 ? (q[0] * dq[0] + q[1] * dq[1]) / (size * d->clearance) : 0.0;
    outputs[3] = 0.0;
}

void damper_support(const Damper *d, Support *support)
{
    const Support made = {d, DAMPER_SUPPORT};
    *support = made;
}

/* Size of the structure, for callers in other languages. */
size_t damper_size(void)
{
    return sizeof(Damper);
}
