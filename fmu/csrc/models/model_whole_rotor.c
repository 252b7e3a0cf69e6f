/* A rotor on ball bearings: reduced_models.rotor. Steps are those of `simulate_rotor` (time_step, integrate_compiled): everything linear is
 * condensed onto the points at which bearings act, and Newton's method balances these. Equations in README.md. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bearing.h"
#include "linear_equations.h"
#include "model.h"
#include "rotor_data.h"
#include "rotor_laws.h"

enum { DIRECTIONS = MOTIONS / BEARINGS }; /* of the motion of a ring */

/* Places in the cache: displacements, velocities and accelerations; the points at the ends of the last three steps, the newest
 * first; forces on balls and applied forces at the end of the last one; the shaft; torques that resisted it at the last two; the
 * bearings' own numbers. */
enum {
    PLACE,
    VELOCITY = PLACE + FREEDOMS,
    ACCELERATION = VELOCITY + FREEDOMS,
    WAS = ACCELERATION + FREEDOMS,
    CARRIED = WAS + 3 * POINTS,
    APPLIED = CARRIED + POINTS,
    ANGLE = APPLIED + FREEDOMS,
    ANGLE_REST,
    SPEED,
    SPIN, /* angular acceleration */
    RESISTED,
    MOVING = RESISTED + 2,
    OWED, /* time of steps so short that the next one takes it */
    LAWS
};

static const double rho = 0.8;          /* spectral radius at infinite frequency, as simulate_rotor has it */
static const double most_steps = 1e6;   /* inner ones in one step of the master */
static const double shortest = 1e-4;    /* step, over an inner one: rounding of the forces is that large in a shorter one's accelerations */
static const double by_rounding = 1e-9; /* of an inner step, that a step of the master may be longer */
static const double balanced = 1e-10;   /* imbalance over the forces at work */
static const double epsilon = 1e-15;    /* rounding of a sum of forces */
static const double overshoot = 2.0;    /* growth of the imbalance that halves the way to the last place: a ball lands or leaves */
static const double open = 1.0;         /* N/m, in equilibrium beside the slopes of bearings that hold nothing in some direction */

static const Fault fine = {FINE, NULL};
static const char *const no_number = "the motion is too large for a floating-point number";

/* Work of all bearings in a step, and their forces on the points with the slopes by their places. */
typedef struct {
    double work[LAW_WORK];
    double omega, ring[MOTIONS], carried[POINTS], slopes[POINTS][POINTS];
} Carrying;

/* ---- forces ---- */

static double product(const double row[], const double x[], int n)
{
    double sum = 0.0;
    int k;
    for (k = 0; k < n; k++) {
        sum += row[k] * x[k];
    }
    return sum;
}

static double damping(const double value[], double omega, int i, int k)
{
    return value[VR_damping_scale] * damping_matrix[i][k] + value[VR_mass_scale] * omega * gyroscopic_matrix[i][k];
}

/* Takes `weight` times the forces on the points from forces on the rotor. */
static void take(const double carried[POINTS], double weight, double force[FREEDOMS])
{
    int i, j;
    for (j = 0; j < POINTS; j++) {
        for (i = 0; i < FREEDOMS; i++) {
            force[i] -= weight * carried[j] * points[j][i];
        }
    }
}

/* Load, forces that are given, and those of the unbalances. */
static void applied(const double value[], const double inputs[], double angle, double omega, double spin, double force[FREEDOMS])
{
    int i, u;
    for (i = 0; i < FREEDOMS; i++) {
        force[i] = value[VR_load_scale] * load[i];
    }
    for (i = 0; i < SHOWN; i++) {
        force[shown[i]] += inputs[i];
    }
    for (u = 0; u < UNBALANCES; u++) {
        const double c = cos(angle + unbalance_phase[u]), s = sin(angle + unbalance_phase[u]);
        const double amount = inputs[FIRST_UNBALANCE + u];
        const int x = unbalance_at[u][0], y = unbalance_at[u][1];
        if (x >= 0) {
            force[x] += amount * (omega * omega * c + spin * s);
        }
        if (y >= 0) {
            force[y] += amount * (omega * omega * s - spin * c);
        }
    }
}

/* ---- bearings ---- */

static const char *start_bearings(Model *m)
{
    const char *reason = NULL;
    int b;
    for (b = 0; b < BEARINGS && reason == NULL; b++) {
        const int *at = law_settings[b];
        BearingSettings settings;
        settings.clearance = at[0] < 0 ? 0.0 : m->value[at[0]];
        settings.offset = at[1] < 0 ? 0.0 : m->value[at[1]];
        settings.cage_angle = m->value[at[2]];
        settings.film = m->value[at[3]];
        reason = bearing_start(law_of[b], &settings, &m->cache[LAWS + law_numbers[b]]);
    }
    return reason;
}

static void begin_bearings(const Model *m, Carrying *c, double h, double omega)
{
    int b;
    c->omega = omega;
    for (b = 0; b < BEARINGS; b++) {
        bearing_begin(law_of[b], &m->cache[LAWS + law_numbers[b]], &c->work[law_work[b]], h, omega);
    }
}

static double ring_of(int motion, const double of_points[POINTS], const double shift[])
{
    return product(ties[motion], of_points, POINTS) + (shift == NULL ? 0.0 : shift[motion]);
}

/* Forces with the points at r, moving at v. */
static const char *press(const Model *m, Carrying *c, const double r[POINTS], const double v[POINTS])
{
    double q[MOTIONS], rate[MOTIONS];
    int b, i, j;
    memset(c->carried, 0, sizeof c->carried);
    for (i = 0; i < MOTIONS; i++) {
        q[i] = ring_of(i, r, ring_shift);
        rate[i] = ring_of(i, v, NULL);
    }
    for (b = 0; b < BEARINGS; b++) {
        const int first = b * DIRECTIONS;
        const double *state = &m->cache[LAWS + law_numbers[b]];
        const char *reason = bearing_press(law_of[b], state, &c->work[law_work[b]], &q[first], &rate[first], &c->ring[first]);
        if (reason != NULL) {
            return reason;
        }
    }
    for (i = 0; i < MOTIONS; i++) {
        for (j = 0; j < POINTS; j++) {
            c->carried[j] += ties[i][j] * c->ring[i];
        }
    }
    return NULL;
}

/* d(force)/dr there, where v changes by `gain` as much. */
static void find_slopes(Carrying *c, double gain)
{
    double stiffness[DIRECTIONS * DIRECTIONS], damped[DIRECTIONS * DIRECTIONS];
    int b, i, j, k, l;
    memset(c->slopes, 0, sizeof c->slopes);
    for (b = 0; b < BEARINGS; b++) {
        const int first = b * DIRECTIONS;
        bearing_slopes(law_of[b], &c->work[law_work[b]], stiffness, damped);
        for (i = 0; i < DIRECTIONS; i++) {
            for (j = 0; j < POINTS; j++) {
                const double tie = ties[first + i][j];
                for (k = 0; k < DIRECTIONS && tie != 0.0; k++) {
                    const double slope = tie * (stiffness[i * DIRECTIONS + k] + gain * damped[i * DIRECTIONS + k]);
                    for (l = 0; l < POINTS; l++) {
                        c->slopes[j][l] += slope * ties[first + k][l];
                    }
                }
            }
        }
    }
}

/* Moves the bearings to where they were pressed last, with the points at r; shows them. */
static const char *accept(Model *m, Carrying *c, const double r[POINTS])
{
    double q[MOTIONS];
    int b, i;
    for (i = 0; i < MOTIONS; i++) {
        q[i] = ring_of(i, r, ring_shift);
    }
    memmove(&m->cache[RESISTED + 1], &m->cache[RESISTED], sizeof m->cache[0]);
    m->cache[RESISTED] = 0.0;
    for (b = 0; b < BEARINGS; b++) {
        double *own = &m->cache[LAWS + law_numbers[b]];
        const char *reason = bearing_check(law_of[b], &q[b * DIRECTIONS], c->omega);
        BallOutputs balls[MOST_BALLS];
        if (reason != NULL) {
            return reason;
        }
        bearing_accept(law_of[b], own, &c->work[law_work[b]]);
        bearing_outputs_of_step(law_of[b], own, balls, &m->value[law_shown_at[b]]);
        m->cache[RESISTED] += bearing_torque(law_of[b], &m->value[law_shown_at[b]]);
    }
    memcpy(&m->cache[CARRIED], c->carried, sizeof c->carried);
    return NULL;
}

/* ---- the shaft ---- */

/* Torque that the unbalances take from the shaft, through their accelerations. */
static double slowed(const Model *m)
{
    const double *a = &m->cache[ACCELERATION];
    double sum = 0.0;
    int u;
    for (u = 0; u < UNBALANCES; u++) {
        const double c = cos(m->cache[ANGLE] + unbalance_phase[u]), s = sin(m->cache[ANGLE] + unbalance_phase[u]);
        const int x = unbalance_at[u][0], y = unbalance_at[u][1];
        sum += m->input[FIRST_UNBALANCE + u] * ((y >= 0 ? a[y] * c : 0.0) - (x >= 0 ? a[x] * s : 0.0));
    }
    return sum;
}

/* Angular acceleration in a step of length h. What resists goes on as in the last two steps; a shaft does not turn backwards. */
static double spin_of(const Model *m, const double inputs[], double torque, double h)
{
    const double omega = m->cache[SPEED];
#if HAS_TORQUE
    const double resisted = 1.5 * m->cache[RESISTED] - 0.5 * m->cache[RESISTED + 1];
    (void)inputs;
    return fmax((torque - resisted) / (m->value[VR_mass_scale] * m->value[VR_inertia]), -omega / h);
#else
    (void)torque;
    return (inputs[VR_speed] - omega) / h;
#endif
}

/* Adds to the angle, which must not lose a little in every step. */
static void turn(Model *m, double by)
{
    const double old = m->cache[ANGLE], more = by + m->cache[ANGLE_REST];
    m->cache[ANGLE] = old + more;
    m->cache[ANGLE_REST] = more - (m->cache[ANGLE] - old);
}

/* ---- outputs ---- */

static const char *show(Model *m)
{
    const double *place = &m->cache[PLACE], *velocity = &m->cache[VELOCITY];
    double *value = m->value, r[POINTS], v[POINTS];
    int b, i, outside = 0;
    for (i = 0; i < FREEDOMS; i++) {
        if (!(isfinite(place[i]) && isfinite(velocity[i]) && isfinite(m->cache[ACCELERATION + i]))) {
            return no_number;
        }
    }
    for (i = 0; i < SHOWN; i++) {
        value[FIRST_PLACE + i] = place[shown[i]];
        value[FIRST_VELOCITY + i] = velocity[shown[i]];
    }
    for (i = 0; i < POINTS; i++) {
        r[i] = product(points[i], place, FREEDOMS);
        v[i] = product(points[i], velocity, FREEDOMS);
    }
    for (i = 0; i < MOTIONS; i++) {
        value[FIRST_PLACE + SHOWN + i] = ring_of(i, r, ring_shift);
        value[FIRST_VELOCITY + SHOWN + i] = ring_of(i, v, NULL);
    }
    for (b = 0; b < BEARINGS; b++) {
        outside |= value[law_outside[b]] != 0.0;
    }
    value[VR_outside_validity] = outside;
    value[VR_angle] = m->cache[ANGLE];
#if HAS_TORQUE
    value[VR_speed] = m->cache[SPEED];
#endif
    return isfinite(m->cache[ANGLE]) && isfinite(m->cache[SPEED]) ? NULL : "the speed is too large for a floating-point number";
}

/* ---- the start: equilibrium under the load ---- */

/* Bearings at rest with the rotor at q, and what they and its stiffness exert on it beyond the load. */
static const char *rest_at(Model *m, Carrying *c, const double q[], double off[], double *size)
{
    static const double still[POINTS] = {0.0};
    double r[POINTS];
    const char *reason = start_bearings(m);
    int i, b;
    for (i = 0; i < POINTS; i++) {
        r[i] = product(points[i], q, FREEDOMS);
    }
    for (b = 0; b < BEARINGS && reason == NULL; b++) {
        double ring[DIRECTIONS], force[DIRECTIONS];
        for (i = 0; i < DIRECTIONS; i++) {
            ring[i] = ring_of(b * DIRECTIONS + i, r, ring_shift);
        }
        reason = bearing_rest(law_of[b], &m->cache[LAWS + law_numbers[b]], &c->work[law_work[b]], m->cache[SPEED], ring, force);
    }
    if (reason == NULL) { /* once more, for the forces on the points */
        begin_bearings(m, c, 0.0, m->cache[SPEED]);
        reason = press(m, c, r, still);
    }
    if (reason == NULL) {
        reason = accept(m, c, r);
    }
    if (reason != NULL) {
        return reason;
    }
    for (i = 0; i < FREEDOMS; i++) {
        off[i] = m->value[VR_stiffness_scale] * product(stiffness_matrix[i], q, FREEDOMS) - m->value[VR_load_scale] * load[i];
    }
    take(c->carried, -1.0, off);
    *size = sqrt(product(off, off, FREEDOMS));
    return isfinite(*size) ? NULL : no_number;
}

static const char *newton_of_rest(const Model *m, Carrying *c, const double off[], double step[])
{
    double slopes[FREEDOMS * FREEDOMS], more;
    int pivot[FREEDOMS], i, j, k, l;
    find_slopes(c, 0.0);
    for (i = 0; i < FREEDOMS; i++) {
        step[i] = -off[i];
        for (k = 0; k < FREEDOMS; k++) {
            slopes[i * FREEDOMS + k] = m->value[VR_stiffness_scale] * stiffness_matrix[i][k];
        }
    }
    for (j = 0; j < POINTS; j++) {
        for (l = 0; l < POINTS; l++) {
            more = c->slopes[j][l] + (j == l ? open : 0.0);
            for (i = 0; i < FREEDOMS; i++) {
                for (k = 0; k < FREEDOMS && points[j][i] != 0.0; k++) {
                    slopes[i * FREEDOMS + k] += points[j][i] * more * points[l][k];
                }
            }
        }
    }
    if (!factorise(FREEDOMS, slopes, pivot)) {
        return "nothing holds the rotor in some direction";
    }
    substitute(FREEDOMS, slopes, pivot, step);
    return NULL;
}

static const char *find_rest(Model *m)
{
    enum { MOST = 60, HALVINGS = 30 };
    const double allowed = 1e-10, by_rounding_of_rest = 10.0;
    const double most = allowed * fmax(1.0, fabs(m->value[VR_load_scale]) * sqrt(product(load, load, FREEDOMS)));
    double off[FREEDOMS], step[FREEDOMS], tried[FREEDOMS], size, now, *q = &m->cache[PLACE];
    Carrying c;
    const char *reason;
    int i, k, n;
    memcpy(q, rest, sizeof rest);
    memset(&m->cache[VELOCITY], 0, 2 * FREEDOMS * sizeof q[0]);
    reason = rest_at(m, &c, q, off, &size);
    for (n = 0; n < MOST && reason == NULL && !(size <= most); n++) {
        reason = newton_of_rest(m, &c, off, step);
        now = HUGE_VAL;
        for (k = 0; k < HALVINGS && reason == NULL && !(now < size); k++) {
            for (i = 0; i < FREEDOMS; i++) {
                tried[i] = q[i] + step[i];
                step[i] *= 0.5;
            }
            if (rest_at(m, &c, tried, off, &now) != NULL) {
                now = HUGE_VAL;
            }
        }
        if (!(now < size)) {
            break;
        }
        memcpy(q, tried, sizeof tried);
        size = now;
    }
    if (reason == NULL && !(size <= by_rounding_of_rest * most)) {
        reason = "no equilibrium under this load with these parameters";
    }
    if (reason != NULL) {
        return reason;
    }
    for (i = 0; i < POINTS; i++) {
        m->cache[WAS + i] = m->cache[WAS + POINTS + i] = m->cache[WAS + 2 * POINTS + i] = product(points[i], q, FREEDOMS);
    }
    reason = rest_at(m, &c, q, off, &size);
    m->cache[RESISTED + 1] = m->cache[RESISTED];
    return reason;
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
    if (!(value[VR_inner_step] >= LEAST_INNER_STEP && isfinite(value[VR_inner_step]))) {
        return "inner_step must be finite, and at least a thousandth of its start value";
    }
#if HAS_TORQUE
    if (!(value[VR_inertia] > 0.0 && isfinite(value[VR_inertia]) && value[VR_speed_start] >= 0.0)) {
        return "inertia must be finite and > 0, and speed_start >= 0";
    }
#endif
    return NULL;
}

/* ---- the interface of the core ---- */

Fault model_prepare(Model *m)
{
    return fault(REFUSE, check(m->value));
}

/* Before the first step at rest; later, outputs are those of the last step, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    Model next = *m;
    const char *reason;
    if (m->cache[MOVING] != 0.0) {
        return fine;
    }
#if HAS_TORQUE
    next.cache[SPEED] = m->value[VR_speed_start];
#else
    next.cache[SPEED] = m->input[VR_speed];
#endif
    reason = find_rest(&next);
    if (reason == NULL) {
        reason = show(&next);
    }
    if (reason == NULL) {
        *m = next;
    }
    return fault(DISCARD, reason);
}

Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}

/* ---- steps ---- */

/* What a step of length h at a speed makes of the linear part: see time_step.py. */
typedef struct {
    double h, omega, alpha_m, alpha_f, weight;
    double velocity[4], acceleration[4]; /* gain, then what place, velocity and acceleration at the start make of them at the end */
    double system[FREEDOMS * FREEDOMS];  /* factors */
    double columns[POINTS][FREEDOMS], D[POINTS][POINTS];
    int pivot[FREEDOMS];
} Condensed;

static const char *condense(const double value[], double h, double omega, Condensed *c)
{
    const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0);
    const double gamma = 0.5 - alpha_m + alpha_f, twice = 1.0 - alpha_m + alpha_f, beta = 0.25 * twice * twice, ratio = gamma / beta;
    double flexibility[POINTS * POINTS];
    int pivot[POINTS], i, j, k;
    c->h = h;
    c->omega = omega;
    c->alpha_m = alpha_m;
    c->alpha_f = alpha_f;
    c->weight = 1.0 - alpha_f;
    c->velocity[0] = ratio / h;
    c->velocity[1] = -c->velocity[0];
    c->velocity[2] = 1.0 - ratio;
    c->velocity[3] = h * (1.0 - 0.5 * ratio);
    c->acceleration[0] = 1.0 / (beta * h * h);
    c->acceleration[1] = -c->acceleration[0];
    c->acceleration[2] = -1.0 / (beta * h);
    c->acceleration[3] = 1.0 - 0.5 / beta;
    for (i = 0; i < FREEDOMS; i++) {
        for (k = 0; k < FREEDOMS; k++) {
            c->system[i * FREEDOMS + k] = (1.0 - alpha_m) * c->acceleration[0] * value[VR_mass_scale] * mass_matrix[i][k]
                                          + c->weight * (c->velocity[0] * damping(value, omega, i, k)
                                                         + value[VR_stiffness_scale] * stiffness_matrix[i][k]);
        }
    }
    if (!isfinite(c->acceleration[0]) || !factorise(FREEDOMS, c->system, c->pivot)) {
        return "the step size is too small for the rotor";
    }
    for (j = 0; j < POINTS; j++) {
        memcpy(c->columns[j], points[j], sizeof c->columns[j]);
        substitute(FREEDOMS, c->system, c->pivot, c->columns[j]);
    }
    for (i = 0; i < POINTS; i++) {
        for (j = 0; j < POINTS; j++) {
            flexibility[i * POINTS + j] = product(points[i], c->columns[j], FREEDOMS);
        }
    }
    if (!factorise(POINTS, flexibility, pivot)) {
        return "the step size is too small for the rotor";
    }
    for (j = 0; j < POINTS; j++) {
        double column[POINTS] = {0.0};
        column[j] = 1.0;
        substitute(POINTS, flexibility, pivot, column);
        for (i = 0; i < POINTS; i++) {
            c->D[i][j] = column[i];
        }
    }
    return NULL;
}

/* Place at the end of a step without forces of the bearings there, under applied forces p at its end. */
static void free_place(const Model *m, const Condensed *c, const double p[], double place[FREEDOMS])
{
    const double *value = m->value, *d = &m->cache[PLACE], *v = &m->cache[VELOCITY], *a = &m->cache[ACCELERATION];
    double inertial[FREEDOMS], damped[FREEDOMS];
    int i, k;
    for (i = 0; i < FREEDOMS; i++) {
        const double late = c->velocity[1] * d[i] + c->velocity[2] * v[i] + c->velocity[3] * a[i];
        const double later = c->acceleration[1] * d[i] + c->acceleration[2] * v[i] + c->acceleration[3] * a[i];
        inertial[i] = value[VR_mass_scale] * ((1.0 - c->alpha_m) * later + c->alpha_m * a[i]);
        damped[i] = c->weight * late + c->alpha_f * v[i];
        place[i] = c->weight * p[i] + c->alpha_f * m->cache[APPLIED + i];
    }
    take(&m->cache[CARRIED], c->alpha_f, place);
    for (i = 0; i < FREEDOMS; i++) {
        for (k = 0; k < FREEDOMS; k++) {
            place[i] -= mass_matrix[i][k] * inertial[k] + damping(value, c->omega, i, k) * damped[k]
                        + c->alpha_f * value[VR_stiffness_scale] * stiffness_matrix[i][k] * d[k];
        }
    }
    substitute(FREEDOMS, c->system, c->pivot, place);
}

/* What an imbalance is measured by. */
static double size_of(const Model *m, const double p[])
{
    double most = 1.0;
    int i;
    for (i = 0; i < FREEDOMS; i++) {
        most = fmax(most, fmax(fabs(p[i]), fabs(m->cache[APPLIED + i])));
    }
    for (i = 0; i < POINTS; i++) {
        most = fmax(most, fabs(m->cache[CARRIED + i]));
    }
    return most;
}

/* Newton's method for D (r - free) + weight F = 0 from r; the points' rates are gain r + history. */
static const char *balance(const Model *m, const Condensed *c, const double free[], const double history[], double size, Carrying *forces,
                           double r[])
{
    enum { MOST = 30 };
    double previous = HUGE_VAL, step[POINTS] = {0.0}, v[POINTS], off[POINTS], system[POINTS * POINTS];
    int pivot[POINTS], n, i, k;
    for (n = 0; n < MOST; n++) {
        double error = 0.0, noise = 0.0;
        const char *reason;
        for (i = 0; i < POINTS; i++) {
            v[i] = c->velocity[0] * r[i] + history[i];
        }
        reason = press(m, forces, r, v);
        if (reason != NULL) {
            return reason;
        }
        for (i = 0; i < POINTS; i++) {
            off[i] = c->weight * forces->carried[i];
            for (k = 0; k < POINTS; k++) {
                off[i] += c->D[i][k] * (r[k] - free[k]);
                noise = fmax(noise, fabs(c->D[i][k] * r[k]));
            }
            error += off[i] * off[i];
        }
        error = sqrt(error);
        if (!isfinite(error)) {
            return no_number;
        }
        if (error <= balanced * size + epsilon * noise) {
            return NULL;
        }
        if (error > overshoot * previous) { /* a kink lies between */
            for (i = 0; i < POINTS; i++) {
                step[i] *= 0.5;
                r[i] -= step[i];
            }
            continue;
        }
        previous = error;
        find_slopes(forces, c->velocity[0]);
        for (i = 0; i < POINTS; i++) {
            for (k = 0; k < POINTS; k++) {
                system[i * POINTS + k] = c->D[i][k] + c->weight * forces->slopes[i][k];
            }
        }
        if (!factorise(POINTS, system, pivot)) {
            break;
        }
        for (i = 0; i < POINTS; i++) {
            step[i] = -off[i];
        }
        substitute(POINTS, system, pivot, step);
        for (i = 0; i < POINTS; i++) {
            r[i] += step[i];
        }
    }
    return "the forces of the bearings find no balance: a shorter inner_step can help";
}

/* One step under applied forces p at its end. */
static const char *advance(Model *m, const Condensed *c, double omega, const double p[])
{
    double *d = &m->cache[PLACE], *v = &m->cache[VELOCITY], *a = &m->cache[ACCELERATION], *was = &m->cache[WAS];
    double place[FREEDOMS], r[POINTS], free[POINTS], history[POINTS];
    Carrying forces;
    const char *reason;
    int i, j;
    free_place(m, c, p, place);
    for (j = 0; j < POINTS; j++) {
        free[j] = product(points[j], place, FREEDOMS);
        history[j] = c->velocity[1] * product(points[j], d, FREEDOMS) + c->velocity[2] * product(points[j], v, FREEDOMS)
                     + c->velocity[3] * product(points[j], a, FREEDOMS);
        r[j] = 3.0 * (was[j] - was[POINTS + j]) + was[2 * POINTS + j];
    }
    begin_bearings(m, &forces, c->h, omega);
    reason = balance(m, c, free, history, size_of(m, p), &forces, r);
    if (reason == NULL) {
        reason = accept(m, &forces, r);
    }
    for (j = 0; j < POINTS; j++) {
        for (i = 0; i < FREEDOMS; i++) {
            place[i] -= c->weight * forces.carried[j] * c->columns[j][i];
        }
    }
    for (i = 0; i < FREEDOMS; i++) {
        const double old = d[i], rate = v[i];
        d[i] = place[i];
        v[i] = c->velocity[0] * place[i] + c->velocity[1] * old + c->velocity[2] * rate + c->velocity[3] * a[i];
        a[i] = c->acceleration[0] * place[i] + c->acceleration[1] * old + c->acceleration[2] * rate + c->acceleration[3] * a[i];
        m->cache[APPLIED + i] = p[i];
    }
    memmove(&was[POINTS], was, 2 * POINTS * sizeof was[0]);
    memcpy(was, r, sizeof r);
    return reason;
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
static void begin(Model *m, const Motion *motion, double h)
{
    const double *d = &m->cache[PLACE], *v = &m->cache[VELOCITY];
    double inputs[N_INPUTS], ends[N_INPUTS], p[FREEDOMS], net[FREEDOMS], *before = &m->cache[APPLIED];
    int i, k;
    inputs_at(motion, 0.0, 0, inputs);
    if (m->cache[MOVING] == 0.0) {
        inputs_at(motion, h, 0, ends);
        m->cache[SPIN] = spin_of(m, ends, HAS_TORQUE ? inputs[FIRST_DRIVE] : 0.0, h);
    }
    applied(m->value, inputs, m->cache[ANGLE], m->cache[SPEED], m->cache[SPIN], p);
    for (i = 0; i < FREEDOMS; i++) {
        net[i] = p[i] - before[i];
        if (m->cache[MOVING] == 0.0) {
            net[i] = p[i] - m->value[VR_stiffness_scale] * product(stiffness_matrix[i], d, FREEDOMS);
            for (k = 0; k < FREEDOMS; k++) {
                net[i] -= damping(m->value, m->cache[SPEED], i, k) * v[k];
            }
        }
    }
    if (m->cache[MOVING] == 0.0) {
        take(&m->cache[CARRIED], 1.0, net);
    }
    for (i = 0; i < FREEDOMS; i++) {
        m->cache[ACCELERATION + i] += product(mass_inverse[i], net, FREEDOMS) / m->value[VR_mass_scale];
    }
    memcpy(before, p, sizeof p);
    m->cache[MOVING] = 1.0;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    const double span = h + m->cache[OWED], count = ceil(span / m->value[VR_inner_step] - by_rounding);
    double inputs[N_INPUTS], p[FREEDOMS];
    const char *reason = NULL;
    Model next = *m;
    Condensed c;
    int i, steps;
    (void)tolerance; /* inner_step decides */
    if (!(count <= most_steps)) {
        return fault(DISCARD, "more than a million inner steps: take a shorter step, or a longer inner_step");
    }
    if (span < shortest * m->value[VR_inner_step]) {
        m->cache[OWED] = span;
        return fine;
    }
    steps = count > 1.0 ? (int)count : 1;
    c.h = 0.0;
    next.cache[OWED] = 0.0;
    begin(&next, motion, span / steps);
    for (i = 1; i <= steps && reason == NULL; i++) {
        const double part = span / steps, omega = next.cache[SPEED];
        double torque = 0.0, end;
#if HAS_TORQUE
        inputs_at(motion, (i - 0.5) * part, 0, inputs);
        torque = inputs[FIRST_DRIVE];
#endif
        inputs_at(motion, i * part, i == steps, inputs);
        next.cache[SPIN] = spin_of(&next, inputs, torque, part);
        end = HAS_TORQUE ? omega + part * next.cache[SPIN] : inputs[FIRST_DRIVE];
        if (!(end >= 0.0)) {
            reason = "speed must be >= 0 rad/s";
            break;
        }
        turn(&next, 0.5 * part * (omega + end));
        next.cache[SPEED] = end;
        applied(next.value, inputs, next.cache[ANGLE], end, next.cache[SPIN], p);
        if (c.h == 0.0 || (HAS_GYROSCOPIC && c.omega != 0.5 * (omega + end))) {
            reason = condense(next.value, part, 0.5 * (omega + end), &c);
        }
        if (reason == NULL) {
            reason = advance(&next, &c, end, p);
        }
        memcpy(next.input, inputs, sizeof inputs);
        next.cache[RESISTED] += slowed(&next);
    }
    if (reason == NULL) {
        reason = show(&next);
    }
    if (reason == NULL) {
        *m = next;
    }
    return fault(DISCARD, reason);
}

void model_direction(const Model *m, const double seed[], double along[])
{
    (void)m, (void)seed, (void)along;
}

/* Two bits for each bearing. */
unsigned long long model_outside(const Model *m)
{
    unsigned long long found = 0;
    int b;
    for (b = 0; b < BEARINGS; b++) {
        found |= (m->value[law_outside[b] + 1] != 0.0 ? 1ULL : 0ULL) << (2 * b);
        found |= (m->value[law_outside[b] + 2] != 0.0 ? 2ULL : 0ULL) << (2 * b);
    }
    return found;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    unsigned long long fast = 0, heavy = 0;
    int b;
    (void)m;
    for (b = 0; b < BEARINGS; b++) {
        fast |= which >> (2 * b) & 1ULL;
        heavy |= which >> (2 * b) & 2ULL;
    }
    snprintf(text, size, "%s%s%s", fast ? " speed above the tables" : "", fast && heavy ? ";" : "",
             heavy ? " a ball carries more than the tables have" : "");
}
