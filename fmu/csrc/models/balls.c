/* What balls of both kinds have in common; see balls.h. */
#include "balls.h"

#include <math.h>

#include "bearing_speeds.h"

static const double film_growth = 0.67; /* of the film with speed (Hamrock and Dowson 1977): between two speeds films add so */

double film_speed(double omega)
{
    return omega > table_speeds[0] ? omega : table_speeds[0];
}

SpeedRow speed_row(double omega)
{
    const double highest = table_speeds[SPEED_ROWS - 1], rolling = fmin(film_speed(omega), highest);
    SpeedRow at = {0, 0.0, 0.0};
#if SPEED_ROWS > 1
    double low, high;
    while (at.row < SPEED_ROWS - 2 && rolling > table_speeds[at.row + 1]) {
        at.row++;
    }
    low = pow(table_speeds[at.row], film_growth);
    high = pow(table_speeds[at.row + 1], film_growth);
    at.weight = (pow(rolling, film_growth) - low) / (high - low);
    at.slope = rolling == omega && omega > table_speeds[0] ? film_growth * pow(rolling, film_growth - 1.0) / (high - low) : 0.0;
#else
    (void)rolling;
    (void)film_growth;
#endif
    return at;
}

Differences differences(double h, double h_before)
{
    const double ratio = h_before > 0.0 ? h / h_before : 1.0, both = 1.0 + ratio, per = 1.0 / (1.0 + 2.0 * ratio);
    Differences d;
    d.gain = (1.0 + 2.0 * ratio) / (both * h);
    d.now = both * both * per;
    d.before = ratio * ratio * per;
    return d;
}

void place_ahead(const Ball *old, double h, double h_before, double start[PLACES])
{
    const double ratio = h_before > 0.0 ? h / h_before : 0.0;
    int j;
    for (j = 0; j < PLACES; j++) {
        start[j] = old->place[0][j] + ratio * (old->place[0][j] - old->place[1][j]);
    }
}
