/* What the FMI glue asks of a model. config.h names the header that defines Model;
 * Model is a plain struct without pointers, so copying it saves and restores the state. */
#ifndef MODEL_H
#define MODEL_H

#include "config.h"
#include MODEL_HEADER

typedef enum {
    MODEL_OK,
    MODEL_UNKNOWN,    /* no variable of this type has this reference */
    MODEL_READ_ONLY,  /* an output cannot be set */
    MODEL_UNAVAILABLE /* there is a fault, see model_fault */
} ModelResult;

/* Sets every input and parameter to its start value. */
void model_start(Model *model);

/* Each reads or writes one variable. */
ModelResult model_get_real(const Model *model, unsigned int reference, double *value);
ModelResult model_set_real(Model *model, unsigned int reference, double value);
ModelResult model_get_boolean(const Model *model, unsigned int reference, int *value);

/* Partial derivative of one output with respect to one input, at the present inputs. */
ModelResult model_partial(const Model *model, unsigned int unknown, unsigned int known, double *value);

/* NULL if the outputs can be computed, else the reason why not. */
const char *model_fault(const Model *model);

/* NULL, or why the outputs are to be taken with care. */
const char *model_notice(const Model *model);

#endif
