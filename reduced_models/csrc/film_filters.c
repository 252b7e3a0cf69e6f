/* Filters of the film memory; see film_filters.h. Names and order of the arithmetic are those of film_filters.py. */
#include "film_filters.h"

#include <math.h>

/* 1/k, and 0 for k = 0. */
static const double inverse[MOST_LAGS + 4] = {
    0.0, 1.0 / 1, 1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 5, 1.0 / 6, 1.0 / 7, 1.0 / 8, 1.0 / 9, 1.0 / 10, 1.0 / 11,
    1.0 / 12, 1.0 / 13, 1.0 / 14, 1.0 / 15, 1.0 / 16, 1.0 / 17, 1.0 / 18, 1.0 / 19, 1.0 / 20, 1.0 / 21, 1.0 / 22,
    1.0 / 23, 1.0 / 24, 1.0 / 25, 1.0 / 26, 1.0 / 27, 1.0 / 28, 1.0 / 29, 1.0 / 30, 1.0 / 31, 1.0 / 32, 1.0 / 33,
    1.0 / 34, 1.0 / 35, 1.0 / 36, 1.0 / 37, 1.0 / 38, 1.0 / 39, 1.0 / 40, 1.0 / 41, 1.0 / 42, 1.0 / 43, 1.0 / 44,
    1.0 / 45, 1.0 / 46, 1.0 / 47, 1.0 / 48, 1.0 / 49, 1.0 / 50, 1.0 / 51, 1.0 / 52, 1.0 / 53, 1.0 / 54, 1.0 / 55,
    1.0 / 56, 1.0 / 57, 1.0 / 58, 1.0 / 59, 1.0 / 60, 1.0 / 61, 1.0 / 62, 1.0 / 63, 1.0 / 64, 1.0 / 65, 1.0 / 66,
    1.0 / 67};

static const double shortest = 1e-100; /* step over the lag, whose square is a number: a step of no length is none */

double lag_moments(double mu, double few, Moments *r)
{
    const double kept = exp(-mu);
    double second, third, term;
    int k;
    if (mu < shortest) {
        r->r0 = mu;
        r->r1 = 0.5 * mu;
        r->r2 = mu / 3.0;
        return kept;
    }
    if (mu < few) {
        term = kept * mu * mu * mu / 6.0;
        third = 0.0;
        for (k = 4; term > 1e-17 * third; k++) {
            third += term;
            term *= mu / k;
        }
        second = third + 0.5 * kept * mu * mu;
        r->r0 = second + kept * mu;
    } else {
        r->r0 = 1.0 - kept;
        second = r->r0 - kept * mu;
        third = second - 0.5 * kept * mu * mu;
    }
    r->r1 = second / mu;
    r->r2 = 2.0 * third / (mu * mu);
    return kept;
}

void poisson_shares(double mu, int n, double few, double poisson[], double share[])
{
    double weight = exp(-mu), passed = 1.0;
    int k;
    for (k = 0; k <= n; k++) {
        poisson[k] = weight;
        share[k] = passed;
        passed -= weight;
        weight *= mu * inverse[k + 1];
    }
    if (mu < few) { /* from the far end */
        passed = 0.0;
        for (k = n + 1; weight > 1e-17 * passed; k++) {
            passed += weight;
            weight *= mu / (k + 1);
        }
        for (k = n; k >= 0; k--) {
            passed += poisson[k];
            share[k] = passed;
        }
    }
}

void pass_on(int lags, const double chain[], const double poisson[], double held[])
{
    int i, j = 0;
    for (; j + 3 < lags; j += 4) { /* four lags at once: sums of their own do not wait for each other */
        double a = held[j], b = held[j + 1], c = held[j + 2], d = held[j + 3];
        for (i = 0; i <= j; i++) {
            const double start = chain[i], *share = &poisson[j - i];
            a += share[0] * start;
            b += share[1] * start;
            c += share[2] * start;
            d += share[3] * start;
        }
        held[j] = a;
        held[j + 1] = b + poisson[0] * chain[j + 1];
        held[j + 2] = c + poisson[1] * chain[j + 1] + poisson[0] * chain[j + 2];
        held[j + 3] = d + poisson[2] * chain[j + 1] + poisson[1] * chain[j + 2] + poisson[0] * chain[j + 3];
    }
    for (; j < lags; j++) {
        for (i = 0; i <= j; i++) {
            held[j] += poisson[j - i] * chain[i];
        }
    }
}
