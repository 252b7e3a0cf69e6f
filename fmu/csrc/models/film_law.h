/* The film law of the elements with memory, dimensionless: reduced_models.elements.film_law. Equations in README.md. */
#ifndef FILM_LAW_H
#define FILM_LAW_H

#include "config.h"

/* Entries of a state of film_step; the chain is the rest. Those from INLET on are the states of film_rates. */
enum { THETA, RATE, APPROACH, INLET, FAST, CHAIN, FILM_SIZE = CHAIN + LAGS, FILM_RATES = FILM_SIZE - INLET };

enum { VISCOUS, DIRECT = 3, FILM_GAINS = DIRECT + LAGS }; /* gains before those of the chain: viscous, inlet, fast */

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
    double by_state[FILM_RATES];
    double second_state[2][FILM_RATES]; /* of dF/du and dF/dv by each state */
} FilmInstant;

/* At approach u; `near` is a point close by, which may be `rest` itself, or NULL. */
void film_static(double u, const Rest *near, Rest *rest);

/* Advances `before` into `after`, another one, which is at rest->u, moving at v. */
void film_step(const double before[FILM_SIZE], double after[FILM_SIZE], double dt, const Rest *rest, double v,
               FilmStep *found);

/* Force and first derivatives alone; and all of it. */
FilmForce film_now(const double states[FILM_RATES], const Rest *rest, double v);
void film_instant(const double states[FILM_RATES], const Rest *rest, double v, FilmInstant *now);

/* d(states)/dT, and its change along a direction of approach, rate and states. */
void film_rates(const double states[FILM_RATES], const Rest *rest, double v, double rates[FILM_RATES]);
void film_rates_along(const double states[FILM_RATES], const Rest *rest, double v, double du, double dv,
                      const double along[FILM_RATES], double change[FILM_RATES]);

#endif
