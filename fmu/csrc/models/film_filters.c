/* Filters of the film memory; see film_filters.h. Names and order of the arithmetic are those of film_filters.py. */
#include "film_filters.h"

#include <math.h>

#include "film_inverse.h"

/* Below these means shares are sums, or small differences would drown in rounding. Where the sums cost too much, FEW_LAGS of
 * config.h leaves differences that lose two digits. */
#ifdef FEW_LAGS
static const double few = FEW_LAGS, few_shares = FEW_LAGS;
#else
static const double few = 3.0, few_shares = LAGS + 2;
#endif

double lag_moments(double mu, Moments *r)
{
    const double kept = exp(-mu);
    double second, third, term;
    int k;
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

void poisson_shares(double mu, int n, double poisson[], double share[])
{
    double weight = exp(-mu), passed = 1.0;
    int k;
    for (k = 0; k <= n; k++) {
        poisson[k] = weight;
        share[k] = passed;
        passed -= weight;
        weight *= mu * inverse[k + 1];
    }
    if (mu < few_shares) { /* from the far end */
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

void pass_on(const double chain[LAGS], const double poisson[], double held[LAGS])
{
    int i, j;
    for (i = 0; i < LAGS; i++) { /* not lag by lag: sums of their own do not wait for each other */
        for (j = 0; j < LAGS - i; j++) {
            held[i + j] += poisson[j] * chain[i];
        }
    }
}
