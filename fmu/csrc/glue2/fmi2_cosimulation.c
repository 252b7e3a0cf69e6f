/* FMI 2.0 around the core: co-simulation. */
#include "fmi2_instance.h"

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    Instance *instance = enter_as(c, CO_SIMULATION, STEPPING, "fmi2DoStep");
    Fault fault;
    (void)noSetFMUStatePriorToCurrentPoint; /* no history is kept beyond the state */
    if (instance == NULL) {
        return fmi2Error;
    }
    fault = core_step(&instance->state, currentCommunicationPoint, communicationStepSize);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi2DoStep");
    }
    warn_of_step(instance, "fmi2DoStep");
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    Instance *instance = enter_as(c, CO_SIMULATION, INITIALIZATION | STEPPING, "fmi2SetRealInputDerivatives");
    size_t i;
    if (instance == NULL || missing(vr, value, nvr) || missing(vr, order, nvr)) {
        return fmi2Error;
    }
    for (i = 0; i < nvr; i++) {
        const Fault fault = core_may_set_slope(&instance->state, vr[i], order[i], value[i]);
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi2SetRealInputDerivatives");
        }
    }
    master_is_unclear(&instance->master);
    for (i = 0; i < nvr; i++) {
        core_set_slope(&instance->state, vr[i], order[i], value[i]);
    }
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[])
{
    Instance *instance = enter_as(c, CO_SIMULATION, STEPPING | TERMINATED, "fmi2GetRealOutputDerivatives");
    if (instance == NULL || missing(vr, value, nvr) || missing(vr, order, nvr)) {
        return fmi2Error;
    }
    return (fmi2Status)get_slopes(instance, vr, nvr, order, value, "fmi2GetRealOutputDerivatives");
}

/* ---- status ---- */

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    Instance *instance = enter_as(c, CO_SIMULATION, STEPPING | TERMINATED, "fmi2GetRealStatus");
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
    Instance *instance = enter_as(c, CO_SIMULATION, STEPPING | TERMINATED, "fmi2GetBooleanStatus");
    if (instance == NULL || value == NULL) {
        return fmi2Error;
    }
    if (s != fmi2Terminated) {
        return fmi2Discard;
    }
    *value = fmi2False; /* the element never ends a simulation by itself */
    return fmi2OK;
}

static fmi2Status synchronous(fmi2Component c, const char *function)
{
    return c == NULL ? fmi2Error : fail((const Instance *)c, function, "steps are synchronous");
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return synchronous(c, "fmi2CancelStep");
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value)
{
    (void)s, (void)value;
    return synchronous(c, "fmi2GetStatus");
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value)
{
    (void)s, (void)value;
    return synchronous(c, "fmi2GetIntegerStatus");
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value)
{
    (void)s, (void)value;
    return synchronous(c, "fmi2GetStringStatus");
}
