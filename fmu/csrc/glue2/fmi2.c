/* FMI 2.0 around the core: instances, logging, call sequence. A call that fails leaves the instance as it was. */
#include "fmi2_instance.h"

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

fmi2Status outcome(const Instance *instance, Fault fault, const char *function)
{
    if (fault.severity == REFUSE) {
        return fail(instance, function, fault.reason);
    }
    if (fault.severity == DISCARD) {
        log_call(instance, fmi2Discard, LOG_DISCARD, function, fault.reason);
        return fmi2Discard;
    }
    return fmi2OK;
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

Instance *enter_as(fmi2Component c, Kind kind, int phases, const char *function)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL && instance->state.kind != (int)kind) {
        fail(instance, function,
             kind == CO_SIMULATION ? "this instance is for model exchange" : "this instance is for co-simulation");
        return NULL;
    }
    return enter(c, phases, function);
}

void notice(Instance *instance, const char *function)
{
    char text[160];
    if (core_notice(&instance->state, text, sizeof text) != NULL) {
        log_call(instance, fmi2Warning, LOG_WARNING, function, text);
    }
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
            return fail(instance, "fmi2SetDebugLogging", "unknown log category");
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
    if (fmuType != fmi2CoSimulation && fmuType != fmi2ModelExchange) {
        return refuse(instanceName, functions, "fmi2Instantiate: neither co-simulation nor model exchange.");
    }
    if (fmuGUID == NULL || strcmp(fmuGUID, MODEL_TOKEN) != 0) {
        return refuse(instanceName, functions, "fmi2Instantiate: wrong GUID, expected " MODEL_TOKEN ".");
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
    core_start(&instance->state, fmuType == fmi2CoSimulation ? CO_SIMULATION : MODEL_EXCHANGE);
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
    if (instance == NULL) {
        return fmi2Error;
    }
    return outcome(instance,
                   core_setup(&instance->state, startTime, stopTimeDefined != fmi2False, stopTime,
                              toleranceDefined != fmi2False, tolerance),
                   "fmi2SetupExperiment");
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    Instance *instance = enter(c, INSTANTIATED, "fmi2EnterInitializationMode");
    if (instance == NULL) {
        return fmi2Error;
    }
    instance->state.phase = INITIALIZATION;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *instance = enter(c, INITIALIZATION, "fmi2ExitInitializationMode");
    Fault fault;
    if (instance == NULL) {
        return fmi2Error;
    }
    fault = core_exit_initialization(&instance->state);
    if (fault.severity == FINE) {
        notice(instance, "fmi2ExitInitializationMode");
    }
    return outcome(instance, fault, "fmi2ExitInitializationMode");
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    Instance *instance = enter(c, STEPPING | EVENT | CONTINUOUS, "fmi2Terminate");
    if (instance == NULL) {
        return fmi2Error;
    }
    instance->state.phase = TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2Reset");
    if (instance == NULL) {
        return fmi2Error;
    }
    core_start(&instance->state, (Kind)instance->state.kind);
    return fmi2OK;
}
