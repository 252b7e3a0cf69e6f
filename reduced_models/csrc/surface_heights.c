/* Heights of features; see surface_heights.h. */
#include "surface_heights.h"

#include <math.h>
#include <stddef.h>

enum { RAISED, TABLE, RING_SPEED = 3 }; /* columns of the numbers of a ball; first of its tables, and of speeds of rings */
static const double half_turn = 3.141592653589793;

double table_height(const HeightTables *h, int table, double angle, double compression)
{
    const int places = h->rows - 1, columns = h->columns;
    const double *page, *here, *next;
    double turns, place, load, s, t, low, high;
    int i, j;
    if (table == 0) {
        return 0.0;
    }
    page = h->heights + (size_t)table * (size_t)h->rows * (size_t)columns;
    turns = angle / (2.0 * half_turn);
    place = (turns - floor(turns)) * places;
    i = place < places - 1 ? (int)place : places - 1;
    s = place - i;
    here = page + (size_t)i * (size_t)columns;
    next = i + 1 < places ? here + columns : page;
    load = compression > 0.0 ? sqrt(compression) * page[(size_t)places * (size_t)columns] : 0.0;
    load = load < columns - 1.0 ? load : columns - 1.0;
    j = load < columns - 2 ? (int)load : columns - 2;
    /* straight over the compression: so are contacts that are lost, and the mean over long waves */
    t = (load * load - (double)j * j) / (2.0 * j + 1.0);
    low = here[j] + t * (here[j + 1] - here[j]);
    high = next[j] + t * (next[j + 1] - next[j]);
    return low + s * (high - low);
}

double contact_height(const HeightTables *h, int ball, int race, double psi, double shaft, double own, double compression)
{
    const double *numbers = h->heights, *row = numbers + (size_t)(1 + ball) * (size_t)h->columns;
    const double on_race = psi - numbers[RING_SPEED + race] * shaft, on_ball = race == 0 ? own : own + half_turn;
    return row[RAISED] + table_height(h, (int)numbers[TABLE + race], on_race, compression)
           + table_height(h, (int)row[TABLE + race], on_ball, compression);
}
