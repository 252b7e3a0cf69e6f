/* FMI 3.0 around the core: instances, logging, call sequence. A call that fails leaves the instance as it was. */
#include "fmi3_instance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const category_names[LOG_CATEGORIES] = {
    "logStatusError", "logStatusDiscard", "logStatusWarning"};

/* ---- logging and guards ---- */

void log_call(const Instance *instance, fmi3Status status, LogCategory category, const char *function,
              const char *message)
{
    char text[256];
    if (instance->log != NULL && instance->logged[category]) {
        snprintf(text, sizeof text, "%s: %s.", function, message);
        instance->log(instance->environment, status, category_names[category], text);
    }
}

fmi3Status fail(const Instance *instance, const char *function, const char *message)
{
    log_call(instance, fmi3Error, LOG_ERROR, function, message);
    return fmi3Error;
}

fmi3Status outcome(const Instance *instance, Fault fault, const char *function)
{
    if (fault.severity == REFUSE) {
        return fail(instance, function, fault.reason);
    }
    if (fault.severity == DISCARD) {
        log_call(instance, fmi3Discard, LOG_DISCARD, function, fault.reason);
        return fmi3Discard;
    }
    return fmi3OK;
}

Instance *enter_to_read(fmi3Instance c, int phases, const char *function)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL && (instance->state.phase & phases) == 0) {
        fail(instance, function, "not allowed at this point of the call sequence");
        return NULL;
    }
    return instance;
}

Instance *enter(fmi3Instance c, int phases, const char *function)
{
    Instance *instance = enter_to_read(c, phases, function);
    if (instance != NULL && instance->within_step) {
        fail(instance, function, "not allowed within fmi3IntermediateUpdate");
        return NULL;
    }
    return instance;
}

Instance *enter_as(fmi3Instance c, Kind kind, int phases, const char *function)
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
        log_call(instance, fmi3Warning, LOG_WARNING, function, text);
    }
}

int unsuitable(const Instance *instance, const void *references, size_t count, const void *values, size_t n_values,
               const char *function)
{
    if (count != n_values || (count > 0 && (references == NULL || values == NULL))) {
        fail(instance, function, "as many values as value references are needed, and arrays of them");
        return 1;
    }
    return 0;
}

/* ---- versions, logging ---- */

const char *fmi3GetVersion(void)
{
    return "3.0";
}

/* Errors are always logged; the rest as asked for. */
static void set_logging(Instance *instance, int on)
{
    instance->logged[LOG_ERROR] = 1;
    instance->logged[LOG_DISCARD] = on;
    instance->logged[LOG_WARNING] = on;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3SetDebugLogging");
    int chosen[LOG_CATEGORIES] = {0};
    size_t i;
    int k;
    if (instance == NULL || (nCategories > 0 && categories == NULL)) {
        return fmi3Error;
    }
    for (i = 0; i < nCategories; i++) {
        for (k = 0; k < LOG_CATEGORIES; k++) {
            if (categories[i] != NULL && strcmp(categories[i], category_names[k]) == 0) {
                chosen[k] = 1;
                break;
            }
        }
        if (k == LOG_CATEGORIES) {
            return fail(instance, "fmi3SetDebugLogging", "unknown log category");
        }
    }
    if (nCategories == 0) {
        set_logging(instance, loggingOn);
    }
    for (k = 0; k < LOG_CATEGORIES; k++) {
        if (chosen[k]) {
            instance->logged[k] = loggingOn || k == LOG_ERROR;
        }
    }
    return fmi3OK;
}

/* ---- creation and destruction ---- */

static Instance *make(fmi3String name, fmi3String token, fmi3Boolean loggingOn, fmi3InstanceEnvironment environment,
                      fmi3LogMessageCallback log, Kind kind)
{
    const char *reason = NULL;
    Instance *instance = NULL;
    size_t length;
    if (name == NULL || name[0] == '\0') {
        reason = "fmi3Instantiate: the instance has no name.";
    } else if (token == NULL || strcmp(token, MODEL_TOKEN) != 0) {
        reason = "fmi3Instantiate: wrong instantiation token, expected " MODEL_TOKEN ".";
    } else {
        length = strlen(name) + 1;
        instance = (Instance *)calloc(1, sizeof *instance);
        if (instance != NULL) {
            instance->name = (char *)malloc(length);
        }
        if (instance == NULL || instance->name == NULL) {
            free(instance);
            instance = NULL;
            reason = "fmi3Instantiate: out of memory.";
        } else {
            memcpy(instance->name, name, length);
        }
    }
    if (instance == NULL) {
        if (log != NULL) {
            log(environment, fmi3Error, category_names[LOG_ERROR], reason);
        }
        return NULL;
    }
    instance->environment = environment;
    instance->log = log;
    set_logging(instance, loggingOn);
    core_start(&instance->state, kind);
    return instance;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage)
{
    (void)resourcePath, (void)visible; /* nothing is read from there, nothing shown */
    return make(instanceName, instantiationToken, loggingOn, instanceEnvironment, logMessage, MODEL_EXCHANGE);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken,
                                         fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                         fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables,
                                         fmi3InstanceEnvironment instanceEnvironment,
                                         fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate)
{
    Instance *instance;
    (void)resourcePath, (void)visible;
    (void)requiredIntermediateVariables, (void)nRequiredIntermediateVariables; /* all can be read there */
    instance = make(instanceName, instantiationToken, loggingOn, instanceEnvironment, logMessage, CO_SIMULATION);
    if (instance != NULL) {
        instance->event_mode = eventModeUsed;
        instance->early_return = earlyReturnAllowed;
        instance->update = intermediateUpdate;
    }
    return instance;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
                                               fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment instanceEnvironment,
                                               fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
                                               fmi3LockPreemptionCallback lockPreemption,
                                               fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    (void)clockUpdate, (void)lockPreemption, (void)unlockPreemption;
    if (logMessage != NULL) {
        logMessage(instanceEnvironment, fmi3Error, category_names[LOG_ERROR],
                   "fmi3InstantiateScheduledExecution: this FMU has no clocks.");
    }
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL) {
        free(instance->name);
        free(instance);
    }
}

/* ---- call sequence ---- */

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    Instance *instance = enter(c, INSTANTIATED, "fmi3EnterInitializationMode");
    Fault fault;
    if (instance == NULL) {
        return fmi3Error;
    }
    fault = core_setup(&instance->state, startTime, stopTimeDefined, stopTime, toleranceDefined, tolerance);
    if (fault.severity == FINE) {
        instance->state.phase = INITIALIZATION;
    }
    return outcome(instance, fault, "fmi3EnterInitializationMode");
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    Instance *instance = enter(c, INITIALIZATION, "fmi3ExitInitializationMode");
    Fault fault;
    if (instance == NULL) {
        return fmi3Error;
    }
    fault = core_exit_initialization(&instance->state);
    if (fault.severity == FINE) {
        if (instance->state.kind == CO_SIMULATION && instance->event_mode) {
            instance->state.phase = EVENT;
        }
        notice(instance, "fmi3ExitInitializationMode");
    }
    return outcome(instance, fault, "fmi3ExitInitializationMode");
}

fmi3Status fmi3EnterEventMode(fmi3Instance c)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL && instance->state.kind == CO_SIMULATION && !instance->event_mode) {
        return fail(instance, "fmi3EnterEventMode", "this instance was made without event mode");
    }
    instance = enter(c, CONTINUOUS | STEPPING, "fmi3EnterEventMode");
    if (instance == NULL) {
        return fmi3Error;
    }
    instance->state.phase = EVENT;
    return fmi3OK;
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    Instance *instance = enter(c, STEPPING | EVENT | CONTINUOUS, "fmi3Terminate");
    if (instance == NULL) {
        return fmi3Error;
    }
    instance->state.phase = TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3Reset");
    if (instance == NULL) {
        return fmi3Error;
    }
    core_start(&instance->state, (Kind)instance->state.kind);
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined,
                                    fmi3Float64 *nextEventTime)
{
    Instance *instance = enter(c, EVENT, "fmi3UpdateDiscreteStates");
    int changed = 0;
    Fault fault;
    if (instance == NULL || discreteStatesNeedUpdate == NULL || terminateSimulation == NULL
        || nominalsOfContinuousStatesChanged == NULL || valuesOfContinuousStatesChanged == NULL
        || nextEventTimeDefined == NULL || nextEventTime == NULL) {
        return fmi3Error;
    }
    fault = core_contact_changed(&instance->state, &changed);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi3UpdateDiscreteStates");
    }
    *discreteStatesNeedUpdate = fmi3False;
    *terminateSimulation = fmi3False;
    /* no state has jumped; but solvers that restart only where one of these is true shall restart */
    *nominalsOfContinuousStatesChanged = changed != 0 && N_STATES > 0;
    *valuesOfContinuousStatesChanged = fmi3False;
    *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0.0;
    return fmi3OK;
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c)
{
    return enter(c, INITIALIZATION | EVENT, "fmi3EvaluateDiscreteStates") == NULL ? fmi3Error : fmi3OK;
}
