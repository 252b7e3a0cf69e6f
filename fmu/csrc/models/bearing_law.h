/* A ball bearing inside a rotor: the model of its own FMU, compiled by itself with its own config.h and kept by the rotor as
 * `size` numbers, so that a rotor may have bearings of different kinds. */
#ifndef BEARING_LAW_H
#define BEARING_LAW_H

/* Functions return NULL, or why there is no such number. `work` holds a step from its `begin` to its `accept`. */
typedef struct {
    int settled; /* steps of rest after which films follow the places of their balls */
    /* The bearing with these parameters, in the order of its FMU, its balls not yet placed. */
    const char *(*start)(double numbers[], const double parameters[]);
    /* Begins a step of length h, or of rest where it is 0, at whose end the shaft turns at omega. */
    void (*begin)(const double numbers[], double work[], double h, double omega);
    /* Force of the ring on the balls at its place q and velocity v of the end; its slopes by both there, row by row. */
    const char *(*press)(double work[], const double q[], const double v[], double force[]);
    void (*slopes)(const double work[], double stiffness[], double damping[]);
    /* Moves the bearing to the end of the step, with the ring where it was pressed last. */
    const char *(*accept)(double numbers[], double work[], const double q[]);
    void (*show)(const double numbers[], double outputs[]); /* in the order of its own FMU */
    double (*torque)(const double numbers[]);               /* that it takes from the shaft */
} BearingLaw;

#endif
