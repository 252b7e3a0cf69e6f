/* A rotor as an FMU: rotor.h on the variables of the core. Its states are those of continuous time: displacements, velocities,
 * the angle of the shaft and, under a torque, its speed; then those of the supports inside. rotor_data.h and rotor_supports.h
 * are generated. Equations in README.md. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "linear_equations.h"
#include "model.h"
#include "rotor.h"
#include "rotor_data.h"
#include "rotor_inside.h"

/* States among the values. */
enum {
    POSITION = FIRST_MOTION,
    VELOCITY = POSITION + FREEDOMS,
    ANGLE = VELOCITY + FREEDOMS,
    SPEED = ANGLE + HAS_TORQUE, /* under a torque */
    FILMS = ANGLE + 1 + HAS_TORQUE
};

/* The cache: matrices of the parameters, where they are sums; the inverse of the mass; what is owed to a step, the place at rest that the
 * start follows, and the rotor's numbers. */
enum { MATRIX = FREEDOMS * FREEDOMS, SUMS = HAS_SUMS ? 3 * MATRIX + FREEDOMS : 0 };
enum { INVERSE = SUMS, OWED = INVERSE + MATRIX + FREEDOMS, LONGEST, REST, NUMBERS = REST + FREEDOMS };

static const double most_steps = 1e6;   /* inner ones in one step of the master */
static const double shortest = 1e-4;    /* step, over an inner one: rounding of the forces is that large in a shorter one's accelerations */
static const double by_rounding = 1e-9; /* of an inner step, that a step of the master may be longer */

static const Fault fine = {FINE, NULL};
static const char *const no_number = "the motion is too large for a floating-point number";

static Rotor rotor_of(const Model *m)
{
    Rotor r;
    r.freedoms = FREEDOMS;
    r.points = POINTS;
    r.motions = MOTIONS;
    r.supports = SUPPORTS;
    r.unbalances = UNBALANCES;
    r.M = HAS_SUMS ? &m->cache[0] : mass_matrix[0];
    r.C = HAS_SUMS ? &m->cache[MATRIX] : damping_matrix[0];
    r.K = HAS_SUMS ? &m->cache[2 * MATRIX] : stiffness_matrix[0];
    r.L = HAS_SUMS ? &m->cache[3 * MATRIX] : constant_load;
    r.G = HAS_GYROSCOPIC ? gyroscopic_matrix[0] : NULL;
#if HAS_SUMS
    r.mass = r.damping = r.stiffness = r.load = 1.0;
#else
    r.mass = m->value[VR_mass_scale];
    r.damping = m->value[VR_damping_scale];
    r.stiffness = m->value[VR_stiffness_scale];
    r.load = m->value[VR_load_scale];
#endif
    r.M_inverse = &m->cache[INVERSE];
    r.B = points[0];
    r.ties = ties;
    r.shift = shift;
    r.count = count;
    r.unbalance_at = unbalance_at;
    r.phase = unbalance_phase;
#if HAS_TORQUE
    r.inertia = m->value[VR_inertia];
#else
    r.inertia = 0.0;
#endif
    r.rho = 0.8;
    r.allowed = 0.0;
    r.floor = FLOOR;
    r.balanced = 1e-10;
    r.rested = RESTED;
    r.held = HELD;
    r.support = inside;
    r.first = inside_first;
    return r;
}

/* Parameters of the supports inside, in `room`: those of a bearing in the order of its settings. */
static void parameters_of(const Model *m, double room[][4], const double *of[])
{
    int s, k;
    for (s = 0; s < SUPPORTS; s++) {
        for (k = 0; k < 4; k++) {
            room[s][k] = settings_at[s][k] < 0 ? 0.0 : m->value[settings_at[s][k]];
        }
        of[s] = room[s];
    }
}

/* ---- parameters ---- */

static const char *check(const double value[])
{
    int i;
    for (i = 0; i < PARAMETERS; i++) {
        const double x = value[FIRST_PARAMETER + i];
        if (!(isfinite(x) && (x > 0.0 || (!parameter_positive[i] && (x == 0.0 || parameter_signed[i]))))) {
            return parameter_reason[i];
        }
    }
    if (!(value[VR_inner_step] >= LEAST_INNER_STEP && isfinite(value[VR_inner_step]))) {
        return "inner_step must be finite and at least " LEAST_TEXT;
    }
#if HAS_TORQUE
    if (!(value[VR_inertia] > 0.0 && isfinite(value[VR_inertia]) && isfinite(value[SPEED])
          && (SUPPORTS == 0 || value[SPEED] >= 0.0))) {
        return "inertia must be finite and > 0, and speed finite, and >= 0 with bearings inside";
    }
#endif
    return NULL;
}

/* Matrices that are sums, and factors of the mass. */
static const char *matrices(Model *m)
{
    int i;
#if HAS_SUMS
    int k;
    memset(m->cache, 0, SUMS * sizeof m->cache[0]);
    for (k = 0; k < TERMS; k++) {
        const double x = m->value[term_parameter[k]];
        for (i = 0; i < term_size[k]; i++) {
            m->cache[term_place[k] + i] += x * terms[term_first[k] + i];
        }
    }
    for (i = 0; i < FREEDOMS; i++) {
        m->cache[3 * MATRIX + i] += constant_load[i];
    }
#endif
    {
        const Rotor r = rotor_of(m);
        double factors[MATRIX], pivots[FREEDOMS], column[FREEDOMS];
        for (i = 0; i < MATRIX; i++) {
            factors[i] = r.M[i];
        }
        if (!factorise(FREEDOMS, factors, pivots)) {
            return "the mass has no inverse";
        }
        invert(FREEDOMS, factors, pivots, column, &m->cache[INVERSE]);
    }
    return NULL;
}

/* The longest inner step. Its start value resolves the shaft of the export; where another shaft has been set that vibrates
 * faster, it is resolved as well. */
static double longest_step(const Model *m)
{
    const double given = m->value[VR_inner_step];
#if FOLLOWS_SHAFT
    if (given == DEFAULT_INNER_STEP) {
        const Rotor r = rotor_of(m);
        double trace = 0.0, column[FREEDOMS], response[FREEDOMS];
        int i, k;
        for (i = 0; i < FREEDOMS; i++) {
            for (k = 0; k < FREEDOMS; k++) {
                column[k] = r.stiffness * r.K[k * FREEDOMS + i];
            }
            rotor_accelerate(&r, column, response);
            trace += response[i];
        }
        return trace > 0.0 ? fmin(given, SHAFT_STEP / sqrt(trace)) : given;
    }
#endif
    return given;
}

/* ---- outputs ---- */

static const double *shaft_of(const Model *m, const Rotor *r)
{
    return &m->cache[NUMBERS] + rotor_layout(r).shaft;
}

/* Motions of the supports, inside and outside, in the state of the values. */
static const char *show_motions(Model *m)
{
    double *value = m->value;
    int i, k;
    for (i = 0; i < SHOWN; i++) {
        double place = shown_shift[i], velocity = 0.0;
        for (k = 0; k < FREEDOMS; k++) {
            place += shown_rows[i][k] * value[POSITION + k];
            velocity += shown_rows[i][k] * value[VELOCITY + k];
        }
        if (!(isfinite(place) && isfinite(velocity))) {
            return no_number;
        }
        value[FIRST_PLACE + i] = place;
        value[FIRST_RATE + i] = velocity;
    }
    return NULL;
}

/* Outputs of the supports inside. */
static void show_supports(Model *m, const Rotor *r)
{
    const double *numbers = &m->cache[NUMBERS] + rotor_layout(r).supports;
    double *films = &m->value[FILMS], indicators[INDICATORS + 1], *indicator = indicators;
    const int seen = !PLAIN || m->stage != IN_STEPS; /* steps on ball bearings have no events */
    int s, outside = 0;
    for (s = 0; s < SUPPORTS; s++) {
        inside[s]->show(inside[s]->own, numbers, &m->value[outputs_at[s]], films, seen ? indicator : NULL);
        indicator += inside[s]->indicators;
        outside |= m->value[outside_at[s]] != 0.0;
        films += inside[s]->states;
        numbers += inside[s]->size;
    }
    if (seen) {
        memcpy(m->indicator, indicators, N_CONTACTS * sizeof indicators[0]);
    }
#if SUPPORTS > 0
    m->value[VR_outside_validity] = outside;
#else
    (void)outside;
#endif
}

/* The rotor's numbers to the states and outputs. */
static const char *show(Model *m, const Rotor *r)
{
    const double *numbers = &m->cache[NUMBERS], *shaft = shaft_of(m, r);
    int i;
    for (i = 0; i < 2 * FREEDOMS; i++) {
        m->value[POSITION + i] = numbers[i];
    }
    m->value[ANGLE] = shaft[SHAFT_ANGLE];
#if HAS_TORQUE
    m->value[SPEED] = shaft[SHAFT_SPEED];
#endif
    show_supports(m, r);
    return isfinite(shaft[SHAFT_ANGLE]) && isfinite(shaft[SHAFT_SPEED]) ? show_motions(m)
                                                                         : "the speed is too large for a floating-point number";
}

/* ---- inputs ---- */

/* Forces on the freedoms. */
static void given_forces(const double inputs[], double given[])
{
    int i, k;
    memset(given, 0, FREEDOMS * sizeof given[0]);
    for (i = 0; i < FORCES; i++) {
        if (force_at[i] >= 0) {
            given[force_at[i]] += inputs[i];
        } else {
            for (k = 0; k < FREEDOMS; k++) {
                given[k] += inputs[i] * force_rows[i][k];
            }
        }
    }
}

/* What turns the shaft. */
static void turning(Acting *acting, const double inputs[])
{
    acting->torque = acting->drag = acting->omega = 0.0;
#if HAS_TORQUE
    {
        int b;
        acting->torque = inputs[FIRST_DRIVE];
        for (b = 1; b <= DRAGS; b++) {
            acting->drag += inputs[FIRST_DRIVE + b];
        }
    }
#else
    acting->omega = inputs[FIRST_DRIVE];
#endif
}

static Acting acting(const double inputs[], double given[])
{
    Acting a;
    given_forces(inputs, given);
    a.given = given;
    a.unbalance = &inputs[FORCES];
    turning(&a, inputs);
    return a;
}

/* ---- the start ---- */

/* Where the rotor starts: in equilibrium with the parameters, until another place or velocity is set. */
static const char *start(Model *m, const Rotor *r)
{
    const RotorLayout at = rotor_layout(r);
    const double *of[SUPPORTS + 1];
    double settings[SUPPORTS + 1][4];
    double *numbers = &m->cache[NUMBERS], work[WORK], *shaft = numbers + at.shaft, forces[N_INPUTS], given[FREEDOMS];
    int i, moved = !STARTS_AT_REST;
    const char *reason;
    parameters_of(m, settings, of);
    for (i = 0; i < FREEDOMS; i++) {
        moved |= m->value[POSITION + i] != m->cache[REST + i] || m->value[VELOCITY + i] != 0.0;
    }
    memset(numbers, 0, rotor_size(r) * sizeof numbers[0]);
    shaft[SHAFT_ANGLE] = m->value[ANGLE];
#if HAS_TORQUE
    shaft[SHAFT_SPEED] = m->value[SPEED];
#else
    shaft[SHAFT_SPEED] = m->input[FIRST_DRIVE];
#endif
    if (moved) {
        for (i = 0; i < 2 * FREEDOMS; i++) {
            numbers[i] = m->value[POSITION + i];
        }
        reason = rotor_place(r, of, numbers, work);
    } else {
        memcpy(forces, m->input, sizeof forces);
        memset(forces, 0, NODE_FORCES * sizeof forces[0]); /* which act from the first step on */
        given_forces(forces, given);
        memcpy(numbers, rotor_start, FREEDOMS * sizeof numbers[0]);
        reason = rotor_rest(r, of, given, numbers, work);
        memcpy(&m->cache[REST], numbers, FREEDOMS * sizeof numbers[0]);
    }
    return reason == NULL ? show(m, r) : reason;
}

/* ---- the interface of the core ---- */

Fault model_prepare(Model *m)
{
    const char *reason = check(m->value);
    if (reason == NULL && m->cache[LONGEST] == 0.0) { /* for the first time */
        memcpy(&m->cache[REST], rotor_start, sizeof rotor_start);
    }
    if (reason == NULL) {
        reason = matrices(m);
    }
    if (reason == NULL) {
        m->cache[LONGEST] = longest_step(m);
    }
    return fault(REFUSE, reason);
}

static double angular_speed(const Model *m)
{
    #if HAS_TORQUE
    return m->value[SPEED];
#else
    return m->input[FIRST_DRIVE];
#endif
}

static SupportMotion motion_of(const double value[], int first, double omega)
{
    SupportMotion motion;
    motion.q = &value[FIRST_PLACE + first];
    motion.v = &value[FIRST_RATE + first];
    motion.omega = omega;
    return motion;
}

#ifndef CO_SIMULATION_ONLY

/* Supports inside in a state of continuous time; their forces on the points are kept. */
static const char *evaluate(Model *m, const Rotor *r)
{
    const RotorLayout at = rotor_layout(r);
    double *numbers = &m->cache[NUMBERS] + at.supports, *carried = &m->cache[NUMBERS] + at.carried;
    double force[MOTIONS + 1], indicators[INDICATORS + 1], *indicator = indicators, work[WORK];
    const double omega = angular_speed(m);
    const char *reason = show_motions(m);
    int s, i, j, films = FILMS - POSITION, outside = 0;
    for (s = 0; s < SUPPORTS && reason == NULL; s++) {
        const SupportMotion motion = motion_of(m->value, inside_first[s], omega);
        reason = inside[s]->evaluate(inside[s]->own, numbers, work, &motion, &m->value[POSITION + films],
                                     &m->value[outputs_at[s]], indicator, &force[inside_first[s]],
                                     &m->value[FIRST_DERIVATIVE + films]);
        outside |= m->value[outside_at[s]] != 0.0;
        films += inside[s]->states;
        numbers += inside[s]->size;
        indicator += inside[s]->indicators;
    }
    memset(carried, 0, POINTS * sizeof carried[0]);
    for (i = 0; i < MOTIONS && reason == NULL; i++) {
        for (j = 0; j < POINTS; j++) {
            carried[j] += ties[i * POINTS + j] * count[i] * force[i];
        }
    }
    if (reason == NULL) {
        memcpy(m->indicator, indicators, N_CONTACTS * sizeof indicators[0]);
    }
#if SUPPORTS > 0
    m->value[VR_outside_validity] = outside;
#else
    (void)outside;
#endif
    return reason;
}

#endif

/* Before the first step where it starts; later outputs of steps are those of the last one, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    Model next = *m;
    const Rotor r = rotor_of(&next);
    const char *reason = NULL;
    int i;
    for (i = 0; i < N_STATES; i++) {
        if (!isfinite(m->value[FIRST_MOTION + i])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    if (m->stage == IN_CONTINUOUS_TIME) {
        reason = evaluate(&next, &r);
    } else if (shaft_of(m, &r)[SHAFT_MOVING] == 0.0) {
        reason = start(&next, &r);
    }
    if (reason == NULL) {
        *m = next;
    }
    return fault(DISCARD, reason);
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

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    const double span = h + m->cache[OWED], needed = ceil(span / m->cache[LONGEST] - by_rounding);
    const int steps = needed > 1.0 && needed <= most_steps ? (int)needed : 1;
    const double part = span / steps;
    double inputs[N_INPUTS], between[N_INPUTS], given[FREEDOMS], work[WORK], *numbers = &m->cache[NUMBERS];
    const Rotor r = rotor_of(m);
    const char *reason = NULL;
    Acting now, end;
    int i;
    (void)tolerance; /* inner_step decides */
    if (!(needed <= most_steps)) {
        return fault(DISCARD, "more than a million inner steps: take a shorter step, or a longer inner_step");
    }
    if (span < shortest * m->value[VR_inner_step]) {
        m->cache[OWED] = span;
        return fine;
    }
    m->cache[OWED] = 0.0;
    inputs_at(motion, 0.0, 0, inputs);
    now = acting(inputs, given);
    end = now;
#if !HAS_TORQUE
    inputs_at(motion, part, steps == 1, between);
    end.omega = between[FIRST_DRIVE];
#endif
    rotor_begin(&r, &now, &end, part, numbers, work);
    for (i = 1; i <= steps && reason == NULL; i++) {
        inputs_at(motion, i * part, i == steps, inputs);
        end = acting(inputs, given);
#if HAS_TORQUE
        inputs_at(motion, (i - 0.5) * part, 0, between);
        turning(&end, between);
#endif
        reason = rotor_step(&r, &end, part, numbers, work);
    }
    memcpy(m->input, inputs, sizeof inputs);
    return fault(DISCARD, reason == NULL ? show(m, &r) : reason);
}

/* ---- continuous time ---- */

#ifdef CO_SIMULATION_ONLY

Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    (void)m, (void)seed, (void)along;
}

#else

/* Takes forces of the supports inside from those on the freedoms. */
static void take_supports(const double force[], double net[])
{
    int i, k;
    for (i = 0; i < MOTIONS; i++) {
        const double push = count[i] * force[i];
        for (k = 0; k < FREEDOMS; k++) {
            net[k] -= push * shown_rows[i][k];
        }
    }
}

/* Accelerations of the freedoms and of the shaft, together, for forces `net` without the part of the angular acceleration, and
 * `drive` on the shaft without that of the unbalances. */
static double accelerate(const Rotor *r, const double unbalance[], const double swing[], double alpha, double drive,
                         const double net[], double a[])
{
    double swung[FREEDOMS], response[FREEDOMS];
    int u, i;
    rotor_accelerate(r, net, a);
    if (UNBALANCES == 0) {
        return r->inertia == 0.0 ? alpha : drive / (r->mass * r->inertia);
    }
    memset(swung, 0, sizeof swung);
    for (u = 0; u < UNBALANCES; u++) {
        const double c = swing[2 * u], s = swing[2 * u + 1];
        const int x = unbalance_at[2 * u], y = unbalance_at[2 * u + 1];
        if (x >= 0) {
            swung[x] += unbalance[u] * s;
        }
        if (y >= 0) {
            swung[y] -= unbalance[u] * c;
        }
    }
    rotor_accelerate(r, swung, response);
    if (r->inertia != 0.0) { /* m J alpha = drive + swung . a, a = a + alpha response */
        double with = 0.0, of = 0.0;
        for (i = 0; i < FREEDOMS; i++) {
            with += swung[i] * a[i];
            of += swung[i] * response[i];
        }
        alpha = (drive + with) / (r->mass * r->inertia - of);
    }
    for (i = 0; i < FREEDOMS; i++) {
        a[i] += alpha * response[i];
    }
    return alpha;
}

/* Torque on the shaft. What is outside acts against the turning. */
static double driving(const Model *m, double omega)
{
#if HAS_TORQUE
    double given[FREEDOMS];
    const Acting now = acting(m->input, given);
    double drive = now.torque;
    int s;
    for (s = 0; s < SUPPORTS; s++) {
        drive -= inside[s]->torque(inside[s]->own, NULL, &m->value[outputs_at[s]]);
    }
    if (omega == 0.0 && fabs(drive) <= now.drag) {
        return 0.0;
    }
    return drive - (omega > 0.0 || (omega == 0.0 && drive > 0.0) ? now.drag : -now.drag);
#else
    (void)m, (void)omega;
    return 0.0;
#endif
}

Fault model_rates(Model *m)
{
    Model next = *m;
    const Rotor r = rotor_of(&next);
    const RotorLayout at = rotor_layout(&r);
    double *rates = &next.value[FIRST_DERIVATIVE], *numbers = &next.cache[NUMBERS];
    double given[FREEDOMS], net[FREEDOMS], swing[2 * UNBALANCES + 1], alpha = 0.0;
    const double omega = angular_speed(m);
    const Acting now = acting(m->input, given);
    const char *reason = NULL;
    int i;
    if (m->stage == IN_STEPS) { /* rates of films beside accelerations */
        reason = evaluate(&next, &r);
    }
#if !HAS_TORQUE
    alpha = m->input[FIRST_DRIVE + 1];
#endif
    rotor_swing(&r, m->value[ANGLE], swing);
    rotor_applied(&r, given, now.unbalance, swing, omega, 0.0, net);
    rotor_resist(&r, omega, &m->value[POSITION], &m->value[VELOCITY], net);
    rotor_take(&r, numbers + at.carried, 1.0, net);
    memcpy(rates, &m->value[VELOCITY], FREEDOMS * sizeof rates[0]);
    alpha = accelerate(&r, now.unbalance, swing, alpha, driving(&next, omega), net, rates + FREEDOMS);
    rates[2 * FREEDOMS] = omega;
#if HAS_TORQUE
    rates[2 * FREEDOMS + 1] = alpha;
#else
    (void)alpha;
#endif
    for (i = 0; i < N_STATES && reason == NULL; i++) {
        if (!isfinite(rates[i])) {
            reason = "an acceleration is too large for a floating-point number";
        }
    }
    if (reason == NULL) { /* outputs of steps stay those of the last one */
        memcpy(&m->value[FIRST_DERIVATIVE], rates, N_STATES * sizeof rates[0]);
    }
    return fault(DISCARD, reason);
}

void model_direction(const Model *m, const double seed[], double along[])
{
    const Rotor r = rotor_of(m);
    const double *numbers = &m->cache[NUMBERS] + rotor_layout(&r).supports, *dq = &seed[POSITION], *dv = &seed[VELOCITY];
    const double *v = &m->value[VELOCITY], omega = angular_speed(m), *amount = &m->input[FORCES];
    const double domega = HAS_TORQUE ? seed[SPEED] : seed[FIRST_DRIVE], dangle = seed[ANGLE];
    double given[FREEDOMS], net[FREEDOMS], swing[2 * UNBALANCES + 1], force[MOTIONS + 1], a[FREEDOMS], work[WORK];
    double *rates = &along[FIRST_DERIVATIVE];
    double alpha = 0.0, dalpha = 0.0, ddrive = 0.0;
    int i, k, s, u, films = FILMS;
    rotor_swing(&r, m->value[ANGLE], swing);
    for (i = 0; i < SHOWN; i++) {
        along[FIRST_PLACE + i] = along[FIRST_RATE + i] = 0.0;
        for (k = 0; k < FREEDOMS; k++) {
            along[FIRST_PLACE + i] += shown_rows[i][k] * dq[k];
            along[FIRST_RATE + i] += shown_rows[i][k] * dv[k];
        }
    }
    for (s = 0; s < SUPPORTS; s++) {
        const SupportMotion motion = motion_of(m->value, inside_first[s], omega), change = motion_of(along, inside_first[s], domega);
        inside[s]->along(inside[s]->own, numbers, work, &motion, &m->value[films], &change, &seed[films],
                         &along[outputs_at[s]], &force[inside_first[s]], &rates[films - POSITION]);
        films += inside[s]->states;
        numbers += inside[s]->size;
    }
    given_forces(seed, given);
    memcpy(net, given, sizeof net);
    rotor_resist(&r, omega, dq, dv, net);
    for (i = 0; i < FREEDOMS && r.G != NULL; i++) {
        for (k = 0; k < FREEDOMS; k++) {
            net[i] -= r.mass * domega * r.G[i * FREEDOMS + k] * v[k];
        }
    }
    take_supports(force, net);
#if HAS_TORQUE
    alpha = m->value[FIRST_DERIVATIVE + 2 * FREEDOMS + 1];
    ddrive = seed[FIRST_DRIVE];
    for (i = 1; i <= DRAGS; i++) {
        ddrive -= (omega >= 0.0 ? 1.0 : -1.0) * seed[FIRST_DRIVE + i];
    }
#else
    alpha = m->input[FIRST_DRIVE + 1];
    dalpha = seed[FIRST_DRIVE + 1];
#endif
    for (i = 0; i < FREEDOMS; i++) {
        a[i] = m->value[FIRST_DERIVATIVE + FREEDOMS + i];
    }
    for (u = 0; u < UNBALANCES; u++) {
        const double c = swing[2 * u], sn = swing[2 * u + 1], U = amount[u], dU = seed[FORCES + u];
        const double pulled = dU * omega * omega + U * (2.0 * omega * domega + alpha * dangle);
        const double pushed = dU * alpha - U * omega * omega * dangle;
        const int x = unbalance_at[2 * u], y = unbalance_at[2 * u + 1];
        const double ax = x >= 0 ? a[x] : 0.0, ay = y >= 0 ? a[y] : 0.0;
        if (x >= 0) {
            net[x] += pulled * c + pushed * sn;
        }
        if (y >= 0) {
            net[y] += pulled * sn - pushed * c;
        }
        ddrive += dU * (ax * sn - ay * c) + U * dangle * (ax * c + ay * sn);
    }
    memcpy(rates, dv, FREEDOMS * sizeof rates[0]);
    dalpha = accelerate(&r, amount, swing, dalpha, ddrive, net, rates + FREEDOMS);
    rates[2 * FREEDOMS] = domega;
#if HAS_TORQUE
    rates[2 * FREEDOMS + 1] = dalpha;
#else
    (void)dalpha;
#endif
}

#endif

/* ---- validity ---- */

unsigned long long model_outside(const Model *m)
{
    unsigned long long found = 0;
    int s, k;
    for (s = 0; s < SUPPORTS; s++) {
        for (k = 0; k < outside_flags[s]; k++) {
            found |= (m->value[flags_at[s] + k] != 0.0 ? 1ULL : 0ULL) << (2 * s + k);
        }
    }
    return found;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    int s, k;
    (void)m;
    for (s = 0; s < SUPPORTS && size > 0; s++) {
        for (k = 0; k < outside_flags[s]; k++) {
            if ((which >> (2 * s + k) & 1ULL) != 0) {
                const int written = snprintf(text, size, " %s", outside_text[s][k]);
                if (written < 0 || (size_t)written >= size) {
                    return;
                }
                text += written;
                size -= (size_t)written;
            }
        }
    }
}
