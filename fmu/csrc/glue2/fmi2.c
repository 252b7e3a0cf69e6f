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

/* ---- callbacks of the importer ---- */

static void log_text(const Instance *instance, int status, const char *category, const char *text)
{
    const fmi2CallbackFunctions *callbacks = &((const Component *)instance)->callbacks;
    if (callbacks->logger != NULL) { /* the text is free of percent signs */
        callbacks->logger(callbacks->componentEnvironment, instance->name != NULL ? instance->name : "",
                          (fmi2Status)status, category, text);
    }
}

/* Zeroed memory from the importer's allocator, where it has one. */
static void *allocate(const Instance *instance, size_t size)
{
    const fmi2CallbackFunctions *callbacks = &((const Component *)instance)->callbacks;
    return callbacks->allocateMemory != NULL ? callbacks->allocateMemory(1, size) : calloc(1, size);
}

static void release(const Instance *instance, void *memory)
{
    const fmi2CallbackFunctions *callbacks = &((const Component *)instance)->callbacks;
    if (callbacks->allocateMemory == NULL) {
        free(memory);
    } else if (callbacks->freeMemory != NULL) {
        callbacks->freeMemory(memory);
    }
}

static const Version version = {"FMI 2.0 " MODEL_TOKEN, "wrong GUID, expected " MODEL_TOKEN, log_text, allocate, release};

/* ---- creation and destruction ---- */

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    Component like;
    (void)fmuResourceLocation; /* nothing is read from there */
    (void)visible;
    if (functions == NULL) {
        return NULL;
    }
    memset(&like, 0, sizeof like);
    like.common.version = &version;
    like.callbacks = *functions;
    like.common.name = instanceName;
    like.common.logged[LOG_ERROR] = 1;
    if (fmuType != fmi2CoSimulation && fmuType != fmi2ModelExchange) {
        failed(&like.common, "fmi2Instantiate", "neither co-simulation nor model exchange");
        return NULL;
    }
    return make_instance(&like.common, sizeof like, instanceName, fmuGUID, loggingOn != fmi2False,
                         fmuType == fmi2CoSimulation ? CO_SIMULATION : MODEL_EXCHANGE, "fmi2Instantiate");
}

void fmi2FreeInstance(fmi2Component c)
{
    free_instance(c);
}

/* ---- call sequence ---- */

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    return (fmi2Status)set_up(c, startTime, stopTimeDefined != fmi2False, stopTime, toleranceDefined != fmi2False,
                              tolerance, "fmi2SetupExperiment");
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return (fmi2Status)enter_phase(c, INSTANTIATED, INITIALIZATION, "fmi2EnterInitializationMode");
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return (fmi2Status)exit_initialization(c, 0, "fmi2ExitInitializationMode");
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    return (fmi2Status)enter_phase(c, STEPPING | EVENT | CONTINUOUS, TERMINATED, "fmi2Terminate");
}

fmi2Status fmi2Reset(fmi2Component c)
{
    return (fmi2Status)reset(c, "fmi2Reset");
}
