/* Groove centres, contact angles and rolling of a ball between two races: reduced_models.bearing.contact_angles. In the plane
 * through a ball and the axis of the bearing, r outward and z along the shaft, the outer groove centre is the origin, that of
 * the inner groove is at c and the ball at b: two springs in series, l_i = |c - b| and l_o = |b|. */
#ifndef ROLLING_H
#define ROLLING_H

#include "bearing.h"

/* What is written with derivatives and used without them costs nothing where it is compiled in place. */
#ifdef __GNUC__
#define IN_PLACE static inline __attribute__((always_inline))
#else
#define IN_PLACE static inline
#endif

/* Ball between two races, seen from the outer ring. Angular speeds over that of the rings against each other, entrainment speeds over it
 * [m]. */
typedef struct {
    Dual l[2], cosine[2], sine[2]; /* inner and outer spring */
    Dual axis, drive;              /* tangent of the angle of the axis of the ball; sum of the cosines from it to both contacts, over their radii */
    Dual orbit, spin, share, speed_sum[2]; /* spin: of the ball about its own axis, times the sine of that axis */
} Rolling;

/* Forces on a ball: all of them, that of the inner ring, and its moment about the inner groove centre. */
typedef struct {
    Dual sum[2], ring[2], moment;
} BallForces;

/* Row of the tables at a speed of the shaft; films at rest and below the lowest speed are those of the lowest. */
SpeedRow speed_row(const Bearing *b, double omega);

static inline double film_speed(const Bearing *b, double omega)
{
    return fabs(omega) > b->speed[0] ? fabs(omega) : b->speed[0];
}

/* Speed about the axis of what has the speed `orbit` as seen from the outer ring. */
static inline Dual about_axis(const Grooves *g, Dual orbit)
{
    return plus(times(g->sense, orbit), g->ring_speed[OUTER_RACE]);
}

/* Whether the races share the gyroscopic moment by their forces. */
static inline int shared_by_forces(const Bearing *b)
{
    return b->control == INNER_CONTROL || b->control == SHARED_CONTROL;
}

/* Whether contact angles vary: else balls stay in the plane of the grooves. */
static inline int is_angular(const Bearing *b)
{
    return b->direction[b->directions - 1] >= IN_Z || b->grooves.axial != 0.0;
}

/* Whether films follow the angles of their balls: else they are those of the tables. */
static inline int films_vary(const Bearing *b)
{
    return is_angular(b) || b->grooves.cosine != 1.0;
}

/* Dry compression of a contact by the table of the lowest speed, for the share of the inner race in the gyroscopic moment. */
static inline Dual dry_compression(const Race *race, Dual approach)
{
    static const SpeedRow lowest = {0, 0.0, 0.0};
    int k = 0;
    double slope, lift;
    const double g = race_gap(race, lowest, NULL, approach.x, &k, &slope, &lift);
    return chained(g, slope, approach);
}

/* The vector along the inner spring: its groove, half a circle with straight walls beyond it, never pulls a ball inward, however far the
 * ring has left it, and the potential stays convex. Returns its length. */
IN_PLACE Dual inner_span(const Dual b[2], const Dual c[2], Dual s[2])
{
    static const double tiny = 1e-20;
    s[0] = sub(c[0], b[0]);
    s[1] = sub(c[1], b[1]);
    if (s[0].x < 0.0) {
        s[0] = number(0.0);
    }
    return root(plus(add(mul(s[0], s[0]), mul(s[1], s[1])), tiny * tiny));
}

IN_PLACE Dual outer_span(const Dual b[2])
{
    return root(add(mul(b[0], b[0]), mul(b[1], b[1])));
}

static inline Dual at_least(Dual value, double least)
{
    return value.x > least ? value : number(least);
}

/* Angles and speeds of a ball; `dry` are the dry compressions of both contacts where the races share by forces, else NULL. */
IN_PLACE Rolling roll(const Bearing *bearing, const Dual b[2], const Dual c[2], const Dual dry[2])
{
    /* Least cosine of a contact angle with which a ball rolls (63 degrees): none that carries runs so steeply, and one that the inner
     * ring has left by a tenth of a millimetre has no place on it at which it would roll. Cosine between the axis of a ball and the cone
     * of a contact that drives it, from which on it slips. W_i/W_o below which inner race control fades. */
    static const double least_cosine = 0.45, least_drive = 0.1, of_outer = 0.01;
    const Grooves *grooves = &bearing->grooves;
    const double g = grooves->ball / grooves->pitch; /* the axis of the ball is at an angle whose tangent is `slope` */
    Dual s[2], c_i, s_i, c_o, s_o, per_i, per_o, slope, r_i, r_o, per_r, by_i, by_o, per_both;
    Rolling at;
    at.l[INNER_RACE] = inner_span(b, c, s);
    at.l[OUTER_RACE] = outer_span(b);
    per_i = over(number(1.0), at.l[INNER_RACE]);
    per_o = over(number(1.0), at.l[OUTER_RACE]);
    c_i = at.cosine[INNER_RACE] = mul(s[0], per_i);
    s_i = at.sine[INNER_RACE] = mul(s[1], per_i);
    c_o = at.cosine[OUTER_RACE] = mul(b[0], per_o);
    s_o = at.sine[OUTER_RACE] = mul(b[1], per_o);
    if (s[1].x == 0.0 && s[1].d == 0.0 && b[1].x == 0.0 && b[1].d == 0.0) { /* on no inclined contact nothing spins */
        at.axis = at.spin = at.share = number(0.0);
        at.drive = number(2.0 / (1.0 - g * g));
        at.orbit = number(0.5 * (1.0 - g));
        at.speed_sum[INNER_RACE] = at.speed_sum[OUTER_RACE] = number(0.5 * grooves->pitch * (1.0 - g * g));
        return at;
    }
    if (c_i.x < least_cosine) {
        c_i = number(least_cosine);
        s_i = number((s_i.x >= 0.0 ? 1.0 : -1.0) * sqrt(1.0 - least_cosine * least_cosine));
    }
    if (c_o.x < least_cosine) {
        c_o = number(least_cosine);
        s_o = number((s_o.x >= 0.0 ? 1.0 : -1.0) * sqrt(1.0 - least_cosine * least_cosine));
    }
    at.share = number(0.0);
    slope = over(s_o, plus(c_o, g));
    if (dry != NULL && dry[INNER_RACE].x > 0.0) {
        const Dual w_i = times(grooves->spin_moment[INNER_RACE], mul(dry[INNER_RACE], dry[INNER_RACE]));
        Dual ratio = over(times(grooves->spin_moment[OUTER_RACE], mul(dry[OUTER_RACE], dry[OUTER_RACE])), w_i);
        if (bearing->control == INNER_CONTROL) {
            ratio = times(of_outer * of_outer, mul(ratio, ratio));
        }
        at.share = over(number(1.0), plus(ratio, 1.0));
        slope = add(mul(sub(number(1.0), at.share), slope), mul(at.share, over(s_i, plus(c_i, -g))));
    }
    r_i = plus(times(-g, c_i), 1.0);
    r_o = plus(times(g, c_o), 1.0);
    per_r = over(number(1.0), mul(r_i, r_o));
    by_i = at_least(mul(add(c_i, mul(slope, s_i)), mul(r_o, per_r)), least_drive);
    by_o = at_least(mul(add(c_o, mul(slope, s_o)), mul(r_i, per_r)), least_drive);
    at.axis = slope;
    at.drive = add(by_i, by_o);
    per_both = over(number(1.0), at.drive);
    at.orbit = mul(by_o, per_both);
    at.spin = times(1.0 / g, mul(slope, per_both));
    at.speed_sum[INNER_RACE] = mul(times(grooves->pitch, sub(number(1.0), at.orbit)), r_i);
    at.speed_sum[OUTER_RACE] = mul(times(grooves->pitch, at.orbit), r_o);
    return at;
}

/* Speed of a ball about its own axis, seen from the cage, over that of the rings against each other. */
static inline double own_rotation(const Bearing *b, const Rolling *at)
{
    return b->grooves.pitch / b->grooves.ball * sqrt(1.0 + at->axis.x * at->axis.x) / at->drive.x;
}

/* Film at a race over that of the tables, by speed and radius (Hamrock and Dowson 1977). */
static inline Dual film_factor(const Bearing *b, const Rolling *at, int race)
{
    static const double by_speed = 0.67, by_radius = 0.464;
    const double pitch = b->grooves.pitch, nominal = b->grooves.ball / pitch * b->grooves.cosine;
    const double radius = race == INNER_RACE ? 1.0 - nominal : 1.0 + nominal;
    const Dual share = race == INNER_RACE ? sub(number(1.0), at->orbit) : at->orbit, u = at->speed_sum[race];
    const Dual faster = times(1.0 / (0.5 * pitch * (1.0 - nominal * nominal)), u);
    const Dual wider = times(1.0 / (radius * pitch), over(u, share));
    const double factor = exp(by_speed * log(faster.x) + by_radius * log(wider.x));
    return dual(factor, factor * (by_speed * faster.d / faster.x + by_radius * wider.d / wider.x));
}

IN_PLACE BallForces forces_on(const Grooves *g, const Rolling *at, Dual omega, Dual f_i, Dual f_o)
{
    const Dual speed = mul(about_axis(g, at->orbit), omega), centrifugal = times(g->mass * 0.5 * g->pitch, mul(speed, speed));
    const Dual spin = mul(times(g->sense, at->spin), omega), gyroscopic_friction = times(0.2 * g->gyroscopic * g->mass * g->ball, mul(speed, spin));
    const Dual t_i = mul(at->share, gyroscopic_friction), t_o = sub(t_i, gyroscopic_friction);
    const Dual *cosine = at->cosine, *sine = at->sine;
    BallForces f;
    f.ring[0] = sub(mul(f_i, cosine[INNER_RACE]), mul(t_i, sine[INNER_RACE]));
    f.ring[1] = add(mul(f_i, sine[INNER_RACE]), mul(t_i, cosine[INNER_RACE]));
    f.sum[0] = sub(sub(f.ring[0], mul(f_o, cosine[OUTER_RACE])), mul(t_o, sine[OUTER_RACE]));
    f.sum[0] = add(f.sum[0], centrifugal);
    f.sum[1] = add(sub(f.ring[1], mul(f_o, sine[OUTER_RACE])), mul(t_o, cosine[OUTER_RACE]));
    f.moment = times(g->inner_radius, t_i);
    return f;
}

/* Rows by which the ring's displacement along a direction moves the groove centre at (x, y) outward and along the shaft, and by
 * which the force of a ball there acts along it; the third is that of its moment. */
static inline void ring_rows(const Grooves *g, int direction, double x, double y, double rows[3])
{
    rows[0] = direction == IN_X ? x : direction == IN_Y ? y : 0.0;
    rows[1] = direction == IN_Z ? 1.0 : direction == TILT_X ? g->circle * y : direction == TILT_Y ? -g->circle * x : 0.0;
    rows[2] = direction == TILT_X ? -y : direction == TILT_Y ? x : 0.0;
}

#endif
