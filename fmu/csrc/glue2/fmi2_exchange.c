/* FMI 2.0 around the core: model exchange. The force is always that of the present states and inputs, so an importer
 * that does not restart its solver at an event loses accuracy there and nothing else. */
#include "fmi2_instance.h"

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, CONTINUOUS, "fmi2EnterEventMode");
    if (instance == NULL) {
        return fmi2Error;
    }
    instance->state.phase = EVENT;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *eventInfo)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, EVENT, "fmi2NewDiscreteStates");
    int changed = 0;
    Fault fault;
    if (instance == NULL || eventInfo == NULL) {
        return fmi2Error;
    }
    fault = core_contact_changed(&instance->state, &changed);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi2NewDiscreteStates");
    }
    eventInfo->newDiscreteStatesNeeded = fmi2False;
    eventInfo->terminateSimulation = fmi2False;
    /* no state has jumped; but solvers that restart only where one of these is true shall restart */
    eventInfo->nominalsOfContinuousStatesChanged = changed ? fmi2True : fmi2False;
    eventInfo->valuesOfContinuousStatesChanged = fmi2False;
    eventInfo->nextEventTimeDefined = fmi2False;
    eventInfo->nextEventTime = 0.0;
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, EVENT, "fmi2EnterContinuousTimeMode");
    if (instance == NULL) {
        return fmi2Error;
    }
    instance->state.phase = CONTINUOUS;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, CONTINUOUS, "fmi2CompletedIntegratorStep");
    Fault fault;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (instance == NULL || enterEventMode == NULL || terminateSimulation == NULL) {
        return fmi2Error;
    }
    fault = core_outputs(&instance->state);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi2CompletedIntegratorStep");
    }
    notice(instance, "fmi2CompletedIntegratorStep");
    *enterEventMode = fmi2False;
    *terminateSimulation = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, EVENT | CONTINUOUS, "fmi2SetTime");
    return instance == NULL ? fmi2Error : outcome(instance, core_set_time(&instance->state, time), "fmi2SetTime");
}

/* The instance, if the array is one of all `count` entries. */
static Instance *sized(fmi2Component c, int phases, const void *values, size_t given, size_t count,
                       const char *function)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, phases, function);
    if (instance != NULL && (given != count || (count > 0 && values == NULL))) {
        fail(instance, function, "wrong number of entries");
        return NULL;
    }
    return instance;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    Instance *instance = sized(c, CONTINUOUS, x, nx, N_STATES, "fmi2SetContinuousStates");
    if (instance == NULL) {
        return fmi2Error;
    }
    core_set_states(&instance->state, x);
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    Instance *instance = sized(c, EVENT | CONTINUOUS | TERMINATED | INITIALIZATION, x, nx, N_STATES,
                               "fmi2GetContinuousStates");
    int i;
    if (instance == NULL) {
        return fmi2Error;
    }
    for (i = 0; i < N_STATES; i++) {
        x[i] = instance->state.model.value[FIRST_STATE + i];
    }
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx)
{
    Instance *instance = sized(c, ANY_PHASE, x_nominal, nx, N_STATES, "fmi2GetNominalsOfContinuousStates");
    int i;
    if (instance == NULL) {
        return fmi2Error;
    }
    for (i = 0; i < N_STATES; i++) {
        x_nominal[i] = core_variables[FIRST_STATE + i].nominal;
    }
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx)
{
    Instance *instance = sized(c, READABLE, derivatives, nx, N_STATES, "fmi2GetDerivatives");
    Fault fault;
    int i;
    if (instance == NULL) {
        return fmi2Error;
    }
    fault = core_rates(&instance->state);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi2GetDerivatives");
    }
    for (i = 0; i < N_STATES; i++) {
        derivatives[i] = instance->state.model.value[FIRST_DERIVATIVE + i];
    }
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni)
{
    Instance *instance = sized(c, READABLE, eventIndicators, ni, N_CONTACTS, "fmi2GetEventIndicators");
    Fault fault;
    int i;
    if (instance == NULL) {
        return fmi2Error;
    }
    fault = core_outputs(&instance->state);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi2GetEventIndicators");
    }
    for (i = 0; i < N_CONTACTS; i++) {
        eventIndicators[i] = instance->state.model.indicator[i];
    }
    return fmi2OK;
}
