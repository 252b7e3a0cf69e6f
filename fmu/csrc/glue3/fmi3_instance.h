/* One FMI 3.0 instance, and what the files of the FMI 3.0 glue share. */
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

#include "core.h"

typedef enum { LOG_ERROR, LOG_DISCARD, LOG_WARNING, LOG_CATEGORIES } LogCategory;

typedef struct {
    State state;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    fmi3IntermediateUpdateCallback update;
    int logged[LOG_CATEGORIES];
    int event_mode, early_return;
    int within_step; /* fmi3DoStep is calling fmi3IntermediateUpdate: reading is all that is allowed */
    char *name;
} Instance;

/* Value references behind those of the core: the independent variable, and the event indicators. */
enum { VR_time = N_VARIABLES, VR_indicator };

/* Logs "function: message." if the importer asked for this category. */
void log_call(const Instance *instance, fmi3Status status, LogCategory category, const char *function,
              const char *message);

/* Logs "function: message" as an error and returns fmi3Error. */
fmi3Status fail(const Instance *instance, const char *function, const char *message);

/* Logs what a fault says and returns its status; fmi3OK for none. */
fmi3Status outcome(const Instance *instance, Fault fault, const char *function);

/* The instance, or NULL (and the error logged) if the function may not be called in its phase. */
Instance *enter(fmi3Instance instance, int phases, const char *function);

/* As `enter`, for one kind of instance alone. */
Instance *enter_as(fmi3Instance instance, Kind kind, int phases, const char *function);

/* As `enter`, for what may be called from fmi3IntermediateUpdate too. */
Instance *enter_to_read(fmi3Instance instance, int phases, const char *function);

/* Tells once that the validity box has been left. */
void notice(Instance *instance, const char *function);

/* Whether these arrays cannot be: NULL though there are elements, or of unequal lengths. */
int unsuitable(const Instance *instance, const void *references, size_t count, const void *values, size_t n_values,
               const char *function);

#endif
