/* FMI 3.0 around the core: variables, dependencies, directional and adjoint derivatives. */
#include "fmi3_instance.h"

/* ---- real variables, the time and the event indicators among them ---- */

static int is_indicator(unsigned int reference)
{
    return reference >= VR_indicator && reference < VR_indicator + N_CONTACTS;
}

static Fault get(Instance *instance, unsigned int reference, double *value)
{
    Fault fault = {FINE, NULL};
    if (reference == VR_time) {
        *value = instance->state.time;
        return fault;
    }
    if (!is_indicator(reference)) {
        return core_get(&instance->state, &reference, 1, REAL, value);
    }
    fault = core_outputs(&instance->state);
    if (fault.severity == FINE) {
        *value = instance->state.model.indicator[reference - VR_indicator];
    }
    return fault;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          fmi3Float64 values[], size_t nValues)
{
    Instance *instance = enter_to_read(c, ANY_PHASE, "fmi3GetFloat64");
    size_t i;
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3GetFloat64")) {
        return fmi3Error;
    }
    for (i = 0; i < nValueReferences; i++) {
        const Fault fault = get(instance, valueReferences[i], &values[i]);
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3GetFloat64");
        }
    }
    return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          const fmi3Float64 values[], size_t nValues)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3SetFloat64");
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3SetFloat64")) {
        return fmi3Error;
    }
    return outcome(instance, core_set(&instance->state, valueReferences, nValueReferences, REAL, values),
                   "fmi3SetFloat64");
}

/* ---- flags ---- */

static void put_boolean(void *values, size_t i, double value)
{
    ((fmi3Boolean *)values)[i] = value > 0.0;
}

fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          fmi3Boolean values[], size_t nValues)
{
    Instance *instance = enter_to_read(c, ANY_PHASE, "fmi3GetBoolean");
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3GetBoolean")) {
        return fmi3Error;
    }
    return (fmi3Status)get_values(instance, valueReferences, nValueReferences, BOOLEAN, values, put_boolean,
                                  "fmi3GetBoolean");
}

/* ---- partial derivatives ---- */

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                        const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                        size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity)
{
    Instance *instance = enter_to_read(c, READABLE, "fmi3GetDirectionalDerivative");
    if (instance == NULL || unsuitable(instance, knowns, nKnowns, seed, nSeed, "fmi3GetDirectionalDerivative")
        || unsuitable(instance, unknowns, nUnknowns, sensitivity, nSensitivity, "fmi3GetDirectionalDerivative")) {
        return fmi3Error;
    }
    return outcome(instance,
                   core_directional(&instance->state, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity),
                   "fmi3GetDirectionalDerivative");
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                    size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity)
{
    Instance *instance = enter_to_read(c, READABLE, "fmi3GetAdjointDerivative");
    if (instance == NULL || unsuitable(instance, unknowns, nUnknowns, seed, nSeed, "fmi3GetAdjointDerivative")
        || unsuitable(instance, knowns, nKnowns, sensitivity, nSensitivity, "fmi3GetAdjointDerivative")) {
        return fmi3Error;
    }
    return outcome(instance, core_adjoint(&instance->state, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity),
                   "fmi3GetAdjointDerivative");
}
