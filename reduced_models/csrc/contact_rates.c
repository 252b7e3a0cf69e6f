/* One contact and the balance of a ball in continuous time; see contact_rates.h. */
#include "contact_rates.h"

#include "rolling.h"

enum { MOST_RATE_STEPS = 60 };
static const double small_step = 1e-14; /* of the rates, that ends the search for w': rounding */

LawSpeed law_speed(const Bearing *b, Dual omega)
{
    const SpeedRow row = speed_row(b, omega.x);
    const double rolling = film_speed(b, omega.x), way = omega.x < 0.0 ? -1.0 : 1.0;
    LawSpeed at;
    at.row = row.row;
    at.weight = chained(row.weight, way * row.slope, omega);
    at.rolling = dual(rolling, rolling == fabs(omega.x) ? way * omega.d : 0.0);
    return at;
}

/* ---- one contact ---- */

/* An entry of a table between two rows of speeds, which are `stride` entries apart. */
static Dual of_rows(const double *entry, const LawSpeed *at, int stride)
{
    const double more = at->weight.x > 0.0 ? entry[stride] - *entry : 0.0;
    return dual(*entry + at->weight.x * more, at->weight.d * more);
}

/* The same between two nodes of the load, `stride` entries apart. */
static Dual of_nodes(const double *entry, const LawSpeed *at, int rows, int stride, Dual weight)
{
    const Dual low = of_rows(entry, at, rows), high = of_rows(entry + stride, at, rows);
    return add(low, mul(weight, sub(high, low)));
}

/* Dry compression at an approach; of a dry contact it says below zero how far the surfaces have parted. */
static Dual curve_at(const Race *race, const LawSpeed *at, Dual f, Dual u, int *k)
{
    const Thickness film = {f.x, 0.0};
    SpeedRow row = {0, 0.0, 0.0};
    double slope, lift;
    Dual g;
    if (race->nodes == 0) {
        return u;
    }
    row.row = at->row;
    row.weight = at->weight.x;
    g.x = race_gap(race, row, &film, u.x, k, &slope, &lift);
    g.d = slope * (u.d + (g.x - (u.x + lift)) * f.d);
    if (at->weight.x > 0.0 && at->weight.d != 0.0) {
        double any;
        int next = *k, here = *k;
        const double more = race_curve(race, at->row + 1, u.x + lift, &next, &any) - race_curve(race, at->row, u.x + lift, &here, &any);
        g.d += (1.0 - (1.0 - f.x) * slope) * more * at->weight.d;
    }
    return g;
}

Held held(const Race *race, const LawSpeed *at, Dual transit, Dual factor, Dual u, const Dual states[])
{
    const int gains = DIRECT_GAINS + race->lags, gain_rows = race->nodes * gains, last = race->nodes - 2;
    Held h;
    Dual g, x, weight, carried = number(0.0);
    int row = 0, j;
    g = curve_at(race, at, factor, u, &row);
    h.film = g;
    h.dashpot = h.tau = number(0.0);
    h.kn = number(race->kn);
    h.made = number(1.0);
    if (race->nodes == 0) {
        return h;
    }
    h.tau = mul(transit, root(g));
    x = plus(times(1.5, logarithm(g)), race->log_kn);
    while (row > 0 && x.x <= race->x[row]) {
        row--;
    }
    while (row < last && x.x > race->x[row + 1]) {
        row++;
    }
    weight = times(1.0 / (race->x[row + 1] - race->x[row]), plus(x, -race->x[row]));
    if (!(weight.x > 0.0 && weight.x < 1.0)) {
        weight = number(weight.x > 0.0 ? 1.0 : 0.0);
    }
    h.made = of_nodes(&race->made[at->row * race->nodes + row], at, race->nodes, 1, weight);
    for (j = 0; j < gains; j++) {
        const double *entry = &race->gains[at->row * gain_rows + row * gains + j];
        const Dual here = of_nodes(entry, at, gain_rows, gains, weight);
        if (j == 0) {
            h.dashpot = mul(here, h.tau);
        } else if (j < DIRECT_GAINS) {
            h.film = add(h.film, mul(here, states[j - 1]));
        } else {
            carried = add(carried, mul(here, states[j - 1]));
        }
    }
    h.film = add(h.film, over(carried, h.made));
    {
        double slope;
        const double share = race_cutoff(race, u.x, &slope);
        h.kn = dual(race->kn * share, race->kn * slope * u.d);
    }
    return h;
}

Dual pushed(Dual kn, Dual film)
{
    return film.x > 0.0 ? mul(kn, mul(film, root(film))) : number(0.0);
}

double push_slope(Dual kn, Dual film)
{
    return film.x > 0.0 ? 1.5 * kn.x * sqrt(film.x) : 0.0;
}

Dual squeezed(const Held *h, Dual rate)
{
    return add(h->film, mul(h->dashpot, rate));
}

void film_state_rates(const Race *race, const Held *h, Dual rate, const Dual states[], Dual rates[])
{
    const Dual moved = mul(h->tau, rate);
    Dual fed = mul(h->made, states[0]);
    int k;
    rates[0] = over(times(race->inlet_rate, sub(moved, states[0])), h->tau);
    rates[1] = over(times(race->fast_rate, sub(moved, states[1])), h->tau);
    for (k = 2; k < 2 + race->lags; k++) {
        rates[k] = over(times(race->lag_rate, sub(fed, states[k])), h->tau);
        fed = states[k];
    }
}

Dual rest_force(const Race *race, const LawSpeed *at, Dual factor, Dual u)
{
    int k = 0;
    double slope;
    const double share = race_cutoff(race, u.x, &slope);
    const Dual kn = race->nodes == 0 ? number(race->kn) : dual(race->kn * share, race->kn * slope * u.d);
    return pushed(kn, curve_at(race, at, factor, u, &k));
}

/* ---- one ball ---- */

static double within(double z, double low, double high)
{
    return z < low ? low : z > high ? high : z;
}

int balance(const Held *inner, const Held *outer, Dual rate, Dual centrifugal, Dual *own)
{
    const double ai = inner->film.x, di = inner->dashpot.x, ki = inner->kn.x, v = rate.x;
    const double ao = outer->film.x, d_o = outer->dashpot.x, ko = outer->kn.x;
    double low, high, alike, z, scale, slope = 0.0;
    Dual off;
    int i;
    *own = number(0.0);
    if (ko <= 0.0) { /* nothing at the outer race: the ball stays where it is if nothing presses it outward */
        return pushed(inner->kn, squeezed(inner, rate)).x + centrifugal.x == 0.0;
    }
    if (!(di > 0.0 && d_o > 0.0 && isfinite(ai + ao))) {
        return 0;
    }
    low = -ao / d_o;
    high = fmax(v + ai / di, (pow(centrifugal.x / ko, 2.0 / 3.0) - ao) / d_o);
    alike = pow(ki / ko, 2.0 / 3.0);
    z = (alike * (ai + di * v) - ao) / (d_o + alike * di);
    scale = small_step * (fabs(ao) / d_o + fabs(ai) / di);
    for (i = 0; i < MOST_RATE_STEPS; i++) {
        double step;
        Dual film_i, film_o;
        z = within(z, low, high);
        film_i = number(ai + di * (v - z));
        film_o = number(ao + d_o * z);
        slope = push_slope(outer->kn, film_o) * d_o + push_slope(inner->kn, film_i) * di;
        off.x = pushed(outer->kn, film_o).x - pushed(inner->kn, film_i).x - centrifugal.x;
        if (off.x > 0.0) {
            high = z;
        } else {
            low = z;
        }
        step = slope > 0.0 ? -off.x / slope : 0.5 * (high - low);
        if (!(low <= z + step && z + step <= high)) {
            step = 0.5 * (low + high) - z;
        }
        z += step;
        if (fabs(step) <= scale) {
            break;
        }
    }
    own->x = z;
    if (slope > 0.0) { /* what holds the balance along the direction */
        off = sub(sub(pushed(outer->kn, squeezed(outer, *own)), pushed(inner->kn, squeezed(inner, sub(rate, *own)))), centrifugal);
        own->d = -off.d / slope;
    } else if (ai / di + v > -ao / d_o) { /* no force at either race: the ball goes with the inner one */
        own->d = add(rate, over(inner->film, inner->dashpot)).d;
    } else {
        own->d = -over(outer->film, outer->dashpot).d;
    }
    return 1;
}
