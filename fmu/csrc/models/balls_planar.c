/* Balls of a planar bearing: reduced_models.bearing.balls. Names and order of the arithmetic are those of the Python file. */
#include <math.h>
#include <string.h>

#include "balls.h"

enum { MOST_STEPS = 60 };
static const double two_pi = 6.283185307179586;
static const double nearly = 1e-7;     /* imbalance of a ball, over its forces and 1 N, that one more step ends */
static const double first_step = 1e-7; /* m, to a ball that nothing touches; doubled until a race is met */

/* One ball in a step: its contacts, what its rates follow from, what presses it outward. */
typedef struct {
    RaceStep contact[2];
    double gain, history, rate_history, centrifugal;
} BallStep;

static void press(const BallStep *step, double delta, double rate, double w, RaceForce *inner, RaceForce *outer)
{
    const double v = step->gain * (w - step->history);
    *inner = race_force(&step->contact[INNER_RACE], delta - w, rate - v);
    *outer = race_force(&step->contact[OUTER_RACE], w, v);
}

/* Balances a ball whose rings come closer by delta, at a rate; w is its place. Returns whether there is a balance. */
static int balance(const BallStep *step, double delta, double rate, double *w, Ball *ball)
{
    const double gain = step->gain, heavy = BALL_INERTIA * gain;
    double low = -HUGE_VAL, high = HUGE_VAL, reach = first_step;
    RaceForce inner, outer;
    int i;
    for (i = 0; i < MOST_STEPS; i++) {
        double off, tangent;
        press(step, delta, rate, *w, &inner, &outer);
        off = outer.force + heavy * (gain * (*w - step->history) - step->rate_history) - inner.force - step->centrifugal;
        tangent = inner.stiffness + gain * inner.damping + outer.stiffness + gain * outer.damping + heavy * gain;
        if (!isfinite(off)) {
            return 0;
        }
        if (fabs(off) <= nearly * (1.0 + outer.force + inner.force + step->centrifugal)) {
            if (tangent > 0.0) {
                *w -= off / tangent;
                press(step, delta, rate, *w, &inner, &outer);
            }
            ball->force[INNER_RACE] = inner.force;
            ball->force[OUTER_RACE] = outer.force;
            ball->film[INNER_RACE] = inner.film;
            ball->film[OUTER_RACE] = outer.film;
            return 1;
        }
        if (off > 0.0) {
            high = *w;
        } else {
            low = *w;
        }
        if (tangent > 0.0) {
            *w -= off / tangent;
        } else {
            *w -= copysign(reach, off);
            reach *= 2.0;
        }
        if (low > -HUGE_VAL && high < HUGE_VAL && !(low < *w && *w < high)) {
            *w = 0.5 * (low + high);
        }
    }
    return 0;
}

/* All balls with the ring at q, moving at v. */
static const char *press_all(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega,
                             const double q[], const double v[], double force[])
{
    const int moving = h > 0.0;
    const double u_sum = ROLLING_RADIUS * film_speed(omega), shaft_cage = CAGE_RATIO * omega, cage = moving ? shaft_cage : 0.0;
    const SpeedRow at = speed_row(omega);
    Differences d = {0.0, 0.0, 0.0};
    int k, race;
    if (moving) {
        d = differences(h, before->h);
    }
    force[0] = force[1] = 0.0;
    for (k = 0; k < BALLS; k++) {
        const double psi = after->angle + two_pi * k / BALLS, x = cos(psi), y = sin(psi);
        const double delta = x * q[0] + y * q[1] - 0.5 * setup->clearance;
        const double rate = x * v[0] + y * v[1] + cage * (x * q[1] - y * q[0]);
        const Ball *old = &before->ball[k];
        Ball *ball = &after->ball[k];
        StepFilters filters[2];
        BallStep step;
        double w = old->place[0][0], own;
        step.gain = d.gain;
        step.history = d.now * old->place[0][0] - d.before * old->place[1][0];
        step.rate_history = d.now * old->rate[0] - d.before * old->rate[1];
        step.centrifugal = BALL_SWING * shaft_cage * shaft_cage;
        for (race = 0; race < 2; race++) {
            RaceStep *c = &step.contact[race];
            c->race = &setup->race[race];
            c->at = at;
            c->transit = u_sum > 0.0 ? c->race->reach / u_sum : 0.0;
            c->film = NULL;
            c->before = &before->film[k][race];
            c->filters = &filters[race];
            filters[race].interval = 0;
            race_at_rest(c->filters);
            if (moving) {
                race_prepare(c, h);
            }
        }
        if (!balance(&step, delta, rate, &w, ball)) {
            return "a ball finds no balance: a shorter step, or a smaller displacement, can help";
        }
        own = moving ? d.gain * (w - step.history) : 0.0;
        ball->place[1][0] = moving ? old->place[0][0] : w;
        ball->place[0][0] = w;
        ball->rate[1] = moving ? old->rate[0] : 0.0;
        ball->rate[0] = own;
        if (moving) {
            race_accept(&step.contact[INNER_RACE], delta - w, rate - own, &after->film[k][INNER_RACE]);
            race_accept(&step.contact[OUTER_RACE], w, own, &after->film[k][OUTER_RACE]);
        } else {
            memset(after->film[k], 0, sizeof after->film[k]);
            after->film[k][INNER_RACE].approach = delta - w;
            after->film[k][OUTER_RACE].approach = w;
        }
        force[0] += ball->force[INNER_RACE] * x;
        force[1] += ball->force[INNER_RACE] * y;
    }
    return NULL;
}

const char *balls_step(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, const double q[],
                       const double v[], double force[])
{
    *after = *before;
    after->angle += 0.5 * h * (before->omega + omega) * CAGE_RATIO;
    after->omega = omega;
    after->h = h;
    return press_all(setup, before, after, h, omega, q, v, force);
}

const char *balls_rest(const Setup *setup, Bearing *bearing, double omega, const double q[], double force[])
{
    static const double still[FREEDOMS] = {0.0};
    const Bearing before = *bearing;
    bearing->omega = omega;
    bearing->h = 0.0;
    bearing->cage[0] = bearing->cage[1] = CAGE_RATIO;
    return press_all(setup, &before, bearing, 0.0, omega, q, still, force);
}
