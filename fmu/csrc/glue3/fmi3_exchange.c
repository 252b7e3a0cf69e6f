/* FMI 3.0 around the core: model exchange. */
#include "fmi3_instance.h"

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c)
{
    return (fmi3Status)enter_phase_as(c, MODEL_EXCHANGE, EVENT, CONTINUOUS, "fmi3EnterContinuousTimeMode");
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    if (enterEventMode == NULL || terminateSimulation == NULL) {
        return fmi3Error;
    }
    *enterEventMode = fmi3False;
    *terminateSimulation = fmi3False;
    return (fmi3Status)complete_step(c, "fmi3CompletedIntegratorStep");
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    return (fmi3Status)set_time(c, time, "fmi3SetTime");
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    return (fmi3Status)set_states(c, continuousStates, nContinuousStates, "fmi3SetContinuousStates");
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    return (fmi3Status)get_states(c, continuousStates, nContinuousStates, "fmi3GetContinuousStates");
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[], size_t nContinuousStates)
{
    return (fmi3Status)get_nominals(c, nominals, nContinuousStates, "fmi3GetNominalsOfContinuousStates");
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 derivatives[], size_t nContinuousStates)
{
    return (fmi3Status)get_rates(c, derivatives, nContinuousStates, "fmi3GetContinuousStateDerivatives");
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 eventIndicators[], size_t nEventIndicators)
{
    return (fmi3Status)get_indicators(c, eventIndicators, nEventIndicators, "fmi3GetEventIndicators");
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
