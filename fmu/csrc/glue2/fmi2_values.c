/* FMI 2.0 around the core: variables and directional derivatives. */
#include "fmi2_instance.h"

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    Instance *instance = enter(c, READABLE, "fmi2GetReal");
    if (instance == NULL || missing(vr, value, nvr)) {
        return fmi2Error;
    }
    return outcome(instance, core_get(&instance->state, vr, nvr, REAL, value), "fmi2GetReal");
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[])
{
    Instance *instance = enter(c, ANY_PHASE, "fmi2SetReal");
    if (instance == NULL || missing(vr, value, nvr)) {
        return fmi2Error;
    }
    return outcome(instance, core_set(&instance->state, vr, nvr, REAL, value), "fmi2SetReal");
}

/* ---- flags ---- */

static void put_boolean(void *values, size_t i, double value)
{
    ((fmi2Boolean *)values)[i] = value > 0.0 ? fmi2True : fmi2False;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[])
{
    Instance *instance = enter(c, READABLE, "fmi2GetBoolean");
    if (instance == NULL || missing(vr, value, nvr)) {
        return fmi2Error;
    }
    return (fmi2Status)get_values(instance, vr, nvr, BOOLEAN, value, put_boolean, "fmi2GetBoolean");
}

/* ---- partial derivatives ---- */

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[], size_t nUnknown,
                                        const fmi2ValueReference vKnown_ref[], size_t nKnown,
                                        const fmi2Real dvKnown[], fmi2Real dvUnknown[])
{
    Instance *instance = enter(c, READABLE, "fmi2GetDirectionalDerivative");
    if (instance == NULL || missing(vUnknown_ref, dvUnknown, nUnknown) || missing(vKnown_ref, dvKnown, nKnown)) {
        return fmi2Error;
    }
    return outcome(instance,
                   core_directional(&instance->state, vUnknown_ref, nUnknown, vKnown_ref, nKnown, dvKnown, dvUnknown),
                   "fmi2GetDirectionalDerivative");
}

/* ---- what there is none of ---- */

/* Legal for no variables at all, which some importers ask for. */
static fmi2Status no_variables(fmi2Component c, size_t count, const char *function)
{
    if (c == NULL) {
        return fmi2Error;
    }
    return count == 0 ? fmi2OK : fail((const Instance *)c, function, "no variable of this type can be named here");
}

#define NONE_OF(Name, Values) \
    fmi2Status fmi2##Name(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, Values value[]) \
    { \
        (void)vr, (void)value; \
        return no_variables(c, nvr, "fmi2" #Name); \
    }

NONE_OF(GetInteger, fmi2Integer)
NONE_OF(SetInteger, const fmi2Integer)
NONE_OF(GetString, fmi2String)
NONE_OF(SetString, const fmi2String)
NONE_OF(SetBoolean, const fmi2Boolean)
