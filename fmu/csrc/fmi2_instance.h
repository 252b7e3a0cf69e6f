/* One FMI 2.0 co-simulation instance. All of it that can change is in State, which is copied to save and restore. */
#ifndef FMI2_INSTANCE_H
#define FMI2_INSTANCE_H

#include "fmi2Functions.h"

#include "model.h"

/* Call states of FMI 2.0, section 4.2.4; bits, so that a function can name those it may be called in. */
typedef enum {
    INSTANTIATED = 1,
    INITIALIZATION = 2,
    STEPPING = 4,
    TERMINATED = 8
} Phase;

enum { ANY_PHASE = INSTANTIATED | INITIALIZATION | STEPPING | TERMINATED };

/* No padding: its bytes are the serialized state. */
typedef struct {
    Model model;
    double time;
    double stop_time;
    int phase;
    int has_stop_time;
    int noticed; /* the present notice of the model is in the log already */
    int spare;
} State;

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

/* The instance behind c, or NULL (and the error logged) if the function may not be called in its phase. */
Instance *enter(fmi2Component c, int phases, const char *function);

/* Zeroed memory from the importer's allocator, where it has one. */
void *allocate(const fmi2CallbackFunctions *callbacks, size_t size);
void release(const fmi2CallbackFunctions *callbacks, void *memory);

#endif
