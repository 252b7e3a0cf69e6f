/* A support inside a rotor: a ball bearing, a contact, or a squeeze film damper. Its state and the work of a step are plain numbers that the rotor keeps.
 *
 * `own` is the support itself, constant. Motions are those of its directions: displacements of an inner ring, or the approach of
 * a contact; forces are those of the rotor on it, in the same directions. Functions return NULL, or why there is no such number;
 * they have changed nothing but `work` then. */
#ifndef SUPPORT_H
#define SUPPORT_H

#include <stddef.h>

/* Displacements and velocities of a support, and the speed of the shaft. */
typedef struct {
    const double *q, *v;
    double omega;
} SupportMotion;

typedef struct {
    const void *own;
    int motions, states, indicators; /* directions; states of continuous time; what changes sign where surfaces meet or part */
    size_t size, work;   /* numbers of its state, and of a step */
    /* With these parameters, its balls and films not yet placed. */
    const char *(*start)(const void *own, const double parameters[], double state[]);
    /* At rest at q, with the shaft turning at omega; a contact already moves at v. Slopes of `work` are those of rest. */
    const char *(*rest)(const void *own, double state[], double work[], double omega, const double q[], const double v[],
                        double force[]);
    /* A step of length h from `state`, at whose end the shaft turns at omega; forces with the support there at q, moving at v, as
     * often as they are needed; slopes of the last ones by q and v, row by row; then the state goes there. */
    void (*begin)(const void *own, const double state[], double work[], double h, double omega);
    const char *(*press)(const void *own, const double state[], double work[], const double q[], const double v[], double force[]);
    void (*slopes)(const void *own, const double work[], double stiffness[], double damping[]);
    const char *(*accept)(const void *own, double state[], double work[]);
    /* That it takes from the shaft: with these outputs, or (NULL) at the end of the last step. */
    double (*torque)(const void *own, const double state[], const double outputs[]);
    /* Outputs and states of continuous time at the end of a step, as variables of its own FMU; its indicators, unless NULL. */
    void (*show)(const void *own, const double state[], double outputs[], double states[], double indicators[]);
    /* The same in a motion, with these states of continuous time; forces, and rates of the states. */
    const char *(*evaluate)(const void *own, double state[], double work[], const SupportMotion *motion, const double states[],
                            double outputs[], double indicators[], double force[], double rates[]);
    /* Changes of all these along a direction, where it was evaluated last. */
    void (*along)(const void *own, const double state[], double work[], const SupportMotion *motion, const double states[],
                  const SupportMotion *change, const double changes[], double outputs[], double force[], double rates[]);
} Support;

#endif
