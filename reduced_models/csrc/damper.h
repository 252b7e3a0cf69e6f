/* A squeeze film damper: a journal that does not turn in a film of oil, and a spring that may centre it.
 *
 * With u = q/clearance, H = 1 - u . n and n = (cos, sin) of the angle around the journal, the film resists with
 *
 *     F = open int H^-3 (v . n) n  +  sealed int (H^-2 + H^-1)/2 (g . n) n,      g = v - (v . u') u'/(2 + u . u),  u' = (-u_y, u_x)
 *
 * the first of a short bearing, whose oil leaves at open ends, the second of a long one; over the half circle of positive
 * pressure, that which v or g points to, or, where oil carries tension, the whole. All integrals are closed (Sommerfeld's
 * substitution): docs/squeeze_film_dampers.md. */
#ifndef DAMPER_H
#define DAMPER_H

#include <stddef.h>

#include "support.h"

typedef struct {
    double clearance;    /* m */
    double open, sealed; /* N s/m: mu L^3 R/c^3 and 12 mu R^3 L/c^3, times their shares */
    double stiffness;    /* N/m of the spring */
    double cavitates;    /* 1: the half of positive pressure alone; 0: the whole film */
} Damper;

#define THINNEST 1e-2 /* of the clearance: a film that is thinner stays that of such a gap */

/* Forces on the damper, spring included, at displacements q and velocities v of its journal; their slopes row by row. */
void damper_press(const Damper *damper, const double q[2], const double v[2], double force[2], double stiffness[4],
                  double damping[4]);
/* The same for many motions, one after the other. */
void damper_forces(const Damper *damper, size_t count, const double q[], const double v[], double force[], double stiffness[],
                   double damping[]);
double damper_eccentricity(const Damper *damper, const double q[2]);

/* ---- as a support of a rotor ---- */

enum { DAMPER_OUTPUTS = 4 }; /* force on the rotor along x and y, eccentricity ratio, whether the film is thinner than `THINNEST` */

const char *damper_support_start(const void *own, const double parameters[], double state[]);
const char *damper_support_rest(const void *own, double state[], double work[], double omega, const double q[], const double v[],
                                double force[]);
void damper_support_begin(const void *own, const double state[], double work[], double h, double omega);
const char *damper_support_press(const void *own, const double state[], double work[], const double q[], const double v[],
                                 double force[]);
void damper_support_slopes(const void *own, const double work[], double stiffness[], double damping[]);
const char *damper_support_accept(const void *own, double state[], double work[]);
double damper_support_torque(const void *own, const double state[], const double outputs[]);
void damper_support_show(const void *own, const double state[], double outputs[], double states[], double indicators[]);
const char *damper_support_evaluate(const void *own, double state[], double work[], const SupportMotion *motion,
                                    const double states[], double outputs[], double indicators[], double force[], double rates[]);
void damper_support_along(const void *own, const double state[], double work[], const SupportMotion *motion, const double states[],
                          const SupportMotion *change, const double changes[], double outputs[], double force[], double rates[]);

/* Numbers and functions of a `Support`, in their order: two directions, no states, one indicator. */
enum { DAMPER_SIZE = 3, DAMPER_WORK = DAMPER_SIZE + 8 };
#define DAMPER_SUPPORT                                                                                                         \
    2, 0, 1, DAMPER_SIZE, DAMPER_WORK, damper_support_start, damper_support_rest, damper_support_begin, damper_support_press,  \
        damper_support_slopes, damper_support_accept, damper_support_torque, damper_support_show, damper_support_evaluate,     \
        damper_support_along

void damper_support(const Damper *damper, Support *support);
size_t damper_size(void);

#endif
