/* Capacitance of a contact; see capacitance_table.h. */
#include "capacitance_table.h"

#include <math.h>

enum { MOST_DEGREES = 24 };

static Dual bounded(Dual x, double low, double high)
{
    return x.x < low ? number(low) : x.x > high ? number(high) : x;
}

static Dual one_more(Dual x)
{
    return chained(log1p(x.x), 1.0 / (1.0 + x.x), x);
}

Dual capacitance_of_contact(const CapacitanceTable *t, Dual load, Dual film, Dual angle)
{
    const Dual h = bounded(film, exp(t->first), exp(t->last));
    const Dual pressed = load.x > 0.0 ? power(bounded(load, 0.0, t->largest_load), number(2.0 / 3.0)) : number(0.0);
    const Dual dry = over(times(t->approach, pressed), h), most = over(number(t->approach * pow(t->largest_load, 2.0 / 3.0)), h);
    Dual degrees[3][MOST_DEGREES], sum = number(0.0);
    int i, n;
    degrees[0][1] = plus(times(2.0 / (t->last - t->first), plus(logarithm(h), -t->first)), -1.0);
    degrees[1][1] = plus(times(2.0, over(one_more(dry), one_more(most))), -1.0);
    degrees[2][1] = number(0.0);
    if (t->flattest > t->steepest) {
        const Dual cosine = chained(cos(angle.x), -sin(angle.x), angle);
        const double middle = 0.5 * (t->flattest + t->steepest), half = 0.5 * (t->flattest - t->steepest);
        degrees[2][1] = bounded(times(1.0 / half, plus(cosine, -middle)), -1.0, 1.0);
    }
    for (i = 0; i < 3; i++) {
        degrees[i][0] = number(1.0);
        for (n = 2; n < MOST_DEGREES; n++) {
            degrees[i][n] = sub(times(2.0, mul(degrees[i][1], degrees[i][n - 1])), degrees[i][n - 2]);
        }
    }
    for (n = 0; n < t->terms; n++) {
        const unsigned char *k = &t->power[3 * n];
        sum = add(sum, times(t->coefficient[n], mul(mul(degrees[0][k[0]], degrees[1][k[1]]), degrees[2][k[2]])));
    }
    return add(times(t->plate, over(pressed, h)), chained(exp(sum.x), exp(sum.x), sum));
}
