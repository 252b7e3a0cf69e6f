/* Balance of one ball between two races by Newton's method; see ball.h. */
#include "ball.h"

#include <math.h>
#include <string.h>

enum { MOST_BALL_STEPS = 60, MOST_AT_REST = 12, STALE = 5 };
static const double overshoot = 2.0;  /* growth of the imbalance that halves the way to the last place */

void renew_slopes(const Search *s, const double b[2], const double force[2], const double by_film[2], double slopes[5][4])
{
    const double *c = s->ball->c;
    const int films = by_film[INNER_RACE] != 0.0 || by_film[OUTER_RACE] != 0.0;
    int j;
    for (j = 0; j < 4; j++) {
        const Dual ball[2] = {dual(b[0], j == 0), dual(b[1], j == 1)}, centre[2] = {dual(c[0], j == 2), dual(c[1], j == 3)};
        const Rolling at = roll_along(s, ball, centre);
        const Dual f_i = dual(force[INNER_RACE], films ? by_film[INNER_RACE] * film_factor(s->bearing, &at, INNER_RACE).d : 0.0);
        const Dual f_o = dual(force[OUTER_RACE], films ? by_film[OUTER_RACE] * film_factor(s->bearing, &at, OUTER_RACE).d : 0.0);
        const BallForces f = forces_on(&s->bearing->grooves, &at, number(s->step->omega), f_i, f_o);
        slopes[0][j] = f.sum[0].d;
        slopes[1][j] = f.sum[1].d;
        slopes[2][j] = f.ring[0].d;
        slopes[3][j] = f.ring[1].d;
        slopes[4][j] = f.moment.d;
    }
}

void press_ball(const Search *s, const double b[2], Pressed *p)
{
    press(s, b, p);
}

/* Where a ball is looked for next: at rest where it is, following the groove centre by these slopes. */
static void keep_place(BallStep *ball, const double follow[2][2])
{
    memcpy(ball->start, ball->place, sizeof ball->start);
    memcpy(ball->tried, ball->c, sizeof ball->tried);
    memcpy(ball->follow, follow, sizeof ball->follow);
}

void leave_ball(const Search *s, const double b[2], const Pressed *p)
{
    static const double still[2][2] = {{0.0}};
    BallStep *ball = s->ball;
    memcpy(ball->place, b, sizeof ball->place);
    memset(ball->force, 0, sizeof ball->force);
    memset(ball->ring, 0, sizeof ball->ring);
    memset(ball->slopes, 0, sizeof ball->slopes);
    ball->film[INNER_RACE] = p->inner.film;
    ball->film[OUTER_RACE] = p->outer.film;
    if (at_rest(s)) {
        keep_place(ball, still);
    }
}

/* A ball that is balanced but for an imbalance that moves it a last bit: its place, forces and slopes, the ball following. */
static void settle_ball(const Search *s, const double b[2], const Pressed *p, const Tangents *t, const double inertia[5][4])
{
    const double i_r = p->at.cosine[INNER_RACE], i_z = p->at.sine[INNER_RACE], d_i = p->inner.damping, per_det = 1.0 / t->det;
    const double move[2] = {(t->rz * p->sum[1] - t->zz * p->sum[0]) * per_det, (t->zr * p->sum[0] - t->rr * p->sum[1]) * per_det};
    /* by c and d: of the balance; then of the force of the ring, in which b follows c */
    const double w[2][4] = {
        {i_r * t->a[0] + t->turn_rr + inertia[0][2], i_r * t->a[1] + t->turn_rz + inertia[0][3], d_i * i_r * i_r, d_i * i_r * i_z},
        {i_z * t->a[0] + t->turn_rz + inertia[1][2], i_z * t->a[1] + t->turn_zz + inertia[1][3], d_i * i_r * i_z, d_i * i_z * i_z}};
    const double by_b[3][2] = {{-i_r * t->h[0] - t->turn_rr + inertia[2][0], -i_r * t->h[1] - t->turn_rz + inertia[2][1]},
                               {-i_z * t->h[0] - t->turn_rz + inertia[3][0], -i_z * t->h[1] - t->turn_zz + inertia[3][1]},
                               {inertia[4][0], inertia[4][1]}};
    const double ring[2] = {p->at.ring[0] + p->inner.force * i_r, p->at.ring[1] + p->inner.force * i_z};
    double follow[2][2];
    BallStep *ball = s->ball;
    int i, j;
    for (j = 0; j < 4; j++) {
        const double follow_r = (t->rz * w[1][j] - t->zz * w[0][j]) * per_det, follow_z = (t->zr * w[0][j] - t->rr * w[1][j]) * per_det;
        for (i = 0; i < 3; i++) {
            double own = i < 2 ? w[i][j] : 0.0;
            if (j < 2) {
                own += i < 2 ? inertia[2 + i][2 + j] - inertia[i][2 + j] : inertia[4][2 + j];
            }
            ball->slopes[i][j] = own + by_b[i][0] * follow_r + by_b[i][1] * follow_z;
        }
        if (j < 2) {
            follow[0][j] = follow_r;
            follow[1][j] = follow_z;
        }
    }
    for (i = 0; i < 3; i++) {
        ball->ring[i] = (i < 2 ? ring[i] : p->at.moment) + by_b[i][0] * move[0] + by_b[i][1] * move[1];
    }
    ball->place[0] = b[0] + move[0];
    ball->place[1] = b[1] + move[1];
    ball->force[INNER_RACE] = fmax(0.0, p->inner.force - t->h[0] * move[0] - t->h[1] * move[1]);
    ball->force[OUTER_RACE] = fmax(0.0, p->outer.force + t->m[0] * move[0] + t->m[1] * move[1]);
    ball->film[INNER_RACE] = p->inner.film;
    ball->film[OUTER_RACE] = p->outer.film;
    if (at_rest(s)) {
        keep_place(ball, (const double (*)[2])follow);
    }
}

int balance_ball(const Search *s, const double start[2])
{
    static const double none[2] = {0.0};
    const StepHead *step = s->step;
    const double *free = s->bearing->grooves.free_length, most = longest * (free[INNER_RACE] + free[OUTER_RACE]);
    const int most_steps = at_rest(s) ? MOST_AT_REST : MOST_BALL_STEPS, films = s->contact[INNER_RACE].film != NULL;
    const int renews = at_rest(s) && (films || (is_angular(s->bearing) && step->omega != 0.0));
    double reach = first_step, previous = HUGE_VAL, b[2] = {start[0], start[1]}, last[2] = {start[0], start[1]}, renewed[5][4];
    BallStep *ball = s->ball;
    int i, j;
    for (i = 0; i < most_steps; i++) {
        const double (*inertia)[4] = at_rest(s) ? (const double (*)[4])ball->inertia : s->inertia;
        const int old = i % STALE == STALE - 1;
        double size, allowed, move[2];
        Pressed p;
        Tangents t;
        if (i >= STALE - 1 && step->omega != 0.0 && !at_rest(s)) { /* a long search */
            if (old) {
                renew_slopes(s, b, none, none, renewed);
            }
            inertia = (const double (*)[4])renewed;
        }
        press(s, b, &p);
        size = sqrt(p.sum[0] * p.sum[0] + p.sum[1] * p.sum[1]);
        if (!isfinite(size)) {
            return 0;
        }
        if (step->omega == 0.0 && s->heavy == 0.0 && p.inner.force == 0.0 && p.outer.force == 0.0 && p.inner.damping == 0.0
            && p.outer.damping == 0.0) { /* at rest between the races nothing acts on it */
            leave_ball(s, b, &p);
            return 1;
        }
        if (size > overshoot * previous) { /* a kink lies between */
            for (j = 0; j < 2; j++) {
                b[j] = 0.5 * (b[j] + last[j]);
            }
            previous = HUGE_VAL;
            continue;
        }
        allowed = allowed_imbalance(s, &p);
        if (at_rest(s) && films && size <= allowed) {
            press_ball(s, b, &p); /* begins with its films as they are: now their slopes are exact too */
        }
        if (renews && (old || size <= allowed)) { /* exact in the end, of films too */
            const double by_film[2] = {p.inner.by_film, p.outer.by_film};
            renew_slopes(s, b, none, by_film, ball->inertia);
        }
        tangents(s, &p, inertia, &t);
        if (t.stiff <= 0.0 || fabs(t.det) <= singular * t.stiff * t.stiff) { /* nothing touches it */
            for (j = 0; j < 2; j++) {
                b[j] += reach * p.sum[j] / size;
            }
            reach *= 2.0;
            previous = HUGE_VAL;
            continue;
        }
        if (size <= allowed) {
            settle_ball(s, b, &p, &t, inertia);
            return 1;
        }
        {
            const double per_det = 1.0 / t.det;
            double cut = 1.0, length;
            move[0] = (t.rz * p.sum[1] - t.zz * p.sum[0]) * per_det;
            move[1] = (t.zr * p.sum[0] - t.rr * p.sum[1]) * per_det;
            length = move[0] * move[0] + move[1] * move[1];
            if (length > most * most) {
                cut = most / sqrt(length);
            }
            for (j = 0; j < 2; j++) {
                last[j] = b[j];
                b[j] += cut * move[j];
            }
            previous = size;
        }
    }
    return 0;
}
