/* Balls at contact angles and their films in continuous time; see continuous_time.h. */
#include "contact_angles.h"
#include "contact_rates.h"
#include "continuous_time.h"

#include <stddef.h>

enum { MOST_STEPS = 120, CAGE_ROUNDS = 3 };
static const double balanced = 1e-12; /* imbalance of a ball across its contacts over its forces: rounding */

/* States of a ball are w and a, from its place on the line between both grooves of a ring in the middle: along it, across it. */
static const double middle[2] = {PLACE_RADIAL, PLACE_AXIAL};
static const double e[2] = {PLACE_RADIAL / OUTER_FREE_LENGTH, PLACE_AXIAL / OUTER_FREE_LENGTH};

/* A ball at a place, its contacts there, and the angle between both normals. */
typedef struct {
    GrooveCentre centre;
    Rolling rolls;
    Dual u[2], factor[2], cosine, sine;
} BallPlace;

static Dual dot(const Dual a[2], const Dual b[2])
{
    return add(mul(a[0], b[0]), mul(a[1], b[1]));
}

static Dual cross(const Dual a[2], const Dual b[2])
{
    return sub(mul(a[0], b[1]), mul(a[1], b[0]));
}

static BallPlace ball_place(const Setup *setup, const RingMotion *ring, Dual angle, Dual cage, int k, const Dual own[2])
{
    const Dual w = own[0], a = own[1], zero[2] = {number(middle[0]), number(middle[1])};
    BallPlace p;
    Dual b[2], s[2], x[2], y[2], span[2], across;
    double rest_i;
    int j;
    p.centre = groove_centre(setup, ring->q, ring->v, angle, cage, k);
    x[0] = sub(times(e[0], w), times(e[1], a));
    x[1] = add(times(e[1], w), times(e[0], a));
    for (j = 0; j < 2; j++) { /* at rest the ball is at `middle`, the inner spring s; both grow by x and y */
        b[j] = plus(x[j], middle[j]);
        y[j] = sub(p.centre.moved[j], x[j]);
    }
    s[0] = number(FREE_RADIAL - 0.5 * setup->clearance - middle[0]);
    s[1] = number(FREE_AXIAL - middle[1]);
    rest_i = sqrt(s[0].x * s[0].x + s[1].x * s[1].x);
    {
        const Dual l_i = inner_span(b, p.centre.c, span), l_o = root(dot(b, b));
        const Dual more_o = add(times(2.0 * OUTER_FREE_LENGTH, w), add(mul(w, w), mul(a, a)));
        const Dual more_i = add(times(2.0, dot(s, y)), dot(y, y));
        p.u[OUTER_RACE] = over(more_o, plus(l_o, OUTER_FREE_LENGTH));
        p.u[INNER_RACE] = plus(over(more_i, plus(l_i, rest_i)), rest_i - INNER_FREE_LENGTH);
        across = add(add(cross(zero, s), cross(x, p.centre.c)), cross(zero, p.centre.moved));
        if (p.centre.c[0].x < b[0].x) { /* beyond the groove, along its wall */
            p.u[INNER_RACE] = plus(l_i, -INNER_FREE_LENGTH);
            across = cross(b, span);
        }
        p.sine = over(across, mul(l_i, l_o));
        p.cosine = over(dot(b, span), mul(l_i, l_o));
    }
    p.rolls = roll(setup, b, p.centre.c, p.u);
    film_factors(&p.rolls, p.factor);
    return p;
}

/* ---- at rest ---- */

void own_states(const Ball *ball, double states[])
{
    const double r = ball->place[0][0] - middle[0], z = ball->place[0][1] - middle[1];
    states[0] = e[0] * r + e[1] * z;
    states[1] = e[0] * z - e[1] * r;
}

/* Sum of the forces of a ball at rest. */
static BallForces at_rest(const Setup *setup, const RingMotion *ring, Dual angle, int k, const Dual own[2])
{
    const LawSpeed law = law_speed(ring->omega);
    const BallPlace p = ball_place(setup, ring, angle, number(0.0), k, own);
    Dual f[2];
    int race;
    for (race = 0; race < 2; race++) {
        f[race] = rest_force(&setup->race[race], &law, &p.factor[race], p.u[race]);
    }
    return forces_on(&p.rolls, ring->omega, f[INNER_RACE], f[OUTER_RACE]);
}

void rest_place(const Setup *setup, const RingMotion *ring, Dual angle, int k, Dual place[PLACES])
{
    const Dual here[2] = {number(place[0].x), number(place[1].x)}, by_w[2] = {dual(here[0].x, 1.0), here[1]};
    const Dual by_a[2] = {here[0], dual(here[1].x, 1.0)};
    const BallForces off = at_rest(setup, ring, angle, k, here);
    RingMotion fixed = *ring;
    BallForces w, a;
    double det;
    int j;
    fixed.omega.d = 0.0;
    for (j = 0; j < FREEDOMS; j++) {
        fixed.q[j].d = fixed.v[j].d = 0.0;
    }
    w = at_rest(setup, &fixed, number(angle.x), k, by_w);
    a = at_rest(setup, &fixed, number(angle.x), k, by_a);
    det = w.sum[0].d * a.sum[1].d - a.sum[0].d * w.sum[1].d;
    place[0].d = det != 0.0 ? (a.sum[0].d * off.sum[1].d - a.sum[1].d * off.sum[0].d) / det : 0.0;
    place[1].d = det != 0.0 ? (w.sum[1].d * off.sum[0].d - w.sum[0].d * off.sum[1].d) / det : 0.0;
}

/* ---- rates ---- */

/* What a ball is in at an instant: both contacts, the inner one with the `normal` (cos, sin) at the outer, velocity of the
 * inner groove centre and forces beside those of the contacts, all along and across the outer contact. */
typedef struct {
    Held inner, outer;
    Dual cosine, sine, moving[2], pushed[2];
} Between;

/* Rate of a ball along its outer contact at a rate t across it, and the imbalance that is left across; 0 without any. */
static int along_at(const Between *b, Dual t, Dual *p, Dual *off, double *tangent, double *force)
{
    const double c = b->cosine.x, s = b->sine.x;
    Held seen = b->inner; /* along the outer one */
    Dual rate, film_i, film_o, f_i;
    double by_i, by_o, both;
    seen.dashpot = mul(b->cosine, seen.dashpot);
    seen.kn = mul(b->cosine, seen.kn);
    rate = add(b->moving[0], mul(over(b->sine, b->cosine), sub(b->moving[1], t)));
    if (!balance(&seen, &b->outer, rate, b->pushed[0].x > 0.0 ? b->pushed[0] : number(0.0), p)) {
        return 0;
    }
    film_i = squeezed(&seen, sub(rate, *p));
    film_o = squeezed(&b->outer, *p);
    f_i = pushed(seen.kn, film_i);
    *off = sub(add(b->pushed[1], mul(over(b->sine, b->cosine), f_i)), times(ACROSS, t));
    by_i = push_slope(b->inner.kn, film_i) * b->inner.dashpot.x;
    by_o = push_slope(b->outer.kn, film_o) * b->outer.dashpot.x;
    both = c * c * by_i + by_o;
    *tangent = ACROSS + (both > 0.0 ? by_i * by_o * s * s / both : 0.0);
    *force = f_i.x;
    return isfinite(off->x);
}

/* Rates along and across the outer contact at which the forces balance; returns whether there are such. */
static int rates_in_balance(const Between *b, Dual *p, Dual *t)
{
    double low = -HUGE_VAL, high = HUGE_VAL, last = HUGE_VAL, tangent, force, at = 0.0;
    Dual off;
    int i;
    if (!(b->cosine.x > 0.0)) {
        return 0;
    }
    for (i = 0; i < MOST_STEPS; i++) {
        double size, step;
        if (!along_at(b, number(at), p, &off, &tangent, &force)) {
            return 0;
        }
        size = fabs(off.x);
        if (size == 0.0 || (size > 0.5 * last && size <= balanced * (force + fabs(b->pushed[0].x)))) {
            break;
        }
        last = size;
        if (off.x > 0.0) {
            low = at;
        } else {
            high = at;
        }
        step = off.x / tangent;
        if (at + step == at) {
            break;
        }
        if (!(low < at + step && at + step < high)) {
            step = 0.5 * (low + high) - at;
        }
        at += step;
    }
    *t = dual(at, off.d / tangent);
    return t->d == 0.0 || along_at(b, *t, p, &off, &tangent, &force);
}

/* All rates with the cage at a given speed; that at which the balls would turn it is the rate of its angle. */
static const char *rates_at(const Setup *setup, const RingMotion *ring, const Bearing *last, Dual cage, const Dual states[],
                            Dual rates[], BallLoads *out)
{
    const LawSpeed law = law_speed(ring->omega);
    const int wet = setup->race[INNER_RACE].nodes > 0;
    Dual carried = number(0.0), driven = number(0.0), free = number(0.0);
    int k, j, race;
    for (j = 0; j < FREEDOMS; j++) {
        out->force[j] = number(0.0);
    }
    for (k = 0; k < BALLS; k++) {
        const Dual *first = &states[FIRST_OF_BALLS + k * BALL_STATES];
        Dual *rate = &rates[FIRST_OF_BALLS + k * BALL_STATES], own[2], o[2], *load = out->load[k];
        Dual along = number(0.0), aside = number(0.0), approaching[2], film[2], transit[2] = {{0.0, 0.0}, {0.0, 0.0}};
        BallForces forces;
        BallPlace p;
        Between b;
        for (j = 0; j < BALL_STATES; j++) {
            rate[j] = number(0.0);
        }
        if (wet) {
            own[0] = first[0];
            own[1] = first[1];
        } else {
            double place[2];
            own_states(&last->ball[k], place);
            own[0] = number(place[0]);
            own[1] = number(place[1]);
            rest_place(setup, ring, states[CAGE_ANGLE], k, own);
        }
        p = ball_place(setup, ring, states[CAGE_ANGLE], cage, k, own);
        forces = forces_on(&p.rolls, ring->omega, number(0.0), number(0.0));
        for (race = 0; race < 2 && wet && law.rolling.x > 0.0; race++) {
            transit[race] = over(number(setup->race[race].contact_length_factor), mul(p.rolls.speed_sum[race], law.rolling));
        }
        b.inner = held(&setup->race[INNER_RACE], &law, transit[INNER_RACE], &p.factor[INNER_RACE], p.u[INNER_RACE],
                       first + OWN_STATES);
        b.outer = held(&setup->race[OUTER_RACE], &law, transit[OUTER_RACE], &p.factor[OUTER_RACE], p.u[OUTER_RACE],
                       first + OWN_STATES + FILM_STATES);
        o[0] = p.rolls.cosine[OUTER_RACE];
        o[1] = p.rolls.sine[OUTER_RACE];
        b.cosine = p.cosine;
        b.sine = p.sine;
        b.moving[0] = dot(o, p.centre.d);
        b.moving[1] = cross(o, p.centre.d);
        b.pushed[0] = dot(o, forces.sum);
        b.pushed[1] = cross(o, forces.sum);
        if (wet) {
            if (last->h > 0.0) {
                const double *v = last->ball[k].rate;
                along = add(times(v[0], o[0]), times(v[1], o[1]));
                aside = sub(times(v[1], o[0]), times(v[0], o[1]));
            } else if (!rates_in_balance(&b, &along, &aside)) {
                return "a ball finds no balance: a smaller displacement can help";
            }
            {
                const Dual v[2] = {sub(mul(o[0], along), mul(o[1], aside)), add(mul(o[1], along), mul(o[0], aside))};
                rate[0] = add(times(e[0], v[0]), times(e[1], v[1]));
                rate[1] = sub(times(e[0], v[1]), times(e[1], v[0]));
            }
        }
        approaching[INNER_RACE] = add(mul(b.cosine, sub(b.moving[0], along)), mul(b.sine, sub(b.moving[1], aside)));
        approaching[OUTER_RACE] = along;
        film[INNER_RACE] = squeezed(&b.inner, approaching[INNER_RACE]);
        film[OUTER_RACE] = squeezed(&b.outer, approaching[OUTER_RACE]);
        load[INNER_RACE] = pushed(b.inner.kn, film[INNER_RACE]);
        load[OUTER_RACE] = pushed(b.outer.kn, film[OUTER_RACE]);
        for (race = 0; race < 2; race++) {
            const int at = OWN_STATES + race * FILM_STATES;
            const Dual c = p.rolls.cosine[race], s = p.rolls.sine[race];
            out->film[k][race] = film[race].x;
            out->factor[k][race] = p.factor[race];
            out->speed_sum[k][race] = p.rolls.speed_sum[race];
            out->angle[k][race] = dual(atan2(s.x, c.x), c.x * s.d - s.x * c.d);
            if (wet) {
                film_state_rates(&setup->race[race], race == INNER_RACE ? &b.inner : &b.outer, approaching[race], first + at,
                                 rate + at);
            }
        }
        forces.ring[0] = add(forces.ring[0], mul(load[INNER_RACE], p.rolls.cosine[INNER_RACE]));
        forces.ring[1] = add(forces.ring[1], mul(load[INNER_RACE], p.rolls.sine[INNER_RACE]));
        add_to_ring(&p.centre, &forces, out->force);
        carried = add(carried, load[INNER_RACE]);
        driven = add(driven, mul(load[INNER_RACE], p.rolls.orbit));
        free = add(free, times(1.0 / BALLS, p.rolls.orbit));
    }
    rates[CAGE_ANGLE] = mul(ring->omega, carried.x > 0.0 ? over(driven, carried) : free);
    return NULL;
}

const char *bearing_rates(const Setup *setup, const RingMotion *ring, const Bearing *last, const Dual states[], Dual rates[],
                          BallLoads *out)
{
    const char *reason = NULL;
    Dual cage = number(0.0);
    int i;
    for (i = 0; i < CAGE_ROUNDS && reason == NULL; i++) { /* the cage turns as the balls carry, which move with it */
        reason = rates_at(setup, ring, last, cage, states, rates, out);
        cage = rates[CAGE_ANGLE];
    }
    return reason;
}
