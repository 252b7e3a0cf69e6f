/* What the common core asks of a model, and a model of the core. config.h is generated: it numbers the variables,
 * counts the states and says where the validity box ends. A Model is plain numbers, so copying it saves it. */
#ifndef MODEL_H
#define MODEL_H

#include "config.h"

typedef enum {
    FINE,
    DISCARD, /* another input or a shorter step can help */
    REFUSE
} Severity;

typedef struct {
    Severity severity;
    const char *reason; /* NULL if fine */
} Fault;

/* What the inputs of a step mean; the values of the parameter input_meaning. */
typedef enum { EXTRAPOLATED = 1, AT_THE_END = 2, HELD = 3 } Meaning;

typedef struct {
    double value[N_VARIABLES]; /* by value reference; a Boolean is 0 or 1 */
    double approach, rate;     /* that the outputs belong to: those of the inputs, or of the end of a step */
    double indicator;          /* of contact: > 0 while the surfaces push */
    double cache[N_CACHE];     /* what follows from parameters, approach and rate alone */
} Model;

/* How approach and rate go through a step, t from its start:
 * approach + slope t + bend t^2/2, and rate + turn t; with AT_THE_END only both ends are known. */
typedef struct {
    Meaning meaning;
    double approach, slope, bend;
    double rate, turn;
    double end_approach, end_rate;
} Motion;

/* Checks the parameters and fills the cache with what follows from them. May leave anything in a model it refuses. */
Fault model_prepare(Model *model);

/* Outputs and indicator at model->approach, model->rate and the states; untouched if it refuses. */
Fault model_evaluate(Model *model);

/* Derivatives of the states, of an evaluated model. */
Fault model_rates(Model *model);

/* Moves the states along `motion` for a time h, approach and rate to its end, and evaluates there;
 * a relative error of the force of about `tolerance` is allowed. Untouched if it refuses. */
Fault model_step(Model *model, const Motion *motion, double h, double tolerance);

/* Change of outputs and derivatives, by value reference, along `seed`, a direction of inputs, parameters and states;
 * of an evaluated model. Entries of `along` that are neither stay as they are. */
void model_direction(const Model *model, const double seed[], double along[]);

/* Says which bounds of the validity box are left; of an evaluated model. */
void model_watch(Model *model);

#endif
