/* Tables of a race from a static curve: reduced_models.bearing.race_table. */
#ifndef RACE_TABLE_H
#define RACE_TABLE_H

#include "film_law.h"
#include "race_contact.h"

/* Approaches [nodes] at the loads e^x and, between them, cubics of g and its slope at equal distances, [nodes - 1][CELLS][4] as in `Race`;
 * all in the units of the curve. */
void race_cells(const FilmLaw *law, int nodes, const double x[], double u[], double cells[]);

#endif
