/* Force of one ball on one race at the end of a time step. The equations are those of reduced_models.elements.film_law without
 * saturation of the inlet. The filters are then linear in the own rate e at the end of the step and the travel t of the approach:
 * `race_prepare` reduces them, once a step, to two times three numbers for each of two nodes of the gains,
 *
 *     m = m_0 + m_e e + m_t t + (q_0 + q_e e + q_t t)/G,
 *
 * the second for what the chain holds of earlier films and of the middle of the step, with G, the film that the inlet makes, at the
 * load of the end. So `race_force`, which every iteration calls, evaluates the curve g(u) and a few products. The length of the step
 * in own time, and G of the film made within it, have to be known before its end: they are taken at the middle, extrapolated from
 * the start. Elements take the mean of both ends. Both are of second order. */
#ifndef RACE_CONTACT_H
#define RACE_CONTACT_H

/* Law of a race, in N and m; a row of its tables for each speed of the shaft. Without nodes it is a dry contact. */
typedef struct {
    double kn, log_kn, contact_length_factor; /* N/m^1.5; its logarithm; 2a over sqrt(g) [m^0.5] */
    double lag_rate, inlet_rate, fast_rate;
    double cutoff_gap;   /* m, from half of which a film lets go, HUGE_VAL for never */
    int lags;            /* of the chain */
    int nodes;
    const int *first;    /* [rows * (nodes - 1) + 1] first coefficient of every interval of `curve` */
    const double *x;     /* [nodes] ln F, increasing */
    const double *u;     /* [rows][nodes] approach there */
    const double *curve; /* g between, powers of s = -1 to 1; or, in Python: */
    const double *cells; /* [rows][nodes - 1][CELLS][4] cubics between approaches at equal distances; NULL: `curve` */
    const double *gains; /* [rows][nodes][DIRECT_GAINS + lags]: viscous, inlet, fast, chain */
    const double *made;  /* [rows][nodes] film that a unit of the inlet's state lets into the chain */
} Race;

enum { DIRECT_GAINS = 3, CELLS = 128 };

/* Row of the tables, and weight of the next with its slope by the speed of the shaft. */
typedef struct {
    int row;
    double weight, slope;
} SpeedRow;

/* A film that is not that of the tables: its thickness over that, and a guess of v - u, see race_gap. */
typedef struct {
    double factor, lift;
} Thickness;

/* What a contact remembers from step to step: doubles alone, `lags` of them at the end. */
typedef struct {
    double approach, rate, own, inlet, fast, entered;
    double interval; /* of the curve at the approach */
    double chain[];
} FilmState;

/* The filters of a step, worked out before its end is known: sums of 1, the own rate e and the travel t at the end. */
typedef struct {
    double s[3], y[3], middle[3], at[3], next[3], carried[3], next_carried[3];
    double per_x, made[2]; /* of the interval of loads that has been weighed */
    int interval, weighed; /* of the curve used last; whose gains have been weighed, -1 for none */
    double chain[];        /* [3][lags] what each lag has of the past, of the film at the end, of its hump */
} StepFilters;

/* The force and its slopes, `by_film` that by the factor of the thickness; `film` is the compression whose power 3/2 it is, below 0
 * where the surfaces have parted; `lift` as in Thickness. */
typedef struct {
    double force, stiffness, damping, by_film, film, lift;
} RaceForce;

/* A contact in a step: its law, speeds and filters. */
typedef struct {
    const Race *race;
    SpeedRow at;
    double transit;          /* 2a/u_sum over sqrt(g) [s/m^0.5] */
    const Thickness *film;   /* NULL: that of the tables */
    const FilmState *before; /* at the start */
    StepFilters *filters;
} RaceStep;

/* Curve of one speed, dry compression g at an approach and its slope; k is where to begin to look for the interval of u, and
 * that found. */
double race_curve(const Race *race, int row, double u, int *k, double *slope);

/* Share of its force that a film carries at an approach, and its slope. */
double race_cutoff(const Race *race, double u, double *slope);

/* Dry compression g at an approach, its slope, and v - u of a film that is not that of the tables; k as above. */
double race_gap(const Race *race, SpeedRow at, const Thickness *film, double u, int *k, double *slope, double *lift);

/* Works out the filters of a step of length dt; or none of them, for the static force. */
void race_prepare(const RaceStep *contact, double dt);
void race_at_rest(const RaceStep *contact);

/* The force at approach u and rate v of the end of the step, and its slopes. */
RaceForce race_force(const RaceStep *contact, double u, double v);

/* Moves what the contact remembers, which may be `before`, to the end of the step; returns v - u, a guess for the next one. */
double race_accept(const RaceStep *contact, double u, double v, FilmState *after);

#endif
