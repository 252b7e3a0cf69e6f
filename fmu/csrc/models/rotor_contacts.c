/* The contacts inside a rotor: their laws, and Newton's method for the journal between them; see rotor.h. rotor_laws.h is
 * generated: the law of each mount, its numbers in the cache and its film among the states. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "contact_law.h"
#include "rotor.h"
#include "rotor_laws.h"

enum { MOST_ITERATIONS = 30 };
static const double balanced = 1e-10; /* imbalance over the forces at work that ends the iteration */
static const double by_rounding = 16.0 * DBL_EPSILON; /* of what balances, which cannot be less */
static const double overshoot = 2.0; /* growth of the imbalance that halves the way: a contact opens or closes */

static double *numbers_of(Model *m, int mount)
{
    return &m->cache[CONTACTS + law_numbers[mount]];
}

static void show(Model *m, int mount, const ContactForce *found)
{
    m->value[FIRST_FORCE + mount] = found->force;
    m->value[FIRST_OUTSIDE + mount] = found->outside;
    m->indicator[mount] = found->indicator;
    if (mount == 0 || found->outside) {
        m->value[VR_outside_validity] = found->outside;
    }
}

const char *contacts_start(Model *m)
{
    const char *reason = NULL;
    int i;
    for (i = 0; i < N_MOUNTS && reason == NULL; i++) {
        reason = law_of[i]->start(numbers_of(m, i));
    }
    return reason;
}

/* Solves A x = b by elimination, b becoming x; what balances the journal is positive definite. */
static void solve(double A[AXES][AXES], double b[AXES])
{
    int i, j, k;
    for (k = 0; k < AXES; k++) {
        for (i = k + 1; i < AXES; i++) {
            const double factor = A[i][k] / A[k][k];
            for (j = k; j < AXES; j++) {
                A[i][j] -= factor * A[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (k = AXES - 1; k >= 0; k--) {
        for (j = k + 1; j < AXES; j++) {
            b[k] -= A[k][j] * b[j];
        }
        b[k] /= A[k][k];
    }
}

/* Whether contacts of this stiffness hold the journal along every axis. */
static int holds(double A[AXES][AXES])
{
    const int last = AXES - 1;
    return A[0][0] > 0.0 && (AXES == 1 || A[0][0] * A[last][last] > A[0][last] * A[last][0]);
}

const char *contacts_rest(Model *m, const double load[], double q[])
{
    double slopes[AXES][AXES], residual[AXES], previous = HUGE_VAL;
    int iteration, i, j, k;
    for (iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        double error = 0.0, size = 0.0;
        for (k = 0; k < AXES; k++) {
            residual[k] = -load[k];
            size = hypot(size, load[k]);
        }
        memset(slopes, 0, sizeof slopes);
        for (i = 0; i < N_MOUNTS; i++) {
            ContactForce found;
            const char *reason = law_of[i]->evaluate(numbers_of(m, i), &m->value[FILMS + law_film[i]],
                                                     rotor_approach(i, q), 0.0, &found);
            if (reason != NULL) {
                return reason;
            }
            rotor_carry(i, found.force, residual);
            for (j = 0; j < AXES; j++) {
                for (k = 0; k < AXES; k++) {
                    slopes[j][k] += BEARINGS * found.stiffness * rotor_normals[i][j] * rotor_normals[i][k];
                }
            }
        }
        for (k = 0; k < AXES; k++) {
            error = hypot(error, residual[k]);
        }
        if (error <= by_rounding * size || (error <= balanced * size && error >= previous)) {
            return NULL;
        }
        if (!holds(slopes)) {
            break;
        }
        previous = error;
        solve(slopes, residual);
        for (k = 0; k < AXES; k++) {
            q[k] -= residual[k];
        }
    }
    return "the contacts do not carry the rotor at rest with these masses";
}

const char *contacts_evaluate(Model *m)
{
    ContactForce found;
    int i;
    for (i = 0; i < N_MOUNTS; i++) {
        const char *reason = law_of[i]->evaluate(numbers_of(m, i), &m->value[FILMS + law_film[i]],
                                                 m->value[FIRST_APPROACH + i], m->value[FIRST_RATE + i], &found);
        if (reason != NULL) {
            return reason;
        }
        show(m, i, &found);
    }
    return NULL;
}

void contacts_carried(const double value[], double carried[])
{
    int i;
    memset(carried, 0, AXES * sizeof carried[0]);
    for (i = 0; i < N_MOUNTS; i++) {
        rotor_carry(i, value[FIRST_FORCE + i], carried);
    }
}

const char *contacts_rates(Model *m)
{
    const char *reason = NULL;
    int i;
    for (i = 0; i < N_MOUNTS && reason == NULL; i++) {
        reason = law_of[i]->rates(numbers_of(m, i), &m->value[FIRST_DERIVATIVE + 2 * FREEDOMS + 1 + law_film[i]]);
    }
    return reason;
}

void contacts_direction(const Model *m, const double seed[], double along[], double carried[])
{
    int i;
    for (i = 0; i < N_MOUNTS; i++) {
        const double u = along[FIRST_APPROACH + i], v = along[FIRST_RATE + i];
        const double force = law_of[i]->direction(&m->cache[CONTACTS + law_numbers[i]], u, v, &seed[FILMS + law_film[i]],
                                                  &along[FIRST_DERIVATIVE + 2 * FREEDOMS + 1 + law_film[i]]);
        along[FIRST_FORCE + i] = force;
        rotor_carry(i, force, carried);
    }
}

/* ---- the end of a step ---- */

/* Moves all contacts to the end of a step with the journal at q, from `before`; their force, and its slopes by q. */
static const char *move(const Model *before, Model *after, const Balance *b, double h, const double q[], double carried[],
                        double slopes[AXES][AXES])
{
    double velocity[AXES];
    ContactForce found;
    int i, j, k;
    for (k = 0; k < AXES; k++) {
        velocity[k] = b->gain * q[k] + b->history[k];
    }
    memset(carried, 0, AXES * sizeof carried[0]);
    memset(slopes, 0, AXES * sizeof slopes[0]);
    for (i = 0; i < N_MOUNTS; i++) {
        const size_t at = (size_t)(CONTACTS + law_numbers[i]);
        ContactMotion motion;
        const char *reason;
        double slope;
        motion.start_approach = before->value[FIRST_APPROACH + i];
        motion.start_rate = before->value[FIRST_RATE + i];
        motion.end_approach = rotor_approach(i, q);
        motion.end_rate = rotor_rate(i, velocity);
        memcpy(&after->cache[at], &before->cache[at], (size_t)law_of[i]->size * sizeof after->cache[0]);
        reason = law_of[i]->step(&after->cache[at], &before->value[FILMS + law_film[i]], &after->value[FILMS + law_film[i]],
                                 &motion, h, &found);
        if (reason != NULL) {
            return reason;
        }
        show(after, i, &found);
        rotor_carry(i, found.force, carried);
        slope = BEARINGS * (found.stiffness + b->gain * found.damping);
        for (j = 0; j < AXES; j++) {
            for (k = 0; k < AXES; k++) {
                slopes[j][k] += slope * rotor_normals[i][j] * rotor_normals[i][k];
            }
        }
    }
    return NULL;
}

const char *contacts_balance(Model *m, const Balance *b, double h, double q[], double carried[])
{
    const Model before = *m;
    double slopes[AXES][AXES], residual[AXES], last[AXES];
    double previous = HUGE_VAL;
    int iteration, j, k;
    memcpy(last, q, sizeof last);
    for (iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        const char *reason = move(&before, m, b, h, q, carried, slopes);
        double error = 0.0, size = 0.0;
        if (reason != NULL) {
            return reason;
        }
        for (k = 0; k < AXES; k++) {
            residual[k] = b->D * (q[k] - b->free[k]) + b->weight * carried[k];
            error = hypot(error, residual[k]);
            size = fmax(size, fmax(fabs(q[k]), fabs(b->free[k])));
            for (j = 0; j < AXES; j++) {
                slopes[k][j] = b->weight * slopes[k][j] + (j == k ? b->D : 0.0);
            }
        }
        if (error <= balanced * b->load + by_rounding * b->D * size) {
            return NULL;
        }
        if (!isfinite(error)) {
            break;
        }
        if (error > overshoot * previous) {
            for (k = 0; k < AXES; k++) {
                q[k] = 0.5 * (q[k] + last[k]);
            }
            continue;
        }
        previous = error;
        solve(slopes, residual);
        for (k = 0; k < AXES; k++) {
            last[k] = q[k];
            q[k] -= residual[k];
        }
    }
    return "the forces on the journal do not balance: a shorter step can help";
}

/* ---- validity ---- */

unsigned long long model_outside(const Model *m)
{
    unsigned long long outside = 0;
    int i;
    for (i = 0; i < N_MOUNTS; i++) {
        outside |= (m->value[FIRST_OUTSIDE + i] > 0.0 ? 1ULL : 0ULL) << i;
    }
    return outside;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    int i;
    (void)m;
    for (i = 0; i < N_MOUNTS && size > 0; i++) {
        if ((which >> i & 1ULL) != 0) {
            const int written = snprintf(text, size, " contact[%d]", i + 1);
            if (written < 0 || (size_t)written >= size) {
                return;
            }
            text += written;
            size -= (size_t)written;
        }
    }
}
