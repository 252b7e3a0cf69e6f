/* Filters of the film memory over a step of any length: reduced_models.elements.film_filters. */
#ifndef FILM_FILTERS_H
#define FILM_FILTERS_H

enum { MOST_LAGS = 64 }; /* of a chain; elements have at most 32 */

/* Response of lags at the end of a step to (1 - t)^k, t from 0 to 1. */
typedef struct {
    double r0, r1, r2;
} Moments;

/* Share of its state that one lag keeps over a step of length mu in its own time, and its moments. Where mu is below `few` they
 * are sums, or small differences would drown in rounding. */
double lag_moments(double mu, double few, Moments *r);

/* Poisson weights of mean `mu`, and the share of what entered that k lags have passed on, to k = n <= MOST_LAGS + 2. Where mu is
 * below `few` shares are sums; where these cost too much, a smaller `few` leaves differences that lose two digits. */
void poisson_shares(double mu, int n, double few, double poisson[], double share[]);

/* Moments of j equal lags in a row, from poisson_shares. */
static inline Moments chain_moments(int j, double per_mu, const double share[])
{
    Moments r;
    r.r0 = share[j];
    r.r1 = j * share[j + 1] * per_mu;
    r.r2 = j * (j + 1) * share[j + 2] * per_mu * per_mu;
    return r;
}

/* Adds to `held` what each lag now has of what the chain held at the start of the step. */
void pass_on(int lags, const double chain[], const double poisson[], double held[]);

#endif
