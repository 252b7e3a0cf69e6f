/* Balls and films of a planar bearing in continuous time; see continuous_time.h. */
#include "contact_rates.h"
#include "continuous_time.h"

#include <stddef.h>

static const double two_pi = 6.283185307179586;

/* Contacts, cage and centrifugal force at one speed of the shaft. */
typedef struct {
    LawSpeed law;
    Dual transit[2], cage, centrifugal;
} SpeedState;

static SpeedState speed_state(const Setup *setup, Dual omega)
{
    SpeedState at;
    Dual u_sum;
    int race;
    at.law = law_speed(omega);
    u_sum = times(ROLLING_RADIUS, at.law.rolling);
    for (race = 0; race < 2; race++) {
        const double length_factor = setup->race[race].nodes > 0 ? setup->race[race].contact_length_factor : 0.0;
        at.transit[race] = u_sum.x > 0.0 ? over(number(length_factor), u_sum) : number(0.0);
    }
    at.cage = times(CAGE_RATIO, omega);
    at.centrifugal = times(CENTRIFUGAL_FACTOR, mul(at.cage, at.cage));
    return at;
}

/* Direction to a ball from the angle of the cage, how far the rings come closer there, and the rate of that. */
typedef struct {
    Dual x, y, delta, rate;
} AtBall;

static AtBall at_ball(const Setup *setup, const RingMotion *ring, Dual angle, Dual cage, int k)
{
    const double psi = angle.x + two_pi * k / BALLS;
    AtBall b;
    b.x = chained(cos(psi), -sin(psi), angle);
    b.y = chained(sin(psi), cos(psi), angle);
    b.delta = plus(add(mul(b.x, ring->q[0]), mul(b.y, ring->q[1])), -0.5 * setup->clearance);
    b.rate = add(mul(b.x, ring->v[0]), mul(b.y, ring->v[1]));
    b.rate = add(b.rate, mul(cage, sub(mul(b.x, ring->q[1]), mul(b.y, ring->q[0]))));
    return b;
}

void rest_place(const Setup *setup, const RingMotion *ring, Dual angle, int k, Dual place[PLACES])
{
    const SpeedState at = speed_state(setup, ring->omega);
    const Dual delta = at_ball(setup, ring, angle, number(0.0), k).delta;
    const Race *inner = &setup->race[INNER_RACE], *outer = &setup->race[OUTER_RACE];
    const double w = place[0].x;
    const Dual held_back = rest_force(outer, &at.law, NULL, number(w));
    const Dual off = sub(sub(held_back, rest_force(inner, &at.law, NULL, plus(delta, -w))), at.centrifugal);
    const double tangent = rest_force(outer, &at.law, NULL, dual(w, 1.0)).d
                           + rest_force(inner, &at.law, NULL, dual(delta.x - w, 1.0)).d;
    place[0].d = tangent > 0.0 ? -off.d / tangent : 0.0;
}

void own_states(const Ball *ball, double states[])
{
    states[0] = ball->place[0][0];
    if (HEAVY) {
        states[1] = ball->rate[0];
    }
}

/* ---- all balls ---- */

const char *bearing_rates(const Setup *setup, const RingMotion *ring, const Bearing *last, const Dual states[], Dual rates[],
                          BallLoads *out)
{
    const SpeedState at = speed_state(setup, ring->omega);
    const Race *inner_race = &setup->race[INNER_RACE], *outer_race = &setup->race[OUTER_RACE];
    const int wet = inner_race->nodes > 0;
    int k, j;
    out->force[0] = out->force[1] = number(0.0);
    rates[CAGE_ANGLE] = at.cage;
    for (k = 0; k < BALLS; k++) {
        const AtBall b = at_ball(setup, ring, states[CAGE_ANGLE], at.cage, k);
        const Dual *first = &states[FIRST_OF_BALLS + k * BALL_STATES], *second = first + OWN_STATES + FILM_STATES;
        Dual *first_rate = &rates[FIRST_OF_BALLS + k * BALL_STATES], *second_rate = first_rate + OWN_STATES + FILM_STATES;
        const int placed = HEAVY || wet;
        Dual w = placed ? first[0] : number(last->ball[k].place[0][0]), own = number(0.0), film[2];
        Held inner, outer;
        if (!placed) {
            rest_place(setup, ring, states[CAGE_ANGLE], k, &w);
        }
        inner = held(inner_race, &at.law, at.transit[INNER_RACE], NULL, sub(b.delta, w), first + OWN_STATES);
        outer = held(outer_race, &at.law, at.transit[OUTER_RACE], NULL, w, second);
        if (HEAVY) {
            own = first[1];
        } else if (wet && last->h > 0.0) {
            own = number(last->ball[k].rate[0]);
        } else if (wet && !balance(&inner, &outer, b.rate, at.centrifugal, &own)) {
            return "a ball finds no balance: a smaller displacement can help";
        }
        film[INNER_RACE] = squeezed(&inner, sub(b.rate, own));
        film[OUTER_RACE] = squeezed(&outer, own);
        out->load[k][INNER_RACE] = pushed(inner.kn, film[INNER_RACE]);
        out->load[k][OUTER_RACE] = pushed(outer.kn, film[OUTER_RACE]);
        out->film[k][INNER_RACE] = film[INNER_RACE].x;
        out->film[k][OUTER_RACE] = film[OUTER_RACE].x;
        out->force[0] = add(out->force[0], mul(out->load[k][INNER_RACE], b.x));
        out->force[1] = add(out->force[1], mul(out->load[k][INNER_RACE], b.y));
        for (j = 0; j < BALL_STATES; j++) {
            first_rate[j] = number(0.0);
        }
        if (placed) {
            first_rate[0] = own;
        }
        if (HEAVY) {
            const Dual net = sub(add(out->load[k][INNER_RACE], at.centrifugal), out->load[k][OUTER_RACE]);
            first_rate[1] = over(net, number(BALL_INERTIA));
        }
        if (wet) {
            film_state_rates(inner_race, &inner, sub(b.rate, own), first + OWN_STATES, first_rate + OWN_STATES);
            film_state_rates(outer_race, &outer, own, second, second_rate);
        }
    }
    return NULL;
}
