/* The end of a contact law inside a rotor: the model before it in the same file, by the face of contact_law.h.
 * LAW is its name, law_values are the start values of its variables, LAW_SIZE its numbers. */
#include "contact_law.h"

typedef char law_is_numbers[sizeof(Model) == LAW_SIZE * sizeof(double) ? 1 : -1];

static Model *law_model(double numbers[])
{
    return (Model *)(void *)numbers;
}

static const char *law_start(double numbers[])
{
    Model *m = law_model(numbers);
    memset(m, 0, sizeof *m);
    memcpy(m->value, law_values, sizeof m->value);
    return model_prepare(m).reason;
}

static void law_found(const Model *m, int stiffness, int damping, ContactForce *found)
{
    found->force = m->value[VR_force];
    found->stiffness = m->value[stiffness];
    found->damping = m->value[damping];
    found->indicator = m->indicator[0];
    found->outside = m->value[VR_outside_validity] > 0.0;
}

static const char *law_evaluate(double numbers[], const double film[], double approach, double rate, ContactForce *found)
{
    Model *m = law_model(numbers);
    Fault fault;
    m->input[VR_approach] = approach;
    m->input[VR_rate] = rate;
    memcpy(&m->value[FIRST_STATE], film, N_STATES * sizeof film[0]);
    fault = model_evaluate(m);
    if (fault.severity == FINE) {
        law_found(m, VR_stiffness, VR_damping, found);
    }
    return fault.reason;
}

static const char *law_step(double numbers[], const double before[], double after[], const ContactMotion *motion, double h,
                            ContactForce *found)
{
    Model *m = law_model(numbers);
    Motion along;
    Fault fault;
    memset(&along, 0, sizeof along);
    along.input[VR_approach].start = motion->start_approach;
    along.input[VR_approach].end = motion->end_approach;
    along.input[VR_rate].start = motion->start_rate;
    along.input[VR_rate].end = motion->end_rate;
    memcpy(&m->value[FIRST_STATE], before, N_STATES * sizeof before[0]);
    fault = model_step(m, &along, h, DEFAULT_TOLERANCE);
    if (fault.severity == FINE) {
        memcpy(after, &m->value[FIRST_STATE], N_STATES * sizeof after[0]);
        law_found(m, LAW_STIFFNESS, LAW_DAMPING, found);
    }
    return fault.reason;
}

static const char *law_rates(double numbers[], double rates[])
{
    Model *m = law_model(numbers);
    const Fault fault = model_rates(m);
    memcpy(rates, &m->value[FIRST_DERIVATIVE], N_STATES * sizeof rates[0]);
    return fault.reason;
}

static double law_direction(const double numbers[], double approach, double rate, const double film[], double rates[])
{
    double seed[N_VARIABLES] = {0.0}, along[N_VARIABLES] = {0.0};
    seed[VR_approach] = approach;
    seed[VR_rate] = rate;
    memcpy(&seed[FIRST_STATE], film, N_STATES * sizeof film[0]);
    model_direction((const Model *)(const void *)numbers, seed, along);
    memcpy(rates, &along[FIRST_DERIVATIVE], N_STATES * sizeof rates[0]);
    return along[VR_force];
}

extern const ContactLaw LAW;
const ContactLaw LAW = {LAW_SIZE, N_STATES, law_start, law_evaluate, law_step, law_rates, law_direction};
