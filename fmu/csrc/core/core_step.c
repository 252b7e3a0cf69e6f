/* Steps of co-simulation, and derivatives, of an FMU of any version; see core.h. */
#include "core.h"

#include <math.h>
#include <string.h>

static const Fault fine = {FINE, NULL};

static Fault check_step(const State *s, double time, double h)
{
    static const double longest = 1e9; /* s: thirty years */
    const double end = time + h;
    if (h > longest) {
        return refuse("the step size must be at most 1e9");
    }
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

int core_extrapolates(const State *s)
{
#ifdef LEAD_OF_INPUTS
    return s->model.value[VR_LEAD] < 1.0;
#else
    return s->model.value[VR_LEAD] > 0.0;
#endif
}

int core_path_is_known(const State *s)
{
#ifdef LEAD_OF_INPUTS
    return s->model.value[VR_LEAD] < 1.0;
#else
    return s->model.value[VR_LEAD] >= 1.0;
#endif
}

static int is_set(const State *s, int order, int k)
{
    return (s->slopes_set[order - 1] >> k & 1U) != 0;
}

/* ---- how inputs go on: from the inputs of this step and of the two before ---- */

/* Paths that begin at the inputs. */
static void begin_at_inputs(const State *s, Motion *motion)
{
    int k;
    motion->known = 1;
    for (k = 0; k < N_INPUTS; k++) {
        Path *p = &motion->input[k];
        p->end = s->model.value[k];
        p->bend = 0.0;
        p->slope = is_set(s, 1, k) ? s->input_slope[0][k] : rate_of[k] < 0 ? 0.0 : s->model.value[rate_of[k]];
    }
}

#ifdef LEAD_OF_INPUTS

#ifndef REACHED
#define REACHED (-1) /* an input that is no force: a step goes straight to its value, whatever the lead */
#endif

/* Forces that are those of the time `lead` steps after the start go through a step straight, those of its middle are held:
 * a slope from forces before would take K h (w h)^2/6 off the damping of contacts outside. */
static double motion_of(const State *s, double time, double h, Motion *motion, Motion *ahead)
{
    const double lead = s->model.value[VR_LEAD];
    int k;
    (void)ahead;
    begin_at_inputs(s, motion);
    for (k = 0; k < N_INPUTS; k++) {
        Path *p = &motion->input[k];
        const double x = p->end, before = s->n_given > 0 ? (1.0 - lead) * (time - s->given_time[0]) + lead * h : 0.0;
        if (lead >= 1.0 || k == REACHED) {
            p->start = s->now[k];
            p->slope = (x - p->start) / h;
        } else {
            if (!is_set(s, 1, k) && before > 0.0 && lead != 0.5) {
                p->slope = (x - s->given[0][k]) / before;
            }
            p->start = x - lead * h * p->slope;
            p->end = x + (1.0 - lead) * h * p->slope;
        }
    }
    return 0.0;
}

#else

/* Mean slopes of an input over the last steps, the later one first, and the lengths of these steps; returns how many. */
static int slopes_before(const State *s, int k, double time, double slope[2], double length[2])
{
    double x = s->model.value[k];
    int n;
    for (n = 0; n < s->n_given; n++) {
        length[n] = time - s->given_time[n];
        slope[n] = (x - s->given[n][k]) / length[n];
        if (!(length[n] > 0.0 && isfinite(slope[n]))) {
            break;
        }
        time = s->given_time[n];
        x = s->given[n][k];
    }
    return n;
}

/* The slope of an input at some time after the inputs. A mass under a force that is held has a constant slope of its rate in
 * every step: the slopes of the last two steps, at their middles, go on along a straight line, in steps like those. */
static double slope_after(const State *s, int k, double time, double after)
{
    double slope[2], length[2], reach;
    const int n = slopes_before(s, k, time, slope, length);
    if (is_set(s, 1, k)) {
        return s->input_slope[0][k];
    }
    if (n < 2) {
        return n == 0 ? 0.0 : slope[0];
    }
    reach = (2.0 * after + length[0]) / (length[0] + length[1]);
    return slope[0] + (reach < 2.0 ? reach : 2.0) * (slope[0] - slope[1]);
}

/* What masters add to the approach in a step beyond its mean rate, over what the change of the rate adds: 0 where masses go
 * through their steps exactly, 1 where they advance the approach by the rate at the end of a step (symplectic Euler). More is
 * a jump, which says nothing of the next step. */
static double missed_share(const State *s, int k, double time)
{
    double slope[2], length[2], missed;
    if ((s->slopes_set[0] | s->slopes_set[1]) != 0 || slopes_before(s, rate_of[k], time, slope, length) == 0 || slope[0] == 0.0) {
        return 0.0;
    }
    missed = (s->model.value[k] - s->given[0][k]) / length[0] - 0.5 * (s->model.value[rate_of[k]] + s->given[0][rate_of[k]]);
    missed /= 0.5 * length[0] * slope[0];
    return missed > 1.0 ? 1.0 : missed < -1.0 ? -1.0 : isfinite(missed) ? missed : 0.0;
}

/* Whether an input is a displacement or its rate. Others, the speed of a shaft, are held in a step: beyond what was given they
 * could be what no shaft does. */
static int moves(int k)
{
    int j;
    for (j = 0; j < N_INPUTS && rate_of[j] != k; j++) {
    }
    return rate_of[k] >= 0 || j < N_INPUTS;
}

/* Lengthens paths by `length` from where they end; `middle` of the master's step there, from the inputs. */
static void go_on(const State *s, double time, double middle, double length, Motion *motion)
{
    int k;
    for (k = N_INPUTS - 1; k >= 0; k--) { /* a rate before its approach */
        Path *p = &motion->input[k];
        p->start = p->end;
        if (rate_of[k] < 0) {
            p->slope = moves(k) || is_set(s, 1, k) ? slope_after(s, k, time, middle) : 0.0;
        } else {
            p->bend = is_set(s, 2, k) ? s->input_slope[1][k]
                                      : motion->input[rate_of[k]].slope * (1.0 + missed_share(s, k, time));
        }
        p->end = p->start + length * (p->slope + 0.5 * length * p->bend);
    }
}

/* The motion of a step, and what follows it until the time that the outputs are for; returns how long that is. With a lead of
 * a step and more the inputs are those of the step's start, with less those of its end. */
static double motion_of(const State *s, double time, double h, Motion *motion, Motion *ahead)
{
    const double lead = s->model.value[VR_LEAD], length = lead < 1.0 ? 0.0 : h, beyond = lead * h - length;
    int k;
    begin_at_inputs(s, motion);
    *ahead = *motion;
    if (lead < 1.0) {
        motion->known = 0;
        for (k = 0; k < N_INPUTS; k++) {
            Path *p = &motion->input[k];
            p->start = s->now[k];
            p->slope = rate_of[k] < 0 ? (p->end - p->start) / h : 0.0;
        }
    } else {
        go_on(s, time, 0.5 * h, h, motion);
        *ahead = *motion;
        for (k = 0; k < N_INPUTS; k++) {
            ahead->input[k].slope += h * ahead->input[k].bend;
        }
    }
    go_on(s, time, length + 0.5 * h, beyond, ahead);
    return beyond;
}

#endif

#ifndef LEAD_OF_INPUTS

/* Where inputs go on beyond what was given: how well they did, in blocks of steps, each rate by itself. Of a vibration w is
 * missed (w h)^2 of the change of its rate; a jump spoils one block, or two. -1 where too little moves. */
static int block_is_too_long(State *s)
{
    static const double most = 0.03;   /* w h = 0.17: the damping of a contact is 10 % too large where its ratio is 0.002 */
    static const double still = 1e-6;  /* of the nominal rate: no motion */
    static const double small = 0.01;  /* of the largest motion so far: what is left of it, or noise beside it */
    int k, found = 0, judged = 0;
    for (k = 0; k < N_INPUTS; k++) {
        s->most_moved = s->moved[k] > s->most_moved ? s->moved[k] : s->most_moved;
    }
    for (k = 0; k < N_INPUTS; k++) {
        const double moved = s->moved[k], least = small * small * s->most_moved;
        if (moved > still * still && moved >= least) {
            judged = 1;
            found |= s->missed[k] > most * most * moved;
        }
        s->missed[k] = s->moved[k] = 0.0;
    }
    return judged ? found : -1;
}

enum { BLOCK = 64 };

/* Whether displacements change as their rates say, in blocks of steps: the mean slope of a step beside the mean of the rates at its
 * ends. Symplectic Euler is off by w h/2 of the rate. */
static void compare_rates(State *s, double time, double h)
{
    static const double most = 0.1;   /* of the sum of squares of slope and rate: the rate is 0.6 or 1.6 of the slope */
    static const double still = 1e-6; /* of the nominal rate: no motion */
    static const double small = 0.01; /* of the largest motion so far */
    const double length = core_path_is_known(s) ? time - s->given_time[0] : h;
    int k;
    if (s->n_given == 0) {
        return;
    }
    for (k = 0; k < N_INPUTS; k++) {
        if (rate_of[k] >= 0) {
            const int rate = rate_of[k];
            const double unit = 1.0 / core_variables[rate].nominal;
            const double slope = unit * (s->model.value[k] - s->given[0][k]) / length;
            const double mean = 0.5 * unit * (s->model.value[rate] + s->given[0][rate]);
            s->apart[k] += (slope - mean) * (slope - mean);
            s->travelled[k] += slope * slope + mean * mean;
        }
    }
    if (++s->compared < BLOCK) {
        return;
    }
    s->compared = 0;
    for (k = 0; k < N_INPUTS; k++) {
        s->most_travelled = s->travelled[k] > s->most_travelled ? s->travelled[k] : s->most_travelled;
    }
    for (k = 0; k < N_INPUTS; k++) {
        const double travelled = s->travelled[k];
        if (travelled > (double)BLOCK * still * still && travelled >= small * small * s->most_travelled) {
            s->unlike[k] = s->apart[k] > most * travelled ? s->unlike[k] + 1.0 : 0.0;
        }
        s->apart[k] = s->travelled[k] = 0.0;
    }
}

static void judge_step(State *s)
{
    enum { ASTRAY_STEPS = 20 };       /* of 32: a jump spoils three */
    static const double far = 0.1;    /* of the change of a rate: w h = 0.32 */
    static const double small = 1e-3; /* of the largest change so far */
    int k;
    if (s->n_given < 2 || !core_path_is_known(s)) {
        return;
    }
    for (k = 0; k < N_INPUTS; k++) {
        if (rate_of[k] >= 0) {
            const int rate = rate_of[k];
            const double unit = 1.0 / core_variables[rate].nominal, now = s->model.value[rate];
            const double missed = unit * (now - s->now[rate]), moved = unit * (now - s->given[0][rate]);
            s->most_change = fabs(moved) > s->most_change ? fabs(moved) : s->most_change;
            s->astray[k] <<= 1;
            s->astray[k] |= fabs(missed) > far * fabs(moved) && fabs(moved) > small * s->most_change ? 1ULL : 0ULL;
            s->far_astray |= count_bits(s->astray[k] & 0xffffffffULL) >= ASTRAY_STEPS;
            s->missed[k] += missed * missed;
            s->moved[k] += moved * moved;
        }
    }
    if (++s->judged == BLOCK) {
        const int found = block_is_too_long(s);
        s->too_long = found > 0 ? s->too_long + 1 : found == 0 ? 0 : s->too_long;
        s->judged = 0;
    }
}

#endif

static Fault check_motion(const Motion *motion)
{
    const Fault too_large = {DISCARD, "the motion of the inputs within the step is too large for a floating-point number"};
    int k;
    for (k = 0; k < N_INPUTS; k++) {
        const Path *p = &motion->input[k];
        if (!(isfinite(p->start) && isfinite(p->end) && isfinite(p->slope) && isfinite(p->bend))) {
            return too_large;
        }
    }
    return fine;
}

/* ---- steps ---- */

Fault core_check_inputs(const double input[])
{
    static const double farthest = 1e6; /* nominal values of a displacement: metres */
    int k;
    for (k = 0; k < N_INPUTS; k++) {
        if (!isfinite(input[k])) {
            return refuse(not_finite[k]);
        }
        if (rate_of[k] >= 0 && fabs(input[k]) > farthest * core_variables[k].nominal) {
            return fault(DISCARD, too_far[k]);
        }
    }
    return fine;
}

/* Outputs of a later time, the states as they are. */
static Fault look_ahead(Model *model, const Motion *ahead, double length, double tolerance)
{
    Model later = *model;
    const Fault fault = model_step(&later, ahead, length, tolerance);
    int i;
    for (i = 0; i < N_VARIABLES && fault.severity == FINE; i++) {
        if (core_variables[i].role == OUTPUT && core_variables[i].type == REAL) {
            model->value[i] = later.value[i];
        }
    }
    return fault;
}

Fault core_step(State *s, double time, double h)
{
    const Model before = s->model;
    Motion motion, ahead;
    Fault fault = check_step(s, time, h);
    double beyond = 0.0;
    int k;
    if (fault.severity == FINE) {
        fault = core_check_inputs(s->model.value);
    }
    if (fault.severity == FINE) {
        beyond = motion_of(s, time, h, &motion, &ahead);
        fault = check_motion(&motion);
    }
    if (fault.severity == FINE && beyond > 0.0) {
        fault = check_motion(&ahead);
    }
    if (fault.severity == FINE && (s->stale & STALE_LAW) != 0) {
        fault = model_prepare(&s->model);
    }
    if (fault.severity == FINE) {
        fault = model_step(&s->model, &motion, h, s->tolerance);
    }
    if (fault.severity == FINE && beyond > 0.0) {
        fault = look_ahead(&s->model, &ahead, beyond, s->tolerance);
    }
    if (fault.severity != FINE) {
        s->model = before;
        return fault;
    }
#ifndef LEAD_OF_INPUTS
    compare_rates(s, time, h);
    judge_step(s);
#endif
    memmove(s->given[1], s->given[0], sizeof s->given[0]);
    memcpy(s->given[0], s->model.value, sizeof s->given[0]);
    s->given_time[1] = s->given_time[0];
    s->given_time[0] = time;
    s->n_given = s->n_given < 2 ? s->n_given + 1 : 2;
    s->time = time + h;
    for (k = 0; k < N_INPUTS; k++) {
        s->now[k] = motion.input[k].end;
        s->turn[k] = motion.input[k].slope;
    }
    s->slopes_set[0] = s->slopes_set[1] = 0;
    s->read_early = s->read_early << 1 & 2;
    s->stale = N_STATES == 0 ? 0 : STALE_RATES;
    return fine;
}

const char *core_step_warning(const State *s, Told *told)
{
    enum { LONG_BLOCKS = 3, UNLIKE_BLOCKS = 2 };
    int k;
    for (k = 0; k < N_INPUTS && !told->unlike; k++) {
        if (s->unlike[k] >= (double)UNLIKE_BLOCKS) {
            told->unlike = 1;
            return unlike_rate[k];
        }
    }
    if (!told->too_long && (s->too_long >= LONG_BLOCKS || s->far_astray)) {
        told->too_long = 1;
        return "the communication steps are too long for this motion: the coupling adds to its damping";
    }
    return NULL;
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
    if (!core_extrapolates(s)) {
        return refuse("derivatives of inputs need a " LEAD_NAME " that " LEAD_EXTRAPOLATES);
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
#ifdef PLAIN_STEPS
    if (s->kind == CO_SIMULATION) {
        return refuse("this FMU has no partial derivatives in co-simulation");
    }
#endif
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
#ifdef PLAIN_STEPS
    return refuse("this FMU has no derivatives of its outputs");
#endif
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
