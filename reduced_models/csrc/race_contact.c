/* Force of one ball on one race at the end of a time step; see race_contact.h. */
#include "race_contact.h"

#include <math.h>
#include <string.h>

#include "film_filters.h"

enum { MOST_FILM_STEPS = 100 };
static const double left = 1e-14;       /* of g: what Newton's method for the film may leave, which is of the square of its last step */
static const double rigid_slope = -2.0; /* of ln F over ln h of a film between surfaces that hardly deform */
static const double few_lags = 0.5;     /* see poisson_shares */

/* ---- the static curve ---- */

/* The curve in an interval of its row by cubics. */
static double by_cells(const double (*cells)[4], double share, int last, double *slope)
{
    const int j = share >= CELLS - 1 ? CELLS - 1 : (int)share;
    const double *at = cells[j], t = share - j;
    if (t > 1.0 && last) { /* an iteration went too far: straight on */
        *slope = at[1] + 2.0 * at[2] + 3.0 * at[3];
        return at[0] + at[1] + at[2] + at[3] + *slope * (t - 1.0);
    }
    *slope = at[1] + t * (2.0 * at[2] + 3.0 * at[3] * t);
    return at[0] + t * (at[1] + t * (at[2] + t * at[3]));
}

double race_curve(const Race *race, int row, double u, int *k, double *slope)
{
    const double *nodes = &race->u[row * race->nodes], *term;
    const int last = race->nodes - 2, *first;
    double start, per_half, s, t, by_s, even[2] = {0.0, 0.0}, odd[2] = {0.0, 0.0}; /* sums of powers, and their slopes */
    int i;
    while (*k > 0 && u < nodes[*k]) {
        --*k;
    }
    while (*k < last && u >= nodes[*k + 1]) {
        ++*k;
    }
    start = nodes[*k];
    if (u < start) { /* wider than the table: F like h^-1/2 */
        const double power = 2.0 / 3.0 / rigid_slope, g = exp(2.0 / 3.0 * (race->x[0] - race->log_kn)) * pow(u / start, power);
        *slope = g / u * power;
        return g;
    }
    if (race->cells != NULL) {
        const double per_cell = CELLS / (nodes[*k + 1] - start), *cells = &race->cells[(row * (last + 1) + *k) * CELLS * 4];
        const double g = by_cells((const double (*)[4])(const void *)cells, (u - start) * per_cell, *k == last, slope);
        *slope *= per_cell;
        return g;
    }
    per_half = 2.0 / (nodes[*k + 1] - start);
    s = (u - start) * per_half - 1.0;
    t = s > 1.0 ? 1.0 : s * s;
    first = &race->first[row * (last + 1) + *k];
    term = &race->curve[first[0]];
    i = first[1] - first[0] - 1;
    if (i % 2 == 0) {
        even[0] = term[i--];
    }
    for (; i > 0; i -= 2) { /* even and odd powers apart: sums of their own do not wait for each other */
        odd[1] = odd[1] * t + odd[0];
        odd[0] = odd[0] * t + term[i];
        even[1] = even[1] * t + even[0];
        even[0] = even[0] * t + term[i - 1];
    }
    start = s > 1.0 ? 1.0 : s; /* beyond the table: straight on */
    by_s = odd[0] + 2.0 * (start * even[1] + t * odd[1]);
    *slope = by_s * per_half;
    return even[0] + start * odd[0] + by_s * (s - start);
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

double race_gap(const Race *race, SpeedRow at, const Thickness *film, double u, int *k, double *slope, double *lift)
{
    double f, v, g = 0.0, per_stretch = 1.0;
    int i;
    *lift = 0.0;
    if (film == NULL || race->nodes == 0) {
        return curve(race, at, u, k, slope);
    }
    f = film->factor;
    v = u + film->lift;
    *slope = 1.0;
    for (i = 0; i < MOST_FILM_STEPS; i++) {
        double step;
        g = curve(race, at, v, k, slope);
        per_stretch = 1.0 / ((1.0 - f) * *slope + f);
        step = (u - (1.0 - f) * g - f * v) * per_stretch;
        v += step;
        g += *slope * step;
        if (step * step * fabs(1.0 - f) <= left * g * g) {
            break;
        }
    }
    *slope *= per_stretch;
    *lift = v - u;
    return g;
}

static double gap_of(const RaceStep *c, double u, double *slope, double *lift)
{
    return race_gap(c->race, c->at, c->film, u, &c->filters->interval, slope, lift);
}

/* ---- gains ---- */

/* Gain k of a node of the load; `gains` are those of the node at the lower speed. */
static double gain(const RaceStep *c, const double gains[], int k)
{
    const int row = c->race->nodes * (DIRECT_GAINS + c->race->lags);
    return c->at.weight > 0.0 ? gains[k] + c->at.weight * (gains[k + row] - gains[k]) : gains[k];
}

static double made_at(const RaceStep *c, int node)
{
    const Race *race = c->race;
    const double *at = &race->made[c->at.row * race->nodes + node];
    return c->at.weight > 0.0 ? *at + c->at.weight * (at[race->nodes] - *at) : *at;
}

static double film_made(const RaceStep *c, double x)
{
    const StepFilters *f = c->filters;
    const double *nodes = c->race->x;
    const int last = c->race->nodes - 2;
    int k = f->weighed;
    double here, weight;
    if (k >= 0 && x >= nodes[k] && x <= nodes[k + 1]) {
        return f->made[0] + (x - nodes[k]) * f->per_x * (f->made[1] - f->made[0]);
    }
    if (k < 0) { /* near it: nodes are nearly even */
        const double first = (x - nodes[0]) / (nodes[last + 1] - nodes[0]) * last;
        k = !(first > 0.0) ? 0 : first >= last ? last : (int)first;
    }
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

double race_cutoff(const Race *race, double u, double *slope)
{
    const double gap = race->cutoff_gap;
    double t;
    *slope = 0.0;
    if (!(-u > 0.5 * gap)) {
        return 1.0;
    }
    if (-u >= gap) {
        return 0.0;
    }
    t = -2.0 * u / gap - 1.0;
    *slope = 12.0 * t * (1.0 - t) / gap;
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

/* ---- filters of a step ---- */

/* One lag at the end of a step that travels t at an own rate from `start` to e. */
static void one_lag(double old, double start, double rate, double span, double sums[3])
{
    Moments r;
    const double kept = lag_moments(rate * span, few_lags, &r), hump = r.r1 - r.r2;
    sums[0] = old * kept + start * (r.r1 - 3.0 * hump);
    sums[1] = r.r0 - r.r1 - 3.0 * hump;
    sums[2] = 6.0 * hump / span;
}

void race_prepare(const RaceStep *c, double dt)
{
    const Race *race = c->race;
    const FilmState *before = c->before;
    StepFilters *f = c->filters;
    const int lags = race->lags;
    double poisson[MOST_LAGS + 3], share[MOST_LAGS + 3], *held = f->chain, *ends = held + lags, *humps = ends + lags;
    double middle, slope, lift, span, p, mu, per_mu, made;
    int j;
    if (race->nodes == 0) {
        return;
    }
    f->interval = (int)before->interval;
    f->weighed = -1;
    middle = gap_of(c, before->approach + 0.5 * dt * before->rate, &slope, &lift);
    span = dt / (c->transit * sqrt(middle));
    p = race->inlet_rate;
    one_lag(before->inlet, before->own, p, span, f->s);
    one_lag(before->fast, before->own, race->fast_rate, span, f->y);
    mu = race->lag_rate * span;
    made = film_made(c, race->log_kn + 1.5 * log(middle));
    f->middle[0] = -made * (f->s[0] - before->inlet) / (p * span) - 0.5 * before->entered;
    f->middle[1] = -made * f->s[1] / (p * span);
    f->middle[2] = made * (1.0 - f->s[2] / p) / span;
    poisson_shares(mu, lags + 2, few_lags, poisson, share);
    per_mu = 1.0 / mu;
    for (j = 0; j < lags; j++) {
        const Moments r = chain_moments(j + 1, per_mu, share);
        held[j] = before->entered * r.r1;
        ends[j] = r.r0 - r.r1;
        humps[j] = 6.0 * (r.r1 - r.r2);
    }
    pass_on(lags, before->chain, poisson, held);
}

void race_at_rest(const RaceStep *c)
{
    StepFilters *filters = c->filters;
    memset(filters, 0, sizeof *filters + 3 * (size_t)c->race->lags * sizeof filters->chain[0]);
    filters->interval = (int)c->before->interval;
    filters->weighed = -1;
}

/* Sums of the gains of a node over all filters from those of its chain; what the chain carries of earlier films apart. */
static void sum_gains(const RaceStep *c, const double gains[], const double chain[3], double at[3], double carried[3])
{
    const StepFilters *f = c->filters;
    const double inlet = gain(c, gains, 1) + chain[1] - 0.5 * chain[2], fast = gain(c, gains, 2);
    int j;
    for (j = 0; j < 3; j++) {
        at[j] = inlet * f->s[j] + fast * f->y[j];
        carried[j] = chain[2] * f->middle[j];
    }
    at[1] += gain(c, gains, 0);
    carried[0] += chain[0];
}

/* The same of node k and the next; sums of both chains do not wait for each other. */
static void weigh(const RaceStep *c, int k)
{
    StepFilters *f = c->filters;
    const Race *race = c->race;
    const int lags = race->lags, size = DIRECT_GAINS + lags;
    const double *here = &race->gains[(c->at.row * race->nodes + k) * size], *next = here + size, *chain = f->chain;
    double held[3] = {0.0, 0.0, 0.0}, next_held[3] = {0.0, 0.0, 0.0};
    int j;
    for (j = 0; j < lags; j++) {
        const double a = gain(c, here, DIRECT_GAINS + j), b = gain(c, next, DIRECT_GAINS + j);
        const double holds = chain[j], end = chain[lags + j], hump = chain[2 * lags + j];
        held[0] += a * holds;
        next_held[0] += b * holds;
        held[1] += a * end;
        next_held[1] += b * end;
        held[2] += a * hump;
        next_held[2] += b * hump;
    }
    sum_gains(c, here, held, f->at, f->carried);
    sum_gains(c, next, next_held, f->next, f->next_carried);
    f->weighed = k;
    f->per_x = 1.0 / (race->x[k + 1] - race->x[k]);
    f->made[0] = made_at(c, k);
    f->made[1] = made_at(c, k + 1);
}

RaceForce race_force(const RaceStep *c, double u, double v)
{
    const Race *race = c->race;
    StepFilters *f = c->filters;
    RaceForce out = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    double g_u, lift, root, x, per_x, weight, tau, e, t, here, there, per_made, share, share_u, slope;
    double m0, me, mt, step, q0, qe, qt, more, carried, w, w_u, bent;
    const double g = gap_of(c, u, &g_u, &lift);
    int k = f->interval;
    out.lift = lift;
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
        weigh(c, k);
    }
    per_x = f->per_x;
    weight = (x - race->x[k]) * per_x;
    tau = c->transit * root;
    e = tau * v;
    t = u - c->before->approach;
    m0 = f->at[0] + weight * (f->next[0] - f->at[0]);
    me = f->at[1] + weight * (f->next[1] - f->at[1]);
    mt = f->at[2] + weight * (f->next[2] - f->at[2]);
    step = f->next[0] - f->at[0] + (f->next[1] - f->at[1]) * e + (f->next[2] - f->at[2]) * t;
    /* what the chain carries, in shares of the film made at this load */
    here = f->made[0];
    there = f->made[1];
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
    bent = 0.5 * me * e + 1.5 * per_x * step;
    w_u = g_u + mt + bent * g_u / g;
    root = sqrt(w);
    share = race_cutoff(race, u, &share_u);
    slope = 1.5 * race->kn * root;
    out.force = race->kn * w * root;
    out.stiffness = share * slope * w_u + share_u * out.force;
    out.damping = share * slope * me * tau;
    out.by_film = c->film == NULL ? 0.0 : share * slope * (1.0 + bent / g) * g_u * (g - u - lift);
    out.force *= share;
    return out;
}

double race_accept(const RaceStep *c, double u, double v, FilmState *after)
{
    const Race *race = c->race;
    const StepFilters *f = c->filters;
    const double t = u - c->before->approach, *held = f->chain, *ends = held + race->lags, *humps = ends + race->lags;
    double g, slope, lift, e, s, hump;
    int j;
    after->approach = u;
    after->rate = v;
    if (race->nodes == 0) {
        return 0.0;
    }
    g = gap_of(c, u, &slope, &lift);
    e = c->transit * sqrt(g) * v;
    s = f->s[0] + f->s[1] * e + f->s[2] * t;
    after->interval = f->interval;
    after->own = e;
    after->inlet = s;
    after->fast = f->y[0] + f->y[1] * e + f->y[2] * t;
    after->entered = s * film_made(c, race->log_kn + 1.5 * log(g));
    hump = f->middle[0] + f->middle[1] * e + f->middle[2] * t - 0.5 * after->entered;
    for (j = 0; j < race->lags; j++) {
        after->chain[j] = held[j] + ends[j] * after->entered + humps[j] * hump;
    }
    return lift;
}
