/* Layout of a rotor's numbers, and its forces; see rotor.h. */
#include "rotor.h"

#include <math.h>
#include <string.h>

#include "linear_equations.h"

size_t rotor_size(const Rotor *r)
{
    return rotor_layout(r).supports + support_place(r, r->supports);
}

size_t support_place(const Rotor *r, int support)
{
    size_t place = 0;
    int i;
    for (i = 0; i < support; i++) {
        place += r->support[i]->size;
    }
    return place;
}

/* That of the supports, then vectors and matrices of a step or of rest. */
size_t rotor_work(const Rotor *r)
{
    const size_t n = (size_t)(r->freedoms + r->held), p = (size_t)r->points;
    return supports_work(r) + 6 * n + 8 * p + 2 * p * p + n * n + n;
}

double rotor_motion(const Rotor *r, int motion, const double q[])
{
    const double *tie = &r->ties[motion * r->points];
    double sum = 0.0;
    int j;
    for (j = 0; j < r->points; j++) {
        if (tie[j] != 0.0) {
            add_product(1, r->freedoms, tie[j], &r->B[j * r->freedoms], q, &sum);
        }
    }
    return sum;
}

void rotor_swing(const Rotor *r, double angle, double swing[])
{
    int u;
    for (u = 0; u < r->unbalances; u++) {
        const double place = angle + r->phase[u];
        swing[2 * u] = cos(place);
        swing[2 * u + 1] = sin(place);
    }
}

void rotor_applied(const Rotor *r, const double given[], const double unbalance[], const double swing[], double omega,
                   double spin, double force[])
{
    int i, u;
    for (i = 0; i < r->freedoms; i++) {
        force[i] = r->load * r->L[i] + given[i];
    }
    for (u = 0; u < r->unbalances; u++) {
        const double c = swing[2 * u], s = swing[2 * u + 1], amount = unbalance[u];
        const int x = r->unbalance_at[2 * u], y = r->unbalance_at[2 * u + 1];
        if (x >= 0) {
            force[x] += amount * (omega * omega * c + spin * s);
        }
        if (y >= 0) {
            force[y] += amount * (omega * omega * s - spin * c);
        }
    }
}

void rotor_take(const Rotor *r, const double carried[], double weight, double force[])
{
    int i, j;
    for (j = 0; j < r->points; j++) {
        const double *row = &r->B[j * r->freedoms], push = weight * carried[j];
        for (i = 0; i < r->freedoms; i++) {
            force[i] -= push * row[i];
        }
    }
}

void rotor_accelerate(const Rotor *r, const double force[], double acceleration[])
{
    memset(acceleration, 0, (size_t)r->freedoms * sizeof acceleration[0]);
    add_product(r->freedoms, r->freedoms, 1.0 / r->mass, r->M_inverse, force, acceleration);
}

void rotor_resist(const Rotor *r, double omega, const double q[], const double v[], double force[])
{
    const int n = r->freedoms;
    add_product(n, n, -r->damping, r->C, v, force);
    add_product(n, n, -r->stiffness, r->K, q, force);
    if (r->G != NULL) {
        add_product(n, n, -r->mass * omega, r->G, v, force);
    }
}

double rotor_slowed(const Rotor *r, const double unbalance[], const double swing[], const double a[])
{
    double sum = 0.0;
    int u;
    for (u = 0; u < r->unbalances; u++) {
        const double c = swing[2 * u], s = swing[2 * u + 1];
        const int x = r->unbalance_at[2 * u], y = r->unbalance_at[2 * u + 1];
        sum += unbalance[u] * ((y >= 0 ? a[y] * c : 0.0) - (x >= 0 ? a[x] * s : 0.0));
    }
    return sum;
}
