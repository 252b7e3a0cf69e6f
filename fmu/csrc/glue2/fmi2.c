/* FMI 2.0 around the core: instances, call sequence. A call that fails leaves the instance as it was. */
#include "fmi2_instance.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    Instance common;
    fmi2CallbackFunctions callbacks;
} Component;

/* ---- versions, logging ---- */

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    return (fmi2Status)choose_logging(c, loggingOn != fmi2False, nCategories, categories, "fmi2SetDebugLogging");
}

/* ---- what the core asks ---- */

static void log_text(const Instance *instance, int status, const char *category, const char *text)
{
    const fmi2CallbackFunctions *callbacks = &((const Component *)instance)->callbacks;
    if (callbacks->logger != NULL) { /* the text is free of percent signs */
        callbacks->logger(callbacks->componentEnvironment, instance->name, (fmi2Status)status, category, text);
    }
}

/* Zeroed memory from the importer's allocator, where it has one. */
static void *allocate(const fmi2CallbackFunctions *callbacks, size_t size)
{
    return callbacks->allocateMemory != NULL ? callbacks->allocateMemory(1, size) : calloc(1, size);
}

static void release(const fmi2CallbackFunctions *callbacks, void *memory)
{
    if (callbacks->allocateMemory == NULL) {
        free(memory);
    } else if (callbacks->freeMemory != NULL) {
        callbacks->freeMemory(memory);
    }
}

static void *allocate_for(const Instance *instance, size_t size)
{
    return allocate(&((const Component *)instance)->callbacks, size);
}

static void release_of(const Instance *instance, void *memory)
{
    release(&((const Component *)instance)->callbacks, memory);
}

static const Version version = {"FMI 2.0 " MODEL_TOKEN, log_text, allocate_for, release_of};

/* ---- creation and destruction ---- */

static fmi2Component refuse(fmi2String name, const fmi2CallbackFunctions *callbacks, const char *message)
{
    if (callbacks != NULL && callbacks->logger != NULL) {
        callbacks->logger(callbacks->componentEnvironment, name != NULL ? name : "", fmi2Error,
                          log_categories[LOG_ERROR], message);
    }
    return NULL;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    Component *made;
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
    made = (Component *)allocate(functions, sizeof *made);
    if (made == NULL) {
        return refuse(instanceName, functions, "fmi2Instantiate: out of memory.");
    }
    length = strlen(instanceName) + 1;
    made->callbacks = *functions;
    made->common.version = &version;
    made->common.name = (char *)allocate(functions, length);
    if (made->common.name == NULL) {
        release(functions, made);
        return refuse(instanceName, functions, "fmi2Instantiate: out of memory.");
    }
    memcpy(made->common.name, instanceName, length);
    set_logging(&made->common, loggingOn != fmi2False);
    core_start(&made->common.state, fmuType == fmi2CoSimulation ? CO_SIMULATION : MODEL_EXCHANGE);
    return made;
}

void fmi2FreeInstance(fmi2Component c)
{
    Component *component = (Component *)c;
    if (component != NULL) {
        const fmi2CallbackFunctions callbacks = component->callbacks;
        release(&callbacks, component->common.name);
        release(&callbacks, component);
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
    return (fmi2Status)go_on(c, INSTANTIATED, INITIALIZATION, "fmi2EnterInitializationMode");
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
    return (fmi2Status)go_on(c, STEPPING | EVENT | CONTINUOUS, TERMINATED, "fmi2Terminate");
}

fmi2Status fmi2Reset(fmi2Component c)
{
    return (fmi2Status)reset(c, "fmi2Reset");
}
