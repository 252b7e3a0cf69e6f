/* A Jeffcott rotor, alone or on its contacts: reduced_models.rotor. Equations in README.md. AXES, N_MOUNTS, BEARINGS and
 * the value references FIRST_... are generated, and so is rotor_data.h: rotor_normals and rotor_offsets of the mounts,
 * rotor_gravity, rotor_force on the disc, and rotor_rest, the positions at rest with the parameters of the export. */
#ifndef ROTOR_H
#define ROTOR_H

#include "model.h"
#include "rotor_data.h"

/* Degrees of freedom, in the order of JeffcottRotor.matrices: the disc along the axes that move, then the journal. */
enum { DISC = 0, JOURNAL = AXES, FREEDOMS = 2 * AXES };

/* States among the values: positions, velocities, angle of the unbalance, films. */
enum {
    POSITION = FIRST_STATE,
    VELOCITY = POSITION + FREEDOMS,
    ANGLE = VELOCITY + FREEDOMS,
    FILMS = ANGLE + 1,
    FILM_STATES = N_STATES - 2 * FREEDOMS - 1
};

/* Inputs: forces on journal and disc, and those of the contacts, where they are not inside; unbalance, speed and its rate. */
enum { JOURNAL_FORCE = 0, DISC_FORCE = AXES, MOUNT_FORCE = 2 * AXES, MOUNT_FORCES = VR_unbalance - MOUNT_FORCE };

/* Entries of the cache: the contacts are ready; a step has been made; what rounding took from the angle; accelerations,
 * applied forces and the contacts' force on the journal at the end of the last step; positions at rest; the contacts' own
 * numbers. */
enum {
    READY,
    MOVING,
    ANGLE_REST,
    ACCELERATION,
    APPLIED = ACCELERATION + FREEDOMS,
    CARRIED = APPLIED + FREEDOMS,
    REST = CARRIED + AXES,
    CONTACTS = REST + FREEDOMS
};

/* How far a contact is pressed with the journal there, and how fast at a velocity. */
double rotor_approach(int mount, const double journal[]);
double rotor_rate(int mount, const double velocity[]);

/* Shows approach and rate of all mounts in a state. */
const char *rotor_mounts(Model *model);

/* Adds what a force of a contact, in all bearings, takes from the journal. */
void rotor_carry(int mount, double force, double carried[]);

/* Force of the shaft on the disc along the axis k, at displacements d and velocities v of disc and journal. */
double rotor_shaft(const double value[], const double d[], const double v[], int k);

/* Weight and constant forces on the degrees of freedom. */
void rotor_loads(const double value[], double loads[]);

/* Forces applied to the degrees of freedom at an angle of the unbalance, with these inputs. */
void rotor_applied(const double value[], const double inputs[], double angle, double applied[]);

/* Accelerations in a state, under applied forces and the contacts' force on the journal. */
void rotor_accelerations(const double value[], const double applied[], const double carried[], double accelerations[]);

/* ---- the contacts: rotor_contacts.c, or rotor_free.c where they are not inside ---- */

const char *contacts_start(Model *model);

/* Moves the journal from q to where the contacts carry this load at rest, with their films as they are. */
const char *contacts_rest(Model *model, const double load[], double q[]);

/* Forces and all that is shown of the contacts in a state. */
const char *contacts_evaluate(Model *model);

/* Their force on the journal, as evaluated. */
void contacts_carried(const double value[], double carried[]);

/* Rates of the films; and changes along a direction: of forces and rates in `along`, of the force on the journal. */
const char *contacts_rates(Model *model);
void contacts_direction(const Model *model, const double seed[], double along[], double carried[]);

/* The end of a step: with the journal at q and the force F of the contacts on it, D (q - free) + weight F = 0, and the
 * journal's velocity is gain q + history. */
typedef struct {
    double D, weight, gain;
    double free[AXES], history[AXES];
    double load; /* what the imbalance is measured by */
} Balance;

/* Finds q, from a guess, and moves the contacts and what is shown of them there, from the start of the step, where the rest
 * of the model still is. */
const char *contacts_balance(Model *model, const Balance *balance, double h, double q[], double carried[]);

#endif
