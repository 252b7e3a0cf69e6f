/* Random calls of FMI 2.0, meant to run under sanitizers. A call that fails must change nothing, and fmi2OK must not
 * come with a number that is not finite. Arguments: number of calls, seed. Exit code 0 if all held. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core.h"
#include "fuzz_numbers.h"

#ifndef FUZZ_INPUTS /* two inputs, three outputs of which the first is not negative; for a rotor others are given */
#define FUZZ_INPUTS VR_approach, VR_rate
#define FUZZ_OUTPUTS VR_force, VR_stiffness, VR_damping
#define FUZZ_USUAL 0.0 /* of the inputs: none, but their start value */
#define FUZZ_STEP 1e-6
#endif

static int bytes_of(fmi2Component c, char *bytes, size_t size)
{
    fmi2FMUstate saved = NULL;
    const int held = fmi2GetFMUstate(c, &saved) == fmi2OK && fmi2SerializeFMUstate(c, saved, bytes, size) == fmi2OK;
    return fmi2FreeFMUstate(c, &saved) == fmi2OK && held;
}

/* Sets some fixed parameters at random. Where the FMU refuses them all together, they get their start values again, and
 * the instance has to go on as a new one does. */
static void set_parameters(fmi2Component c)
{
    const fmi2ValueReference outputs[] = {FUZZ_OUTPUTS};
    fmi2Real found[3];
    fmi2ValueReference k;
    for (k = 0; k < N_VARIABLES; k++) {
        if (core_variables[k].role == FIXED && k != VR_LEAD && any(3) == 0) {
            const fmi2Real value = parameter(core_variables[k].start);
            fmi2SetReal(c, &k, 1, &value);
        }
    }
    if (fmi2EnterInitializationMode(c) == fmi2OK && fmi2GetReal(c, outputs, 3, found) == fmi2OK) {
        return;
    }
    for (k = 0; k < N_VARIABLES; k++) {
        if (core_variables[k].role == FIXED && k != VR_LEAD) {
            fmi2SetReal(c, &k, 1, &core_variables[k].start);
        }
    }
    fmi2EnterInitializationMode(c);
}

static fmi2Component start(fmi2Type type)
{
    static const fmi2CallbackFunctions callbacks = {NULL, NULL, NULL, NULL, NULL};
#ifdef CO_SIMULATION_ONLY
    fmi2Component c = fmi2Instantiate("fuzz", fmi2ModelExchange, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2False);
    if (c != NULL) {
        fprintf(stderr, "an instance for model exchange was made\n");
        exit(1);
    }
    type = fmi2CoSimulation;
    c = fmi2Instantiate("fuzz", type, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2False);
#else
    fmi2Component c = fmi2Instantiate("fuzz", type, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2False);
#endif
    const fmi2ValueReference lead = VR_LEAD;
    const fmi2Real value = 0.5 * any(2 * (unsigned int)MOST_LEAD + 1);
    fmi2SetupExperiment(c, any(2) ? fmi2True : fmi2False, 1e-5, 0.0, fmi2False, 0.0);
    fmi2SetReal(c, &lead, 1, &value);
    set_parameters(c);
    return c;
}

/* Whether these are numbers; what was set may be anything, so of variables only what is computed counts. */
static int finite(const double values[], const fmi2ValueReference vr[], size_t count)
{
    size_t i;
    for (i = 0; i < count; i++) {
        const int computed = vr == NULL || core_variables[vr[i]].role >= DERIVATIVE;
        if (computed && !isfinite(values[i])) {
            return 0;
        }
    }
    return 1;
}

#define MOST (N_VARIABLES + 2)

int main(int count, char **arguments)
{
    const long calls = count > 1 ? atol(arguments[1]) : 1000;
    fmi2Component c;
    fmi2FMUstate kept = NULL, probe = NULL;
    const fmi2ValueReference inputs[] = {FUZZ_INPUTS}, outputs[] = {FUZZ_OUTPUTS};
    fmi2ValueReference vr[MOST], derivatives[N_STATES + 1];
    double values[MOST], seeds[MOST], usual[2], time = 0.0;
    fmi2Boolean flags[MOST], flag = fmi2False;
    fmi2Integer integers[MOST];
    fmi2EventInfo info;
    size_t size = 0, n, i;
    long k, ok = 0;
    int j;
    char *before, *after;
    for (k = 0; k < N_STATES; k++) {
        derivatives[k] = (fmi2ValueReference)(FIRST_DERIVATIVE + k);
    }
    seed = count > 2 ? (unsigned long long)atol(arguments[2]) : 1;
    c = start(fmi2CoSimulation);
    fmi2GetReal(c, inputs, 2, usual);
    usual[0] = FUZZ_USUAL > 0.0 ? FUZZ_USUAL : usual[0];
    fmi2GetFMUstate(c, &probe);
    fmi2SerializedFMUstateSize(c, probe, &size);
    fmi2FreeFMUstate(c, &probe);
    before = (char *)malloc(size);
    after = (char *)malloc(size);
    fmi2ExitInitializationMode(c);
    for (k = 0; k < calls; k++) {
        const unsigned int call = any(26);
        fmi2Status status = fmi2OK;
        int judge = 0, numbers = 1;
        fmi2GetReal(c, outputs, 3, values); /* what can be computed is: outputs are, when they are first asked for */
        fmi2GetDerivatives(c, values, N_STATES);
        fmi2GetReal(c, derivatives, N_STATES, values);
        bytes_of(c, before, size);
        n = any(4);
        for (i = 0; i < n; i++) {
            vr[i] = any(N_VARIABLES + 2);
            values[i] = anything(usual[0]);
            seeds[i] = (double)any(100) - 50.0;
            integers[i] = (fmi2Integer)any(5) - 1;
        }
        switch (call) {
        case 0:
        case 1:
        case 2:
        case 3: /* what a master does */
            values[0] = any(50) ? usual[0] * (0.3 + (double)any(1000) / 700.0) : anything(usual[0]);
            values[1] = any(50) ? 0.0 : anything(usual[0]);
            status = fmi2SetReal(c, inputs, 2, values);
            break;
        case 4:
        case 5:
        case 6:
        case 7: {
            const double h = any(20) ? (double)(1 + any(1000)) * FUZZ_STEP : anything(1e-3);
            const double at = any(20) ? time : anything(time);
            status = fmi2DoStep(c, at, h, fmi2True);
            if (status == fmi2OK) {
                time = at + h;
                judge = 1;
            }
            break;
        }
        case 8: status = fmi2SetReal(c, vr, n, values); break;
        case 9:
            status = fmi2GetReal(c, vr, n, values);
            numbers = status != fmi2OK || finite(values, vr, n);
            break;
        case 10: status = fmi2GetBoolean(c, vr, n, flags); break;
        case 11: status = fmi2GetInteger(c, vr, n, integers); break;
        case 12: status = fmi2SetInteger(c, vr, n, integers); break;
        case 13:
            status = fmi2GetDirectionalDerivative(c, vr, n, &vr[n / 2], n - n / 2, seeds, values);
            numbers = status != fmi2OK || finite(values, NULL, n);
            break;
        case 14: status = fmi2SetRealInputDerivatives(c, vr, n, integers, values); break;
        case 15:
            status = fmi2GetRealOutputDerivatives(c, vr, n, integers, values);
            numbers = status != fmi2OK || finite(values, NULL, n);
            break;
        case 16:
            if (kept != NULL) {
                status = fmi2SetFMUstate(c, kept);
                if (status == fmi2OK) {
                    fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &time);
                }
            }
            break;
        case 17: fmi2GetFMUstate(c, &kept); break;
        case 18: status = fmi2NewDiscreteStates(c, &info); break;
        case 19:
            status = fmi2GetDerivatives(c, values, N_STATES);
            numbers = status != fmi2OK || finite(values, NULL, N_STATES);
            break;
        case 20:
            n = any(2) ? N_CONTACTS : any(3);
            status = fmi2GetEventIndicators(c, values, n);
            numbers = status != fmi2OK || finite(values, NULL, n);
            break;
        case 21:
            for (j = 0; j < N_STATES; j++) {
                values[j] = ((double)any(100) - 50.0) * core_variables[FIRST_STATE + j].nominal * (any(1000) ? 0.05 : 1e9);
            }
            status = fmi2SetContinuousStates(c, values, N_STATES);
            break;
        case 22: status = fmi2CompletedIntegratorStep(c, fmi2True, &flag, &flag); break;
        case 23: status = any(2) ? fmi2EnterContinuousTimeMode(c) : fmi2EnterEventMode(c); break;
        case 24: status = fmi2SetTime(c, anything(1.0)); break;
        default:
            if (any(200) == 0) { /* another instance, of the other kind now and then */
                fmi2FreeFMUstate(c, &kept);
                fmi2FreeInstance(c);
                c = start(any(3) ? fmi2CoSimulation : fmi2ModelExchange);
                fmi2ExitInitializationMode(c);
                time = 0.0;
            }
        }
        bytes_of(c, after, size);
        if (status > fmi2Warning && memcmp(before, after, size) != 0) {
            fprintf(stderr, "call %u failed and changed the state\n", call);
            return 1;
        }
        ok += status == fmi2OK;
        if (!numbers) {
            fprintf(stderr, "call %u was answered with what is no number\n", call);
            return 1;
        }
        if (judge) {
            if (fmi2GetReal(c, outputs, 3, values) == fmi2OK
                && !(isfinite(values[0]) && values[0] >= 0.0 && isfinite(values[1]) && isfinite(values[2]))) {
                fprintf(stderr, "an output of a step is not finite, or pulls\n");
                return 1;
            }
        }
    }
    fmi2FreeFMUstate(c, &kept);
    fmi2FreeInstance(c);
    free(before);
    free(after);
    printf("%ld of %ld calls were answered\n", ok, calls);
    return ok > calls / 4 ? EXIT_SUCCESS : EXIT_FAILURE;
}
