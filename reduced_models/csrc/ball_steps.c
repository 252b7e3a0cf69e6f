/* Balls between two races in steps: reduced_models.bearing.ball. The ball is at b, the inner groove centre at c, moving at
 * d, see rolling.h. */
#include <math.h>
#include <string.h>

#include "bearing.h"
#include "film_filters.h"
#include "rolling.h"

enum { MOST_BALL_STEPS = 60, STALE = 5, SETTLED = 20, MOST_SETTLINGS = 60 };
enum { DOUBLED = 40, HALVED = 48 }; /* steps of a search by bisection: to a bracket, and in it */
enum { RENEWED = 16 }; /* steps after which the slopes of centrifugal force and gyroscopic moment are renewed */
static const double two_pi = 6.283185307179586;
static const double nearly = 1e-8, nearly_shared = 1e-10; /* imbalance of a ball, over its forces and 1 N, that one more step ends */
static const double first_step = 1e-7; /* m, outward, of a ball that nothing touches; doubled until a race is met */
static const double overshoot = 2.0;   /* growth of the imbalance that halves the way to the last place */
static const double longest = 0.05;    /* step over the distance of the groove centres */
static const double singular = 1e-14;
static const double settled = 1e-9; /* of the largest height: by which heights at rest may still change */
static const double beside = 0.5;      /* rad, of the angle of a ball, on either side of the line between the groove centres and of that across the shaft */
static const double rounding = 1e-15;  /* of the place of a ball: what is left of its imbalance, over its stiffness */
static const char *const no_balance = "a ball finds no balance: a shorter step, or a smaller displacement, can help";

/* A step of the bearing; `gain` leads from places to rates, by differences of second order. `angle` is that of the first ball at its
 * end, `lift` the slope of the force with losses by that without them. */
typedef struct {
    double h, gain, omega, cage, angle, lift;
    double bare[MOST_DIRECTIONS], force[MOST_DIRECTIONS]; /* of the ring on the balls, without losses of rings and fits and with them */
    SpeedRow row;
} StepHead;

/* A ball in a step: direction to it, what its rates follow from, where it is looked for. Then what it was balanced with last: c and d,
 * its place, forces of its contacts, force of the ring on it (r, z) and its moment, and their slopes by c and d, the ball
 * following. */
typedef struct {
    double x, y, history[2], rate_history[2], start[2];
    double c[2], d[2], place[2], force[2], film[2], ring[3], slopes[3][4];
    double transit[2], height[2], height_rate[2]; /* [race] of features */
    Thickness thickness[2];
} BallStep;

enum {
    STEP_NUMBERS = sizeof(StepHead) / sizeof(double),
    BALL_STEP_NUMBERS = sizeof(BallStep) / sizeof(double),
    FILTER_NUMBERS = sizeof(StepFilters) / sizeof(double)
};

typedef char step_is_numbers[sizeof(StepHead) % sizeof(double) == 0 && sizeof(StepFilters) % sizeof(double) == 0 ? 1 : -1];

size_t bearing_state_size(const Bearing *b)
{
    return shaft_place(b) + (b->heights != NULL ? 1 + (size_t)b->balls * SURFACE_NUMBERS : 0);
}

size_t bearing_work_size(const Bearing *b)
{
    const size_t filters = FILTER_NUMBERS + 3 * (size_t)b->lags;
    return STEP_NUMBERS + (size_t)b->balls * (BALL_STEP_NUMBERS + 2 * filters);
}

void bearing_sizes(size_t sizes[])
{
    sizes[0] = sizeof(Bearing);
    sizes[1] = sizeof(Grooves);
    sizes[2] = sizeof(Race);
    sizes[3] = sizeof(HeightTables);
    sizes[4] = sizeof(BearingHead);
    sizes[5] = sizeof(Ball);
    sizes[6] = sizeof(FilmState);
    sizes[7] = sizeof(BallSurface);
    sizes[8] = sizeof(StepHead);
    sizes[9] = sizeof(BallStep);
}

static StepHead *step_of(double work[])
{
    return (StepHead *)(void *)work;
}

static BallStep *ball_in(double work[], int k)
{
    return (BallStep *)(void *)(work + STEP_NUMBERS) + k;
}

static StepFilters *filters_in(const Bearing *b, double work[], int k, int race)
{
    const size_t size = FILTER_NUMBERS + 3 * (size_t)b->lags;
    return (StepFilters *)(void *)(work + STEP_NUMBERS + (size_t)b->balls * BALL_STEP_NUMBERS + (size_t)(2 * k + race) * size);
}

/* ---- one ball ---- */

/* What a ball needs to be balanced: both contacts, its mass over the square of the step. */
typedef struct {
    const Bearing *bearing;
    const StepHead *step;
    BallStep *ball;
    RaceStep contact[2];
    const Race *dry; /* of both races, for the share of the gyroscopic moment */
    const BallSurface *surface; /* NULL: no full films */
    double heavy;
} Search;

/* Rolling of a ball at b with the groove centre at c, and what acts on it beside its contacts. */
IN_PLACE BallForces roll_along(const Search *s, const Dual b[2], const Dual c[2], Rolling *at)
{
    const double *free = s->bearing->grooves.free_length;
    Dual dry[2], span[2];
    if (shared_by_forces(s->bearing)) {
        dry[INNER_RACE] = dry_compression(&s->dry[INNER_RACE], plus(inner_span(b, c, span), -free[INNER_RACE]));
        dry[OUTER_RACE] = dry_compression(&s->dry[OUTER_RACE], plus(outer_span(b), -free[OUTER_RACE]));
    }
    *at = roll(s->bearing, b, c, shared_by_forces(s->bearing) ? dry : NULL);
    return forces_on(&s->bearing->grooves, at, number(s->step->omega), number(0.0), number(0.0));
}

/* Slopes of centrifugal force and gyroscopic moment by the places of the ball and of the groove centre. */
static void renew_inertia(const Search *s, const double b[2], double slopes[5][4])
{
    const double *c = s->ball->c;
    int j;
    for (j = 0; j < 4; j++) {
        const Dual ball[2] = {dual(b[0], j == 0), dual(b[1], j == 1)}, centre[2] = {dual(c[0], j == 2), dual(c[1], j == 3)};
        Rolling at;
        const BallForces f = roll_along(s, ball, centre, &at);
        slopes[0][j] = f.sum[0].d;
        slopes[1][j] = f.sum[1].d;
        slopes[2][j] = f.ring[0].d;
        slopes[3][j] = f.ring[1].d;
        slopes[4][j] = f.moment.d;
    }
}

/* A ball at a place: its springs, its rolling, and what acts on it beside its contacts, all as in `Rolling` and `BallForces`. */
typedef struct {
    double l[2], cosine[2], sine[2], orbit, rotation, speed_sum[2], factor[2], sum[2], ring[2], moment;
} Turning;

/* Factors of films where they vary, and the rotation of the ball about its own axis, at the end of a step alone. */
static void turn(const Search *s, const double b[2], int end, Turning *t)
{
    const Dual ball[2] = {number(b[0]), number(b[1])}, centre[2] = {number(s->ball->c[0]), number(s->ball->c[1])};
    Rolling at;
    const BallForces f = roll_along(s, ball, centre, &at);
    int i;
    for (i = 0; i < 2; i++) {
        t->l[i] = at.l[i].x;
        t->cosine[i] = at.cosine[i].x;
        t->sine[i] = at.sine[i].x;
        t->speed_sum[i] = at.speed_sum[i].x;
        t->sum[i] = f.sum[i].x;
        t->ring[i] = f.ring[i].x;
        t->factor[i] = end && films_vary(s->bearing) ? film_factor(s->bearing, &at, i).x : 1.0;
    }
    t->orbit = at.orbit.x;
    t->rotation = end ? own_rotation(s->bearing, &at) : 0.0;
    t->moment = f.moment.x;
}

/* At rest between the races nothing acts on a ball. */
static void leave_ball(BallStep *ball, const double b[2])
{
    memcpy(ball->place, b, sizeof ball->place);
    memset(ball->force, 0, sizeof ball->force);
    memset(ball->ring, 0, sizeof ball->ring);
    memset(ball->slopes, 0, sizeof ball->slopes);
}

/* A ball at a place: its rolling, the rates of ball and groove centre along which its springs move, both contacts, and the sum of
 * its forces. */
typedef struct {
    Turning at;
    RaceForce inner, outer;
    double v[2], e[2], sum[2];
} Pressed;

/* Of an element, or of the full film in its place, at an approach and a rate without heights. */
static RaceForce contact_force(const Search *s, int race, double u, double v)
{
    const FullFilm *full = s->surface != NULL ? &s->surface->full[race] : NULL;
    RaceForce out;
    if (full == NULL || full->slope == 0.0) {
        return race_force(&s->contact[race], u + s->ball->height[race], v + s->ball->height_rate[race]);
    }
    out.force = full->force + full->slope * (u - full->approach);
    out.stiffness = full->slope;
    out.damping = 0.0;
    out.film = u;
    return out;
}

static void press(const Search *s, const double b[2], Pressed *p)
{
    const double *free = s->bearing->grooves.free_length, gain = s->step->gain;
    const BallStep *ball = s->ball;
    double *cosine, *sine;
    int j;
    turn(s, b, 0, &p->at);
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
    p->sum[0] = p->at.sum[0] + p->inner.force * cosine[INNER_RACE] - p->outer.force * cosine[OUTER_RACE];
    p->sum[1] = p->at.sum[1] + p->inner.force * sine[INNER_RACE] - p->outer.force * sine[OUTER_RACE];
    for (j = 0; j < 2 && s->heavy > 0.0; j++) {
        p->sum[j] -= s->bearing->inertia * gain * (p->v[j] - ball->rate_history[j]);
    }
}

/* Balances a ball from b to first order, from where its imbalance is small; returns whether there is a balance. `kept` are slopes
 * of its forces of inertia. */
static int balance_ball(const Search *s, const double start[2], const double kept[5][4])
{
    const StepHead *step = s->step;
    const double *free = s->bearing->grooves.free_length, gain = step->gain, close = shared_by_forces(s->bearing) ? nearly_shared : nearly;
    const double most = longest * (free[INNER_RACE] + free[OUTER_RACE]);
    double reach = first_step, previous = HUGE_VAL, b[2] = {start[0], start[1]}, last[2] = {start[0], start[1]}, renewed[5][4];
    BallStep *ball = s->ball;
    int i, j;
    for (i = 0; i < MOST_BALL_STEPS; i++) {
        const double (*inertia)[4] = kept;
        double i_r, i_z, o_r, o_z, l_i, l_o, *v, *e, *sum, size, s_i, s_o, t_i, t_o, k_i, k_o, d_i, d_o, det, stiff;
        double a_r, a_z, h_r, h_z, m_r, m_z, turn_rr, turn_rz, turn_zz, rr, rz, zr, zz, move[2];
        RaceForce inner, outer;
        Pressed p;
        if (i >= STALE - 1 && step->omega > 0.0) { /* a long search */
            if (i % STALE == STALE - 1) {
                renew_inertia(s, b, renewed);
            }
            inertia = (const double (*)[4])renewed;
        }
        press(s, b, &p);
        l_i = p.at.l[INNER_RACE];
        l_o = p.at.l[OUTER_RACE];
        i_r = p.at.cosine[INNER_RACE];
        i_z = p.at.sine[INNER_RACE];
        o_r = p.at.cosine[OUTER_RACE];
        o_z = p.at.sine[OUTER_RACE];
        inner = p.inner;
        outer = p.outer;
        v = p.v;
        e = p.e;
        sum = p.sum;
        size = sqrt(sum[0] * sum[0] + sum[1] * sum[1]);
        if (!isfinite(size)) {
            return 0;
        }
        k_i = inner.stiffness;
        k_o = outer.stiffness;
        d_i = inner.damping;
        d_o = outer.damping;
        ball->film[INNER_RACE] = inner.film;
        ball->film[OUTER_RACE] = outer.film;
        if (step->omega == 0.0 && s->heavy == 0.0 && inner.force == 0.0 && outer.force == 0.0 && d_i == 0.0 && d_o == 0.0) {
            leave_ball(ball, b);
            return 1;
        }
        if (size > overshoot * previous) { /* a kink lies between */
            for (j = 0; j < 2; j++) {
                b[j] = 0.5 * (b[j] + last[j]);
            }
            previous = HUGE_VAL;
            continue;
        }
        /* slopes of both forces by c and, but for the sign and the gain, by b: the springs get longer, and turn */
        s_i = inner.force / l_i;
        s_o = outer.force / l_o;
        t_i = (i_r * e[1] - i_z * e[0]) / l_i;
        t_o = (o_r * v[1] - o_z * v[0]) / l_o;
        a_r = k_i * i_r - d_i * t_i * i_z;
        a_z = k_i * i_z + d_i * t_i * i_r;
        h_r = a_r + d_i * gain * i_r;
        h_z = a_z + d_i * gain * i_z;
        m_r = (k_o + d_o * gain) * o_r - d_o * t_o * o_z;
        m_z = (k_o + d_o * gain) * o_z + d_o * t_o * o_r;
        turn_rr = s_i * i_z * i_z;
        turn_rz = -s_i * i_r * i_z;
        turn_zz = s_i * i_r * i_r;
        rr = -i_r * h_r - turn_rr - o_r * m_r - s_o * o_z * o_z + inertia[0][0] - s->heavy;
        rz = -i_r * h_z - turn_rz - o_r * m_z + s_o * o_r * o_z + inertia[0][1];
        zr = -i_z * h_r - turn_rz - o_z * m_r + s_o * o_r * o_z + inertia[1][0];
        zz = -i_z * h_z - turn_zz - o_z * m_z - s_o * o_r * o_r + inertia[1][1] - s->heavy;
        det = rr * zz - rz * zr;
        stiff = k_i + k_o + gain * (d_i + d_o) + s->heavy;
        if (stiff <= 0.0 || fabs(det) <= singular * stiff * stiff) { /* nothing touches it */
            for (j = 0; j < 2; j++) {
                b[j] += reach * sum[j] / size;
            }
            reach *= 2.0;
            previous = HUGE_VAL;
            continue;
        }
        move[0] = (rz * sum[1] - zz * sum[0]) / det;
        move[1] = (zr * sum[0] - rr * sum[1]) / det;
        if (size > close * (1.0 + inner.force + outer.force) + rounding * l_o * stiff) {
            const double cut = fmin(1.0, most / sqrt(move[0] * move[0] + move[1] * move[1]));
            for (j = 0; j < 2; j++) {
                last[j] = b[j];
                b[j] += cut * move[j];
            }
            previous = size;
            continue;
        }
        {
            /* by c and d: of the balance; then of the force of the ring, in which b follows c */
            const double w[2][4] = {{i_r * a_r + turn_rr + inertia[0][2], i_r * a_z + turn_rz + inertia[0][3], d_i * i_r * i_r, d_i * i_r * i_z},
                                    {i_z * a_r + turn_rz + inertia[1][2], i_z * a_z + turn_zz + inertia[1][3], d_i * i_r * i_z, d_i * i_z * i_z}};
            const double by_b[3][2] = {{-i_r * h_r - turn_rr + inertia[2][0], -i_r * h_z - turn_rz + inertia[2][1]},
                                       {-i_z * h_r - turn_rz + inertia[3][0], -i_z * h_z - turn_zz + inertia[3][1]},
                                       {inertia[4][0], inertia[4][1]}};
            const double ring[2] = {p.at.ring[0] + inner.force * i_r, p.at.ring[1] + inner.force * i_z};
            for (j = 0; j < 4; j++) {
                const double follow_r = (rz * w[1][j] - zz * w[0][j]) / det, follow_z = (zr * w[0][j] - rr * w[1][j]) / det;
                for (i = 0; i < 3; i++) {
                    double own = i < 2 ? w[i][j] : 0.0;
                    if (j < 2) {
                        own += i < 2 ? inertia[2 + i][2 + j] - inertia[i][2 + j] : inertia[4][2 + j];
                    }
                    ball->slopes[i][j] = own + by_b[i][0] * follow_r + by_b[i][1] * follow_z;
                }
            }
            for (i = 0; i < 3; i++) {
                ball->ring[i] = (i < 2 ? ring[i] : p.at.moment) + by_b[i][0] * move[0] + by_b[i][1] * move[1];
            }
            ball->place[0] = b[0] + move[0];
            ball->place[1] = b[1] + move[1];
            ball->force[INNER_RACE] = fmax(0.0, inner.force - h_r * move[0] - h_z * move[1]);
            ball->force[OUTER_RACE] = fmax(0.0, outer.force + m_r * move[0] + m_z * move[1]);
        }
        return 1;
    }
    return 0;
}

/* First place of a ball: on the line between the groove centres, dry contacts in balance if they touch. */
static void first_place(const Search *s, double b[2])
{
    const Bearing *bearing = s->bearing;
    const double *c = s->ball->c, omega = s->step->omega, *free = bearing->grooves.free_length, *height = s->ball->height;
    const double free_outer = free[OUTER_RACE] - height[OUTER_RACE], length = hypot(c[0], c[1]);
    const double closer = length - (free[INNER_RACE] - height[INNER_RACE]) - free_outer;
    const double ratio = pow(bearing->race[OUTER_RACE].kn / bearing->race[INNER_RACE].kn, 2.0 / 3.0);
    double outward = free_outer + closer / (1.0 + ratio);
    if (closer < 0.0 && omega > 0.0) {
        const double swing = 0.125 * omega * omega * bearing->grooves.mass * bearing->grooves.pitch;
        outward = free_outer + pow(swing / bearing->race[OUTER_RACE].kn, 2.0 / 3.0);
    }
    b[0] = outward * c[0] / length;
    b[1] = outward * c[1] / length;
}

/* Force on a ball away from the outer groove centre, at a distance from it where none acts across; its place there. */
static double push_along(const Search *s, double length, double far, double b[2])
{
    double low = fmin(far, 0.0) - beside, high = fmax(far, 0.0) + beside, angle = far, along = 0.0;
    int i;
    for (i = 0; i < HALVED; i++) {
        const double c = cos(angle), z = sin(angle);
        double across;
        Pressed p;
        b[0] = length * c;
        b[1] = length * z;
        press(s, b, &p);
        along = p.sum[0] * c + p.sum[1] * z;
        across = p.sum[1] * c - p.sum[0] * z;
        if (across == 0.0) { /* exactly, of balls between grooves in one plane, which stay in it */
            break;
        }
        if (across > 0.0) {
            low = angle;
        } else {
            high = angle;
        }
        angle = 0.5 * (low + high);
    }
    return along;
}

/* Place of a ball by bisection, for one that Newton's method loses between the races: there nothing may act on it whose slope leads
 * to the far race. The force outward falls towards the outer race, and those across with the angle. */
static void search_place(const Search *s, double b[2])
{
    const double *c = s->ball->c, far = atan2(c[1], c[0]);
    double low = s->bearing->grooves.free_length[OUTER_RACE], high = low, reach = first_step;
    int i;
    for (i = 0; i < DOUBLED && push_along(s, low, far, b) < 0.0; i++) {
        reach *= 2.0;
        low = fmax(low - reach, 0.5 * low);
    }
    reach = first_step;
    for (i = 0; i < DOUBLED && push_along(s, high, far, b) > 0.0; i++) {
        reach *= 2.0;
        high += reach;
    }
    for (i = 0; i < HALVED; i++) {
        const double middle = 0.5 * (low + high);
        if (push_along(s, middle, far, b) > 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/* ---- all balls ---- */

static void search_of(const Bearing *b, const double state[], double work[], int k, const Race races[2], Search *s)
{
    int race;
    s->bearing = b;
    s->step = step_of(work);
    s->ball = ball_in(work, k);
    s->dry = races;
    s->surface = b->heights != NULL ? surface_of(b, state, k) : NULL;
    s->heavy = b->inertia * s->step->gain * s->step->gain;
    for (race = 0; race < 2; race++) {
        RaceStep *c = &s->contact[race];
        c->race = &races[race];
        c->at = s->step->row;
        c->transit = s->ball->transit[race];
        c->film = films_vary(b) ? &s->ball->thickness[race] : NULL;
        c->before = film_of(b, state, k, race);
        c->filters = filters_in(b, work, k, race);
    }
}

/* Both races as the settings have them: dry without films. */
static void races_of(const Bearing *b, const double state[], Race races[2])
{
    int race;
    for (race = 0; race < 2; race++) {
        races[race] = b->race[race];
        if (!is_wet(b, state)) {
            races[race].nodes = 0;
        }
    }
}

/* Weight of the last two places in the rate of the next: rate = gain (place - history), by differences of second order. */
typedef struct {
    double gain, now, before; /* history = now place[0] - before place[1] */
} Differences;

static Differences differences(double h, double h_before)
{
    const double ratio = h_before > 0.0 ? h / h_before : 1.0, both = 1.0 + ratio, per = 1.0 / (1.0 + 2.0 * ratio);
    Differences d = {0.0, 0.0, 0.0};
    if (h > 0.0) {
        d.gain = (1.0 + 2.0 * ratio) / (both * h);
        d.now = both * both * per;
        d.before = ratio * ratio * per;
    }
    return d;
}

/* What a contact finds in a step: films and entrainment speeds change slowly and go on as in the last two steps. */
static void begin_contact(const Bearing *b, const Ball *old, int race, double ratio, RaceStep *c, BallStep *ball, const StepHead *step)
{
    const double change = ratio * (old->speed_sum[race][0] - old->speed_sum[race][1]), speed = film_speed(b, step->omega);
    const double middle = old->speed_sum[race][0] + 0.5 * change, end = old->speed_sum[race][0] + change;
    ball->thickness[race].factor = old->factor[race][0] + ratio * (old->factor[race][0] - old->factor[race][1]);
    ball->thickness[race].lift = old->lift[race];
    c->filters->interval = 0;
    race_at_rest(c);
    if (speed > 0.0 && step->h > 0.0) {
        c->transit = c->race->contact_length_factor / (middle * speed);
        race_prepare(c, step->h);
    }
    ball->transit[race] = speed > 0.0 ? c->race->contact_length_factor / (end * speed) : 0.0;
}

/* Height at a contact under the compression at the end of the last step, that height left out. */
static double height_at(const Bearing *b, const double state[], int k, int race, double psi, double shaft, double own)
{
    const double force = ball_of(state, k)->force[race];
    double pressed;
    if (b->heights->tables == 0) {
        return 0.0;
    }
    pressed = force > 0.0 ? pow(force / b->race[race].kn, 2.0 / 3.0) : film_of(b, state, k, race)->approach;
    return contact_height(b->heights, k, race, psi, shaft, own, pressed - surface_of(b, state, k)->height[race][0]);
}

void bearing_begin(const Bearing *b, const double state[], double work[], double h, double omega)
{
    const BearingHead *old = head_of(state);
    const double ratio = h > 0.0 ? (old->h > 0.0 ? h / old->h : 1.0) : 0.0;
    const double turns = old->cage[0] + 0.5 * ratio * (old->cage[0] - old->cage[1]);
    const Differences d = differences(h, old->h);
    const double swept = 0.5 * h * (old->omega + omega), shaft = b->heights != NULL ? state[shaft_place(b)] + swept : 0.0;
    StepHead *step = step_of(work);
    Race races[2];
    int k, j, race;
    races_of(b, state, races);
    memset(step, 0, sizeof *step);
    step->h = h;
    step->gain = d.gain;
    step->omega = omega;
    step->cage = h > 0.0 ? omega * old->cage[0] : 0.0;
    step->angle = old->angle + swept * turns;
    step->row = speed_row(b, omega);
    for (k = 0; k < b->balls; k++) {
        const double psi = step->angle + two_pi * k / b->balls, moved = old->h > 0.0 ? h / old->h : 0.0;
        const Ball *last = ball_of(state, k);
        BallStep *ball = ball_in(work, k);
        Search s;
        ball->x = cos(psi);
        ball->y = sin(psi);
        for (j = 0; j < 2; j++) {
            ball->history[j] = d.now * last->place[0][j] - d.before * last->place[1][j];
            ball->rate_history[j] = d.now * last->rate[0][j] - d.before * last->rate[1][j];
            /* A ball moves on as in the last step, however often the ring is tried: a film that lets go pulls and pushes, and a ball
             * may have several balances. Which one is found must not depend on where the ring was tried before. */
            ball->start[j] = last->place[0][j] + moved * (last->place[0][j] - last->place[1][j]);
        }
        search_of(b, state, work, k, races, &s);
        for (race = 0; race < 2; race++) {
            begin_contact(b, last, race, ratio, &s.contact[race], ball, step);
            ball->height[race] = ball->height_rate[race] = 0.0;
            if (b->heights != NULL) {
                const double *height = s.surface->height[race], own = s.surface->angle + swept * s.surface->rotation;
                ball->height[race] = h > 0.0 ? height_at(b, state, k, race, psi, shaft, own) : height[0];
                ball->height_rate[race] = d.gain * (ball->height[race] - (d.now * height[0] - d.before * height[1]));
            }
        }
    }
}

/* Inner groove centre at a ball and its velocity as the ball sees it, in a cage that turns. */
static void place_groove(const Bearing *b, const StepHead *step, const double q[], const double v[], double clearance, double offset,
                         BallStep *ball)
{
    const Grooves *g = &b->grooves;
    int j;
    ball->c[0] = g->radial - 0.5 * (clearance - g->clearance);
    ball->c[1] = g->axial + offset;
    ball->d[0] = ball->d[1] = 0.0;
    for (j = 0; j < b->directions; j++) {
        double rows[3], turned[3];
        ring_rows(g, b->direction[j], ball->x, ball->y, rows);
        ring_rows(g, b->direction[j], -ball->y, ball->x, turned);
        ball->c[0] += rows[0] * q[j];
        ball->c[1] += rows[1] * q[j];
        ball->d[0] += rows[0] * v[j] + step->cage * turned[0] * q[j];
        ball->d[1] += rows[1] * v[j] + (b->direction[j] == IN_Z ? 0.0 : step->cage * turned[1] * q[j]);
    }
}

/* Force of the seat at the end of a step through which that of the balls runs straight: losses of rings and fits. */
static void pass_seat(const Bearing *b, const double state[], StepHead *step)
{
    const double *before = state + seat_place(b, 1);
    int j, k;
    step->lift = 1.0;
    memcpy(step->force, step->bare, sizeof step->force);
    for (k = 0; k < b->filters && step->h > 0.0; k++) {
        const double *held = state + seat_place(b, 2 + k), mu = b->filter_rates[k] * step->h, left = exp(-mu), mean = -expm1(-mu) / mu;
        step->lift += b->filter_gains[k] * mean;
        for (j = 0; j < b->directions; j++) {
            const double now = left * held[j] + (mean - left) * before[j] + (1.0 - mean) * step->bare[j];
            step->force[j] += b->filter_gains[k] * (step->bare[j] - now);
        }
    }
}

const char *bearing_press(const Bearing *b, const double state[], double work[], const double q[], const double v[], double force[])
{
    const BearingSettings *settings = &head_of(state)->settings;
    StepHead *step = step_of(work);
    Race races[2];
    int k, j;
    for (j = 0; j < b->directions; j++) {
        if (!isfinite(q[j] + v[j])) {
            return "the motion of the ring must be finite";
        }
    }
    races_of(b, state, races);
    memset(step->bare, 0, sizeof step->bare);
    for (k = 0; k < b->balls; k++) {
        const double (*inertia)[4] = ball_of(state, k)->inertia;
        BallStep *ball = ball_in(work, k);
        Search s;
        int done;
        place_groove(b, step, q, v, settings->clearance, settings->offset, ball);
        search_of(b, state, work, k, races, &s);
        done = ball->start[0] != 0.0 && balance_ball(&s, ball->start, inertia);
        for (j = 0; j < 2 && !done; j++) {
            double place[2];
            (j == 0 ? first_place : search_place)(&s, place);
            done = balance_ball(&s, place, inertia);
        }
        if (!done) {
            return no_balance;
        }
        for (j = 0; j < b->directions; j++) {
            double rows[3];
            ring_rows(&b->grooves, b->direction[j], ball->x, ball->y, rows);
            step->bare[j] += rows[0] * ball->ring[0] + rows[1] * ball->ring[1] + rows[2] * ball->ring[2];
        }
    }
    pass_seat(b, state, step);
    for (j = 0; j < b->directions; j++) {
        force[j] = step->force[j];
        if (!isfinite(force[j])) {
            return "the forces are too large for a floating-point number";
        }
    }
    return NULL;
}

/* How many directions of a bearing are across the shaft: they come first, and a ball acts along them with its radial force. */
static int radial_directions(const Bearing *b)
{
    int n = 0;
    while (n < b->directions && b->direction[n] < IN_Z) {
        n++;
    }
    return n;
}

void bearing_slopes(const Bearing *b, const double work[], double stiffness[], double damping[])
{
    const StepHead *step = (const StepHead *)(const void *)work;
    const BallStep *balls = (const BallStep *)(const void *)(work + STEP_NUMBERS);
    const int n = b->directions, radial = radial_directions(b);
    int k, i, j, m;
    memset(stiffness, 0, (size_t)(n * n) * sizeof stiffness[0]);
    memset(damping, 0, (size_t)(n * n) * sizeof damping[0]);
    for (k = 0; k < b->balls; k++) {
        const BallStep *ball = &balls[k];
        double rows[MOST_DIRECTIONS][3];
        for (j = 0; j < n; j++) {
            ring_rows(&b->grooves, b->direction[j], ball->x, ball->y, rows[j]);
        }
        for (j = 0; j < n; j++) {
            const int at = j < radial ? 0 : 1; /* whether it moves the groove centre outward or along the shaft */
            double turned[3], swept, row = step->lift * rows[j][at];
            ring_rows(&b->grooves, b->direction[j], -ball->y, ball->x, turned);
            swept = b->direction[j] == IN_Z ? 0.0 : step->lift * step->cage * turned[at];
            for (m = 0; m < (radial < n ? 3 : 1); m++) {
                const double *by = ball->slopes[m], rate = by[2 + at] * row, place = by[at] * row + by[2 + at] * swept;
                for (i = m == 0 ? 0 : radial; i < (m == 0 ? radial : n); i++) {
                    stiffness[i * n + j] += rows[i][m] * place;
                    damping[i * n + j] += rows[i][m] * rate;
                }
            }
        }
    }
}

/* Moves the filters of the losses. */
static void accept_seat(const Bearing *b, double state[], const StepHead *step)
{
    double *total = state + seat_place(b, 0), *bare = state + seat_place(b, 1);
    int j, k;
    for (k = 0; k < b->filters; k++) {
        double *held = state + seat_place(b, 2 + k);
        const double mu = b->filter_rates[k] * step->h, left = exp(-mu), mean = step->h > 0.0 ? -expm1(-mu) / mu : 0.0;
        for (j = 0; j < b->directions; j++) {
            held[j] = step->h > 0.0 ? left * held[j] + (mean - left) * bare[j] + (1.0 - mean) * step->bare[j] : step->bare[j];
        }
    }
    memcpy(bare, step->bare, (size_t)b->directions * sizeof bare[0]);
    memcpy(total, step->force, (size_t)b->directions * sizeof total[0]);
}

/* Moves a ball and its films to the end of the step; returns its speed about the shaft, over that of the shaft. */
static double accept_ball(const Search *s, double state[], int k)
{
    const Bearing *b = s->bearing;
    const StepHead *step = s->step;
    const BallStep *now = s->ball;
    const int moving = step->h > 0.0;
    Ball *ball = (Ball *)(void *)(state + HEAD_NUMBERS) + k;
    Turning at;
    double v[2];
    int j, race;
    turn(s, now->place, 1, &at);
    for (j = 0; j < 2; j++) {
        v[j] = step->gain * (now->place[j] - now->history[j]);
        ball->place[1][j] = moving ? ball->place[0][j] : now->place[j];
        ball->place[0][j] = now->place[j];
        ball->rate[1][j] = moving ? ball->rate[0][j] : 0.0;
        ball->rate[0][j] = v[j];
    }
    for (race = 0; race < 2; race++) {
        const double c = at.cosine[race], z = at.sine[race], u = at.l[race] - b->grooves.free_length[race] + now->height[race];
        const double along = race == INNER_RACE ? c * (now->d[0] - v[0]) + z * (now->d[1] - v[1]) : c * v[0] + z * v[1];
        const double rate = along + now->height_rate[race];
        const double factor = at.factor[race], speed_sum = at.speed_sum[race];
        FilmState *film = (FilmState *)(void *)(state + film_place(b, k, race));
        ball->force[race] = now->force[race];
        ball->film[race] = now->film[race];
        if (moving) {
            ball->lift[race] = race_accept(&s->contact[race], u, rate, film);
        } else {
            memset(film, 0, sizeof *film + (size_t)b->lags * sizeof film->chain[0]);
            film->approach = u;
            ball->lift[race] = 0.0;
        }
        ball->factor[race][1] = moving ? ball->factor[race][0] : factor;
        ball->factor[race][0] = factor;
        ball->speed_sum[race][1] = moving ? ball->speed_sum[race][0] : speed_sum;
        ball->speed_sum[race][0] = speed_sum;
        ball->cosine[race] = c;
        ball->sine[race] = z;
    }
    if (b->heights != NULL) {
        BallSurface *surface = (BallSurface *)(void *)(state + shaft_place(b) + 1) + k;
        surface->angle += 0.5 * step->h * (head_of(state)->omega + step->omega) * surface->rotation;
        surface->rotation = at.rotation;
        for (race = 0; race < 2; race++) {
            surface->height[race][1] = moving ? surface->height[race][0] : now->height[race];
            surface->height[race][0] = now->height[race];
            if (moving && now->force[race] > surface->largest[race]) {
                surface->largest[race] = now->force[race];
            }
        }
    }
    return at.orbit;
}

void bearing_accept(const Bearing *b, double state[], double work[])
{
    BearingHead *head = (BearingHead *)(void *)state;
    const StepHead *step = step_of(work);
    double carried = 0.0, turned = 0.0, free = 0.0, cage;
    Race races[2];
    int k;
    races_of(b, state, races);
    for (k = 0; k < b->balls; k++) {
        Search s;
        double orbit;
        int inclined;
        search_of(b, state, work, k, races, &s);
        orbit = accept_ball(&s, state, k);
        carried += s.ball->force[INNER_RACE];
        turned += s.ball->force[INNER_RACE] * orbit;
        free += orbit / b->balls;
        inclined = ball_of(state, k)->sine[INNER_RACE] != 0.0 || ball_of(state, k)->sine[OUTER_RACE] != 0.0;
        if (step->omega > 0.0 && (step->h == 0.0 || (inclined && (shared_by_forces(b) || ((int)head->steps + k) % RENEWED == 0)))) {
            renew_inertia(&s, s.ball->place, ((Ball *)(void *)(state + HEAD_NUMBERS))[k].inertia);
        }
    }
    cage = carried > 0.0 ? turned / carried : free;
    head->cage[1] = step->h > 0.0 ? head->cage[0] : cage;
    head->cage[0] = cage;
    head->steps = step->h > 0.0 ? (head->steps < RENEWED - 1 ? head->steps + 1.0 : 0.0) : 0.0;
    if (b->heights != NULL) {
        state[shaft_place(b)] += 0.5 * step->h * (head->omega + step->omega);
    }
    head->angle = step->angle;
    head->omega = step->omega;
    head->h = step->h;
    accept_seat(b, state, step);
}

/* Balls that have not been placed, films of the tables; surfaces are where they were. */
static void unmoved(const Bearing *b, double state[])
{
    BearingHead *head = (BearingHead *)(void *)state;
    const BearingSettings settings = head->settings;
    int k, race;
    memset(state, 0, shaft_place(b) * sizeof state[0]);
    head->settings = settings;
    head->angle = settings.cage_angle;
    for (k = 0; k < b->balls; k++) {
        Ball *ball = (Ball *)(void *)(state + HEAD_NUMBERS) + k;
        for (race = 0; race < 2; race++) {
            ball->factor[race][0] = ball->factor[race][1] = 1.0;
            ball->speed_sum[race][0] = ball->speed_sum[race][1] = 1.0;
        }
    }
}

const char *bearing_start(const Bearing *b, const BearingSettings *settings, double state[])
{
    const int oil = b->race[INNER_RACE].nodes > 0;
    if (!(fabs(settings->clearance) <= b->largest_place)) {
        return "clearance is too large or too small for a bearing of this size";
    }
    if (settings->film != 0.0 && !(settings->film == 1.0 && oil)) {
        return oil ? "film must be 0 (dry) or 1 (with oil films)" : "film must be 0: this bearing is dry";
    }
    memset(state, 0, bearing_state_size(b) * sizeof state[0]);
    ((BearingHead *)(void *)state)->settings = *settings;
    unmoved(b, state);
    return NULL;
}

const char *bearing_check(const Bearing *b, const double q[], double omega)
{
    int j;
    if (!(omega >= 0.0)) {
        return "speed must be >= 0 rad/s";
    }
    for (j = 0; j < b->directions; j++) {
        if (!(fabs(q[j]) <= (b->direction[j] < TILT_X ? b->largest_place : b->largest_tilt))) {
            return "the inner ring is farther from the outer one than the groove of a race is deep "
                   "(a coupling with too long steps does that)";
        }
    }
    return NULL;
}

/* Looks heights up again under the loads of rest; returns whether they stay. */
static int settle_heights(const Bearing *b, double state[])
{
    double change = 0.0, most = 0.0;
    int k, race;
    for (k = 0; b->heights != NULL && b->heights->tables > 0 && k < b->balls; k++) {
        BallSurface *surface = (BallSurface *)(void *)(state + shaft_place(b) + 1) + k;
        const double psi = head_of(state)->angle + two_pi * k / b->balls;
        for (race = 0; race < 2; race++) {
            const double height = height_at(b, state, k, race, psi, state[shaft_place(b)], surface->angle);
            change = fmax(change, fabs(height - surface->height[race][0]));
            most = fmax(most, fabs(height));
            surface->height[race][0] = surface->height[race][1] = height;
        }
    }
    return change <= settled * most;
}

const char *bearing_rest(const Bearing *b, double state[], double work[], double omega, const double q[], double force[])
{
    return bearing_rest_at(b, state, work, omega, head_of(state)->settings.cage_angle, q, force);
}

const char *bearing_rest_at(const Bearing *b, double state[], double work[], double omega, double angle, const double q[],
                            double force[])
{
    static const double still[MOST_DIRECTIONS] = {0.0};
    const char *reason = NULL;
    int i;
    unmoved(b, state);
    ((BearingHead *)(void *)state)->angle = angle;
    for (i = 0; i <= MOST_SETTLINGS && reason == NULL; i++) { /* films at rest follow the angles of their balls, heights their loads */
        bearing_begin(b, state, work, 0.0, omega);
        reason = bearing_press(b, state, work, q, still, force);
        if (reason == NULL) {
            bearing_accept(b, state, work);
            if (settle_heights(b, state) && i >= SETTLED) {
                break;
            }
        }
    }
    return reason;
}

int bearing_drive(const Bearing *b, double state[], double work[], double h, double omega, int steps, const double q[],
                  const double v[], double force[], double loads[])
{
    const size_t directions = (size_t)b->directions, balls = (size_t)b->balls;
    int i, k;
    for (i = 0; i < steps; i++) {
        const size_t row = (size_t)i * directions;
        bearing_begin(b, state, work, h, omega);
        if (bearing_press(b, state, work, q + row, v + row, force + row) != NULL) {
            break;
        }
        bearing_accept(b, state, work);
        for (k = 0; k < b->balls; k++) {
            memcpy(loads + ((size_t)i * balls + (size_t)k) * 2, ball_of(state, k)->force, sizeof ball_of(state, k)->force);
        }
    }
    return i;
}
