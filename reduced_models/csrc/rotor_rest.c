/* Static equilibrium of a rotor on its supports; see rotor.h. */
#include <math.h>
#include <string.h>

#include "linear_equations.h"
#include "rotor.h"

static const double open = 1.0; /* N/m beside the slopes of supports that hold nothing in some direction */
static const double enough = 1e-9; /* imbalance over the load that is equilibrium where it gets no smaller */
static const char *const no_number = "the motion is too large for a floating-point number";

/* Room behind that of the supports. */
typedef struct {
    double *off, *step, *tried, *pivot, *r, *v, *slopes, *system;
} Room;

static Room room(const Rotor *r, double work[])
{
    const size_t n = (size_t)(r->freedoms + r->held), p = (size_t)r->points;
    Room room;
    room.off = work + supports_work(r);
    room.step = room.off + n;
    room.tried = room.step + n;
    room.pivot = room.tried + n;
    room.r = room.pivot + n;
    room.v = room.r + p;
    room.slopes = room.v + p;
    room.system = room.slopes + p * p;
    return room;
}

static void points_of(const Rotor *r, const double q[], double points[])
{
    memset(points, 0, (size_t)r->points * sizeof points[0]);
    add_product(r->points, r->freedoms, 1.0, r->B, q, points);
}

const char *rotor_place(const Rotor *r, const double *const parameters[], double state[], double work[])
{
    const RotorLayout at = rotor_layout(r);
    const Room own = room(r, work);
    double *shaft = state + at.shaft, *past = state + at.past;
    const char *reason = supports_start(r, parameters, state);
    int j;
    points_of(r, state + at.place, own.r);
    points_of(r, state + at.velocity, own.v);
    if (reason == NULL && r->points > 0) {
        reason = supports_rest(r, state, work, shaft[SHAFT_SPEED], own.r, own.v, state + at.carried);
    }
    for (j = 0; j < r->points; j++) {
        past[j] = past[r->points + j] = past[2 * r->points + j] = own.r[j];
    }
    shaft[SHAFT_RESISTED] = shaft[SHAFT_RESISTED + 1] = 0.0;
    if (reason == NULL && r->inertia != 0.0) {
        shaft[SHAFT_RESISTED] = shaft[SHAFT_RESISTED + 1] = supports_torque(r, state);
    }
    return reason;
}

/* Supports at rest with the rotor where it is, and what they and its stiffness exert on it beyond the load; forces that hold
 * what is held are not in it. */
static const char *rest_at(const Rotor *r, const double *const parameters[], const double given[], double state[], double work[],
                           const Room *own, double *size)
{
    const RotorLayout at = rotor_layout(r);
    const double *q = state + at.place, *reaction = own->step + r->freedoms;
    const char *reason = rotor_place(r, parameters, state, work);
    const int n = r->freedoms;
    double sum = 0.0;
    int i, k;
    for (i = 0; i < n; i++) {
        own->off[i] = -r->load * r->L[i] - given[i];
        for (k = 0; k < n; k++) {
            own->off[i] += r->stiffness * r->K[i * n + k] * q[k];
        }
    }
    rotor_take(r, state + at.carried, -1.0, own->off);
    for (i = 0; i < n; i++) {
        double left = own->off[i];
        for (k = 0; k < r->held; k++) {
            left += r->B[(r->points + k) * n + i] * reaction[k];
        }
        sum += left * left;
    }
    *size = sqrt(sum);
    return reason == NULL && !isfinite(*size) ? no_number : reason;
}

/* Step of Newton's method, and behind it the forces that hold what is held. */
static int newton(const Rotor *r, double work[], const Room *own)
{
    const int n = r->freedoms, p = r->points, all = n + r->held;
    double *system = own->system;
    int i, j, k, l;
    supports_slopes(r, work, 0.0, own->slopes);
    memset(system, 0, (size_t)(all * all) * sizeof system[0]);
    for (i = 0; i < n; i++) {
        own->step[i] = -own->off[i];
        for (k = 0; k < n; k++) {
            system[i * all + k] = r->stiffness * r->K[i * n + k];
        }
    }
    for (j = 0; j < p; j++) {
        for (l = 0; l < p; l++) {
            const double slope = own->slopes[j * p + l] + (j == l ? open : 0.0);
            for (i = 0; i < n; i++) {
                for (k = 0; k < n && r->B[j * n + i] != 0.0; k++) {
                    system[i * all + k] += r->B[j * n + i] * slope * r->B[l * n + k];
                }
            }
        }
    }
    for (j = 0; j < r->held; j++) {
        own->step[n + j] = 0.0;
        for (i = 0; i < n; i++) {
            system[i * all + n + j] = system[(n + j) * all + i] = r->B[(p + j) * n + i];
        }
    }
    if (!factorise(all, system, own->pivot)) {
        return 0;
    }
    substitute(all, system, own->pivot, own->step);
    return 1;
}

const char *rotor_rest(const Rotor *r, const double *const parameters[], const double given[], double state[], double work[])
{
    enum { MOST = 60, HALVINGS = 30 };
    const RotorLayout at = rotor_layout(r);
    const Room own = room(r, work);
    const int n = r->freedoms;
    double *q = state + at.place, load = r->floor, most, size, now;
    const char *reason;
    int i, k, iteration;
    for (i = 0; i < n; i++) {
        load = fmax(load, fabs(r->load * r->L[i] + given[i]));
    }
    most = r->rested * load;
    memset(state + at.velocity, 0, 2 * (size_t)n * sizeof q[0]);
    memset(own.step, 0, (size_t)(n + r->held) * sizeof own.step[0]);
    reason = rest_at(r, parameters, given, state, work, &own, &size);
    for (iteration = 0; iteration < MOST && reason == NULL && !(size <= most); iteration++) {
        const int halvings = size <= enough * load ? 1 : HALVINGS;
        if (!newton(r, work, &own)) {
            return r->held > 0 && r->points == 0 ? NULL : "nothing holds the rotor in some direction";
        }
        memcpy(own.tried, q, (size_t)n * sizeof q[0]);
        now = HUGE_VAL;
        for (k = 0; k < halvings && !(now < size); k++) {
            for (i = 0; i < n; i++) {
                q[i] = own.tried[i] + own.step[i];
                own.step[i] *= 0.5;
            }
            if (rest_at(r, parameters, given, state, work, &own, &now) != NULL) {
                now = HUGE_VAL;
            }
        }
        if (!(now < size)) {
            memcpy(q, own.tried, (size_t)n * sizeof q[0]);
            break;
        }
        size = now;
    }
    if (reason == NULL && !(size <= enough * load)) {
        reason = "no equilibrium under this load with these parameters";
    }
    return reason == NULL ? rotor_place(r, parameters, state, work) : reason;
}
