/* Balls at contact angles: reduced_models.bearing.angular_steps and contact_angles. In the plane through a ball and the axis of
 * the bearing, r outward and z along the shaft, the outer groove centre is the origin, that of the inner groove is at c and the
 * ball at b: two springs in series, l_i = |c - b| and l_o = |b|. */
#include <math.h>
#include <string.h>

#include "balls.h"

enum { MOST_STEPS = 60, STALE = 5, SETTLED = 20 };
enum { OUTER_CONTROL, INNER_CONTROL, SHARED_CONTROL, HARRIS_CONTROL };
static const double two_pi = 6.283185307179586;
static const double nearly = 1e-7, nearly_shared = 1e-10; /* imbalance of a ball, over its forces and 1 N, that one more step ends */
static const double first_step = 1e-7; /* m, outward, of a ball that nothing touches; doubled until a race is met */
static const double overshoot = 2.0;   /* growth of the imbalance that halves the way to the last place */
static const double longest = 0.05;    /* step over the distance of the groove centres */
static const double singular = 1e-14;
static const double least_cosine = 0.45, least_drive = 0.1, of_outer = 0.01, tiny = 1e-20;
static const double by_speed = 0.67, by_radius = 0.464; /* film over speed and radius (Hamrock and Dowson 1977) */
static const double gamma_ratio = BALL_DIAMETER / PITCH_DIAMETER;
static const int by_forces = RACE_CONTROL == INNER_CONTROL || RACE_CONTROL == SHARED_CONTROL; /* races share the moment so */

/* Ball between two races. Angular speeds over that of the shaft, entrainment speeds over it [m]. */
typedef struct {
    double l[2], cosine[2], sine[2]; /* inner and outer spring */
    double orbit, turn, sin_b, share, entrained[2];
} Rolling;

/* The vector along the inner spring: its groove never pulls a ball inward. Returns its length. */
static double inner_span(const double b[2], const double c[2], double s[2])
{
    s[0] = c[0] - b[0];
    s[1] = c[1] - b[1];
    if (s[0] < 0.0) {
        s[0] = 0.0;
    }
    return sqrt(s[0] * s[0] + s[1] * s[1] + tiny * tiny);
}

static void rolls_at(double *cosine, double *sine)
{
    if (*cosine < least_cosine) {
        const double most = sqrt(1.0 - least_cosine * least_cosine);
        *cosine = least_cosine;
        *sine = *sine >= 0.0 ? most : -most;
    }
}

/* Angles and speeds of a ball; `pressed` are dry compressions under the forces of both contacts. */
static Rolling roll(const double b[2], const double c[2], const double pressed[2])
{
    const double g = gamma_ratio;
    double s[2], c_i, s_i, c_o, s_o, slope, cos_b, r_i, r_o, by_i, by_o;
    Rolling at;
    at.l[INNER_RACE] = inner_span(b, c, s);
    at.l[OUTER_RACE] = sqrt(b[0] * b[0] + b[1] * b[1]);
    c_i = at.cosine[INNER_RACE] = s[0] / at.l[INNER_RACE];
    s_i = at.sine[INNER_RACE] = s[1] / at.l[INNER_RACE];
    c_o = at.cosine[OUTER_RACE] = b[0] / at.l[OUTER_RACE];
    s_o = at.sine[OUTER_RACE] = b[1] / at.l[OUTER_RACE];
    rolls_at(&c_i, &s_i);
    rolls_at(&c_o, &s_o);
    at.share = 0.0;
    if (by_forces && pressed[INNER_RACE] > 0.0) {
        const double ratio = OUTER_TORSION * pressed[OUTER_RACE] * pressed[OUTER_RACE]
                             / (INNER_TORSION * pressed[INNER_RACE] * pressed[INNER_RACE]);
        const double faded = of_outer * ratio;
        at.share = 1.0 / (1.0 + (RACE_CONTROL == SHARED_CONTROL ? ratio : faded * faded));
    }
    slope = (1.0 - at.share) * s_o / (c_o + g) + at.share * s_i / (c_i - g);
    cos_b = 1.0 / sqrt(1.0 + slope * slope);
    r_i = 1.0 - g * c_i;
    r_o = 1.0 + g * c_o;
    by_i = fmax((c_i + slope * s_i) / r_i, least_drive);
    by_o = fmax((c_o + slope * s_o) / r_o, least_drive);
    at.orbit = by_o / (by_i + by_o);
    at.turn = 1.0 / (g * cos_b * (by_i + by_o));
    at.sin_b = slope * cos_b;
    at.entrained[INNER_RACE] = (1.0 - at.orbit) * PITCH_DIAMETER * r_i;
    at.entrained[OUTER_RACE] = at.orbit * PITCH_DIAMETER * r_o;
    return at;
}

/* Films at both races over those of the tables. */
static void film_factors(const Rolling *at, double factor[2])
{
    const double nominal = gamma_ratio * TABLE_COSINE, u = 0.5 * PITCH_DIAMETER * (1.0 - nominal * nominal);
    const double r_i = at->entrained[INNER_RACE] / ((1.0 - at->orbit) * PITCH_DIAMETER);
    const double r_o = at->entrained[OUTER_RACE] / (at->orbit * PITCH_DIAMETER);
    factor[INNER_RACE] = pow(at->entrained[INNER_RACE] / u, by_speed) * pow(r_i / (1.0 - nominal), by_radius);
    factor[OUTER_RACE] = pow(at->entrained[OUTER_RACE] / u, by_speed) * pow(r_o / (1.0 + nominal), by_radius);
}

/* Forces on a ball: all of them, that of the inner ring, and its moment about the inner groove centre. */
typedef struct {
    double sum[2], ring[2], moment;
} BallForces;

static BallForces forces_on(const Rolling *at, double omega, double f_i, double f_o)
{
    const double speed = at->orbit * omega, centrifugal = BALL_MASS * 0.5 * PITCH_DIAMETER * speed * speed;
    const double drag = 0.2 * GYROSCOPIC * BALL_MASS * BALL_DIAMETER * speed * at->turn * omega * at->sin_b;
    const double t_i = at->share * drag, t_o = -(1.0 - at->share) * drag;
    const double *cosine = at->cosine, *sine = at->sine;
    BallForces f;
    f.ring[0] = f_i * cosine[INNER_RACE] - t_i * sine[INNER_RACE];
    f.ring[1] = f_i * sine[INNER_RACE] + t_i * cosine[INNER_RACE];
    f.sum[0] = f.ring[0] - f_o * cosine[OUTER_RACE] - t_o * sine[OUTER_RACE] + centrifugal;
    f.sum[1] = f.ring[1] - f_o * sine[OUTER_RACE] + t_o * cosine[OUTER_RACE];
    f.moment = GROOVE_RADIUS * t_i;
    return f;
}

/* One ball in a step. */
typedef struct {
    RaceStep contact[2];
    Thickness film[2];
    StepFilters filters[2];
    double gain, history[2], omega;
    double c[2], d[2]; /* inner groove centre and its velocity */
} BallStep;

/* Dry compressions that share the gyroscopic moment, by the tables of the lowest speed. */
static void compressions(const BallStep *step, const double b[2], double pressed[2])
{
    static const SpeedRow lowest = {0, 0.0, 0.0};
    double s[2], slope, lift;
    int race;
    pressed[INNER_RACE] = pressed[OUTER_RACE] = 0.0;
    if (!by_forces) {
        return;
    }
    for (race = 0; race < 2; race++) {
        const double l = race == INNER_RACE ? inner_span(b, step->c, s) : sqrt(b[0] * b[0] + b[1] * b[1]);
        RaceStep c = step->contact[race];
        StepFilters filters;
        filters.interval = 0;
        c.at = lowest;
        c.film = NULL;
        c.filters = &filters;
        pressed[race] = race_gap(&c, l - (race == INNER_RACE ? INNER_REACH : OUTER_REACH), &slope, &lift);
    }
}

/* Slopes of centrifugal force and friction by the place, of a ball that rolls there as in `here`. */
static void inertia_slopes(const BallStep *step, const double b[2], const Rolling *here, double slopes[2][2])
{
    const double by = 1e-7 * (INNER_REACH + OUTER_REACH);
    const BallForces at = forces_on(here, step->omega, 0.0, 0.0);
    int i, j;
    for (j = 0; j < 2; j++) {
        double moved[2], pressed[2];
        Rolling there;
        BallForces f;
        memcpy(moved, b, sizeof moved);
        moved[j] += by;
        compressions(step, moved, pressed);
        there = roll(moved, step->c, pressed);
        f = forces_on(&there, step->omega, 0.0, 0.0);
        for (i = 0; i < 2; i++) {
            slopes[i][j] = (f.sum[i] - at.sum[i]) / by;
        }
    }
}

/* Both contacts and all forces of a ball at b. */
typedef struct {
    Rolling at;
    RaceForce inner, outer;
    BallForces forces;
    double e[2], v[2], rate[2]; /* velocities along which the springs move; of both approaches */
} Pressed;

static Pressed press(const BallStep *step, const double b[2])
{
    double pressed[2];
    Pressed p;
    int j;
    compressions(step, b, pressed);
    p.at = roll(b, step->c, pressed);
    for (j = 0; j < 2; j++) {
        p.v[j] = step->gain * (b[j] - step->history[j]);
        p.e[j] = step->d[j] - p.v[j];
    }
    p.rate[INNER_RACE] = p.at.cosine[INNER_RACE] * p.e[0] + p.at.sine[INNER_RACE] * p.e[1];
    p.rate[OUTER_RACE] = p.at.cosine[OUTER_RACE] * p.v[0] + p.at.sine[OUTER_RACE] * p.v[1];
    p.inner = race_force(&step->contact[INNER_RACE], p.at.l[INNER_RACE] - INNER_REACH, p.rate[INNER_RACE]);
    p.outer = race_force(&step->contact[OUTER_RACE], p.at.l[OUTER_RACE] - OUTER_REACH, p.rate[OUTER_RACE]);
    p.forces = forces_on(&p.at, step->omega, p.inner.force, p.outer.force);
    return p;
}

/* Newton's step of a ball; returns whether its tangent has an inverse. */
static int newton(const BallStep *step, const Pressed *p, double inertia[2][2], double move[2])
{
    const double i_r = p->at.cosine[INNER_RACE], i_z = p->at.sine[INNER_RACE], o_r = p->at.cosine[OUTER_RACE];
    const double o_z = p->at.sine[OUTER_RACE], gain = step->gain, d_i = p->inner.damping, d_o = p->outer.damping;
    const double s_i = p->inner.force / p->at.l[INNER_RACE], s_o = p->outer.force / p->at.l[OUTER_RACE];
    const double t_i = (i_r * p->e[1] - i_z * p->e[0]) / p->at.l[INNER_RACE];
    const double t_o = (o_r * p->v[1] - o_z * p->v[0]) / p->at.l[OUTER_RACE];
    const double k_i = p->inner.stiffness + gain * d_i, k_o = p->outer.stiffness + gain * d_o;
    const double h_r = k_i * i_r - d_i * t_i * i_z, h_z = k_i * i_z + d_i * t_i * i_r;
    const double m_r = k_o * o_r - d_o * t_o * o_z, m_z = k_o * o_z + d_o * t_o * o_r;
    const double rr = -i_r * h_r - s_i * i_z * i_z - o_r * m_r - s_o * o_z * o_z + inertia[0][0];
    const double rz = -i_r * h_z + s_i * i_r * i_z - o_r * m_z + s_o * o_r * o_z + inertia[0][1];
    const double zr = -i_z * h_r + s_i * i_r * i_z - o_z * m_r + s_o * o_r * o_z + inertia[1][0];
    const double zz = -i_z * h_z - s_i * i_r * i_r - o_z * m_z - s_o * o_r * o_r + inertia[1][1];
    const double det = rr * zz - rz * zr, stiff = k_i + k_o;
    if (stiff <= 0.0 || fabs(det) <= singular * stiff * stiff) {
        return 0;
    }
    move[0] = (rz * p->forces.sum[1] - zz * p->forces.sum[0]) / det;
    move[1] = (zr * p->forces.sum[0] - rr * p->forces.sum[1]) / det;
    return 1;
}

/* Balances a ball from b; returns whether there is a balance, which is then `p`. */
static int balance(const BallStep *step, double b[2], Pressed *p)
{
    const double close = by_forces ? nearly_shared : nearly;
    double reach = first_step, previous = HUGE_VAL, last[2], move[2] = {0.0, 0.0}, inertia[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    int i, j;
    memcpy(last, b, sizeof last);
    for (i = 0; i < MOST_STEPS; i++) {
        double size;
        *p = press(step, b);
        size = sqrt(p->forces.sum[0] * p->forces.sum[0] + p->forces.sum[1] * p->forces.sum[1]);
        if (!isfinite(size)) {
            return 0;
        }
        if (step->omega == 0.0 && p->inner.force == 0.0 && p->outer.force == 0.0 && p->inner.damping == 0.0
            && p->outer.damping == 0.0) { /* at rest between the races */
            return 1;
        }
        if ((by_forces || i % STALE == 0) && step->omega > 0.0) {
            inertia_slopes(step, b, &p->at, inertia);
        }
        if (size > overshoot * previous) { /* a kink lies between */
            for (j = 0; j < 2; j++) {
                b[j] = 0.5 * (b[j] + last[j]);
            }
            previous = HUGE_VAL;
            continue;
        }
        if (!newton(step, p, inertia, move)) { /* nothing touches it */
            for (j = 0; j < 2; j++) {
                b[j] += reach * p->forces.sum[j] / size;
            }
            reach *= 2.0;
            previous = HUGE_VAL;
            continue;
        }
        if (size <= close * (1.0 + p->inner.force + p->outer.force)) {
            for (j = 0; j < 2; j++) {
                b[j] += move[j];
            }
            *p = press(step, b);
            return 1;
        }
        {
            const double cut = fmin(1.0, longest * (INNER_REACH + OUTER_REACH) / sqrt(move[0] * move[0] + move[1] * move[1]));
            for (j = 0; j < 2; j++) {
                last[j] = b[j];
                b[j] += cut * move[j];
            }
            previous = size;
        }
    }
    return 0;
}

/* First place of a ball: on the line between the groove centres, dry contacts in balance if they touch. */
static void first_place(const Setup *setup, const BallStep *step, double b[2])
{
    const double length = hypot(step->c[0], step->c[1]), closer = length - INNER_REACH - OUTER_REACH;
    const double ratio = pow(setup->race[OUTER_RACE].kn / setup->race[INNER_RACE].kn, 2.0 / 3.0);
    double outward = OUTER_REACH + closer / (1.0 + ratio);
    int j;
    if (closer < 0.0 && step->omega > 0.0) {
        const double swing = 0.125 * step->omega * step->omega * BALL_MASS * PITCH_DIAMETER;
        outward = OUTER_REACH + pow(swing / setup->race[OUTER_RACE].kn, 2.0 / 3.0);
    }
    for (j = 0; j < 2; j++) {
        b[j] = outward * step->c[j] / length;
    }
}

/* Inner groove centre at a ball at psi, and its velocity, seen in the plane of the ball. */
static void groove_centre(const Setup *setup, double psi, double cage, const double q[], const double v[], BallStep *step)
{
    const double c = cos(psi), s = sin(psi), lever = GROOVE_LEVER;
    step->c[0] = FREE_RADIAL - 0.5 * setup->clearance + c * q[0] + s * q[1];
    step->c[1] = FREE_AXIAL + q[2] + lever * (s * q[3] - c * q[4]);
    step->d[0] = c * v[0] + s * v[1] + cage * (c * q[1] - s * q[0]);
    step->d[1] = v[2] + lever * (s * v[3] - c * v[4]) + cage * lever * (c * q[3] + s * q[4]);
}

/* What a contact finds in a step: films and entrainment speeds change slowly and go on as in the last two steps. */
static void ready(const Setup *setup, const Bearing *before, int k, int race, double h, SpeedRow at, double speed,
                  BallStep *step)
{
    const Ball *old = &before->ball[k];
    const double ratio = h > 0.0 && before->h > 0.0 ? h / before->h : h > 0.0 ? 1.0 : 0.0;
    const double change = ratio * (old->entrained[race][0] - old->entrained[race][1]);
    const double middle = old->entrained[race][0] + 0.5 * change, end = old->entrained[race][0] + change;
    RaceStep *c = &step->contact[race];
    step->film[race].factor = old->factor[race][0] + ratio * (old->factor[race][0] - old->factor[race][1]);
    step->film[race].lift = old->lift[race];
    c->race = &setup->race[race];
    c->at = at;
    c->film = &step->film[race];
    c->before = &before->film[k][race];
    c->filters = &step->filters[race];
    c->filters->interval = 0;
    race_at_rest(c->filters);
    c->transit = speed > 0.0 ? c->race->reach / (middle * speed) : 0.0;
    if (h > 0.0) {
        race_prepare(c, h);
    }
    c->transit = speed > 0.0 ? c->race->reach / (end * speed) : 0.0;
}

/* Speed of the cage over that of the shaft, in which balls stand by their loads. */
static double cage_of(const Bearing *bearing, const double orbit[BALLS])
{
    double carried = 0.0, turned = 0.0, free = 0.0;
    int k;
    for (k = 0; k < BALLS; k++) {
        carried += bearing->ball[k].force[INNER_RACE];
        turned += bearing->ball[k].force[INNER_RACE] * orbit[k];
        free += orbit[k] / BALLS;
    }
    return carried > 0.0 ? turned / carried : free;
}

/* All balls with the ring at q, moving at v; h = 0: at rest. */
static const char *press_all(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega,
                             const double q[], const double v[], double force[])
{
    const double cage = h > 0.0 ? omega * before->cage[0] : 0.0;
    const SpeedRow at = speed_row(omega);
    double orbit[BALLS];
    Differences d = {0.0, 0.0, 0.0};
    int k, j, race;
    if (h > 0.0) {
        d = differences(h, before->h);
    }
    memset(force, 0, FREEDOMS * sizeof force[0]);
    for (k = 0; k < BALLS; k++) {
        const double psi = after->angle + two_pi * k / BALLS, c = cos(psi), s = sin(psi);
        const Ball *old = &before->ball[k];
        Ball *ball = &after->ball[k];
        BallStep step;
        Pressed p;
        double b[2], factor[2];
        int attempt, done = 0;
        step.gain = d.gain;
        step.omega = omega;
        for (j = 0; j < 2; j++) {
            step.history[j] = d.now * old->place[0][j] - d.before * old->place[1][j];
            b[j] = old->place[0][j];
        }
        groove_centre(setup, psi, cage, q, v, &step);
        for (race = 0; race < 2; race++) {
            ready(setup, before, k, race, h, at, film_speed(omega), &step);
        }
        for (attempt = b[0] == 0.0 ? 1 : 0; attempt < 2 && !done; attempt++) {
            if (attempt == 1) {
                first_place(setup, &step, b);
            }
            done = balance(&step, b, &p);
        }
        if (!done) {
            return "a ball finds no balance: a shorter step, or a smaller displacement, can help";
        }
        film_factors(&p.at, factor);
        orbit[k] = p.at.orbit;
        ball->force[INNER_RACE] = p.inner.force;
        ball->force[OUTER_RACE] = p.outer.force;
        ball->film[INNER_RACE] = p.inner.film;
        ball->film[OUTER_RACE] = p.outer.film;
        for (j = 0; j < 2; j++) {
            ball->place[1][j] = h > 0.0 ? old->place[0][j] : b[j];
            ball->place[0][j] = b[j];
        }
        for (race = 0; race < 2; race++) {
            const double u = p.at.l[race] - (race == INNER_RACE ? INNER_REACH : OUTER_REACH);
            FilmState *film = &after->film[k][race];
            if (h > 0.0) {
                ball->lift[race] = race_accept(&step.contact[race], u, p.rate[race], film);
            } else {
                memset(film, 0, sizeof *film);
                film->approach = u;
                ball->lift[race] = 0.0;
            }
            ball->factor[race][1] = h > 0.0 ? old->factor[race][0] : factor[race];
            ball->factor[race][0] = factor[race];
            ball->entrained[race][1] = h > 0.0 ? old->entrained[race][0] : p.at.entrained[race];
            ball->entrained[race][0] = p.at.entrained[race];
            ball->angle[race] = atan2(p.at.sine[race], p.at.cosine[race]);
        }
        force[0] += c * p.forces.ring[0];
        force[1] += s * p.forces.ring[0];
        force[2] += p.forces.ring[1];
        force[3] += GROOVE_LEVER * s * p.forces.ring[1] - s * p.forces.moment;
        force[4] += -GROOVE_LEVER * c * p.forces.ring[1] + c * p.forces.moment;
    }
    after->cage[1] = h > 0.0 ? before->cage[0] : cage_of(after, orbit);
    after->cage[0] = cage_of(after, orbit);
    return NULL;
}

const char *balls_step(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, const double q[],
                       const double v[], double force[])
{
    const double ratio = before->h > 0.0 ? h / before->h : 1.0;
    const double cage = before->cage[0] + 0.5 * ratio * (before->cage[0] - before->cage[1]);
    *after = *before;
    after->angle += 0.5 * h * (before->omega + omega) * cage;
    after->omega = omega;
    after->h = h;
    return press_all(setup, before, after, h, omega, q, v, force);
}

const char *balls_rest(const Setup *setup, Bearing *bearing, double omega, const double q[], double force[])
{
    static const double still[FREEDOMS] = {0.0};
    const char *reason = NULL;
    int i, k, race;
    memset(bearing->ball, 0, sizeof bearing->ball);
    for (k = 0; k < BALLS; k++) {
        for (race = 0; race < 2; race++) {
            bearing->ball[k].factor[race][0] = bearing->ball[k].factor[race][1] = 1.0;
            bearing->ball[k].entrained[race][0] = bearing->ball[k].entrained[race][1] = 1.0;
        }
    }
    bearing->omega = omega;
    bearing->h = 0.0;
    for (i = 0; i <= SETTLED && reason == NULL; i++) { /* films at rest follow the angles of their balls */
        const Bearing before = *bearing;
        reason = press_all(setup, &before, bearing, 0.0, omega, q, still, force);
    }
    return reason;
}
