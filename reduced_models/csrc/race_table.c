/* Tables of a race from a static curve; see race_table.h. */
#include "race_table.h"

#include <math.h>
#include <stddef.h>

/* Cubics between two approaches, each from a value and a slope at either end. */
static void cells_between(const FilmLaw *law, double from, double to, double cells[])
{
    Rest here, next;
    int j;
    film_static(law, from, NULL, &here);
    for (j = 0; j < CELLS; j++, here = next) {
        double *cell = &cells[4 * j], start, end, rise;
        film_static(law, j + 1 < CELLS ? from + (to - from) * (j + 1) / CELLS : to, NULL, &next);
        start = here.g_u * (to - from) / CELLS;
        end = next.g_u * (to - from) / CELLS;
        rise = next.g - here.g;
        cell[0] = here.g;
        cell[1] = start;
        cell[2] = 3.0 * rise - 2.0 * start - end;
        cell[3] = start + end - 2.0 * rise;
    }
}

void race_cells(const FilmLaw *law, int nodes, const double x[], double u[], double cells[])
{
    int k;
    for (k = 0; k < nodes; k++) {
        u[k] = exp(2.0 / 3.0 * x[k]) - film_under(law, x[k]);
    }
    for (k = 0; k + 1 < nodes; k++) {
        cells_between(law, u[k], u[k + 1], &cells[4 * CELLS * k]);
    }
}
