/* The end of a contact inside a rotor: its model before it in the same file, by the face of support.h, its numbers being those
 * of the model. LAW is its name, law_values are the start values of its variables, LAW_SIZE its numbers. */
#include "support.h"

typedef char law_is_numbers[sizeof(Model) == LAW_SIZE * sizeof(double) ? 1 : -1];

/* Work of a step: its length, force, slopes, and the numbers at its end. */
enum { STEP_LENGTH, STEP_FORCE, STEP_STIFFNESS, STEP_DAMPING, STEP_NUMBERS };

static Model *law_model(double numbers[])
{
    return (Model *)(void *)numbers;
}

static const Model *law_shown(const double numbers[])
{
    return (const Model *)(const void *)numbers;
}

static const char *law_start(const void *own, const double parameters[], double numbers[])
{
    Model *m = law_model(numbers);
    (void)own, (void)parameters;
    memset(m, 0, sizeof *m);
    memcpy(m->value, law_values, sizeof m->value);
    return model_prepare(m).reason;
}

static void law_found(const Model *m, int stiffness, int damping, double work[], double force[])
{
    force[0] = work[STEP_FORCE] = m->value[VR_force];
    work[STEP_STIFFNESS] = m->value[stiffness];
    work[STEP_DAMPING] = m->value[damping];
}

static const char *law_rest(const void *own, double numbers[], double work[], double omega, const double q[], const double v[],
                            double force[])
{
    Model *m = law_model(numbers);
    Fault fault;
    (void)own, (void)omega;
    m->input[VR_approach] = q[0];
    m->input[VR_rate] = v[0];
    fault = model_evaluate(m);
    law_found(m, VR_stiffness, VR_damping, work, force);
    return fault.reason;
}

static void law_begin(const void *own, const double numbers[], double work[], double h, double omega)
{
    (void)own, (void)numbers, (void)omega;
    work[STEP_LENGTH] = h;
}

static const char *law_press(const void *own, const double numbers[], double work[], const double q[], const double v[],
                             double force[])
{
    const Model *before = law_shown(numbers);
    Model *m = law_model(&work[STEP_NUMBERS]);
    Motion along;
    Fault fault;
    (void)own;
    memset(&along, 0, sizeof along);
    along.input[VR_approach].start = before->input[VR_approach];
    along.input[VR_approach].end = q[0];
    along.input[VR_rate].start = before->input[VR_rate];
    along.input[VR_rate].end = v[0];
    memcpy(m, before, sizeof *m);
    fault = model_step(m, &along, work[STEP_LENGTH], DEFAULT_TOLERANCE);
    law_found(m, LAW_STIFFNESS, LAW_DAMPING, work, force);
    return fault.reason;
}

static void law_slopes(const void *own, const double work[], double stiffness[], double damping[])
{
    (void)own;
    stiffness[0] = work[STEP_STIFFNESS];
    damping[0] = work[STEP_DAMPING];
}

static const char *law_accept(const void *own, double numbers[], double work[])
{
    (void)own;
    memcpy(numbers, &work[STEP_NUMBERS], sizeof(Model));
    return NULL;
}

static double law_torque(const void *own, const double numbers[], const double outputs[])
{
    (void)own, (void)numbers, (void)outputs;
    return 0.0;
}

static void law_show(const void *own, const double numbers[], double outputs[], double states[], double indicators[])
{
    const Model *m = law_shown(numbers);
    (void)own;
    outputs[0] = m->value[VR_force];
    outputs[1] = m->value[VR_outside_validity];
    memcpy(states, &m->value[FIRST_STATE], N_STATES * sizeof states[0]);
    if (indicators != NULL) {
        indicators[0] = m->indicator[0];
    }
}

static const char *law_evaluate(const void *own, double numbers[], double work[], const SupportMotion *motion,
                                const double states[], double outputs[], double indicators[], double force[], double rates[])
{
    Model *m = law_model(numbers);
    Fault fault;
    (void)own, (void)work;
    m->input[VR_approach] = motion->q[0];
    m->input[VR_rate] = motion->v[0];
    memcpy(&m->value[FIRST_STATE], states, N_STATES * sizeof states[0]);
    fault = model_evaluate(m);
    if (fault.severity == FINE) {
        fault = model_rates(m);
    }
    force[0] = outputs[0] = m->value[VR_force];
    outputs[1] = m->value[VR_outside_validity];
    indicators[0] = m->indicator[0];
    memcpy(rates, &m->value[FIRST_DERIVATIVE], N_STATES * sizeof rates[0]);
    return fault.reason;
}

static void law_along(const void *own, const double numbers[], double work[], const SupportMotion *motion, const double states[],
                      const SupportMotion *change, const double changes[], double outputs[], double force[], double rates[])
{
    double seed[N_VARIABLES] = {0.0}, along[N_VARIABLES] = {0.0};
    (void)own, (void)work, (void)motion, (void)states;
    seed[VR_approach] = change->q[0];
    seed[VR_rate] = change->v[0];
    memcpy(&seed[FIRST_STATE], changes, N_STATES * sizeof changes[0]);
    model_direction(law_shown(numbers), seed, along);
    memcpy(rates, &along[FIRST_DERIVATIVE], N_STATES * sizeof rates[0]);
    force[0] = outputs[0] = along[VR_force];
}

extern const Support LAW;
const Support LAW = {NULL,      1,         N_STATES,  N_CONTACTS, LAW_SIZE,   STEP_NUMBERS + LAW_SIZE, law_start,   law_rest,
                     law_begin, law_press, law_slopes, law_accept, law_torque, law_show,                law_evaluate, law_along};
