/* The static curve of the film law: ln h_s over ln F, and its inverse. */
#ifndef FILM_CURVE_H
#define FILM_CURVE_H

#include "film_law.h"

/* Last index k with nodes[k] < x (or <= x if `at`), for x between the ends. */
int film_before(const double nodes[], int count, double x, int at);

/* Second derivatives of x = ln F_s and of g by the approach. */
void film_curvature(const Rest *rest, double *x_uu, double *g_uu);

#endif
