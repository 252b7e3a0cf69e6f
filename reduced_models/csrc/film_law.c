/* The film law: static curve, steps, rates; see film_law.h. Names and order of the arithmetic are those of film_law.py. */
#include "film_law.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "jet.h"

static const double few_moments = 3.0; /* of lag_moments: full relative accuracy */

/* ---- the static curve ---- */

static const double nothing = -400.0; /* ln of a force that is none */

/* Last index k with nodes[k] < x (or <= x if `at`), for x between the ends. */
static int film_before(const double nodes[], int count, double x, int at)
{
    int low = 0, high = count - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (nodes[middle] < x || (at && nodes[middle] <= x)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Film h_s, dh_s/dx and d2h_s/dx2 at x = ln F: Hermite between the nodes, straight beyond them; x is most likely behind
 * node `guess`. */
static double film(const FilmLaw *law, double x, int guess, double *slope, double *curvature)
{
    const int n = law->nodes;
    double w, t, d, a, b, y, dy, ddy, h;
    int k;
    if (x <= law->x[0] || !(x < law->x[n - 1])) {
        k = x <= law->x[0] ? 0 : n - 1;
        h = exp(law->y[k] + law->slope[k] * (x - law->x[k]));
        *slope = h * law->slope[k];
        *curvature = *slope * law->slope[k];
        return h;
    }
    k = law->x[guess] < x && x <= law->x[guess + 1] ? guess : film_before(law->x, n, x, 0);
    w = law->x[k + 1] - law->x[k];
    t = (x - law->x[k]) / w;
    d = law->y[k + 1] - law->y[k];
    a = w * law->slope[k] - d;
    b = d - w * law->slope[k + 1];
    y = law->y[k] + t * d + t * (1.0 - t) * ((1.0 - t) * a + t * b);
    dy = d + (1.0 - 2.0 * t) * ((1.0 - t) * a + t * b) + t * (1.0 - t) * (b - a);
    ddy = -2.0 * ((1.0 - t) * a + t * b) + 2.0 * (1.0 - 2.0 * t) * (b - a);
    h = exp(y);
    *slope = h * dy / w;
    *curvature = h * (dy * dy + ddy) / (w * w);
    return h;
}

double film_under(const FilmLaw *law, double x)
{
    double slope, curvature;
    return film(law, x, 0, &slope, &curvature);
}

void film_static(const FilmLaw *law, double u, const Rest *near, Rest *rest)
{
    const int n = law->nodes;
    double low = -HUGE_VAL, high = HUGE_VAL, x, g, h, dh, ddh, du, r, new_x, step;
    int i, k = 0;
    if (u < law->u[0]) {
        high = law->x[0];
        x = high;
        if (-u > exp(law->y[0])) { /* F hardly matters there: h_s is nearly -u */
            x += (log(-u) - law->y[0]) / law->slope[0];
            if (x < nothing) {
                rest->u = u;
                rest->x = nothing;
                rest->g = exp(2.0 / 3.0 * nothing);
                rest->g_u = 0.0;
                return;
            }
        }
    } else if (!(u < law->u[n - 1])) {
        low = law->x[n - 1];
        x = low;
    } else {
        k = film_before(law->u, n, u, 1);
        low = law->x[k];
        high = law->x[k + 1];
        x = low + (high - low) * (u - law->u[k]) / (law->u[k + 1] - law->u[k]);
    }
    if (near != NULL && near->g_u > 0.0) { /* along the slope of the curve from there, if that is not far */
        step = 1.5 * near->g_u / near->g * (u - near->u);
        new_x = near->x + step;
        x = fabs(step) <= 1.0 && low <= new_x && new_x <= high ? new_x : x;
    }
    for (i = 0; i < 100; i++) {
        g = exp(2.0 / 3.0 * x);
        h = film(law, x, k, &dh, &ddh);
        du = 2.0 / 3.0 * g - dh;
        r = g - h - u;
        if (r > 0.0) {
            high = high < x ? high : x;
        } else {
            low = low > x ? low : x;
        }
        step = r / du;
        new_x = x - (step < -2.0 ? -2.0 : step > 2.0 ? 2.0 : step);
        if (!(low <= new_x && new_x <= high)) {
            new_x = 0.5 * (low + high);
        }
        step = new_x - x;
        x = new_x;
        if (fabs(step) <= 1e-9) {
            break;
        }
    }
    /* The last step squared is below rounding: its first two orders are enough. After a hundred the approach is beyond
     * all numbers of use, and the force will be refused. */
    r = 2.0 / 3.0 * step;
    g = i < 100 ? g * (1.0 + r * (1.0 + 0.5 * r)) : HUGE_VAL;
    dh += ddh * step;
    rest->u = u;
    rest->x = x;
    rest->g = g;
    rest->g_u = i < 100 ? 2.0 / 3.0 * g / (2.0 / 3.0 * g - dh) : 1.0;
}

/* Second derivatives of x = ln F_s and of g by the approach. */
static void film_curvature(const FilmLaw *law, const Rest *rest, double *x_uu, double *g_uu)
{
    double dh, ddh, du, ddu, x_u;
    if (rest->g_u == 0.0) {
        *x_uu = *g_uu = 0.0;
        return;
    }
    film(law, rest->x, 0, &dh, &ddh);
    du = 2.0 / 3.0 * rest->g - dh;
    ddu = 4.0 / 9.0 * rest->g - ddh;
    x_u = 1.0 / du;
    *x_uu = -ddu * x_u * x_u * x_u;
    *g_uu = 2.0 / 3.0 * rest->g * (2.0 / 3.0 * x_u * x_u + *x_uu);
}

/* ---- gains, and the film that enters the chain ---- */

/* Rows of gains on both sides of x = ln F, weight of the second and its slope. */
typedef struct {
    const FilmLaw *law;
    const double *here, *there; /* the rows */
    int row, after;
    double weight, per_x;
} Between;

/* One lag after input start + (end - start) t + 6 bump t (1 - t). */
static Jet one_lag(double old, double start, Jet end, Jet bump, double rate, Jet span)
{
    Moments r;
    const double mu = rate * span.x, kept = lag_moments(mu, few_moments, &r);
    const double d1 = (kept * mu - r.r1) / mu, d2 = (kept * mu - 2.0 * r.r2) / mu;
    const double value = old * kept + start * r.r1 + end.x * (r.r0 - r.r1) + 6.0 * bump.x * (r.r1 - r.r2);
    const double slope = -old * kept + start * d1 + end.x * (kept - d1) + 6.0 * bump.x * (d1 - d2);
    return through3(value, slope * rate, span, r.r0 - r.r1, end, 6.0 * (r.r1 - r.r2), bump);
}

/* phi(s), the film that enters the chain, and its slope. */
static double film_entering(const FilmLaw *law, double s, double *slope)
{
    const double b = law->inlet_saturation * s, d = 1.0 + fabs(b);
    if (law->rim > 0.0 && b > 0.0) {
        const double c = pow(1.0 + 1.5 * b, 1.0 / 3.0);
        *slope = 1.0 / c;
        return 1.5 * s * (c + 1.0) / (c * c + c + 1.0); /* (c^2 - 1)/beta without a difference */
    }
    *slope = 1.0 + b * (1.0 + d) / (d * d);
    return s + b * s / d;
}

/* The same of a jet. */
static Jet entering(const FilmLaw *law, Jet s)
{
    double slope;
    const double x = film_entering(law, s.x, &slope);
    return through(x, slope, s);
}

static Between between(const FilmLaw *law, double x)
{
    Between b = {law, NULL, NULL, 0, 0, 0.0, 0.0};
    const int last = law->rows - 1, width = DIRECT + law->lags;
    if (last == 0 || x <= law->gain_x[0]) {
        b.after = last > 0 ? 1 : 0;
    } else if (!(x < law->gain_x[last])) {
        b.row = last - 1;
        b.after = last;
        b.weight = 1.0;
    } else {
        b.row = film_before(law->gain_x, law->rows, x, 0);
        b.after = b.row + 1;
        b.per_x = 1.0 / (law->gain_x[b.after] - law->gain_x[b.row]);
        b.weight = (x - law->gain_x[b.row]) * b.per_x;
    }
    b.here = &law->gains[b.row * width];
    b.there = &law->gains[b.after * width];
    return b;
}

static double gain(int k, const Between *b)
{
    return b->here[k] * (1.0 - b->weight) + b->there[k] * b->weight;
}

static double gain_slope(int k, const Between *b)
{
    return (b->there[k] - b->here[k]) * b->per_x;
}

/* Film G that a unit of phi lets into the chain, with its slope by x: 1 with one row of gains. */
typedef struct {
    double film, by_x;
} Made;

static Made film_made(const Between *b)
{
    double here = LEAST_MADE, there = LEAST_MADE;
    Made made = {1.0, 0.0};
    int k;
    if (b->law->rows == 1) {
        return made;
    }
    for (k = DIRECT; k < DIRECT + b->law->lags; k++) {
        here += fabs(b->here[k]);
        there += fabs(b->there[k]);
    }
    made.film = here + b->weight * (there - here);
    made.by_x = (there - here) * b->per_x;
    return made;
}

/* Filter k times its gain at the load, whose ln F has the slope x_u. */
static Jet weighed(int k, Jet q, const Between *b, double x_u)
{
    return times(jet(gain(k, b), gain_slope(k, b) * x_u, 0.0), q);
}

/* The force of an argument g + m with its slopes; nothing where it would pull. */
static FilmForce force_of(double argument, double by_approach, double by_rate)
{
    FilmForce found = {0.0, 0.0, 0.0, 0.0};
    found.argument = argument;
    if (!(argument <= 0.0)) {
        const double w_root = sqrt(argument);
        found.force = argument * w_root;
        found.stiffness = 1.5 * w_root * by_approach;
        found.damping = 1.5 * w_root * by_rate;
    }
    return found;
}

/* Slope of g + m by the approach, the states as they are; `by_gain` is their sum with the slopes of the gains by x. */
static double frozen_slope(const Rest *rest, const Between *b, double theta, double theta_u, double v, double by_gain)
{
    const double x_u = 1.5 * rest->g_u / rest->g;
    return rest->g_u + v * (gain_slope(VISCOUS, b) * x_u * theta + gain(VISCOUS, b) * theta_u) + by_gain * x_u;
}

/* Sums over the chain, weighed with the gains at the load: of the lags at the end of the step, the same with the slopes of
 * the gains by x, and of the lags' slopes by mu, by the film made at the end and by its bump, and by the share of the contact that it has kept while it grew. */
typedef struct {
    double value, by_gain, by_mu, by_end, by_hump, by_kept;
} Chain;

/* One lag at the end of a step and its slopes. */
typedef struct {
    double value, by_mu, by_end, by_hump, by_kept;
} Lag;

/* Lag `q` of a contact that has grown, and kept the share `kept` of what it held at the start. Of q, `stayed` (slope by mu
 * `stayed_mu`) is what the lag would hold of the start; what came in by the inlet, the share `passed`, has grown half as
 * long. The rest, so that all shares make 1, is film of the `rim`. */
static Lag with_rim(Lag q, double stayed, double stayed_mu, double passed, double passed_mu, double kept, Lag rim)
{
    const double late = sqrt(kept), late_k = 0.5 / late, fresh = 1.0 - kept - (late - kept) * passed;
    Lag found;
    found.value = late * q.value + (kept - late) * stayed + fresh * rim.value;
    found.by_mu = late * q.by_mu + (kept - late) * stayed_mu + fresh * rim.by_mu
                  - (late - kept) * passed_mu * rim.value;
    found.by_end = late * q.by_end + fresh * rim.by_end;
    found.by_hump = late * q.by_hump + fresh * rim.by_hump;
    found.by_kept = late_k * q.value + (1.0 - late_k) * stayed - (1.0 + (late_k - 1.0) * passed) * rim.value;
    return found;
}

/* Advances the chain: the film made goes from f0 to f with a bump; `kept` is 1 but in a contact that has grown. */
static Chain advance_chain(const double before[], double after[], double mu, double f0, double f,
                           double hump, double kept, const Between *b)
{
    const double *row = b->here, *next = b->there;
    const double share_of_next = b->weight, share_of_row = 1.0 - b->weight, per_x = b->per_x, per_mu = 1.0 / mu;
    const int lags = b->law->lags;
    double poisson[MOST_LAGS + 3], share[MOST_LAGS + 3], held[MOST_LAGS + 1];
    Chain sum = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    Lag rim = {0.0, 0.0, 0.0, 0.0, 0.0};
    int j;
    memset(held, 0, (size_t)(lags + 1) * sizeof held[0]);
    poisson_shares(mu, lags + 2, lags + 2.0, poisson, share);
    pass_on(lags, &before[CHAIN], poisson, &held[1]);
    for (j = 1; j <= lags; j++) {
        const Moments r = chain_moments(j, per_mu, share);
        const double low = row[DIRECT - 1 + j], high = next[DIRECT - 1 + j];
        const int counts = low != 0.0 || high != 0.0; /* many lags have no part in the force */
        Lag q = {0.0, 0.0, 0.0, 0.0, 0.0};
        q.value = held[j] + f0 * r.r1 + f * (r.r0 - r.r1) + 6.0 * hump * (r.r1 - r.r2);
        if (counts || (kept < 1.0 && j == 1)) {
            const double d0 = poisson[j - 1], d1 = (j * poisson[j] - r.r1) * per_mu;
            const double d2 = (j * (j + 1) * poisson[j + 1] * per_mu - 2.0 * r.r2) * per_mu;
            q.by_mu = held[j - 1] - held[j] + f0 * d1 + f * (d0 - d1) + 6.0 * hump * (d1 - d2);
            q.by_end = r.r0 - r.r1;
            q.by_hump = 6.0 * (r.r1 - r.r2);
        }
        if (kept < 1.0) {
            const double stayed_mu = held[j - 1] - held[j], passed_mu = poisson[j - 1];
            if (j == 1) { /* what the first lag has got: a mean over the step that ends on the film at its end */
                const double got = (q.value - held[1]) / r.r0;
                rim.value = b->law->rim * got;
                rim.by_mu = b->law->rim * ((q.by_mu - stayed_mu - got * passed_mu) / r.r0);
                rim.by_end = b->law->rim * (q.by_end / r.r0);
                rim.by_hump = b->law->rim * (q.by_hump / r.r0);
            }
            q = with_rim(q, held[j], stayed_mu, r.r0, passed_mu, kept, rim);
        }
        after[CHAIN + j - 1] = q.value;
        if (counts) {
            const double weight = low * share_of_row + high * share_of_next;
            sum.value += weight * q.value;
            sum.by_gain += (high - low) * per_x * q.value;
            sum.by_mu += weight * q.by_mu;
            sum.by_end += weight * q.by_end;
            sum.by_hump += weight * q.by_hump;
            sum.by_kept += weight * q.by_kept;
        }
    }
    return sum;
}

void film_step(const FilmLaw *law, const double before[], double after[], double dt, const Rest *rest, double v,
               FilmStep *found)
{
    const Jet g = jet(rest->g, rest->g_u, 0.0);
    const Jet theta = root(g);
    const double start = before[RATE];
    const Jet end = times(theta, jet(v, 0.0, 1.0));
    const Jet span = jet(0.5 * dt * (1.0 / before[THETA] + 1.0 / theta.x),
                         -0.5 * dt * theta.u / (theta.x * theta.x), 0.0);
    /* what the straight line between both rates misses of the change of approach */
    const Jet travel = jet(rest->u - before[APPROACH], 1.0, 0.0);
    const Jet bump = minus(over(travel, span), half(start, end));
    const Jet s = one_lag(before[INLET], start, end, bump, law->inlet_rate, span);
    const Jet y = one_lag(before[FAST], start, end, bump, law->fast_rate, span);
    /* the film made: its ends, and a bump that keeps its mean, which the balance of the inlet lag gives */
    const double p = law->inlet_rate, mean = (travel.x - (s.x - before[INLET]) / p) / span.x;
    const Jet entered = jet(mean, (travel.u - s.u / p - mean * span.u) / span.x, -s.v / (p * span.x));
    const Between b = between(law, rest->x);
    const double x_u = 1.5 * g.u / g.x;
    const Between b0 = between(law, 3.0 * log(before[THETA]));
    double ignored, by_gain;
    const double made0 = film_made(&b0).film;
    const Made at_end = film_made(&b);
    const Jet made = jet(at_end.film, at_end.by_x * x_u, 0.0);
    const double f0 = made0 * film_entering(law, before[INLET], &ignored);
    const Jet f = times(made, entering(law, s));
    const Jet hump = minus(times(half(made0, made), entering(law, entered)), half(f0, f));
    const int grows = law->rim > 0.0 && theta.x > before[THETA];
    const double kept = grows ? before[THETA] / theta.x : 1.0, kept_u = grows ? -kept / theta.x * theta.u : 0.0;
    Chain chain;
    Jet m, w, carried;
    chain = advance_chain(before, after, law->lag_rate * span.x, f0, f.x, hump.x, kept, &b);
    m = weighed(VISCOUS, end, &b, x_u);
    m = plus(m, weighed(1, s, &b, x_u));
    m = plus(m, weighed(2, y, &b, x_u));
    carried = over(jet(chain.value,
                       x_u * chain.by_gain + law->lag_rate * span.u * chain.by_mu + chain.by_end * f.u
                           + chain.by_hump * hump.u + chain.by_kept * kept_u,
                       chain.by_end * f.v + chain.by_hump * hump.v), made);
    m = plus(m, carried);
    after[THETA] = theta.x;
    after[RATE] = end.x;
    after[APPROACH] = rest->u;
    after[INLET] = s.x;
    after[FAST] = y.x;
    w = plus(g, m);
    found->step = force_of(w.x, w.u, w.v);
    by_gain = gain_slope(1, &b) * s.x + gain_slope(2, &b) * y.x + (chain.by_gain - carried.x * at_end.by_x) / at_end.film;
    found->now = force_of(w.x, frozen_slope(rest, &b, theta.x, theta.u, v, by_gain), gain(VISCOUS, &b) * theta.x);
}

/* ---- at an instant ---- */

/* m and its slopes by approach and rate, the states as they are; the sums of gains and of their slopes over the states. */
typedef struct {
    double theta, theta_u;
    double direct, direct_x;      /* viscous gain, and its slope by x */
    double inlet, fast, carried;  /* film that inlet, fast lag and chain add */
    double held_x, held_xx;       /* slopes of their sum by x */
    Made made;
    double x_u;
    Between between;
} Memory;

static Memory film_memory(const FilmLaw *law, const double states[], const Rest *rest)
{
    Memory m;
    double carried = 0.0, carried_x = 0.0;
    int k;
    m.between = between(law, rest->x);
    m.theta = sqrt(rest->g);
    m.theta_u = 0.5 * rest->g_u / m.theta;
    m.x_u = 1.5 * rest->g_u / rest->g;
    m.direct = gain(VISCOUS, &m.between);
    m.direct_x = gain_slope(VISCOUS, &m.between);
    m.made = film_made(&m.between);
    m.inlet = gain(1, &m.between) * states[0];
    m.fast = gain(2, &m.between) * states[1];
    for (k = DIRECT - 1; k < DIRECT - 1 + law->lags; k++) {
        carried += gain(k + 1, &m.between) * states[k];
        carried_x += gain_slope(k + 1, &m.between) * states[k];
    }
    m.carried = carried / m.made.film;
    carried_x = (carried_x - m.carried * m.made.by_x) / m.made.film;
    m.held_x = gain_slope(1, &m.between) * states[0] + gain_slope(2, &m.between) * states[1] + carried_x;
    m.held_xx = -2.0 * carried_x * m.made.by_x / m.made.film;
    return m;
}

/* g + m, in the order of film_step. */
static double film_argument(const Memory *m, const Rest *rest, double v)
{
    return rest->g + (m->direct * (m->theta * v) + m->inlet + m->fast + m->carried);
}

FilmForce film_now(const FilmLaw *law, const double states[], const Rest *rest, double v)
{
    const Memory m = film_memory(law, states, rest);
    return force_of(film_argument(&m, rest, v),
                    frozen_slope(rest, &m.between, m.theta, m.theta_u, v, m.held_x), m.direct * m.theta);
}

void film_instant(const FilmLaw *law, const double states[], const Rest *rest, double v, FilmInstant *now)
{
    const Memory m = film_memory(law, states, rest);
    double x_uu, g_uu, theta_uu, w_root, w[2], ww[2][2];
    int i, j, k;
    film_curvature(law, rest, &x_uu, &g_uu);
    theta_uu = (0.5 * g_uu - m.theta_u * m.theta_u) / m.theta;
    w[0] = rest->g_u + v * (m.direct_x * m.x_u * m.theta + m.direct * m.theta_u) + m.held_x * m.x_u;
    w[1] = m.direct * m.theta;
    ww[0][0] = g_uu + m.held_x * x_uu + m.held_xx * m.x_u * m.x_u
               + v * (m.direct_x * (x_uu * m.theta + 2.0 * m.x_u * m.theta_u) + m.direct * theta_uu);
    ww[0][1] = ww[1][0] = m.direct_x * m.x_u * m.theta + m.direct * m.theta_u;
    ww[1][1] = 0.0;
    memset(now, 0, sizeof *now);
    now->argument = film_argument(&m, rest, v);
    if (now->argument <= 0.0) {
        return;
    }
    w_root = sqrt(now->argument);
    now->force = now->argument * w_root;
    for (i = 0; i < 2; i++) {
        now->by[i] = 1.5 * w_root * w[i];
        for (j = 0; j < 2; j++) {
            now->second[i][j] = 1.5 * (w_root * ww[i][j] + 0.5 * w[i] * w[j] / w_root);
        }
    }
    for (k = 0; k < DIRECT - 1 + law->lags; k++) {
        const int lag = k >= DIRECT - 1;
        const double made = lag ? m.made.film : 1.0, by = gain(k + 1, &m.between) / made;
        const double by_u = (gain_slope(k + 1, &m.between) - (lag ? by * m.made.by_x : 0.0)) / made * m.x_u;
        now->by_state[k] = 1.5 * w_root * by;
        now->second_state[0][k] = 1.5 * (w_root * by_u + 0.5 * w[0] * by / w_root);
        now->second_state[1][k] = 1.5 * (0.5 * w[1] * by / w_root);
    }
}

/* The contact's own clock runs like 1/theta, without end as the surfaces part; no faster than at LEAST_THETA. */
static double clock(double theta)
{
    return theta > LEAST_THETA ? theta : LEAST_THETA;
}

void film_rates(const FilmLaw *law, const double states[], const Rest *rest, double v, double rates[])
{
    const double theta = sqrt(rest->g), i = theta * v, unit = clock(theta);
    const Between b = between(law, rest->x);
    double fed, entered, ignored;
    int k;
    rates[0] = law->inlet_rate * (i - states[0]) / unit;
    rates[1] = law->fast_rate * (i - states[1]) / unit;
    fed = film_entering(law, states[0], &ignored);
    fed *= film_made(&b).film;
    entered = fed;
    for (k = 2; k < DIRECT - 1 + law->lags; k++) {
        rates[k] = law->lag_rate * (fed - states[k]) / unit;
        if (law->rim > 0.0 && v > 0.0) {
            rates[k] += 0.5 * rest->g_u / theta * v / unit * (law->rim * entered - states[k]);
        }
        fed = states[k];
    }
}

void film_rates_along(const FilmLaw *law, const double states[], const Rest *rest, double v, double du, double dv,
                      const double along[], double change[])
{
    const double theta = sqrt(rest->g), unit = clock(theta), theta_u = 0.5 * rest->g_u / theta;
    const double i = theta * v, di = theta_u * v * du + theta * dv;
    const double dunit = theta > LEAST_THETA ? theta_u * du / unit : 0.0; /* over the unit */
    const Between b = between(law, rest->x);
    const Made made = film_made(&b);
    double fed, slope, dfed, entered, dentered, grow = 0.0, dgrow = 0.0;
    int k;
    if (law->rim > 0.0 && v > 0.0) {
        double x_uu, g_uu;
        film_curvature(law, rest, &x_uu, &g_uu);
        grow = theta_u * v / unit;
        dgrow = ((0.5 * g_uu - theta_u * theta_u) / theta * v * du + theta_u * dv) / unit - grow * dunit;
    }
    change[0] = law->inlet_rate * ((di - along[0]) - (i - states[0]) * dunit) / unit;
    change[1] = law->fast_rate * ((di - along[1]) - (i - states[1]) * dunit) / unit;
    fed = film_entering(law, states[0], &slope);
    dfed = made.film * slope * along[0] + made.by_x * 1.5 * rest->g_u / rest->g * du * fed;
    fed *= made.film;
    entered = fed;
    dentered = dfed;
    for (k = 2; k < DIRECT - 1 + law->lags; k++) {
        change[k] = law->lag_rate * ((dfed - along[k]) - (fed - states[k]) * dunit) / unit;
        change[k] += dgrow * (law->rim * entered - states[k]) + grow * (law->rim * dentered - along[k]);
        fed = states[k];
        dfed = along[k];
    }
}
