/* Balls and films of a bearing in continuous time: reduced_models.bearing.continuous_time. Planar (continuous_planar.c) or at
 * contact angles (continuous_angular.c). */
#ifndef CONTINUOUS_TIME_H
#define CONTINUOUS_TIME_H

#include "balls.h"
#include "dual.h"

/* The states: angle of the cage; of every ball its place (PLACES numbers), with inertia its rate too, of a dry one without
 * inertia nothing, and the films of its inner and outer contact: inlet, fast, chain. */
enum { CAGE_ANGLE, FIRST_OF_BALLS, BALL_STATES = OWN_STATES + 2 * FILM_STATES, HEAVY = OWN_STATES == 2 * PLACES };

typedef struct {
    Dual q[FREEDOMS], v[FREEDOMS], omega; /* of the inner ring; of the shaft */
} RingMotion;

/* States of the place of a ball in steps. */
void own_states(const Ball *ball, double states[]);

/* Where a ball at rest is that is at `place` without the direction. */
void rest_place(const Setup *setup, const RingMotion *ring, Dual angle, int k, Dual place[PLACES]);

/* Rates of the states, and what balls carry. Dry balls without inertia are where those of `last` are, and have no rates. After a
 * step others move at its rates: the rate at which forces balance is that of continuous time alone, and errors of a step are many
 * times as large in it. Returns why not, or NULL. */
const char *bearing_rates(const Setup *setup, const RingMotion *ring, const Bearing *last, const Dual states[], Dual rates[],
                          BallLoads *out);

#endif
