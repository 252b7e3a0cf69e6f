/* A master of a few lines: loads an FMI 2.0 library by its path and steps through states, as any C program would.
 * Usage: loader LIBRARY GUID COUNT REFERENCES..., with the references of lead, of COUNT inputs and of outputs.
 * Reads lines "time inputs", the first one for the start, the others for the ends of steps; writes a line of
 * outputs after each step, hexadecimal, so that no digit is lost. With LINKED defined it is linked with the sources
 * of the FMU, and loads nothing. */
#include <stdio.h>
#include <stdlib.h>

#include "fmi2FunctionTypes.h"

#ifdef LINKED
#include "fmi2Functions.h"
#define GET(type, name) type *const name = fmi2##name;
#else
#ifdef _WIN32
#include <windows.h>
typedef HMODULE Library;
static Library load(const char *path) { return LoadLibraryA(path); }
static void (*function(Library library, const char *name))(void)
{
    return (void (*)(void))GetProcAddress(library, name);
}
#else
#include <dlfcn.h>
typedef void *Library;
static Library load(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void (*function(Library library, const char *name))(void)
{
    void (*found)(void);
    *(void **)(&found) = dlsym(library, name); /* as POSIX has it */
    return found;
}
#endif

#define GET(type, name) \
    type *name = (type *)function(library, "fmi2" #name); \
    if (name == NULL) { \
        fprintf(stderr, "no function fmi2" #name "\n"); \
        return 3; \
    }
#endif

enum { MOST = 256 };

/* Reads `count` numbers; returns whether there were as many. */
static int read_row(double row[], int count)
{
    int k;
    for (k = 0; k < count && scanf("%lf", &row[k]) == 1; k++) {
    }
    return k == count;
}

int main(int count, char **arguments)
{
    fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
    const fmi2Real end = 0.0; /* inputs are those of the end of a step */
    const int inputs = count > 3 ? atoi(arguments[3]) : -1, outputs = count - 5 - inputs;
    fmi2ValueReference lead, in[MOST], out[MOST];
    fmi2Real row[1 + MOST], found[MOST];
    fmi2Component instance;
    double time;
    int k;
    if (inputs < 0 || inputs > MOST || outputs < 1 || outputs > MOST) {
        return 2;
    }
    lead = (fmi2ValueReference)strtoul(arguments[4], NULL, 10);
    for (k = 0; k < inputs + outputs; k++) {
        *(k < inputs ? &in[k] : &out[k - inputs]) = (fmi2ValueReference)strtoul(arguments[5 + k], NULL, 10);
    }
    {
#ifndef LINKED
        const Library library = load(arguments[1]);
        if (library == NULL) {
            fprintf(stderr, "cannot load %s\n", arguments[1]);
            return 3;
        }
#endif
        GET(fmi2InstantiateTYPE, Instantiate)
        GET(fmi2SetupExperimentTYPE, SetupExperiment)
        GET(fmi2EnterInitializationModeTYPE, EnterInitializationMode)
        GET(fmi2ExitInitializationModeTYPE, ExitInitializationMode)
        GET(fmi2SetRealTYPE, SetReal)
        GET(fmi2DoStepTYPE, DoStep)
        GET(fmi2GetRealTYPE, GetReal)
        GET(fmi2TerminateTYPE, Terminate)
        GET(fmi2FreeInstanceTYPE, FreeInstance)
        instance = Instantiate("loader", fmi2CoSimulation, arguments[2], NULL, &callbacks, fmi2False, fmi2False);
        if (instance == NULL || !read_row(row, 1 + inputs)
            || SetupExperiment(instance, fmi2False, 0.0, row[0], fmi2False, 0.0) != fmi2OK
            || SetReal(instance, &lead, 1, &end) != fmi2OK
            || SetReal(instance, in, (size_t)inputs, row + 1) != fmi2OK
            || EnterInitializationMode(instance) != fmi2OK || ExitInitializationMode(instance) != fmi2OK) {
            return 4;
        }
        time = row[0];
        while (read_row(row, 1 + inputs)) {
            if (SetReal(instance, in, (size_t)inputs, row + 1) != fmi2OK
                || DoStep(instance, time, row[0] - time, fmi2True) != fmi2OK
                || GetReal(instance, out, (size_t)outputs, found) != fmi2OK) {
                return 5;
            }
            time = row[0];
            for (k = 0; k < outputs; k++) {
                printf("%a%c", found[k], k < outputs - 1 ? ' ' : '\n');
            }
        }
        if (Terminate(instance) != fmi2OK) {
            return 6;
        }
        FreeInstance(instance);
    }
    return 0;
}
