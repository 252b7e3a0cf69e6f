/* Slopes of a step of the bearing TESTED inside a rotor beside differences of its force: prints the largest error of each kind of
 * slope, over its largest. RING, PARAMETERS and START, a place of the ring, are given. */
#include "bearing_law.h"

#include <math.h>
#include <stdio.h>

enum { N = RING, ROOM = 100000, STEPS = 30 };
static const double h = 1e-5, omega = 600.0, small[2] = {1e-10, 1e-5}; /* m and rad, m/s and rad/s */
static double numbers[ROOM], work[ROOM];

extern const BearingLaw TESTED;

int main(void)
{
    const BearingLaw *law = &TESTED;
    const double parameters[] = {PARAMETERS}, start[N] = {START};
    double at[2][N], force[2][N], slopes[2][N * N];
    int i, j, k, kind;
    if (law->start(numbers, parameters) != NULL) {
        return 1;
    }
    for (k = 0; k <= STEPS; k++) {
        for (i = 0; i < N; i++) {
            const double size = (i < 3 ? 1e-6 : 2e-5), turn = 2e4 + 3e3 * i;
            at[0][i] = start[i] + size * sin(turn * h * k);
            at[1][i] = k == 0 ? 0.0 : size * turn * cos(turn * h * k);
        }
        law->begin(numbers, work, k == 0 ? 0.0 : h, omega);
        if (law->press(work, at[0], at[1], force[0]) != NULL) {
            return 1;
        }
        if (k < STEPS && law->accept(numbers, work, at[0]) != NULL) {
            return 1;
        }
    }
    law->slopes(work, slopes[0], slopes[1]);
    for (kind = 0; kind < 2; kind++) {
        double worst = 0.0, most = 0.0;
        for (j = 0; j < N; j++) {
            const double kept = at[kind][j], unit = j < 3 ? 1.0 : 0.02;
            for (i = 0; i < 2; i++) {
                at[kind][j] = kept + (i == 0 ? small[kind] : -small[kind]) / unit;
                if (law->press(work, at[0], at[1], force[i]) != NULL) {
                    return 1;
                }
            }
            at[kind][j] = kept;
            for (i = 0; i < N; i++) {
                const double found = slopes[kind][i * N + j] / unit / (i < 3 ? 1.0 : 0.02);
                const double wanted = 0.5 * (force[0][i] - force[1][i]) / small[kind] / (i < 3 ? 1.0 : 0.02);
                worst = fmax(worst, fabs(found - wanted));
                most = fmax(most, fabs(wanted));
            }
        }
        printf("%g\n", worst / most);
    }
    return 0;
}
