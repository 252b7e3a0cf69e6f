/* Helpers of the FMI 2.0 interface. */
#ifndef FMI2_INSTANCE_H
#define FMI2_INSTANCE_H

#include "fmi2Functions.h"

#include "instance.h"

/* Logs "function: message." as an error and returns fmi2Error. */
static inline fmi2Status fail(const Instance *instance, const char *function, const char *message)
{
    return (fmi2Status)failed(instance, function, message);
}

/* Logs the reason of a fault and returns its status; fmi2OK for none. */
static inline fmi2Status outcome(const Instance *instance, Fault fault, const char *function)
{
    return fault.severity == FINE ? fmi2OK : (fmi2Status)report(instance, fault, function);
}

/* NULL arrays are legal only for no elements. */
static inline int missing(const void *references, const void *values, size_t count)
{
    return count > 0 && (references == NULL || values == NULL);
}

#endif
