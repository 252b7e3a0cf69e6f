/* Capacitance of contacts with a race, for outputs alone: plate load^(2/3)/film, and what is outside the contact ellipse: the power of e
 * that is the sum of coefficients times polynomials of Chebyshev in the logarithms of film and approach and the cosine of the contact
 * angle. FMUs without this output have no such function. */
#ifndef CAPACITANCE_TABLE_H
#define CAPACITANCE_TABLE_H

#include "dual.h"

typedef struct CapacitanceTable CapacitanceTable;

/* Lengths in m; approach and plate are those of 1 N. */
struct CapacitanceTable {
    Dual (*of)(const CapacitanceTable *t, Dual load, Dual film, Dual angle); /* `capacitance_of_contact`; NULL: no such output */
    int terms;
    double first, last;         /* logarithms of films */
    double approach, plate, largest_load;
    double flattest, steepest;  /* cosines at 1 and -1 */
    const unsigned char *power; /* [terms][3] degrees, below 24 */
    const double *coefficient;
};

/* In F, of a load [N] on the contact, its film [m] and its angle [rad]. */
Dual capacitance_of_contact(const CapacitanceTable *t, Dual load, Dual film, Dual angle);

#endif
