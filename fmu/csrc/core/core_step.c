/* Steps of co-simulation, and derivatives, of an FMU of any version; see core.h. */
#include "core.h"

#include <math.h>
#include <string.h>

static const Fault fine = {FINE, NULL};

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

static const int rate_of[N_INPUTS] = INPUT_RATES;

static int is_set(const State *s, int order, int k)
{
    return (s->slopes_set[order - 1] >> k & 1U) != 0;
}

static int has_history(const State *s, double time)
{
    return s->has_last && time > s->last_time;
}

/* The slope of an input that is no approach, at the start of a step. */
static double turn_of(const State *s, int k, double time)
{
    if (is_set(s, 1, k)) {
        return s->input_slope[0][k];
    }
    return has_history(s, time) ? (s->model.value[k] - s->last[k]) / (time - s->last_time) : 0.0;
}

/* The bend that the mean rate has missed in the last change of the approach, for the step to come. A master that advances the
 * approach by the rate at the end of its steps (symplectic Euler) misses half the change of the rate, in the next step
 * again; more than that is a jump, which tells nothing of the next step. */
static double missed(const State *s, int k, double turn, double time)
{
    const double before = time - s->last_time, most = fabs(turn);
    const double mean = 0.5 * (s->model.value[rate_of[k]] + s->last[rate_of[k]]);
    const double again = 2.0 * (s->model.value[k] - s->last[k] - before * mean) / before / before;
    return again > most ? most : again < -most ? -most : isfinite(again) ? again : 0.0;
}

/* An input that goes on by its derivatives: those that were set, or an approach by its rate, others by their last change. */
static void extrapolate(const State *s, int k, double time, double h, Motion *motion)
{
    const double x = s->model.value[k];
    Path *p = &motion->input[k];
    p->bend = 0.0;
    if (rate_of[k] < 0) {
        p->slope = turn_of(s, k, time);
        p->end = x + h * p->slope;
        return;
    }
    p->slope = is_set(s, 1, k) ? s->input_slope[0][k] : s->model.value[rate_of[k]];
    if (is_set(s, 2, k)) {
        p->bend = s->input_slope[1][k];
    } else {
        p->bend = motion->input[rate_of[k]].slope;
        if ((s->slopes_set[0] | s->slopes_set[1]) == 0 && has_history(s, time)) {
            p->bend += missed(s, k, p->bend, time);
        }
    }
    p->end = x + h * (p->slope + 0.5 * h * p->bend);
}

/* The motion of a step, from the inputs and what they mean. */
static Fault motion_of(const State *s, double time, double h, Motion *motion)
{
    const Fault too_large = {DISCARD, "the motion of the inputs within the step is too large for a floating-point number"};
    const double meaning = s->model.value[VR_input_meaning];
    int k;
    motion->meaning = meaning < 1.5 ? EXTRAPOLATED : meaning < 2.5 ? AT_THE_END : HELD;
    for (k = N_INPUTS - 1; k >= 0; k--) { /* a rate before its approach */
        const double x = s->model.value[k];
        Path *p = &motion->input[k];
        if (!isfinite(x)) {
            return refuse(INPUT_NAMES " must be finite");
        }
        p->start = p->end = x;
        p->slope = p->bend = 0.0;
        if (motion->meaning == EXTRAPOLATED) {
            extrapolate(s, k, time, h, motion);
        } else if (motion->meaning == AT_THE_END) {
            p->start = s->now[k];
            p->slope = rate_of[k] < 0 ? (x - p->start) / h : 0.0;
        }
        if (!(isfinite(p->end) && isfinite(p->slope))) {
            return too_large;
        }
    }
    return fine;
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
    int k;
    if (fault.severity != FINE) {
        return fault;
    }
    fault = motion_of(s, time, h, &motion);
    if (fault.severity != FINE) {
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
    memcpy(s->last, s->model.value, sizeof s->last);
    s->has_last = 1;
    s->time = time + h;
    for (k = 0; k < N_INPUTS; k++) {
        s->now[k] = motion.input[k].end;
        s->turn[k] = motion.input[k].slope;
    }
    s->slopes_set[0] = s->slopes_set[1] = 0;
    s->stale = N_STATES == 0 ? 0 : STALE_RATES;
    return fine;
}

/* ---- derivatives of inputs and outputs in time ---- */

Fault core_may_set_slope(const State *s, unsigned int reference, int order, double value)
{
    if (reference >= N_INPUTS || !(order == 1 || (order == 2 && rate_of[reference] >= 0))) {
        return refuse("only first derivatives of inputs can be set, and the second one of an approach");
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
    s->input_slope[order - 1][reference] = value;
    s->slopes_set[order - 1] |= 1ULL << reference;
}

/* ---- partial derivatives ---- */

static int is_unknown(unsigned int reference)
{
    Role role;
    if (reference >= N_VARIABLES || core_variables[reference].type != REAL) {
        return 0;
    }
    role = core_variables[reference].role;
    return role == OUTPUT || role == DERIVATIVE || role == STATE; /* a state may be an output too */
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
            return refuse("an unknown is a real output, a state or its derivative");
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

/* What is computed, and the states themselves, along a direction. */
static void go_along(const State *s, const double direction[], double along[])
{
    memset(along, 0, N_VARIABLES * sizeof along[0]);
    memcpy(&along[FIRST_STATE], &direction[FIRST_STATE], N_STATES * sizeof along[0]);
    model_direction(&s->model, direction, along);
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
    for (i = 0; i < n_knowns; i++) {
        direction[knowns[i]] += seed[i];
    }
    go_along(s, direction, along);
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
        direction[knowns[j]] = 1.0;
        go_along(s, direction, along);
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
    if (!is_unknown(reference) || core_variables[reference].role == DERIVATIVE) {
        return refuse("not a real output");
    }
    fault = core_rates(s);
    if (fault.severity != FINE) {
        return fault;
    }
    memset(direction, 0, sizeof direction);
    for (i = 0; i < N_INPUTS; i++) {
        direction[i] = rate_of[i] < 0 ? s->turn[i] : s->model.input[rate_of[i]];
    }
    for (i = 0; i < N_STATES; i++) {
        direction[FIRST_STATE + i] = s->model.value[FIRST_DERIVATIVE + i];
    }
    go_along(s, direction, along);
    fault = check_finite(&along[reference], 1);
    if (fault.severity == FINE) {
        *value = along[reference];
    }
    return fault;
}
