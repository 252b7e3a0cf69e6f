/* Balls and films of a planar bearing in continuous time; see continuous_time.h. Names and order of the arithmetic are those
 * of the Python file; every number has its change along one direction with it. */
#include "continuous_time.h"

#include <stddef.h>

enum { MOST_STEPS = 60 };
static const double small_step = 1e-14; /* of the rates, that ends the search for w': rounding */
static const double two_pi = 6.283185307179586;

/* Contacts, cage and centrifugal force at one speed of the shaft. */
typedef struct {
    int row;
    Dual weight, transit[2], cage, centrifugal;
} SpeedState;

static SpeedState speed_state(const Setup *setup, Dual omega)
{
    const SpeedRow row = speed_row(omega.x);
    const double rolling = film_speed(omega.x);
    const Dual u_sum = dual(ROLLING_RADIUS * rolling, rolling == omega.x ? ROLLING_RADIUS * omega.d : 0.0);
    SpeedState at;
    int race;
    at.row = row.row;
    at.weight = chained(row.weight, row.slope, omega);
    for (race = 0; race < 2; race++) {
        const double reach = setup->race[race].nodes > 0 ? setup->race[race].reach : 0.0;
        at.transit[race] = u_sum.x > 0.0 ? over(number(reach), u_sum) : number(0.0);
    }
    at.cage = times(CAGE_RATIO, omega);
    at.centrifugal = times(BALL_SWING, mul(at.cage, at.cage));
    return at;
}

/* ---- one contact ---- */

/* An entry of a table between two rows of speeds, which are `stride` entries apart. */
static Dual of_rows(const double *entry, const SpeedState *at, int stride)
{
    const double more = at->weight.x > 0.0 ? entry[stride] - *entry : 0.0;
    return dual(*entry + at->weight.x * more, at->weight.d * more);
}

/* The same between two nodes of the load, `stride` entries apart. */
static Dual of_nodes(const double *entry, const SpeedState *at, int rows, int stride, Dual weight)
{
    const Dual low = of_rows(entry, at, rows), high = of_rows(entry + stride, at, rows);
    return add(low, mul(weight, sub(high, low)));
}

static Dual curve(const Race *race, const SpeedState *at, Dual u, int *k)
{
    double slope;
    Dual g;
    if (race->nodes == 0) { /* below zero, it says how far the surfaces have parted */
        return u;
    }
    g.x = race_curve(race, at->row, u.x, k, &slope);
    g.d = slope * u.d;
    if (at->weight.x > 0.0) {
        int next = *k;
        Dual more;
        more.x = race_curve(race, at->row + 1, u.x, &next, &slope);
        more.d = slope * u.d;
        more = sub(more, g);
        g = add(g, mul(at->weight, more));
    }
    return g;
}

/* Film without its dashpot [m], dashpot c tau [s], k_n that the film carries, own time [s], film G made. */
typedef struct {
    Dual film, dashpot, kn, tau, made;
} Held;

static Held held(const Race *race, const SpeedState *at, Dual transit, Dual u, const Dual states[])
{
    const int gain_rows = race->nodes * RACE_GAINS, last = race->nodes - 2;
    Held h;
    Dual g, x, weight, carried = number(0.0);
    int row = 0, j;
    g = curve(race, at, u, &row);
    h.film = g;
    h.dashpot = h.tau = number(0.0);
    h.kn = number(race->kn);
    h.made = number(1.0);
    if (race->nodes == 0) {
        return h;
    }
    h.tau = mul(transit, root(g));
    x = plus(times(1.5, logarithm(g)), race->log_kn);
    while (row > 0 && x.x <= race->x[row]) {
        row--;
    }
    while (row < last && x.x > race->x[row + 1]) {
        row++;
    }
    weight = times(1.0 / (race->x[row + 1] - race->x[row]), plus(x, -race->x[row]));
    if (!(weight.x > 0.0 && weight.x < 1.0)) {
        weight = number(weight.x > 0.0 ? 1.0 : 0.0);
    }
    h.made = of_nodes(&race->made[at->row * race->nodes + row], at, race->nodes, 1, weight);
    for (j = 0; j < RACE_GAINS; j++) {
        const double *entry = &race->gains[at->row * gain_rows + row * RACE_GAINS + j];
        const Dual here = of_nodes(entry, at, gain_rows, RACE_GAINS, weight);
        if (j == 0) {
            h.dashpot = mul(here, h.tau);
        } else if (j < 3) {
            h.film = add(h.film, mul(here, states[j - 1]));
        } else {
            carried = add(carried, mul(here, states[j - 1]));
        }
    }
    h.film = add(h.film, over(carried, h.made));
    {
        double slope;
        const double share = race_cutoff(u.x, &slope);
        h.kn = dual(race->kn * share, race->kn * slope * u.d);
    }
    return h;
}

/* Force of a film. */
static Dual pushed(Dual kn, Dual film)
{
    return film.x > 0.0 ? mul(kn, mul(film, root(film))) : number(0.0);
}

/* Its slope by the film. */
static double push_slope(Dual kn, Dual film)
{
    return film.x > 0.0 ? 1.5 * kn.x * sqrt(film.x) : 0.0;
}

static Dual squeezed(const Held *h, Dual rate)
{
    return add(h->film, mul(h->dashpot, rate));
}

/* Time derivatives of the states of one film, `rate` that of its approach. */
static void filter_rates(const Race *race, const Held *h, Dual rate, const Dual states[], Dual rates[])
{
    const Dual moved = mul(h->tau, rate);
    Dual fed = mul(h->made, states[0]);
    int k;
    rates[0] = over(times(race->inlet_rate, sub(moved, states[0])), h->tau);
    rates[1] = over(times(race->fast_rate, sub(moved, states[1])), h->tau);
    for (k = 2; k < FILM_STATES; k++) {
        rates[k] = over(times(race->lag_rate, sub(fed, states[k])), h->tau);
        fed = states[k];
    }
}

/* ---- one ball ---- */

static double within(double z, double low, double high)
{
    return z < low ? low : z > high ? high : z;
}

/* w' of a ball without inertia, whose contacts balance; returns whether there is one. */
static int balance(const Held *inner, const Held *outer, Dual rate, Dual centrifugal, Dual *own)
{
    const double ai = inner->film.x, di = inner->dashpot.x, ki = inner->kn.x, v = rate.x;
    const double ao = outer->film.x, d_o = outer->dashpot.x, ko = outer->kn.x;
    double low, high, alike, z, scale, slope = 0.0;
    Dual off;
    int i;
    *own = number(0.0);
    if (ko <= 0.0) { /* nothing at the outer race: the ball stays where it is if nothing presses it outward */
        return pushed(inner->kn, squeezed(inner, rate)).x + centrifugal.x == 0.0;
    }
    if (!(di > 0.0 && d_o > 0.0 && isfinite(ai + ao))) {
        return 0;
    }
    low = -ao / d_o;
    high = fmax(v + ai / di, (pow(centrifugal.x / ko, 2.0 / 3.0) - ao) / d_o);
    alike = pow(ki / ko, 2.0 / 3.0);
    z = (alike * (ai + di * v) - ao) / (d_o + alike * di);
    scale = small_step * (fabs(ao) / d_o + fabs(ai) / di);
    for (i = 0; i < MOST_STEPS; i++) {
        double step;
        Dual film_i, film_o;
        z = within(z, low, high);
        film_i = number(ai + di * (v - z));
        film_o = number(ao + d_o * z);
        slope = push_slope(outer->kn, film_o) * d_o + push_slope(inner->kn, film_i) * di;
        off.x = pushed(outer->kn, film_o).x - pushed(inner->kn, film_i).x - centrifugal.x;
        if (off.x > 0.0) {
            high = z;
        } else {
            low = z;
        }
        step = slope > 0.0 ? -off.x / slope : 0.5 * (high - low);
        if (!(low <= z + step && z + step <= high)) {
            step = 0.5 * (low + high) - z;
        }
        z += step;
        if (fabs(step) <= scale) {
            break;
        }
    }
    own->x = z;
    if (slope > 0.0) { /* what holds the balance along the direction */
        off = sub(sub(pushed(outer->kn, squeezed(outer, *own)), pushed(inner->kn, squeezed(inner, sub(rate, *own)))), centrifugal);
        own->d = -off.d / slope;
    } else if (ai / di + v > -ao / d_o) { /* no force at either race: the ball goes with the inner one */
        own->d = add(rate, over(inner->film, inner->dashpot)).d;
    } else {
        own->d = -over(outer->film, outer->dashpot).d;
    }
    return 1;
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

/* Static force of a contact. */
static Dual rest_force(const Race *race, const SpeedState *at, Dual u)
{
    int k = 0;
    double slope;
    const double share = race_cutoff(u.x, &slope);
    const Dual kn = race->nodes == 0 ? number(race->kn) : dual(race->kn * share, race->kn * slope * u.d);
    return pushed(kn, curve(race, at, u, &k));
}

Dual rest_place(const Setup *setup, const RingMotion *ring, Dual angle, int k, double w)
{
    const SpeedState at = speed_state(setup, ring->omega);
    const Dual delta = at_ball(setup, ring, angle, number(0.0), k).delta;
    const Race *inner = &setup->race[INNER_RACE], *outer = &setup->race[OUTER_RACE];
    const Dual off = sub(sub(rest_force(outer, &at, number(w)), rest_force(inner, &at, plus(delta, -w))), at.centrifugal);
    const double tangent = rest_force(outer, &at, dual(w, 1.0)).d + rest_force(inner, &at, dual(delta.x - w, 1.0)).d;
    return dual(w, tangent > 0.0 ? -off.d / tangent : 0.0);
}

/* ---- all balls ---- */

const char *bearing_rates(const Setup *setup, const RingMotion *ring, const Bearing *still, const Dual states[], Dual rates[],
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
        const int placed = OWN_STATES == 2 || wet;
        const Dual w = placed ? first[0] : rest_place(setup, ring, states[CAGE_ANGLE], k, still->ball[k].place[0][0]);
        const Held inner = held(inner_race, &at, at.transit[INNER_RACE], sub(b.delta, w), first + OWN_STATES);
        const Held outer = held(outer_race, &at, at.transit[OUTER_RACE], w, second);
        Dual own = number(0.0), film[2];
        if (OWN_STATES == 2) {
            own = first[1];
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
        if (OWN_STATES == 2) {
            const Dual net = sub(add(out->load[k][INNER_RACE], at.centrifugal), out->load[k][OUTER_RACE]);
            first_rate[1] = over(net, number(BALL_INERTIA));
        }
        if (wet) {
            filter_rates(inner_race, &inner, sub(b.rate, own), first + OWN_STATES, first_rate + OWN_STATES);
            filter_rates(outer_race, &outer, own, second, second_rate);
        }
    }
    return NULL;
}
