/* A contact law inside a rotor. It is a model of its own, compiled by itself with its own config.h and kept by the rotor as
 * `size` numbers, so that one rotor may sit on contacts of different kinds. */
#ifndef CONTACT_LAW_H
#define CONTACT_LAW_H

/* What a contact gives at an instant, or at the end of a step: then the tangents are through its memory too. */
typedef struct {
    double force, stiffness, damping, indicator;
    int outside; /* its validity box */
} ContactForce;

/* Approach and rate at both ends of a step. */
typedef struct {
    double start_approach, start_rate, end_approach, end_rate;
} ContactMotion;

/* Functions return NULL, or why there is no such number; then they leave everything as it was. */
typedef struct {
    int size, states; /* numbers it is kept in, and how many states its film has */
    const char *(*start)(double numbers[]);
    const char *(*evaluate)(double numbers[], const double film[], double approach, double rate, ContactForce *found);
    const char *(*step)(double numbers[], const double before[], double after[], const ContactMotion *motion, double h,
                        ContactForce *found);
    /* d(film)/dt, of what was evaluated last; and changes of force and rates along a direction. */
    const char *(*rates)(double numbers[], double rates[]);
    double (*direction)(const double numbers[], double approach, double rate, const double film[], double rates[]);
} ContactLaw;

#endif
