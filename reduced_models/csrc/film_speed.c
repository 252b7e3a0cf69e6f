/* Film laws over the speed of the surfaces; see film_speed.h. */
#include "film_speed.h"

#include <math.h>
#include <string.h>

static const double standstill = 1e-6; /* of the lowest speed of the tables */
static const double growth = 0.67;     /* of films with speed (Hamrock and Dowson 1977) */
static const double few_moments = 3.0;

/* Magnitude of a speed within the tables; that which stands for 0 at standstill. */
static double moving(const FilmSpeeds *range, double speed)
{
    return fmax(fmin(fabs(speed), range->speed[range->speeds - 1]), standstill * range->speed[0]);
}

static double linear(double low, double w, double high)
{
    return low + w * (high - low);
}

/* Law at a constant speed > 0. */
static FilmLaw law_at(const FilmSpeeds *range, double speed, double room[])
{
    int i, k = 0;
    while (k < range->speeds - 2 && range->speed[k + 1] < speed) {
        k++;
    }
    {
        const FilmLaw *a = &range->law[k], *b = a + 1;
        const double low = range->speed[k], high = range->speed[k + 1];
        const int count = a->rows * (DIRECT + a->lags);
        double *y = room, *slope = y + a->nodes, *u = slope + a->nodes, *gains = u + a->nodes;
        FilmLaw law = *a;
        if (speed < low) {
            const double share = pow(speed / low, growth), thinner = log(share);
            for (i = 0; i < a->nodes; i++) {
                y[i] = a->y[i] + thinner;
                slope[i] = a->slope[i];
            }
            for (i = 0; i < count; i++) {
                gains[i] = a->gains[i] * share;
            }
        } else {
            double w = log(speed / low) / log(high / low);
            for (i = 0; i < a->nodes; i++) {
                y[i] = linear(a->y[i], w, b->y[i]);
                slope[i] = linear(a->slope[i], w, b->slope[i]);
            }
            law.inlet_saturation = linear(a->inlet_saturation, w, b->inlet_saturation);
            w = (pow(speed / low, growth) - 1.0) / (pow(high / low, growth) - 1.0);
            for (i = 0; i < count; i++) {
                gains[i] = linear(a->gains[i], w, b->gains[i]);
            }
        }
        for (i = 0; i < a->nodes; i++) {
            u[i] = exp(2.0 / 3.0 * a->x[i]) - exp(y[i]);
        }
        law.y = y;
        law.slope = slope;
        law.u = u;
        law.gains = gains;
        return law;
    }
}

/* Of surfaces at `slowed` times the speed of the film: what the film at the inlet resists depends on its thickness. */
static FilmLaw slow_law(FilmLaw law, double slowed, double gains[])
{
    int row, k;
    for (row = 0; row < law.rows && slowed != 1.0; row++) {
        for (k = 0; k < DIRECT; k++) {
            gains[row * (DIRECT + law.lags) + k] *= slowed;
        }
    }
    law.inlet_rate /= slowed;
    law.fast_rate /= slowed;
    law.inlet_saturation *= slowed;
    law.rim *= slowed;
    return law;
}

static double *gains_in(const FilmLaw *law, double room[])
{
    return room + 3 * law->nodes;
}

FilmLaw speed_law(const FilmSpeeds *range, const SpeedHistory *history, double room[])
{
    const FilmLaw law = law_at(range, history->film, room);
    return slow_law(law, history->slowed, gains_in(&law, room));
}

SpeedHistory speed_constant(const FilmSpeeds *range, double speed)
{
    SpeedHistory history;
    int k;
    history.speed = speed;
    history.pace = history.film = moving(range, speed);
    history.slowed = 1.0;
    for (k = 0; k < MOST_AGES; k++) {
        history.ages[k] = k < AGES + range->law[0].lags ? pow(history.film, growth) : 0.0;
    }
    return history;
}

/* One lag at the end of a step whose input goes straight from `start` to `end`. */
static double lag(double old, double start, double end, double rate, double span)
{
    Moments r;
    const double kept = lag_moments(rate * span, few_moments, &r);
    return old * kept + start * r.r1 + end * (r.r0 - r.r1);
}

/* Advances the filters of the speed over a step of length `span` in own time, at whose end their input is z. */
static void speed_step(const FilmLaw *law, double ages[], double z, double span, double slowed)
{
    const double start = ages[NOW_SPEED], inlet = law->inlet_rate / slowed, before = ages[SLOW_INLET];
    const double s = lag(before, start, z, inlet, span);
    /* into the chain goes s: its ends, and a bump that keeps its mean */
    const double mean = 0.5 * (start + z) - (s - before) / (inlet * span), bump = mean - 0.5 * (before + s);
    const double mu = law->lag_rate * span;
    double poisson[MOST_LAGS + 3], share[MOST_LAGS + 3], held[MOST_LAGS] = {0.0};
    int j;
    ages[QUICK] = lag(ages[QUICK], start, z, law->fast_rate / slowed, span);
    ages[NOW_SPEED] = z;
    ages[SLOW_INLET] = s;
    poisson_shares(mu, law->lags + 2, law->lags + 2.0, poisson, share);
    pass_on(law->lags, &ages[AGES], poisson, held);
    for (j = 1; j <= law->lags; j++) {
        const Moments r = chain_moments(j, 1.0 / mu, share);
        ages[AGES + j - 1] = held[j - 1] + before * r.r1 + s * (r.r0 - r.r1) + 6.0 * bump * (r.r1 - r.r2);
    }
}

/* Speed of the film to the power of `growth`: filters weighed with the gains at x = ln F. */
static double film_speed(const FilmLaw *law, double x, const double ages[])
{
    const int size = DIRECT + law->lags, last = law->rows - 2;
    double weight = 0.0, total = 0.0, gains = 0.0;
    int row = 0, k;
    while (row < last && law->gain_x[row + 1] < x) {
        row++;
    }
    if (last >= 0) {
        weight = fmin(fmax((x - law->gain_x[row]) / (law->gain_x[row + 1] - law->gain_x[row]), 0.0), 1.0);
    }
    for (k = 0; k < size; k++) {
        const double low = law->gains[row * size + k];
        const double gain = weight > 0.0 ? linear(low, weight, law->gains[(row + 1) * size + k]) : low;
        total += gain * ages[k];
        gains += gain;
    }
    return total / gains;
}

FilmLaw speed_begin(const FilmSpeeds *range, double speed, double length, double state[], SpeedHistory *history, double room[],
                    double *own)
{
    const double rolling = moving(range, speed), z = pow(rolling, growth);
    const double pace = moving(range, 0.5 * (fabs(history->speed) + fabs(speed)));
    const int size = AGES + range->law[0].lags;
    double film = rolling, slowed;
    int k, changing = 0;
    *own = length * pace;
    state[RATE] *= history->pace / pace;
    for (k = 0; k < size; k++) {
        changing |= history->ages[k] != z;
    }
    if (changing) {
        const FilmLaw before = law_at(range, history->film, room);
        Rest rest;
        film_static(&before, state[APPROACH] + 0.5 * *own * state[RATE] / state[THETA], NULL, &rest);
        speed_step(&before, history->ages, z, *own / sqrt(rest.g), fmin(1.0, pace / history->film));
        film = pow(film_speed(&before, rest.x, history->ages), 1.0 / growth);
    }
    slowed = fmin(1.0, pace / film);
    state[INLET] *= history->slowed / slowed;
    state[FAST] *= history->slowed / slowed;
    history->speed = speed;
    history->pace = pace;
    history->film = film;
    history->slowed = slowed;
    return speed_law(range, history, room);
}
