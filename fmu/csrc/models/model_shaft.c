/* A shaft in its modes at standstill, each of mass 1: forces of its bearings in, motions at them out. Equations in README.md. */
#include <math.h>
#include <string.h>

#include "model.h"
#include "shaft_data.h"

/* Places in the cache. */
enum { SHAPE = 0, RATE = MODES, ANGLE = 2 * MODES, SPEED, ANGLE_REST, MOVING };

static const Fault fine = {FINE, NULL};

/* A mode after a step of h: of its place q, rate v and held force f
 *     q' = (1 - k p) q + s v + p f,   v' = -k s q + c v + s f,
 * of y'' + 2 d y' + k y = 0, y(0) = 0, y'(0) = 1: s = y(h), c = y'(h), p the integral of y. */
typedef struct {
    double k, p, s, c;
} Mode;

/* By power series in steps that are short for it, which are then doubled. */
static Mode mode_step(double k, double d, double h)
{
    Mode m = {k, 0.0, 0.0, 1.0};
    int doublings = 0, n;
    double before = 0.0, here = 1.0, power = 1.0;
    while ((sqrt(k) + 2.0 * d) * h > 1.0) {
        h *= 0.5;
        doublings++;
    }
    for (n = 1; n < 24; n++) { /* y = sum of here_n h^n */
        const double next = -(2.0 * d * n * here + k * before) / ((n + 1.0) * n);
        power *= h;
        m.s += here * power;
        m.p += here * power * h / (n + 1.0);
        m.c += (n + 1.0) * next * power;
        before = here;
        here = next;
    }
    for (; doublings > 0; doublings--) {
        const double p = m.p, s = m.s, c = m.c;
        m.p = (1.0 - k * p) * p + s * s + p;
        m.s = (1.0 - k * p) * s + s * c;
        m.c = c * c - k * s * s;
    }
    return m;
}

/* Modes that a step does not resolve are damped critically at least: they follow their forces. */
static void mode_steps(const double value[], double h, Mode modes[])
{
    const double mass = value[VR_mass_scale];
    int i;
    for (i = 0; i < MODES; i++) {
        const double k = value[VR_stiffness_scale] * modal_stiffness[i] / mass, omega = sqrt(k);
        double d = 0.5 * value[VR_damping_scale] * modal_damping[i][i] / mass;
        if (omega * h > RESOLVED && d < omega) {
            d = omega;
        }
        modes[i] = mode_step(k, d, h);
    }
}

/* ---- forces ---- */

/* Load and forces of the bearings, held over the step. */
static void held_forces(const double value[], const double inputs[], double force[])
{
    int i, j;
    for (i = 0; i < MODES; i++) {
        force[i] = value[VR_load_scale] * modal_load[i];
        for (j = 0; j < PORTS; j++) {
            force[i] += inputs[j] * row_modes[j][i];
        }
    }
}

/* Unbalances at an angle; `slowed`: the torque that their accelerations take from the shaft. */
static void add_unbalances(const double inputs[], double angle, double omega, double alpha, const double gain[], double h,
                           double force[], double *slowed)
{
#if UNBALANCES > 0
    int u, i;
    for (u = 0; u < UNBALANCES; u++) {
        const double *x = unbalance_modes[2 * u], *y = unbalance_modes[2 * u + 1], amount = inputs[FIRST_UNBALANCE + u];
        const double c = cos(angle + unbalance_phase[u]), s = sin(angle + unbalance_phase[u]);
        const double fx = amount * (omega * omega * c + alpha * s), fy = amount * (omega * omega * s - alpha * c);
        double ax = 0.0, ay = 0.0;
        for (i = 0; i < MODES; i++) {
            force[i] += fx * x[i] + fy * y[i];
            ax += gain[i] / h * x[i];
            ay += gain[i] / h * y[i];
        }
        *slowed += amount * (ay * c - ax * s);
    }
#else
    (void)inputs, (void)angle, (void)omega, (void)alpha, (void)gain, (void)h, (void)force, (void)slowed;
#endif
}

/* Gyroscopic forces and those of damping between modes at the mean rates of the step: the former do no work over it, the
 * latter take some out. */
static void add_coupling(const double value[], double omega, const double drift[], double force[])
{
    int i, j;
    for (i = 0; i < MODES; i++) {
        for (j = 0; j < MODES; j++) {
            const double damping = i == j ? 0.0 : value[VR_damping_scale] * modal_damping[i][j];
            force[i] -= (damping + value[VR_mass_scale] * omega * modal_gyroscopic[i][j]) * drift[j];
        }
    }
}

/* Angular acceleration over a step. Torques of bearings act against the turning, and hold a shaft that stands. */
static double spin(const double value[], const double inputs[], double omega, double slowed, double h)
{
#if HAS_TORQUE
    const double drive = inputs[FIRST_DRIVE] - slowed, inertia = value[VR_mass_scale] * value[VR_inertia];
    double drag = 0.0, end;
    int b;
    for (b = 1; b <= BEARINGS; b++) {
        drag += inputs[FIRST_DRIVE + b];
    }
    end = omega + h * (drive - (omega > 0.0 || (omega == 0.0 && drive > 0.0) ? drag : -drag)) / inertia;
    if (fabs(drive) <= drag && end * omega <= 0.0) {
        end = 0.0;
    }
    return (end - omega) / h;
#else
    (void)value, (void)slowed;
    return (inputs[FIRST_DRIVE] - omega) / h;
#endif
}

/* ---- outputs ---- */

static const char *show(Model *m)
{
    int i, j;
    for (j = 0; j < ROWS; j++) {
        double place = row_shift[j], velocity = 0.0;
        for (i = 0; i < MODES; i++) {
            place += row_modes[j][i] * m->cache[SHAPE + i];
            velocity += row_modes[j][i] * m->cache[RATE + i];
        }
        if (!(isfinite(place) && isfinite(velocity))) {
            return "the motion is too large for a floating-point number";
        }
        m->value[FIRST_PLACE + j] = place;
        m->value[FIRST_VELOCITY + j] = velocity;
    }
    m->value[VR_angle] = m->cache[ANGLE];
#if HAS_TORQUE
    m->value[VR_speed] = m->cache[SPEED];
#endif
    return isfinite(m->cache[ANGLE]) && isfinite(m->cache[SPEED]) ? NULL : "the speed is too large for a floating-point number";
}

static const char *check(const double value[])
{
    if (!(value[VR_mass_scale] > 0.0 && isfinite(value[VR_mass_scale]))) {
        return "mass_scale must be finite and > 0";
    }
    if (!(value[VR_stiffness_scale] >= 0.0 && value[VR_damping_scale] >= 0.0 && isfinite(value[VR_stiffness_scale])
          && isfinite(value[VR_damping_scale]) && isfinite(value[VR_load_scale]))) {
        return "stiffness_scale, damping_scale and load_scale must be finite, the first two >= 0";
    }
#if HAS_TORQUE
    if (!(value[VR_inertia] > 0.0 && isfinite(value[VR_inertia]) && isfinite(value[VR_speed_start]))) {
        return "inertia must be finite and > 0, and speed_start finite";
    }
#endif
    return NULL;
}

/* ---- the interface of the core ---- */

Fault model_prepare(Model *m)
{
    (void)m;
    return fine;
}

/* Before the first step where it starts; later, outputs are those of the last step, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    Model next = *m;
    const char *reason;
    if (m->cache[MOVING] != 0.0) {
        return fine;
    }
    reason = check(m->value);
    if (reason == NULL) {
        memcpy(&next.cache[SHAPE], modal_start, sizeof modal_start);
#if HAS_TORQUE
        next.cache[SPEED] = m->value[VR_speed_start];
#else
        next.cache[SPEED] = m->input[FIRST_DRIVE];
#endif
        reason = show(&next);
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    *m = next;
    return fine;
}

Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}

/* Mean rates of the modes, and the angular acceleration, until forces that depend on them agree. */
Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    enum { MOST = 60 };
    static const double rounding = 1e-13;
    Model next = *m;
    const double *value = m->value, *q = &m->cache[SHAPE], *v = &m->cache[RATE], omega = m->cache[SPEED];
    double inputs[N_INPUTS], held[MODES], force[MODES], drift[MODES], gain[MODES], change = 1.0, size = 0.0, alpha = 0.0, turned;
    Mode modes[MODES];
    const char *reason;
    int i, n;
    (void)tolerance;
    for (i = 0; i < N_INPUTS; i++) {
        inputs[i] = 0.5 * (motion->input[i].start + motion->input[i].end);
    }
#if !HAS_TORQUE
    inputs[FIRST_DRIVE] = motion->input[FIRST_DRIVE].end;
#endif
    mode_steps(value, h, modes);
    held_forces(value, inputs, held);
    memcpy(drift, v, sizeof drift);
    memset(gain, 0, sizeof gain);
    for (n = 0; n < MOST && change > rounding * size; n++) {
        const double middle = omega + 0.5 * h * alpha, angle = m->cache[ANGLE] + 0.5 * h * (omega + 0.25 * h * alpha);
        double slowed = 0.0;
        memcpy(force, held, sizeof force);
        add_unbalances(inputs, angle, middle, alpha, gain, h, force, &slowed);
        add_coupling(value, middle, drift, force);
        change = size = 0.0;
        for (i = 0; i < MODES; i++) {
            const Mode *o = &modes[i];
            const double f = force[i] / value[VR_mass_scale];
            const double mean = (o->s * v[i] + o->p * (f - o->k * q[i])) / h;
            gain[i] = (o->c - 1.0) * v[i] + o->s * (f - o->k * q[i]);
            change = fmax(change, fabs(mean - drift[i]));
            size = fmax(size, fabs(o->s * v[i] / h) + o->p / h * (fabs(f) + fabs(o->k * q[i])));
            drift[i] = mean;
        }
        alpha = spin(value, inputs, omega, slowed, h);
    }
    if (!(change <= rounding * size)) {
        return fault(DISCARD, "the step is too long for the gyroscopic forces, or for the damping between modes");
    }
    for (i = 0; i < MODES; i++) {
        next.cache[SHAPE + i] = q[i] + h * drift[i];
        next.cache[RATE + i] = v[i] + gain[i];
    }
    turned = h * (omega + 0.5 * h * alpha) + m->cache[ANGLE_REST];
    next.cache[ANGLE] = m->cache[ANGLE] + turned; /* which must not lose a little in every step */
    next.cache[ANGLE_REST] = turned - (next.cache[ANGLE] - m->cache[ANGLE]);
    next.cache[SPEED] = omega + h * alpha;
    next.cache[MOVING] = 1.0;
    for (i = 0; i < N_INPUTS; i++) {
        next.input[i] = motion->input[i].end;
    }
    reason = show(&next);
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    *m = next;
    return fine;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    (void)m, (void)seed, (void)along;
}

unsigned long long model_outside(const Model *m)
{
    (void)m;
    return 0;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    (void)m, (void)which;
    if (size > 0) {
        text[0] = '\0';
    }
}
