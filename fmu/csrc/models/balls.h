/* Balls between two races under a given motion of the inner ring, the outer one at rest: planar (balls_planar.c, x and y) or
 * at contact angles (balls_angular.c, x, y, z and tilts about x and y). config.h has FREEDOMS, 2 or 5, and BALLS. */
#ifndef BALLS_H
#define BALLS_H

#include "dual.h"
#include "race_contact.h"

enum { INNER_RACE, OUTER_RACE };

/* What a bearing has as it was made, and as its parameters say. */
typedef struct {
    Race race[2];
    double clearance; /* m, radial; 0 where the contact angle is given */
} Setup;

/* A ball at the end of a step and of the one before: its place (the approach of its outer race; at contact angles its centre
 * from the outer groove centre, outward and along the shaft), and what follows from it. */
typedef struct {
    double place[2][PLACES];
    double rate[2];          /* of the place: planar at the ends of both steps, at contact angles both of the last one */
    double factor[2][2];     /* [race]: film over that of the tables */
    double speed_sum[2][2];  /* [race]: sum of both surface speeds over the speed of the shaft [m] */
    double lift[2];          /* [race]: see Thickness */
    double force[2];         /* [race] N */
    double film[2];          /* [race]: see RaceForce */
    double angle[2];         /* [race] rad */
} Ball;

/* Forces of the ring on all balls and at the contacts, and the compressions `film` that these have, see RaceForce; at contact
 * angles what else a `Ball` has of them. */
typedef struct {
    Dual force[FREEDOMS], load[BALLS][2], factor[BALLS][2], speed_sum[BALLS][2], angle[BALLS][2];
    double film[BALLS][2];
} BallLoads;

/* All that a bearing remembers: doubles alone. */
typedef struct {
    double h;                /* length of the last step; 0: at rest so far */
    double omega;            /* of the shaft, at its end [rad/s] */
    double angle;            /* of the first ball */
    double cage[2];          /* speed of the cage over that of the shaft, at the ends of the last two steps */
    Ball ball[BALLS];
    FilmState film[BALLS][2];
    double seat[1 + SEAT_FILTERS][FREEDOMS]; /* force of the balls at the end of the last step; filters of its losses */
} Bearing;

/* Row of the tables at a speed of the shaft; films at rest and below the lowest speed are those of the lowest. */
SpeedRow speed_row(double omega);
double film_speed(double omega);

/* Weight of the last two places in the rate of the next: rate = gain (place - history), by differences of second order. */
typedef struct {
    double gain, now, before; /* history = now place[0] - before place[1] */
} Differences;
Differences differences(double h, double h_before);

/* Where the balance of a ball is looked for in a step, however often: it moves on as in the last one. A film that lets go pulls
 * and pushes, and a ball may have several balances: which one is found must not depend on where the ring was tried before. */
void place_ahead(const Ball *old, double h, double h_before, double start[PLACES]);

/* All balls in a step. */
typedef struct BallsStep BallsStep;

#if FREEDOMS == 2
/* A planar ball in a step: its contacts; its direction; what its rates follow from; what presses it outward. Where it
 * is looked for; where it was balanced last, by delta and its rate, and what the force of the ring changes by with both. */
typedef struct {
    RaceStep contact[2];
    StepFilters filters[2];
    double x, y, gain, history, rate_history, centrifugal;
    double start[PLACES], place[PLACES], tried[2], slope[2];
} BallStep;

struct BallsStep {
    const Setup *setup;
    double cage; /* rad/s */
    BallStep ball[BALLS];
};
#endif

/* Slopes of the force of the ring on the balls at the end of a step, by the place and the velocity of the ring. */
typedef struct {
    double stiffness[FREEDOMS][FREEDOMS], damping[FREEDOMS][FREEDOMS];
} RingSlopes;

/* Balls that have not been placed yet. */
void balls_unmoved(Bearing *bearing);

/* Begins a step of length h, or of rest where it is 0; balances all balls with the ring at q, moving at v, as often as it takes
 * to find the end of the step, with the slopes there; and moves balls, films and cage to where they were balanced last. `setup`
 * and `before` must stay as they are. */
void balls_begin(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, BallsStep *step);
const char *balls_press(BallsStep *step, Bearing *after, const double q[], const double v[], double force[]);
void balls_slopes(const BallsStep *step, RingSlopes *slopes);
void balls_accept(const BallsStep *step, const Bearing *before, Bearing *after);

/* Moves all balls, films and the cage to the end of a step of length h, with the ring at q, moving at v; `force` is what the
 * ring exerts on the balls. Or puts them at rest. Returns why not, or NULL. */
const char *balls_step(const Setup *setup, const Bearing *before, Bearing *after, double h, double omega, const double q[],
                       const double v[], double force[]);
const char *balls_rest(const Setup *setup, Bearing *bearing, double omega, const double q[], double force[]);

#endif
