/* What an FMU can tell of its master in co-simulation: which force acts on the mass, and how its displacement goes on. From both
 * follows the lead that leaves a vibration its damping. Not part of the state: a master that goes back is one too. */
#ifndef MASTER_H
#define MASTER_H

#include "core.h"

enum { DELAYS = 5 }; /* of the force that acts on the mass: -1/2, 0, 1/2, 1, 3/2 steps */

/* Coefficients of 1, e and e^2: the product of two series, each with its second difference plus e times itself. */
typedef struct {
    double one, e, ee;
} Product;

/* A displacement, and the force on it. */
typedef struct {
    double place, rate, change;                         /* of the last step; the last change of the rate */
    double force[3];                                    /* of the three last steps, the later first */
    double acting[DELAYS];                              /* force that acted in the last step, by its delay */
    double changes[2], drives[DELAYS][2];               /* of changes of the rate, and of acting forces: the two last differences */
    Product squares, products[DELAYS], drives_squared[DELAYS]; /* sums over a window */
    double shares, change_squares, missed_squares;      /* of what the mean rate misses in a step */
    double skew, inertia;                               /* of the last window: its share; change of the rate by a force */
    int delay, agreed, skewed;                          /* windows on end of this delay; of a skew without one */
} Course;

typedef struct {
    Course course[N_INPUTS];
    double start, length, inputs[N_INPUTS]; /* of the last step */
    unsigned long long repeats;             /* bits: of the last 64 steps, those that were made again with other inputs */
    int steps, size, unclear;               /* steps of this window and its size; the master reads, or gives, what hides the rest */
    int told;
} Master;

/* After a step. Returns a text in `text` if the lead is wrong for this master, once; NULL else. */
const char *master_warning(Master *master, const State *state, char *text, size_t size);

/* The master has set an earlier state: the last steps are none of one course. */
void master_goes_back(Master *master);

/* The master gives or reads derivatives: its lead cannot be told. */
void master_is_unclear(Master *master);

#endif
