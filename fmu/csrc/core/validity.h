/* The validity box of a contact. */
#ifndef VALIDITY_H
#define VALIDITY_H

#include "model.h"

/* Says which of its bounds are left; of an evaluated model. */
void model_watch(Model *model);

#endif
