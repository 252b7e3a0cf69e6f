/* Random bearings and motions, meant to run under sanitizers: numbers of balls, directions, race control, inertia, clearance, losses and
 * heights of races and balls are drawn, rings vibrate with lift-off, blows and jumps of the speed, in steps that change. A number that is not finite must come
 * with a reason, and a step that is refused must leave the state as it was. bearing_data.h has the tables. Arguments: number of steps,
 * seed. Prints steps, how many were refused though the ring's motion was finite, and how often a ball lost its load. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bearing.h"
#include "bearing_data.h"

enum { PER_BEARING = 2500, MOST_BALLS = 24, PLACES = 64, COLUMNS = 6 };
static const double slow = 2e-4; /* s, in which half of a motion is there */

static unsigned long long seed = 1;

static double uniform(double low, double high)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static int any(int n)
{
    return (int)uniform(0.0, n) % n;
}

static void fail(const char *text)
{
    fprintf(stderr, "%s\n", text);
    exit(1);
}

static int all_finite(const double x[], size_t n)
{
    size_t i;
    for (i = 0; i < n && isfinite(x[i]); i++) {
    }
    return i == n;
}

/* Waves on one race, and on some balls, which are larger than others. */
static const HeightTables *drawn_heights(int balls)
{
    static double pages[2][PLACES + 1][COLUMNS];
    static const HeightTables heights = {2, PLACES + 1, COLUMNS, &pages[0][0][0]};
    const unsigned long long motion = seed; /* rings move as they would without heights */
    const double size = pow(10.0, uniform(-9.0, -6.5));
    const int waves = 1 + any(9);
    int i, j;
    memset(pages, 0, sizeof pages);
    pages[0][0][1 + any(2)] = 1.0;
    for (i = 1; i <= balls; i++) {
        pages[0][i][0] = uniform(-1.0, 1.0) * 1e-7;
        pages[0][i][1] = any(2);
        pages[0][i][2] = any(2);
    }
    for (i = 0; i < PLACES; i++) {
        for (j = 0; j < COLUMNS; j++) {
            pages[1][i][j] = size * cos(6.28 * waves * i / PLACES) / (1.0 + j);
        }
    }
    pages[1][PLACES][0] = COLUMNS / sqrt(2e-5);
    seed = motion;
    return &heights;
}

static Bearing drawn(void)
{
    static const int most[3] = {2, 3, 5};
    static BallOrigin origins[MOST_BALLS];
    static int bearings = 0;
    Bearing b = bearing;
    int k;
    b.balls = 3 + any(MOST_BALLS - 2);
    b.control = any(4);
    b.grooves.gyroscopic = b.control == HARRIS_CONTROL ? -1.0 : 1.0;
    b.directions = b.grooves.axial != 0.0 ? 5 : most[any(3)];
    b.inertia = any(3) == 0 ? b.grooves.mass : 0.0;
    b.filters = any(2) == 0 ? 0 : b.filters;
    for (k = 0; k < b.balls; k++) {
        origins[k] = bearing.origin[0];
    }
    b.origin = origins;
    b.heights = ++bearings % 2 == 0 ? NULL : drawn_heights(b.balls);
    return b;
}

/* A vibration in every direction about a place, now and then far enough for balls to part. */
typedef struct {
    double middle[MOST_DIRECTIONS], size[MOST_DIRECTIONS], turn[MOST_DIRECTIONS];
} Vibration;

static Vibration vibration(const Bearing *b)
{
    Vibration v;
    int j;
    for (j = 0; j < b->directions; j++) {
        const double arm = b->direction[j] < TILT_X ? 1.0 : 1.0 / b->grooves.circle;
        v.middle[j] = uniform(-1.0, 1.0) * 5e-6 * arm;
        v.size[j] = pow(10.0, uniform(-8.0, -5.0)) * arm;
        v.turn[j] = 6.28 * pow(10.0, uniform(1.5, 3.7));
    }
    return v;
}

/* A motion from rest. Where the races share friction by their forces there may be no rest (docs/notes/bearings.md): then another motion. Returns how many
 * bearings have none without that reason. */
static int begin_motion(const Bearing *b, double state[], double work[], double omega, Vibration *vibrates)
{
    double force[MOST_DIRECTIONS];
    int i;
    for (i = 0; i < 100; i++) {
        *vibrates = vibration(b);
        if (bearing_rest(b, state, work, omega, vibrates->middle, force) == NULL) {
            return 0;
        }
        if (b->control == OUTER_CONTROL || b->control == HARRIS_CONTROL) {
            break;
        }
    }
    return 1;
}

/* Rates of the states that a step has left: those of model exchange. */
static void check_rates(const Bearing *b, const double state[], double work[], const double q[], const double v[], double omega)
{
    const size_t size = bearing_state_size(b), n = (size_t)bearing_states(b);
    double *copy = malloc(size * sizeof *copy), *values = malloc(n * sizeof *values);
    Dual *states = malloc(n * sizeof *states), *rates = malloc(n * sizeof *rates), force[MOST_DIRECTIONS];
    BallOutputs balls[MOST_BALLS];
    RingMotion ring;
    size_t i;
    int j;
    memcpy(copy, state, size * sizeof *copy);
    bearing_states_of_step(b, state, values);
    for (i = 0; i < n; i++) {
        states[i] = dual(values[i], uniform(-1e-9, 1e-9));
    }
    for (j = 0; j < b->directions; j++) {
        ring.q[j] = dual(q[j], uniform(-1e-9, 1e-9));
        ring.v[j] = number(v[j]);
    }
    ring.omega = number(omega);
    if (bearing_rates(b, copy, work, &ring, 0, states, rates, force, balls) == NULL) {
        for (i = 0; i < n; i++) {
            if (!isfinite(rates[i].x) || !isfinite(rates[i].d)) {
                fail("a rate is not finite");
            }
        }
    }
    free(copy);
    free(values);
    free(states);
    free(rates);
}

int main(int argc, char **argv)
{
    const long count = argc > 1 ? atol(argv[1]) : 1000;
    long made = 0, refused = 0, parted = 0;
    seed += argc > 2 ? (unsigned long long)atol(argv[2]) : 0;
    while (made < count) {
        const Bearing b = drawn();
        const BearingSettings settings = {b.grooves.clearance * uniform(0.0, 2.0), b.directions > 2 ? uniform(-1e-5, 1e-5) : 0.0,
                                          uniform(-3.0, 3.0), b.race[0].nodes > 0 && any(4) > 0 ? 1.0 : 0.0};
        const size_t size = bearing_state_size(&b);
        double *state = malloc(size * sizeof *state), *work = malloc(bearing_work_size(&b) * sizeof *work);
        double *kept = malloc(size * sizeof *kept), omega = b.most_speed * uniform(0.05, 1.0), h = 1e-5, t = 0.0;
        double q[MOST_DIRECTIONS], v[MOST_DIRECTIONS], force[MOST_DIRECTIONS], slopes[2][MOST_DIRECTIONS * MOST_DIRECTIONS];
        Vibration vibrates;
        int i, j, k, loaded[MOST_BALLS] = {0};
        if (bearing_start(&b, &settings, state) != NULL) {
            fail("settings are refused");
        }
        refused += begin_motion(&b, state, work, omega, &vibrates);
        for (i = 0; i < PER_BEARING && made < count; i++, made++) {
            const char *reason;
            if (any(300) == 0) { /* another motion, which grows from rest */
                refused += begin_motion(&b, state, work, omega, &vibrates);
                t = 0.0;
            }
            h = any(20) == 0 ? pow(10.0, uniform(-6.0, -4.5)) : h;
            omega = any(100) == 0 ? (any(4) == 0 ? 0.0 : b.most_speed * uniform(0.0, 1.2)) : omega;
            t += h;
            for (j = 0; j < b.directions; j++) {
                const double turn = vibrates.turn[j], size_now = vibrates.size[j] * t / (t + slow), grows = slow / ((t + slow) * (t + slow));
                q[j] = vibrates.middle[j] + size_now * sin(turn * t);
                v[j] = size_now * turn * cos(turn * t) + vibrates.size[j] * grows * sin(turn * t);
            }
            if (any(500) == 0) {
                v[0] = any(2) == 0 ? NAN : 0.01;
            }
            memcpy(kept, state, size * sizeof *state);
            bearing_begin(&b, state, work, h, omega);
            reason = bearing_press(&b, state, work, q, v, force);
            if (reason != NULL) {
                refused += isfinite(v[0]) != 0;
                if (memcmp(kept, state, size * sizeof *state) != 0) {
                    fail("a step that was refused changed the state");
                }
                continue;
            }
            bearing_slopes(&b, work, slopes[0], slopes[1]);
            bearing_accept(&b, state, work);
            if (!all_finite(force, (size_t)b.directions) || !all_finite(state, size)
                || !all_finite(slopes[0], (size_t)(b.directions * b.directions))
                || !all_finite(slopes[1], (size_t)(b.directions * b.directions))) {
                fail("a number is not finite, and no reason is given");
            }
            for (k = 0; k < b.balls; k++) {
                const double load = ball_of(state, k)->force[INNER_RACE];
                if (load < 0.0) {
                    fail("a race pulls a ball");
                }
                parted += loaded[k] && load <= 0.0;
                loaded[k] = load > 1.0 || (loaded[k] && load > 0.0);
            }
            if (any(50) == 0) {
                check_rates(&b, state, work, q, v, omega);
            }
        }
        free(state);
        free(work);
        free(kept);
    }
    printf("%ld %ld %ld\n", made, refused, parted);
    return 0;
}
