/* A ball bearing: force on the inner ring under a given motion of it. Its states are those of model exchange; in steps they are
 * those of the end of the step. Equations in README.md. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "continuous_time.h"
#include "model.h"
#if HAS_FILMS
#include "bearing_films.h"
#endif
#include "bearing_races.h"
#include "bearing_seat.h"
#include "bearing_speeds.h"

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

/* Force of the seat at the end of a step through which that of the balls runs straight; h = 0: at rest. Returns its slope by
 * that of the balls. */
static double pass_seat(const Bearing *before, Bearing *after, double h, double force[])
{
    double slope = 1.0;
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
                slope += j == 0 ? seat_gains[k] * mean : 0.0;
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
    return slope;
}

/* ---- films and outputs ---- */

#if HAS_FILMS

/* Where films stand in their tables: rows of speeds, and share of the next; loads likewise. */
typedef struct {
    int row, node;
    Dual by_speed, by_load;
} FilmPlace;

static FilmPlace at_speed(Dual omega)
{
    FilmPlace at = {0, 0, {0.0, 0.0}, {0.0, 0.0}};
#if SPEED_ROWS > 1
    const double rolling = fmin(film_speed(omega.x), table_speeds[SPEED_ROWS - 1]);
    at.row = speed_row(omega.x).row;
    {
        const double per_ratio = 1.0 / log(table_speeds[at.row + 1] / table_speeds[at.row]);
        at.by_speed.x = per_ratio * log(rolling / table_speeds[at.row]);
        at.by_speed.d = rolling == omega.x ? per_ratio / rolling * omega.d : 0.0;
    }
#else
    (void)omega;
#endif
    return at;
}

static FilmPlace at_load(FilmPlace at, int race, Dual load)
{
    const double x = load.x > 0.0 ? (log(load.x) - film_x0[race]) / film_dx[race] : 0.0;
    if (x >= FILM_NODES - 1) {
        at.node = FILM_NODES - 2;
        at.by_load = number(1.0);
    } else if (x > 0.0) {
        at.node = (int)x;
        at.by_load = dual(x - at.node, load.d / (load.x * film_dx[race]));
    }
    return at;
}

static Dual between(const double *here, Dual share)
{
    return dual(here[0] + share.x * (here[1] - here[0]), share.d * (here[1] - here[0]));
}

/* A quantity of a film, tabulated as its logarithm over those of load and speed. */
static Dual of_table(int race, int what, FilmPlace at)
{
    Dual y = between(&film_tables[race][at.row][what][at.node], at.by_load);
#if SPEED_ROWS > 1
    y = add(y, mul(at.by_speed, sub(between(&film_tables[race][at.row + 1][what][at.node], at.by_load), y)));
#endif
    return chained(exp(y.x), exp(y.x), y);
}

/* Films of a contact, and the torque that it takes from the inner ring. */
static Dual show_film(const BallLoads *balls, int k, int race, double omega, FilmPlace speed, Dual films[2])
{
    const FilmPlace at = at_load(speed, race, balls->load[k][race]);
    const Dual factor = FREEDOMS == 5 ? balls->factor[k][race] : number(1.0);
    const Dual rolls = FREEDOMS == 5 ? balls->speed_sum[k][race] : number(ROLLING_RADIUS);
    films[0] = mul(factor, of_table(race, CENTRAL, at));
    films[1] = mul(factor, of_table(race, SMALLEST, at));
    return omega > 0.0 ? mul(over(times(0.5, rolls), number(rolling_radius[race])), of_table(race, MOMENT, at)) : number(0.0);
}

#endif

/* Values of variables, or their changes along a direction; either may be NULL. */
typedef struct {
    double *value, *along;
} Shown;

static void put(Shown to, int reference, Dual x)
{
    if (to.value != NULL) {
        to.value[reference] = x.x;
    }
    if (to.along != NULL) {
        to.along[reference] = x.d;
    }
}

/* Loads and films of all balls, the largest and the smallest, and the torque. */
static void show_balls(const BallLoads *balls, Dual omega, int film, Shown to)
{
    Dual largest[2] = {{0.0, 0.0}, {0.0, 0.0}};
    int k, race;
#if HAS_FILMS
    const FilmPlace speed = at_speed(omega);
    Dual smallest = number(film ? HUGE_VAL : 0.0), torque = number(0.0);
#else
    (void)omega, (void)film;
#endif
    for (k = 0; k < BALLS; k++) {
        int shown = FIRST_BALL + k * PER_BALL;
        for (race = 0; race < 2; race++) {
            const Dual load = balls->load[k][race];
            if (load.x > largest[race].x) {
                largest[race] = load;
            }
            put(to, shown++, load);
#if HAS_FILMS
            {
                Dual films[2] = {{0.0, 0.0}, {0.0, 0.0}};
                if (film) {
                    torque = add(torque, show_film(balls, k, race, omega.x, speed, films));
                    smallest = films[1].x < smallest.x ? films[1] : smallest;
                }
                put(to, shown++, films[0]);
                put(to, shown++, films[1]);
            }
#endif
#if FREEDOMS == 5
            put(to, shown++, balls->angle[k][race]);
#endif
        }
    }
    put(to, VR_largest_load_inner, largest[INNER_RACE]);
    put(to, VR_largest_load_outer, largest[OUTER_RACE]);
#if HAS_FILMS
    put(to, VR_smallest_film, smallest);
    put(to, VR_rolling_torque, torque);
#if HAS_ROUGHNESS
    put(to, VR_smallest_lambda, times(1.0 / ROUGHNESS, smallest));
#endif
#endif
}

/* Outputs, and what the bearing remembers. */
static void show(Model *m, const Bearing *b, const BallLoads *balls, const double force[])
{
    double *value = m->value;
    const Shown to = {value, NULL};
    const int per_ball = N_CONTACTS / BALLS;
    int j, k, race;
    for (j = 0; j < FREEDOMS; j++) {
        value[FIRST_FORCE + j] = -force[j];
    }
    for (k = 0; k < BALLS; k++) {
        for (race = 0; race < per_ball; race++) {
            m->indicator[k * per_ball + race] = balls->film[k][race];
        }
    }
    show_balls(balls, number(b->omega), value[VR_film] != 0.0, to);
    value[VR_cage_angle] = b->angle;
    value[VR_outside_speed] = b->omega > (1.0 + by_rounding) * MOST_SPEED;
    value[VR_outside_load] = value[VR_largest_load_inner] > most_load[INNER_RACE]
                             || value[VR_largest_load_outer] > most_load[OUTER_RACE];
    value[VR_outside_validity] = value[VR_outside_speed] != 0.0 || value[VR_outside_load] != 0.0;
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
            return "the inner ring is farther from the outer one than the groove of a race is deep "
                   "(a coupling with too long steps does that)";
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
    const double film = m->value[VR_film];
#if HAS_CLEARANCE
    if (!(fabs(m->value[VR_clearance]) <= LARGEST_PLACE)) {
        return fault(REFUSE, "clearance is too large or too small for a bearing of this size");
    }
#endif
    if (film != 0.0 && !(film == 1.0 && races[0].nodes > 0)) {
        return fault(REFUSE, races[0].nodes > 0 ? "film must be 0 (dry) or 1 (with oil films)" : "film must be 0: this bearing is dry");
    }
    return fine;
}

/* At rest with the ring at q: what the bearing remembers, and the force on its balls. */
static const char *rest(const Model *m, const double q[], Bearing *bearing, double force[])
{
    const Setup setup = setup_of(m->value);
    const char *reason = check(q, m->input[SPEED]);
    if (reason == NULL) {
        bearing->angle = m->value[VR_cage_angle_start];
        reason = balls_rest(&setup, bearing, m->input[SPEED], q, force);
    }
    if (reason == NULL) {
        reason = check_forces(force);
    }
    if (reason == NULL) {
        pass_seat(bearing, bearing, 0.0, force);
    }
    return reason;
}

/* ---- continuous time ---- */

enum { SEAT = FIRST_OF_BALLS + BALLS * BALL_STATES };

/* The states of a bearing at rest or at the end of a step. */
static void states_of(const Bearing *b, double states[])
{
    int k, race, j;
    states[CAGE_ANGLE] = b->angle;
    for (k = 0; k < BALLS; k++) {
        double *state = &states[FIRST_OF_BALLS + k * BALL_STATES];
        if (OWN_STATES > 0) {
            own_states(&b->ball[k], state);
            state += OWN_STATES;
        }
        for (race = 0; race < 2 && FILM_STATES > 0; race++) {
            const FilmState *film = &b->film[k][race];
            *state++ = film->inlet;
            *state++ = film->fast;
            memcpy(state, film->chain, sizeof film->chain);
            state += LAGS;
        }
    }
    for (k = 0; k < SEAT_FILTERS; k++) {
        for (j = 0; j < FREEDOMS; j++) {
            states[SEAT + k * FREEDOMS + j] = b->seat[1 + k][j];
        }
    }
}

/* States, rates and forces, with their changes along a direction. */
typedef struct {
    Dual states[N_STATES], rates[N_STATES], force[FREEDOMS];
    RingMotion ring;
    BallLoads balls;
} InTime;

/* What follows from the inputs and these states, along `seed` (NULL: no direction); at the start from the inputs alone. */
static const char *in_time(const Model *m, const double states[], const double *seed, InTime *t)
{
    const Setup setup = setup_of(m->value);
    const int starts = m->stage == STARTING, wet = setup.race[INNER_RACE].nodes > 0;
    double q[FREEDOMS], force[FREEDOMS];
    Bearing last;
    const char *reason;
    int i, j, k;
    place_of(m->value, m->input, q);
    reason = check(q, m->input[SPEED]);
    if (reason != NULL) {
        return reason;
    }
    for (j = 0; j < FREEDOMS; j++) {
        t->ring.q[j] = dual(q[j], seed != NULL ? seed[j] : 0.0);
        t->ring.v[j] = dual(m->input[VELOCITY + j], seed != NULL ? seed[VELOCITY + j] : 0.0);
    }
    t->ring.omega = dual(m->input[SPEED], seed != NULL ? seed[SPEED] : 0.0);
    for (i = 0; i < N_STATES; i++) {
        t->states[i] = dual(states[i], seed != NULL && !starts ? seed[FIRST_STATE + i] : 0.0);
    }
    memcpy(&last, m->cache, sizeof last);
    if (!HEAVY && !wet) {
        last.angle = states[CAGE_ANGLE];
        reason = balls_rest(&setup, &last, m->input[SPEED], q, force);
    }
    for (k = 0; k < BALLS && starts && OWN_STATES > 0; k++) {
        rest_place(&setup, &t->ring, t->states[CAGE_ANGLE], k, &t->states[FIRST_OF_BALLS + k * BALL_STATES]);
    }
    if (reason == NULL) {
        reason = bearing_rates(&setup, &t->ring, &last, t->states, t->rates, &t->balls);
    }
    for (j = 0; j < FREEDOMS && reason == NULL; j++) {
        const Dual raw = t->balls.force[j];
        t->force[j] = raw;
#if SEAT_FILTERS > 0
        for (k = 0; k < SEAT_FILTERS; k++) {
            Dual *held = &t->states[SEAT + k * FREEDOMS + j], lost;
            held->d = starts ? raw.d : held->d;
            lost = sub(raw, *held);
            t->rates[SEAT + k * FREEDOMS + j] = times(seat_rates[k], lost);
            t->force[j] = add(t->force[j], times(seat_gains[k], lost));
        }
#endif
        reason = isfinite(t->force[j].x) ? NULL : "the forces are too large for a floating-point number";
    }
    for (i = 0; i < N_STATES && reason == NULL; i++) {
        reason = isfinite(t->rates[i].x) ? NULL : "a derivative of a state is too large for a floating-point number";
    }
    return reason;
}

static void show_rates(Model *m, const InTime *t)
{
    int i;
    for (i = 0; i < N_STATES; i++) {
        m->value[FIRST_DERIVATIVE + i] = t->rates[i].x;
    }
}

/* Outputs and derivatives of model exchange: with the states that were set, at the start with those at rest. */
static Fault evaluate_in_time(Model *m)
{
    double states[N_STATES], force[FREEDOMS], q[FREEDOMS];
    const char *reason = NULL;
    Bearing b;
    InTime t;
    int i, j;
    memcpy(&b, m->cache, sizeof b);
    memcpy(states, &m->value[FIRST_STATE], sizeof states);
    if (m->stage == STARTING) {
        place_of(m->value, m->input, q);
        reason = rest(m, q, &b, force);
        states_of(&b, states);
    }
    for (i = 0; i < N_STATES && reason == NULL; i++) {
        if (!isfinite(states[i])) {
            return fault(REFUSE, "the states must be finite");
        }
    }
    if (reason == NULL) {
        reason = in_time(m, states, NULL, &t);
    }
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    for (j = 0; j < FREEDOMS; j++) {
        force[j] = t.force[j].x;
    }
    b.angle = states[CAGE_ANGLE];
    b.omega = m->input[SPEED];
    memcpy(&m->value[FIRST_STATE], states, sizeof states);
    show_rates(m, &t);
    show(m, &b, &t.balls, force);
    return fine;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    const Shown to = {NULL, along};
    InTime t;
    int i, j;
    if (in_time(m, &m->value[FIRST_STATE], seed, &t) != NULL) {
        return; /* not of an evaluated model */
    }
    for (j = 0; j < FREEDOMS; j++) {
        along[FIRST_FORCE + j] = -t.force[j].d;
    }
    for (i = 0; i < N_STATES; i++) {
        along[FIRST_STATE + i] = t.states[i].d;
        along[FIRST_DERIVATIVE + i] = t.rates[i].d;
    }
    show_balls(&t.balls, t.ring.omega, m->value[VR_film] != 0.0, to);
}

/* ---- steps ---- */

static void show_step(Model *m, const Bearing *b, const double force[])
{
    BallLoads balls;
    int k, race;
    for (k = 0; k < BALLS; k++) {
        const Ball *ball = &b->ball[k];
        for (race = 0; race < 2; race++) {
            balls.load[k][race] = number(ball->force[race]);
            balls.film[k][race] = ball->film[race];
            balls.factor[k][race] = number(ball->factor[race][0]);
            balls.speed_sum[k][race] = number(ball->speed_sum[race][0]);
            balls.angle[k][race] = number(ball->angle[race]);
        }
    }
    show(m, b, &balls, force);
    states_of(b, &m->value[FIRST_STATE]);
}

/* In steps: before the first one at rest where the inputs are; then outputs are those of the last, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    Bearing bearing;
    double q[FREEDOMS], force[FREEDOMS];
    const char *reason;
    if (m->stage != IN_STEPS) {
        return evaluate_in_time(m);
    }
    memcpy(&bearing, m->cache, sizeof bearing);
    if (bearing.h > 0.0) {
        return fine;
    }
    place_of(m->value, m->input, q);
    reason = rest(m, q, &bearing, force);
    if (reason != NULL) {
        return fault(DISCARD, reason);
    }
    show_step(m, &bearing, force);
    return fine;
}

Fault model_rates(Model *m)
{
    if (m->stage == IN_STEPS) {
        InTime t;
        const char *reason = in_time(m, &m->value[FIRST_STATE], NULL, &t);
        if (reason != NULL) {
            return fault(DISCARD, reason);
        }
        show_rates(m, &t);
    }
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
    show_step(m, &after, force);
    memcpy(m->input, inputs, sizeof inputs);
    return fine;
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
