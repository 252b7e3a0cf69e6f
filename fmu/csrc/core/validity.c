/* Which bounds of the validity box a state leaves, as reduced_models.elements.validity has it: a margin goes unmentioned. */
#include <math.h>

#include "model.h"

void model_watch(Model *m)
{
    double *value = m->value;
    const double slack = BOX_MARGIN * (value[VR_high] - value[VR_low]);
    const double force = value[VR_force];
    const int approach = !(value[VR_low] - slack <= m->approach && m->approach <= value[VR_high] + slack);
    const int rate = !(fabs(m->rate) <= (1.0 + BOX_MARGIN) * BOX_RATE);
    const int load = !(BOX_LEAST_FORCE <= force && force <= BOX_MOST_FORCE);
    value[VR_outside_approach] = approach;
    value[VR_outside_rate] = rate;
    value[VR_outside_force] = load;
    value[VR_outside_validity] = approach || rate || load;
}
