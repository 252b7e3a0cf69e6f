/* The static curve of the film law; see film_curve.h. Names and order of the arithmetic are those of film_law.py. */
#include "film_curve.h"

#include <math.h>
#include <stddef.h>

#include "film_curve_data.h"

static const double nothing = -400.0; /* ln of a force that is none */

int film_before(const double nodes[], int count, double x, int at)
{
    int low = 0, high = count - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (nodes[middle] < x || (at && nodes[middle] <= x)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Film h_s, dh_s/dx and d2h_s/dx2 at x = ln F: Hermite between the nodes, straight beyond them; x is most likely behind
 * node `guess`. */
static double film(double x, int guess, double *slope, double *curvature)
{
    const int n = CURVE_NODES;
    double w, t, d, a, b, y, dy, ddy, h;
    int k;
    if (x <= curve_x[0] || !(x < curve_x[n - 1])) {
        k = x <= curve_x[0] ? 0 : n - 1;
        h = exp(curve_y[k] + curve_slope[k] * (x - curve_x[k]));
        *slope = h * curve_slope[k];
        *curvature = *slope * curve_slope[k];
        return h;
    }
    k = curve_x[guess] < x && x <= curve_x[guess + 1] ? guess : film_before(curve_x, n, x, 0);
    w = curve_x[k + 1] - curve_x[k];
    t = (x - curve_x[k]) / w;
    d = curve_y[k + 1] - curve_y[k];
    a = w * curve_slope[k] - d;
    b = d - w * curve_slope[k + 1];
    y = curve_y[k] + t * d + t * (1.0 - t) * ((1.0 - t) * a + t * b);
    dy = d + (1.0 - 2.0 * t) * ((1.0 - t) * a + t * b) + t * (1.0 - t) * (b - a);
    ddy = -2.0 * ((1.0 - t) * a + t * b) + 2.0 * (1.0 - 2.0 * t) * (b - a);
    h = exp(y);
    *slope = h * dy / w;
    *curvature = h * (dy * dy + ddy) / (w * w);
    return h;
}

void film_static(double u, const Rest *near, Rest *rest)
{
    const int n = CURVE_NODES;
    double low = -HUGE_VAL, high = HUGE_VAL, x, g, h, dh, ddh, du, r, new_x, step;
    int i, k = 0;
    if (u < curve_u[0]) {
        high = curve_x[0];
        x = high;
        if (-u > exp(curve_y[0])) { /* F hardly matters there: h_s is nearly -u */
            x += (log(-u) - curve_y[0]) / curve_slope[0];
            if (x < nothing) {
                rest->u = u;
                rest->x = nothing;
                rest->g = exp(2.0 / 3.0 * nothing);
                rest->g_u = 0.0;
                return;
            }
        }
    } else if (!(u < curve_u[n - 1])) {
        low = curve_x[n - 1];
        x = low;
    } else {
        k = film_before(curve_u, n, u, 1);
        low = curve_x[k];
        high = curve_x[k + 1];
        x = low + (high - low) * (u - curve_u[k]) / (curve_u[k + 1] - curve_u[k]);
    }
    if (near != NULL && near->g_u > 0.0) { /* along the slope of the curve from there, if that is not far */
        step = 1.5 * near->g_u / near->g * (u - near->u);
        new_x = near->x + step;
        x = fabs(step) <= 1.0 && low <= new_x && new_x <= high ? new_x : x;
    }
    for (i = 0; i < 100; i++) {
        g = exp(2.0 / 3.0 * x);
        h = film(x, k, &dh, &ddh);
        du = 2.0 / 3.0 * g - dh;
        r = g - h - u;
        if (r > 0.0) {
            high = high < x ? high : x;
        } else {
            low = low > x ? low : x;
        }
        step = r / du;
        new_x = x - (step < -2.0 ? -2.0 : step > 2.0 ? 2.0 : step);
        if (!(low <= new_x && new_x <= high)) {
            new_x = 0.5 * (low + high);
        }
        step = new_x - x;
        x = new_x;
        if (fabs(step) <= 1e-9) {
            break;
        }
    }
    /* The last step squared is below rounding: its first two orders are enough. After a hundred the approach is beyond
     * all numbers of use, and the force will be refused. */
    r = 2.0 / 3.0 * step;
    g = i < 100 ? g * (1.0 + r * (1.0 + 0.5 * r)) : HUGE_VAL;
    dh += ddh * step;
    rest->u = u;
    rest->x = x;
    rest->g = g;
    rest->g_u = i < 100 ? 2.0 / 3.0 * g / (2.0 / 3.0 * g - dh) : 1.0;
}

void film_curvature(const Rest *rest, double *x_uu, double *g_uu)
{
    double dh, ddh, du, ddu, x_u;
    if (rest->g_u == 0.0) {
        *x_uu = *g_uu = 0.0;
        return;
    }
    film(rest->x, 0, &dh, &ddh);
    du = 2.0 / 3.0 * rest->g - dh;
    ddu = 4.0 / 9.0 * rest->g - ddh;
    x_u = 1.0 / du;
    *x_uu = -ddu * x_u * x_u * x_u;
    *g_uu = 2.0 / 3.0 * rest->g * (2.0 / 3.0 * x_u * x_u + *x_uu);
}
