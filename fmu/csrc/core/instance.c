/* Creation, guards, logging and phases of an instance of any FMI version, and its saved states; see instance.h. */
#include "instance.h"

#include <stdio.h>
#include <string.h>

const char *const log_categories[LOG_CATEGORIES] = {"logStatusError", "logStatusDiscard", "logStatusWarning"};

/* ---- logging and guards ---- */

static int log_call(const Instance *instance, int status, LogCategory category, const char *function,
                    const char *message)
{
    char text[256];
    if (instance->logged[category]) {
        snprintf(text, sizeof text, "%s: %s.", function, message);
        instance->version->log(instance, status, log_categories[category], text);
    }
    return status;
}

int failed(const Instance *instance, const char *function, const char *message)
{
    return log_call(instance, FAILED, LOG_ERROR, function, message);
}

int report(const Instance *instance, Fault fault, const char *function)
{
    if (fault.severity == FINE) {
        return DONE;
    }
    return fault.severity == REFUSE ? failed(instance, function, fault.reason)
                                    : log_call(instance, DISCARDED, LOG_DISCARD, function, fault.reason);
}

void warn_if_outside(Instance *instance, const char *function)
{
    char text[160];
    if (core_warning(&instance->state, text, sizeof text) != NULL) {
        log_call(instance, WARNED, LOG_WARNING, function, text);
    }
}

void warn_of_step(Instance *instance, const char *function)
{
    char text[200];
    const char *of_step = core_step_warning(&instance->state, &instance->told);
    const char *of_master = master_warning(&instance->master, &instance->state, text, sizeof text);
    if (of_step != NULL) {
        log_call(instance, WARNED, LOG_WARNING, function, of_step);
    }
    if (of_master != NULL) {
        log_call(instance, WARNED, LOG_WARNING, function, of_master);
    }
    warn_if_outside(instance, function);
}

Instance *enter_as(void *c, Kind kind, int phases, const char *function)
{
    const Instance *instance = (const Instance *)c;
    if (instance != NULL && instance->state.kind != (int)kind) {
        failed(instance, function,
               kind == CO_SIMULATION ? "this instance is for model exchange" : "this instance is for co-simulation");
        return NULL;
    }
    return enter(c, phases, function);
}

/* Errors are always logged; the rest as asked for. */
static void set_logging(Instance *instance, int on)
{
    instance->logged[LOG_ERROR] = 1;
    instance->logged[LOG_DISCARD] = on;
    instance->logged[LOG_WARNING] = on;
}

int choose_logging(void *c, int on, size_t count, const char *const categories[], const char *function)
{
    Instance *instance = enter(c, ANY_PHASE, function);
    int chosen[LOG_CATEGORIES] = {0};
    size_t i;
    int k;
    if (instance == NULL || (count > 0 && categories == NULL)) {
        return FAILED;
    }
    for (i = 0; i < count; i++) {
        for (k = 0; k < LOG_CATEGORIES; k++) {
            if (categories[i] != NULL && strcmp(categories[i], log_categories[k]) == 0) {
                chosen[k] = 1;
                break;
            }
        }
        if (k == LOG_CATEGORIES) {
            return failed(instance, function, "unknown log category");
        }
    }
    if (count == 0) {
        set_logging(instance, on);
    }
    for (k = 0; k < LOG_CATEGORIES; k++) {
        if (chosen[k]) {
            instance->logged[k] = on || k == LOG_ERROR;
        }
    }
    return DONE;
}

/* ---- creation and destruction ---- */

void *make_instance(Instance *like, size_t size, const char *name, const char *token, int logging_on, Kind kind,
                    const char *function)
{
    const Version *version = like->version;
    Instance *made;
    char *copy;
    like->name = name;
    set_logging(like, logging_on);
    if (name == NULL || name[0] == '\0') {
        failed(like, function, "the instance has no name");
        return NULL;
    }
    if (token == NULL || strcmp(token, MODEL_TOKEN) != 0) {
        failed(like, function, version->wrong_token);
        return NULL;
    }
#ifdef CO_SIMULATION_ONLY
    if (kind == MODEL_EXCHANGE) {
        failed(like, function, "this FMU is for co-simulation alone");
        return NULL;
    }
#endif
    made = (Instance *)version->allocate(like, size);
    copy = made == NULL ? NULL : (char *)version->allocate(like, strlen(name) + 1);
    if (copy == NULL) {
        if (made != NULL) {
            version->release(like, made);
        }
        failed(like, function, "out of memory");
        return NULL;
    }
    strcpy(copy, name);
    memcpy(made, like, size);
    made->name = copy;
    core_start(&made->state, kind);
    return made;
}

void free_instance(void *c)
{
    Instance *instance = (Instance *)c;
    if (instance != NULL) {
        instance->version->release(instance, (void *)instance->name);
        instance->version->release(instance, instance);
    }
}

/* ---- call sequence ---- */

static int set_phase(Instance *instance, Phase next)
{
    if (instance == NULL) {
        return FAILED;
    }
    instance->state.phase = (int)next;
    return DONE;
}

int enter_phase(void *c, int phases, Phase next, const char *function)
{
    return set_phase(enter(c, phases, function), next);
}

int enter_phase_as(void *c, Kind kind, int phases, Phase next, const char *function)
{
    return set_phase(enter_as(c, kind, phases, function), next);
}

int set_up(void *c, double start, int has_stop, double stop, int has_tolerance, double tolerance, const char *function)
{
    Instance *instance = enter(c, INSTANTIATED, function);
    return instance == NULL ? FAILED
        : report(instance, core_setup(&instance->state, start, has_stop, stop, has_tolerance, tolerance), function);
}

int exit_initialization(void *c, int event_mode, const char *function)
{
    Instance *instance = enter(c, INITIALIZATION, function);
    Fault fault;
    if (instance == NULL) {
        return FAILED;
    }
    fault = core_exit_initialization(&instance->state);
    if (fault.severity == FINE) {
        if (event_mode && instance->state.kind == CO_SIMULATION) {
            instance->state.phase = EVENT;
        }
        warn_if_outside(instance, function);
    }
    return report(instance, fault, function);
}

int reset(void *c, const char *function)
{
    Instance *instance = enter(c, ANY_PHASE, function);
    if (instance == NULL) {
        return FAILED;
    }
    core_start(&instance->state, (Kind)instance->state.kind);
    memset(&instance->master, 0, sizeof instance->master);
    memset(&instance->told, 0, sizeof instance->told);
    return DONE;
}

/* ---- saved states ---- */

/* Memory for a state, where there is none yet. */
static int make_room(const Instance *instance, void **saved, const char *function)
{
    if (*saved == NULL) {
        *saved = instance->version->allocate(instance, sizeof(Saved));
    }
    return *saved == NULL ? failed(instance, function, "out of memory") : DONE;
}

int save_state(void *c, void **saved, const char *function)
{
    const Instance *instance = enter(c, ANY_PHASE, function);
    if (instance == NULL || saved == NULL || make_room(instance, saved, function) != DONE) {
        return FAILED;
    }
    core_save(&instance->state, instance->version->token, (Saved *)*saved);
    return DONE;
}

int load_state(void *c, const void *saved, const char *function)
{
    Instance *instance = enter(c, ANY_PHASE, function);
    if (instance == NULL || saved == NULL) {
        return FAILED;
    }
    master_goes_back(&instance->master);
    return report(instance, core_load(&instance->state, instance->version->token, (const Saved *)saved), function);
}

int free_state(void *c, void **saved, const char *function)
{
    const Instance *instance = enter(c, ANY_PHASE, function);
    if (instance == NULL) {
        return FAILED;
    }
    if (saved != NULL && *saved != NULL) {
        instance->version->release(instance, *saved);
        *saved = NULL;
    }
    return DONE;
}

int size_state(void *c, const void *saved, size_t *size, const char *function)
{
    if (enter(c, ANY_PHASE, function) == NULL || saved == NULL || size == NULL) {
        return FAILED;
    }
    *size = sizeof(Saved);
    return DONE;
}

int write_state(void *c, const void *saved, void *bytes, size_t size, const char *function)
{
    const Instance *instance = enter(c, ANY_PHASE, function);
    if (instance == NULL || saved == NULL || bytes == NULL) {
        return FAILED;
    }
    if (size < sizeof(Saved)) {
        return failed(instance, function, "the buffer is too small");
    }
    memcpy(bytes, saved, sizeof(Saved));
    return DONE;
}

int read_state(void *c, const void *bytes, size_t size, void **saved, const char *function)
{
    const Instance *instance = enter(c, ANY_PHASE, function);
    State probe;
    Saved found;
    Fault fault;
    if (instance == NULL || bytes == NULL || saved == NULL) {
        return FAILED;
    }
    if (size != sizeof found) {
        return failed(instance, function, "not a state of this FMU: wrong size");
    }
    memcpy(&found, bytes, sizeof found);
    probe = instance->state;
    fault = core_load(&probe, instance->version->token, &found);
    if (fault.severity != FINE) {
        return report(instance, fault, function);
    }
    if (make_room(instance, saved, function) != DONE) {
        return FAILED;
    }
    memcpy(*saved, &found, sizeof found);
    return DONE;
}
