/* FMI 2.0 around the core: saving, restoring and serializing the state of an instance. */
#include "fmi2_instance.h"

#include <string.h>

static const char token[] = "FMI 2.0 " MODEL_TOKEN;

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2GetFMUstate");
    if (instance == NULL || FMUstate == NULL) {
        return fmi2Error;
    }
    if (*FMUstate == NULL) {
        *FMUstate = allocate(&instance->callbacks, sizeof(Saved));
    }
    if (*FMUstate == NULL) {
        return fail(instance, "fmi2GetFMUstate", "out of memory");
    }
    core_save(&instance->state, token, (Saved *)*FMUstate);
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2SetFMUstate");
    if (instance == NULL || FMUstate == NULL) {
        return fmi2Error;
    }
    return outcome(instance, core_load(&instance->state, token, (const Saved *)FMUstate), "fmi2SetFMUstate");
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
    *size = sizeof(Saved);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2SerializeFMUstate");
    if (instance == NULL || FMUstate == NULL || serializedState == NULL) {
        return fmi2Error;
    }
    if (size < sizeof(Saved)) {
        return fail(instance, "fmi2SerializeFMUstate", "the buffer is too small");
    }
    memcpy(serializedState, FMUstate, sizeof(Saved));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2DeSerializeFMUstate");
    State probe;
    Saved saved;
    Fault fault;
    if (instance == NULL || serializedState == NULL || FMUstate == NULL) {
        return fmi2Error;
    }
    if (size != sizeof saved) {
        return fail(instance, "fmi2DeSerializeFMUstate", "not a state of this FMU: wrong size");
    }
    memcpy(&saved, serializedState, sizeof saved);
    probe = instance->state;
    fault = core_load(&probe, token, &saved);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi2DeSerializeFMUstate");
    }
    if (*FMUstate == NULL) {
        *FMUstate = allocate(&instance->callbacks, sizeof saved);
    }
    if (*FMUstate == NULL) {
        return fail(instance, "fmi2DeSerializeFMUstate", "out of memory");
    }
    memcpy(*FMUstate, &saved, sizeof saved);
    return fmi2OK;
}
