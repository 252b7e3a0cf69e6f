/* The supports inside a rotor, all together; see rotor.h. Work begins with that of every support; then motions, their rates and
 * forces, and the slopes of one support. */
#include <string.h>

#include "rotor.h"

typedef struct {
    double *motion, *rate, *force, *stiffness, *damping;
} Shared;

static size_t own_work(const Rotor *r, int support)
{
    size_t place = 0;
    int i;
    for (i = 0; i < support; i++) {
        place += r->support[i]->work;
    }
    return place;
}

size_t supports_work(const Rotor *r)
{
    const size_t m = (size_t)r->motions;
    return own_work(r, r->supports) + 3 * m + 2 * m * m;
}

static Shared shared(const Rotor *r, double work[])
{
    const size_t m = (size_t)r->motions;
    Shared s;
    s.motion = work + own_work(r, r->supports);
    s.rate = s.motion + m;
    s.force = s.rate + m;
    s.stiffness = s.force + m;
    s.damping = s.stiffness + m * m;
    return s;
}

static double *numbers(const Rotor *r, double state[], int support)
{
    return state + rotor_layout(r).supports + support_place(r, support);
}

/* Motions of the supports from those of the points. */
static void move(const Rotor *r, const double points[], const double shift[], double motion[])
{
    int i, j;
    for (i = 0; i < r->motions; i++) {
        const double *tie = &r->ties[i * r->points];
        double sum = shift == NULL ? 0.0 : shift[i];
        for (j = 0; j < r->points; j++) {
            sum += tie[j] * points[j];
        }
        motion[i] = sum;
    }
}

static void carry(const Rotor *r, const double force[], double carried[])
{
    int i, j;
    memset(carried, 0, (size_t)r->points * sizeof carried[0]);
    for (i = 0; i < r->motions; i++) {
        const double *tie = &r->ties[i * r->points], push = r->count[i] * force[i];
        for (j = 0; j < r->points; j++) {
            carried[j] += tie[j] * push;
        }
    }
}

const char *supports_start(const Rotor *r, const double *const parameters[], double state[])
{
    const char *reason = NULL;
    int i;
    for (i = 0; i < r->supports && reason == NULL; i++) {
        reason = r->support[i]->start(r->support[i]->own, parameters[i], numbers(r, state, i));
    }
    return reason;
}

void supports_begin(const Rotor *r, const double state[], double work[], double h, double omega)
{
    const double *own = state + rotor_layout(r).supports;
    int i;
    for (i = 0; i < r->supports; i++) {
        const Support *support = r->support[i];
        support->begin(support->own, own, work, h, omega);
        own += support->size;
        work += support->work;
    }
}

/* Forces on the points; `rest`, the numbers of supports that come to rest with the shaft turning at omega, is NULL in a step. */
static const char *exert(const Rotor *r, const double own[], double *rest, double work[], double omega, const double points[],
                         const double v[], double carried[], int *refused)
{
    const Shared s = shared(r, work);
    int i;
    move(r, points, r->shift, s.motion);
    move(r, v, NULL, s.rate);
    for (i = 0; i < r->supports; i++) {
        const Support *support = r->support[i];
        const int first = r->first[i];
        const double *q = &s.motion[first], *rate = &s.rate[first];
        double *force = &s.force[first];
        const char *reason = rest == NULL ? support->press(support->own, own, work, q, rate, force)
                                          : support->rest(support->own, rest, work, omega, q, rate, force);
        if (reason != NULL) {
            *refused = i;
            return reason;
        }
        own += support->size;
        rest = rest == NULL ? NULL : rest + support->size;
        work += support->work;
    }
    carry(r, s.force, carried);
    return NULL;
}

const char *supports_press(const Rotor *r, const double state[], double work[], const double points[], const double v[],
                           double carried[], int *refused)
{
    return exert(r, state + rotor_layout(r).supports, NULL, work, 0.0, points, v, carried, refused);
}

const double *supports_pressed(const Rotor *r, const double work[])
{
    return work + own_work(r, r->supports);
}

const char *supports_rest(const Rotor *r, double state[], double work[], double omega, const double points[], const double v[],
                          double carried[])
{
    double *own = state + rotor_layout(r).supports;
    int refused;
    return exert(r, own, own, work, omega, points, v, carried, &refused);
}

void supports_slopes(const Rotor *r, double work[], double gain, double slopes[])
{
    const Shared s = shared(r, work);
    const int n = r->points;
    int i, a, b, j, l;
    memset(slopes, 0, (size_t)(n * n) * sizeof slopes[0]);
    for (i = 0; i < r->supports; i++) {
        const Support *support = r->support[i];
        const int first = r->first[i], m = support->motions;
        support->slopes(support->own, work, s.stiffness, s.damping);
        work += support->work;
        for (a = 0; a < m; a++) {
            const double *tie = &r->ties[(first + a) * n];
            for (b = 0; b < m; b++) {
                const double *other = &r->ties[(first + b) * n];
                const double slope = r->count[first + a] * (s.stiffness[a * m + b] + gain * s.damping[a * m + b]);
                for (j = 0; j < n; j++) {
                    const double part = tie[j] * slope;
                    for (l = 0; l < n && part != 0.0; l++) {
                        slopes[j * n + l] += part * other[l];
                    }
                }
            }
        }
    }
}

const char *supports_accept(const Rotor *r, double state[], double work[], int *refused)
{
    double *own = state + rotor_layout(r).supports;
    const char *reason = NULL;
    int i;
    for (i = 0; i < r->supports && reason == NULL; i++) {
        const Support *support = r->support[i];
        reason = support->accept(support->own, own, work);
        *refused = reason == NULL ? *refused : i;
        own += support->size;
        work += support->work;
    }
    return reason;
}

double supports_torque(const Rotor *r, const double state[])
{
    const double *own = state + rotor_layout(r).supports;
    double torque = 0.0;
    int i;
    for (i = 0; i < r->supports; i++) {
        torque += r->support[i]->torque(r->support[i]->own, own, NULL);
        own += r->support[i]->size;
    }
    return torque;
}
