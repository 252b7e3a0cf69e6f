/* Contact angles and rolling of a ball between two races; see contact_angles.h. */
#include "contact_angles.h"

#include <math.h>
#include <stddef.h>

static const double two_pi = 6.283185307179586;
static const double least_cosine = 0.45, least_drive = 0.1, of_outer = 0.01, tiny = 1e-20;
static const double by_speed = 0.67, by_radius = 0.464; /* film over speed and radius (Hamrock and Dowson 1977) */
static const double gamma_ratio = BALL_DIAMETER / PITCH_DIAMETER;

GrooveCentre groove_centre(const Setup *setup, const Dual q[], const Dual v[], Dual angle, Dual cage, int k)
{
    const double psi = angle.x + two_pi * k / BALLS, circle = GROOVE_CIRCLE;
    GrooveCentre g;
    Dual x, y;
    x = g.x = chained(cos(psi), -sin(psi), angle);
    y = g.y = chained(sin(psi), cos(psi), angle);
    g.moved[0] = add(mul(x, q[0]), mul(y, q[1]));
    g.moved[1] = add(q[2], times(circle, sub(mul(y, q[3]), mul(x, q[4]))));
    g.c[0] = plus(g.moved[0], FREE_RADIAL - 0.5 * setup->clearance);
    g.c[1] = plus(g.moved[1], FREE_AXIAL);
    g.d[0] = add(add(mul(x, v[0]), mul(y, v[1])), mul(cage, sub(mul(x, q[1]), mul(y, q[0]))));
    g.d[1] = add(v[2], times(circle, add(sub(mul(y, v[3]), mul(x, v[4])), mul(cage, add(mul(x, q[3]), mul(y, q[4]))))));
    return g;
}

Dual inner_span(const Dual b[2], const Dual c[2], Dual s[2])
{
    s[0] = sub(c[0], b[0]);
    s[1] = sub(c[1], b[1]);
    if (s[0].x < 0.0) {
        s[0] = number(0.0);
    }
    return root(plus(add(mul(s[0], s[0]), mul(s[1], s[1])), tiny * tiny));
}

static void rolls_at(Dual *cosine, Dual *sine)
{
    if (cosine->x < least_cosine) {
        const double most = sqrt(1.0 - least_cosine * least_cosine);
        *cosine = number(least_cosine);
        *sine = number(sine->x >= 0.0 ? most : -most);
    }
}

static Dual at_least(Dual value, double least)
{
    return value.x > least ? value : number(least);
}

/* Share of the inner race in the gyroscopic moment, by dry compressions from the tables of the lowest speed. */
static Dual share_of(const Setup *setup, const Dual approach[2])
{
    const double spin_moment[2] = {INNER_SPIN_MOMENT, OUTER_SPIN_MOMENT};
    Dual moment[2], ratio;
    int race;
    for (race = 0; race < 2; race++) {
        StepFilters filters;
        RaceStep contact = {&setup->race[race], {0, 0.0, 0.0}, 0.0, NULL, NULL, &filters};
        double slope, lift, g;
        filters.interval = 0;
        g = race_gap(&contact, approach[race].x, &slope, &lift);
        moment[race] = times(spin_moment[race], mul(chained(g, slope, approach[race]), chained(g, slope, approach[race])));
    }
    if (moment[INNER_RACE].x <= 0.0) {
        return number(0.0);
    }
    ratio = over(moment[OUTER_RACE], moment[INNER_RACE]);
    if (RACE_CONTROL == INNER_CONTROL) {
        ratio = times(of_outer * of_outer, mul(ratio, ratio));
    }
    return over(number(1.0), plus(ratio, 1.0));
}

Rolling roll(const Setup *setup, const Dual b[2], const Dual c[2], const Dual *approach)
{
    const double g = gamma_ratio;
    Dual s[2], c_i, s_i, c_o, s_o, slope, cos_b, r_i, r_o, by_i, by_o, both;
    Rolling at;
    at.l[INNER_RACE] = inner_span(b, c, s);
    at.l[OUTER_RACE] = root(add(mul(b[0], b[0]), mul(b[1], b[1])));
    c_i = at.cosine[INNER_RACE] = over(s[0], at.l[INNER_RACE]);
    s_i = at.sine[INNER_RACE] = over(s[1], at.l[INNER_RACE]);
    c_o = at.cosine[OUTER_RACE] = over(b[0], at.l[OUTER_RACE]);
    s_o = at.sine[OUTER_RACE] = over(b[1], at.l[OUTER_RACE]);
    rolls_at(&c_i, &s_i);
    rolls_at(&c_o, &s_o);
    if (BY_FORCES) {
        const Dual own[2] = {plus(at.l[INNER_RACE], -INNER_FREE_LENGTH), plus(at.l[OUTER_RACE], -OUTER_FREE_LENGTH)};
        at.share = share_of(setup, approach != NULL ? approach : own);
    } else {
        at.share = number(0.0);
    }
    slope = over(mul(sub(number(1.0), at.share), s_o), plus(c_o, g));
    slope = add(slope, over(mul(at.share, s_i), plus(c_i, -g)));
    cos_b = over(number(1.0), root(plus(mul(slope, slope), 1.0)));
    r_i = plus(times(-g, c_i), 1.0);
    r_o = plus(times(g, c_o), 1.0);
    by_i = at_least(over(add(c_i, mul(slope, s_i)), r_i), least_drive);
    by_o = at_least(over(add(c_o, mul(slope, s_o)), r_o), least_drive);
    both = add(by_i, by_o);
    at.orbit = over(by_o, both);
    at.ball_rotation = over(number(1.0), mul(times(g, cos_b), both));
    at.sin_b = mul(slope, cos_b);
    at.speed_sum[INNER_RACE] = mul(times(PITCH_DIAMETER, sub(number(1.0), at.orbit)), r_i);
    at.speed_sum[OUTER_RACE] = mul(times(PITCH_DIAMETER, at.orbit), r_o);
    return at;
}

void film_factors(const Rolling *at, Dual factor[2])
{
    const double nominal = gamma_ratio * TABLE_COSINE, u = 0.5 * PITCH_DIAMETER * (1.0 - nominal * nominal);
    const Dual share[2] = {sub(number(1.0), at->orbit), at->orbit};
    int race;
    for (race = 0; race < 2; race++) {
        const double radius = race == INNER_RACE ? 1.0 - nominal : 1.0 + nominal;
        const Dual r = over(at->speed_sum[race], times(PITCH_DIAMETER, share[race]));
        factor[race] = mul(power(times(1.0 / u, at->speed_sum[race]), number(by_speed)),
                           power(times(1.0 / radius, r), number(by_radius)));
    }
}

BallForces forces_on(const Rolling *at, Dual omega, Dual f_i, Dual f_o)
{
    const Dual speed = mul(at->orbit, omega), centrifugal = times(BALL_MASS * 0.5 * PITCH_DIAMETER, mul(speed, speed));
    const Dual spin = mul(mul(at->ball_rotation, omega), at->sin_b);
    const Dual gyroscopic_friction = times(0.2 * GYROSCOPIC * BALL_MASS * BALL_DIAMETER, mul(speed, spin));
    const Dual t_i = mul(at->share, gyroscopic_friction), t_o = sub(t_i, gyroscopic_friction);
    const Dual *cosine = at->cosine, *sine = at->sine;
    BallForces f;
    f.ring[0] = sub(mul(f_i, cosine[INNER_RACE]), mul(t_i, sine[INNER_RACE]));
    f.ring[1] = add(mul(f_i, sine[INNER_RACE]), mul(t_i, cosine[INNER_RACE]));
    f.sum[0] = sub(sub(f.ring[0], mul(f_o, cosine[OUTER_RACE])), mul(t_o, sine[OUTER_RACE]));
    f.sum[0] = add(f.sum[0], centrifugal);
    f.sum[1] = add(sub(f.ring[1], mul(f_o, sine[OUTER_RACE])), mul(t_o, cosine[OUTER_RACE]));
    f.moment = times(GROOVE_RADIUS, t_i);
    return f;
}

void add_to_ring(const GrooveCentre *at, const BallForces *ball, Dual force[])
{
    const Dual turns = sub(times(GROOVE_CIRCLE, ball->ring[1]), ball->moment);
    force[0] = add(force[0], mul(at->x, ball->ring[0]));
    force[1] = add(force[1], mul(at->y, ball->ring[0]));
    force[2] = add(force[2], ball->ring[1]);
    force[3] = add(force[3], mul(at->y, turns));
    force[4] = sub(force[4], mul(at->x, turns));
}
