/* Model exchange of an instance of any FMI version; see instance.h. The force is always that of the present states and
 * inputs, so an importer that does not restart its solver at an event loses accuracy there and nothing else. */
#include "instance.h"

#include <string.h>

int set_time(void *c, double time, const char *function)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, EVENT | CONTINUOUS, function);
    return instance == NULL ? FAILED : report(instance, core_set_time(&instance->state, time), function);
}

/* The instance, if the array is one of all `count` entries. */
static Instance *sized(void *c, int phases, const void *values, size_t given, size_t count, const char *function)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, phases, function);
    if (instance != NULL && (given != count || (count > 0 && values == NULL))) {
        failed(instance, function, "wrong number of entries");
        return NULL;
    }
    return instance;
}

/* Hands out numbers of an instance, if there was no fault in finding them. */
static int hand_out(const Instance *instance, Fault fault, const double from[], double to[], size_t count,
                    const char *function)
{
    if (fault.severity == FINE && count > 0) {
        memcpy(to, from, count * sizeof to[0]);
    }
    return report(instance, fault, function);
}

int set_states(void *c, const double states[], size_t count, const char *function)
{
    Instance *instance = sized(c, CONTINUOUS, states, count, N_STATES, function);
    if (instance == NULL) {
        return FAILED;
    }
    core_set_states(&instance->state, states);
    return DONE;
}

int get_states(void *c, double states[], size_t count, const char *function)
{
    Fault fault = {FINE, NULL};
    Instance *instance = sized(c, READABLE, states, count, N_STATES, function);
    if (instance != NULL && instance->state.phase == INITIALIZATION) {
        fault = core_outputs(&instance->state);
    }
    return instance == NULL ? FAILED
        : hand_out(instance, fault, &instance->state.model.value[FIRST_STATE], states, count, function);
}

int get_nominals(void *c, double nominals[], size_t count, const char *function)
{
    int i;
    if (sized(c, ANY_PHASE, nominals, count, N_STATES, function) == NULL) {
        return FAILED;
    }
    for (i = 0; i < N_STATES; i++) {
        nominals[i] = core_variables[FIRST_STATE + i].nominal;
    }
    return DONE;
}

int get_rates(void *c, double rates[], size_t count, const char *function)
{
    Instance *instance = sized(c, READABLE, rates, count, N_STATES, function);
    return instance == NULL ? FAILED
        : hand_out(instance, core_rates(&instance->state), &instance->state.model.value[FIRST_DERIVATIVE], rates, count,
                   function);
}

int get_indicators(void *c, double indicators[], size_t count, const char *function)
{
    Instance *instance = sized(c, READABLE, indicators, count, N_CONTACTS, function);
    return instance == NULL ? FAILED
        : hand_out(instance, core_outputs(&instance->state), instance->state.model.indicator, indicators, count,
                   function);
}

int complete_step(void *c, const char *function)
{
    Instance *instance = enter_as(c, MODEL_EXCHANGE, CONTINUOUS, function);
    Fault fault;
    if (instance == NULL) {
        return FAILED;
    }
    fault = core_outputs(&instance->state);
    if (fault.severity == FINE) {
        warn_if_outside(instance, function);
    }
    return report(instance, fault, function);
}
