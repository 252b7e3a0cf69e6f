/* FMI 2.0 around the core: model exchange. */
#include "fmi2_instance.h"

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    return (fmi2Status)enter_phase_as(c, MODEL_EXCHANGE, CONTINUOUS, EVENT, "fmi2EnterEventMode");
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    return (fmi2Status)enter_phase_as(c, MODEL_EXCHANGE, EVENT, CONTINUOUS, "fmi2EnterContinuousTimeMode");
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

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    if (enterEventMode == NULL || terminateSimulation == NULL) {
        return fmi2Error;
    }
    *enterEventMode = fmi2False;
    *terminateSimulation = fmi2False;
    return (fmi2Status)complete_step(c, "fmi2CompletedIntegratorStep");
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    return (fmi2Status)set_time(c, time, "fmi2SetTime");
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    return (fmi2Status)set_states(c, x, nx, "fmi2SetContinuousStates");
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    return (fmi2Status)get_states(c, x, nx, "fmi2GetContinuousStates");
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx)
{
    return (fmi2Status)get_nominals(c, x_nominal, nx, "fmi2GetNominalsOfContinuousStates");
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx)
{
    return (fmi2Status)get_rates(c, derivatives, nx, "fmi2GetDerivatives");
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni)
{
    return (fmi2Status)get_indicators(c, eventIndicators, ni, "fmi2GetEventIndicators");
}
