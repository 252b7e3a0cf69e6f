/* Balls between two races under a given motion of the inner ring against the outer one, which may turn: in steps (ball_steps.c) and in continuous
 * time (ball_rates.c). A bearing is constant, all that changes is in memory of the caller: nothing is allocated, and many bearings
 * of different sizes stand side by side. Equations in README.md. */
#ifndef BEARING_H
#define BEARING_H

#include <stddef.h>

#include "capacitance_table.h"
#include "dual.h"
#include "race_contact.h"
#include "surface_heights.h"

enum { INNER_RACE, OUTER_RACE };
enum { IN_X, IN_Y, IN_Z, TILT_X, TILT_Y, MOST_DIRECTIONS }; /* of the ring; the most that a bearing has */
enum { OUTER_CONTROL, INNER_CONTROL, SHARED_CONTROL, HARRIS_CONTROL };
enum { TOO_FAST = 1, OVERLOADED = 2 };        /* bits of bearing_outside */

/* Grooves and balls: reduced_models.bearing.contact_angles. Lengths in m. */
typedef struct {
    double radial, axial;           /* inner groove centre from the outer one, the ring in the middle, with this: */
    double clearance;               /* 0 where the contact angle is given */
    double free_length[2];          /* of either spring from a groove centre to that of the ball */
    double circle, inner_radius;    /* of the inner groove centres; of the inner groove */
    double ball, pitch, mass;       /* diameters; of a ball [kg] */
    double gyroscopic;              /* factor of the gyroscopic moment: 1, or -1 of HARRIS_CONTROL */
    double spin_moment[2];          /* of friction, over the dry compression squared */
    double cosine;                  /* of the contact angle that the tables are for */
    double ring_speed[2], sense;    /* of both rings about the axis, over their speed against each other; 1 or -1, the sign of that */
} Grooves;

/* What a ball is counted from in continuous time [m]: its place, and how far the inner groove centre is there from its free place; its
 * damping across its outer contact [N s/m]. */
typedef struct {
    double place[2], moved[2], across;
} BallOrigin;

/* Films over load, for outputs alone: logarithms of central and smallest film and of the moment, even in that of the load. */
typedef struct {
    int nodes; /* 0: dry */
    double first[2], step[2], rolling_radius[2];
    const double *table; /* [2][speeds][3][nodes] */
    double roughness;    /* 0: not given */
} FilmTables;

typedef struct {
    int directions, direction[MOST_DIRECTIONS]; /* of the ring that move, of IN_X ... TILT_Y; the others stay 0 */
    int balls, lags, speeds, filters;      /* lags: of the chain of any film; filters: of the losses of rings and fits */
    int control;
    double inertia;                        /* of a ball towards the races [kg]; 0: it follows them */
    const double *speed;                   /* [speeds] of the shaft, for which tables are made [rad/s], increasing */
    const double *filter_gains, *filter_rates;
    Grooves grooves;
    Race race[2];
    FilmTables films;
    CapacitanceTable capacitance[2];
    double most_speed, most_load[2];       /* of the tables */
    double largest_place, largest_tilt;    /* of a ring in its bearing */
    const HeightTables *heights;           /* of features; NULL: the state has no `BallSurface` */
    const BallOrigin *origin;              /* [balls] */
    int cage_held;                         /* whether the cage stands still while the shaft turns */
} Bearing;

typedef struct {
    double clearance, offset; /* m: radial, 0 where the contact angle is given; added to z */
    double cage_angle;        /* of the first ball at the start */
    double film;              /* 1: with oil films, 0: dry */
} BearingSettings;

/* The state of a bearing in steps is this, balls, their films, filters of losses: doubles alone, bearing_state_size of them. */
typedef struct {
    BearingSettings settings;
    double h;       /* length of the last step; 0: at rest so far */
    double steps;   /* made */
    double omega;   /* of the shaft, or of one ring against the other, at its end [rad/s] */
    double angle;   /* of the first ball */
    double cage[2]; /* speed of the cage over that of the shaft, at the ends of the last two steps */
} BearingHead;

/* A ball at the end of a step and of the one before. */
typedef struct {
    double place[2][2];      /* of its centre from the outer groove centre, outward and along the shaft */
    double rate[2][2];
    double factor[2][2];     /* [race]: film over that of the tables */
    double speed_sum[2][2];  /* [race]: sum of both surface speeds over the speed of the shaft [m] */
    double lift[2];          /* [race]: see Thickness */
    double force[2];         /* [race] N */
    double film[2];          /* [race]: see RaceForce */
    double cosine[2], sine[2]; /* [race] of the contact angle */
    double inertia[5][4];    /* slopes of `BallForces` without contacts, by the place of the ball and of the inner groove centre */
} Ball;

/* What changes at the contacts of a ball, of a bearing with `heights`: angle of the ball about its own axis and its speed over that
 * of the shaft, heights at the ends of the last two steps, a full film in place of the element of a contact, and sums over the turns
 * of the shaft of force^3 and force^(10/3), as rating life needs them. At rest the newest heights are those that it rests on. */
typedef struct {
    double angle, rotation;
    double height[2][2];   /* [race] m */
    FullFilm full[2];      /* [race] */
    double largest[2];     /* [race] force that it has had at the end of a step [N] */
    double fatigue[2][2];  /* [race] integrals of force^3 and force^(10/3) over the angle of the shaft since it was at rest */
} BallSurface;

enum {
    HEAD_NUMBERS = sizeof(BearingHead) / sizeof(double),
    BALL_NUMBERS = sizeof(Ball) / sizeof(double),
    FILM_NUMBERS = sizeof(FilmState) / sizeof(double), /* and the chain */
    SURFACE_NUMBERS = sizeof(BallSurface) / sizeof(double)
};

size_t bearing_state_size(const Bearing *b); /* in doubles */
size_t bearing_work_size(const Bearing *b);

/* Bytes of a bearing, its grooves, a race and tables of heights; of the head of a state, a ball, a film without its chain and a
 * surface; of the head of a step and a ball in it; of a ball at rest; of an origin, a motion and outputs of a ball: for those who have these
 * structures in another language. */
void bearing_sizes(size_t sizes[]);

/* Where the films of a ball stand in a state, and rows [directions] of the seat: force of the ring on the balls with the losses of
 * rings and fits, without them, and what the filters of the losses have of it. */
static inline size_t film_place(const Bearing *b, int k, int race)
{
    const size_t balls = (size_t)b->balls, ahead = (size_t)(2 * k + race);
    return HEAD_NUMBERS + balls * BALL_NUMBERS + ahead * (FILM_NUMBERS + (size_t)b->lags);
}

static inline size_t seat_place(const Bearing *b, int row)
{
    return film_place(b, b->balls, 0) + (size_t)row * (size_t)b->directions;
}

/* Where the angle of the shaft is, with the surfaces of all balls behind it, of a bearing with `heights`. */
static inline size_t shaft_place(const Bearing *b)
{
    return seat_place(b, 2 + b->filters);
}

static inline const BallSurface *surface_of(const Bearing *b, const double state[], int k)
{
    return (const BallSurface *)(const void *)(state + shaft_place(b) + 1) + k;
}

static inline const BearingHead *head_of(const double state[])
{
    return (const BearingHead *)(const void *)state;
}

static inline const Ball *ball_of(const double state[], int k)
{
    return (const Ball *)(const void *)(state + HEAD_NUMBERS) + k;
}

static inline const FilmState *film_of(const Bearing *b, const double state[], int k, int race)
{
    return (const FilmState *)(const void *)(state + film_place(b, k, race));
}

/* Whether a bearing has films, and these are not switched off. */
static inline int is_wet(const Bearing *b, const double state[])
{
    return b->race[INNER_RACE].nodes > 0 && head_of(state)->settings.film != 0.0;
}

/* ---- steps ---- Functions return NULL, or why there is no such number. q, v and forces have the directions of the bearing, in their
 * order: place of the ring (`offset` is added to it) and its velocity. */

/* A bearing whose balls have not been placed; refused where settings make no sense. */
const char *bearing_start(const Bearing *b, const BearingSettings *settings, double state[]);

/* Whether a ring can be there, and a shaft turn so. */
const char *bearing_check(const Bearing *b, const double q[], double omega);
const char *bearing_within(const Bearing *b, const double q[]); /* for a shaft that may turn backward too */

/* Begins a step of length h, or of rest where it is 0, at whose end the shaft turns at omega. Balances all balls with the ring at q,
 * moving at v, as often as it takes to find the end of the step (at rest from where they were balanced last); gives the slopes of the force by both there, row by row; and moves
 * the bearing to where it was pressed last. `work` holds the step from its begin to its accept. */
void bearing_begin(const Bearing *b, const double state[], double work[], double h, double omega);
const char *bearing_press(const Bearing *b, const double state[], double work[], const double q[], const double v[], double force[]);
void bearing_slopes(const Bearing *b, const double work[], double stiffness[], double damping[]);
void bearing_accept(const Bearing *b, double state[], double work[]);

/* Steps of length h along a motion, (steps, directions) at their ends: forces (steps, directions), loads of all balls (steps, balls,
 * 2) and slopes (steps, directions, directions), unless NULL. Returns how many were made: a ball finds no balance in the next. */
int bearing_drive(const Bearing *b, double state[], double work[], double h, double omega, int steps, const double q[],
                  const double v[], double force[], double loads[], double stiffness[], double damping[]);

/* Puts the ring, balls and films at rest, the cage at the angle of the start or at another one; `work` has the slopes there. */
const char *bearing_rest(const Bearing *b, double state[], double work[], double omega, const double q[], double force[]);
const char *bearing_rest_at(const Bearing *b, double state[], double work[], double omega, double angle, const double q[],
                            double force[]);

/* A ball at rest: contact angles [rad], forces [N] and approaches [m] of its contacts, compressions of dry ones under these forces, as if
 * no film had let go [m], slopes of the forces by the approaches [N/m], films over those of the tables, sums of both surface speeds over the speed of the shaft [m]; its speed about the shaft, and seen from the cage
 * that about its own axis, both over that of the shaft; the angle of this axis from that of the shaft. */
typedef struct {
    double angle[2], load[2], approach[2], compression[2], slope[2], factor[2], speed_sum[2], orbit, rotation, axis, share;
} BallAtRest;

/* All balls where they were pressed last, at rest. `geometric`, [balls][5][4], gets slopes of the forces on a ball (r, z), of that of the
 * ring (r, z) and of its moment, by the places of the ball and of the inner groove centre, (r, z) each, without those by approaches. */
void bearing_describe(const Bearing *b, const double state[], double work[], BallAtRest balls[], double geometric[]);

/* ---- outputs ---- */

/* A ball, along a direction of inputs and states too. */
typedef struct {
    Dual load[2], approach[2], factor[2], speed_sum[2], angle[2]; /* [race] */
    double film[2];                                  /* [race]: see RaceForce */
} BallOutputs;

/* What the balls have at the end of the last step. */
void bearing_balls(const Bearing *b, const double state[], BallOutputs balls[]);

enum { MOST_OUTPUTS = MOST_DIRECTIONS + 9, MOST_BALL_OUTPUTS = 8 };

/* The outputs of the FMU of a bearing and how many they are: forces on the ring, largest load of a ball at either race; of a bearing
 * with oil the smallest film, the rolling torque and, if they are known, the smallest lambda and the capacitance between the rings; whether tables are left, by
 * the speed, by a load. `force` is that on the balls. */
int bearing_outputs(const Bearing *b, int wet, Dual omega, const Dual force[], const BallOutputs balls[], Dual outputs[]);
int bearing_outputs_of_step(const Bearing *b, const double state[], BallOutputs balls[], double outputs[]);

/* Those of a ball, its inner race first: load, with oil central and smallest film, under contact angles that vary the angle. */
int ball_outputs(const Bearing *b, int wet, Dual omega, const BallOutputs *ball, Dual outputs[]);

/* Torque that the films take from the shaft, in such outputs. */
double bearing_torque(const Bearing *b, const double outputs[]);

/* ---- continuous time ---- Both contacts of a ball have the force
 *
 *     F = share k_n (g(u) + c tau u' + sum g_j x_j)_+^(3/2)
 *
 * with g_j/G for the states of the chain (film_law.h). A ball without inertia has its rate b' from the balance of both contact forces
 * along their normals, centrifugal force and friction that turns its axis: the minimum of a convex function, for both forces rise with
 * their rates. Along the outer contact that rate lies above the one at which this contact lets go, and below the one at which the inner
 * contact does or the outer one carries all other forces. A ball with inertia m has b' as a state. Between rings that are held along the
 * shaft and cannot tilt a ball moves along its outer contact alone. Films follow the angles and speeds of their ball at once; the cage turns
 * at the mean speed of the balls by their loads, as in steps. Places are counted from an origin, so that small changes keep their digits. */

typedef struct {
    Dual q[MOST_DIRECTIONS], v[MOST_DIRECTIONS], omega; /* of the inner ring, in the order of the bearing's directions; of the shaft */
} RingMotion;

/* The states: angle of the cage; of every ball its place from its origin (along the line from the outer groove centre to there, and
 * across it where the contact angle varies), with inertia its rate likewise, of a dry ball without inertia nothing, and the films of
 * its inner and outer contact: inlet, fast, chain; the filters of the losses. */
enum { CAGE_ANGLE, FIRST_OF_BALLS };
int bearing_states(const Bearing *b); /* how many */
int ball_states(const Bearing *b);    /* those of a ball */

/* The states of a bearing at rest or at the end of a step. */
void bearing_states_of_step(const Bearing *b, const double state[], double states[]);

/* Rates of the states, force on the balls and what these carry. `starts`: states of places and filters follow from the inputs, and
 * get their changes along the direction here. Dry balls without inertia are where they are at rest, and have no rates; `state` is moved
 * there. After a step others move at its rates: the rate at which forces balance is that of continuous time alone, and errors
 * of a step are many times as large in it. */
const char *bearing_rates(const Bearing *b, double state[], double work[], const RingMotion *ring, int starts, Dual states[],
                          Dual rates[], Dual force[], BallOutputs balls[]);

#endif
