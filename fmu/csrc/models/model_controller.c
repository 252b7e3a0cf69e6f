/* A speed controller, proportional and integral, with a limit of its torque. Equations in README.md. */
#include <math.h>

#include "model.h"

enum { INTEGRAL, DIFFERENCE, MOVING }; /* in the cache; set point less speed at the end of the last step */

static const Fault fine = {FINE, NULL};

static double clipped(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* The torque, and the integral as far as the limit lets it go, from `before` by `change`. */
static Fault control(Model *m, double difference, double before, double change)
{
    const double limit = m->value[VR_torque_limit], proportional = m->value[VR_proportional_gain] * difference;
    const double after = before + change, torque = clipped(proportional + after, -limit, limit);
    if (!isfinite(proportional + after)) {
        return fault(DISCARD, "the torque is too large for a floating-point number");
    }
    m->cache[INTEGRAL] = torque == proportional + after
                             ? after : clipped(torque - proportional, fmin(before, after), fmax(before, after));
    m->cache[DIFFERENCE] = difference;
    m->value[VR_torque] = torque;
    return fine;
}

Fault model_prepare(Model *m)
{
    const double *value = m->value;
    if (!(value[VR_proportional_gain] >= 0.0 && isfinite(value[VR_proportional_gain]) && value[VR_integral_gain] >= 0.0
          && isfinite(value[VR_integral_gain]))) {
        return fault(REFUSE, "proportional_gain and integral_gain must be finite and >= 0");
    }
    if (!(value[VR_torque_limit] > 0.0 && isfinite(value[VR_torque_limit]) && isfinite(value[VR_integral_start]))) {
        return fault(REFUSE, "torque_limit must be finite and > 0, and integral_start finite");
    }
    return fine;
}

/* Before the first step the torque of the inputs; later, outputs are those of the last step, whatever the inputs. */
Fault model_evaluate(Model *m)
{
    if (m->cache[MOVING] != 0.0) {
        return fine;
    }
    return control(m, m->input[VR_speed_set_point] - m->input[VR_speed], m->value[VR_integral_start], 0.0);
}

Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    const Path *wanted = &motion->input[VR_speed_set_point], *speed = &motion->input[VR_speed];
    const double start = wanted->start - speed->start, end = wanted->end - speed->end;
    Model next = *m;
    Fault found;
    (void)tolerance;
    next.cache[MOVING] = 1.0;
    found = control(&next, end, m->cache[INTEGRAL], m->value[VR_integral_gain] * h * 0.5 * (start + end));
    if (found.severity == FINE) {
        next.input[VR_speed_set_point] = wanted->end;
        next.input[VR_speed] = speed->end;
        *m = next;
    }
    return found;
}

void model_direction(const Model *m, const double seed[], double along[])
{
    (void)m, (void)seed, (void)along;
}

unsigned long long model_outside(const Model *m)
{
    (void)m;
    return 0;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    (void)m, (void)which;
    if (size > 0) {
        text[0] = '\0';
    }
}
