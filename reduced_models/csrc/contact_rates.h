/* One contact and the balance of a ball in continuous time; every number has its change along one direction with it. */
#ifndef CONTACT_RATES_H
#define CONTACT_RATES_H

#include "bearing.h"

/* Row of the tables at a speed of the shaft, weight of the next, and the speed at which films are made. */
typedef struct {
    int row;
    Dual weight, rolling;
} LawSpeed;

LawSpeed law_speed(const Bearing *b, Dual omega);

/* Film without its dashpot [m], dashpot c tau [s], k_n that the film carries, own time [s], film G made. */
typedef struct {
    Dual film, dashpot, kn, tau, made;
} Held;

/* Of a contact at approach u with these states; `factor` is its film over that of the tables. */
Held held(const Race *race, const LawSpeed *at, Dual transit, Dual factor, Dual u, const Dual states[]);

/* Static force of a contact. */
Dual rest_force(const Race *race, const LawSpeed *at, Dual factor, Dual u);

/* Film of a contact whose approach has a rate; the force of a film, and its slope by the film. */
Dual squeezed(const Held *h, Dual rate);
Dual pushed(Dual kn, Dual film);
double push_slope(Dual kn, Dual film);

/* Time derivatives of the states of one film, `rate` that of its approach. */
void film_state_rates(const Race *race, const Held *h, Dual rate, const Dual states[], Dual rates[]);

/* w' of a ball without inertia, whose contacts balance; returns whether there is one. */
int balance(const Held *inner, const Held *outer, Dual rate, Dual centrifugal, Dual *own);

#endif
