/* An instance of FMI 3.0, and helpers of the FMI 3.0 interface. */
#ifndef FMI3_INSTANCE_H
#define FMI3_INSTANCE_H

#ifdef __clang__ /* two callbacks of the standard are declared without prototype */
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wstrict-prototypes"
#endif
#include "fmi3Functions.h"
#ifdef __clang__
#pragma clang diagnostic pop
#endif

#include "instance.h"

typedef struct {
    Instance common;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    fmi3IntermediateUpdateCallback update;
    int event_mode, early_return;
} Unit;

/* Value references behind those of the core: the independent variable, and the event indicators. */
enum { VR_time = N_VARIABLES, VR_indicator };

/* Logs "function: message." as an error and returns fmi3Error. */
static inline fmi3Status fail(const Instance *instance, const char *function, const char *message)
{
    return (fmi3Status)failed(instance, function, message);
}

/* Logs the reason of a fault and returns its status; fmi3OK for none. */
static inline fmi3Status outcome(const Instance *instance, Fault fault, const char *function)
{
    return fault.severity == FINE ? fmi3OK : (fmi3Status)report(instance, fault, function);
}

/* Whether these arrays cannot be: NULL though there are elements, or of unequal lengths. */
int unsuitable(const Instance *instance, const void *references, size_t count, const void *values, size_t n_values,
               const char *function);

#endif
