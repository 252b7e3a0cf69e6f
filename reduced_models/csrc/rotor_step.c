/* Steps of a rotor by the generalised-alpha method (Chung and Hulbert 1993), everything linear condensed onto the points at which
 * supports act: reduced_models.rotor.core_rotor. See rotor.h. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "linear_equations.h"
#include "rotor.h"

static const double by_rounding = 16.0 * DBL_EPSILON; /* of what balances, which cannot be less */
static const double overshoot = 2.0; /* growth of the imbalance that halves the way to the last place: a surface lands or leaves */
static const char *const no_number = "the motion is too large for a floating-point number";

/* What a step of a length makes of velocities and accelerations: gain, then what place, velocity and acceleration at the start
 * make of them at the end. */
typedef struct {
    double alpha_m, alpha_f, weight, velocity[4], acceleration[4];
} Method;

typedef char method_is_numbers[sizeof(Method) == METHOD_NUMBERS * sizeof(double) ? 1 : -1];

static Method method_of(double rho, double h)
{
    const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0);
    const double gamma = 0.5 - alpha_m + alpha_f, twice = 1.0 - alpha_m + alpha_f, beta = 0.25 * twice * twice, ratio = gamma / beta;
    Method m;
    m.alpha_m = alpha_m;
    m.alpha_f = alpha_f;
    m.weight = 1.0 - alpha_f;
    m.velocity[0] = ratio / h;
    m.velocity[1] = -m.velocity[0];
    m.velocity[2] = 1.0 - ratio;
    m.velocity[3] = h * (1.0 - 0.5 * ratio);
    m.acceleration[0] = 1.0 / (beta * h * h);
    m.acceleration[1] = -m.acceleration[0];
    m.acceleration[2] = -1.0 / (beta * h);
    m.acceleration[3] = 1.0 - 0.5 / beta;
    return m;
}

/* The linear part of a step, in the state: of which length and speed, factors (without gyroscopic forces the inverse), responses to forces on the points, and the
 * stiffness of the points, (points, points). */
typedef struct {
    Method *method;
    double *h, *omega, *factors, *pivot, *columns, *D;
} Condensed;

static Condensed condensed(const Rotor *r, double state[])
{
    const size_t n = (size_t)r->freedoms, p = (size_t)r->points;
    Condensed c;
    c.h = state + rotor_layout(r).step;
    c.omega = c.h + 1;
    c.method = (Method *)(void *)(c.h + 2);
    c.factors = c.h + 2 + METHOD_NUMBERS;
    c.pivot = c.factors + n * n;
    c.columns = c.pivot + n;
    c.D = c.columns + p * n;
    return c;
}

/* Room of a step, behind that of the supports. */
typedef struct {
    double *place, *inertial, *damped, *more, *late, *r, *free, *history, *off, *step, *velocity, *carried, *pivot, *slopes, *system, *applied;
} Room;

static Room room(const Rotor *r, double work[])
{
    const size_t n = (size_t)(r->freedoms + r->held), p = (size_t)r->points;
    Room room;
    room.place = work + supports_work(r);
    room.inertial = room.place + n;
    room.damped = room.inertial + n;
    room.more = room.damped + n;
    room.late = room.more + n;
    room.r = room.late + n;
    room.free = room.r + p;
    room.history = room.free + p;
    room.off = room.history + p;
    room.step = room.off + p;
    room.velocity = room.step + p;
    room.carried = room.velocity + p;
    room.pivot = room.carried + p;
    room.slopes = room.pivot + p;
    room.system = room.slopes + p * p;
    room.applied = room.system + n * n;
    return room;
}

static const char *condense(const Rotor *r, const Method *m, double h, double omega, double state[], const Room *room)
{
    const Condensed c = condensed(r, state);
    const int n = r->freedoms, p = r->points;
    const double inertial = (1.0 - m->alpha_m) * m->acceleration[0] * r->mass, damped = m->weight * m->velocity[0];
    int i, j;
    for (i = 0; i < n * n; i++) {
        const double turned = r->G == NULL ? 0.0 : r->mass * omega * r->G[i];
        c.factors[i] = inertial * r->M[i] + damped * (r->damping * r->C[i] + turned) + m->weight * r->stiffness * r->K[i];
    }
    *c.h = 0.0;
    if (!(isfinite(m->acceleration[0]) && factorise(n, c.factors, c.pivot))) {
        return "the step size is too small for the rotor";
    }
    for (j = 0; j < p; j++) {
        memcpy(&c.columns[j * n], &r->B[j * n], (size_t)n * sizeof c.columns[0]);
        substitute(n, c.factors, c.pivot, &c.columns[j * n]);
    }
    memset(room->slopes, 0, (size_t)(p * p) * sizeof room->slopes[0]);
    for (j = 0; j < p; j++) {
        add_product(p, n, 1.0, c.columns, &r->B[j * n], &room->slopes[j * p]);
    }
    if (!factorise(p, room->slopes, room->pivot)) {
        return "supports act on points that move as one";
    }
    invert(p, room->slopes, room->pivot, room->off, c.D);
    if (r->G == NULL) { /* the same for all steps of this length: products in place of substitutions */
        invert(n, c.factors, c.pivot, room->place, room->system);
        memcpy(c.factors, room->system, (size_t)(n * n) * sizeof c.factors[0]);
    }
    *c.h = h;
    *c.omega = omega;
    return NULL;
}

/* Places at the end of a step without forces of the supports there, and of the points what their rates follow from. */
static void free_place(const Rotor *r, const Method *m, double omega, const double applied[], double state[], const Room *room)
{
    const RotorLayout at = rotor_layout(r);
    const Condensed c = condensed(r, state);
    const double *d = state + at.place, *v = state + at.velocity, *a = state + at.acceleration;
    const int n = r->freedoms, p = r->points;
    double *place = room->place;
    int i;
    for (i = 0; i < n; i++) {
        const double history = m->acceleration[1] * d[i] + m->acceleration[2] * v[i] + m->acceleration[3] * a[i];
        room->late[i] = m->velocity[1] * d[i] + m->velocity[2] * v[i] + m->velocity[3] * a[i];
        room->inertial[i] = (1.0 - m->alpha_m) * history + m->alpha_m * a[i];
        room->damped[i] = m->weight * room->late[i] + m->alpha_f * v[i];
        room->more[i] = m->alpha_f * d[i];
        place[i] = m->weight * applied[i] + m->alpha_f * state[at.applied + (size_t)i];
    }
    rotor_take(r, state + at.carried, m->alpha_f, place);
    rotor_resist(r, omega, room->more, room->damped, place);
    add_product(n, n, -r->mass, r->M, room->inertial, place);
    if (r->G != NULL) {
        substitute(n, c.factors, c.pivot, place);
    } else {
        memcpy(room->more, place, (size_t)n * sizeof place[0]);
        memset(place, 0, (size_t)n * sizeof place[0]);
        add_product(n, n, 1.0, c.factors, room->more, place);
    }
    memset(room->free, 0, 2 * (size_t)p * sizeof place[0]); /* the rates behind them */
    add_product(p, n, 1.0, r->B, place, room->free);
    add_product(p, n, 1.0, r->B, room->late, room->history);
}

/* As fmax of numbers, which compilers call a library for. */
static double larger(double a, double b)
{
    return b > a ? b : a;
}

/* What an imbalance is measured by. */
static double size_of(const Rotor *r, const double applied[], const double state[])
{
    const RotorLayout at = rotor_layout(r);
    double most = r->floor;
    int i;
    for (i = 0; i < r->freedoms; i++) {
        most = larger(most, larger(fabs(applied[i]), fabs(state[at.applied + (size_t)i])));
    }
    for (i = 0; i < r->points; i++) {
        most = larger(most, fabs(state[at.carried + (size_t)i]));
    }
    return most;
}

/* Newton's method for D (r - free) + weight F = 0 from r; the points' rates are gain r + history. */
static const char *balance(const Rotor *r, const Method *m, const double applied[], double state[], double work[], const Room *room,
                           Search *search)
{
    enum { MOST = 30 };
    const Condensed c = condensed(r, state);
    const double allowed = r->allowed > 0.0 ? r->allowed : r->balanced * size_of(r, applied, state);
    const double rounding = r->allowed > 0.0 ? 0.0 : by_rounding;
    const int p = r->points;
    double previous = HUGE_VAL;
    int n, i, k;
    memset(room->step, 0, (size_t)p * sizeof room->step[0]);
    for (n = 0; n < MOST; n++) {
        double error = 0.0, noise = 0.0;
        const char *reason;
        for (i = 0; i < p; i++) {
            room->velocity[i] = m->velocity[0] * room->r[i] + room->history[i];
        }
        search->presses = n + 1;
        reason = supports_press(r, state, work, room->r, room->velocity, room->carried, &search->refused);
        if (reason != NULL) {
            return reason;
        }
        for (i = 0; i < p; i++) {
            double off = m->weight * room->carried[i];
            for (k = 0; k < p; k++) {
                const double stiffness = c.D[i * p + k], r_k = room->r[k], free = room->free[k];
                off += stiffness * (r_k - free);
                noise = larger(noise, fabs(stiffness) * larger(fabs(r_k), fabs(free)));
            }
            room->off[i] = off;
            error += off * off;
        }
        error = sqrt(error);
        if (!isfinite(error)) {
            return no_number;
        }
        if (error <= allowed + rounding * noise) {
            return NULL;
        }
        if (error > overshoot * previous) {
            for (i = 0; i < p; i++) {
                room->step[i] *= 0.5;
                room->r[i] -= room->step[i];
            }
            continue;
        }
        previous = error;
        supports_slopes(r, work, m->velocity[0], room->slopes);
        for (i = 0; i < p * p; i++) {
            room->slopes[i] = c.D[i] + m->weight * room->slopes[i];
        }
        if (!factorise(p, room->slopes, room->pivot)) {
            break;
        }
        for (i = 0; i < p; i++) {
            room->step[i] = -room->off[i];
        }
        substitute(p, room->slopes, room->pivot, room->step);
        for (i = 0; i < p; i++) {
            room->r[i] += room->step[i];
        }
    }
    return "the forces of the supports find no balance: a shorter inner_step can help";
}

/* ---- a step, in parts and whole ---- */

void rotor_renew(const Rotor *r, double state[])
{
    *condensed(r, state).h = 0.0;
}

double rotor_gain(double rho, double h)
{
    return method_of(rho, h).velocity[0];
}

const char *rotor_free_step(const Rotor *r, const double applied[], double h, double omega, double state[], double work[],
                            FreeStep *step)
{
    const Condensed c = condensed(r, state);
    const Room own = room(r, work);
    const Method *m = c.method;
    if (*c.h != h || (r->G != NULL && *c.omega != omega)) {
        const char *reason;
        *c.method = method_of(r->rho, h);
        reason = condense(r, m, h, omega, state, &own);
        if (reason != NULL) {
            return reason;
        }
    }
    free_place(r, m, omega, applied, state, &own);
    step->gain = m->velocity[0];
    step->weight = m->weight;
    step->free = own.free;
    step->history = own.history;
    step->stiffness = c.D;
    return NULL;
}

const char *rotor_end_step(const Rotor *r, const double applied[], const double place[], const double reaction[],
                           const double carried[], double state[], double work[])
{
    const RotorLayout at = rotor_layout(r);
    const Condensed c = condensed(r, state);
    const Room own = room(r, work);
    const Method *m = c.method;
    double *d = state + at.place, *v = state + at.velocity, *a = state + at.acceleration, *past = state + at.past;
    const int n = r->freedoms, p = r->points;
    int i, j, finite = 1;
    for (j = 0; j < p; j++) {
        const double push = m->weight * reaction[j];
        for (i = 0; i < n; i++) {
            own.place[i] -= push * c.columns[j * n + i];
        }
    }
    for (i = 0; i < n; i++) {
        const double old = d[i], rate = v[i], new = own.place[i];
        d[i] = new;
        v[i] = m->velocity[0] * new + (m->velocity[1] * old + m->velocity[2] * rate + m->velocity[3] * a[i]);
        a[i] = m->acceleration[0] * new + m->acceleration[1] * old + m->acceleration[2] * rate + m->acceleration[3] * a[i];
        state[at.applied + (size_t)i] = applied[i];
        finite &= isfinite(d[i]) && isfinite(v[i]) && isfinite(a[i]);
    }
    memmove(past + p, past, 2 * (size_t)p * sizeof past[0]);
    memcpy(past, place, (size_t)p * sizeof past[0]);
    memcpy(state + at.carried, carried, (size_t)p * sizeof past[0]);
    return finite ? NULL : no_number;
}

const char *rotor_move(const Rotor *r, const double applied[], double h, double omega, double after, double state[], double work[],
                       Search *search)
{
    const RotorLayout at = rotor_layout(r);
    const Room own = room(r, work);
    const double *past = state + at.past;
    const int p = r->points;
    const char *reason;
    FreeStep step;
    int j;
    search->presses = 0;
    search->refused = -1;
    reason = rotor_free_step(r, applied, h, omega, state, work, &step);
    if (reason == NULL && p > 0) {
        for (j = 0; j < p; j++) {
            own.r[j] = 3.0 * (past[j] - past[p + j]) + past[2 * p + j];
        }
        supports_begin(r, state, work, h, after);
        reason = balance(r, condensed(r, state).method, applied, state, work, &own, search);
    }
    if (reason == NULL && p > 0) {
        reason = supports_accept(r, state, work, &search->refused);
    }
    return reason == NULL ? rotor_end_step(r, applied, own.r, own.carried, own.carried, state, work) : reason;
}

/* ---- the shaft ---- */

/* Speed at the end of a step. What resists goes on as in the last two steps, and holds a shaft that stands; with supports inside
 * a shaft does not turn backwards. */
static double speed_after(const Rotor *r, const Acting *end, double h, const double shaft[])
{
    const double omega = shaft[SHAFT_SPEED], inertia = r->mass * r->inertia;
    double drive, drag, after;
    if (r->inertia == 0.0) {
        return end->omega;
    }
    drive = end->torque - 1.5 * shaft[SHAFT_RESISTED] + 0.5 * shaft[SHAFT_RESISTED + 1];
    drag = end->drag;
    after = omega + h * (drive - (omega > 0.0 || (omega == 0.0 && drive > 0.0) ? drag : -drag)) / inertia;
    if (drag > 0.0 && fabs(drive) <= drag && after * omega <= 0.0) {
        after = 0.0;
    }
    return r->supports > 0 ? fmax(after, 0.0) : after;
}

/* Adds to the angle, which must not lose a little in every step. */
static void turn(double shaft[], double by)
{
    const double old = shaft[SHAFT_ANGLE], more = by + shaft[SHAFT_ANGLE_REST];
    shaft[SHAFT_ANGLE] = old + more;
    shaft[SHAFT_ANGLE_REST] = more - (shaft[SHAFT_ANGLE] - old);
}

void rotor_begin(const Rotor *r, const Acting *now, const Acting *end, double h, double state[], double work[])
{
    const RotorLayout at = rotor_layout(r);
    const Room own = room(r, work);
    double *shaft = state + at.shaft, *applied = own.place, *net = own.more, *before = state + at.applied;
    int i, changed = 0;
    if (shaft[SHAFT_MOVING] == 0.0) {
        rotor_swing(r, shaft[SHAFT_ANGLE], state + at.swing);
        shaft[SHAFT_SPIN] = (speed_after(r, end, h, shaft) - shaft[SHAFT_SPEED]) / h;
    }
    rotor_applied(r, now->given, now->unbalance, state + at.swing, shaft[SHAFT_SPEED], shaft[SHAFT_SPIN], applied);
    if (shaft[SHAFT_MOVING] == 0.0) {
        memcpy(net, applied, (size_t)r->freedoms * sizeof net[0]);
        rotor_resist(r, shaft[SHAFT_SPEED], state + at.place, state + at.velocity, net);
        rotor_take(r, state + at.carried, 1.0, net);
    } else {
        for (i = 0; i < r->freedoms; i++) {
            net[i] = applied[i] - before[i];
            changed |= net[i] != 0.0;
        }
    }
    if (shaft[SHAFT_MOVING] == 0.0) {
        rotor_accelerate(r, net, state + at.acceleration);
    } else if (changed) {
        rotor_accelerate(r, net, own.damped);
        for (i = 0; i < r->freedoms; i++) {
            state[at.acceleration + (size_t)i] += own.damped[i];
        }
    }
    memcpy(before, applied, (size_t)r->freedoms * sizeof before[0]);
    shaft[SHAFT_MOVING] = 1.0;
}

const char *rotor_step(const Rotor *r, const Acting *end, double h, double state[], double work[])
{
    const RotorLayout at = rotor_layout(r);
    double *shaft = state + at.shaft, *applied = room(r, work).applied;
    const double omega = shaft[SHAFT_SPEED], after = speed_after(r, end, h, shaft), middle = 0.5 * (omega + after);
    const char *reason;
    Search search;
    if (!(after >= 0.0) && r->supports > 0) {
        return "speed must be >= 0 rad/s";
    }
    shaft[SHAFT_SPIN] = (after - omega) / h;
    turn(shaft, 0.5 * h * (omega + after));
    shaft[SHAFT_SPEED] = after;
    rotor_swing(r, shaft[SHAFT_ANGLE], state + at.swing);
    rotor_applied(r, end->given, end->unbalance, state + at.swing, after, shaft[SHAFT_SPIN], applied);
    reason = rotor_move(r, applied, h, middle, after, state, work, &search);
    if (r->inertia != 0.0) {
        shaft[SHAFT_RESISTED + 1] = shaft[SHAFT_RESISTED];
        shaft[SHAFT_RESISTED] = supports_torque(r, state)
                                + rotor_slowed(r, end->unbalance, state + at.swing, state + at.acceleration);
    }
    return reason;
}
