/* Balls of a planar bearing: reduced_models.bearing.balls. Names and order of the arithmetic are those of the Python file. */
#include <math.h>
#include <string.h>

#include "balls.h"

enum { MOST_BALL_STEPS = 60, HALVES_FROM = 20 }; /* from the second on, every other step halves the bracket */
static const double one_turn = 6.283185307179586;
static const double nearly = 1e-7;     /* imbalance of a ball, over its forces and 1 N, that one more step ends */
static const double first_step = 1e-7; /* m, to a ball that nothing touches; doubled until a race is met */
static const double farthest = 1e-5;   /* m, of Newton's first step, twice as far in each that follows: see the Python file */

static void press(const BallStep *step, double delta, double rate, double w, RaceForce *inner, RaceForce *outer)
{
    const double v = step->gain * (w - step->history);
    *inner = race_force(&step->contact[INNER_RACE], delta - w, rate - v);
    *outer = race_force(&step->contact[OUTER_RACE], w, v);
}

/* A ball that has been balanced: its forces, and what they change by with delta and its rate. */
static void balanced(BallStep *step, double delta, double rate, double w, const RaceForce *inner, const RaceForce *outer,
                     Ball *ball)
{
    const double held = outer->stiffness + step->gain * outer->damping + BALL_INERTIA * step->gain * step->gain;
    const double tangent = inner->stiffness + step->gain * inner->damping + held, share = tangent > 0.0 ? held / tangent : 0.0;
    step->place[0] = w;
    step->tried[0] = delta;
    step->tried[1] = rate;
    step->slope[0] = share * inner->stiffness;
    step->slope[1] = share * inner->damping;
    ball->force[INNER_RACE] = inner->force;
    ball->force[OUTER_RACE] = outer->force;
    ball->film[INNER_RACE] = inner->film;
    ball->film[OUTER_RACE] = outer->film;
}

/* Balances a ball whose rings come closer by delta, at a rate. Returns whether there is a balance. */
static int balance_ball(BallStep *step, double delta, double rate, Ball *ball)
{
    const double gain = step->gain, heavy = BALL_INERTIA * gain;
    double low = -HUGE_VAL, high = HUGE_VAL, reach = first_step, most = farthest;
    double w = step->start[0];
    RaceForce inner, outer;
    int i;
    for (i = 0; i < MOST_BALL_STEPS; i++) {
        double off, tangent;
        press(step, delta, rate, w, &inner, &outer);
        off = outer.force + heavy * (gain * (w - step->history) - step->rate_history) - inner.force - step->centrifugal;
        tangent = inner.stiffness + gain * inner.damping + outer.stiffness + gain * outer.damping + heavy * gain;
        if (!isfinite(off)) {
            return 0;
        }
        if (fabs(off) <= nearly * (1.0 + outer.force + inner.force + step->centrifugal)) {
            if (tangent > 0.0) {
                w -= off / tangent;
                press(step, delta, rate, w, &inner, &outer);
            }
            balanced(step, delta, rate, w, &inner, &outer, ball);
            return 1;
        }
        if (off > 0.0) {
            high = w;
        } else {
            low = w;
        }
        if (tangent > 0.0) {
            w -= copysign(fmin(fabs(off) / tangent, most), off);
        } else {
            w -= copysign(reach, off);
            reach *= 2.0;
        }
        most *= 2.0;
        if (low > -HUGE_VAL && high < HUGE_VAL && (!(low < w && w < high) || (i >= HALVES_FROM && i % 2 == 0))) {
            w = 0.5 * (low + high);
        }
    }
    return 0;
}

static void begin_ball(const Setup *setup, const Bearing *before, int k, double h, SpeedRow at, double u_sum, BallStep *step)
{
    const Ball *old = &before->ball[k];
    int race;
    for (race = 0; race < 2; race++) {
        RaceStep *c = &step->contact[race];
        c->race = &setup->race[race];
        c->at = at;
        c->transit = u_sum > 0.0 ? c->race->contact_length_factor / u_sum : 0.0;
        c->film = NULL;
        c->before = &before->film[k][race];
        c->filters = &step->filters[race];
        c->filters->interval = 0;
        race_at_rest(c->filters);
        if (h > 0.0) {
            race_prepare(c, h);
        }
    }
    place_ahead(old, h, before->h, step->start);
}

void balls_unmoved(Bearing *bearing)
{
    memset(bearing->ball, 0, sizeof bearing->ball);
}

void balls_begin(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, BallsStep *step)
{
    const double u_sum = ROLLING_RADIUS * film_speed(omega), shaft_cage = CAGE_RATIO * omega;
    const SpeedRow at = speed_row(omega);
    Differences d = {0.0, 0.0, 0.0};
    int k;
    *after = *before;
    after->angle += 0.5 * h * (before->omega + omega) * CAGE_RATIO;
    after->omega = omega;
    after->h = h;
    if (h > 0.0) {
        d = differences(h, before->h);
    }
    step->setup = setup;
    step->cage = h > 0.0 ? shaft_cage : 0.0;
    for (k = 0; k < BALLS; k++) {
        const double psi = after->angle + one_turn * k / BALLS;
        const Ball *old = &before->ball[k];
        BallStep *ball = &step->ball[k];
        ball->x = cos(psi);
        ball->y = sin(psi);
        ball->gain = d.gain;
        ball->history = d.now * old->place[0][0] - d.before * old->place[1][0];
        ball->rate_history = d.now * old->rate[0] - d.before * old->rate[1];
        ball->centrifugal = CENTRIFUGAL_FACTOR * shaft_cage * shaft_cage;
        begin_ball(setup, before, k, h, at, u_sum, ball);
    }
}

const char *balls_press(BallsStep *step, Bearing *after, const double q[], const double v[], double force[])
{
    int k;
    force[0] = force[1] = 0.0;
    for (k = 0; k < BALLS; k++) {
        const double x = step->ball[k].x, y = step->ball[k].y;
        const double delta = x * q[0] + y * q[1] - 0.5 * step->setup->clearance;
        const double rate = x * v[0] + y * v[1] + step->cage * (x * q[1] - y * q[0]);
        if (!balance_ball(&step->ball[k], delta, rate, &after->ball[k])) {
            return "a ball finds no balance: a shorter step, or a smaller displacement, can help";
        }
        force[0] += after->ball[k].force[INNER_RACE] * x;
        force[1] += after->ball[k].force[INNER_RACE] * y;
    }
    return NULL;
}

void balls_slopes(const BallsStep *step, RingSlopes *slopes)
{
    int k, i, j;
    memset(slopes, 0, sizeof *slopes);
    for (k = 0; k < BALLS; k++) {
        const BallStep *ball = &step->ball[k];
        const double n[2] = {ball->x, ball->y}, swept[2] = {-step->cage * ball->y, step->cage * ball->x};
        for (i = 0; i < 2; i++) {
            for (j = 0; j < 2; j++) {
                slopes->stiffness[i][j] += n[i] * (ball->slope[0] * n[j] + ball->slope[1] * swept[j]);
                slopes->damping[i][j] += n[i] * ball->slope[1] * n[j];
            }
        }
    }
}

void balls_accept(const BallsStep *step, const Bearing *before, Bearing *after)
{
    const int moving = after->h > 0.0;
    int k;
    for (k = 0; k < BALLS; k++) {
        const BallStep *step_of = &step->ball[k];
        const Ball *old = &before->ball[k];
        const double w = step_of->place[0], delta = step_of->tried[0], rate = step_of->tried[1];
        const double own = moving ? step_of->gain * (w - step_of->history) : 0.0;
        Ball *ball = &after->ball[k];
        FilmState *film = after->film[k];
        ball->place[1][0] = moving ? old->place[0][0] : w;
        ball->place[0][0] = w;
        ball->rate[1] = moving ? old->rate[0] : 0.0;
        ball->rate[0] = own;
        if (moving) {
            race_accept(&step_of->contact[INNER_RACE], delta - w, rate - own, &film[INNER_RACE]);
            race_accept(&step_of->contact[OUTER_RACE], w, own, &film[OUTER_RACE]);
        } else {
            memset(after->film[k], 0, sizeof after->film[k]);
            film[INNER_RACE].approach = delta - w;
            film[OUTER_RACE].approach = w;
        }
    }
}

static const char *press_all(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega,
                             const double q[], const double v[], double force[])
{
    BallsStep step;
    const char *reason;
    balls_begin(setup, before, after, h, omega, &step);
    reason = balls_press(&step, after, q, v, force);
    if (reason == NULL) {
        balls_accept(&step, before, after);
    }
    return reason;
}

const char *balls_step(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, const double q[],
                       const double v[], double force[])
{
    return press_all(setup, before, after, h, omega, q, v, force);
}

const char *balls_rest(const Setup *setup, Bearing *bearing, double omega, const double q[], double force[])
{
    static const double still[FREEDOMS] = {0.0};
    const Bearing before = *bearing;
    const char *reason = press_all(setup, &before, bearing, 0.0, omega, q, still, force);
    bearing->cage[0] = bearing->cage[1] = CAGE_RATIO;
    return reason;
}
