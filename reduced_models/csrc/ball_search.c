/* Places of balls from anywhere: where `balance_ball` begins, and where it is lost. */
#include "ball.h"

#include <math.h>
#include <string.h>

enum { MOST_SEARCHED = 100 };          /* steps of the search at rest: a handful, but where a ball lifts off */
enum { DOUBLED = 40, HALVED = 48 };    /* steps of a search by bisection: to a bracket, and in it */
enum { MOST_DESCENDED = 400 };         /* steps of a descent: tens */
static const double balanced_roughly = 1e-9; /* imbalance of a ball, over its forces, from which `balance_ball` goes on */
static const double light = 1e-3;      /* stiffness of the inner contact over that of the outer one, below which a ball follows the outer one */
static const double roughly = 0.1;     /* of the forces along a step, that are left at the end of a search along it */
static const double beside = 0.5;      /* rad, of the angle of a ball, on either side of the line between the groove centres and of that across the shaft */
static const double first_damping = 1e-12; /* of a descent, over the squared slopes */
static const double epsilon = 2.220446049250313e-16;

/* First place of a ball: on the line between the groove centres, dry contacts in balance if they touch. */
static void first_place(const Search *s, double b[2])
{
    const Bearing *bearing = s->bearing;
    const double *c = s->ball->c, omega = s->step->omega, free_outer = free_length(s, OUTER_RACE), length = hypot(c[0], c[1]);
    const double closer = length - free_length(s, INNER_RACE) - free_outer;
    const double ratio = pow(bearing->race[OUTER_RACE].kn / bearing->race[INNER_RACE].kn, 2.0 / 3.0);
    double outward = free_outer + closer / (1.0 + ratio);
    if (closer < 0.0 && omega != 0.0) {
        const double orbit = 2.0 * about_axis(&bearing->grooves, number(0.5)).x;
        const double swing = 0.125 * omega * omega * bearing->grooves.mass * bearing->grooves.pitch * orbit * orbit;
        outward = free_outer + pow(swing / bearing->race[OUTER_RACE].kn, 2.0 / 3.0);
    }
    b[0] = outward * c[0] / length;
    b[1] = outward * c[1] / length;
}

/* Newton's step with the springs alone, whose stiffness k n n^T + F/l (1 - n n^T) is positive definite. */
static void convex_step(const Pressed *p, double d[2])
{
    const double i_r = p->at.cosine[INNER_RACE], i_z = p->at.sine[INNER_RACE], o_r = p->at.cosine[OUTER_RACE], o_z = p->at.sine[OUTER_RACE];
    const double side_i = p->inner.force / p->at.l[INNER_RACE], side_o = p->outer.force / p->at.l[OUTER_RACE];
    const double k_i = p->inner.stiffness - side_i, k_o = p->outer.stiffness - side_o;
    const double rr = k_i * i_r * i_r + k_o * o_r * o_r + side_i + side_o, zz = k_i * i_z * i_z + k_o * o_z * o_z + side_i + side_o;
    const double rz = k_i * i_r * i_z + k_o * o_r * o_z, det = rr * zz - rz * rz;
    if (det > 0.0) {
        d[0] = (zz * p->sum[0] - rz * p->sum[1]) / det;
        d[1] = (rr * p->sum[1] - rz * p->sum[0]) / det;
    } else {
        d[0] = p->sum[0] / (rr + zz);
        d[1] = p->sum[1] / (rr + zz);
    }
}

/* Place of a ball after a share t of the step d from b, and the direction of the step there. On an `arc` the ball follows the outer
 * groove: a straight step would press it into the groove, or lift it, by far more than what holds a ball that the inner ring has left. */
static void move_along(const double b[2], const double d[2], double t, int arc, double moved[2], double direction[2])
{
    int j;
    if (arc) {
        const double length = hypot(b[0], b[1]), r = b[0] / length, z = b[1] / length, out = d[0] * r + d[1] * z;
        const double reach = length + t * out, across = d[1] * r - d[0] * z, aside = across * reach / length;
        const double c = cos(t * across / length), s = sin(t * across / length), n_r = c * r - s * z, n_z = s * r + c * z;
        moved[0] = reach * n_r;
        moved[1] = reach * n_z;
        direction[0] = out * n_r - aside * n_z;
        direction[1] = out * n_z + aside * n_r;
        return;
    }
    for (j = 0; j < 2; j++) {
        moved[j] = b[j] + t * d[j];
        direction[j] = d[j];
    }
}

/* Moves b along a step to where the forces along it balance, roughly. */
static void search_along(const Search *s, const double d[2], int arc, const Pressed *p, double b[2])
{
    const double size = hypot(p->sum[0], p->sum[1]), slope = p->sum[0] * d[0] + p->sum[1] * d[1];
    double low = 0.0, high = 1.0, t = 1.0, moved[2] = {b[0], b[1]}, direction[2];
    int i;
    for (i = 0; i < MOST_SEARCHED && low < 1.0; i++) {
        Pressed now;
        double along;
        move_along(b, d, t, arc, moved, direction);
        press_ball(s, moved, &now);
        along = now.sum[0] * direction[0] + now.sum[1] * direction[1];
        if ((t == 1.0 && hypot(now.sum[0], now.sum[1]) < 0.5 * size) || fabs(along) <= roughly * slope) {
            break;
        }
        *(along > 0.0 ? &low : &high) = t;
        t = 0.5 * (low + high);
    }
    memcpy(b, moved, sizeof moved);
}

/* Moves a ball to where its forces nearly balance at rest; returns whether there is such a place. Newton's method with a search along
 * each step. Contacts act as springs between groove centres, whose distance grows as the ball is compressed: without forces of
 * inertia their energy is convex, so that it converges; these disturb it little. */
static int seek_place(const Search *s, double b[2])
{
    static const double none[2] = {0.0};
    const double *free = s->bearing->grooves.free_length, most = longest * (free[INNER_RACE] + free[OUTER_RACE]);
    double reach = first_step;
    int i, j;
    for (i = 0; i < MOST_SEARCHED; i++) {
        double size, stiff, by_film[2], d[2], cut;
        Pressed p;
        Tangents t;
        press_ball(s, b, &p);
        size = hypot(p.sum[0], p.sum[1]);
        stiff = p.inner.stiffness + p.outer.stiffness;
        if (!isfinite(size)) {
            return 0;
        }
        if (size <= balanced_roughly * (p.inner.force + p.outer.force + size)
                        + 100.0 * epsilon * (p.at.l[INNER_RACE] + p.at.l[OUTER_RACE]) * stiff) {
            return 1;
        }
        by_film[INNER_RACE] = p.inner.by_film;
        by_film[OUTER_RACE] = p.outer.by_film;
        renew_slopes(s, b, none, by_film, s->ball->inertia);
        tangents(s, &p, (const double (*)[4])s->ball->inertia, &t);
        if (stiff <= 0.0 || !(fabs(t.det) > singular * stiff * stiff)) { /* nothing touches it */
            for (j = 0; j < 2; j++) {
                b[j] += reach * p.sum[j] / size;
            }
            reach *= 2.0;
            continue;
        }
        d[0] = (t.rz * p.sum[1] - t.zz * p.sum[0]) / t.det;
        d[1] = (t.zr * p.sum[0] - t.rr * p.sum[1]) / t.det;
        if (p.sum[0] * d[0] + p.sum[1] * d[1] <= 0.0) { /* away from the balance */
            convex_step(&p, d);
        }
        cut = fmin(1.0, most / hypot(d[0], d[1]));
        d[0] *= cut;
        d[1] *= cut;
        search_along(s, d, p.inner.stiffness < light * p.outer.stiffness, &p, b);
    }
    return 0;
}

/* Force on a ball away from the outer groove centre, at a distance from it where none acts across; its place there. */
static double push_along(const Search *s, double length, double far, double b[2])
{
    double low = fmin(far, 0.0) - beside, high = fmax(far, 0.0) + beside, angle = far, along = 0.0;
    int i;
    for (i = 0; i < HALVED; i++) {
        const double c = cos(angle), z = sin(angle);
        double across;
        Pressed p;
        b[0] = length * c;
        b[1] = length * z;
        press_ball(s, b, &p);
        along = p.sum[0] * c + p.sum[1] * z;
        across = p.sum[1] * c - p.sum[0] * z;
        if (across == 0.0) { /* exactly, of balls between grooves in one plane, which stay in it */
            break;
        }
        if (across > 0.0) {
            low = angle;
        } else {
            high = angle;
        }
        angle = 0.5 * (low + high);
    }
    return along;
}

/* Place of a ball by bisection, for one that Newton's method loses between the races: there nothing may act on it whose slope leads
 * to the far race. The force outward falls towards the outer race, and those across with the angle. */
static void search_place(const Search *s, double b[2])
{
    const double *c = s->ball->c, far = atan2(c[1], c[0]);
    double low = s->bearing->grooves.free_length[OUTER_RACE], high = low, reach = first_step;
    int i;
    for (i = 0; i < DOUBLED && push_along(s, low, far, b) < 0.0; i++) {
        reach *= 2.0;
        low = fmax(low - reach, 0.5 * low);
    }
    reach = first_step;
    for (i = 0; i < DOUBLED && push_along(s, high, far, b) > 0.0; i++) {
        reach *= 2.0;
        high += reach;
    }
    for (i = 0; i < HALVED; i++) {
        const double middle = 0.5 * (low + high);
        if (push_along(s, middle, far, b) > 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/* Moves a ball to where its forces balance at the end of a step; returns whether there is such a place. The method of Levenberg and
 * Marquardt makes the imbalance smaller in every step: films that let go, and friction that passes from race to race, bend it so much within
 * some nanometres that Newton's method runs around the balance. */
static int descend(const Search *s, double b[2])
{
    static const double none[2] = {0.0};
    double damping = 0.0, size;
    int i, renewed = 0;
    Pressed p;
    Tangents t;
    press_ball(s, b, &p);
    size = hypot(p.sum[0], p.sum[1]);
    for (i = 0; i < MOST_DESCENDED && !(size <= allowed_imbalance(s, &p)); i++) {
        double rr, rz, zz, by_r, by_z, det, moved[2], now;
        Pressed there;
        if (!renewed) {
            renew_slopes(s, b, none, none, s->ball->inertia);
            tangents(s, &p, (const double (*)[4])s->ball->inertia, &t);
            renewed = 1;
        }
        rr = t.rr * t.rr + t.zr * t.zr;
        rz = t.rr * t.rz + t.zr * t.zz;
        zz = t.rz * t.rz + t.zz * t.zz;
        damping = i == 0 ? first_damping * (rr + zz) : damping;
        rr += damping;
        zz += damping;
        by_r = t.rr * p.sum[0] + t.zr * p.sum[1];
        by_z = t.rz * p.sum[0] + t.zz * p.sum[1];
        det = rr * zz - rz * rz;
        moved[0] = b[0] + (rz * by_z - zz * by_r) / det;
        moved[1] = b[1] + (rz * by_r - rr * by_z) / det;
        press_ball(s, moved, &there);
        now = hypot(there.sum[0], there.sum[1]);
        if (now < size) {
            memcpy(b, moved, sizeof moved);
            p = there;
            size = now;
            damping *= 0.2;
            renewed = 0;
        } else if (det > 0.0 && isfinite(det)) {
            damping *= 5.0;
        } else { /* it is lost, or nothing acts on it */
            break;
        }
    }
    return size <= allowed_imbalance(s, &p);
}

/* Whether a ball without films lies between both races at rest. */
static int lies_between(const Search *s)
{
    const double *c = s->ball->c;
    return at_rest(s) && s->step->omega == 0.0 && s->contact[INNER_RACE].race->nodes == 0
           && hypot(c[0], c[1]) <= (free_length(s, INNER_RACE) + free_length(s, OUTER_RACE)) * (1.0 + 10.0 * singular);
}

int place_ball(const Search *s)
{
    const BallStep *ball = s->ball;
    const int placed = ball->start[0] != 0.0;
    double b[2];
    int j;
    if (lies_between(s)) {
        Pressed p;
        first_place(s, b);
        press_ball(s, b, &p);
        leave_ball(s, b, &p);
        return 1;
    }
    for (j = 0; j < 2; j++) {
        b[j] = ball->start[j] + ball->follow[j][0] * (ball->c[0] - ball->tried[0]) + ball->follow[j][1] * (ball->c[1] - ball->tried[1]);
    }
    if (placed && balance_ball(s, b)) {
        return 1;
    }
    memcpy(b, ball->start, sizeof b);
    if (placed && at_rest(s) && seek_place(s, b) && balance_ball(s, b)) {
        return 1;
    }
    first_place(s, b);
    if (at_rest(s)) {
        return seek_place(s, b) && balance_ball(s, b);
    }
    if (balance_ball(s, b)) {
        return 1;
    }
    search_place(s, b);
    if (balance_ball(s, b)) {
        return 1;
    }
    memcpy(b, ball->start, sizeof b);
    if (placed && descend(s, b) && balance_ball(s, b)) {
        return 1;
    }
    first_place(s, b);
    return descend(s, b) && balance_ball(s, b);
}
