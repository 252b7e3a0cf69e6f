/* One ball between two races, in a step or at rest: reduced_models.bearing. The ball is at b, the inner groove centre at c, moving at
 * d, see rolling.h. Rest is a step that leads from places to rates with a gain of 0: films are then those of the place. */
#ifndef BALL_H
#define BALL_H

#include "bearing.h"
#include "film_filters.h"
#include "rolling.h"

static const double two_pi = 6.283185307179586;
static const double first_step = 1e-7; /* m, outward, of a ball that nothing touches; doubled until a race is met */
static const double longest = 0.05;    /* step over the distance of the groove centres */
static const double nearly = 1e-8, nearly_shared = 1e-10; /* imbalance of a ball, over its forces and in steps 1 N, that one more step ends */
static const double rounding = 1e-15;  /* of the place of a ball: what is left of its imbalance, over its stiffness */
static const double singular = 1e-14;  /* of the squared stiffness: determinant of the tangent of a ball that nothing touches */

/* A step of the bearing; `gain` leads from places to rates, by differences of second order. `angle` is that of the first ball at its
 * end, `lift` the slope of the force with losses by that without them. */
typedef struct {
    double h, gain, omega, cage, angle, lift;
    double bare[MOST_DIRECTIONS], force[MOST_DIRECTIONS]; /* of the ring on the balls, without losses of rings and fits and with them */
    SpeedRow row;
} StepHead;

/* A ball in a step: direction to it, what its rates follow from, where it is looked for (0: it has not been placed). Then what it was balanced with last: c and d, its place, forces of its contacts, force of the
 * ring on it (r, z) and its moment, and their slopes by c and d, the ball following. At rest it is looked for where it was balanced
 * last, moved on with the groove centre, which was at `tried`, by its slopes `follow`, and `inertia` has those of `renew_slopes`. */
typedef struct {
    double x, y, history[2], rate_history[2], start[2], tried[2], follow[2][2], inertia[5][4];
    double c[2], d[2], place[2], force[2], film[2], ring[3], slopes[3][4];
    double transit[2], height[2], height_rate[2]; /* [race] of features */
    Thickness thickness[2];
} BallStep;

enum {
    STEP_NUMBERS = sizeof(StepHead) / sizeof(double),
    BALL_STEP_NUMBERS = sizeof(BallStep) / sizeof(double),
    FILTER_NUMBERS = sizeof(StepFilters) / sizeof(double)
};

/* What a ball needs to be balanced: both contacts, its mass over the square of the step, slopes of its forces of inertia. */
typedef struct {
    const Bearing *bearing;
    const StepHead *step;
    BallStep *ball;
    RaceStep contact[2];
    const Race *dry; /* of both races, for the share of the gyroscopic moment */
    const BallSurface *surface; /* NULL: no full films */
    double heavy;
    const double (*inertia)[4];
} Search;

/* Both races as the settings have them: dry without films. */
void races_of(const Bearing *b, const double state[], Race races[2]);

/* Height at a contact under the compression at the end of the last step, that height left out. */
double height_at(const Bearing *b, const double state[], int k, int race, double psi, double shaft, double own);

void search_of(const Bearing *b, const double state[], double work[], int k, const Race races[2], Search *s);

/* Balances a ball from `start` to first order, from where its imbalance is small; returns whether there is a balance. */
int balance_ball(const Search *s, const double start[2]);

/* The same from wherever it takes. */
int place_ball(const Search *s);

/* Slopes of `BallForces` by the places of the ball and of the inner groove centre, without those by the approaches of the contacts: of
 * centrifugal force and gyroscopic moment, of contacts that turn under their forces, and of these by films that follow the place. */
void renew_slopes(const Search *s, const double b[2], const double force[2], const double by_film[2], double slopes[5][4]);

static inline StepHead *step_of(double work[])
{
    return (StepHead *)(void *)work;
}

static inline BallStep *ball_in(double work[], int k)
{
    return (BallStep *)(void *)(work + STEP_NUMBERS) + k;
}

static inline int at_rest(const Search *s)
{
    return s->step->gain == 0.0;
}

/* Length of either spring of a ball without load, under the height of a feature. */
static inline double free_length(const Search *s, int race)
{
    return s->bearing->grooves.free_length[race] - s->ball->height[race];
}

/* Rolling of a ball at b with the groove centre at c. */
IN_PLACE Rolling roll_along(const Search *s, const Dual b[2], const Dual c[2])
{
    Dual dry[2], span[2];
    if (!shared_by_forces(s->bearing)) {
        return roll(s->bearing, b, c, NULL);
    }
    dry[INNER_RACE] = dry_compression(&s->dry[INNER_RACE], plus(inner_span(b, c, span), -free_length(s, INNER_RACE)));
    dry[OUTER_RACE] = dry_compression(&s->dry[OUTER_RACE], plus(outer_span(b), -free_length(s, OUTER_RACE)));
    return roll(s->bearing, b, c, dry);
}

/* A ball at a place: its springs, its rolling, and what acts on it beside its contacts, all as in `Rolling` and `BallForces`. */
typedef struct {
    double l[2], cosine[2], sine[2], orbit, axis, share, rotation, speed_sum[2], factor[2], sum[2], ring[2], moment;
} Turning;

/* Factors of films that vary, and the rotation of the ball about its own axis, at an end of a step alone. */
IN_PLACE void turn(const Search *s, const double b[2], int end, Turning *t)
{
    const Dual ball[2] = {number(b[0]), number(b[1])}, centre[2] = {number(s->ball->c[0]), number(s->ball->c[1])}, none = number(0.0);
    const Rolling at = roll_along(s, ball, centre);
    const BallForces f = forces_on(&s->bearing->grooves, &at, number(s->step->omega), none, none);
    int i;
    for (i = 0; i < 2; i++) {
        t->l[i] = at.l[i].x;
        t->cosine[i] = at.cosine[i].x;
        t->sine[i] = at.sine[i].x;
        t->speed_sum[i] = at.speed_sum[i].x;
        t->sum[i] = f.sum[i].x;
        t->ring[i] = f.ring[i].x;
        t->factor[i] = end && s->contact[i].film != NULL ? film_factor(s->bearing, &at, i).x : 1.0;
    }
    t->orbit = at.orbit.x;
    t->axis = at.axis.x;
    t->share = at.share.x;
    t->rotation = end ? own_rotation(s->bearing, &at) : 0.0;
    t->moment = f.moment.x;
}

/* A ball at a place: its rolling, the rates of ball and groove centre along which its springs move, both contacts, and the sum of
 * its forces. */
typedef struct {
    Turning at;
    RaceForce inner, outer;
    double v[2], e[2], sum[2];
} Pressed;

/* Of an element, or of the full film in its place, at an approach and a rate without heights. */
static inline RaceForce contact_force(const Search *s, int race, double u, double v)
{
    const FullFilm *full = s->surface != NULL ? &s->surface->full[race] : NULL;
    RaceForce out = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    if (full == NULL || full->slope == 0.0) {
        return race_force(&s->contact[race], u + s->ball->height[race], v + s->ball->height_rate[race]);
    }
    out.force = full->force + full->slope * (u - full->approach);
    out.stiffness = full->slope;
    out.film = u;
    return out;
}

IN_PLACE void press(const Search *s, const double b[2], Pressed *p)
{
    const double *free = s->bearing->grooves.free_length, gain = s->step->gain;
    BallStep *ball = s->ball;
    double *cosine, *sine;
    int j;
    turn(s, b, at_rest(s), &p->at);
    if (at_rest(s)) {
        ball->thickness[INNER_RACE].factor = p->at.factor[INNER_RACE];
        ball->thickness[OUTER_RACE].factor = p->at.factor[OUTER_RACE];
    }
    cosine = p->at.cosine;
    sine = p->at.sine;
    for (j = 0; j < 2; j++) {
        p->v[j] = gain * (b[j] - ball->history[j]);
        p->e[j] = ball->d[j] - p->v[j];
    }
    p->inner = contact_force(s, INNER_RACE, p->at.l[INNER_RACE] - free[INNER_RACE],
                             cosine[INNER_RACE] * p->e[0] + sine[INNER_RACE] * p->e[1]);
    p->outer = contact_force(s, OUTER_RACE, p->at.l[OUTER_RACE] - free[OUTER_RACE],
                             cosine[OUTER_RACE] * p->v[0] + sine[OUTER_RACE] * p->v[1]);
    if (at_rest(s)) { /* films are looked for where they were found */
        ball->thickness[INNER_RACE].lift = p->inner.lift;
        ball->thickness[OUTER_RACE].lift = p->outer.lift;
    }
    p->sum[0] = p->at.sum[0] + p->inner.force * cosine[INNER_RACE] - p->outer.force * cosine[OUTER_RACE];
    p->sum[1] = p->at.sum[1] + p->inner.force * sine[INNER_RACE] - p->outer.force * sine[OUTER_RACE];
    for (j = 0; j < 2 && s->heavy > 0.0; j++) {
        p->sum[j] -= s->bearing->inertia * gain * (p->v[j] - ball->rate_history[j]);
    }
}

/* Leaves a ball that nothing touches at rest where it is. */
void leave_ball(const Search *s, const double b[2], const Pressed *p);

/* Slopes of the balance of a ball: of both forces by c (a, without rates) and, but for the sign, by b (h and m); how the inner force
 * turns with its spring; those of the sum by b, their determinant, and a stiffness to compare it with. */
typedef struct {
    double a[2], h[2], m[2], turn_rr, turn_rz, turn_zz, rr, rz, zr, zz, det, stiff;
} Tangents;

/* Of a ball that a contact touches above 0, even where a film that lets go has a falling force. */
static inline double stiffness_of(const Search *s, const Pressed *p)
{
    return fabs(p->inner.stiffness) + fabs(p->outer.stiffness) + s->step->gain * (fabs(p->inner.damping) + fabs(p->outer.damping)) + s->heavy;
}

/* Imbalance of a ball that one more step of Newton's method ends. */
static inline double allowed_imbalance(const Search *s, const Pressed *p)
{
    const double close = shared_by_forces(s->bearing) ? nearly_shared : nearly, least = at_rest(s) ? 0.0 : 1.0;
    return close * (least + p->inner.force + p->outer.force) + rounding * p->at.l[OUTER_RACE] * stiffness_of(s, p);
}

IN_PLACE void tangents(const Search *s, const Pressed *p, const double inertia[5][4], Tangents *t)
{
    const double gain = s->step->gain, k_i = p->inner.stiffness, k_o = p->outer.stiffness, d_i = p->inner.damping, d_o = p->outer.damping;
    const double i_r = p->at.cosine[INNER_RACE], i_z = p->at.sine[INNER_RACE], o_r = p->at.cosine[OUTER_RACE], o_z = p->at.sine[OUTER_RACE];
    const double per_i = 1.0 / p->at.l[INNER_RACE], per_o = 1.0 / p->at.l[OUTER_RACE];
    const double s_i = p->inner.force * per_i, s_o = p->outer.force * per_o;
    const double t_i = (i_r * p->e[1] - i_z * p->e[0]) * per_i, t_o = (o_r * p->v[1] - o_z * p->v[0]) * per_o;
    t->a[0] = k_i * i_r - d_i * t_i * i_z;
    t->a[1] = k_i * i_z + d_i * t_i * i_r;
    t->h[0] = t->a[0] + d_i * gain * i_r;
    t->h[1] = t->a[1] + d_i * gain * i_z;
    t->m[0] = (k_o + d_o * gain) * o_r - d_o * t_o * o_z;
    t->m[1] = (k_o + d_o * gain) * o_z + d_o * t_o * o_r;
    t->turn_rr = s_i * i_z * i_z;
    t->turn_rz = -s_i * i_r * i_z;
    t->turn_zz = s_i * i_r * i_r;
    t->rr = -i_r * t->h[0] - t->turn_rr - o_r * t->m[0] - s_o * o_z * o_z + inertia[0][0] - s->heavy;
    t->rz = -i_r * t->h[1] - t->turn_rz - o_r * t->m[1] + s_o * o_r * o_z + inertia[0][1];
    t->zr = -i_z * t->h[0] - t->turn_rz - o_z * t->m[0] + s_o * o_r * o_z + inertia[1][0];
    t->zz = -i_z * t->h[1] - t->turn_zz - o_z * t->m[1] - s_o * o_r * o_r + inertia[1][1] - s->heavy;
    t->det = t->rr * t->zz - t->rz * t->zr;
    t->stiff = stiffness_of(s, p);
}

/* `press`, not compiled in place: for searches, which are rare, so that FMUs are smaller. */
void press_ball(const Search *s, const double b[2], Pressed *p);

#endif
