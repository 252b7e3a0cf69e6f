/* Balls and films of a planar bearing in continuous time: reduced_models.bearing.continuous_time. */
#ifndef CONTINUOUS_TIME_H
#define CONTINUOUS_TIME_H

#include "balls.h"
#include "dual.h"

/* The states: angle of the cage; of every ball its place w (OWN_STATES 1), with inertia its rate too (2), of a dry one
 * without inertia nothing (0), and the films of its inner and outer contact: inlet, fast, chain. */
enum { CAGE_ANGLE, FIRST_OF_BALLS, BALL_STATES = OWN_STATES + 2 * FILM_STATES };

typedef struct {
    Dual q[FREEDOMS], v[FREEDOMS], omega; /* of the inner ring; of the shaft */
} RingMotion;

/* Forces of the ring on all balls and at the contacts, and the compressions `film` that these have: see RaceForce. */
typedef struct {
    Dual force[FREEDOMS], load[BALLS][2];
    double film[BALLS][2];
} BallLoads;

/* Where balls at rest are that are at `w` without the direction. */
Dual rest_place(const Setup *setup, const RingMotion *ring, Dual angle, int k, double w);

/* Rates of the states, and the forces. Dry balls without inertia are where they are at rest, near those of `still`: they have
 * no rates. Returns why not, or NULL. */
const char *bearing_rates(const Setup *setup, const RingMotion *ring, const Bearing *still, const Dual states[], Dual rates[],
                          BallLoads *out);

#endif
