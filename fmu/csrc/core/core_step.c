/* Steps of co-simulation, and derivatives, of an FMU of any version; see core.h. */
#include "core.h"

#include <math.h>
#include <string.h>

static const Fault fine = {FINE, NULL};

static Fault refuse(const char *reason)
{
    Fault fault = {REFUSE, NULL};
    fault.reason = reason;
    return fault;
}

/* ---- steps ---- */

static Fault check_step(const State *s, double time, double h)
{
    const double end = time + h;
    if (!(isfinite(end) && h > 0.0)) {
        return refuse("the time must be finite and the step size > 0");
    }
    if (!(fabs(time - s->time) <= 0.01 * h + 1e-14 * fabs(time))) { /* masters add up their time in other ways */
        return refuse("the step does not start at the present time of the FMU");
    }
    if (!(end > time)) {
        return refuse("the step size is too small for the time to change");
    }
    if (s->has_stop_time && end - s->stop_time > 1e-9 * (fabs(s->stop_time) + h)) {
        return refuse("the step ends after the stop time");
    }
    return fine;
}

/* What the mean rate has missed of the last change of the approach, for the step to come. A master that advances the
 * approach by the rate at the end of its steps (symplectic Euler) misses half the change of the rate, in the next step
 * again; more than that is a jump, which tells nothing of the next step. */
static double missed(const State *s, double turn, double time, double h)
{
    const double before = time - s->last_time, most = 0.5 * h * h * fabs(turn);
    const double mean = 0.5 * (s->model.value[VR_rate] + s->last_rate);
    const double again = (s->model.value[VR_approach] - s->last_approach - before * mean) * (h / before) * (h / before);
    return again > most ? most : again < -most ? -most : isfinite(again) ? again : 0.0;
}

/* The motion of a step, from the inputs and what they mean. */
static Motion motion_of(const State *s, double time, double h)
{
    const double u = s->model.value[VR_approach], v = s->model.value[VR_rate];
    const double *slope = s->input_slope;
    Motion m;
    m.meaning = s->model.value[VR_input_meaning] < 1.5 ? EXTRAPOLATED
                : s->model.value[VR_input_meaning] < 2.5 ? AT_THE_END : HELD;
    m.approach = u;
    m.rate = v;
    m.slope = m.bend = m.turn = 0.0;
    m.end_approach = u;
    m.end_rate = v;
    if (m.meaning == EXTRAPOLATED) {
        if ((s->input_slopes & RATE_1) != 0) {
            m.turn = slope[2];
        } else if (s->has_last && time > s->last_time) {
            m.turn = (v - s->last_rate) / (time - s->last_time);
        }
        m.slope = (s->input_slopes & APPROACH_1) != 0 ? slope[0] : v;
        m.bend = (s->input_slopes & APPROACH_2) != 0 ? slope[1] : m.turn;
        if (s->input_slopes == 0 && s->has_last && time > s->last_time) {
            m.bend += 2.0 * missed(s, m.turn, time, h) / (h * h);
        }
        m.end_approach = u + h * (m.slope + 0.5 * h * m.bend);
        m.end_rate = v + h * m.turn;
    } else if (m.meaning == AT_THE_END) {
        m.approach = s->now_approach;
        m.rate = s->now_rate;
        m.turn = (v - s->now_rate) / h;
    }
    return m;
}

/* Parameters that were tuned, before a step; on a copy, so that a law that is refused changes nothing. */
static Fault prepared(const State *s, Model *model)
{
    *model = s->model;
    return model_prepare(model);
}

Fault core_step(State *s, double time, double h)
{
    Fault fault = check_step(s, time, h);
    Model tuned;
    Motion motion;
    if (fault.severity != FINE) {
        return fault;
    }
    if (!(isfinite(s->model.value[VR_approach]) && isfinite(s->model.value[VR_rate]))) {
        return refuse("approach and rate must be finite");
    }
    motion = motion_of(s, time, h);
    if (!(isfinite(motion.end_approach) && isfinite(motion.end_rate) && isfinite(motion.turn))) {
        fault.severity = DISCARD;
        fault.reason = "the motion of the inputs within the step is too large for a floating-point number";
        return fault;
    }
    if ((s->stale & STALE_LAW) != 0) {
        fault = prepared(s, &tuned);
        if (fault.severity == FINE) {
            fault = model_step(&tuned, &motion, h, s->tolerance);
        }
        if (fault.severity == FINE) {
            s->model = tuned;
        }
    } else {
        fault = model_step(&s->model, &motion, h, s->tolerance);
    }
    if (fault.severity != FINE) {
        return fault;
    }
    s->last_time = time;
    s->last_approach = s->model.value[VR_approach];
    s->last_rate = s->model.value[VR_rate];
    s->has_last = 1;
    s->time = time + h;
    s->now_approach = motion.end_approach;
    s->now_rate = motion.end_rate;
    s->turn = motion.turn;
    s->input_slopes = 0;
    s->stale = N_STATES == 0 ? 0 : STALE_RATES;
    return fine;
}

/* ---- derivatives of inputs and outputs in time ---- */

static int slope_entry(unsigned int reference, int order)
{
    if (reference == VR_approach && (order == 1 || order == 2)) {
        return order - 1;
    }
    return reference == VR_rate && order == 1 ? 2 : -1;
}

Fault core_may_set_slope(const State *s, unsigned int reference, int order, double value)
{
    if (slope_entry(reference, order) < 0) {
        return refuse("only derivatives of approach (order 1, 2) and rate (order 1) can be set");
    }
    if (!isfinite(value)) {
        return refuse("a derivative must be finite");
    }
    if (s->model.value[VR_input_meaning] > 1.5) {
        return refuse("derivatives of inputs are for input_meaning = 1 (extrapolated)");
    }
    return fine;
}

void core_set_slope(State *s, unsigned int reference, int order, double value)
{
    const int entry = slope_entry(reference, order);
    s->input_slope[entry] = value;
    s->input_slopes |= 1 << entry;
}

/* ---- partial derivatives ---- */

static int is_unknown(unsigned int reference)
{
    return reference < N_VARIABLES
           && (core_variables[reference].role == OUTPUT || core_variables[reference].role == DERIVATIVE)
           && core_variables[reference].type == REAL;
}

static int is_known(unsigned int reference)
{
    Role role;
    if (reference >= N_VARIABLES || core_variables[reference].type != REAL) {
        return 0;
    }
    role = core_variables[reference].role;
    return role == INPUT || role == TUNABLE || role == STATE;
}

static Fault check_references(State *s, const unsigned int unknowns[], size_t n_unknowns,
                              const unsigned int knowns[], size_t n_knowns)
{
    size_t i;
    int rates = 0;
    for (i = 0; i < n_unknowns; i++) {
        if (!is_unknown(unknowns[i])) {
            return refuse("an unknown is a real output or the derivative of a state");
        }
        rates |= core_variables[unknowns[i]].role == DERIVATIVE;
    }
    for (i = 0; i < n_knowns; i++) {
        if (!is_known(knowns[i])) {
            return refuse("a known is a real input, a tunable parameter or a state");
        }
    }
    return rates ? core_rates(s) : core_outputs(s);
}

/* Derivatives along a direction may be too large even where the outputs are not. */
static Fault check_finite(const double values[], size_t count)
{
    Fault fault = {DISCARD, "the derivative is too large for a floating-point number"};
    size_t i;
    for (i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            return fault;
        }
    }
    return fine;
}

Fault core_directional(State *s, const unsigned int unknowns[], size_t n_unknowns, const unsigned int knowns[],
                       size_t n_knowns, const double seed[], double sensitivity[])
{
    Fault fault = check_references(s, unknowns, n_unknowns, knowns, n_knowns);
    double direction[N_VARIABLES], along[N_VARIABLES];
    size_t i;
    if (fault.severity != FINE) {
        return fault;
    }
    memset(direction, 0, sizeof direction);
    memset(along, 0, sizeof along);
    for (i = 0; i < n_knowns; i++) {
        direction[knowns[i]] += seed[i];
    }
    model_direction(&s->model, direction, along);
    for (i = 0; i < n_unknowns; i++) {
        fault = check_finite(&along[unknowns[i]], 1);
        if (fault.severity != FINE) {
            return fault;
        }
    }
    for (i = 0; i < n_unknowns; i++) {
        sensitivity[i] = along[unknowns[i]];
    }
    return fine;
}

Fault core_adjoint(State *s, const unsigned int unknowns[], size_t n_unknowns, const unsigned int knowns[],
                   size_t n_knowns, const double seed[], double sensitivity[])
{
    Fault fault = check_references(s, unknowns, n_unknowns, knowns, n_knowns);
    double direction[N_VARIABLES], along[N_VARIABLES], sums[N_VARIABLES];
    size_t i, j;
    if (fault.severity != FINE) {
        return fault;
    }
    memset(sums, 0, sizeof sums);
    for (j = 0; j < n_knowns; j++) {
        memset(direction, 0, sizeof direction);
        memset(along, 0, sizeof along);
        direction[knowns[j]] = 1.0;
        model_direction(&s->model, direction, along);
        sums[knowns[j]] = 0.0;
        for (i = 0; i < n_unknowns; i++) {
            sums[knowns[j]] += along[unknowns[i]] * seed[i];
        }
        fault = check_finite(&sums[knowns[j]], 1);
        if (fault.severity != FINE) {
            return fault;
        }
    }
    for (j = 0; j < n_knowns; j++) {
        sensitivity[j] = sums[knowns[j]];
    }
    return fine;
}

Fault core_output_slope(State *s, unsigned int reference, double *value)
{
    double direction[N_VARIABLES], along[N_VARIABLES];
    Fault fault;
    int i;
    if (reference >= N_VARIABLES || core_variables[reference].role != OUTPUT
        || core_variables[reference].type != REAL) {
        return refuse("not a real output");
    }
    fault = core_rates(s);
    if (fault.severity != FINE) {
        return fault;
    }
    memset(direction, 0, sizeof direction);
    memset(along, 0, sizeof along);
    direction[VR_approach] = s->model.rate;
    direction[VR_rate] = s->turn;
    for (i = 0; i < N_STATES; i++) {
        direction[FIRST_STATE + i] = s->model.value[FIRST_DERIVATIVE + i];
    }
    model_direction(&s->model, direction, along);
    fault = check_finite(&along[reference], 1);
    if (fault.severity == FINE) {
        *value = along[reference];
    }
    return fault;
}
