/* Force of one ball on one race at the end of a time step; see race_contact.h. */
#include "race_contact.h"

#include <math.h>
#include <string.h>

#include "film_filters.h"

enum { MOST_FILM_STEPS = 100 };
static const double found = 1e-7; /* of g: last step of Newton's method for the film */
static const double cutoff_gap = CUTOFF_GAP;

/* ---- the static curve ---- */

double race_curve(const Race *race, int row, double u, int *k, double *slope)
{
    const double *nodes = &race->u[row * race->nodes], *term;
    const int last = race->nodes - 2, *first;
    double start, half, s, value, by_s;
    int i;
    while (*k > 0 && u < nodes[*k]) {
        --*k;
    }
    while (*k < last && u >= nodes[*k + 1]) {
        ++*k;
    }
    start = nodes[*k];
    if (u < start) { /* wider than the table: F like h^-1/2 */
        const double power = 2.0 / 3.0 / RIGID_SLOPE, g = exp(2.0 / 3.0 * (race->x[0] - race->log_kn)) * pow(u / start, power);
        *slope = g / u * power;
        return g;
    }
    half = 0.5 * (nodes[*k + 1] - start);
    s = (u - start) / half - 1.0;
    first = &race->first[row * (last + 1) + *k];
    term = &race->curve[first[0]];
    i = first[1] - first[0] - 1;
    value = term[i];
    by_s = 0.0;
    start = s > 1.0 ? 1.0 : s; /* beyond the table: straight on */
    while (--i >= 0) {
        by_s = by_s * start + value;
        value = value * start + term[i];
    }
    *slope = by_s / half;
    return value + by_s * (s - start);
}

static double curve(const Race *race, SpeedRow at, double u, int *k, double *slope)
{
    double g, other_slope;
    if (race->nodes == 0) {
        *slope = u > 0.0 ? 1.0 : 0.0;
        return u > 0.0 ? u : 0.0;
    }
    g = race_curve(race, at.row, u, k, slope);
    if (at.weight > 0.0) {
        int next = *k;
        const double other = race_curve(race, at.row + 1, u, &next, &other_slope);
        g += at.weight * (other - g);
        *slope += at.weight * (other_slope - *slope);
    }
    return g;
}

double race_gap(const RaceStep *c, double u, double *slope, double *lift)
{
    const Race *race = c->race;
    double f, v, g = 0.0, stretch = 1.0;
    int i;
    *lift = 0.0;
    if (c->film == NULL || race->nodes == 0) {
        return curve(race, c->at, u, &c->filters->interval, slope);
    }
    f = c->film->factor;
    v = u + c->film->lift;
    *slope = 1.0;
    for (i = 0; i < MOST_FILM_STEPS; i++) {
        double step;
        g = curve(race, c->at, v, &c->filters->interval, slope);
        stretch = (1.0 - f) * *slope + f;
        step = (u - (1.0 - f) * g - f * v) / stretch;
        v += step;
        g += *slope * step;
        if (fabs(step) <= found * g) {
            break;
        }
    }
    *slope /= stretch;
    *lift = v - u;
    return g;
}

/* ---- gains ---- */

static double gain(const RaceStep *c, int node, int k)
{
    const Race *race = c->race;
    const double *at = &race->gains[(c->at.row * race->nodes + node) * RACE_GAINS + k];
    return c->at.weight > 0.0 ? *at + c->at.weight * (at[race->nodes * RACE_GAINS] - *at) : *at;
}

static double made_at(const RaceStep *c, int node)
{
    const Race *race = c->race;
    const double *at = &race->made[c->at.row * race->nodes + node];
    return c->at.weight > 0.0 ? *at + c->at.weight * (at[race->nodes] - *at) : *at;
}

static double film_made(const RaceStep *c, double x)
{
    const double *nodes = c->race->x;
    const int last = c->race->nodes - 2;
    const double first = (x - nodes[0]) / (nodes[last + 1] - nodes[0]) * last; /* near it: nodes are nearly even */
    int k = !(first > 0.0) ? 0 : first >= last ? last : (int)first;
    double here, weight;
    while (k > 0 && x < nodes[k]) {
        k--;
    }
    while (k < last && x > nodes[k + 1]) {
        k++;
    }
    here = made_at(c, k);
    weight = (x - nodes[k]) / (nodes[k + 1] - nodes[k]);
    weight = weight < 0.0 ? 0.0 : weight > 1.0 ? 1.0 : weight;
    return here + weight * (made_at(c, k + 1) - here);
}

double race_cutoff(double u, double *slope)
{
    const double gap = -u / cutoff_gap, t = 2.0 * gap - 1.0;
    *slope = 0.0;
    if (!(gap > 0.5)) {
        return 1.0;
    }
    if (gap >= 1.0) {
        return 0.0;
    }
    *slope = 12.0 * t * (1.0 - t) / cutoff_gap;
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

/* ---- filters of a step ---- */

/* One lag at the end of a step that travels t at an own rate from `start` to e. */
static void one_lag(double old, double start, double rate, double span, double sums[3])
{
    Moments r;
    const double kept = lag_moments(rate * span, &r), hump = r.r1 - r.r2;
    sums[0] = old * kept + start * (r.r1 - 3.0 * hump);
    sums[1] = r.r0 - r.r1 - 3.0 * hump;
    sums[2] = 6.0 * hump / span;
}

void race_prepare(const RaceStep *c, double dt)
{
    const Race *race = c->race;
    const FilmState *before = c->before;
    StepFilters *f = c->filters;
    double poisson[LAGS + 3], share[LAGS + 3];
    double middle, slope, lift, span, p, mu, per_mu, made;
    int j;
    if (race->nodes == 0) {
        return;
    }
    middle = race_gap(c, before->approach + 0.5 * dt * before->rate, &slope, &lift);
    span = dt / (c->transit * sqrt(middle));
    p = race->inlet_rate;
    one_lag(before->inlet, before->own, p, span, f->s);
    one_lag(before->fast, before->own, race->fast_rate, span, f->y);
    mu = race->lag_rate * span;
    made = film_made(c, race->log_kn + 1.5 * log(middle));
    f->middle[0] = -made * (f->s[0] - before->inlet) / (p * span) - 0.5 * before->entered;
    f->middle[1] = -made * f->s[1] / (p * span);
    f->middle[2] = made * (1.0 - f->s[2] / p) / span;
    poisson_shares(mu, LAGS + 2, poisson, share);
    per_mu = 1.0 / mu;
    for (j = 0; j < LAGS; j++) {
        const Moments r = chain_moments(j + 1, per_mu, share);
        f->held[j] = before->entered * r.r1;
        f->ends[j] = r.r0 - r.r1;
        f->humps[j] = 6.0 * (r.r1 - r.r2);
    }
    pass_on(before->chain, poisson, f->held);
    f->weighed = -1;
}

void race_at_rest(StepFilters *filters)
{
    const int interval = filters->interval;
    memset(filters, 0, sizeof *filters);
    filters->interval = interval;
    filters->weighed = -1;
}

/* Sums of the gains of one node over all filters; what the chain carries of earlier films apart. */
static void weigh(const RaceStep *c, int node, double at[3], double carried[3])
{
    const StepFilters *f = c->filters;
    double held = 0.0, ends = 0.0, humps = 0.0, inlet, fast;
    int j;
    for (j = 0; j < LAGS; j++) {
        const double here = gain(c, node, 3 + j);
        held += here * f->held[j];
        ends += here * f->ends[j];
        humps += here * f->humps[j];
    }
    inlet = gain(c, node, 1) + ends - 0.5 * humps;
    fast = gain(c, node, 2);
    for (j = 0; j < 3; j++) {
        at[j] = inlet * f->s[j] + fast * f->y[j];
        carried[j] = humps * f->middle[j];
    }
    at[1] += gain(c, node, 0);
    carried[0] += held;
}

RaceForce race_force(const RaceStep *c, double u, double v)
{
    const Race *race = c->race;
    StepFilters *f = c->filters;
    RaceForce out = {0.0, 0.0, 0.0, 0.0};
    double g_u, lift, root, x, per_x, weight, tau, e, t, here, there, per_made, share, share_u, slope;
    double m0, me, mt, step, q0, qe, qt, more, carried, w, w_u;
    const double g = race_gap(c, u, &g_u, &lift);
    int k = f->interval;
    root = sqrt(g);
    if (race->nodes == 0) {
        out.force = race->kn * g * root;
        out.stiffness = 1.5 * race->kn * root * g_u;
        out.film = u;
        return out;
    }
    x = race->log_kn + 1.5 * log(g);
    while (k > 0 && x < race->x[k]) {
        k--;
    }
    while (k < race->nodes - 2 && x > race->x[k + 1]) {
        k++;
    }
    if (k != f->weighed) {
        weigh(c, k, f->at, f->carried);
        weigh(c, k + 1, f->next, f->next_carried);
        f->weighed = k;
    }
    per_x = 1.0 / (race->x[k + 1] - race->x[k]);
    weight = (x - race->x[k]) * per_x;
    tau = c->transit * root;
    e = tau * v;
    t = u - c->before->approach;
    m0 = f->at[0] + weight * (f->next[0] - f->at[0]);
    me = f->at[1] + weight * (f->next[1] - f->at[1]);
    mt = f->at[2] + weight * (f->next[2] - f->at[2]);
    step = f->next[0] - f->at[0] + (f->next[1] - f->at[1]) * e + (f->next[2] - f->at[2]) * t;
    /* what the chain carries, in shares of the film made at this load */
    here = made_at(c, k);
    there = made_at(c, k + 1);
    per_made = 1.0 / (here + weight * (there - here));
    q0 = f->carried[0] + weight * (f->next_carried[0] - f->carried[0]);
    qe = f->carried[1] + weight * (f->next_carried[1] - f->carried[1]);
    qt = f->carried[2] + weight * (f->next_carried[2] - f->carried[2]);
    more = f->next_carried[0] - f->carried[0] + (f->next_carried[1] - f->carried[1]) * e
           + (f->next_carried[2] - f->carried[2]) * t;
    carried = per_made * (q0 + qe * e + qt * t);
    step += per_made * (more - carried * (there - here));
    w = g + m0 + me * e + mt * t + carried;
    me += per_made * qe;
    mt += per_made * qt;
    out.film = w;
    if (w <= 0.0) {
        return out;
    }
    w_u = g_u + mt + (0.5 * me * e + 1.5 * per_x * step) * g_u / g;
    root = sqrt(w);
    share = race_cutoff(u, &share_u);
    slope = 1.5 * race->kn * root;
    out.force = race->kn * w * root;
    out.stiffness = share * slope * w_u + share_u * out.force;
    out.damping = share * slope * me * tau;
    out.force *= share;
    return out;
}

double race_accept(const RaceStep *c, double u, double v, FilmState *after)
{
    const Race *race = c->race;
    const StepFilters *f = c->filters;
    const double t = u - c->before->approach;
    double g, slope, lift, e, s, hump;
    int j;
    after->approach = u;
    after->rate = v;
    if (race->nodes == 0) {
        return 0.0;
    }
    g = race_gap(c, u, &slope, &lift);
    e = c->transit * sqrt(g) * v;
    s = f->s[0] + f->s[1] * e + f->s[2] * t;
    after->own = e;
    after->inlet = s;
    after->fast = f->y[0] + f->y[1] * e + f->y[2] * t;
    after->entered = s * film_made(c, race->log_kn + 1.5 * log(g));
    hump = f->middle[0] + f->middle[1] * e + f->middle[2] * t - 0.5 * after->entered;
    for (j = 0; j < LAGS; j++) {
        after->chain[j] = f->held[j] + f->ends[j] * after->entered + f->humps[j] * hump;
    }
    return lift;
}
