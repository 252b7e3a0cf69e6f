/* Random calls of FMI 3.0, meant to run under sanitizers. A call that fails must change nothing, and fmi2OK must not
 * come with a number that is not finite. Arguments: number of calls, seed. Exit code 0 if all held. */
#include "fmi3Functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core.h"
#include "fuzz_numbers.h"

#ifndef FUZZ_INPUTS /* as in fuzz.c */
#define FUZZ_INPUTS VR_approach, VR_rate
#define FUZZ_OUTPUTS VR_force, VR_stiffness, VR_damping
#define FUZZ_STEP 1e-6
#endif

static int bytes_of(fmi3Instance c, uint8_t *bytes, size_t size)
{
    fmi3FMUState saved = NULL;
    const int held = fmi3GetFMUState(c, &saved) == fmi3OK && fmi3SerializeFMUState(c, saved, bytes, size) == fmi3OK;
    return fmi3FreeFMUState(c, &saved) == fmi3OK && held;
}

/* As in fuzz.c. */
static void set_parameters(fmi3Instance c)
{
    const bool tolerant = any(2) != 0;
    const fmi3ValueReference outputs[] = {FUZZ_OUTPUTS};
    fmi3Float64 found[3];
    fmi3ValueReference k;
    for (k = 0; k < N_VARIABLES; k++) {
        if (core_variables[k].role == FIXED && k != VR_LEAD && any(3) == 0) {
            const fmi3Float64 value = parameter(core_variables[k].start);
            fmi3SetFloat64(c, &k, 1, &value, 1);
        }
    }
    if (fmi3EnterInitializationMode(c, tolerant, 1e-5, 0.0, fmi3False, 0.0) == fmi3OK
        && fmi3GetFloat64(c, outputs, 3, found, 3) == fmi3OK) {
        return;
    }
    for (k = 0; k < N_VARIABLES; k++) {
        if (core_variables[k].role == FIXED && k != VR_LEAD) {
            fmi3SetFloat64(c, &k, 1, &core_variables[k].start, 1);
        }
    }
    fmi3EnterInitializationMode(c, tolerant, 1e-5, 0.0, fmi3False, 0.0);
}

/* A slave, with event mode and early return or without, or a model. */
static fmi3Instance start(int slave)
{
    const fmi3ValueReference lead = VR_LEAD;
    const fmi3Float64 value = 0.5 * any(2 * (unsigned int)MOST_LEAD + 1);
    const bool events = any(2) != 0, early = any(2) != 0;
#ifdef CO_SIMULATION_ONLY
    fmi3Instance c;
    if (fmi3InstantiateModelExchange("fuzz", MODEL_TOKEN, NULL, fmi3False, fmi3False, NULL, NULL) != NULL) {
        fprintf(stderr, "an instance for model exchange was made\n");
        exit(1);
    }
    (void)slave;
    c = fmi3InstantiateCoSimulation("fuzz", MODEL_TOKEN, NULL, fmi3False, fmi3False, events, early, NULL, 0, NULL, NULL, NULL);
#else
    fmi3Instance c = slave ? fmi3InstantiateCoSimulation("fuzz", MODEL_TOKEN, NULL, fmi3False, fmi3False, events, early,
                                                         NULL, 0, NULL, NULL, NULL)
                           : fmi3InstantiateModelExchange("fuzz", MODEL_TOKEN, NULL, fmi3False, fmi3False, NULL, NULL);
#endif
    fmi3SetFloat64(c, &lead, 1, &value, 1);
    set_parameters(c);
    return c;
}

/* Whether these are numbers; what was set may be anything, so of variables only what is computed counts: those of the core,
 * and behind them time and event indicators. */
static int finite(const double values[], const fmi3ValueReference vr[], size_t count)
{
    size_t i;
    for (i = 0; i < count; i++) {
        const int computed = vr == NULL || vr[i] >= N_VARIABLES || core_variables[vr[i]].role >= DERIVATIVE;
        if (computed && !isfinite(values[i])) {
            return 0;
        }
    }
    return 1;
}

#define MOST (N_VARIABLES + 2)

int main(int count, char **arguments)
{
    static const fmi3ValueReference inputs[] = {FUZZ_INPUTS}, outputs[] = {FUZZ_OUTPUTS};
    const long calls = count > 1 ? atol(arguments[1]) : 1000;
    fmi3Instance c;
    fmi3FMUState kept = NULL, probe = NULL;
    fmi3ValueReference vr[MOST], derivatives[N_STATES + 1];
    double values[MOST], seeds[MOST], usual[2], time = 0.0, until = 0.0;
    bool flags[MOST], a = false, b = false, d = false, e = false, f = false;
    fmi3Int64 integers[MOST];
    fmi3Int32 orders[MOST];
    size_t size = 0, n, i;
    long k, ok = 0;
    int j;
    uint8_t *before, *after;
    for (k = 0; k < N_STATES; k++) {
        derivatives[k] = (fmi3ValueReference)(FIRST_DERIVATIVE + k);
    }
    seed = count > 2 ? (unsigned long long)atol(arguments[2]) : 1;
    c = start(1);
    fmi3GetFloat64(c, inputs, 2, usual, 2);
    fmi3GetFMUState(c, &probe);
    fmi3SerializedFMUStateSize(c, probe, &size);
    fmi3FreeFMUState(c, &probe);
    before = (uint8_t *)malloc(size);
    after = (uint8_t *)malloc(size);
    fmi3ExitInitializationMode(c);
    for (k = 0; k < calls; k++) {
        const unsigned int call = any(28);
        fmi3Status status = fmi3OK;
        int judge = 0, numbers = 1;
        fmi3GetFloat64(c, outputs, 3, values, 3); /* what can be computed is: outputs are, when they are first asked for */
        fmi3GetFloat64(c, derivatives, N_STATES, values, N_STATES);
        bytes_of(c, before, size);
        n = any(4);
        for (i = 0; i < n; i++) {
            vr[i] = any(N_VARIABLES + 3);
            values[i] = anything(usual[0]);
            seeds[i] = (double)any(100) - 50.0;
            integers[i] = (fmi3Int64)any(5) - 1;
            orders[i] = (fmi3Int32)any(3);
        }
        switch (call) {
        case 0:
        case 1:
        case 2:
        case 3: /* what a master does */
            values[0] = any(50) ? usual[0] * (0.3 + (double)any(1000) / 700.0) : anything(usual[0]);
            values[1] = any(50) ? 0.0 : anything(usual[0]);
            status = fmi3SetFloat64(c, inputs, 2, values, 2);
            break;
        case 4:
        case 5:
        case 6:
        case 7: {
            const double h = any(20) ? (double)(1 + any(1000)) * FUZZ_STEP : anything(1e-3);
            status = fmi3DoStep(c, any(20) ? time : anything(time), h, fmi3True, &a, &b, &d, &until);
            if (status == fmi3OK) {
                time = until;
                judge = 1;
            }
            break;
        }
        case 8: status = fmi3SetFloat64(c, vr, n, values, any(9) ? n : n + 1); break;
        case 9:
            status = fmi3GetFloat64(c, vr, n, values, any(9) ? n : n + 1);
            numbers = status != fmi3OK || finite(values, vr, n);
            break;
        case 10: status = fmi3GetBoolean(c, vr, n, flags, n); break;
        case 11: status = fmi3GetInt64(c, vr, n, integers, n); break;
        case 12: status = fmi3SetInt64(c, vr, n, integers, n); break;
        case 13:
        case 14:
            status = call == 13 ? fmi3GetDirectionalDerivative(c, vr, n, &vr[n / 2], n - n / 2, seeds, n - n / 2, values, n)
                                : fmi3GetAdjointDerivative(c, vr, n, &vr[n / 2], n - n / 2, seeds, n, values, n - n / 2);
            numbers = status != fmi3OK || finite(values, NULL, call == 13 ? n : n - n / 2);
            break;
        case 15:
            status = fmi3GetOutputDerivatives(c, vr, n, orders, values, n);
            numbers = status != fmi3OK || finite(values, NULL, n);
            break;
        case 16:
            if (kept != NULL) {
                status = fmi3SetFMUState(c, kept);
            }
            break;
        case 17: fmi3GetFMUState(c, &kept); break;
        case 18: status = fmi3UpdateDiscreteStates(c, &a, &b, &d, &e, &f, &until); break;
        case 19:
            status = fmi3GetContinuousStateDerivatives(c, values, N_STATES);
            numbers = status != fmi3OK || finite(values, NULL, N_STATES);
            break;
        case 20:
            n = any(2) ? N_CONTACTS : any(3);
            status = fmi3GetEventIndicators(c, values, n);
            numbers = status != fmi3OK || finite(values, NULL, n);
            break;
        case 21:
            for (j = 0; j < N_STATES; j++) {
                values[j] = ((double)any(100) - 50.0) * core_variables[FIRST_STATE + j].nominal * (any(1000) ? 0.05 : 1e9);
            }
            status = fmi3SetContinuousStates(c, values, N_STATES);
            break;
        case 22: status = fmi3CompletedIntegratorStep(c, fmi3True, &a, &b); break;
        case 23:
        case 24:
        case 25: status = any(2) ? fmi3EnterStepMode(c) : any(2) ? fmi3EnterContinuousTimeMode(c) : fmi3EnterEventMode(c); break;
        case 26: status = fmi3SetTime(c, anything(1.0)); break;
        default:
            if (any(200) == 0) { /* another instance, of the other kind now and then */
                fmi3FreeFMUState(c, &kept);
                fmi3FreeInstance(c);
                c = start(any(3) != 0);
                fmi3ExitInitializationMode(c);
            }
        }
        {
            const fmi3ValueReference clock = N_VARIABLES;
            fmi3GetFloat64(c, &clock, 1, &time, 1);
        }
        bytes_of(c, after, size);
        if (status > fmi3Warning && memcmp(before, after, size) != 0) {
            fprintf(stderr, "call %u failed and changed the state\n", call);
            return 1;
        }
        ok += status == fmi3OK;
        if (!numbers) {
            fprintf(stderr, "call %u was answered with what is no number\n", call);
            return 1;
        }
        if (judge && fmi3GetFloat64(c, outputs, 3, values, 3) == fmi3OK
            && !(isfinite(values[0]) && values[0] >= 0.0 && isfinite(values[1]) && isfinite(values[2]))) {
            fprintf(stderr, "an output of a step is not finite, or pulls\n");
            return 1;
        }
    }
    fmi3FreeFMUState(c, &kept);
    fmi3FreeInstance(c);
    free(before);
    free(after);
    printf("%ld of %ld calls were answered\n", ok, calls);
    return ok > calls / 5 ? EXIT_SUCCESS : EXIT_FAILURE;
}
