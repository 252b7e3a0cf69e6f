/* A ball bearing as a support of a rotor: its numbers are those of bearing.h. */
#ifndef BEARING_SUPPORT_H
#define BEARING_SUPPORT_H

#include "bearing.h"
#include "support.h"

/* `parameters` are clearance, offset, angle of the cage at the start and film; one that a bearing does not have is 0. */
const char *bearing_support_start(const void *own, const double parameters[], double state[]);
const char *bearing_support_rest(const void *own, double state[], double work[], double omega, const double q[], const double v[],
                                 double force[]);
void bearing_support_begin(const void *own, const double state[], double work[], double h, double omega);
const char *bearing_support_press(const void *own, const double state[], double work[], const double q[], const double v[],
                                  double force[]);
void bearing_support_slopes(const void *own, const double work[], double stiffness[], double damping[]);
const char *bearing_support_accept(const void *own, double state[], double work[]);
double bearing_support_torque(const void *own, const double state[], const double outputs[]);
void bearing_support_show(const void *own, const double state[], double outputs[], double states[], double indicators[]);
const char *bearing_support_evaluate(const void *own, double state[], double work[], const SupportMotion *motion,
                                     const double states[], double outputs[], double indicators[], double force[],
                                     double rates[]);
void bearing_support_along(const void *own, const double state[], double work[], const SupportMotion *motion,
                           const double states[], const SupportMotion *change, const double changes[], double outputs[],
                           double force[], double rates[]);

/* The functions of a `Support`, in their order. */
#define BEARING_SUPPORT                                                                                                        \
    bearing_support_start, bearing_support_rest, bearing_support_begin, bearing_support_press, bearing_support_slopes,         \
        bearing_support_accept, bearing_support_torque, bearing_support_show, bearing_support_evaluate, bearing_support_along

/* The support of a bearing, for steps alone: without states of continuous time. */
void bearing_support(const Bearing *bearing, Support *support);

#endif
