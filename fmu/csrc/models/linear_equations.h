/* Linear equations with a full matrix, row by row, by elimination with pivots. */
#ifndef LINEAR_EQUATIONS_H
#define LINEAR_EQUATIONS_H

/* Turns the matrix a, (n, n), into its factors; returns whether it has an inverse. */
int factorise(int n, double a[], int pivot[]);

/* Turns the right side x into the solution. */
void substitute(int n, const double a[], const int pivot[], double x[]);

#endif
