/* Groove centres, contact angles and rolling of a ball between two races: reduced_models.bearing.contact_angles. In the plane
 * through a ball and the axis of the bearing, r outward and z along the shaft, the outer groove centre is the origin, that of
 * the inner groove is at c and the ball at b: two springs in series, l_i = |c - b| and l_o = |b|. */
#ifndef CONTACT_ANGLES_H
#define CONTACT_ANGLES_H

#include "balls.h"
#include "dual.h"

enum { OUTER_CONTROL, INNER_CONTROL, SHARED_CONTROL, HARRIS_CONTROL };
enum { BY_FORCES = RACE_CONTROL == INNER_CONTROL || RACE_CONTROL == SHARED_CONTROL }; /* races share the moment so */

/* Direction to a ball; inner groove centre there, how far the ring has moved it, and its velocity as the ball sees it. */
typedef struct {
    Dual x, y, c[2], moved[2], d[2];
} GrooveCentre;

GrooveCentre groove_centre(const Setup *setup, const Dual q[], const Dual v[], Dual angle, Dual cage, int k);

/* Ball between two races. Angular speeds over that of the shaft, entrainment speeds over it [m]. */
typedef struct {
    Dual l[2], cosine[2], sine[2]; /* inner and outer spring */
    Dual orbit, ball_rotation, sin_b, share, speed_sum[2];
} Rolling;

/* The vector along the inner spring: its groove never pulls a ball inward. Returns its length. */
Dual inner_span(const Dual b[2], const Dual c[2], Dual s[2]);

/* Angles and speeds of a ball; `approach` is that of its contacts, or NULL: the lengths of the springs say it well enough. */
Rolling roll(const Setup *setup, const Dual b[2], const Dual c[2], const Dual *approach);

/* Films at both races over those of the tables. */
void film_factors(const Rolling *at, Dual factor[2]);

/* Forces on a ball: all of them, that of the inner ring, and its moment about the inner groove centre. */
typedef struct {
    Dual sum[2], ring[2], moment;
} BallForces;

BallForces forces_on(const Rolling *at, Dual omega, Dual f_i, Dual f_o);

/* Adds the force of a ball to those of the ring. */
void add_to_ring(const GrooveCentre *at, const BallForces *ball, Dual force[]);

/* Both contacts and all forces of a ball at some place. */
typedef struct {
    Rolling at;
    RaceForce inner, outer;
    BallForces forces;
    double l[2], cosine[2], sine[2], sum[2]; /* of `at` and `forces` */
    double e[2], v[2], rate[2]; /* velocities along which the springs move; of both approaches */
} Pressed;

/* A ball in a step, where it is looked for, and where it was balanced last. */
typedef struct {
    const Setup *setup;
    RaceStep contact[2];
    Thickness film[2];
    StepFilters filters[2];
    double gain, history[2], omega;
    GrooveCentre centre;
    double start[PLACES], place[PLACES];
    Pressed found;
} BallStep;

struct BallsStep {
    double h, omega, cage; /* s, rad/s, rad/s */
    BallStep ball[BALLS];
};

#endif
