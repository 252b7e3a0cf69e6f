/* Variables and call sequence of an FMU of any version; see core.h. */
#include "core.h"

#include <math.h>
#include <string.h>

#include "variables.h"

static const Fault fine = {FINE, NULL};

/* ---- values ---- */

void core_start(State *s, Kind kind)
{
    int i;
    memset(s, 0, sizeof *s);
    for (i = 0; i < N_VARIABLES; i++) {
        s->model.value[i] = core_variables[i].start;
    }
    memcpy(s->model.input, s->model.value, sizeof s->model.input);
    s->tolerance = DEFAULT_TOLERANCE;
    s->phase = INSTANTIATED;
    s->kind = (int)kind;
    s->model.stage = kind == MODEL_EXCHANGE ? STARTING : IN_STEPS;
    s->stale = STALE_LAW | STALE_OUTPUTS | STALE_RATES;
}

static int is_known(unsigned int reference, Type type)
{
    return reference < N_VARIABLES && core_variables[reference].type == type;
}

static const char unknown[] = "no variable of this type has this value reference";

/* The phases in which a variable may be set, by its role and the kind of instance; none for what is computed. */
enum { BEFORE = INSTANTIATED | INITIALIZATION, CHANGING = EVENT | CONTINUOUS };
static const int settable_in[8][2] = { /* CO_SIMULATION, MODEL_EXCHANGE */
    {BEFORE | STEPPING | CHANGING, BEFORE | STEPPING | CHANGING}, /* INPUT */
    {BEFORE | STEPPING | EVENT, BEFORE | EVENT},                  /* TUNABLE */
    {BEFORE, BEFORE},                                             /* FIXED */
    {0, 0},                                                       /* CONSTANT */
    {BEFORE, BEFORE | CHANGING},                                  /* STATE: CasADi sets them so */
    {0, 0}, {0, 0}, {0, 0}                                        /* DERIVATIVE, OUTPUT, MEASURE */
};

Fault core_may_set(const State *s, unsigned int reference, Type type, double value)
{
    int phases;
    if (!is_known(reference, type)) {
        return refuse(unknown);
    }
    phases = settable_in[core_variables[reference].role][s->kind];
    if (phases == 0) {
        return refuse("an output, a state's derivative or a constant cannot be set");
    }
    if ((phases & s->phase) == 0) {
        return refuse("this variable cannot be set at this point of the call sequence");
    }
    if (reference == VR_LEAD && !(value >= 0.0 && value <= MOST_LEAD)) {
        return refuse(LEAD_NAME " is from 0 to " LEAD_MOST " steps");
    }
    return fine;
}

Fault core_set(State *s, const unsigned int references[], size_t count, Type type, const double values[])
{
    size_t i;
    int stale;
    for (i = 0; i < count; i++) {
        const Fault fault = core_may_set(s, references[i], type, values[i]);
        if (fault.severity != FINE) {
            return fault;
        }
    }
    stale = count > 0 ? STALE_OUTPUTS | STALE_RATES : 0;
    for (i = 0; i < count; i++) {
        const Role role = core_variables[references[i]].role;
        s->model.value[references[i]] = values[i];
        stale |= role == TUNABLE || role == FIXED ? STALE_LAW : role == INPUT ? STALE_INPUTS : 0;
    }
    s->stale |= stale;
    return fine;
}

/* Outputs by parameters that were set; on a copy, so that a law that is refused changes nothing. */
static Fault tuned(Model *model)
{
    Model anew = *model;
    Fault fault = model_prepare(&anew);
    if (fault.severity == FINE) {
        fault = model_evaluate(&anew);
    }
    if (fault.severity == FINE) {
        *model = anew;
    }
    return fault;
}

/* Outputs that do not exist are no error of the call: other inputs or parameters can help. */
Fault core_outputs(State *s)
{
    double before[N_INPUTS], force[N_INPUTS];
    const int early = s->phase == STEPPING && (s->stale & STALE_INPUTS) != 0;
    Fault fault;
    int k;
    if ((s->stale & (STALE_LAW | STALE_OUTPUTS)) == 0) {
        return fine;
    }
    for (k = 0; k < N_INPUTS; k++) {
        force[k] = force_on[k] < 0 ? 0.0 : s->model.value[force_on[k]];
    }
    memcpy(before, s->model.input, sizeof before);
    if ((s->stale & STALE_INPUTS) != 0) {
        memcpy(s->model.input, s->model.value, sizeof before);
    }
    fault = core_check_inputs(s->model.input);
    if (fault.severity == FINE) {
        fault = (s->stale & STALE_LAW) != 0 ? tuned(&s->model) : model_evaluate(&s->model);
    }
    if (fault.severity == FINE) {
        s->stale &= ~(STALE_LAW | STALE_INPUTS | STALE_OUTPUTS | (N_STATES == 0 ? STALE_RATES : 0));
        for (k = 0; early && k < N_INPUTS; k++) {
            s->read_early |= force_on[k] >= 0 && s->model.value[force_on[k]] != force[k];
        }
    } else {
        memcpy(s->model.input, before, sizeof before);
        fault.severity = DISCARD;
    }
    return fault;
}

Fault core_rates(State *s)
{
    Fault fault = core_outputs(s);
    if (fault.severity == FINE && (s->stale & STALE_RATES) != 0) {
        fault = model_rates(&s->model);
        s->stale &= fault.severity == FINE ? ~STALE_RATES : ~0;
    }
    return fault;
}

Fault core_get(State *s, const unsigned int references[], size_t count, Type type, double values[])
{
    size_t i;
    for (i = 0; i < count; i++) {
        Role role;
        Fault fault = fine;
        if (!is_known(references[i], type)) {
            return refuse(unknown);
        }
        role = core_variables[references[i]].role;
        if (role == OUTPUT || role == MEASURE || (role == STATE && s->phase == INITIALIZATION)) {
            fault = core_outputs(s);
        } else if (role == DERIVATIVE) {
            fault = core_rates(s);
        }
        if (fault.severity != FINE) {
            return fault;
        }
        values[i] = s->model.value[references[i]];
    }
    return fine;
}

/* ---- call sequence ---- */

Fault core_setup(State *s, double start, int has_stop, double stop, int has_tolerance, double tolerance)
{
    if (!isfinite(start) || (has_stop && !(stop >= start))) {
        return refuse("the start time must be finite and the stop time not before it");
    }
    if (has_tolerance && !(tolerance > 0.0 && isfinite(tolerance))) {
        return refuse("the tolerance must be finite and > 0");
    }
    s->time = start;
    s->stop_time = has_stop ? stop : 0.0;
    s->has_stop_time = has_stop != 0;
    s->tolerance = has_tolerance ? tolerance : DEFAULT_TOLERANCE;
    return fine;
}

Fault core_exit_initialization(State *s)
{
    const Fault fault = core_outputs(s);
    if (fault.severity != FINE) {
        return refuse(fault.reason);
    }
    memcpy(s->now, s->model.input, sizeof s->now);
    s->contact = core_contact(s);
    if (s->kind == MODEL_EXCHANGE) {
        s->model.stage = IN_CONTINUOUS_TIME;
    }
    s->phase = s->kind == MODEL_EXCHANGE ? EVENT : STEPPING;
    return fine;
}

/* ---- model exchange ---- */

void core_set_states(State *s, const double states[])
{
    int i;
    for (i = 0; i < N_STATES; i++) {
        s->model.value[FIRST_STATE + i] = states[i];
    }
    s->stale |= STALE_OUTPUTS | STALE_RATES;
}

Fault core_set_time(State *s, double time)
{
    if (!isfinite(time)) {
        return refuse("the time must be finite");
    }
    s->time = time;
    return fine;
}

unsigned long long core_contact(const State *s)
{
    unsigned long long contact = 0;
    int i;
#ifdef PLAIN_STEPS
    if (s->kind == CO_SIMULATION) {
        return 0;
    }
#endif
    for (i = 0; i < N_CONTACTS; i++) {
        contact |= (s->model.indicator[i] > 0.0 ? 1ULL : 0ULL) << i;
    }
    return contact;
}

Fault core_contact_changed(State *s, int *changed)
{
    const Fault fault = core_outputs(s);
    if (fault.severity == FINE) {
        const unsigned long long contact = core_contact(s);
        *changed = contact != s->contact;
        s->contact = contact;
    }
    return fault;
}

/* ---- validity ---- */

const char *core_warning(State *s, char *text, size_t size)
{
    static const char lead[] = "outside the validity box:";
    const unsigned long long outside = model_outside(&s->model), before = s->noticed;
    s->noticed = outside;
    if ((outside & ~before) == 0) {
        return NULL;
    }
    memcpy(text, lead, sizeof lead);
    model_name_outside(&s->model, outside, text + sizeof lead - 1, size - sizeof lead + 1);
    return text;
}

/* ---- saved states ---- */

/* FNV-1a over some bytes; `hash` is what came before. */
static unsigned long long hashed(unsigned long long hash, const void *bytes, size_t size)
{
    const unsigned char *byte = (const unsigned char *)bytes;
    size_t i;
    for (i = 0; i < size; i++) {
        hash = (hash ^ byte[i]) * 1099511628211ULL;
    }
    return hash;
}

static unsigned long long identity_of(const char *token, int kind)
{
    return hashed(hashed(14695981039346656037ULL, token, strlen(token)), &kind, sizeof kind);
}

void core_save(const State *s, const char *token, Saved *saved)
{
    saved->identity = identity_of(token, s->kind);
    saved->state = *s;
    saved->checksum = hashed(saved->identity, &saved->state, sizeof saved->state);
}

Fault core_load(State *s, const char *token, const Saved *saved)
{
    if (saved->identity != identity_of(token, s->kind)) {
        return refuse("not a state of this FMU, FMI version and kind of instance");
    }
    if (saved->checksum != hashed(saved->identity, &saved->state, sizeof saved->state)) {
        return refuse("the state is damaged");
    }
    *s = saved->state;
    return fine;
}
