/* Steps of a rotor along a course that is known beforehand; see rotor.h. */
#include <math.h>
#include <string.h>

#include "linear_equations.h"
#include "rotor.h"

/* Load, and forces of the unbalances. */
static void apply(const Rotor *r, const double turning[], double force[])
{
    int i, u;
    for (i = 0; i < r->freedoms; i++) {
        force[i] = r->load * r->L[i];
    }
    for (u = 0; u < 2 * r->unbalances; u++) {
        if (r->unbalance_at[u] >= 0) {
            force[r->unbalance_at[u]] += turning[u];
        }
    }
}

/* Sizes of the structures, for callers in other languages. */
void rotor_sizes(size_t sizes[])
{
    sizes[0] = sizeof(Rotor);
    sizes[1] = sizeof(RotorRun);
    sizes[2] = sizeof(Support);
    sizes[3] = sizeof(FreeStep);
}

void rotor_put(const Rotor *r, const double motion[], const double carried[], const double applied[], double state[])
{
    const RotorLayout at = rotor_layout(r);
    const size_t n = (size_t)r->freedoms, p = (size_t)r->points;
    double *past = state + at.past;
    size_t j;
    memcpy(state + at.place, motion, 3 * n * sizeof state[0]);
    memcpy(state + at.carried, carried, p * sizeof state[0]);
    memcpy(state + at.applied, applied, n * sizeof state[0]);
    memset(past, 0, p * sizeof past[0]);
    add_product(r->points, r->freedoms, 1.0, r->B, motion, past);
    for (j = 0; j < p; j++) {
        past[p + j] = past[2 * p + j] = past[j];
    }
}

/* Writes the end of a step; returns whether a support has moved too far. */
static int record(const Rotor *r, const RotorRun *run, int step, const double state[], const double work[])
{
    const RotorLayout at = rotor_layout(r);
    const size_t n = (size_t)r->freedoms, m = (size_t)r->motions, first = (size_t)step * m;
    const double *pressed = supports_pressed(r, work);
    int lost = 0;
    size_t i;
    memcpy(run->place + (size_t)step * n, state + at.place, n * sizeof state[0]);
    memcpy(run->velocity + (size_t)step * n, state + at.velocity, n * sizeof state[0]);
    for (i = 0; i < m; i++) {
        run->motion[first + i] = pressed[i] - r->shift[i];
        lost |= fabs(pressed[i]) > run->farthest[i];
    }
    memcpy(run->rate + first, pressed + m, m * sizeof pressed[0]);
    memcpy(run->force + first, pressed + 2 * m, m * sizeof pressed[0]);
    run->presses[step] = run->search.presses;
    return lost;
}

const char *rotor_run(const Rotor *r, RotorRun *run, double state[], double work[])
{
    int lost = 0;
    for (run->made = 0; run->made < run->steps && !lost; run->made++) {
        const double *omega = run->omega + run->made;
        const char *reason;
        apply(r, run->turning + 2 * r->unbalances * run->made, run->applied);
        reason = rotor_move(r, run->applied, run->h, 0.5 * (omega[0] + omega[1]), omega[1], state, work, &run->search);
        if (reason != NULL) {
            return reason;
        }
        lost = record(r, run, run->made, state, work);
    }
    return NULL;
}
