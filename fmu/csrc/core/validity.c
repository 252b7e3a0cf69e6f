/* Which bounds of the validity box a contact leaves, as reduced_models.elements.validity has it: a margin goes
 * unmentioned. */
#include "validity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void model_watch(Model *m)
{
    double *value = m->value;
    const double slack = BOX_MARGIN * (value[VR_high] - value[VR_low]);
    const double force = value[VR_force], u = m->input[VR_approach], v = m->input[VR_rate];
    const int approach = !(value[VR_low] - slack <= u && u <= value[VR_high] + slack);
    const int rate = !(fabs(v) <= (1.0 + BOX_MARGIN) * BOX_RATE);
    const int load = !(BOX_LEAST_FORCE <= force && force <= BOX_MOST_FORCE);
    value[VR_outside_approach] = approach;
    value[VR_outside_rate] = rate;
    value[VR_outside_force] = load;
    value[VR_outside_validity] = approach || rate || load;
#ifdef BOX_SPEED
    value[VR_outside_speed] = !(fabs(m->input[VR_u_sum]) <= (1.0 + 1e-9) * BOX_SPEED);
    value[VR_outside_validity] = value[VR_outside_validity] || value[VR_outside_speed] > 0.0;
#endif
}

unsigned long long model_outside(const Model *m)
{
    return (m->value[VR_outside_approach] > 0.0 ? 1U : 0U) | (m->value[VR_outside_rate] > 0.0 ? 2U : 0U)
           | (m->value[VR_outside_force] > 0.0 ? 4U : 0U)
#ifdef BOX_SPEED
           | (m->value[VR_outside_speed] > 0.0 ? 8U : 0U)
#endif
        ;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    const char *approach = m->input[VR_approach] < m->value[VR_low] ? " approach below low;" : " approach above high;";
    snprintf(text, size, "%s%s%s%s", (which & 1U) == 0 ? "" : approach, (which & 2U) == 0 ? "" : " rate;",
             (which & 4U) == 0 ? "" : " force;", (which & 8U) == 0 ? "" : " u_sum above the speeds of the tables;");
    text[strlen(text) - 1] = '\0';
}
