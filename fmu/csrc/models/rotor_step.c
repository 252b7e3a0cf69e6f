/* Steps of a rotor by the generalised-alpha method, everything linear condensed onto the journal: reduced_models.rotor
 * time_step (`Steps`, `steps_of`) and integrate_python. Both axes have the same masses and springs, so that what is a matrix of all
 * degrees of freedom there is one of disc and journal here. */
#include <math.h>
#include <string.h>

#include "rotor.h"

static const double rho = 0.8;             /* spectral radius at infinite frequency, as simulate_rotor has it */
static const double most_steps = 1e6;      /* inner ones in one step of the master */
static const double by_rounding = 1e-9;    /* of an inner step, that a step of the master may be longer */

static const Fault fine = {FINE, NULL};

/* What a step of length h makes of the linear part. */
typedef struct {
    double h, alpha_m, alpha_f, weight;
    double velocity, velocity_0, velocity_a;             /* v' = velocity (d' - d) + velocity_0 v + velocity_a a */
    double acceleration, acceleration_v, acceleration_a; /* a' = acceleration (d' - d) - acceleration_v v - ... a */
    double inverse[2][2];                                /* of the matrix of disc and journal */
    double D;
} Condensed;

static Condensed condense(const double value[], double h)
{
    const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0);
    const double gamma = 0.5 - alpha_m + alpha_f, ratio = 1.0 - alpha_m + alpha_f, beta = 0.25 * ratio * ratio;
    double inertia, spring, disc, journal, per_det;
    Condensed c;
    c.h = h;
    c.alpha_m = alpha_m;
    c.alpha_f = alpha_f;
    c.weight = 1.0 - alpha_f;
    c.velocity = gamma / (beta * h);
    c.velocity_0 = 1.0 - gamma / beta;
    c.velocity_a = h * (1.0 - 0.5 * gamma / beta);
    c.acceleration = 1.0 / (beta * h * h);
    c.acceleration_v = c.acceleration * h;
    c.acceleration_a = 0.5 / beta - 1.0;
    inertia = (1.0 - alpha_m) * c.acceleration;
    spring = c.weight * (c.velocity * value[VR_shaft_damping] + value[VR_shaft_stiffness]);
    disc = inertia * value[VR_disc_mass] + c.weight * c.velocity * value[VR_disc_damping];
    journal = inertia * value[VR_journal_mass];
    per_det = 1.0 / (disc * journal + spring * (disc + journal)); /* nothing cancels */
    c.inverse[0][0] = (journal + spring) * per_det;
    c.inverse[0][1] = c.inverse[1][0] = spring * per_det;
    c.inverse[1][1] = (disc + spring) * per_det;
    c.D = 1.0 / c.inverse[1][1];
    return c;
}

/* Force of shaft and dampers on disc and journal along an axis. */
static void pulled(const double value[], const double d[], const double v[], int k, double force[2])
{
    const double pull = rotor_shaft(value, d, v, k);
    force[0] = pull - value[VR_disc_damping] * v[DISC + k];
    force[1] = -pull;
}

/* Size of the forces at work: what an imbalance is measured by. */
static double size_of(const double value[], const double applied[], const double carried[])
{
    double most = 0.0;
    int k;
    for (k = 0; k < AXES; k++) {
        const double shaft = value[VR_shaft_stiffness] * (value[POSITION + DISC + k] - value[POSITION + JOURNAL + k]);
        most = fmax(most, fmax(fabs(shaft), fabs(carried[k])));
        most = fmax(most, fmax(fabs(applied[DISC + k]), fabs(applied[JOURNAL + k])));
    }
    return most;
}

/* One step to the applied forces at its end; states, accelerations and contacts go there. */
static const char *advance(Model *m, const Condensed *c, const double applied[])
{
    double *value = m->value, *d = &value[POSITION], *v = &value[VELOCITY];
    double *a = &m->cache[ACCELERATION], *before = &m->cache[APPLIED], *carried = &m->cache[CARRIED];
    double free[FREEDOMS], v_history[FREEDOMS], a_history[FREEDOMS], q[AXES], now_carried[AXES];
    Balance balance;
    const char *reason;
    int i, k;
    for (i = 0; i < FREEDOMS; i++) {
        v_history[i] = -c->velocity * d[i] + c->velocity_0 * v[i] + c->velocity_a * a[i];
        a_history[i] = -c->acceleration * d[i] - c->acceleration_v * v[i] - c->acceleration_a * a[i];
    }
    for (k = 0; k < AXES; k++) {
        static const double nowhere[FREEDOMS] = {0.0};
        const double masses[2] = {value[VR_disc_mass], value[VR_journal_mass]};
        double late[2], soon[2], right[2];
        pulled(value, d, v, k, late);
        pulled(value, nowhere, v_history, k, soon);
        late[1] -= carried[k];
        for (i = 0; i < 2; i++) {
            const int f = i * AXES + k;
            right[i] = c->weight * (applied[f] + soon[i]) + c->alpha_f * (before[f] + late[i])
                       - masses[i] * (c->alpha_m * a[f] + (1.0 - c->alpha_m) * a_history[f]);
        }
        free[DISC + k] = c->inverse[0][0] * right[0] + c->inverse[0][1] * right[1];
        free[JOURNAL + k] = c->inverse[1][0] * right[0] + c->inverse[1][1] * right[1];
        balance.free[k] = free[JOURNAL + k];
        balance.history[k] = v_history[JOURNAL + k];
        q[k] = d[JOURNAL + k] + c->h * (v[JOURNAL + k] + 0.5 * c->h * a[JOURNAL + k]);
    }
    balance.D = c->D;
    balance.weight = c->weight;
    balance.gain = c->velocity;
    balance.load = size_of(value, applied, carried);
    reason = contacts_balance(m, &balance, c->h, q, now_carried);
    if (reason != NULL) {
        return reason;
    }
    for (k = 0; k < AXES; k++) {
        const double moved = c->D * (q[k] - free[JOURNAL + k]);
        d[DISC + k] = free[DISC + k] + c->inverse[0][1] * moved;
        d[JOURNAL + k] = q[k];
        carried[k] = now_carried[k];
    }
    for (i = 0; i < FREEDOMS; i++) {
        v[i] = c->velocity * d[i] + v_history[i];
        a[i] = c->acceleration * d[i] + a_history[i];
        before[i] = applied[i];
        if (!(isfinite(d[i]) && isfinite(v[i]) && isfinite(a[i]))) {
            return "the motion is too large for a floating-point number";
        }
    }
    return rotor_mounts(m);
}

/* Inputs at a time t within a step, of which `end` is the last. */
static void inputs_at(const Motion *motion, double t, int end, double inputs[])
{
    int k;
    for (k = 0; k < N_INPUTS; k++) {
        const Path *p = &motion->input[k];
        inputs[k] = end ? p->end : p->start + t * (p->slope + 0.5 * t * p->bend);
    }
}

/* Accelerations at the start of a step. They go on from the last one, but for the jump of the applied forces. */
static void begin(Model *m, const Motion *motion)
{
    const double *value = m->value;
    double *a = &m->cache[ACCELERATION], *before = &m->cache[APPLIED], *carried = &m->cache[CARRIED];
    double inputs[N_INPUTS], applied[FREEDOMS];
    int k;
    inputs_at(motion, 0.0, 0, inputs);
    rotor_applied(value, inputs, value[ANGLE], applied);
    if (m->cache[MOVING] == 0.0) {
        contacts_carried(value, carried);
        rotor_accelerations(value, applied, carried, a);
    } else {
        for (k = 0; k < AXES; k++) {
            a[DISC + k] += (applied[DISC + k] - before[DISC + k]) / value[VR_disc_mass];
            a[JOURNAL + k] += (applied[JOURNAL + k] - before[JOURNAL + k]) / value[VR_journal_mass];
        }
    }
    memcpy(before, applied, sizeof applied);
    m->cache[MOVING] = 1.0;
}

/* Adds to the angle, which must not lose a little in every step. */
static void turn(Model *m, double by)
{
    const double old = m->value[ANGLE], more = by + m->cache[ANGLE_REST];
    m->value[ANGLE] = old + more;
    m->cache[ANGLE_REST] = more - (m->value[ANGLE] - old);
}

/* Longest step inside one. The start value of inner_step resolves the shaft of the export; where another has been set whose
 * vibration against the journal is faster, it is resolved as well. */
static double longest_step(const double value[])
{
    const double omega = sqrt(value[VR_shaft_stiffness] * (1.0 / value[VR_disc_mass] + 1.0 / value[VR_journal_mass]));
    const double given = value[VR_inner_step];
    return given == DEFAULT_INNER_STEP ? fmin(given, SHAFT_STEP / omega) : given;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    const double count = ceil(h / longest_step(m->value) - by_rounding);
    double inputs[N_INPUTS], applied[FREEDOMS];
    double omega = motion->input[VR_speed].start;
    Model next = *m;
    Condensed c;
    int i, steps;
    (void)tolerance; /* inner_step decides */
    if (!(count <= most_steps)) {
        return fault(DISCARD, "more than a million inner steps: take a shorter step, or a longer inner_step");
    }
    steps = count > 1.0 ? (int)count : 1;
    c = condense(m->value, h / steps);
    if (!(isfinite(c.acceleration) && isfinite(c.D))) {
        return fault(REFUSE, "the step size is too small for the rotor");
    }
    begin(&next, motion);
    for (i = 1; i <= steps; i++) {
        const char *reason;
        inputs_at(motion, i * c.h, i == steps, inputs);
        turn(&next, 0.5 * c.h * (omega + inputs[VR_speed]));
        omega = inputs[VR_speed];
        rotor_applied(next.value, inputs, next.value[ANGLE], applied);
        reason = advance(&next, &c, applied);
        if (reason != NULL) {
            return fault(DISCARD, reason);
        }
    }
    memcpy(next.input, inputs, sizeof inputs);
    *m = next;
    return fine;
}
