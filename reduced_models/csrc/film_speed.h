/* Film laws over the speed of the surfaces, and the speed at which the film in a contact was made while that changes:
 * reduced_models.elements.film_speed. Names and order of the arithmetic are those of film_speed.py. */
#ifndef FILM_SPEED_H
#define FILM_SPEED_H

#include "film_law.h"

/* Laws at increasing speeds, over that of the reference; nodes, rows of gains and lags of all are alike. */
typedef struct {
    int speeds; /* at least 2 */
    const double *speed;
    const FilmLaw *law;
} FilmSpeeds;

/* Speeds of the surfaces that the film in the contact was made at. `pace` is the mean of the last step, in whose time the rate of a
 * state is; `film` that of the film; `slowed` pace over film, at most 1. Then filters of the speed to the power of FILM_GROWTH: present,
 * inlet, fast, and the chain. */
enum { NOW_SPEED, SLOW_INLET, QUICK, AGES, MOST_AGES = AGES + MOST_LAGS };
typedef struct {
    double speed, pace, film, slowed;
    double ages[MOST_AGES];
} SpeedHistory;

/* Numbers of the tables of a law between those of the tables. */
#define LAW_ROOM(nodes, rows, lags) (3 * (nodes) + (rows) * (DIRECT + (lags)))

/* Surfaces that have always been at a speed. */
SpeedHistory speed_constant(const FilmSpeeds *range, double speed);

/* The law of the film of a history, with its tables in `room`. */
FilmLaw speed_law(const FilmSpeeds *range, const SpeedHistory *history, double room[]);

/* Begins a step of `length` units of time at the reference speed, at whose end surfaces have a speed: brings `state`, of film_step, and
 * the history there, gives its law in `room`, and the step in the own time of its mean speed. */
FilmLaw speed_begin(const FilmSpeeds *range, double speed, double length, double state[], SpeedHistory *history, double room[],
                    double *own);

#endif
