/* A ball bearing: force on the inner ring under a given motion of it, co-simulation alone; equations in README.md. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "balls.h"
#if HAS_FILMS
#include "bearing_films.h"
#endif
#include "bearing_races.h"
#include "bearing_seat.h"
#include "bearing_speeds.h"
#include "model.h"

enum { VELOCITY = FREEDOMS, SPEED = 2 * FREEDOMS }; /* inputs; those before are the place */
enum { TOO_FAST = 1, OVERLOADED = 2 };               /* bits of model_outside */
enum { CENTRAL, SMALLEST, MOMENT };                  /* of film_tables */

static const Fault fine = {FINE, NULL};
static const double by_rounding = 1e-9;

/* The cache is what a bearing remembers. */
typedef char cache_fits[sizeof(Bearing) == N_CACHE * sizeof(double) ? 1 : -1];

static Setup setup_of(const double value[])
{
    Setup s;
    int race;
    for (race = 0; race < 2; race++) {
        s.race[race] = races[race];
        if (value[VR_film] == 0.0) {
            s.race[race].nodes = 0;
        }
    }
#if HAS_CLEARANCE
    s.clearance = value[VR_clearance];
#else
    s.clearance = 0.0; /* the contact angle is given */
#endif
    return s;
}

/* ---- losses of rings and fits ---- */

/* Force of the seat at the end of a step through which that of the balls runs straight; h = 0: at rest. */
static void pass_seat(const Bearing *before, Bearing *after, double h, double force[])
{
    int j;
    for (j = 0; j < FREEDOMS; j++) {
        const double at_end = force[j];
#if SEAT_FILTERS > 0
        const double at_start = before->seat[0][j];
        int k;
        for (k = 0; k < SEAT_FILTERS; k++) {
            const double held = before->seat[1 + k][j];
            double *now = &after->seat[1 + k][j];
            if (h > 0.0) {
                const double mu = seat_rates[k] * h, left = exp(-mu), mean = -expm1(-mu) / mu;
                *now = left * held + (mean - left) * at_start + (1.0 - mean) * at_end;
            } else {
                *now = at_end;
            }
            force[j] += seat_gains[k] * (at_end - *now);
        }
#else
        (void)before, (void)h;
#endif
        after->seat[0][j] = at_end;
    }
}

/* ---- films and outputs ---- */

#if HAS_FILMS

/* Where films stand in their tables: rows of speeds, and share of the next; loads likewise. */
typedef struct {
    int row, node;
    double by_speed, by_load;
} FilmPlace;

static FilmPlace at_speed(double omega)
{
    FilmPlace at = {0, 0, 0.0, 0.0};
#if SPEED_ROWS > 1
    at.row = speed_row(omega).row;
    at.by_speed = log(film_speed(omega) / table_speeds[at.row]) / log(table_speeds[at.row + 1] / table_speeds[at.row]);
#else
    (void)omega;
#endif
    return at;
}

static FilmPlace at_load(FilmPlace at, int race, double load)
{
    const double x = load > 0.0 ? (log(load) - film_x0[race]) / film_dx[race] : 0.0;
    if (x > 0.0) {
        at.node = x >= FILM_NODES - 1 ? FILM_NODES - 2 : (int)x;
        at.by_load = x >= FILM_NODES - 1 ? 1.0 : x - at.node;
    }
    return at;
}

/* A quantity of a film, tabulated as its logarithm over those of load and speed. */
static double of_table(int race, int what, FilmPlace at)
{
    const double *here = &film_tables[race][at.row][what][at.node];
    double y = here[0] + at.by_load * (here[1] - here[0]);
#if SPEED_ROWS > 1
    const double *next = &film_tables[race][at.row + 1][what][at.node];
    y += at.by_speed * (next[0] + at.by_load * (next[1] - next[0]) - y);
#endif
    return exp(y);
}

/* Films of a contact, and the torque that it takes from the inner ring. */
static double show_film(const Bearing *b, const Ball *ball, int race, FilmPlace speed, double films[2])
{
    const FilmPlace at = at_load(speed, race, ball->force[race]);
    const double factor = FREEDOMS == 5 ? ball->factor[race][0] : 1.0;
    const double rolls = FREEDOMS == 5 ? ball->entrained[race][0] : ROLLING_RADIUS;
    films[0] = factor * of_table(race, CENTRAL, at);
    films[1] = factor * of_table(race, SMALLEST, at);
    return b->omega > 0.0 ? 0.5 * rolls * of_table(race, MOMENT, at) / rolling_radius[race] : 0.0;
}

#endif

static void show_balls(Model *m, const Bearing *b)
{
    double *value = m->value, largest[2] = {0.0, 0.0};
    int k, race;
#if HAS_FILMS
    const FilmPlace speed = at_speed(b->omega);
    double smallest = HUGE_VAL, torque = 0.0;
#endif
    for (k = 0; k < BALLS; k++) {
        const Ball *ball = &b->ball[k];
        double *shown = &value[FIRST_BALL + k * PER_BALL];
        for (race = 0; race < 2; race++) {
            const double load = ball->force[race];
            largest[race] = fmax(largest[race], load);
            *shown++ = load;
#if HAS_FILMS
            if (value[VR_film] != 0.0) {
                torque += show_film(b, ball, race, speed, shown);
                smallest = fmin(smallest, shown[1]);
            } else {
                shown[0] = shown[1] = smallest = 0.0;
            }
            shown += 2;
#endif
#if FREEDOMS == 5
            *shown++ = ball->angle[race];
#endif
        }
    }
    value[VR_largest_load_inner] = largest[INNER_RACE];
    value[VR_largest_load_outer] = largest[OUTER_RACE];
#if HAS_FILMS
    value[VR_smallest_film] = smallest;
    value[VR_rolling_torque] = torque;
#if HAS_ROUGHNESS
    value[VR_smallest_lambda] = smallest / ROUGHNESS;
#endif
#endif
    value[VR_cage_angle] = b->angle;
    value[VR_outside_speed] = b->omega > (1.0 + by_rounding) * MOST_SPEED;
    value[VR_outside_load] = largest[INNER_RACE] > most_load[INNER_RACE] || largest[OUTER_RACE] > most_load[OUTER_RACE];
    value[VR_outside_validity] = value[VR_outside_speed] != 0.0 || value[VR_outside_load] != 0.0;
}

static void show(Model *m, const Bearing *b, const double force[])
{
    int j;
    for (j = 0; j < FREEDOMS; j++) {
        m->value[FIRST_FORCE + j] = -force[j];
    }
    show_balls(m, b);
    memcpy(m->cache, b, sizeof *b);
}

/* ---- the interface of the core ---- */

static const char *check(const double place[], double omega)
{
    int j;
    if (!(omega >= 0.0)) {
        return "speed must be >= 0 rad/s";
    }
    for (j = 0; j < FREEDOMS; j++) {
        if (!(fabs(place[j]) <= (j < 3 ? LARGEST_PLACE : LARGEST_TILT))) {
            return "the inner ring is farther from the outer one than the groove of a race is deep";
        }
    }
    return NULL;
}

/* Place of the ring against its balls. */
static void place_of(const double value[], const double inputs[], double q[])
{
    memcpy(q, inputs, FREEDOMS * sizeof q[0]);
#if FREEDOMS == 5
    q[2] += value[VR_offset];
#else
    (void)value;
#endif
}

static const char *check_forces(const double force[])
{
    int j;
    for (j = 0; j < FREEDOMS; j++) {
        if (!isfinite(force[j])) {
            return "the forces are too large for a floating-point number";
        }
    }
    return NULL;
}

Fault model_prepare(Model *m)
{
#if HAS_CLEARANCE
    const Fault off = {REFUSE, "clearance is too large or too small for a bearing of this size"};
    return fabs(m->value[VR_clearance]) <= LARGEST_PLACE ? fine : off;
#else
    (void)m;
    return fine;
#endif
}

/* Before the first step: at rest where the inputs are. Then outputs are those of the last step, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    Bearing bearing;
    Setup setup = setup_of(m->value);
    double q[FREEDOMS], force[FREEDOMS];
    const char *reason;
    memcpy(&bearing, m->cache, sizeof bearing);
    if (bearing.h > 0.0) {
        return fine;
    }
    place_of(m->value, m->input, q);
    reason = check(q, m->input[SPEED]);
    if (reason == NULL) {
        bearing.angle = m->value[VR_cage_angle_start];
        reason = balls_rest(&setup, &bearing, m->input[SPEED], q, force);
    }
    if (reason == NULL) {
        reason = check_forces(force);
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    pass_seat(&bearing, &bearing, 0.0, force);
    show(m, &bearing, force);
    return fine;
}

Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    Bearing before, after;
    Setup setup = setup_of(m->value);
    double inputs[N_INPUTS], q[FREEDOMS], force[FREEDOMS];
    const char *reason;
    int j;
    (void)tolerance;
    memcpy(&before, m->cache, sizeof before);
    for (j = 0; j < N_INPUTS; j++) {
        inputs[j] = motion->input[j].end;
    }
    place_of(m->value, inputs, q);
    reason = check(q, inputs[SPEED]);
    if (reason == NULL) {
        reason = balls_step(&setup, &before, &after, h, inputs[SPEED], q, &inputs[VELOCITY], force);
    }
    if (reason == NULL) {
        reason = check_forces(force);
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    pass_seat(&before, &after, h, force);
    show(m, &after, force);
    memcpy(m->input, inputs, sizeof inputs);
    return fine;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    (void)m, (void)seed, (void)along;
}

unsigned long long model_outside(const Model *m)
{
    return (m->value[VR_outside_speed] != 0.0 ? TOO_FAST : 0U) | (m->value[VR_outside_load] != 0.0 ? OVERLOADED : 0U);
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    (void)m;
    snprintf(text, size, "%s%s", (which & TOO_FAST) == 0 ? "" : " speed above the tables;",
             (which & OVERLOADED) == 0 ? "" : " a ball carries more than the tables have;");
    text[strlen(text) - 1] = '\0';
}
