/* The end of a bearing inside a rotor: model_bearing.c before it in the same file, by the face of bearing_law.h. LAW is its
 * name, law_values are the start values of its variables, law_parameters and law_outputs the references of those that the rotor
 * has, LAW_SIZE and LAW_WORK its numbers. */
#include "bearing_law.h"

/* A step from its start to its end. */
typedef struct {
    Setup setup;
    Bearing before, after;
    BallsStep step;
    double force[FREEDOMS], lift; /* with the losses of rings and fits, and its slope by that of the balls */
    double offset;                /* of the ring along the shaft */
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

static const char *law_start(double numbers[], const double parameters[])
{
    Model *m = law_model(numbers);
    Bearing bearing;
    size_t i;
    memset(m, 0, sizeof *m);
    memcpy(m->value, law_values, sizeof m->value);
    for (i = 0; i < sizeof law_parameters / sizeof law_parameters[0]; i++) {
        m->value[law_parameters[i]] = parameters[i];
    }
    memset(&bearing, 0, sizeof bearing);
    balls_unmoved(&bearing);
    bearing.angle = m->value[VR_cage_angle_start];
    memcpy(m->cache, &bearing, sizeof bearing);
    return model_prepare(m).reason;
}

static void law_begin(const double numbers[], double work[], double h, double omega)
{
    const Model *m = law_shown(numbers);
    LawStep *s = law_step_of(work);
    s->setup = setup_of(m->value);
#if FREEDOMS == 5
    s->offset = m->value[VR_offset];
#else
    s->offset = 0.0;
#endif
    memcpy(&s->before, m->cache, sizeof s->before);
    balls_begin(&s->setup, &s->before, &s->after, h, omega, &s->step);
}

/* Place of the ring against the balls. */
static void law_place(const LawStep *s, const double ring[], double q[])
{
    memcpy(q, ring, FREEDOMS * sizeof q[0]);
    if (FREEDOMS > 2) {
        q[FREEDOMS / 2] += s->offset;
    }
}

static const char *law_press(double work[], const double ring[], const double v[], double force[])
{
    LawStep *s = law_step_of(work);
    double q[FREEDOMS];
    const char *reason;
    law_place(s, ring, q);
    reason = balls_press(&s->step, &s->after, q, v, s->force);
    if (reason == NULL) {
        reason = check_forces(s->force);
    }
    if (reason == NULL) {
        s->lift = pass_seat(&s->before, &s->after, s->after.h, s->force);
        memcpy(force, s->force, sizeof s->force);
    }
    return reason;
}

static void law_slopes(const double work[], double stiffness[], double damping[])
{
    const LawStep *s = (const LawStep *)(const void *)work;
    RingSlopes slopes;
    int i, j;
    balls_slopes(&s->step, &slopes);
    for (i = 0; i < FREEDOMS; i++) {
        for (j = 0; j < FREEDOMS; j++) {
            stiffness[i * FREEDOMS + j] = s->lift * slopes.stiffness[i][j];
            damping[i * FREEDOMS + j] = s->lift * slopes.damping[i][j];
        }
    }
}

static const char *law_accept(double numbers[], double work[], const double ring[])
{
    LawStep *s = law_step_of(work);
    double q[FREEDOMS];
    const char *reason;
    law_place(s, ring, q);
    reason = check(q, s->after.omega);
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
const BearingLaw LAW = {LAW_SETTLED, law_start, law_begin, law_press, law_slopes, law_accept, law_show, law_torque};
