/* FMI 3.0 around the core: co-simulation, with event mode, early return and intermediate update where the importer
 * asked for them. A step that ends with the surfaces parted, if they touched at its start, or the other way round, wants
 * event mode; nothing jumps there. */
#include "fmi3_instance.h"

#define EVENT_ERROR 1e-6 /* of a step, where the surfaces meet or part in it */

fmi3Status fmi3EnterStepMode(fmi3Instance c)
{
    return (fmi3Status)enter_phase_as(c, CO_SIMULATION, EVENT, STEPPING, "fmi3EnterStepMode");
}

/* Lets the importer read what there is at the end of a step, where it returns anyway. */
static void call_update(Unit *unit)
{
    const State *state = &unit->common.state;
    fmi3Boolean return_requested = fmi3False;
    fmi3Float64 return_time = state->time;
    if (unit->update != NULL) {
        unit->common.within_step = 1;
        unit->update(unit->environment, state->time, fmi3False, fmi3True, fmi3True, fmi3False, &return_requested,
                     &return_time);
        unit->common.within_step = 0;
    }
}

/* Goes from `before` to just behind where the surfaces meet or part, which they do within h. */
static void stop_at_event(State *state, const State *before, double time, double h)
{
    double short_of = 0.0, behind = h;
    while (behind - short_of > EVENT_ERROR * h) {
        const double middle = 0.5 * (short_of + behind);
        *state = *before;
        if (core_step(state, time, middle).severity == FINE && core_contact(state) == before->contact) {
            short_of = middle;
        } else {
            behind = middle;
        }
    }
    *state = *before;
    if (core_step(state, time, behind).severity != FINE) { /* too short a step: the whole one has been made before */
        *state = *before;
        core_step(state, time, h);
    }
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    Instance *instance = enter_as(c, CO_SIMULATION, STEPPING, "fmi3DoStep");
    Unit *unit = (Unit *)c;
    State before;
    Fault fault;
    (void)noSetFMUStatePriorToCurrentPoint; /* no history is kept beyond the state */
    if (instance == NULL) {
        return fmi3Error;
    }
    if (eventHandlingNeeded == NULL || terminateSimulation == NULL || earlyReturn == NULL
        || lastSuccessfulTime == NULL) {
        return fail(instance, "fmi3DoStep", "there is no room for what it returns");
    }
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
    *lastSuccessfulTime = instance->state.time;
    if (unit->event_mode && unit->early_return) {
        before = instance->state;
    }
    fault = core_step(&instance->state, currentCommunicationPoint, communicationStepSize);
    if (fault.severity != FINE) {
        return outcome(instance, fault, "fmi3DoStep");
    }
    if (!unit->event_mode) {
        instance->state.contact = core_contact(&instance->state);
    } else if (core_contact(&instance->state) != instance->state.contact) {
        *eventHandlingNeeded = fmi3True;
        if (unit->early_return && core_path_is_known(&instance->state)) {
            stop_at_event(&instance->state, &before, currentCommunicationPoint, communicationStepSize);
            *earlyReturn = instance->state.time < currentCommunicationPoint + communicationStepSize;
        }
    }
    *lastSuccessfulTime = instance->state.time;
    warn_of_step(instance, "fmi3DoStep");
    call_update(unit);
    return fmi3OK;
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int32 orders[], fmi3Float64 values[],
                                    size_t nValues)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL && instance->state.kind != CO_SIMULATION) {
        return fail(instance, "fmi3GetOutputDerivatives", "this instance is for model exchange");
    }
    instance = enter_to_read(c, STEPPING | EVENT | TERMINATED, "fmi3GetOutputDerivatives");
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3GetOutputDerivatives")
        || (nValueReferences > 0 && orders == NULL)) {
        return fmi3Error;
    }
    return (fmi3Status)get_slopes(instance, valueReferences, nValueReferences, orders, values, "fmi3GetOutputDerivatives");
}
