/* Balls at contact angles in steps: reduced_models.bearing.angular_steps. The ball is at b, the inner groove centre at c, see
 * contact_angles.h. */
#include <math.h>
#include <string.h>

#include "contact_angles.h"

enum { MOST_BALL_STEPS = 60, STALE = 5, SETTLED = 20 };
static const double nearly = 1e-7, nearly_shared = 1e-10; /* imbalance of a ball, over its forces and 1 N, that one more step ends */
static const double first_step = 1e-7; /* m, outward, of a ball that nothing touches; doubled until a race is met */
static const double overshoot = 2.0;   /* growth of the imbalance that halves the way to the last place */
static const double longest = 0.05;    /* step over the distance of the groove centres */
static const double singular = 1e-14;

/* Slopes of centrifugal force and friction by the place. */
static void inertia_slopes(const BallStep *step, const double b[2], double slopes[2][2])
{
    int i, j;
    for (j = 0; j < 2; j++) {
        const Dual moved[2] = {dual(b[0], 1.0 - j), dual(b[1], j)};
        const Rolling there = roll(step->setup, moved, step->centre.c, NULL);
        const BallForces f = forces_on(&there, number(step->omega), number(0.0), number(0.0));
        for (i = 0; i < 2; i++) {
            slopes[i][j] = f.sum[i].d;
        }
    }
}

static Pressed press(const BallStep *step, const double b[2])
{
    const Dual place[2] = {number(b[0]), number(b[1])};
    Pressed p;
    int j;
    p.at = roll(step->setup, place, step->centre.c, NULL);
    for (j = 0; j < 2; j++) {
        p.l[j] = p.at.l[j].x;
        p.cosine[j] = p.at.cosine[j].x;
        p.sine[j] = p.at.sine[j].x;
        p.v[j] = step->gain * (b[j] - step->history[j]);
        p.e[j] = step->centre.d[j].x - p.v[j];
    }
    p.rate[INNER_RACE] = p.cosine[INNER_RACE] * p.e[0] + p.sine[INNER_RACE] * p.e[1];
    p.rate[OUTER_RACE] = p.cosine[OUTER_RACE] * p.v[0] + p.sine[OUTER_RACE] * p.v[1];
    p.inner = race_force(&step->contact[INNER_RACE], p.l[INNER_RACE] - INNER_FREE_LENGTH, p.rate[INNER_RACE]);
    p.outer = race_force(&step->contact[OUTER_RACE], p.l[OUTER_RACE] - OUTER_FREE_LENGTH, p.rate[OUTER_RACE]);
    p.forces = forces_on(&p.at, number(step->omega), number(p.inner.force), number(p.outer.force));
    for (j = 0; j < 2; j++) {
        p.sum[j] = p.forces.sum[j].x;
    }
    return p;
}

/* Newton's step of a ball; returns whether its tangent has an inverse. */
static int newton(const BallStep *step, const Pressed *p, double inertia[2][2], double move[2])
{
    const double i_r = p->cosine[INNER_RACE], i_z = p->sine[INNER_RACE], o_r = p->cosine[OUTER_RACE];
    const double o_z = p->sine[OUTER_RACE], gain = step->gain, d_i = p->inner.damping, d_o = p->outer.damping;
    const double s_i = p->inner.force / p->l[INNER_RACE], s_o = p->outer.force / p->l[OUTER_RACE];
    const double t_i = (i_r * p->e[1] - i_z * p->e[0]) / p->l[INNER_RACE];
    const double t_o = (o_r * p->v[1] - o_z * p->v[0]) / p->l[OUTER_RACE];
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
    move[0] = (rz * p->sum[1] - zz * p->sum[0]) / det;
    move[1] = (zr * p->sum[0] - rr * p->sum[1]) / det;
    return 1;
}

/* Balances a ball from b; returns whether there is a balance, which is then `p`. */
static int balance_ball(const BallStep *step, double b[2], Pressed *p)
{
    const double close = BY_FORCES ? nearly_shared : nearly;
    double reach = first_step, previous = HUGE_VAL, last[2], move[2] = {0.0, 0.0}, inertia[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    int i, j;
    memcpy(last, b, sizeof last);
    for (i = 0; i < MOST_BALL_STEPS; i++) {
        double size;
        *p = press(step, b);
        size = sqrt(p->sum[0] * p->sum[0] + p->sum[1] * p->sum[1]);
        if (!isfinite(size)) {
            return 0;
        }
        if (step->omega == 0.0 && p->inner.force == 0.0 && p->outer.force == 0.0 && p->inner.damping == 0.0
            && p->outer.damping == 0.0) { /* at rest between the races */
            return 1;
        }
        if ((BY_FORCES || i % STALE == 0) && step->omega > 0.0) {
            inertia_slopes(step, b, inertia);
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
                b[j] += reach * p->sum[j] / size;
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
            const double most = longest * (INNER_FREE_LENGTH + OUTER_FREE_LENGTH);
            const double cut = fmin(1.0, most / sqrt(move[0] * move[0] + move[1] * move[1]));
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
static void first_place(const BallStep *step, double b[2])
{
    const Setup *setup = step->setup;
    const Dual *c = step->centre.c;
    const double length = hypot(c[0].x, c[1].x), closer = length - INNER_FREE_LENGTH - OUTER_FREE_LENGTH;
    const double ratio = pow(setup->race[OUTER_RACE].kn / setup->race[INNER_RACE].kn, 2.0 / 3.0);
    double outward = OUTER_FREE_LENGTH + closer / (1.0 + ratio);
    int j;
    if (closer < 0.0 && step->omega > 0.0) {
        const double swing = 0.125 * step->omega * step->omega * BALL_MASS * PITCH_DIAMETER;
        outward = OUTER_FREE_LENGTH + pow(swing / setup->race[OUTER_RACE].kn, 2.0 / 3.0);
    }
    for (j = 0; j < 2; j++) {
        b[j] = outward * c[j].x / length;
    }
}

/* What a contact finds in a step: films and entrainment speeds change slowly and go on as in the last two steps. */
static void ready(const Bearing *before, int k, int race, double h, SpeedRow at, double speed, BallStep *step)
{
    const Ball *old = &before->ball[k];
    const double ratio = h > 0.0 && before->h > 0.0 ? h / before->h : h > 0.0 ? 1.0 : 0.0;
    const double change = ratio * (old->speed_sum[race][0] - old->speed_sum[race][1]);
    const double middle = old->speed_sum[race][0] + 0.5 * change, end = old->speed_sum[race][0] + change;
    RaceStep *c = &step->contact[race];
    step->film[race].factor = old->factor[race][0] + ratio * (old->factor[race][0] - old->factor[race][1]);
    step->film[race].lift = old->lift[race];
    c->race = &step->setup->race[race];
    c->at = at;
    c->film = &step->film[race];
    c->before = &before->film[k][race];
    c->filters = &step->filters[race];
    c->filters->interval = 0;
    race_at_rest(c->filters);
    c->transit = speed > 0.0 ? c->race->contact_length_factor / (middle * speed) : 0.0;
    if (h > 0.0) {
        race_prepare(c, h);
    }
    c->transit = speed > 0.0 ? c->race->contact_length_factor / (end * speed) : 0.0;
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

void balls_unmoved(Bearing *bearing)
{
    int k, race;
    memset(bearing->ball, 0, sizeof bearing->ball);
    for (k = 0; k < BALLS; k++) {
        for (race = 0; race < 2; race++) {
            bearing->ball[k].factor[race][0] = bearing->ball[k].factor[race][1] = 1.0;
            bearing->ball[k].speed_sum[race][0] = bearing->ball[k].speed_sum[race][1] = 1.0;
        }
    }
}

void balls_begin(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, BallsStep *step)
{
    const double ratio = before->h > 0.0 ? h / before->h : 1.0;
    const double turns = before->cage[0] + 0.5 * ratio * (before->cage[0] - before->cage[1]);
    const SpeedRow at = speed_row(omega);
    Differences d = {0.0, 0.0, 0.0};
    int k, j, race;
    *after = *before;
    after->angle += 0.5 * h * (before->omega + omega) * turns;
    after->omega = omega;
    after->h = h;
    if (h > 0.0) {
        d = differences(h, before->h);
    }
    step->h = h;
    step->omega = omega;
    step->cage = h > 0.0 ? omega * before->cage[0] : 0.0;
    for (k = 0; k < BALLS; k++) {
        const Ball *old = &before->ball[k];
        BallStep *ball = &step->ball[k];
        ball->setup = setup;
        ball->gain = d.gain;
        ball->omega = omega;
        for (j = 0; j < 2; j++) {
            ball->history[j] = d.now * old->place[0][j] - d.before * old->place[1][j];
        }
        place_ahead(old, h, before->h, ball->start);
        for (race = 0; race < 2; race++) {
            ready(before, k, race, h, at, film_speed(omega), ball);
        }
    }
}

const char *balls_press(BallsStep *step, Bearing *after, const double q[], const double v[], double force[])
{
    Dual place[FREEDOMS], velocity[FREEDOMS], pushed[FREEDOMS];
    int k, j;
    for (j = 0; j < FREEDOMS; j++) {
        place[j] = number(q[j]);
        velocity[j] = number(v[j]);
        pushed[j] = number(0.0);
    }
    for (k = 0; k < BALLS; k++) {
        BallStep *ball = &step->ball[k];
        int attempt, done = 0;
        ball->centre = groove_centre(ball->setup, place, velocity, number(after->angle), number(step->cage), k);
        memcpy(ball->place, ball->start, sizeof ball->place);
        for (attempt = ball->place[0] == 0.0 ? 1 : 0; attempt < 2 && !done; attempt++) {
            if (attempt == 1) {
                first_place(ball, ball->place);
            }
            done = balance_ball(ball, ball->place, &ball->found);
        }
        if (!done) {
            return "a ball finds no balance: a shorter step, or a smaller displacement, can help";
        }
        add_to_ring(&ball->centre, &ball->found.forces, pushed);
    }
    for (j = 0; j < FREEDOMS; j++) {
        force[j] = pushed[j].x;
    }
    return NULL;
}

/* Forces of a ball along a direction of its place and of the groove centre, place and velocity. */
static BallForces forces_along(const BallStep *step, const double moved[6])
{
    const Pressed *p = &step->found;
    const Dual b[2] = {dual(step->place[0], moved[0]), dual(step->place[1], moved[1])};
    const Dual c[2] = {dual(step->centre.c[0].x, moved[2]), dual(step->centre.c[1].x, moved[3])};
    const Rolling at = roll(step->setup, b, c, NULL);
    Dual force[2];
    int race;
    for (race = 0; race < 2; race++) {
        const RaceForce *f = race == INNER_RACE ? &p->inner : &p->outer;
        Dual rate = number(0.0);
        int j;
        for (j = 0; j < 2; j++) {
            const double by_ball = step->gain * moved[j];
            const Dual along = race == INNER_RACE ? dual(p->e[j], moved[4 + j] - by_ball) : dual(p->v[j], by_ball);
            rate = add(rate, mul(j == 0 ? at.cosine[race] : at.sine[race], along));
        }
        force[race] = dual(f->force, f->stiffness * at.l[race].d + f->damping * rate.d);
    }
    return forces_on(&at, number(step->omega), force[INNER_RACE], force[OUTER_RACE]);
}

/* Force of the ring on a ball (r, z) and its moment by place and velocity of the groove centre, the ball following. */
static void ball_slopes(const BallStep *step, double slopes[3][4])
{
    const RaceForce *f_i = &step->found.inner, *f_o = &step->found.outer;
    const double stiff = f_i->stiffness + f_o->stiffness + step->gain * (f_i->damping + f_o->damping);
    BallForces by[6];
    double det;
    int i, j;
    for (j = 0; j < 6; j++) {
        double moved[6] = {0.0};
        moved[j] = 1.0;
        by[j] = forces_along(step, moved);
    }
    det = by[0].sum[0].d * by[1].sum[1].d - by[1].sum[0].d * by[0].sum[1].d;
    for (j = 0; j < 4; j++) {
        const Dual *off = by[2 + j].sum;
        double follow[2] = {0.0, 0.0};
        if (fabs(det) > singular * stiff * stiff) {
            follow[0] = (by[1].sum[0].d * off[1].d - by[1].sum[1].d * off[0].d) / det;
            follow[1] = (by[0].sum[1].d * off[0].d - by[0].sum[0].d * off[1].d) / det;
        }
        for (i = 0; i < 2; i++) {
            slopes[i][j] = by[2 + j].ring[i].d + by[0].ring[i].d * follow[0] + by[1].ring[i].d * follow[1];
        }
        slopes[2][j] = by[2 + j].moment.d + by[0].moment.d * follow[0] + by[1].moment.d * follow[1];
    }
}

void balls_slopes(const BallsStep *step, RingSlopes *slopes)
{
    int k, i, j, m;
    memset(slopes, 0, sizeof *slopes);
    for (k = 0; k < BALLS; k++) {
        const double x = step->ball[k].centre.x.x, y = step->ball[k].centre.y.x, lever = GROOVE_CIRCLE, cage = step->cage;
        const double rows[3][FREEDOMS] = {
            {x, y, 0.0, 0.0, 0.0}, {0.0, 0.0, 1.0, lever * y, -lever * x}, {0.0, 0.0, 0.0, -y, x}};
        const double swept[2][FREEDOMS] = {{-cage * y, cage * x, 0.0, 0.0, 0.0},
                                           {0.0, 0.0, 0.0, cage * lever * x, cage * lever * y}};
        double by[3][4];
        ball_slopes(&step->ball[k], by);
        for (m = 0; m < 3; m++) {
            for (j = 0; j < FREEDOMS; j++) {
                const double rate = by[m][2] * rows[0][j] + by[m][3] * rows[1][j];
                const double place = by[m][0] * rows[0][j] + by[m][1] * rows[1][j] + by[m][2] * swept[0][j] + by[m][3] * swept[1][j];
                for (i = 0; i < FREEDOMS; i++) {
                    slopes->stiffness[i][j] += rows[m][i] * place;
                    slopes->damping[i][j] += rows[m][i] * rate;
                }
            }
        }
    }
}

void balls_accept(const BallsStep *step, const Bearing *before, Bearing *after)
{
    const double h = step->h;
    double orbit[BALLS];
    int k, j, race;
    for (k = 0; k < BALLS; k++) {
        const BallStep *in_step = &step->ball[k];
        const Pressed *p = &in_step->found;
        const Ball *old = &before->ball[k];
        Ball *ball = &after->ball[k];
        Dual factor[2];
        film_factors(&p->at, factor);
        orbit[k] = p->at.orbit.x;
        ball->force[INNER_RACE] = p->inner.force;
        ball->force[OUTER_RACE] = p->outer.force;
        ball->film[INNER_RACE] = p->inner.film;
        ball->film[OUTER_RACE] = p->outer.film;
        for (j = 0; j < 2; j++) {
            ball->place[1][j] = h > 0.0 ? old->place[0][j] : in_step->place[j];
            ball->place[0][j] = in_step->place[j];
            ball->rate[j] = h > 0.0 ? p->v[j] : 0.0;
        }
        for (race = 0; race < 2; race++) {
            const double u = p->l[race] - (race == INNER_RACE ? INNER_FREE_LENGTH : OUTER_FREE_LENGTH);
            FilmState *film = &after->film[k][race];
            if (h > 0.0) {
                ball->lift[race] = race_accept(&in_step->contact[race], u, p->rate[race], film);
            } else {
                memset(film, 0, sizeof *film);
                film->approach = u;
                ball->lift[race] = 0.0;
            }
            ball->factor[race][1] = h > 0.0 ? old->factor[race][0] : factor[race].x;
            ball->factor[race][0] = factor[race].x;
            ball->speed_sum[race][1] = h > 0.0 ? old->speed_sum[race][0] : p->at.speed_sum[race].x;
            ball->speed_sum[race][0] = p->at.speed_sum[race].x;
            ball->angle[race] = atan2(p->sine[race], p->cosine[race]);
        }
    }
    after->cage[1] = h > 0.0 ? before->cage[0] : cage_of(after, orbit);
    after->cage[0] = cage_of(after, orbit);
}

const char *balls_step(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, const double q[],
                       const double v[], double force[])
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

const char *balls_rest(const Setup *setup, Bearing *bearing, double omega, const double q[], double force[])
{
    static const double still[FREEDOMS] = {0.0};
    const char *reason = NULL;
    int i;
    balls_unmoved(bearing);
    for (i = 0; i <= SETTLED && reason == NULL; i++) { /* films at rest follow the angles of their balls */
        const Bearing before = *bearing;
        reason = balls_step(setup, &before, bearing, 0.0, omega, q, still, force);
    }
    return reason;
}
