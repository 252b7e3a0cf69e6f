/* Slopes of a step of a bearing beside differences of its force: prints the largest error of each kind of slope, over its largest.
 * bearing_data.h has the bearing; CLEARANCE, SPEED and START, a place of the ring, are given. */
#include <math.h>
#include <stdio.h>

#include "bearing.h"
#include "bearing_data.h"

enum { ROOM = 100000, STEPS = 30 };
static const double h = 1e-5, omega = SPEED, small[2] = {1e-10, 1e-5}; /* m and rad, m/s and rad/s */
static double state[ROOM], work[ROOM];

int main(void)
{
    const BearingSettings settings = {CLEARANCE, 0.0, -1.57, 1.0};
    const double start[MOST_DIRECTIONS] = {START};
    const int n = bearing.directions;
    double at[2][MOST_DIRECTIONS], force[2][MOST_DIRECTIONS], slopes[2][MOST_DIRECTIONS * MOST_DIRECTIONS];
    int i, j, k, kind;
    if (bearing_start(&bearing, &settings, state) != NULL || bearing_rest(&bearing, state, work, omega, start, force[0]) != NULL) {
        return 1;
    }
    for (k = 1; k <= STEPS; k++) {
        for (i = 0; i < n; i++) {
            const double size = i < 3 ? 1e-6 : 2e-5, turn = 2e4 + 3e3 * i;
            at[0][i] = start[i] + size * sin(turn * h * k);
            at[1][i] = size * turn * cos(turn * h * k);
        }
        bearing_begin(&bearing, state, work, h, omega);
        if (bearing_press(&bearing, state, work, at[0], at[1], force[0]) != NULL) {
            return 1;
        }
        if (k < STEPS) {
            bearing_accept(&bearing, state, work);
        }
    }
    bearing_slopes(&bearing, work, slopes[0], slopes[1]);
    for (kind = 0; kind < 2; kind++) {
        double worst = 0.0, most = 0.0;
        for (j = 0; j < n; j++) {
            const double kept = at[kind][j], unit = j < 3 ? 1.0 : 0.02;
            for (i = 0; i < 2; i++) {
                at[kind][j] = kept + (i == 0 ? small[kind] : -small[kind]) / unit;
                if (bearing_press(&bearing, state, work, at[0], at[1], force[i]) != NULL) {
                    return 1;
                }
            }
            at[kind][j] = kept;
            for (i = 0; i < n; i++) {
                const double found = slopes[kind][i * n + j] / unit / (i < 3 ? 1.0 : 0.02);
                const double wanted = 0.5 * (force[0][i] - force[1][i]) / small[kind] / (i < 3 ? 1.0 : 0.02);
                worst = fmax(worst, fabs(found - wanted));
                most = fmax(most, fabs(wanted));
            }
        }
        printf("%g\n", worst / most);
    }
    return 0;
}
