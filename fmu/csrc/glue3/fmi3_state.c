/* FMI 3.0 around the core: saving, restoring and serializing the state of an instance. */
#include "fmi3_instance.h"

#include <stdlib.h>
#include <string.h>

static const char token[] = "FMI 3.0 " MODEL_TOKEN;

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *FMUState)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3GetFMUState");
    if (instance == NULL || FMUState == NULL) {
        return fmi3Error;
    }
    if (*FMUState == NULL) {
        *FMUState = calloc(1, sizeof(Saved));
    }
    if (*FMUState == NULL) {
        return fail(instance, "fmi3GetFMUState", "out of memory");
    }
    core_save(&instance->state, token, (Saved *)*FMUState);
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState FMUState)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3SetFMUState");
    if (instance == NULL || FMUState == NULL) {
        return fmi3Error;
    }
    return outcome(instance, core_load(&instance->state, token, (const Saved *)FMUState), "fmi3SetFMUState");
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *FMUState)
{
    if (enter(c, ANY_PHASE, "fmi3FreeFMUState") == NULL) {
        return fmi3Error;
    }
    if (FMUState != NULL) {
        free(*FMUState);
        *FMUState = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState FMUState, size_t *size)
{
    if (enter(c, ANY_PHASE, "fmi3SerializedFMUStateSize") == NULL || FMUState == NULL || size == NULL) {
        return fmi3Error;
    }
    *size = sizeof(Saved);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3SerializeFMUState");
    if (instance == NULL || FMUState == NULL || serializedState == NULL) {
        return fmi3Error;
    }
    if (size < sizeof(Saved)) {
        return fail(instance, "fmi3SerializeFMUState", "the buffer is too small");
    }
    memcpy(serializedState, FMUState, sizeof(Saved));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte serializedState[], size_t size,
                                   fmi3FMUState *FMUState)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3DeserializeFMUState");
    State probe;
    Saved saved;
    Fault fault;
    if (instance == NULL || serializedState == NULL || FMUState == NULL) {
        return fmi3Error;
    }
    if (size != sizeof saved) {
        return fail(instance, "fmi3DeserializeFMUState", "not a state of this FMU: wrong size");
    }
    memcpy(&saved, serializedState, sizeof saved);
    probe = instance->state;
    fault = core_load(&probe, token, &saved);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi3DeserializeFMUState");
    }
    if (*FMUState == NULL) {
        *FMUState = calloc(1, sizeof saved);
    }
    if (*FMUState == NULL) {
        return fail(instance, "fmi3DeserializeFMUState", "out of memory");
    }
    memcpy(*FMUState, &saved, sizeof saved);
    return fmi3OK;
}
