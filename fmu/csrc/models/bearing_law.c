/* The end of a bearing inside a rotor: model_bearing.c before it in the same file, by the face of bearing_law.h. LAW is its
 * name, law_values are the start values of its variables, law_outputs its outputs, LAW_SIZE and LAW_WORK its numbers. */
#include "bearing_law.h"

/* A step from its start to its end. */
typedef struct {
    Setup setup;
    Bearing before, after;
    BallsStep step;
    double force[FREEDOMS];
} LawStep;

typedef char law_is_numbers[sizeof(Model) == LAW_SIZE * sizeof(double) ? 1 : -1];
typedef char law_step_fits[sizeof(LawStep) <= LAW_WORK * sizeof(double) ? 1 : -1];

static Model *law_model(double numbers[])
{
    return (Model *)(void *)numbers;
}

static const Model *law_shown(const double numbers[])
{
    return (const Model *)(const void *)numbers;
}

static LawStep *law_step_of(double work[])
{
    return (LawStep *)(void *)work;
}

static const char *law_start(double numbers[], const BearingParameters *parameters)
{
    Model *m = law_model(numbers);
    Bearing bearing;
    memset(m, 0, sizeof *m);
    memset(&bearing, 0, sizeof bearing);
    memcpy(m->value, law_values, sizeof m->value);
    m->value[VR_clearance] = parameters->clearance;
    m->value[VR_film] = parameters->film;
    bearing.angle = parameters->cage_angle;
    memcpy(m->cache, &bearing, sizeof bearing);
    return model_prepare(m).reason;
}

static void law_begin(const double numbers[], double work[], double h, double omega)
{
    const Model *m = law_shown(numbers);
    LawStep *s = law_step_of(work);
    int k;
    s->setup = setup_of(m->value);
    memcpy(&s->before, m->cache, sizeof s->before);
    balls_begin(&s->setup, &s->before, &s->after, h, omega, &s->step);
    for (k = 0; k < BALLS; k++) { /* where a ball is looked for first */
        const Ball *old = &s->before.ball[k];
        s->step.ball[k].place = 2.0 * old->place[0][0] - old->place[1][0];
    }
}

static const char *law_press(double work[], const double q[], const double v[], double force[], double stiffness[],
                             double damping[])
{
    LawStep *s = law_step_of(work);
    RingForce ring;
    const char *reason = balls_press(&s->step, &s->after, q, v, &ring);
    double lift;
    int i, j;
    if (reason == NULL) {
        reason = check_forces(ring.force);
    }
    if (reason != NULL) {
        return reason;
    }
    memcpy(s->force, ring.force, sizeof s->force);
    lift = pass_seat(&s->before, &s->after, s->after.h, s->force);
    for (i = 0; i < FREEDOMS; i++) {
        force[i] = s->force[i];
        for (j = 0; j < FREEDOMS; j++) {
            stiffness[i * FREEDOMS + j] = lift * ring.stiffness[i][j];
            damping[i * FREEDOMS + j] = lift * ring.damping[i][j];
        }
    }
    return NULL;
}

static const char *law_accept(double numbers[], double work[], const double q[])
{
    LawStep *s = law_step_of(work);
    const char *reason = check(q, s->after.omega);
    if (reason == NULL) {
        balls_accept(&s->step, &s->before, &s->after);
        show_step(law_model(numbers), &s->after, s->force);
    }
    return reason;
}

static void law_show(const double numbers[], double outputs[])
{
    const Model *m = law_shown(numbers);
    size_t i;
    for (i = 0; i < sizeof law_outputs / sizeof law_outputs[0]; i++) {
        outputs[i] = m->value[law_outputs[i]];
    }
}

static double law_torque(const double numbers[])
{
#if HAS_FILMS
    return law_shown(numbers)->value[VR_rolling_torque];
#else
    (void)numbers;
    return 0.0;
#endif
}

extern const BearingLaw LAW;
const BearingLaw LAW = {LAW_SIZE,  LAW_WORK,   (int)(sizeof law_outputs / sizeof law_outputs[0]),
                        law_start, law_begin,  law_press,
                        law_accept, law_show, law_torque};
