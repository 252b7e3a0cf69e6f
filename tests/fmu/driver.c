/* Drives the FMU's C sources without any importer; meant to run under the address and undefined-behaviour
 * sanitizers. Reads lines "step approach rate", the ends of steps of co-simulation, and prints force, stiffness and
 * damping of each; exit code 0 if all held. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config.h"

#define CHECK(condition) check((condition), #condition, __LINE__)

static int failures = 0;
static int messages = 0;
static int allocations_left = -1; /* -1: no limit */

static void check(int held, const char *condition, int line)
{
    if (!held) {
        fprintf(stderr, "driver.c:%d: %s\n", line, condition);
        failures++;
    }
}

static void count_message(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                          fmi2String category, fmi2String message, ...)
{
    (void)environment, (void)name, (void)status;
    CHECK(category != NULL && strchr(message, '%') == NULL);
    messages++;
}

static void *allocate_some(size_t count, size_t size)
{
    if (allocations_left == 0) {
        return NULL;
    }
    if (allocations_left > 0) {
        allocations_left--;
    }
    return calloc(count, size);
}

static const fmi2CallbackFunctions callbacks = {count_message, allocate_some, free, NULL, NULL};

static fmi2Component instantiate(const char *name)
{
    return fmi2Instantiate(name, fmi2CoSimulation, MODEL_TOKEN, "file:///nowhere", &callbacks, fmi2False, fmi2True);
}

static double clock_of_steps = 0.0; /* of the instance started last */

static fmi2Component started(const char *name)
{
    const fmi2ValueReference lead[] = {VR_lead};
    const fmi2Real end = 0.0, nonsense = 2.5;
    fmi2Component c = instantiate(name);
    CHECK(c != NULL);
    CHECK(fmi2SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK);
    CHECK(fmi2SetReal(c, lead, 1, &nonsense) == fmi2Error);
    CHECK(fmi2SetReal(c, lead, 1, &end) == fmi2OK);
    CHECK(fmi2EnterInitializationMode(c) == fmi2OK);
    CHECK(fmi2ExitInitializationMode(c) == fmi2OK);
    clock_of_steps = 0.0;
    return c;
}

static const fmi2ValueReference inputs[] = {VR_approach, VR_rate};
static const fmi2ValueReference outputs[] = {VR_force, VR_stiffness, VR_damping};

static fmi2Status step(fmi2Component c, double h, double u, double v, double *result)
{
    const double values[] = {u, v};
    fmi2Status status;
    CHECK(fmi2SetReal(c, inputs, 2, values) == fmi2OK);
    status = fmi2DoStep(c, clock_of_steps, h, fmi2True);
    clock_of_steps += status == fmi2OK ? h : 0.0;
    return status == fmi2OK ? fmi2GetReal(c, outputs, 3, result) : status;
}

static fmi2Status evaluate(fmi2Component c, double u, double v, double *result)
{
    return step(c, 1e-3, u, v, result);
}

static void refusals(void)
{
    fmi2CallbackFunctions own_memory = {NULL, NULL, NULL, NULL, NULL};
    fmi2Component c;
    int n;
    CHECK(fmi2Instantiate("a", fmi2CoSimulation, MODEL_TOKEN, NULL, NULL, fmi2False, fmi2False) == NULL);
    CHECK(fmi2Instantiate(NULL, fmi2CoSimulation, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2False) == NULL);
    CHECK(fmi2Instantiate("", fmi2CoSimulation, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2False) == NULL);
    CHECK(fmi2Instantiate("a", fmi2CoSimulation, "{0}", NULL, &callbacks, fmi2False, fmi2False) == NULL);
    CHECK(fmi2Instantiate("a", fmi2CoSimulation, NULL, NULL, &callbacks, fmi2False, fmi2False) == NULL);
    CHECK(fmi2Instantiate("a", (fmi2Type)7, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2False) == NULL);
    CHECK(fmi2Instantiate(NULL, fmi2CoSimulation, NULL, NULL, &own_memory, fmi2False, fmi2False) == NULL);
    CHECK(messages == 5);
    for (n = 0; n < 2; n++) {
        allocations_left = n;
        CHECK(instantiate("a") == NULL);
    }
    allocations_left = -1;
    c = fmi2Instantiate("a", fmi2CoSimulation, MODEL_TOKEN, NULL, &own_memory, fmi2False, fmi2True);
    CHECK(c != NULL);
    CHECK(fmi2DoStep(c, 0.0, 1.0, fmi2True) == fmi2Error);
    fmi2FreeInstance(c);
    fmi2FreeInstance(NULL);
}

static void null_arguments(void)
{
    fmi2Component c = started("nulls");
    fmi2FMUstate state = NULL;
    double value = 0.0;
    size_t size = 0;
    char bytes[4096];
    CHECK(fmi2GetReal(c, NULL, 0, NULL) == fmi2OK);
    CHECK(fmi2GetReal(c, NULL, 1, &value) == fmi2Error);
    CHECK(fmi2GetReal(c, inputs, 1, NULL) == fmi2Error);
    CHECK(fmi2SetReal(c, inputs, 1, NULL) == fmi2Error);
    CHECK(fmi2GetBoolean(c, inputs, 1, NULL) == fmi2Error);
    CHECK(fmi2GetDirectionalDerivative(c, outputs, 1, inputs, 1, NULL, &value) == fmi2Error);
    CHECK(fmi2GetDirectionalDerivative(c, outputs, 1, NULL, 0, NULL, &value) == fmi2OK && value == 0.0);
    CHECK(fmi2SetDebugLogging(c, fmi2True, 1, NULL) == fmi2Error);
    CHECK(fmi2GetFMUstate(c, NULL) == fmi2Error);
    CHECK(fmi2SetFMUstate(c, NULL) == fmi2Error);
    CHECK(fmi2FreeFMUstate(c, NULL) == fmi2OK);
    CHECK(fmi2FreeFMUstate(c, &state) == fmi2OK);
    CHECK(fmi2SerializedFMUstateSize(c, NULL, &size) == fmi2Error);
    CHECK(fmi2SerializeFMUstate(c, NULL, bytes, sizeof bytes) == fmi2Error);
    CHECK(fmi2DeSerializeFMUstate(c, NULL, 0, &state) == fmi2Error);
    CHECK(fmi2DeSerializeFMUstate(c, bytes, 0, &state) == fmi2Error && state == NULL);
    allocations_left = 0;
    CHECK(fmi2GetFMUstate(c, &state) == fmi2Error && state == NULL);
    allocations_left = -1;
    CHECK(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, NULL) == fmi2Error);
    CHECK(fmi2GetBooleanStatus(c, fmi2Terminated, NULL) == fmi2Error);
    CHECK(fmi2DoStep(NULL, 0.0, 1.0, fmi2True) == fmi2Error);
    CHECK(fmi2GetReal(NULL, inputs, 1, &value) == fmi2Error);
    CHECK(fmi2Reset(NULL) == fmi2Error);
    fmi2FreeInstance(c);
}

static void unsupported(void)
{
    fmi2Component c = started("unsupported");
    const int before = messages;
    fmi2Boolean flag = fmi2False;
    fmi2EventInfo info;
    fmi2Integer integer = 3;
    fmi2Status status;
    fmi2String text = "";
    double value = 0.0;
    CHECK(fmi2EnterEventMode(c) == fmi2Error);
    CHECK(fmi2NewDiscreteStates(c, &info) == fmi2Error);
    CHECK(fmi2EnterContinuousTimeMode(c) == fmi2Error);
    CHECK(fmi2CompletedIntegratorStep(c, fmi2True, &flag, &flag) == fmi2Error);
    CHECK(fmi2SetTime(c, 0.0) == fmi2Error);
    CHECK(fmi2SetContinuousStates(c, &value, 1) == fmi2Error);
    CHECK(fmi2GetDerivatives(c, &value, 1) == fmi2Error);
    CHECK(fmi2GetEventIndicators(c, &value, 1) == fmi2Error);
    CHECK(fmi2GetContinuousStates(c, &value, 1) == fmi2Error);
    CHECK(fmi2GetNominalsOfContinuousStates(c, &value, 1) == fmi2Error);
    CHECK(fmi2SetRealInputDerivatives(c, inputs, 1, &integer, &value) == fmi2Error);
    CHECK(fmi2GetRealOutputDerivatives(c, outputs, 1, &integer, &value) == fmi2Error);
    CHECK(fmi2CancelStep(c) == fmi2Error);
    CHECK(fmi2GetStatus(c, fmi2DoStepStatus, &status) == fmi2Error);
    CHECK(fmi2GetIntegerStatus(c, fmi2DoStepStatus, &integer) == fmi2Error);
    CHECK(fmi2GetStringStatus(c, fmi2PendingStatus, &text) == fmi2Error);
    CHECK(fmi2SetBoolean(c, inputs, 1, &flag) == fmi2Error);
    CHECK(fmi2SetInteger(c, inputs, 1, &integer) == fmi2Error);
    CHECK(fmi2SetString(c, inputs, 1, &text) == fmi2Error);
    CHECK(fmi2GetString(c, inputs, 1, &text) == fmi2Error);
    CHECK(fmi2GetInteger(c, inputs, 1, &integer) == fmi2Error);
    CHECK(fmi2DoStep(c, 1.0, 1e-3, fmi2True) == fmi2Error); /* the FMU's time is 0 */
    CHECK(messages == before + 22);
    CHECK(fmi2GetInteger(c, NULL, 0, NULL) == fmi2OK);
    CHECK(fmi2SetString(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2GetRealStatus(c, fmi2DoStepStatus, &value) == fmi2Discard);
    CHECK(fmi2GetBooleanStatus(c, fmi2Terminated, &flag) == fmi2OK && flag == fmi2False);
    CHECK(strcmp(fmi2GetVersion(), "2.0") == 0 && strcmp(fmi2GetTypesPlatform(), "default") == 0);
    CHECK(fmi2Terminate(c) == fmi2OK);
    fmi2FreeInstance(c);
}

/* Model exchange: the calls of one step, and those that are refused. */
static void exchange(void)
{
    fmi2Component c = fmi2Instantiate("me", fmi2ModelExchange, MODEL_TOKEN, NULL, &callbacks, fmi2False, fmi2True);
    double states[N_STATES + 1] = {0.0}, rates[N_STATES + 1] = {0.0}, indicator[1], force[3];
    fmi2Boolean flag, other;
    fmi2EventInfo info;
    fmi2FMUstate foreign = NULL;
    fmi2Component slave = started("slave");
    CHECK(c != NULL && fmi2SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK);
    CHECK(fmi2EnterInitializationMode(c) == fmi2OK && fmi2ExitInitializationMode(c) == fmi2OK);
    CHECK(fmi2NewDiscreteStates(c, NULL) == fmi2Error);
    CHECK(fmi2NewDiscreteStates(c, &info) == fmi2OK && info.newDiscreteStatesNeeded == fmi2False);
    CHECK(fmi2EnterContinuousTimeMode(c) == fmi2OK);
    CHECK(fmi2DoStep(c, 0.0, 1e-3, fmi2True) == fmi2Error);
    CHECK(fmi2SetTime(c, NAN) == fmi2Error && fmi2SetTime(c, 0.1) == fmi2OK);
    CHECK(fmi2SetContinuousStates(c, states, N_STATES + 1) == fmi2Error);
    CHECK(fmi2SetContinuousStates(c, states, N_STATES) == fmi2OK);
    CHECK(fmi2GetDerivatives(c, rates, N_STATES + 1) == fmi2Error);
    CHECK(fmi2GetDerivatives(c, rates, N_STATES) == fmi2OK);
    CHECK(fmi2GetNominalsOfContinuousStates(c, states, N_STATES) == fmi2OK);
    CHECK(fmi2GetContinuousStates(c, states, N_STATES) == fmi2OK);
    CHECK(fmi2GetEventIndicators(c, indicator, 2) == fmi2Error);
    CHECK(fmi2GetEventIndicators(c, indicator, 1) == fmi2OK && indicator[0] > 0.0);
    CHECK(fmi2GetReal(c, outputs, 3, force) == fmi2OK && force[0] > 0.0);
    CHECK(fmi2CompletedIntegratorStep(c, fmi2True, &flag, &other) == fmi2OK && !flag && !other);
    CHECK(fmi2EnterEventMode(c) == fmi2OK && fmi2EnterEventMode(c) == fmi2Error);
    CHECK(fmi2GetFMUstate(slave, &foreign) == fmi2OK && fmi2SetFMUstate(c, foreign) == fmi2Error);
    CHECK(fmi2FreeFMUstate(slave, &foreign) == fmi2OK);
    CHECK(fmi2Terminate(c) == fmi2OK);
    fmi2FreeInstance(slave);
    fmi2FreeInstance(c);
}

static void states(void)
{
    fmi2Component one = started("one"), two = started("two");
    fmi2FMUstate saved = NULL, copy = NULL;
    double before[3], other[3], after[3];
    double start[] = {0.0, 0.0};
    size_t size = 0;
    char *bytes;
    CHECK(fmi2GetReal(one, inputs, 2, start) == fmi2OK && start[0] > 0.0);
    CHECK(evaluate(one, start[0], start[1], before) == fmi2OK);
    CHECK(fmi2GetFMUstate(one, &saved) == fmi2OK);
    CHECK(fmi2SerializedFMUstateSize(one, saved, &size) == fmi2OK);
    bytes = (char *)malloc(size);
    CHECK(fmi2SerializeFMUstate(one, saved, bytes, size - 1) == fmi2Error);
    CHECK(fmi2SerializeFMUstate(one, saved, bytes, size) == fmi2OK);
    CHECK(evaluate(one, 2.0 * start[0], 0.0, other) == fmi2OK && other[0] != before[0]);
    CHECK(evaluate(one, NAN, 0.0, other) == fmi2Error);
    CHECK(evaluate(one, 1e210, -1e300, other) == fmi2Discard);
    CHECK(fmi2GetFMUstate(one, &copy) == fmi2OK); /* then into memory that is there already */
    CHECK(fmi2GetFMUstate(one, &copy) == fmi2OK);
    CHECK(fmi2SetFMUstate(one, saved) == fmi2OK);
    CHECK(fmi2GetReal(one, outputs, 3, after) == fmi2OK && memcmp(before, after, sizeof before) == 0);
    CHECK(fmi2DeSerializeFMUstate(two, bytes, size - 1, &copy) == fmi2Error);
    CHECK(fmi2FreeFMUstate(one, &copy) == fmi2OK && copy == NULL);
    CHECK(fmi2DeSerializeFMUstate(two, bytes, size, &copy) == fmi2OK);
    CHECK(fmi2SetFMUstate(two, copy) == fmi2OK);
    CHECK(fmi2GetReal(two, outputs, 3, after) == fmi2OK && memcmp(before, after, sizeof before) == 0);
    CHECK(fmi2FreeFMUstate(two, &copy) == fmi2OK);
    CHECK(fmi2FreeFMUstate(one, &saved) == fmi2OK);
    free(bytes);
    CHECK(fmi2Reset(one) == fmi2OK);
    fmi2FreeInstance(one);
    fmi2FreeInstance(two);
}

int main(void)
{
    fmi2Component c;
    double h, u, v, result[3];
    int n;
    refusals();
    null_arguments();
    unsupported();
    exchange();
    states();
    for (n = 0; n < 10000; n++) {
        fmi2FreeInstance(instantiate("again"));
    }
    c = started("grid");
    while (scanf("%lf %lf %lf", &h, &u, &v) == 3) {
        CHECK(step(c, h, u, v, result) == fmi2OK);
        printf("%.17g %.17g %.17g\n", result[0], result[1], result[2]);
    }
    fmi2FreeInstance(c);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
