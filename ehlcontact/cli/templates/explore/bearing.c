/* A ball bearing for the page of `ehlcontact explore`, on the C core of reduced_models/csrc: tables of its races from their static
 * curves, its ring at rest under a load, stiffness and damping of a small vibration about there. All that the page passes in and reads
 * are numbers; JavaScript calls what is marked EXPORT. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bearing_support.h"
#include "race_table.h"
#include "rotor.h"

#define EXPORT __attribute__((visibility("default")))

enum { AXES = 3, MOST_NODES = 512, OF_BALL = sizeof(BallAtRest) / sizeof(double) };

/* Of reduced_models.bearing.race_table and .coefficients. */
static const double widest_gap = 4e-3, spacing = 0.35, overload = 64.0, tiny_omega = 1e-3, small_omega = 1e-5;
/* Of reduced_models.bearing.ring and .freedoms: steps in which gyroscopic moments grow; the farthest that a ring may be, over a ball. */
static const double smallest_share = 0.02, farthest = 0.1;
/* Imbalance over the load that ends the search, and the load [N] that no load counts as: balls press each other without one too. */
static const double balanced = 1e-12, least_load = 1.0;

typedef struct {
    Bearing bearing;
    Support support;
    const Support *supports[1];
    Rotor rotor;
    int first;
    double settings[4], omega, gyroscopic;
    int control;
    double eye[AXES * AXES], still[AXES], ones[AXES], load[AXES];
    double *state, *work, *bearing_work;
    /* For the page: the ring, the force on its balls and the slopes of this, and what `bearing_describe` has of every ball. */
    double ring[AXES], force[AXES], stiffness[AXES * AXES];
    BallAtRest *balls;
    double *geometric;
} Explored;

EXPORT double *numbers(size_t count)
{
    return (double *)calloc(count, sizeof(double));
}

/* `grooves` has the numbers of `Grooves` in their order. */
EXPORT Explored *bearing_new(int balls, int directions, int control, double omega, const double grooves[])
{
    Explored *e = (Explored *)calloc(1, sizeof *e);
    Bearing *b = &e->bearing;
    int i;
    memcpy(&b->grooves, grooves, sizeof b->grooves);
    e->omega = omega;
    e->gyroscopic = b->grooves.gyroscopic;
    e->control = control;
    b->directions = directions;
    for (i = 0; i < directions; i++) {
        b->direction[i] = i;
    }
    b->balls = balls;
    b->speeds = 1;
    b->speed = &e->omega;
    b->control = control;
    b->most_speed = b->most_load[0] = b->most_load[1] = HUGE_VAL;
    b->largest_place = farthest * b->grooves.ball;
    b->largest_tilt = 1.0;
    return e;
}

/* Nodes of ln F of a table: those of the curve with others between, down to the widest gap and up to the overload. */
static int table_nodes(const FilmLaw *law, double length, double x[])
{
    double ends[MOST_NODES];
    int count = 0, i, j, n = 0;
    ends[0] = law->x[0];
    while (film_under(law, ends[0]) * length < widest_gap) {
        ends[0] -= spacing;
    }
    count = ends[0] < law->x[0] ? 1 : 0;
    for (i = 0; i < law->nodes; i++) {
        ends[count++] = law->x[i];
    }
    ends[count++] = law->x[law->nodes - 1] + log(overload);
    for (i = 0; i + 1 < count; i++) {
        const int parts = (int)ceil((ends[i + 1] - ends[i]) / spacing);
        for (j = 0; j < parts && n < MOST_NODES - 1; j++) {
            x[n++] = ends[i] + (ends[i + 1] - ends[i]) * j / parts;
        }
    }
    x[n++] = ends[count - 1];
    return n;
}

/* Gains at the nodes of a table, in straight lines over ln F and level beyond, and what a unit of the inlet's state lets into the chain. */
static void table_gains(const FilmLaw *law, const double gains[], int nodes, const double x[], double rows[], double made[])
{
    const int width = DIRECT + law->lags;
    const double *known = law->x + 1;
    int k = 0, i, j;
    for (i = 0; i < nodes; i++) {
        double share, *row = &rows[i * width];
        while (k < law->nodes - 3 && x[i] > known[k + 1]) {
            k++;
        }
        share = fmin(fmax((x[i] - known[k]) / (known[k + 1] - known[k]), 0.0), 1.0);
        made[i] = LEAST_MADE;
        for (j = 0; j < width; j++) {
            row[j] = gains[k * width + j] + share * (gains[(k + 1) * width + j] - gains[k * width + j]);
            made[i] += j < DIRECT ? 0.0 : fabs(row[j]);
        }
    }
}

/* Law of a race: stiffness of the dry contact, 2a over sqrt(g), three rates; its static curve, [4][nodes] ln F, ln h, slope and
 * approach, in N and in the approach of a dry contact under 1 N; gains, [nodes - 1][DIRECT + lags], of its nodes but the first. */
EXPORT void bearing_race(Explored *e, int race, const double law[], int nodes, const double curve[], int lags, const double gains[])
{
    Race *r = &e->bearing.race[race];
    const double length = pow(law[0], -2.0 / 3.0);
    const FilmLaw of = {nodes, 0, lags, curve, curve + nodes, curve + 2 * nodes, curve + 3 * nodes, NULL, NULL, 1.0, 1.0, 1.0, 0.0, 0.0};
    double *x = numbers(MOST_NODES), *u = numbers(MOST_NODES), *cells, *rows, *made;
    int n = table_nodes(&of, length, x), k;
    cells = numbers((size_t)(n - 1) * CELLS * 4);
    race_cells(&of, n, x, u, cells);
    for (k = 0; k < n; k++) {
        u[k] *= length;
    }
    for (k = 0; k < (n - 1) * CELLS * 4; k++) {
        cells[k] *= length;
    }
    table_gains(&of, gains, n, x, rows = numbers((size_t)(n * (DIRECT + lags))), made = numbers((size_t)n));
    r->kn = law[0];
    r->log_kn = log(law[0]);
    r->contact_length_factor = law[1];
    r->lag_rate = law[2];
    r->inlet_rate = law[3];
    r->fast_rate = law[4];
    r->cutoff_gap = HUGE_VAL;
    r->lags = e->bearing.lags = lags;
    r->nodes = n;
    r->x = x;
    r->u = u;
    r->cells = cells;
    r->gains = rows;
    r->made = made;
}

/* The ring as a rotor without mass on its balls. */
static void make_rotor(Explored *e)
{
    Rotor *r = &e->rotor;
    const int n = e->bearing.directions;
    int i;
    bearing_support(&e->bearing, &e->support);
    e->supports[0] = &e->support;
    for (i = 0; i < n; i++) {
        e->eye[i * n + i] = e->ones[i] = 1.0;
    }
    r->freedoms = r->points = r->motions = n;
    r->supports = 1;
    r->load = 1.0;
    r->L = e->load;
    r->K = r->M = r->C = numbers((size_t)(n * n));
    r->B = r->ties = e->eye;
    r->shift = e->still;
    r->count = e->ones;
    r->rested = balanced;
    r->floor = least_load;
    r->support = e->supports;
    r->first = &e->first;
    e->state = numbers(rotor_size(r));
    e->work = numbers(rotor_work(r) + supports_work(r));
    e->bearing_work = numbers(bearing_work_size(&e->bearing));
    e->balls = (BallAtRest *)(void *)numbers((size_t)e->bearing.balls * OF_BALL);
    e->geometric = numbers((size_t)(20 * e->bearing.balls));
    e->settings[3] = 1.0;
}

static void share_gyroscopic(Explored *e, double share)
{
    e->bearing.control = share > 0.0 ? e->control : OUTER_CONTROL;
    e->bearing.grooves.gyroscopic = share * e->gyroscopic;
}

/* Symmetric part of what follows the place of a ball, as in `linear_balls`: outer race control has no moment on the ring. */
static void slopes_of_a_potential(Explored *e)
{
    int k, i, j;
    for (k = 0; k < e->bearing.balls; k++) {
        double *g = &e->geometric[20 * k];
        for (i = 0; i < 4; i++) {
            for (j = 0; j < i; j++) {
                const double sign = (i < 2) == (j < 2) ? 1.0 : -1.0, mean = 0.5 * (g[4 * i + j] + sign * g[4 * j + i]);
                g[4 * i + j] = mean;
                g[4 * j + i] = sign * mean;
            }
        }
    }
}

/* The ring under a load [N] with the first ball at an angle, from where it is; first without the gyroscopic moments of balls, then
 * with growing ones. Returns 0 where it is, else a text. */
EXPORT const char *bearing_stand(Explored *e, double angle, const double load[])
{
    const double *const parameters[1] = {e->settings};
    const int n = e->bearing.directions;
    double done = 0.0, step = 1.0, last[AXES], *q, *own;
    const char *reason;
    if (e->state == NULL) {
        make_rotor(e);
    }
    q = e->state + rotor_layout(&e->rotor).place;
    own = e->state + rotor_layout(&e->rotor).supports;
    e->state[rotor_layout(&e->rotor).shaft + SHAFT_SPEED] = e->omega;
    e->settings[2] = angle;
    memcpy(e->load, load, (size_t)n * sizeof load[0]);
    share_gyroscopic(e, 0.0);
    reason = rotor_rest(&e->rotor, parameters, e->still, e->state, e->work);
    while (reason == NULL && done < 1.0 && n > IN_Z) {
        memcpy(last, q, sizeof last);
        share_gyroscopic(e, fmin(done + step, 1.0));
        reason = rotor_rest(&e->rotor, parameters, e->still, e->state, e->work);
        if (reason == NULL) {
            done = fmin(done + step, 1.0);
        } else if ((step *= 0.5) > smallest_share) {
            memcpy(q, last, sizeof last);
            reason = NULL;
        }
    }
    memcpy(e->ring, q, (size_t)n * sizeof q[0]);
    if (reason == NULL) {
        reason = bearing_rest(&e->bearing, own, e->bearing_work, e->omega, q, e->force);
    }
    if (reason == NULL) {
        double damping[AXES * AXES];
        bearing_slopes(&e->bearing, e->bearing_work, e->stiffness, damping);
        bearing_describe(&e->bearing, own, e->bearing_work, e->balls, e->geometric);
        if (e->omega > 0.0) {
            slopes_of_a_potential(e);
        }
    }
    return reason;
}

EXPORT const double *bearing_ring(const Explored *e)
{
    return e->ring; /* then the force on the balls and its slopes */
}

/* Numbers of `BallAtRest`, ball by ball, and how many each has. */
EXPORT const double *bearing_of_balls(const Explored *e)
{
    return (const double *)(const void *)e->balls;
}

EXPORT int bearing_per_ball(void)
{
    return OF_BALL;
}

/* ---- small vibrations: reduced_models.bearing.linear_balls and elements.film_response ---- */

/* Impedance of a contact at i w. */
static double complex impedance(const Explored *e, int race, const BallAtRest *ball, double w)
{
    const Race *r = &e->bearing.race[race];
    const int width = DIRECT + r->lags;
    const double g = ball->compression[race], x = r->log_kn + 1.5 * log(g), slope = 1.5 * ball->load[race] / g;
    const double own = w * r->contact_length_factor / (ball->speed_sum[race] * e->omega) * sqrt(g), z = fmax(own, small_omega);
    const double complex inlet = 1.0 / (1.0 + I * z / r->inlet_rate), lag = 1.0 / (1.0 + I * z / r->lag_rate);
    double complex sum = 0.0, here = inlet;
    int k = 0, j;
    double share;
    while (k < r->nodes - 2 && x > r->x[k + 1]) {
        k++;
    }
    share = fmin(fmax((x - r->x[k]) / (r->x[k + 1] - r->x[k]), 0.0), 1.0);
    for (j = 0; j < width; j++) {
        const double *row = &r->gains[k * width + j], gain = row[0] + share * (row[width] - row[0]);
        if (j >= DIRECT) {
            here *= lag;
        }
        sum += gain * (j == 0 ? 1.0 : j == 1 ? inlet : j == 2 ? 1.0 / (1.0 + I * z / r->fast_rate) : here);
    }
    return ball->slope[race] + slope * I * own * sum;
}

/* Force of a ball on the ring (r, z) by the place of its inner groove centre (r, z). */
static void ball_impedance(const Explored *e, int k, double w, double complex Z[2][2])
{
    const BallAtRest *ball = &e->balls[k];
    const double a = ball->angle[OUTER_RACE], turned = ball->angle[INNER_RACE] - a;
    const double along[2][2] = {{cos(a), sin(a)}, {-sin(a), cos(a)}}, n[2] = {cos(turned), sin(turned)};
    const double complex inner = impedance(e, INNER_RACE, ball, w), outer = impedance(e, OUTER_RACE, ball, w);
    double complex t[4][4];
    int i, j, l, m, p;
    for (i = 0; i < 4; i++) { /* the balance of the ball and the force on the ring, by b and c; along and across the outer contact */
        for (j = 0; j < 4; j++) {
            t[i][j] = (j < 2 ? -1.0 : 1.0) * inner * n[i % 2] * n[j % 2] - (i == 0 && j == 0 ? outer : 0.0);
            for (l = 0; l < 2; l++) {
                for (m = 0; m < 2; m++) {
                    t[i][j] += along[i % 2][l] * e->geometric[20 * k + (i / 2 * 2 + l) * 4 + j / 2 * 2 + m] * along[j % 2][m];
                }
            }
        }
    }
    for (p = 0; p < (e->bearing.directions > IN_Z ? 2 : 1); p++) { /* nothing acts across in a planar ring */
        for (i = p + 1; i < 4; i++) {
            const double complex share = t[i][p] / t[p][p];
            for (j = p; j < 4; j++) {
                t[i][j] -= share * t[p][j];
            }
        }
    }
    for (i = 0; i < 2; i++) {
        for (j = 0; j < 2; j++) {
            Z[i][j] = 0.0;
            for (l = 0; l < 2; l++) {
                for (m = 0; m < 2; m++) {
                    Z[i][j] += along[l][i] * t[2 + l][2 + m] * along[m][j];
                }
            }
        }
    }
}

/* Adds `share` of stiffness and damping at frequencies [rad/s] to [count][2][3][3], where it stands. */
EXPORT void bearing_vibrate(const Explored *e, double share, int count, const double omega[], double sum[])
{
    const int n = e->bearing.directions;
    int f, k, i, j;
    for (f = 0; f < count; f++) {
        const double w = fmax(omega[f], tiny_omega);
        double *K = &sum[f * 2 * AXES * AXES], *C = K + AXES * AXES;
        for (k = 0; k < e->bearing.balls; k++) {
            const double psi = e->settings[2] + 2.0 * acos(-1.0) * k / e->bearing.balls;
            const double maps[2][AXES] = {{cos(psi), sin(psi), 0.0}, {0.0, 0.0, 1.0}};
            double complex Z[2][2];
            ball_impedance(e, k, w, Z);
            for (i = 0; i < n; i++) {
                for (j = 0; j < n; j++) {
                    double complex z = 0.0;
                    int l, m;
                    for (l = 0; l < 2; l++) {
                        for (m = 0; m < 2; m++) {
                            z += maps[l][i] * Z[l][m] * maps[m][j];
                        }
                    }
                    K[i * AXES + j] += share * creal(z);
                    C[i * AXES + j] += share * cimag(z) / w;
                }
            }
        }
    }
}

/* ---- sliding: reduced_models.bearing.sliding ---- */

/* A contact whose surfaces slide: its ellipse and Hertz pressure, radii of rolling and of what both surfaces share across it, rolling
 * speed, film, spin over rolling; logarithm of the viscosity, with its two numbers of Roelands' law; limiting stress over pressure. */
typedef struct {
    double a, b, pressure, radius, across, speed, film, spin, log_eta, q, z, p0, limit;
} Sliding;

enum { LINES = 480, PLACES = 16 };

/* Traction [N] of the race on the ball, faster by `slip` in the middle, and power [W]; lines ahead of the centre as those behind it. */
static void slide(const Sliding *s, double slip, double *traction, double *power)
{
    static const double slowest = 1e-300;
    const double pi = acos(-1.0), newton = s->log_eta + log(s->speed / s->film);
    double weights = 0.0;
    int i, j;
    *traction = *power = 0.0;
    for (i = 0; i < LINES; i++) {
        const double angle = ((i + 0.5) / LINES - 0.5) * pi, half = cos(angle), y = s->b * sin(angle);
        const double along = y * y / (2.0 * s->across * s->radius) + s->spin * y / s->radius + slip;
        for (j = 0; j < PLACES / 2; j++) {
            const double place = (j + 0.5) / PLACES * pi, high = sin(place), p = s->pressure * half * high, most = s->limit * p;
            const double across = s->spin * s->a * half * cos(place) / s->radius, size = fmax(hypot(along, across), slowest);
            const double thicker = s->q * expm1(s->z * log1p(p / s->p0)), weight = half * half * high;
            const double stress = -most * expm1(-exp(fmin(newton + thicker + log(size) - log(most), 700.0)));
            weights += weight;
            *traction += weight * stress * along / size;
            *power += weight * stress * size;
        }
    }
    *traction *= pi * s->a * s->b / weights;
    *power *= pi * s->a * s->b / weights * s->speed;
}

/* Power [W] of a contact whose ball takes no traction from it. */
EXPORT double sliding_power(const double contact[])
{
    Sliding s;
    double low = -1.0, high = 1.0, below, above, middle = 0.0, now, power;
    int i, side = 0;
    memcpy(&s, contact, sizeof s);
    slide(&s, low, &below, &power);
    slide(&s, high, &above, &power);
    for (i = 0; i < 100 && high - low > 1e-9; i++) {
        const double last = middle;
        middle = i % 3 == 2 ? 0.5 * (low + high) : (low * above - high * below) / (above - below);
        slide(&s, middle, &now, &power);
        if (now == 0.0 || fabs(middle - last) < 1e-12) {
            break;
        }
        if (now < 0.0) {
            low = middle;
            below = now;
            above *= side < 0 ? 0.5 : 1.0;
            side = -1;
        } else {
            high = middle;
            above = now;
            below *= side > 0 ? 0.5 : 1.0;
            side = 1;
        }
    }
    return power;
}
