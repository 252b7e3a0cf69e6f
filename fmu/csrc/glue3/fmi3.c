/* FMI 3.0 around the core: instances, call sequence. A call that fails leaves the instance as it was. */
#include "fmi3_instance.h"

#include <stdlib.h>
#include <string.h>

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

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    return (fmi3Status)choose_logging(c, loggingOn, nCategories, categories, "fmi3SetDebugLogging");
}

/* ---- callbacks of the importer, and memory ---- */

static void log_text(const Instance *instance, int status, const char *category, const char *text)
{
    const Unit *unit = (const Unit *)instance;
    if (unit->log != NULL) {
        unit->log(unit->environment, (fmi3Status)status, category, text);
    }
}

static void *allocate(const Instance *instance, size_t size)
{
    (void)instance;
    return calloc(1, size);
}

static void release(const Instance *instance, void *memory)
{
    (void)instance;
    free(memory);
}

static const Version version = {"FMI 3.0 " MODEL_TOKEN, "wrong instantiation token, expected " MODEL_TOKEN, log_text,
                                allocate, release};

/* ---- creation and destruction ---- */

static Unit *make(fmi3String name, fmi3String token, fmi3Boolean loggingOn, fmi3InstanceEnvironment environment,
                  fmi3LogMessageCallback log, Kind kind, const char *function)
{
    Unit like;
    memset(&like, 0, sizeof like);
    like.common.version = &version;
    like.environment = environment;
    like.log = log;
    return (Unit *)make_instance(&like.common, sizeof like, name, token, loggingOn, kind, function);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage)
{
    (void)resourcePath, (void)visible; /* nothing is read from there, nothing shown */
    return make(instanceName, instantiationToken, loggingOn, instanceEnvironment, logMessage, MODEL_EXCHANGE,
                "fmi3Instantiate");
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
    Unit *unit;
    (void)resourcePath, (void)visible;
    (void)requiredIntermediateVariables, (void)nRequiredIntermediateVariables; /* all can be read there */
    unit = make(instanceName, instantiationToken, loggingOn, instanceEnvironment, logMessage, CO_SIMULATION,
                "fmi3Instantiate");
    if (unit != NULL) {
        unit->event_mode = eventModeUsed;
        unit->early_return = earlyReturnAllowed;
        unit->update = intermediateUpdate;
    }
    return unit;
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
        logMessage(instanceEnvironment, fmi3Error, log_categories[LOG_ERROR],
                   "fmi3InstantiateScheduledExecution: this FMU has no clocks.");
    }
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c)
{
    free_instance(c);
}

/* ---- call sequence ---- */

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    const char *function = "fmi3EnterInitializationMode";
    const int status = set_up(c, startTime, stopTimeDefined, stopTime, toleranceDefined, tolerance, function);
    return (fmi3Status)(status == DONE ? enter_phase(c, INSTANTIATED, INITIALIZATION, function) : status);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    const int event_mode = c != NULL && ((const Unit *)c)->event_mode;
    return (fmi3Status)exit_initialization(c, event_mode, "fmi3ExitInitializationMode");
}

fmi3Status fmi3EnterEventMode(fmi3Instance c)
{
    const Unit *unit = (const Unit *)c;
    if (unit != NULL && unit->common.state.kind == CO_SIMULATION && !unit->event_mode) {
        return fail(&unit->common, "fmi3EnterEventMode", "this instance was made without event mode");
    }
    return (fmi3Status)enter_phase(c, CONTINUOUS | STEPPING, EVENT, "fmi3EnterEventMode");
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    return (fmi3Status)enter_phase(c, STEPPING | EVENT | CONTINUOUS, TERMINATED, "fmi3Terminate");
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    return (fmi3Status)reset(c, "fmi3Reset");
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
