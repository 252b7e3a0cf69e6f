/* Linear equations with a full matrix, row by row, by elimination with pivots. */
#ifndef LINEAR_EQUATIONS_H
#define LINEAR_EQUATIONS_H

/* Turns the matrix a, (n, n), into its factors, the diagonal inverted, and rows exchanged; returns whether it has an inverse. */
int factorise(int n, double a[], double pivot[]);

/* Turns the right side x into the solution. */
void substitute(int n, const double a[], const double pivot[], double x[]);

/* The inverse, row by row, of a matrix of these factors; `column` is room for n numbers. */
void invert(int n, const double a[], const double pivot[], double column[], double inverse[]);

/* Adds `factor` times the product of a matrix, (rows, columns), and x to y. */
void add_product(int rows, int columns, double factor, const double a[], const double x[], double y[]);

#endif
