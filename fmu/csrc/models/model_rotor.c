/* A Jeffcott rotor, alone or on its contacts: reduced_models.rotor.jeffcott. The states are those of continuous time:
 * positions, velocities, the angle of the unbalance, and the films of the contacts. Equations in README.md. */
#include <math.h>
#include <string.h>

#include "rotor.h"

static const Fault fine = {FINE, NULL};

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

/* Direction of the unbalance along the axis k that moves; with one axis that is y. */
static double pointing(double angle, int k)
{
    return k + 2 - AXES == 0 ? cos(angle) : sin(angle);
}

double rotor_shaft(const double value[], const double d[], const double v[], int k)
{
    return -value[VR_shaft_stiffness] * (d[DISC + k] - d[JOURNAL + k])
           - value[VR_shaft_damping] * (v[DISC + k] - v[JOURNAL + k]);
}

void rotor_applied(const double value[], const double inputs[], double angle, double applied[])
{
    const double omega = per_rpm * value[VR_speed_rpm], swing = value[VR_unbalance] * omega * omega;
    double carried[AXES] = {0.0};
    int i, k;
    for (i = 0; i < MOUNT_FORCES; i++) {
        rotor_carry(i, inputs[MOUNT_FORCE + i], carried);
    }
    for (k = 0; k < AXES; k++) {
        applied[DISC + k] = rotor_load[DISC + k] + swing * pointing(angle, k) + inputs[DISC_FORCE + k];
        applied[JOURNAL + k] = rotor_load[JOURNAL + k] + inputs[JOURNAL_FORCE + k] - carried[k];
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

Fault model_prepare(Model *m)
{
    const double *value = m->value;
    if (!(value[VR_unbalance] >= 0.0 && isfinite(value[VR_unbalance]))) {
        return fault(REFUSE, "unbalance must be finite and >= 0");
    }
    if (!(value[VR_speed_rpm] >= 0.0 && isfinite(value[VR_speed_rpm]))) {
        return fault(REFUSE, "speed_rpm must be finite and >= 0");
    }
    if (!(value[VR_inner_step] >= LEAST_INNER_STEP && isfinite(value[VR_inner_step]))) {
        return fault(REFUSE, "inner_step must be finite and at least a millionth of its default");
    }
    if (m->cache[READY] == 0.0) {
        m->cache[READY] = 1.0;
        return fault(REFUSE, contacts_start(m));
    }
    return fine;
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
    rates[2 * FREEDOMS] = per_rpm * m->value[VR_speed_rpm];
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
    const double omega = per_rpm * m->value[VR_speed_rpm], unbalance = m->value[VR_unbalance];
    const double swing = seed[VR_unbalance] * omega * omega
                         + 2.0 * unbalance * omega * per_rpm * seed[VR_speed_rpm];
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
        /* a quarter of a turn on, the pointer is its own derivative by the angle */
        const double turned = k + 2 - AXES == 0 ? -sin(angle) : cos(angle);
        const double pull = rotor_shaft(m->value, d, v, k);
        applied[DISC + k] = swing * pointing(angle, k) + unbalance * omega * omega * turned * seed[ANGLE]
                            + seed[DISC_FORCE + k];
        applied[JOURNAL + k] = seed[JOURNAL_FORCE + k];
        rates[DISC + k] = v[DISC + k];
        rates[JOURNAL + k] = v[JOURNAL + k];
        rates[FREEDOMS + DISC + k] =
            (applied[DISC + k] + pull - m->value[VR_disc_damping] * v[DISC + k]) / m->value[VR_disc_mass];
        rates[FREEDOMS + JOURNAL + k] = (applied[JOURNAL + k] - pull - carried[k]) / m->value[VR_journal_mass];
    }
    rates[2 * FREEDOMS] = per_rpm * seed[VR_speed_rpm];
}
