/* A linear rotor on supports that are inside:
 *
 *     m M q'' + (c C + m omega G) q' + s K q + sum_i n_i T_i^T F_i = l L + P + U (omega^2 (cos, sin) + alpha (sin, -cos))(angle + phase)
 *     m J alpha = torque - torques of the supports - sum_u U (y'' cos - x'' sin)(angle + phase),  angle' = omega
 *
 * Equations in README.md. Tables are constant; state and work are plain numbers: copying them saves a rotor. */
#ifndef ROTOR_H
#define ROTOR_H

#include <stddef.h>
#include <stdint.h>

#include "support.h"

typedef struct {
    int freedoms, points, motions, supports, unbalances; /* of q; at which supports act; of all supports */
    double mass, damping, stiffness, load;               /* factors of matrices and constant forces */
    const double *M, *C, *G, *K, *L;                     /* (freedoms, freedoms) row by row; G: NULL for none; L: (freedoms) */
    const double *M_inverse;
    const double *B;                                     /* (points + held, freedoms): displacements of the points */
    const double *ties, *shift, *count;                  /* (motions, points), then (motions): motions are ties B q + shift */
    const int *unbalance_at;                             /* (unbalances, 2): x and y, -1 for none */
    const double *phase;
    double inertia;                                      /* J; 0 where the speed is given */
    double rho;                                          /* spectral radius of steps at infinite frequency */
    double allowed;                                      /* N: what may be left of an imbalance in a step; 0: shares of the forces */
    double floor, balanced, rested;                      /* N, and shares of the forces: what may be left of it, in steps, at rest */
    int held;                                            /* rows of B behind those of the points: held in equilibrium */
    const Support *const *support;
    const int *first;                                    /* first motion of each support */
} Rotor;

/* Places in the state. Accelerations follow displacements and velocities; forces on the points and applied forces are those of
 * the last step's end, `past` the points at the ends of the last three, the newest first, `swing` where the unbalances are; then the
 * linear part of a step. */
typedef struct {
    size_t place, velocity, acceleration, past, carried, applied, shaft, swing, step, supports;
} RotorLayout;

enum { METHOD_NUMBERS = 11 }; /* weights of a step: rotor_step.c */
enum { SHAFT_ANGLE, SHAFT_ANGLE_REST, SHAFT_SPEED, SHAFT_SPIN, SHAFT_RESISTED, SHAFT_MOVING = SHAFT_RESISTED + 2, SHAFT_NUMBERS };

/* Step length and speed, method, factors, pivots, responses to unit forces at the points, and the stiffness of these. */
static inline size_t step_numbers(const Rotor *r)
{
    const size_t n = (size_t)r->freedoms, p = (size_t)r->points;
    return 2 + METHOD_NUMBERS + n * n + n + p * n + p * p;
}

static inline RotorLayout rotor_layout(const Rotor *r)
{
    const size_t n = (size_t)r->freedoms, p = (size_t)r->points;
    RotorLayout at;
    at.place = 0;
    at.velocity = n;
    at.acceleration = 2 * n;
    at.past = 3 * n;
    at.carried = at.past + 3 * p;
    at.applied = at.carried + p;
    at.shaft = at.applied + n;
    at.swing = at.shaft + SHAFT_NUMBERS;
    at.step = at.swing + 2 * (size_t)r->unbalances;
    at.supports = at.step + step_numbers(r);
    return at;
}

size_t rotor_size(const Rotor *rotor); /* of the state */
size_t rotor_work(const Rotor *rotor);
size_t support_place(const Rotor *rotor, int support); /* of its numbers, from layout.supports on */
size_t supports_work(const Rotor *rotor);              /* of all supports; that of a step or of rest is behind it */

/* Displacements of `motion` and their rates, from those of the rotor. */
double rotor_motion(const Rotor *rotor, int motion, const double q[]);

/* ---- forces ---- */

/* Directions of the unbalances, (unbalances, 2), with the shaft at an angle: cosine and sine. */
void rotor_swing(const Rotor *rotor, double angle, double swing[]);
/* Load, forces that are given on all freedoms, and unbalances in these directions. */
void rotor_applied(const Rotor *rotor, const double given[], const double unbalance[], const double swing[], double omega,
                   double spin, double force[]);
/* Takes `weight` times the forces on the points from forces on the freedoms. */
void rotor_take(const Rotor *rotor, const double carried[], double weight, double force[]);
/* Accelerations under forces on the freedoms, by the mass alone; not in place. */
void rotor_accelerate(const Rotor *rotor, const double force[], double acceleration[]);
/* Takes damping and stiffness from forces. */
void rotor_resist(const Rotor *rotor, double omega, const double q[], const double v[], double force[]);
/* Torque that unbalances take from the shaft through these accelerations. */
double rotor_slowed(const Rotor *rotor, const double unbalance[], const double swing[], const double acceleration[]);

/* ---- supports ---- */

const char *supports_start(const Rotor *rotor, const double *const parameters[], double state[]);
/* Work of all supports, their forces on the points, and slopes of these by the points, velocities being `gain` times as much. */
void supports_begin(const Rotor *rotor, const double state[], double work[], double h, double omega);
/* `refused` becomes the support that has no force there. */
const char *supports_press(const Rotor *rotor, const double state[], double work[], const double r[], const double v[],
                           double carried[], int *refused);
/* Motions of the supports where they were pressed last, their rates, and their forces: (3, motions). */
const double *supports_pressed(const Rotor *rotor, const double work[]);
const char *supports_rest(const Rotor *rotor, double state[], double work[], double omega, const double r[], const double v[],
                          double carried[]);
void supports_slopes(const Rotor *rotor, double work[], double gain, double slopes[]);
/* `refused` becomes the support that cannot be there. */
const char *supports_accept(const Rotor *rotor, double state[], double work[], int *refused);
/* At the end of the last step, or at rest. */
double supports_torque(const Rotor *rotor, const double state[]);

/* ---- motion ---- */

/* Supports where the rotor is, at rest but for contacts, which have its velocity; forces on the points and torques follow. */
const char *rotor_place(const Rotor *rotor, const double *const parameters[], double state[], double work[]);
/* Equilibrium under the load and `given` forces, from the place of the state, what is held staying there; supports are at rest. */
const char *rotor_rest(const Rotor *rotor, const double *const parameters[], const double given[], double state[], double work[]);

/* What acts at a time. */
typedef struct {
    const double *given, *unbalance; /* on the freedoms; amounts */
    double torque, drag;             /* of the motor; of what is outside, against the turning */
    double omega;                    /* where the speed is given */
} Acting;

/* Accelerations at the start of a step of length h under what acts now and at its end; later ones go on from the last step. */
void rotor_begin(const Rotor *rotor, const Acting *now, const Acting *end, double h, double state[], double work[]);
/* A step of length h; torque and drag are those of its middle. */
const char *rotor_step(const Rotor *rotor, const Acting *end, double h, double state[], double work[]);

/* How the balance of a step was looked for: how often the supports were pressed, and the one that has no force there, or -1. */
typedef struct {
    int presses, refused;
} Search;

/* A step of length h to where these forces act on the freedoms, with the shaft turning at `omega` in its middle and at `after` at its
 * end: what `rotor_step` does with its own. The angle of the shaft is left alone. */
const char *rotor_move(const Rotor *rotor, const double applied[], double h, double omega, double after, double state[],
                       double work[], Search *search);

/* The same in parts, for a caller that finds the balance itself. First what the points would do without forces of the supports at the
 * end: of a place r there the rate is gain r + history, and the forces balance where stiffness (r - free) + weight F = 0. Then the
 * step ends with the points at r, where `reaction`, of the points on what moves them, has brought them; F is `carried`. */
typedef struct {
    double gain, weight;
    const double *free, *history, *stiffness; /* (points), (points), (points, points) */
} FreeStep;

const char *rotor_free_step(const Rotor *rotor, const double applied[], double h, double omega, double state[], double work[],
                            FreeStep *step);
const char *rotor_end_step(const Rotor *rotor, const double applied[], const double r[], const double reaction[],
                           const double carried[], double state[], double work[]);

/* Lets the linear part of the next step be made anew: matrices have changed. */
void rotor_renew(const Rotor *rotor, double state[]);

/* From places to rates in a step of length h. */
double rotor_gain(double rho, double h);

/* Steps of length h along a course of the shaft. */
typedef struct {
    int steps, made;        /* wanted; done */
    Search search;          /* in the last step that was begun */
    double h;
    const double *omega;    /* (steps + 1): speed of the shaft at the start and at the end of every step */
    const double *turning;  /* (steps, 2 unbalances): forces of the unbalances at the ends */
    const double *farthest; /* (motions): a support that moved farther is lost, and the run ends there */
    double *applied;        /* (freedoms): room */
    /* At the ends: (steps, freedoms) twice; (steps, motions) without `shift`, rates, forces; (steps) presses. */
    double *place, *velocity, *motion, *rate, *force;
    int64_t *presses;
} RotorRun;

/* The rotor at the start of a run, with forces on the points and on the freedoms; its supports are in the state already.
 * `motion` has displacements, velocities and accelerations. */
void rotor_put(const Rotor *rotor, const double motion[], const double carried[], const double applied[], double state[]);

const char *rotor_run(const Rotor *rotor, RotorRun *run, double state[], double work[]);

#endif
