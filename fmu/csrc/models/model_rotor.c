/* A Jeffcott rotor, alone or on its contacts: reduced_models.rotor.jeffcott. The states are those of continuous time:
 * positions, velocities, the angle of the unbalance, and the films of the contacts. Equations in README.md. */
#include <math.h>
#include <string.h>

#include "rotor.h"

/* ---- mounts ---- */

double rotor_rate(int mount, const double velocity[])
{
    double sum = 0.0;
    int k;
    for (k = 0; k < AXES; k++) {
        sum += rotor_normals[mount][k] * velocity[k];
    }
    return sum;
}

double rotor_approach(int mount, const double journal[])
{
    return rotor_rate(mount, journal) + rotor_offsets[mount];
}

const char *rotor_mounts(Model *m)
{
    int i;
    for (i = 0; i < N_MOUNTS; i++) {
        const double u = rotor_approach(i, &m->value[POSITION + JOURNAL]), v = rotor_rate(i, &m->value[VELOCITY + JOURNAL]);
        if (!(isfinite(u) && isfinite(v))) {
            return "the motion is too large for a floating-point number";
        }
        m->value[FIRST_APPROACH + i] = u;
        m->value[FIRST_RATE + i] = v;
    }
    return NULL;
}

void rotor_carry(int mount, double force, double carried[])
{
    int k;
    for (k = 0; k < AXES; k++) {
        carried[k] += BEARINGS * force * rotor_normals[mount][k];
    }
}

/* ---- forces ---- */

/* Direction of the unbalance along the axis k that moves, and its derivative by the angle; with one axis that is y. */
static double pointing(double angle, int k)
{
    return k + 2 - AXES == 0 ? cos(angle) : sin(angle);
}

static double turning(double angle, int k)
{
    return k + 2 - AXES == 0 ? -sin(angle) : cos(angle);
}

double rotor_shaft(const double value[], const double d[], const double v[], int k)
{
    return -value[VR_shaft_stiffness] * (d[DISC + k] - d[JOURNAL + k])
           - value[VR_shaft_damping] * (v[DISC + k] - v[JOURNAL + k]);
}

void rotor_loads(const double value[], double loads[])
{
    int k;
    for (k = 0; k < AXES; k++) {
        loads[DISC + k] = value[VR_disc_mass] * rotor_gravity[k] + rotor_force[k];
        loads[JOURNAL + k] = value[VR_journal_mass] * rotor_gravity[k];
    }
}

void rotor_applied(const double value[], const double inputs[], double angle, double applied[])
{
    const double omega = inputs[VR_speed], unbalance = inputs[VR_unbalance];
    double carried[AXES] = {0.0};
    int i, k;
    rotor_loads(value, applied);
    for (i = 0; i < MOUNT_FORCES; i++) {
        rotor_carry(i, inputs[MOUNT_FORCE + i], carried);
    }
    for (k = 0; k < AXES; k++) {
        applied[DISC + k] += inputs[DISC_FORCE + k]
                             + unbalance * (omega * omega * pointing(angle, k) - inputs[VR_angular_acceleration] * turning(angle, k));
        applied[JOURNAL + k] += inputs[JOURNAL_FORCE + k] - carried[k];
    }
}

void rotor_accelerations(const double value[], const double applied[], const double carried[], double accelerations[])
{
    const double *d = &value[POSITION], *v = &value[VELOCITY];
    int k;
    for (k = 0; k < AXES; k++) {
        const double pull = rotor_shaft(value, d, v, k);
        accelerations[DISC + k] = (applied[DISC + k] + pull - value[VR_disc_damping] * v[DISC + k]) / value[VR_disc_mass];
        accelerations[JOURNAL + k] = (applied[JOURNAL + k] - pull - carried[k]) / value[VR_journal_mass];
    }
}

/* ---- functions of model.h ---- */

static const char *check(const double value[])
{
    static const struct {
        int reference, positive;
        const char *reason;
    } ranges[] = {
        {VR_disc_mass, 1, "disc_mass must be finite and > 0"},
        {VR_journal_mass, 1, "journal_mass must be finite and > 0"},
        {VR_shaft_stiffness, 1, "shaft_stiffness must be finite and > 0"},
        {VR_shaft_damping, 0, "shaft_damping must be finite and >= 0"},
        {VR_disc_damping, 0, "disc_damping must be finite and >= 0"},
    };
    size_t i;
    for (i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        const double x = value[ranges[i].reference];
        if (!(isfinite(x) && x >= 0.0 && (x > 0.0 || !ranges[i].positive))) {
            return ranges[i].reason;
        }
    }
    return value[VR_inner_step] >= LEAST_INNER_STEP && isfinite(value[VR_inner_step])
               ? NULL : "inner_step must be finite and at least a millionth of its default";
}

/* Equilibrium with the parameters as they are now, where no other start has been set than that of the last equilibrium. */
static const char *settle(Model *m)
{
    double *rest = &m->cache[REST], *d = &m->value[POSITION], loads[FREEDOMS], carried[AXES];
    const char *reason;
    int i, k;
    for (i = 0; i < FREEDOMS; i++) {
        if (d[i] != rest[i] || m->value[VELOCITY + i] != 0.0) {
            return NULL;
        }
    }
    rotor_loads(m->value, loads);
    for (k = 0; k < AXES; k++) {
        carried[k] = loads[DISC + k] + loads[JOURNAL + k];
    }
    reason = contacts_rest(m, carried, &rest[JOURNAL]);
    for (k = 0; k < AXES; k++) {
        rest[DISC + k] = rest[JOURNAL + k] + loads[DISC + k] / m->value[VR_shaft_stiffness];
    }
    memcpy(d, rest, FREEDOMS * sizeof rest[0]);
    return reason;
}

Fault model_prepare(Model *m)
{
    const char *reason = check(m->value);
    if (reason == NULL && m->cache[READY] == 0.0) {
        m->cache[READY] = 1.0;
        memcpy(&m->cache[REST], rotor_rest, sizeof rotor_rest);
        reason = contacts_start(m);
    }
    if (reason == NULL && STARTS_AT_REST) {
        reason = settle(m);
    }
    return fault(REFUSE, reason);
}

Fault model_evaluate(Model *m)
{
    Model next = *m;
    Fault found;
    int i;
    for (i = 0; i < N_STATES; i++) {
        if (!isfinite(m->value[FIRST_STATE + i])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    found = fault(DISCARD, rotor_mounts(&next));
    if (found.severity == FINE) {
        found = fault(DISCARD, contacts_evaluate(&next));
    }
    if (found.severity == FINE) {
        *m = next;
    }
    return found;
}

Fault model_rates(Model *m)
{
    Model next = *m;
    double *rates = &next.value[FIRST_DERIVATIVE];
    double applied[FREEDOMS], carried[AXES];
    Fault found;
    int i;
    contacts_carried(m->value, carried);
    rotor_applied(m->value, m->input, m->value[ANGLE], applied);
    memcpy(rates, &m->value[VELOCITY], FREEDOMS * sizeof rates[0]);
    rotor_accelerations(m->value, applied, carried, rates + FREEDOMS);
    rates[2 * FREEDOMS] = m->input[VR_speed];
    found = fault(DISCARD, contacts_rates(&next));
    for (i = 0; i < 2 * FREEDOMS && found.severity == FINE; i++) {
        if (!isfinite(rates[i])) {
            found = fault(DISCARD, "an acceleration is too large for a floating-point number");
        }
    }
    if (found.severity == FINE) {
        *m = next;
    }
    return found;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    const double *d = &seed[POSITION], *v = &seed[VELOCITY], angle = m->value[ANGLE];
    const double omega = m->input[VR_speed], alpha = m->input[VR_angular_acceleration], unbalance = m->input[VR_unbalance];
    const double swing = seed[VR_unbalance] * omega * omega
                         + unbalance * (2.0 * omega * seed[VR_speed] + alpha * seed[ANGLE]);
    const double pushed = seed[VR_unbalance] * alpha
                          + unbalance * (seed[VR_angular_acceleration] - omega * omega * seed[ANGLE]);
    double applied[FREEDOMS], carried[AXES] = {0.0};
    double *rates = &along[FIRST_DERIVATIVE];
    int i, k;
    for (i = 0; i < N_MOUNTS; i++) {
        along[FIRST_APPROACH + i] = rotor_rate(i, d + JOURNAL);
        along[FIRST_RATE + i] = rotor_rate(i, v + JOURNAL);
    }
    contacts_direction(m, seed, along, carried);
    for (i = 0; i < MOUNT_FORCES; i++) {
        rotor_carry(i, seed[MOUNT_FORCE + i], carried);
    }
    for (k = 0; k < AXES; k++) {
        const double pull = rotor_shaft(m->value, d, v, k);
        applied[DISC + k] = swing * pointing(angle, k) - pushed * turning(angle, k) + seed[DISC_FORCE + k];
        applied[JOURNAL + k] = seed[JOURNAL_FORCE + k];
        rates[DISC + k] = v[DISC + k];
        rates[JOURNAL + k] = v[JOURNAL + k];
        rates[FREEDOMS + DISC + k] =
            (applied[DISC + k] + pull - m->value[VR_disc_damping] * v[DISC + k]) / m->value[VR_disc_mass];
        rates[FREEDOMS + JOURNAL + k] = (applied[JOURNAL + k] - pull - carried[k]) / m->value[VR_journal_mass];
    }
    rates[2 * FREEDOMS] = seed[VR_speed];
}
