/* What a bearing shows: loads, films, torque and bounds of its tables; see bearing.h. */
#include <math.h>

#include "bearing.h"
#include "rolling.h"

enum { CENTRAL, SMALLEST, MOMENT, QUANTITIES }; /* of the tables of films */
static const double film_growth = 0.67; /* of the film with speed (Hamrock and Dowson 1977): between two speeds films add so */
static const double by_rounding = 1e-9;

SpeedRow speed_row(const Bearing *b, double omega)
{
    const double rolling = fmin(film_speed(b, omega), b->speed[b->speeds - 1]);
    SpeedRow at = {0, 0.0, 0.0};
    double low, high;
    if (b->speeds == 1) {
        return at;
    }
    while (at.row < b->speeds - 2 && rolling > b->speed[at.row + 1]) {
        at.row++;
    }
    low = pow(b->speed[at.row], film_growth);
    high = pow(b->speed[at.row + 1], film_growth);
    at.weight = (pow(rolling, film_growth) - low) / (high - low);
    at.slope = rolling == fabs(omega) && fabs(omega) > b->speed[0] ? film_growth * pow(rolling, film_growth - 1.0) / (high - low) : 0.0;
    return at;
}

/* Where films stand in their tables: rows of speeds, and share of the next; loads and their nodes. */
typedef struct {
    int row, node;
    Dual by_speed, by_load;
} FilmPlace;

static FilmPlace film_place_at(const Bearing *b, int race, Dual omega, Dual load)
{
    const FilmTables *films = &b->films;
    const double x = load.x > 0.0 ? (log(load.x) - films->first[race]) / films->step[race] : 0.0;
    FilmPlace at = {0, 0, {0.0, 0.0}, {0.0, 0.0}};
    if (b->speeds > 1) {
        const double rolling = fmin(film_speed(b, omega.x), b->speed[b->speeds - 1]);
        double per_ratio;
        at.row = speed_row(b, omega.x).row;
        per_ratio = 1.0 / log(b->speed[at.row + 1] / b->speed[at.row]);
        at.by_speed.x = per_ratio * log(rolling / b->speed[at.row]);
        at.by_speed.d = rolling == fabs(omega.x) ? per_ratio / omega.x * omega.d : 0.0;
    }
    if (x >= films->nodes - 1) {
        at.node = films->nodes - 2;
        at.by_load = number(1.0);
    } else if (x > 0.0) {
        at.node = (int)x;
        at.by_load = dual(x - at.node, load.d / (load.x * films->step[race]));
    }
    return at;
}

static Dual between(const double *here, Dual share)
{
    return dual(here[0] + share.x * (here[1] - here[0]), share.d * (here[1] - here[0]));
}

/* A quantity of a film, tabulated as its logarithm over those of load and speed. */
static Dual of_table(const Bearing *b, int race, int what, FilmPlace at)
{
    const int nodes = b->films.nodes;
    const double *here = &b->films.table[((race * b->speeds + at.row) * QUANTITIES + what) * nodes + at.node];
    Dual y = between(here, at.by_load);
    if (b->speeds > 1) {
        y = add(y, mul(at.by_speed, sub(between(here + QUANTITIES * nodes, at.by_load), y)));
    }
    return chained(exp(y.x), exp(y.x), y);
}

/* Central and smallest film of a contact, and the torque that it takes from the inner ring. */
static void films_of(const Bearing *b, int race, Dual omega, const BallOutputs *ball, Dual films[QUANTITIES])
{
    const FilmPlace at = film_place_at(b, race, omega, ball->load[race]);
    const Dual arm = times(0.5 / b->films.rolling_radius[race], ball->speed_sum[race]);
    films[CENTRAL] = mul(ball->factor[race], of_table(b, race, CENTRAL, at));
    films[SMALLEST] = mul(ball->factor[race], of_table(b, race, SMALLEST, at));
    films[MOMENT] = omega.x != 0.0 ? mul(arm, of_table(b, race, MOMENT, at)) : number(0.0);
}

/* Central film of a contact; of one that hardly carries the gap of rigid bodies. */
static Dual separation(const Bearing *b, int race, const BallOutputs *ball, Dual film)
{
    const Dual load = ball->load[race], two_thirds = number(2.0 / 3.0);
    if (load.x > 0.0 && log(load.x) >= b->films.first[race]) {
        return film;
    }
    return sub(load.x > 0.0 ? power(times(1.0 / b->race[race].kn, load), two_thirds) : number(0.0), ball->approach[race]);
}

/* Between the rings: contacts of a ball in series, balls in parallel. */
static Dual capacitance_of(const Bearing *b, Dual omega, const BallOutputs balls[])
{
    Dual all = number(0.0);
    int k, race;
    for (k = 0; k < b->balls; k++) {
        Dual inverse = number(0.0);
        for (race = 0; race < 2; race++) {
            const BallOutputs *ball = &balls[k];
            Dual films[QUANTITIES], own;
            films_of(b, race, omega, ball, films);
            own = b->capacitance[race].of(&b->capacitance[race], ball->load[race], separation(b, race, ball, films[CENTRAL]), ball->angle[race]);
            inverse = add(inverse, over(number(1.0), own));
        }
        all = add(all, over(number(1.0), inverse));
    }
    return all;
}

int ball_outputs(const Bearing *b, int wet, Dual omega, const BallOutputs *ball, Dual outputs[])
{
    int race, n = 0;
    for (race = 0; race < 2; race++) {
        outputs[n++] = ball->load[race];
        if (b->films.nodes > 0) {
            Dual films[QUANTITIES] = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
            if (wet) {
                films_of(b, race, omega, ball, films);
            }
            outputs[n++] = films[CENTRAL];
            outputs[n++] = films[SMALLEST];
        }
        if (is_angular(b)) {
            outputs[n++] = ball->angle[race];
        }
    }
    return n;
}

int bearing_outputs(const Bearing *b, int wet, Dual omega, const Dual force[], const BallOutputs balls[], Dual outputs[])
{
    Dual largest[2] = {{0.0, 0.0}, {0.0, 0.0}}, smallest = number(wet ? HUGE_VAL : 0.0), torque = number(0.0);
    int k, race, j, too_fast, overloaded, n = 0;
    for (k = 0; k < b->balls; k++) {
        for (race = 0; race < 2; race++) {
            if (balls[k].load[race].x > largest[race].x) {
                largest[race] = balls[k].load[race];
            }
            if (wet) {
                Dual films[QUANTITIES];
                films_of(b, race, omega, &balls[k], films);
                torque = add(torque, films[MOMENT]);
                smallest = films[SMALLEST].x < smallest.x ? films[SMALLEST] : smallest;
            }
        }
    }
    for (j = 0; j < b->directions; j++) {
        outputs[n++] = times(-1.0, force[j]);
    }
    outputs[n++] = largest[INNER_RACE];
    outputs[n++] = largest[OUTER_RACE];
    if (b->films.nodes > 0) {
        outputs[n++] = smallest;
        outputs[n++] = torque;
        if (b->films.roughness > 0.0) {
            outputs[n++] = times(1.0 / b->films.roughness, smallest);
        }
        if (b->capacitance[INNER_RACE].of != NULL) {
            outputs[n++] = wet ? capacitance_of(b, omega, balls) : number(0.0);
        }
    }
    too_fast = fabs(omega.x) > (1.0 + by_rounding) * b->most_speed;
    overloaded = largest[INNER_RACE].x > b->most_load[INNER_RACE] || largest[OUTER_RACE].x > b->most_load[OUTER_RACE];
    outputs[n++] = number(too_fast || overloaded);
    outputs[n++] = number(too_fast);
    outputs[n++] = number(overloaded);
    return n;
}

double bearing_torque(const Bearing *b, const double outputs[])
{
    return b->films.nodes > 0 ? outputs[b->directions + 3] : 0.0;
}

void bearing_balls(const Bearing *b, const double state[], BallOutputs balls[])
{
    int k, race;
    for (k = 0; k < b->balls; k++) {
        const Ball *ball = ball_of(state, k);
        for (race = 0; race < 2; race++) {
            balls[k].load[race] = number(ball->force[race]);
            balls[k].approach[race] = number(film_of(b, state, k, race)->approach);
            balls[k].film[race] = ball->film[race];
            balls[k].factor[race] = number(ball->factor[race][0]);
            balls[k].speed_sum[race] = number(ball->speed_sum[race][0]);
            balls[k].angle[race] = number(atan2(ball->sine[race], ball->cosine[race]));
        }
    }
}

int bearing_outputs_of_step(const Bearing *b, const double state[], BallOutputs balls[], double outputs[])
{
    Dual force[MOST_DIRECTIONS], all[MOST_OUTPUTS];
    int i, n;
    for (i = 0; i < b->directions; i++) {
        force[i] = number(state[seat_place(b, 0) + (size_t)i]);
    }
    bearing_balls(b, state, balls);
    n = bearing_outputs(b, is_wet(b, state), number(head_of(state)->omega), force, balls, all);
    for (i = 0; i < n; i++) {
        outputs[i] = all[i].x;
    }
    return n;
}
