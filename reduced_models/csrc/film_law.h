/* The film law of the elements with memory, dimensionless: reduced_models.elements.film_law. Equations in README.md. */
#ifndef FILM_LAW_H
#define FILM_LAW_H

#include "film_filters.h"

/* Entries of a state of film_step; the chain, as long as there are lags, is the rest. Those from INLET on are the states of
 * film_rates. */
enum { THETA, RATE, APPROACH, INLET, FAST, CHAIN, MOST_RATES = CHAIN - INLET + MOST_LAGS };

enum { VISCOUS, DIRECT = 3 }; /* gains before those of the chain: viscous, inlet, fast */

/* Static curve, filters and gains of one element. */
typedef struct {
    int nodes, rows, lags;              /* of the curve, of gains; in the chain */
    const double *x, *y, *slope, *u;    /* ln F_s, ln h_s, its slope and the approach at the nodes */
    const double *gain_x, *gains;       /* ln F_s of the rows; rows of DIRECT + lags gains */
    double lag_rate, inlet_rate, fast_rate, inlet_saturation, rim;
} FilmLaw;

#define LEAST_MADE 1e-9 /* added to G, so that shares of it exist where a row of gains has no chain */
#define LEAST_THETA 0.01      /* of the clock of film_rates: the static force is a millionth of the reference load there */
#define SHORTEST_STEP 1e-100 /* in units of 2a/u_sum; its square must be a number */

/* The static curve at one approach: x = ln F_s, g = F_s^(2/3) and its slope. */
typedef struct {
    double u, x, g, g_u;
} Rest;

/* What a step gives at its end. */
typedef struct {
    double argument; /* g + m, whose power 3/2 is the force */
    double force, stiffness, damping;
} FilmForce;

/* At the end of a step: tangents through the step's memory, and with the states as they are. */
typedef struct {
    FilmForce step, now;
} FilmStep;

/* The force at an instant, the states as they are: first derivatives, second ones, and those by the states. */
typedef struct {
    double argument, force;
    double by[2];
    double second[2][2];              /* by approach and rate */
    double by_state[MOST_RATES];
    double second_state[2][MOST_RATES]; /* of dF/du and dF/dv by each state */
} FilmInstant;

/* Film h_s under the load e^x. */
double film_under(const FilmLaw *law, double x);

/* At approach u; `near` is a point close by, which may be `rest` itself, or NULL. */
void film_static(const FilmLaw *law, double u, const Rest *near, Rest *rest);

/* Advances `before` into `after`, another one, which is at rest->u, moving at v. */
void film_step(const FilmLaw *law, const double before[], double after[], double dt, const Rest *rest, double v,
               FilmStep *found);

/* Force and first derivatives alone; and all of it. */
FilmForce film_now(const FilmLaw *law, const double states[], const Rest *rest, double v);
void film_instant(const FilmLaw *law, const double states[], const Rest *rest, double v, FilmInstant *now);

/* d(states)/dT, and its change along a direction of approach, rate and states. */
void film_rates(const FilmLaw *law, const double states[], const Rest *rest, double v, double rates[]);
void film_rates_along(const FilmLaw *law, const double states[], const Rest *rest, double v, double du, double dv,
                      const double along[], double change[]);

#endif
