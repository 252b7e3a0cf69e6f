/* Values and derivatives of the variables of an instance of any FMI version; see instance.h. */
#include "instance.h"

int get_values(Instance *instance, const unsigned int references[], size_t count, Type type, void *values,
               void (*put)(void *values, size_t i, double value), const char *function)
{
    size_t i;
    for (i = 0; i < count; i++) {
        double found = 0.0;
        const Fault fault = core_get(&instance->state, &references[i], 1, type, &found);
        if (fault.severity != FINE) {
            return report(instance, fault, function);
        }
        put(values, i, found);
    }
    return DONE;
}

int set_values(Instance *instance, const unsigned int references[], size_t count, Type type, const void *values,
               double (*take)(const void *values, size_t i), const char *function)
{
    size_t i;
    for (i = 0; i < count; i++) {
        const Fault fault = core_may_set(&instance->state, references[i], type, take(values, i));
        if (fault.severity != FINE) {
            return report(instance, fault, function);
        }
    }
    for (i = 0; i < count; i++) {
        const double value = take(values, i);
        core_set(&instance->state, &references[i], 1, type, &value);
    }
    return DONE;
}

int get_slopes(Instance *instance, const unsigned int references[], size_t count, const int orders[], double values[],
               const char *function)
{
    size_t i;
    master_is_unclear(&instance->master);
    for (i = 0; i < count; i++) {
        Fault fault;
        if (orders[i] != 1) {
            return failed(instance, function, "only first derivatives are provided");
        }
        fault = core_output_slope(&instance->state, references[i], &values[i]);
        if (fault.severity != FINE) {
            return report(instance, fault, function);
        }
    }
    return DONE;
}
