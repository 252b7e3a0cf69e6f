/* FMI 3.0 around the core: variables, dependencies, directional and adjoint derivatives. */
#include "fmi3_instance.h"

/* ---- real variables, the time and the event indicators among them ---- */

static int is_indicator(unsigned int reference)
{
    return reference >= VR_indicator && reference < VR_indicator + N_CONTACTS;
}

static Fault may_get(unsigned int reference)
{
    const Fault fine = {FINE, NULL};
    return reference == VR_time || is_indicator(reference) ? fine : core_may_get(reference, REAL);
}

static Fault get(Instance *instance, unsigned int reference, double *value)
{
    Fault fault = {FINE, NULL};
    if (reference == VR_time) {
        *value = instance->state.time;
        return fault;
    }
    if (!is_indicator(reference)) {
        return core_get(&instance->state, reference, value);
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
        const Fault fault = may_get(valueReferences[i]);
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3GetFloat64");
        }
    }
    for (i = 0; i < nValueReferences; i++) {
        const Fault fault = get(instance, valueReferences[i], &values[i]);
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3GetFloat64");
        }
    }
    return fmi3OK;
}

/* All values or none: a bad reference must not leave half of them set. */
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          const fmi3Float64 values[], size_t nValues)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3SetFloat64");
    size_t i;
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3SetFloat64")) {
        return fmi3Error;
    }
    for (i = 0; i < nValueReferences; i++) {
        const Fault fault = core_may_set(&instance->state, valueReferences[i], REAL, values[i]);
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3SetFloat64");
        }
    }
    for (i = 0; i < nValueReferences; i++) {
        core_set(&instance->state, valueReferences[i], values[i]);
    }
    return fmi3OK;
}

/* ---- flags and input_meaning ---- */

fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          fmi3Boolean values[], size_t nValues)
{
    Instance *instance = enter_to_read(c, ANY_PHASE, "fmi3GetBoolean");
    size_t i;
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3GetBoolean")) {
        return fmi3Error;
    }
    for (i = 0; i < nValueReferences; i++) {
        double found = 0.0;
        Fault fault = core_may_get(valueReferences[i], BOOLEAN);
        if (fault.severity == FINE) {
            fault = core_get(&instance->state, valueReferences[i], &found);
        }
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3GetBoolean");
        }
        values[i] = found > 0.0;
    }
    return fmi3OK;
}

fmi3Status fmi3GetInt64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                        fmi3Int64 values[], size_t nValues)
{
    Instance *instance = enter_to_read(c, ANY_PHASE, "fmi3GetInt64");
    size_t i;
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3GetInt64")) {
        return fmi3Error;
    }
    for (i = 0; i < nValueReferences; i++) {
        double found = 0.0;
        Fault fault = core_may_get(valueReferences[i], ENUMERATION);
        if (fault.severity == FINE) {
            fault = core_get(&instance->state, valueReferences[i], &found);
        }
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3GetInt64");
        }
        values[i] = (fmi3Int64)found;
    }
    return fmi3OK;
}

fmi3Status fmi3SetInt64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                        const fmi3Int64 values[], size_t nValues)
{
    Instance *instance = enter(c, ANY_PHASE, "fmi3SetInt64");
    size_t i;
    if (instance == NULL
        || unsuitable(instance, valueReferences, nValueReferences, values, nValues, "fmi3SetInt64")) {
        return fmi3Error;
    }
    for (i = 0; i < nValueReferences; i++) {
        const Fault fault = core_may_set(&instance->state, valueReferences[i], ENUMERATION, (double)values[i]);
        if (fault.severity != FINE) {
            return outcome(instance, fault, "fmi3SetInt64");
        }
    }
    for (i = 0; i < nValueReferences; i++) {
        core_set(&instance->state, valueReferences[i], (double)values[i]);
    }
    return fmi3OK;
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
