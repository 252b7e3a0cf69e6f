/* FMI 2.0 for co-simulation around any model of model.h: instances and the call sequence.
 * A call that fails leaves the instance as it was. */
#include "fmi2_instance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const category_names[LOG_CATEGORIES] = {
    "logStatusError", "logStatusDiscard", "logStatusWarning"};

/* ---- logging and guards ---- */

void log_call(const Instance *instance, fmi2Status status, LogCategory category, const char *function,
              const char *message)
{
    char text[256];
    if (instance->callbacks.logger != NULL && instance->logged[category]) {
        snprintf(text, sizeof text, "%s: %s.", function, message);
        instance->callbacks.logger(instance->callbacks.componentEnvironment, instance->name, status,
                                   category_names[category], text);
    }
}

fmi2Status fail(const Instance *instance, const char *function, const char *message)
{
    log_call(instance, fmi2Error, LOG_ERROR, function, message);
    return fmi2Error;
}

Instance *enter(fmi2Component c, int phases, const char *function)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL && (instance->state.phase & phases) == 0) {
        fail(instance, function, "not allowed at this point of the call sequence");
        return NULL;
    }
    return instance;
}

/* ---- versions, logging ---- */

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

/* Errors are always logged; the rest as asked for. */
static void set_logging(Instance *instance, int on)
{
    instance->logged[LOG_ERROR] = 1;
    instance->logged[LOG_DISCARD] = on;
    instance->logged[LOG_WARNING] = on;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2SetDebugLogging");
    int chosen[LOG_CATEGORIES] = {0};
    size_t i;
    int k;
    if (instance == NULL || (nCategories > 0 && categories == NULL)) {
        return fmi2Error;
    }
    for (i = 0; i < nCategories; i++) {
        for (k = 0; k < LOG_CATEGORIES; k++) {
            if (categories[i] != NULL && strcmp(categories[i], category_names[k]) == 0) {
                chosen[k] = 1;
                break;
            }
        }
        if (k == LOG_CATEGORIES) {
            return fail(instance, "fmi2SetDebugLogging", "no such log category");
        }
    }
    if (nCategories == 0) {
        set_logging(instance, loggingOn != fmi2False);
    }
    for (k = 0; k < LOG_CATEGORIES; k++) {
        if (chosen[k]) {
            instance->logged[k] = loggingOn != fmi2False || k == LOG_ERROR;
        }
    }
    return fmi2OK;
}

/* ---- creation and destruction ---- */

void *allocate(const fmi2CallbackFunctions *callbacks, size_t size)
{
    return callbacks->allocateMemory != NULL ? callbacks->allocateMemory(1, size) : calloc(1, size);
}

void release(const fmi2CallbackFunctions *callbacks, void *memory)
{
    if (callbacks->allocateMemory == NULL) {
        free(memory);
    } else if (callbacks->freeMemory != NULL) {
        callbacks->freeMemory(memory);
    }
}

static void start(Instance *instance)
{
    memset(&instance->state, 0, sizeof instance->state);
    model_start(&instance->state.model);
    instance->state.phase = INSTANTIATED;
}

static fmi2Component refuse(fmi2String name, const fmi2CallbackFunctions *callbacks, const char *message)
{
    if (callbacks != NULL && callbacks->logger != NULL) {
        callbacks->logger(callbacks->componentEnvironment, name != NULL ? name : "", fmi2Error,
                          category_names[LOG_ERROR], message);
    }
    return NULL;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    Instance *instance;
    size_t length;
    (void)fmuResourceLocation; /* nothing is read from there */
    (void)visible;
    if (functions == NULL) {
        return NULL;
    }
    if (instanceName == NULL || instanceName[0] == '\0') {
        return refuse(instanceName, functions, "fmi2Instantiate: the instance has no name.");
    }
    if (fmuType != fmi2CoSimulation) {
        return refuse(instanceName, functions, "fmi2Instantiate: this FMU is for co-simulation only.");
    }
    if (fmuGUID == NULL || strcmp(fmuGUID, MODEL_GUID) != 0) {
        return refuse(instanceName, functions, "fmi2Instantiate: wrong GUID, expected " MODEL_GUID ".");
    }
    instance = (Instance *)allocate(functions, sizeof *instance);
    if (instance == NULL) {
        return refuse(instanceName, functions, "fmi2Instantiate: out of memory.");
    }
    length = strlen(instanceName) + 1;
    instance->callbacks = *functions;
    instance->name = (char *)allocate(functions, length);
    if (instance->name == NULL) {
        release(functions, instance);
        return refuse(instanceName, functions, "fmi2Instantiate: out of memory.");
    }
    memcpy(instance->name, instanceName, length);
    set_logging(instance, loggingOn != fmi2False);
    start(instance);
    return instance;
}

void fmi2FreeInstance(fmi2Component c)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL) {
        const fmi2CallbackFunctions callbacks = instance->callbacks;
        release(&callbacks, instance->name);
        release(&callbacks, instance);
    }
}

/* ---- call sequence ---- */

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    Instance *instance = enter(c, INSTANTIATED, "fmi2SetupExperiment");
    (void)toleranceDefined; /* nothing is solved to a tolerance */
    (void)tolerance;
    if (instance == NULL) {
        return fmi2Error;
    }
    if (!isfinite(startTime) || (stopTimeDefined && !(stopTime >= startTime))) {
        return fail(instance, "fmi2SetupExperiment", "startTime must be finite and stopTime not before it");
    }
    instance->state.time = startTime;
    instance->state.stop_time = stopTimeDefined ? stopTime : 0.0;
    instance->state.has_stop_time = stopTimeDefined != fmi2False;
    return fmi2OK;
}

static fmi2Status change_phase(fmi2Component c, Phase from, Phase to, const char *function)
{
    Instance *instance = enter(c, (int)from, function);
    if (instance == NULL) {
        return fmi2Error;
    }
    instance->state.phase = (int)to;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return change_phase(c, INSTANTIATED, INITIALIZATION, "fmi2EnterInitializationMode");
}

/* Tells once that the model has something to say, until it has not. */
static void notice(Instance *instance, const char *function)
{
    const char *text = model_notice(&instance->state.model);
    if (text != NULL && !instance->state.noticed) {
        log_call(instance, fmi2Warning, LOG_WARNING, function, text);
    }
    instance->state.noticed = text != NULL;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *instance = enter(c, INITIALIZATION, "fmi2ExitInitializationMode");
    const char *fault;
    if (instance == NULL) {
        return fmi2Error;
    }
    fault = model_fault(&instance->state.model);
    if (fault != NULL) {
        return fail(instance, "fmi2ExitInitializationMode", fault);
    }
    notice(instance, "fmi2ExitInitializationMode");
    instance->state.phase = STEPPING;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    return change_phase(c, STEPPING, TERMINATED, "fmi2Terminate");
}

fmi2Status fmi2Reset(fmi2Component c)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2Reset");
    if (instance == NULL) {
        return fmi2Error;
    }
    start(instance);
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    Instance *instance = enter(c, STEPPING, "fmi2DoStep");
    State *state;
    const char *fault;
    double end;
    (void)noSetFMUStatePriorToCurrentPoint; /* no history is kept */
    if (instance == NULL) {
        return fmi2Error;
    }
    state = &instance->state;
    end = currentCommunicationPoint + communicationStepSize;
    if (!(isfinite(end) && communicationStepSize > 0.0)) {
        return fail(instance, "fmi2DoStep", "the time must be finite and the step size > 0");
    }
    if (state->has_stop_time
        && end - state->stop_time > 1e-9 * (fabs(state->stop_time) + communicationStepSize)) {
        return fail(instance, "fmi2DoStep", "the step ends after the stop time");
    }
    fault = model_fault(&state->model);
    if (fault != NULL) {
        return fail(instance, "fmi2DoStep", fault);
    }
    notice(instance, "fmi2DoStep");
    state->time = end;
    return fmi2OK;
}

/* ---- status ---- */

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    Instance *instance = enter(c, STEPPING | TERMINATED, "fmi2GetRealStatus");
    if (instance == NULL || value == NULL) {
        return fmi2Error;
    }
    if (s != fmi2LastSuccessfulTime) {
        return fmi2Discard;
    }
    *value = instance->state.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value)
{
    Instance *instance = enter(c, STEPPING | TERMINATED, "fmi2GetBooleanStatus");
    if (instance == NULL || value == NULL) {
        return fmi2Error;
    }
    if (s != fmi2Terminated) {
        return fmi2Discard;
    }
    *value = fmi2False; /* the element never ends a simulation by itself */
    return fmi2OK;
}
