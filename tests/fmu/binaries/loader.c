/* A master of a few lines: loads an FMI 2.0 library by its path and steps through states, as any C program would.
 * Usage: loader LIBRARY GUID REFERENCES..., with the references of approach, rate, force, stiffness, damping and
 * lead. Reads lines "time approach rate", the first one for the start, the others for the ends of steps;
 * writes a line "force stiffness damping" after each step, hexadecimal, so that no digit is lost. */
#include <stdio.h>
#include <stdlib.h>

#include "fmi2FunctionTypes.h"

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
    type name = (type)function(library, "fmi2" #name); \
    if (name == NULL) { \
        fprintf(stderr, "no function fmi2" #name "\n"); \
        return 3; \
    }

int main(int count, char **arguments)
{
    fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
    const fmi2Real end = 0.0; /* inputs are those of the end of a step */
    fmi2ValueReference references[6];
    fmi2Real in[2], out[3];
    double time, next;
    fmi2Component instance;
    Library library;
    int k;
    if (count != 9) {
        return 2;
    }
    library = load(arguments[1]);
    if (library == NULL) {
        fprintf(stderr, "cannot load %s\n", arguments[1]);
        return 3;
    }
    for (k = 0; k < 6; k++) {
        references[k] = (fmi2ValueReference)strtoul(arguments[3 + k], NULL, 10);
    }
    {
        GET(fmi2InstantiateTYPE *, Instantiate)
        GET(fmi2SetupExperimentTYPE *, SetupExperiment)
        GET(fmi2EnterInitializationModeTYPE *, EnterInitializationMode)
        GET(fmi2ExitInitializationModeTYPE *, ExitInitializationMode)
        GET(fmi2SetRealTYPE *, SetReal)
        GET(fmi2DoStepTYPE *, DoStep)
        GET(fmi2GetRealTYPE *, GetReal)
        GET(fmi2TerminateTYPE *, Terminate)
        GET(fmi2FreeInstanceTYPE *, FreeInstance)
        instance = Instantiate("loader", fmi2CoSimulation, arguments[2], NULL, &callbacks, fmi2False, fmi2False);
        if (instance == NULL || scanf("%lf %lf %lf", &time, &in[0], &in[1]) != 3
            || SetupExperiment(instance, fmi2False, 0.0, time, fmi2False, 0.0) != fmi2OK
            || SetReal(instance, references + 5, 1, &end) != fmi2OK
            || SetReal(instance, references, 2, in) != fmi2OK || EnterInitializationMode(instance) != fmi2OK
            || ExitInitializationMode(instance) != fmi2OK) {
            return 4;
        }
        while (scanf("%lf %lf %lf", &next, &in[0], &in[1]) == 3) {
            if (SetReal(instance, references, 2, in) != fmi2OK
                || DoStep(instance, time, next - time, fmi2True) != fmi2OK
                || GetReal(instance, references + 2, 3, out) != fmi2OK) {
                return 5;
            }
            time = next;
            printf("%a %a %a\n", out[0], out[1], out[2]);
        }
        if (Terminate(instance) != fmi2OK) {
            return 6;
        }
        FreeInstance(instance);
    }
    return 0;
}
