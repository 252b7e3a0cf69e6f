/* FMI 3.0 functions that an FMU without strings, clocks, arrays and structural parameters has no use for. All are
 * exported, because importers look for every function; each logs why and returns an error. */
#include "fmi3_instance.h"

static fmi3Status unsupported(fmi3Instance c, const char *function, const char *reason)
{
    return c == NULL ? fmi3Error : fail((const Instance *)c, function, reason);
}

/* Legal for no variables at all, which some importers ask for. */
static fmi3Status no_variables(fmi3Instance c, size_t count, const char *function)
{
    return c != NULL && count == 0 ? fmi3OK : unsupported(c, function, "no variable of this type can be named here");
}

/* One getter and one setter of a type that no variable has. */
#define NONE_OF(Name, Type) \
    fmi3Status fmi3Get##Name(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
                             Type values[], size_t nValues) \
    { \
        (void)valueReferences, (void)values, (void)nValues; \
        return no_variables(c, nValueReferences, "fmi3Get" #Name); \
    } \
    fmi3Status fmi3Set##Name(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
                             const Type values[], size_t nValues) \
    { \
        (void)valueReferences, (void)values, (void)nValues; \
        return no_variables(c, nValueReferences, "fmi3Set" #Name); \
    }

NONE_OF(Float32, fmi3Float32)
NONE_OF(Int8, fmi3Int8)
NONE_OF(UInt8, fmi3UInt8)
NONE_OF(Int16, fmi3Int16)
NONE_OF(UInt16, fmi3UInt16)
NONE_OF(Int32, fmi3Int32)
NONE_OF(UInt32, fmi3UInt32)
NONE_OF(Int64, fmi3Int64)
NONE_OF(UInt64, fmi3UInt64)
NONE_OF(String, fmi3String)

fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          const fmi3Boolean values[], size_t nValues)
{
    (void)valueReferences, (void)values, (void)nValues;
    return no_variables(c, nValueReferences, "fmi3SetBoolean");
}

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                         size_t valueSizes[], fmi3Binary values[], size_t nValues)
{
    (void)valueReferences, (void)valueSizes, (void)values, (void)nValues;
    return no_variables(c, nValueReferences, "fmi3GetBinary");
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                         const size_t valueSizes[], const fmi3Binary values[], size_t nValues)
{
    (void)valueReferences, (void)valueSizes, (void)values, (void)nValues;
    return no_variables(c, nValueReferences, "fmi3SetBinary");
}

/* ---- clocks ---- */

/* A function about clocks, with an array of values for each of them, or with two. */
#define NO_CLOCK(Name, Values) \
    fmi3Status fmi3##Name(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
                          Values values[]) \
    { \
        (void)valueReferences, (void)values; \
        return no_variables(c, nValueReferences, "fmi3" #Name); \
    }

#define NO_CLOCK_WITH_TWO(Name, Values, Others) \
    fmi3Status fmi3##Name(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
                          Values values[], Others others[]) \
    { \
        (void)valueReferences, (void)values, (void)others; \
        return no_variables(c, nValueReferences, "fmi3" #Name); \
    }

NO_CLOCK(GetClock, fmi3Clock)
NO_CLOCK(SetClock, const fmi3Clock)
NO_CLOCK(GetShiftDecimal, fmi3Float64)
NO_CLOCK(SetShiftDecimal, const fmi3Float64)
NO_CLOCK(SetIntervalDecimal, const fmi3Float64)
NO_CLOCK_WITH_TWO(GetIntervalDecimal, fmi3Float64, fmi3IntervalQualifier)
NO_CLOCK_WITH_TWO(GetShiftFraction, fmi3UInt64, fmi3UInt64)
NO_CLOCK_WITH_TWO(SetIntervalFraction, const fmi3UInt64, const fmi3UInt64)
NO_CLOCK_WITH_TWO(SetShiftFraction, const fmi3UInt64, const fmi3UInt64)

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                   fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)counters, (void)resolutions, (void)qualifiers;
    return no_variables(c, nValueReferences, "fmi3GetIntervalFraction");
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clockReference, fmi3Float64 activationTime)
{
    (void)clockReference, (void)activationTime;
    return unsupported(c, "fmi3ActivateModelPartition", "this FMU has no clocks");
}

/* ---- dependencies that change, configuration ---- */

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference valueReference,
                                               size_t *nDependencies)
{
    (void)valueReference, (void)nDependencies;
    return unsupported(c, "fmi3GetNumberOfVariableDependencies", "dependencies are those of the model description");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent,
                                       size_t elementIndicesOfDependent[], fmi3ValueReference independents[],
                                       size_t elementIndicesOfIndependents[], fmi3DependencyKind dependencyKinds[],
                                       size_t nDependencies)
{
    (void)dependent, (void)elementIndicesOfDependent, (void)independents, (void)elementIndicesOfIndependents;
    (void)dependencyKinds, (void)nDependencies;
    return unsupported(c, "fmi3GetVariableDependencies", "dependencies are those of the model description");
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c)
{
    return unsupported(c, "fmi3EnterConfigurationMode", "there are no structural parameters");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance c)
{
    return unsupported(c, "fmi3ExitConfigurationMode", "there are no structural parameters");
}
