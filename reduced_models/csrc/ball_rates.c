/* Balls at contact angles and their films in continuous time; see bearing.h. */
#include <math.h>
#include <string.h>

#include "contact_rates.h"
#include "rolling.h"

enum { MOST_STEPS = 120, CAGE_ROUNDS = 3 };
static const double two_pi = 6.283185307179586;
static const double balanced = 1e-12; /* imbalance of a ball across its contacts over its forces: rounding */

/* ---- the states ---- */

/* Of a ball: how many tell its place. */
static int places(const Bearing *b)
{
    return is_angular(b) ? 2 : 1;
}

static int own_states(const Bearing *b)
{
    return b->inertia > 0.0 ? 2 * places(b) : b->race[INNER_RACE].nodes > 0 ? places(b) : 0;
}

static int film_states(const Bearing *b, int race)
{
    return b->race[race].nodes > 0 ? 2 + b->race[race].lags : 0;
}

int ball_states(const Bearing *b)
{
    return own_states(b) + film_states(b, INNER_RACE) + film_states(b, OUTER_RACE);
}

int bearing_states(const Bearing *b)
{
    return FIRST_OF_BALLS + b->balls * ball_states(b) + b->filters * b->directions;
}

/* Unit vector from the outer groove centre to the origin of a ball; across is that turned to the left. Returns their distance. */
static double along_origin(const BallOrigin *origin, double e[2])
{
    const double length = sqrt(origin->place[0] * origin->place[0] + origin->place[1] * origin->place[1]);
    e[0] = origin->place[0] / length;
    e[1] = origin->place[1] / length;
    return length;
}

/* A vector of the plane of a ball by its parts along that line and across it, and back. */
static void to_plane(const double e[2], const Dual own[2], Dual x[2])
{
    x[0] = sub(times(e[0], own[0]), times(e[1], own[1]));
    x[1] = add(times(e[1], own[0]), times(e[0], own[1]));
}

static void from_plane(const double e[2], const Dual x[2], Dual own[2])
{
    own[0] = add(times(e[0], x[0]), times(e[1], x[1]));
    own[1] = sub(times(e[0], x[1]), times(e[1], x[0]));
}

/* Place of a ball in steps, along and across. */
static void own_place(const BallOrigin *origin, const Ball *ball, Dual own[2])
{
    const Dual x[2] = {number(ball->place[0][0] - origin->place[0]), number(ball->place[0][1] - origin->place[1])};
    double e[2];
    along_origin(origin, e);
    from_plane(e, x, own);
}

void bearing_states_of_step(const Bearing *b, const double state[], double states[])
{
    const int n = places(b), own_n = own_states(b);
    int k, race, j;
    *states++ = head_of(state)->angle;
    for (k = 0; k < b->balls; k++) {
        const Ball *ball = ball_of(state, k);
        const Dual rate[2] = {number(ball->rate[0][0]), number(ball->rate[0][1])};
        Dual own[4];
        double e[2];
        along_origin(&b->origin[k], e);
        own_place(&b->origin[k], ball, own);
        from_plane(e, rate, own + 2);
        for (j = 0; j < own_n; j++) {
            *states++ = own[j < n ? j : 2 + j - n].x;
        }
        for (race = 0; race < 2 && film_states(b, race) > 0; race++) {
            const FilmState *film = film_of(b, state, k, race);
            *states++ = film->inlet;
            *states++ = film->fast;
            memcpy(states, film->chain, (size_t)b->race[race].lags * sizeof states[0]);
            states += b->race[race].lags;
        }
    }
    memcpy(states, state + seat_place(b, 2), (size_t)(b->filters * b->directions) * sizeof states[0]);
}

/* ---- places ---- */

/* Inner groove centre at a ball: its place, how far the ring has moved it from where it is with the ball at its origin, its velocity as
 * the ball sees it; rows of forces. */
typedef struct {
    Dual c[2], moved[2], d[2], rows[MOST_DIRECTIONS][3];
} GrooveCentre;

static GrooveCentre groove_centre(const Bearing *b, const BearingSettings *settings, const RingMotion *ring, Dual angle, Dual cage, int k)
{
    const double psi = angle.x + two_pi * k / b->balls, x = cos(psi), y = sin(psi), *from = b->origin[k].moved;
    GrooveCentre g;
    int i, j;
    g.moved[0] = number(-from[0]);
    g.moved[1] = number(settings->offset - from[1]);
    g.d[0] = g.d[1] = number(0.0);
    for (j = 0; j < b->directions; j++) {
        double rows[3], turned[3];
        ring_rows(&b->grooves, b->direction[j], x, y, rows);
        ring_rows(&b->grooves, b->direction[j], -y, x, turned);
        for (i = 0; i < 3; i++) {
            const double by_angle = b->direction[j] == IN_Z ? 0.0 : turned[i];
            g.rows[j][i] = chained(rows[i], by_angle, angle);
            if (i < 2) { /* turned once more it is the row again, backwards */
                const Dual swept = mul(cage, chained(by_angle, b->direction[j] == IN_Z ? 0.0 : -rows[i], angle));
                g.moved[i] = add(g.moved[i], mul(g.rows[j][i], ring->q[j]));
                g.d[i] = add(g.d[i], add(mul(g.rows[j][i], ring->v[j]), mul(swept, ring->q[j])));
            }
        }
    }
    g.c[0] = plus(g.moved[0], b->grooves.radial - 0.5 * (settings->clearance - b->grooves.clearance) + from[0]);
    g.c[1] = plus(g.moved[1], b->grooves.axial + from[1]);
    return g;
}

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

static BallPlace ball_place(const Bearing *bearing, const Race races[2], const BearingSettings *settings, const RingMotion *ring, Dual angle,
                            Dual cage, int k, const Dual own[2])
{
    const Grooves *g = &bearing->grooves;
    const BallOrigin *origin = &bearing->origin[k];
    const Dual zero[2] = {number(origin->place[0]), number(origin->place[1])};
    BallPlace p;
    Dual b[2], s[2], x[2], y[2], span[2], across, dry[2], l_i, l_o, more_o, more_i;
    double rest_i, rest_o, e[2];
    int j, race;
    p.centre = groove_centre(bearing, settings, ring, angle, cage, k);
    rest_o = along_origin(origin, e);
    to_plane(e, own, x);
    for (j = 0; j < 2; j++) { /* at its origin the ball is at `zero`, the inner spring s; both grow by x and y */
        b[j] = add(x[j], zero[j]);
        y[j] = sub(p.centre.moved[j], x[j]);
    }
    s[0] = number(g->radial - 0.5 * (settings->clearance - g->clearance) + origin->moved[0] - zero[0].x);
    s[1] = number(g->axial + origin->moved[1] - zero[1].x);
    rest_i = sqrt(s[0].x * s[0].x + s[1].x * s[1].x);
    l_i = inner_span(b, p.centre.c, span);
    l_o = root(dot(b, b));
    more_o = add(times(2.0 * rest_o, own[0]), add(mul(own[0], own[0]), mul(own[1], own[1])));
    more_i = add(times(2.0, dot(s, y)), dot(y, y));
    p.u[OUTER_RACE] = plus(over(more_o, plus(l_o, rest_o)), rest_o - g->free_length[OUTER_RACE]);
    p.u[INNER_RACE] = plus(over(more_i, plus(l_i, rest_i)), rest_i - g->free_length[INNER_RACE]);
    across = add(add(cross(zero, s), cross(x, p.centre.c)), cross(zero, p.centre.moved));
    if (p.centre.c[0].x < b[0].x) { /* beyond the groove, along its wall */
        p.u[INNER_RACE] = plus(l_i, -g->free_length[INNER_RACE]);
        across = cross(b, span);
    }
    p.sine = over(across, mul(l_i, l_o));
    p.cosine = over(dot(b, span), mul(l_i, l_o));
    for (race = 0; race < 2 && shared_by_forces(bearing); race++) {
        dry[race] = dry_compression(&races[race], p.u[race]);
    }
    p.rolls = roll(bearing, b, p.centre.c, shared_by_forces(bearing) ? dry : NULL);
    for (race = 0; race < 2; race++) {
        p.factor[race] = film_factor(bearing, &p.rolls, race);
    }
    return p;
}

/* ---- at rest ---- */

/* Sum of the forces of a ball at rest. */
static BallForces at_rest(const Bearing *b, const Race races[2], const BearingSettings *settings, const RingMotion *ring, Dual angle, int k,
                          const Dual own[2])
{
    const LawSpeed law = law_speed(b, ring->omega);
    const BallPlace p = ball_place(b, races, settings, ring, angle, number(0.0), k, own);
    Dual f[2];
    int race;
    for (race = 0; race < 2; race++) {
        f[race] = rest_force(&races[race], &law, p.factor[race], p.u[race]);
    }
    return forces_on(&b->grooves, &p.rolls, ring->omega, f[INNER_RACE], f[OUTER_RACE]);
}

/* How the place of a ball at rest changes along the direction of ring, speed and angle. */
static void rest_place(const Bearing *b, const Race races[2], const BearingSettings *settings, const RingMotion *ring, Dual angle, int k,
                       Dual place[2])
{
    const Dual here[2] = {number(place[0].x), number(place[1].x)}, by_w[2] = {dual(here[0].x, 1.0), here[1]};
    const Dual by_a[2] = {here[0], dual(here[1].x, 1.0)};
    const BallForces off = at_rest(b, races, settings, ring, angle, k, here);
    RingMotion fixed = *ring;
    BallForces w, a;
    double det;
    int j;
    fixed.omega.d = 0.0;
    for (j = 0; j < b->directions; j++) {
        fixed.q[j].d = fixed.v[j].d = 0.0;
    }
    w = at_rest(b, races, settings, &fixed, number(angle.x), k, by_w);
    a = at_rest(b, races, settings, &fixed, number(angle.x), k, by_a);
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
    double across;
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
    *off = sub(add(b->pushed[1], mul(over(b->sine, b->cosine), f_i)), times(b->across, t));
    by_i = push_slope(b->inner.kn, film_i) * b->inner.dashpot.x;
    by_o = push_slope(b->outer.kn, film_o) * b->outer.dashpot.x;
    both = c * c * by_i + by_o;
    *tangent = b->across + (both > 0.0 ? by_i * by_o * s * s / both : 0.0);
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


/* What all balls have in common at an instant. */
typedef struct {
    const Bearing *bearing;
    const double *state;
    const RingMotion *ring;
    Race races[2];
    LawSpeed law;
    int wet, starts;
} Instant;

/* Rates of a ball's own states and films, its forces on the ring, and what it carries; the cage turns at a given speed. */
static const char *ball_rates(const Instant *at, Dual angle, Dual cage, int k, Dual states[], Dual rates[], BallPlace *p, BallForces *forces,
                              BallOutputs *out)
{
    const Bearing *b = at->bearing;
    const BearingHead *head = head_of(at->state);
    const Ball *last = ball_of(at->state, k);
    const int n = places(b), own_n = own_states(b), heavy = b->inertia > 0.0, placed = heavy || at->wet;
    const Dual *first[2] = {states + own_n, states + own_n + film_states(b, INNER_RACE)};
    Dual *o, own[2], along = number(0.0), aside = number(0.0), approaching[2], film[2], normal[2];
    Between between;
    double e[2];
    int race, j;
    along_origin(&b->origin[k], e);
    for (j = 0; j < ball_states(b); j++) {
        rates[j] = number(0.0);
    }
    if (placed) {
        if (at->starts) {
            own[0] = states[0];
            own[1] = n > 1 ? states[1] : number(0.0);
            rest_place(b, at->races, &head->settings, at->ring, angle, k, own);
            for (j = 0; j < n; j++) {
                states[j] = own[j];
            }
        }
        own[0] = states[0];
        own[1] = n > 1 ? states[1] : number(0.0);
    } else {
        own_place(&b->origin[k], last, own);
        rest_place(b, at->races, &head->settings, at->ring, angle, k, own);
    }
    *p = ball_place(b, at->races, &head->settings, at->ring, angle, cage, k, own);
    *forces = forces_on(&b->grooves, &p->rolls, at->ring->omega, number(0.0), number(0.0));
    for (race = 0; race < 2; race++) {
        Dual transit = number(0.0);
        if (at->wet && at->law.rolling.x > 0.0) {
            transit = over(number(at->races[race].contact_length_factor), mul(p->rolls.speed_sum[race], at->law.rolling));
        }
        *(race == INNER_RACE ? &between.inner : &between.outer) = held(&at->races[race], &at->law, transit, p->factor[race], p->u[race], first[race]);
    }
    o = normal;
    o[0] = p->rolls.cosine[OUTER_RACE];
    o[1] = p->rolls.sine[OUTER_RACE];
    between.across = b->origin[k].across;
    between.cosine = p->cosine;
    between.sine = p->sine;
    between.moving[0] = dot(o, p->centre.d);
    between.moving[1] = cross(o, p->centre.d);
    between.pushed[0] = dot(o, forces->sum);
    between.pushed[1] = cross(o, forces->sum);
    if (placed) {
        Dual v[2], by_states[2];
        if (heavy) {
            const Dual rate[2] = {states[n], n > 1 ? states[n + 1] : number(0.0)};
            to_plane(e, rate, v);
            along = dot(o, v);
            aside = cross(o, v);
        } else if (head->h > 0.0) {
            v[0] = number(last->rate[0][0]);
            v[1] = number(last->rate[0][1]);
            along = dot(o, v);
            aside = cross(o, v);
        } else {
            if (!rates_in_balance(&between, &along, &aside)) {
                return "a ball finds no balance: a smaller displacement can help";
            }
            v[0] = sub(mul(o[0], along), mul(o[1], aside));
            v[1] = add(mul(o[1], along), mul(o[0], aside));
        }
        from_plane(e, v, by_states);
        for (j = 0; j < n; j++) {
            rates[j] = by_states[j];
        }
    }
    approaching[INNER_RACE] = add(mul(between.cosine, sub(between.moving[0], along)), mul(between.sine, sub(between.moving[1], aside)));
    approaching[OUTER_RACE] = along;
    for (race = 0; race < 2; race++) {
        const Held *contact = race == INNER_RACE ? &between.inner : &between.outer;
        const Dual c = p->rolls.cosine[race], s = p->rolls.sine[race];
        film[race] = squeezed(contact, approaching[race]);
        out->load[race] = pushed(contact->kn, film[race]);
        out->film[race] = film[race].x;
        out->approach[race] = p->u[race];
        out->factor[race] = p->factor[race];
        out->speed_sum[race] = p->rolls.speed_sum[race];
        out->angle[race] = dual(atan2(s.x, c.x), c.x * s.d - s.x * c.d);
        if (at->wet) {
            film_state_rates(&at->races[race], contact, approaching[race], first[race], rates + (first[race] - states));
        }
    }
    if (heavy) {
        const Dual net_along = sub(add(between.pushed[0], mul(between.cosine, out->load[INNER_RACE])), out->load[OUTER_RACE]);
        const Dual net_aside = add(between.pushed[1], mul(between.sine, out->load[INNER_RACE]));
        const Dual net[2] = {sub(mul(o[0], net_along), mul(o[1], net_aside)), add(mul(o[1], net_along), mul(o[0], net_aside))};
        Dual by_states[2];
        from_plane(e, net, by_states);
        for (j = 0; j < n; j++) {
            rates[n + j] = times(1.0 / b->inertia, by_states[j]);
        }
    }
    forces->ring[0] = add(forces->ring[0], mul(out->load[INNER_RACE], p->rolls.cosine[INNER_RACE]));
    forces->ring[1] = add(forces->ring[1], mul(out->load[INNER_RACE], p->rolls.sine[INNER_RACE]));
    return NULL;
}

/* All rates with the cage at a given speed; that at which the balls would turn it is the rate of its angle. */
static const char *rates_at(const Instant *at, Dual cage, Dual states[], Dual rates[], Dual force[], BallOutputs balls[])
{
    const Bearing *b = at->bearing;
    Dual carried = number(0.0), driven = number(0.0), free = number(0.0);
    int k, j, m;
    for (j = 0; j < b->directions; j++) {
        force[j] = number(0.0);
    }
    for (k = 0; k < b->balls; k++) {
        const int first = FIRST_OF_BALLS + k * ball_states(b);
        BallForces forces;
        BallPlace p;
        const char *reason = ball_rates(at, states[CAGE_ANGLE], cage, k, states + first, rates + first, &p, &forces, &balls[k]);
        if (reason != NULL) {
            return reason;
        }
        for (j = 0; j < b->directions; j++) {
            const Dual by[3] = {forces.ring[0], forces.ring[1], forces.moment};
            for (m = 0; m < 3; m++) {
                force[j] = add(force[j], mul(p.centre.rows[j][m], by[m]));
            }
        }
        carried = add(carried, balls[k].load[INNER_RACE]);
        driven = add(driven, mul(balls[k].load[INNER_RACE], about_axis(&b->grooves, p.rolls.orbit)));
        free = add(free, times(1.0 / b->balls, about_axis(&b->grooves, p.rolls.orbit)));
    }
    rates[CAGE_ANGLE] = mul(at->ring->omega, carried.x > 0.0 ? over(driven, carried) : free);
    return NULL;
}

const char *bearing_rates(const Bearing *b, double state[], double work[], const RingMotion *ring, int starts, Dual states[],
                          Dual rates[], Dual force[], BallOutputs balls[])
{
    const int seat = FIRST_OF_BALLS + b->balls * ball_states(b);
    const char *reason = NULL;
    Dual cage = number(0.0);
    Instant at;
    int i, j, k, race;
    at.bearing = b;
    at.state = state;
    at.ring = ring;
    at.wet = is_wet(b, state);
    at.starts = starts;
    at.law = law_speed(b, ring->omega);
    for (race = 0; race < 2; race++) {
        at.races[race] = b->race[race];
        if (!at.wet) {
            at.races[race].nodes = 0;
        }
    }
    if (!at.wet && !(b->inertia > 0.0)) {
        double q[MOST_DIRECTIONS], any[MOST_DIRECTIONS];
        for (j = 0; j < b->directions; j++) {
            q[j] = ring->q[j].x;
        }
        reason = bearing_rest_at(b, state, work, ring->omega.x, states[CAGE_ANGLE].x, q, any);
    }
    for (i = 0; i < (b->cage_held ? 1 : CAGE_ROUNDS) && reason == NULL; i++) { /* the cage turns as the balls carry, which move with it */
        reason = rates_at(&at, cage, states, rates, force, balls);
        cage = rates[CAGE_ANGLE];
    }
    for (j = 0; j < b->directions && reason == NULL; j++) {
        const Dual raw = force[j];
        for (k = 0; k < b->filters; k++) {
            const int state_at = seat + k * b->directions + j;
            Dual lost;
            states[state_at].d = starts ? raw.d : states[state_at].d;
            lost = sub(raw, states[state_at]);
            rates[state_at] = times(b->filter_rates[k], lost);
            force[j] = add(force[j], times(b->filter_gains[k], lost));
        }
        reason = isfinite(force[j].x) ? NULL : "the forces are too large for a floating-point number";
    }
    for (i = 0; i < bearing_states(b) && reason == NULL; i++) {
        reason = isfinite(rates[i].x) ? NULL : "a derivative of a state is too large for a floating-point number";
    }
    return reason;
}
