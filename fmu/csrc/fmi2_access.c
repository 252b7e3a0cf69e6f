/* FMI 2.0 for co-simulation around any model of model.h: variables, derivatives, state. */
#include "fmi2_instance.h"

#include <stdio.h>
#include <string.h>

static fmi2Status unknown_variable(const Instance *instance, const char *function, fmi2ValueReference reference)
{
    char text[80];
    snprintf(text, sizeof text, "no variable of this type has value reference %u", reference);
    return fail(instance, function, text);
}

/* The outputs do not exist for the present inputs and parameters. */
static fmi2Status unavailable(const Instance *instance, const char *function)
{
    log_call(instance, fmi2Discard, LOG_DISCARD, function, model_fault(&instance->state.model));
    return fmi2Discard;
}

/* NULL arrays are legal only for no elements. */
static int missing(const void *references, const void *values, size_t count)
{
    return count > 0 && (references == NULL || values == NULL);
}

/* ---- variables ---- */

enum { READABLE = INITIALIZATION | STEPPING | TERMINATED, WRITABLE = INSTANTIATED | INITIALIZATION | STEPPING };

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    Instance *instance = enter(c, READABLE, "fmi2GetReal");
    size_t i;
    if (instance == NULL || missing(vr, value, nvr)) {
        return fmi2Error;
    }
    for (i = 0; i < nvr; i++) {
        switch (model_get_real(&instance->state.model, vr[i], &value[i])) {
        case MODEL_OK: break;
        case MODEL_UNAVAILABLE: return unavailable(instance, "fmi2GetReal");
        default: return unknown_variable(instance, "fmi2GetReal", vr[i]);
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[])
{
    Instance *instance = enter(c, READABLE, "fmi2GetBoolean");
    size_t i;
    if (instance == NULL || missing(vr, value, nvr)) {
        return fmi2Error;
    }
    for (i = 0; i < nvr; i++) {
        if (model_get_boolean(&instance->state.model, vr[i], &value[i]) != MODEL_OK) {
            return unknown_variable(instance, "fmi2GetBoolean", vr[i]);
        }
    }
    return fmi2OK;
}

/* All values or none: a bad reference must not leave half of them set. */
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[])
{
    Instance *instance = enter(c, WRITABLE, "fmi2SetReal");
    Model changed;
    size_t i;
    if (instance == NULL || missing(vr, value, nvr)) {
        return fmi2Error;
    }
    changed = instance->state.model;
    for (i = 0; i < nvr; i++) {
        switch (model_set_real(&changed, vr[i], value[i])) {
        case MODEL_OK: break;
        case MODEL_READ_ONLY: return fail(instance, "fmi2SetReal", "an output cannot be set");
        default: return unknown_variable(instance, "fmi2SetReal", vr[i]);
        }
    }
    instance->state.model = changed;
    return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[], size_t nUnknown,
                                        const fmi2ValueReference vKnown_ref[], size_t nKnown,
                                        const fmi2Real dvKnown[], fmi2Real dvUnknown[])
{
    Instance *instance = enter(c, READABLE, "fmi2GetDirectionalDerivative");
    size_t i, j;
    if (instance == NULL || missing(vUnknown_ref, dvUnknown, nUnknown) || missing(vKnown_ref, dvKnown, nKnown)) {
        return fmi2Error;
    }
    for (i = 0; i < nUnknown; i++) {
        double sum = 0.0;
        for (j = 0; j < nKnown; j++) {
            double partial = 0.0;
            switch (model_partial(&instance->state.model, vUnknown_ref[i], vKnown_ref[j], &partial)) {
            case MODEL_OK: break;
            case MODEL_UNAVAILABLE: return unavailable(instance, "fmi2GetDirectionalDerivative");
            default:
                return fail(instance, "fmi2GetDirectionalDerivative", "only outputs by inputs are provided");
            }
            sum += partial * dvKnown[j];
        }
        dvUnknown[i] = sum;
    }
    return fmi2OK;
}

/* ---- state ---- */

/* The serialized state: which FMU it belongs to, then the state. */
static const char state_tag[] = MODEL_GUID;
enum { SERIALIZED_SIZE = sizeof state_tag + sizeof(State) };

static int is_state(const State *state)
{
    return state->phase == INSTANTIATED || state->phase == INITIALIZATION || state->phase == STEPPING
           || state->phase == TERMINATED;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2GetFMUstate");
    if (instance == NULL || FMUstate == NULL) {
        return fmi2Error;
    }
    if (*FMUstate == NULL) {
        *FMUstate = allocate(&instance->callbacks, sizeof(State));
    }
    if (*FMUstate == NULL) {
        return fail(instance, "fmi2GetFMUstate", "out of memory");
    }
    memcpy(*FMUstate, &instance->state, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2SetFMUstate");
    if (instance == NULL || FMUstate == NULL) {
        return fmi2Error;
    }
    memcpy(&instance->state, FMUstate, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2FreeFMUstate");
    if (instance == NULL) {
        return fmi2Error;
    }
    if (FMUstate != NULL && *FMUstate != NULL) {
        release(&instance->callbacks, *FMUstate);
        *FMUstate = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    if (enter(c, ANY_PHASE, "fmi2SerializedFMUstateSize") == NULL || FMUstate == NULL || size == NULL) {
        return fmi2Error;
    }
    *size = SERIALIZED_SIZE;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2SerializeFMUstate");
    if (instance == NULL || FMUstate == NULL || serializedState == NULL) {
        return fmi2Error;
    }
    if (size < SERIALIZED_SIZE) {
        return fail(instance, "fmi2SerializeFMUstate", "the buffer is too small");
    }
    memcpy(serializedState, state_tag, sizeof state_tag);
    memcpy(serializedState + sizeof state_tag, FMUstate, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2DeSerializeFMUstate");
    State state;
    if (instance == NULL || serializedState == NULL || FMUstate == NULL) {
        return fmi2Error;
    }
    if (size < SERIALIZED_SIZE || memcmp(serializedState, state_tag, sizeof state_tag) != 0) {
        return fail(instance, "fmi2DeSerializeFMUstate", "not a state of this FMU");
    }
    memcpy(&state, serializedState + sizeof state_tag, sizeof state);
    if (!is_state(&state)) {
        return fail(instance, "fmi2DeSerializeFMUstate", "the state is damaged");
    }
    if (*FMUstate == NULL) {
        *FMUstate = allocate(&instance->callbacks, sizeof state);
    }
    if (*FMUstate == NULL) {
        return fail(instance, "fmi2DeSerializeFMUstate", "out of memory");
    }
    memcpy(*FMUstate, &state, sizeof state);
    return fmi2OK;
}
