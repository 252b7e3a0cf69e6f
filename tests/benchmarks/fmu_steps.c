/* Times the usual loop of a co-simulation master on an FMU of FMI 2.0: fmi2SetReal of approach and rate, fmi2DoStep,
 * fmi2GetReal. Arguments: library, GUID, URI of the resources, lead and its value reference (-1 for none),
 * number of outputs (value references from 2 on), step, mean, amplitude and steps per period of the approach, periods,
 * repetitions. Prints a line for each repetition: seconds of the wall and of the processor per step. Exit code 0 if
 * every call was answered. */
#define _POSIX_C_SOURCE 199309L
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmi2FunctionTypes.h"

enum { MOST_OUTPUTS = 8 };

static void *library;

static void log_nothing(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                        fmi2String message, ...)
{
    (void)environment, (void)name, (void)status, (void)category, (void)message;
}

static void *function(const char *name)
{
    void *found = dlsym(library, name);
    if (found == NULL) {
        fprintf(stderr, "%s is missing\n", name);
        exit(EXIT_FAILURE);
    }
    return found;
}

static void require(fmi2Status status, const char *what)
{
    if (status != fmi2OK) {
        fprintf(stderr, "%s: status %d\n", what, (int)status);
        exit(EXIT_FAILURE);
    }
}

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int count, char **arguments)
{
    static const fmi2CallbackFunctions callbacks = {log_nothing, calloc, free, NULL, NULL};
    const fmi2ValueReference inputs[] = {0, 1};
    fmi2ValueReference outputs[MOST_OUTPUTS], reference;
    double values[MOST_OUTPUTS], chosen, h, mean, amplitude, time = 0.0;
    double (*motion)[2];
    size_t n, i;
    int lead;
    long steps, periods, repetitions, k, j, r;
    fmi2Component c;
    fmi2SetRealTYPE *set;
    fmi2DoStepTYPE *step;
    fmi2GetRealTYPE *get;
    if (count != 13 || (library = dlopen(arguments[1], RTLD_LAZY)) == NULL) {
        fprintf(stderr, "no library: %s\n", count != 13 ? "12 arguments are needed" : dlerror());
        return EXIT_FAILURE;
    }
    chosen = atof(arguments[4]);
    lead = atoi(arguments[5]);
    reference = (fmi2ValueReference)lead;
    n = (size_t)atoi(arguments[6]);
    h = atof(arguments[7]);
    mean = atof(arguments[8]);
    amplitude = atof(arguments[9]);
    steps = atol(arguments[10]);
    periods = atol(arguments[11]);
    repetitions = atol(arguments[12]);
    for (i = 0; i < MOST_OUTPUTS; i++) {
        outputs[i] = (fmi2ValueReference)(2 + i);
    }
    motion = malloc((size_t)steps * sizeof *motion);
    if (motion == NULL || n > MOST_OUTPUTS) {
        return EXIT_FAILURE;
    }
    for (k = 0; k < steps; k++) {
        const double angle = 6.283185307179586 * (double)(k + 1) / (double)steps;
        motion[k][0] = mean + amplitude * sin(angle);
        motion[k][1] = amplitude * 6.283185307179586 / ((double)steps * h) * cos(angle);
    }
    c = ((fmi2InstantiateTYPE *)function("fmi2Instantiate"))("timed", fmi2CoSimulation, arguments[2], arguments[3],
                                                             &callbacks, fmi2False, fmi2False);
    if (c == NULL) {
        fprintf(stderr, "no instance\n");
        return EXIT_FAILURE;
    }
    if (lead >= 0) {
        require(((fmi2SetRealTYPE *)function("fmi2SetReal"))(c, &reference, 1, &chosen), "fmi2SetReal");
    }
    require(((fmi2SetupExperimentTYPE *)function("fmi2SetupExperiment"))(c, fmi2False, 0.0, 0.0, fmi2False, 0.0),
            "fmi2SetupExperiment");
    require(((fmi2EnterInitializationModeTYPE *)function("fmi2EnterInitializationMode"))(c),
            "fmi2EnterInitializationMode");
    require(((fmi2ExitInitializationModeTYPE *)function("fmi2ExitInitializationMode"))(c),
            "fmi2ExitInitializationMode");
    set = (fmi2SetRealTYPE *)function("fmi2SetReal");
    step = (fmi2DoStepTYPE *)function("fmi2DoStep");
    get = (fmi2GetRealTYPE *)function("fmi2GetReal");
    for (r = 0; r < repetitions; r++) {
        const double wall = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
        double total;
        for (j = 0; j < periods; j++) {
            for (k = 0; k < steps; k++) {
                require(set(c, inputs, 2, motion[k]), "fmi2SetReal");
                require(step(c, time, h, fmi2True), "fmi2DoStep");
                require(get(c, outputs, n, values), "fmi2GetReal");
                time += h;
            }
        }
        total = (double)steps * (double)periods;
        printf("%.6g %.6g\n", (seconds(CLOCK_MONOTONIC) - wall) / total,
               (seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu) / total);
    }
    ((fmi2FreeInstanceTYPE *)function("fmi2FreeInstance"))(c);
    free(motion);
    return EXIT_SUCCESS;
}
