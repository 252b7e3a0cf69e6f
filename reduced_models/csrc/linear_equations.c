/* Linear equations; see linear_equations.h. */
#include "linear_equations.h"

#include <math.h>

static void exchange(double *a, double *b)
{
    const double kept = *a;
    *a = *b;
    *b = kept;
}

int factorise(int n, double a[], double pivot[])
{
    int i, j, k;
    for (k = 0; k < n; k++) {
        int row = k;
        for (i = k + 1; i < n; i++) {
            if (fabs(a[i * n + k]) > fabs(a[row * n + k])) {
                row = i;
            }
        }
        if (!(fabs(a[row * n + k]) > 0.0)) {
            return 0;
        }
        pivot[k] = row;
        for (j = 0; j < n && row != k; j++) {
            exchange(&a[k * n + j], &a[row * n + j]);
        }
        a[k * n + k] = 1.0 / a[k * n + k];
        for (i = k + 1; i < n; i++) {
            const double factor = a[i * n + k] * a[k * n + k];
            a[i * n + k] = factor;
            for (j = k + 1; j < n && factor != 0.0; j++) {
                a[i * n + j] -= factor * a[k * n + j];
            }
        }
    }
    return 1;
}

void substitute(int n, const double a[], const double pivot[], double x[])
{
    int i, j;
    for (i = 0; i < n; i++) {
        exchange(&x[i], &x[(int)pivot[i]]);
    }
    for (i = 0; i < n; i++) {
        for (j = 0; j < i; j++) {
            x[i] -= a[i * n + j] * x[j];
        }
    }
    for (i = n - 1; i >= 0; i--) {
        for (j = i + 1; j < n; j++) {
            x[i] -= a[i * n + j] * x[j];
        }
        x[i] *= a[i * n + i];
    }
}

void invert(int n, const double a[], const double pivot[], double column[], double inverse[])
{
    int i, k;
    for (k = 0; k < n; k++) {
        for (i = 0; i < n; i++) {
            column[i] = i == k ? 1.0 : 0.0;
        }
        substitute(n, a, pivot, column);
        for (i = 0; i < n; i++) {
            inverse[i * n + k] = column[i];
        }
    }
}

void add_product(int rows, int columns, double factor, const double a[], const double x[], double y[])
{
    const int n = columns;
    int i, k;
    for (i = 0; i + 4 <= rows; i += 4, a += 4 * n) { /* four sums, which do not wait for each other */
        double first = 0.0, second = 0.0, third = 0.0, fourth = 0.0;
        for (k = 0; k < n; k++) {
            first += a[k] * x[k];
            second += a[n + k] * x[k];
            third += a[2 * n + k] * x[k];
            fourth += a[3 * n + k] * x[k];
        }
        y[i] += factor * first;
        y[i + 1] += factor * second;
        y[i + 2] += factor * third;
        y[i + 3] += factor * fourth;
    }
    for (; i < rows; i++, a += n) {
        double sum = 0.0;
        for (k = 0; k < n; k++) {
            sum += a[k] * x[k];
        }
        y[i] += factor * sum;
    }
}
