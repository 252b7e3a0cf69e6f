/* An instance as both versions of FMI have it, and the calls that are the same in both: guards, logging, model exchange,
 * saved states. Functions of FMI return what these do, cast: the numbers of their statuses are the same. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "master.h"

typedef enum { LOG_ERROR, LOG_DISCARD, LOG_WARNING, LOG_CATEGORIES } LogCategory;

enum { DONE = 0, WARNED = 1, DISCARDED = 2, FAILED = 3 }; /* statuses of a call */

typedef struct Instance Instance;

/* What the interface of a version provides. */
typedef struct {
    const char *token;       /* of saved states */
    const char *wrong_token; /* message about another token at instantiation */
    void (*log)(const Instance *instance, int status, const char *category, const char *text); /* to the importer */
    void *(*allocate)(const Instance *instance, size_t size);                                  /* zeroed, or NULL */
    void (*release)(const Instance *instance, void *memory);
} Version;

/* The first member of the instance of a version. */
struct Instance {
    State state;
    Master master;
    Told told;
    const Version *version;
    int logged[LOG_CATEGORIES];
    int within_step; /* the importer is called from a step: reading is all that it may do */
    const char *name;
};

extern const char *const log_categories[LOG_CATEGORIES];

/* A new instance of `size` bytes, a copy of `like`, which has its version and callbacks; NULL, and the error logged, for
 * want of a name, the right token or memory. */
void *make_instance(Instance *like, size_t size, const char *name, const char *token, int logging_on, Kind kind,
                    const char *function);
void free_instance(void *c);

int choose_logging(void *c, int on, size_t count, const char *const categories[], const char *function);

/* Logs "function: message." as an error and returns FAILED. */
int failed(const Instance *instance, const char *function, const char *message);

/* Logs the reason of a fault and returns its status. */
int report(const Instance *instance, Fault fault, const char *function);

/* Logs once that the validity box has been left. */
void warn_if_outside(Instance *instance, const char *function);

/* The same after a step, with what the core warns of. */
void warn_of_step(Instance *instance, const char *function);

/* The instance behind c, or NULL (and the error logged) if the function may not be called in its phase; for what may be
 * called from within a step too. */
static inline Instance *enter_to_read(void *c, int phases, const char *function)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL && (instance->state.phase & phases) == 0) {
        failed(instance, function, "not allowed at this point of the call sequence");
        return NULL;
    }
    return instance;
}

/* As above, for what may not; for one kind of instance alone. */
static inline Instance *enter(void *c, int phases, const char *function)
{
    Instance *instance = enter_to_read(c, phases, function);
    if (instance != NULL && instance->within_step) {
        failed(instance, function, "not allowed within fmi3IntermediateUpdate");
        return NULL;
    }
    return instance;
}

Instance *enter_as(void *c, Kind kind, int phases, const char *function);

/* Enters another phase of the call sequence. */
int enter_phase(void *c, int phases, Phase next, const char *function);
int enter_phase_as(void *c, Kind kind, int phases, Phase next, const char *function);
int set_up(void *c, double start, int has_stop, double stop, int has_tolerance, double tolerance, const char *function);
int exit_initialization(void *c, int event_mode, const char *function);
int reset(void *c, const char *function);

/* Variables of a type that the importer has in an array of its own type of number: `put` writes entry i, `take` reads it.
 * All values are set, or none. Derivatives of outputs in time, of order 1 alone. */
int get_values(Instance *instance, const unsigned int references[], size_t count, Type type, void *values,
               void (*put)(void *values, size_t i, double value), const char *function);
int set_values(Instance *instance, const unsigned int references[], size_t count, Type type, const void *values,
               double (*take)(const void *values, size_t i), const char *function);
int get_slopes(Instance *instance, const unsigned int references[], size_t count, const int orders[], double values[],
               const char *function);

/* Model exchange. */
int set_time(void *c, double time, const char *function);
int set_states(void *c, const double states[], size_t count, const char *function);
int get_states(void *c, double states[], size_t count, const char *function);
int get_nominals(void *c, double nominals[], size_t count, const char *function);
int get_rates(void *c, double rates[], size_t count, const char *function);
int get_indicators(void *c, double indicators[], size_t count, const char *function);
int complete_step(void *c, const char *function);

/* Saved states. */
int save_state(void *c, void **saved, const char *function);
int load_state(void *c, const void *saved, const char *function);
int free_state(void *c, void **saved, const char *function);
int size_state(void *c, const void *saved, size_t *size, const char *function);
int write_state(void *c, const void *saved, void *bytes, size_t size, const char *function);
int read_state(void *c, const void *bytes, size_t size, void **saved, const char *function);

#endif
