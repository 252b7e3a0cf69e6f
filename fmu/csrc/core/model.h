/* Functions that a model provides for the core, and what it gets. config.h is generated: it numbers the variables, the
 * inputs first, counts them, states and contacts, names the later input that is the rate of one (INPUT_RATES, -1 for none) and
 * where a validity box ends. A Model is plain numbers, so copying it saves it. */
#ifndef MODEL_H
#define MODEL_H

#include <stddef.h>

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

/* A fault, or none where there is no reason. */
static inline Fault fault(Severity severity, const char *reason)
{
    Fault f;
    f.severity = reason == NULL ? FINE : severity;
    f.reason = reason;
    return f;
}

/* What moves the states: steps of co-simulation; in model exchange the importer, but up to the end of initialization those
 * that are calculated follow from inputs and parameters. */
typedef enum { IN_STEPS, STARTING, IN_CONTINUOUS_TIME } Stage;

typedef struct {
    double stage;                /* of Stage */
    double value[N_VARIABLES];   /* by value reference; a Boolean is 0 or 1 */
    double input[N_INPUTS];      /* that the outputs belong to: those that were set, or those of the end of a step */
    double indicator[N_CONTACTS > 0 ? N_CONTACTS : 1]; /* of each contact: > 0 while the surfaces push */
    double cache[N_CACHE];       /* what a model remembers besides */
} Model;

/* How an input goes through a step, t from its start: start + slope t + bend t^2/2, until end. */
typedef struct {
    double start, slope, bend, end;
} Path;

/* The inputs of a step. Where they are not `known` within it, only their ends are. */
typedef struct {
    int known;
    Path input[N_INPUTS];
} Motion;

/* Checks the parameters and fills the cache with what follows from them. May leave anything in a model it refuses. */
Fault model_prepare(Model *model);

/* Outputs and indicators at model->input and the states; untouched if it refuses. */
Fault model_evaluate(Model *model);

/* Derivatives of the states, of an evaluated model. */
Fault model_rates(Model *model);

/* Moves the states along `motion` for a time h, the inputs to its end, and evaluates there;
 * a relative error of the force of about `tolerance` is allowed. May leave anything in a model it refuses. */
Fault model_step(Model *model, const Motion *motion, double h, double tolerance);

/* Change of outputs and derivatives, by value reference, along `seed`, a direction of inputs, parameters and states;
 * of an evaluated model. Entries of `along` that are neither stay as they are. */
void model_direction(const Model *model, const double seed[], double along[]);

/* Which bounds of validity boxes an evaluated model has left, as bits, and in words those in `which`. */
unsigned long long model_outside(const Model *model);
void model_name_outside(const Model *model, unsigned long long which, char *text, size_t size);

#endif
