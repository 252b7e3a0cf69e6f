/* All balls of a bearing in steps: their cage, and the force of the inner ring. */
#include "ball.h"

#include <math.h>
#include <string.h>

enum { RENEWED = 16 }; /* steps after which the slopes of centrifugal force and gyroscopic moment are renewed */
static const char *const no_balance = "a ball finds no balance: a shorter step, or a smaller displacement, can help";

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
    sizes[10] = sizeof(BallAtRest);
    sizes[11] = sizeof(BallOrigin);
    sizes[12] = sizeof(RingMotion);
    sizes[13] = sizeof(BallOutputs);
}

static StepFilters *filters_in(const Bearing *b, double work[], int k, int race)
{
    const size_t size = FILTER_NUMBERS + 3 * (size_t)b->lags;
    return (StepFilters *)(void *)(work + STEP_NUMBERS + (size_t)b->balls * BALL_STEP_NUMBERS + (size_t)(2 * k + race) * size);
}

void search_of(const Bearing *b, const double state[], double work[], int k, const Race races[2], Search *s)
{
    static const double none[5][4] = {{0.0}}; /* of a shaft that stands still */
    int race;
    s->bearing = b;
    s->step = step_of(work);
    s->ball = ball_in(work, k);
    s->dry = races;
    s->surface = b->heights != NULL ? surface_of(b, state, k) : NULL;
    s->heavy = b->inertia * s->step->gain * s->step->gain;
    s->inertia = s->step->omega != 0.0 ? ball_of(state, k)->inertia : none;
    for (race = 0; race < 2; race++) {
        RaceStep *c = &s->contact[race];
        c->race = &races[race];
        c->at = s->step->row;
        c->transit = s->ball->transit[race];
        c->film = films_vary(b) && races[race].nodes > 0 ? &s->ball->thickness[race] : NULL;
        c->before = film_of(b, state, k, race);
        c->filters = filters_in(b, work, k, race);
    }
}

void races_of(const Bearing *b, const double state[], Race races[2])
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

/* A positive number that goes on as in the last two steps; however long this step is after a short one, it stays positive. */
static double continued(const double last[2], double share)
{
    const double next = last[0] + share * (last[0] - last[1]);
    return next < 0.5 * last[0] ? 0.5 * last[0] : next > 2.0 * last[0] ? 2.0 * last[0] : next;
}

/* What a contact finds in a step: films and entrainment speeds change slowly and go on as in the last two steps. */
static void begin_contact(const Bearing *b, const Ball *old, int race, double ratio, RaceStep *c, BallStep *ball, const StepHead *step)
{
    const double speed = film_speed(b, step->omega);
    const double middle = continued(old->speed_sum[race], 0.5 * ratio), end = continued(old->speed_sum[race], ratio);
    ball->thickness[race].factor = continued(old->factor[race], ratio);
    ball->thickness[race].lift = old->lift[race];
    if (speed > 0.0 && step->h > 0.0) {
        c->transit = c->race->contact_length_factor / (middle * speed);
        race_prepare(c, step->h);
    } else {
        race_at_rest(c);
    }
    ball->transit[race] = speed > 0.0 ? c->race->contact_length_factor / (end * speed) : 0.0;
}

double height_at(const Bearing *b, const double state[], int k, int race, double psi, double shaft, double own)
{
    const double force = ball_of(state, k)->force[race];
    double pressed;
    if (b->heights->pages == 0) {
        return 0.0;
    }
    pressed = force > 0.0 ? pow(force / b->race[race].kn, 2.0 / 3.0) : film_of(b, state, k, race)->approach;
    return contact_height(b->heights, k, race, psi, shaft, own, pressed - surface_of(b, state, k)->height[race][0]);
}

void bearing_begin(const Bearing *b, const double state[], double work[], double h, double omega)
{
    const BearingHead *old = head_of(state);
    const double ratio = h > 0.0 ? (old->h > 0.0 ? h / old->h : 1.0) : 0.0;
    const double turns = b->cage_held ? 0.0 : old->cage[0] + 0.5 * ratio * (old->cage[0] - old->cage[1]);
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
    step->cage = h > 0.0 && !b->cage_held ? omega * old->cage[0] : 0.0;
    step->angle = old->angle + swept * turns;
    step->row = speed_row(b, omega);
    for (k = 0; k < b->balls; k++) {
        const double psi = step->angle + two_pi * k / b->balls, moved = old->h > 0.0 ? h / old->h : 0.0;
        const Ball *last = ball_of(state, k);
        BallStep *ball = ball_in(work, k);
        Search s;
        ball->x = cos(psi);
        ball->y = sin(psi);
        memset(ball->tried, 0, sizeof ball->tried);
        memset(ball->follow, 0, sizeof ball->follow);
        memset(ball->inertia, 0, sizeof ball->inertia);
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
        BallStep *ball = ball_in(work, k);
        Search s;
        place_groove(b, step, q, v, settings->clearance, settings->offset, ball);
        search_of(b, state, work, k, races, &s);
        if (!place_ball(&s)) {
            if (at_rest(&s)) {
                ball->start[0] = 0.0; /* it has no place */
            }
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

/* Moves a ball and its films to the end of the step; returns its speed about the axis, over that of the bearing. */
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
        const double turned = 0.5 * step->h * (head_of(state)->omega + step->omega); /* by the shaft */
        surface->angle += turned * surface->rotation;
        surface->rotation = b->grooves.sense * at.rotation;
        for (race = 0; race < 2; race++) {
            surface->height[race][1] = moving ? surface->height[race][0] : now->height[race];
            surface->height[race][0] = now->height[race];
            if (moving && now->force[race] > surface->largest[race]) {
                surface->largest[race] = now->force[race];
            }
            if (moving && now->force[race] > 0.0) {
                const double force = now->force[race], cubed = fabs(turned) * (force * force * force);
                surface->fatigue[race][0] += cubed;
                surface->fatigue[race][1] += cubed * cbrt(force);
            }
        }
    }
    return about_axis(&b->grooves, number(at.orbit)).x;
}

void bearing_accept(const Bearing *b, double state[], double work[])
{
    static const double none[2] = {0.0};
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
        if (step->omega != 0.0 && (step->h == 0.0 || (inclined && (shared_by_forces(b) || ((int)head->steps + k) % RENEWED == 0)))) {
            renew_slopes(&s, s.ball->place, none, none, ((Ball *)(void *)(state + HEAD_NUMBERS))[k].inertia);
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

int bearing_drive(const Bearing *b, double state[], double work[], double h, double omega, int steps, const double q[],
                  const double v[], double force[], double loads[], double stiffness[], double damping[])
{
    const size_t directions = (size_t)b->directions, balls = (size_t)b->balls;
    int i, k;
    for (i = 0; i < steps; i++) {
        const size_t row = (size_t)i * directions;
        bearing_begin(b, state, work, h, omega);
        if (bearing_press(b, state, work, q + row, v + row, force + row) != NULL) {
            break;
        }
        if (stiffness != NULL) {
            bearing_slopes(b, work, stiffness + row * directions, damping + row * directions);
        }
        bearing_accept(b, state, work);
        for (k = 0; k < b->balls && loads != NULL; k++) {
            memcpy(loads + ((size_t)i * balls + (size_t)k) * 2, ball_of(state, k)->force, sizeof ball_of(state, k)->force);
        }
    }
    return i;
}
