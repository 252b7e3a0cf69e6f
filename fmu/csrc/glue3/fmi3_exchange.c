/* FMI 3.0 around the core: model exchange. The force is always that of the present states and inputs, so an importer
 * that does not restart its solver at an event loses accuracy there and nothing else. */
#include "fmi3_instance.h"

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, EVENT, "fmi3EnterContinuousTimeMode");
    if (instance == NULL) {
        return fmi3Error;
    }
    instance->state.phase = CONTINUOUS;
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, CONTINUOUS, "fmi3CompletedIntegratorStep");
    Fault fault;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (instance == NULL || enterEventMode == NULL || terminateSimulation == NULL) {
        return fmi3Error;
    }
    fault = core_outputs(&instance->state);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi3CompletedIntegratorStep");
    }
    notice(instance, "fmi3CompletedIntegratorStep");
    *enterEventMode = fmi3False;
    *terminateSimulation = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, EVENT | CONTINUOUS, "fmi3SetTime");
    return instance == NULL ? fmi3Error : outcome(instance, core_set_time(&instance->state, time), "fmi3SetTime");
}

/* The instance, if the array is one of all `count` entries. */
static Instance *sized(fmi3Instance c, int phases, const void *values, size_t given, size_t count,
                       const char *function)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, phases, function);
    if (instance != NULL && (given != count || (count > 0 && values == NULL))) {
        fail(instance, function, "wrong number of entries");
        return NULL;
    }
    return instance;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    Instance *instance =
        sized(c, CONTINUOUS, continuousStates, nContinuousStates, N_STATES, "fmi3SetContinuousStates");
    if (instance == NULL) {
        return fmi3Error;
    }
    core_set_states(&instance->state, continuousStates);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    Instance *instance = sized(c, READABLE, continuousStates, nContinuousStates, N_STATES, "fmi3GetContinuousStates");
    int i;
    if (instance == NULL) {
        return fmi3Error;
    }
    for (i = 0; i < N_STATES; i++) {
        continuousStates[i] = instance->state.model.value[FIRST_STATE + i];
    }
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[], size_t nContinuousStates)
{
    Instance *instance =
        sized(c, ANY_PHASE, nominals, nContinuousStates, N_STATES, "fmi3GetNominalsOfContinuousStates");
    int i;
    if (instance == NULL) {
        return fmi3Error;
    }
    for (i = 0; i < N_STATES; i++) {
        nominals[i] = core_variables[FIRST_STATE + i].nominal;
    }
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 derivatives[], size_t nContinuousStates)
{
    Instance *instance =
        sized(c, READABLE, derivatives, nContinuousStates, N_STATES, "fmi3GetContinuousStateDerivatives");
    Fault fault;
    int i;
    if (instance == NULL) {
        return fmi3Error;
    }
    fault = core_rates(&instance->state);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi3GetContinuousStateDerivatives");
    }
    for (i = 0; i < N_STATES; i++) {
        derivatives[i] = instance->state.model.value[FIRST_DERIVATIVE + i];
    }
    return fmi3OK;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 eventIndicators[], size_t nEventIndicators)
{
    Instance *instance = sized(c, READABLE, eventIndicators, nEventIndicators, N_CONTACTS,
                               "fmi3GetEventIndicators");
    Fault fault;
    int i;
    if (instance == NULL) {
        return fmi3Error;
    }
    fault = core_outputs(&instance->state);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi3GetEventIndicators");
    }
    for (i = 0; i < N_CONTACTS; i++) {
        eventIndicators[i] = instance->state.model.indicator[i];
    }
    return fmi3OK;
}

/* The number of something that never changes. */
static fmi3Status counted(fmi3Instance c, size_t count, size_t *found, const char *function)
{
    if (enter_as(c, MODEL_EXCHANGE, ANY_PHASE, function) == NULL || found == NULL) {
        return fmi3Error;
    }
    *found = count;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *nEventIndicators)
{
    return counted(c, N_CONTACTS, nEventIndicators, "fmi3GetNumberOfEventIndicators");
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *nContinuousStates)
{
    return counted(c, N_STATES, nContinuousStates, "fmi3GetNumberOfContinuousStates");
}
