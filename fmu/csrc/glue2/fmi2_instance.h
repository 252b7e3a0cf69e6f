/* One FMI 2.0 instance, and what the files of the FMI 2.0 glue share. */
#ifndef FMI2_INSTANCE_H
#define FMI2_INSTANCE_H

#include "fmi2Functions.h"

#include "core.h"

typedef enum { LOG_ERROR, LOG_DISCARD, LOG_WARNING, LOG_CATEGORIES } LogCategory;

typedef struct {
    State state;
    fmi2CallbackFunctions callbacks;
    int logged[LOG_CATEGORIES];
    char *name;
} Instance;

/* Logs "function: message.", free of percent signs, if the importer asked for this category. */
void log_call(const Instance *instance, fmi2Status status, LogCategory category, const char *function,
              const char *message);

/* Logs "function: message" as an error and returns fmi2Error. */
fmi2Status fail(const Instance *instance, const char *function, const char *message);

/* Logs what a fault says and returns its status; fmi2OK for none. */
fmi2Status outcome(const Instance *instance, Fault fault, const char *function);

/* The instance behind c, or NULL (and the error logged) if the function may not be called in its phase. */
Instance *enter(fmi2Component c, int phases, const char *function);

/* As `enter`, for one kind of instance alone. */
Instance *enter_as(fmi2Component c, Kind kind, int phases, const char *function);

/* Tells once that the validity box has been left. */
void notice(Instance *instance, const char *function);

/* NULL arrays are legal only for no elements. */
static inline int missing(const void *references, const void *values, size_t count)
{
    return count > 0 && (references == NULL || values == NULL);
}

/* Zeroed memory from the importer's allocator, where it has one. */
void *allocate(const fmi2CallbackFunctions *callbacks, size_t size);
void release(const fmi2CallbackFunctions *callbacks, void *memory);

#endif
