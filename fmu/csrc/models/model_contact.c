/* Contact elements without memory: a spring beside a damper, never pulling. The law of reduced_models.elements.spring_law;
 * equations in README.md. Macros of config.h say which terms there are: LAW_POWER, LAW_SEVEN, LAW_LEVELS_OFF. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "dual.h"
#include "validity.h"

/* What of the law follows from the parameters alone. */
typedef struct {
    Dual low, high, o_low, A_low, o_high, A_high;
    Dual K1, K2, K3, K, n, u0, F0;
    Dual C1, C2, C3, B4, rate;
} Law;

/* A force with its slope, both along the direction of the duals. */
typedef struct {
    Dual value, slope;
} Curve;

typedef struct {
    Dual force, stiffness, damping;
    double indicator;
} Response;

static const Fault fine = {FINE, NULL};

/* ---- the spring between the ends ---- */

/* K1 u + K2 u^2 + K3 u^3, or K (u + u0)^n + F0 */
static Curve inside(Dual u, const Law *law)
{
    Curve c;
    if (LAW_POWER) {
        const Dual reach = add(u, law->u0), part = mul(law->K, power(reach, law->n));
        c.value = add(part, law->F0);
        c.slope = over(mul(law->n, part), reach);
        return c;
    }
    c.value = mul(u, add(law->K1, mul(u, add(law->K2, mul(u, law->K3)))));
    c.slope = add(law->K1, mul(u, add(times(2.0, law->K2), mul(u, times(3.0, law->K3)))));
    return c;
}

/* The slope of a cubic is a parabola: besides the ends, its vertex may be below zero. */
static Fault check_spring(const Law *law)
{
    if (LAW_POWER && !(law->K.x > 0.0 && law->n.x > 0.0)) {
        return fault(REFUSE, "K and n must be > 0");
    }
    if (LAW_POWER && !(law->low.x + law->u0.x > 0.0)) {
        return fault(REFUSE, "low + u0 must be > 0");
    }
    if (law->K3.x > 0.0) {
        const double vertex = -law->K2.x / (3.0 * law->K3.x);
        if (law->low.x < vertex && vertex < law->high.x && !(law->K1.x + law->K2.x * vertex > 0.0)) {
            return fault(REFUSE, "the spring must rise everywhere between low and high");
        }
    }
    return fine;
}

/* ---- the law ---- */

/* A (u - o)^(3/2) with value and slope of the spring at an end. */
static Fault join(Dual end, const Law *law, Dual *origin, Dual *factor)
{
    const Curve at = inside(end, law);
    Dual reach, length;
    if (!(at.value.x > 0.0 && at.slope.x > 0.0 && at.value.x <= DBL_MAX && at.slope.x <= DBL_MAX)) {
        return fault(REFUSE, "the spring must be positive and rising at low and at high");
    }
    reach = over(times(1.5, at.value), at.slope);
    *origin = sub(end, reach);
    if (!(reach.x > 0.0 && reach.x <= DBL_MAX && origin->x < end.x)) {
        return fault(REFUSE, "the spring is too steep or too flat at low or at high for a floating-point number");
    }
    length = mul(reach, root(reach));
    if (!(length.x > 0.0 && length.x <= DBL_MAX)) {
        return fault(REFUSE, "the spring is too steep or too flat at low or at high for a floating-point number");
    }
    *factor = over(at.value, length);
    return fine;
}

/* One parameter, seeded with a direction if there is one. */
static Dual read(const double value[], const double *seed, int reference)
{
    return dual(value[reference], seed != NULL ? seed[reference] : 0.0);
}

static void read_law(const double value[], const double *seed, Law *law)
{
    memset(law, 0, sizeof *law);
    LAW_READ; /* of config.h: which variable is which */
}

static Fault join_law(Law *law)
{
    const Fault f = join(law->low, law, &law->o_low, &law->A_low);
    return f.severity != FINE ? f : join(law->high, law, &law->o_high, &law->A_high);
}

/* Even powers of the rate cancel over a cycle; what is left must take energy out at every corner. */
static Fault check_damper(const Law *law)
{
    const double reach = 0.5 * (law->high.x - law->low.x);
    const double fastest = LAW_LEVELS_OFF ? law->rate.x : DBL_MAX;
    const double cubed = law->C3.x != 0.0 ? (law->C3.x * fastest) * fastest : 0.0;
    const double low = law->C1.x + law->B4.x * (law->low.x - reach);
    const double high = law->C1.x + law->B4.x * (law->high.x + reach);
    if (!LAW_SEVEN) {
        return law->C1.x >= 0.0 ? fine : fault(REFUSE, "C1 must be >= 0");
    }
    if (!(fastest > 0.0)) {
        return fault(REFUSE, "rate_max must be > 0");
    }
    if (!(low >= 0.0 && high >= 0.0 && low + cubed >= 0.0 && high + cubed >= 0.0)) {
        return fault(REFUSE, "the damper must take energy out of a cycle: C1 + B4 u + C3 rate^2 >= 0");
    }
    return fine;
}

/* Force and tangent of A (u - o)_+^(3/2). */
static Curve hertz(Dual reach, Dual factor)
{
    Curve c;
    c.value = c.slope = number(0.0);
    if (reach.x > 0.0) {
        const Dual r = root(reach);
        c.value = mul(factor, mul(reach, r));
        c.slope = times(1.5, mul(factor, r));
    }
    return c;
}

static Curve spring(Dual u, const Law *law)
{
    if (u.x > law->high.x) {
        return hertz(sub(u, law->o_high), law->A_high);
    }
    if (u.x < law->low.x) {
        return hertz(sub(u, law->o_low), law->A_low);
    }
    return inside(u, law);
}

/* Share of the damper: 1 from low upwards, 0 where the spring ends, S = 3 s^2 - 2 s^3 between. */
static Curve fade(Dual u, const Law *law)
{
    Curve c;
    c.value = number(u.x >= law->low.x ? 1.0 : 0.0);
    c.slope = number(0.0);
    if (u.x < law->low.x && u.x > law->o_low.x) {
        const Dual width = sub(law->low, law->o_low);
        const Dual s = over(sub(u, law->o_low), width);
        c.value = mul(mul(s, s), sub(number(3.0), times(2.0, s)));
        c.slope = over(times(6.0, mul(s, sub(number(1.0), s))), width);
    }
    return c;
}

/* x with slope 1 on [low, high]; beyond, it comes to rest within `reach`. */
static Curve saturate(Dual x, Dual low, Dual high, Dual reach)
{
    Curve c;
    c.value = x;
    c.slope = number(1.0);
    if (x.x > high.x) {
        const Dual t = level(over(sub(x, high), reach));
        c.value = add(high, mul(reach, t));
        c.slope = sub(number(1.0), mul(t, t));
    } else if (x.x < low.x) {
        const Dual t = level(over(sub(low, x), reach));
        c.value = sub(low, mul(reach, t));
        c.slope = sub(number(1.0), mul(t, t));
    }
    return c;
}

/* s(u) (C1 v + C2 v^2 + C3 v^3 + B4 u v), levelled off outside the box, and its slopes. */
static void damper(Dual u, Dual v, const Law *law, Dual *force, Dual *by_u, Dual *by_v)
{
    const Curve s = fade(u, law);
    *force = *by_u = *by_v = number(0.0);
    if (s.value.x == 0.0 && s.slope.x == 0.0) {
        return;
    }
    if (LAW_SEVEN) {
        const Curve at = saturate(u, law->low, law->high, times(0.5, sub(law->high, law->low)));
        const Dual c = add(law->C1, mul(law->B4, at.value));
        Curve w;
        Dual edge = v, slope, all;
        w.value = v;
        w.slope = number(1.0);
        if (LAW_LEVELS_OFF) {
            w = saturate(v, times(-1.0, law->rate), law->rate, law->rate);
            edge = v.x > law->rate.x ? law->rate : v.x < -law->rate.x ? times(-1.0, law->rate) : v;
        }
        slope = mul(edge, add(times(2.0, law->C2), times(3.0, mul(law->C3, edge))));
        all = add(mul(mul(edge, edge), add(law->C2, mul(law->C3, edge))), mul(slope, sub(w.value, edge)));
        all = add(mul(c, v), all);
        *force = mul(s.value, all);
        *by_u = add(mul(s.slope, all), mul(s.value, mul(law->B4, mul(at.slope, v))));
        *by_v = mul(s.value, add(c, mul(slope, w.slope)));
        return;
    }
    *force = mul(mul(law->C1, s.value), v);
    *by_u = mul(mul(law->C1, s.slope), v);
    *by_v = mul(law->C1, s.value);
}

/* F = (f + d)_+ with its tangents; all zero where the force would pull. */
static Response contact(Dual u, Dual v, const Law *law)
{
    const Curve f = spring(u, law);
    Dual d, d_u, d_v;
    Response r;
    damper(u, v, law, &d, &d_u, &d_v);
    r.force = add(f.value, d);
    r.stiffness = add(f.slope, d_u);
    r.damping = d_v;
    r.indicator = r.force.x;
    if (u.x <= law->o_low.x) { /* no force at all: how far the surfaces are apart, as the law's first slope has it */
        r.indicator = law->A_low.x * (u.x - law->o_low.x) * sqrt(law->low.x - law->o_low.x);
    }
    if (r.force.x <= 0.0) {
        r.force = r.stiffness = r.damping = number(0.0);
    }
    return r;
}

/* ---- functions of model.h ---- */

Fault model_prepare(Model *m)
{
    static const int parameters[] = {LAW_REFERENCES};
    Law law;
    Fault f;
    size_t i;
    for (i = 0; i < sizeof parameters / sizeof parameters[0]; i++) {
        if (!isfinite(m->value[parameters[i]])) {
            return fault(REFUSE, LAW_NAMES " must be finite");
        }
    }
    read_law(m->value, NULL, &law);
    if (!(law.low.x < law.high.x)) {
        return fault(REFUSE, "low must be below high");
    }
    f = check_damper(&law);
    if (f.severity == FINE) {
        f = check_spring(&law);
    }
    if (f.severity == FINE) {
        f = join_law(&law);
    }
    if (f.severity != FINE) {
        return f;
    }
    m->cache[0] = law.o_low.x;
    m->cache[1] = law.A_low.x;
    m->cache[2] = law.o_high.x;
    m->cache[3] = law.A_high.x;
    return isfinite(m->cache[1]) && isfinite(m->cache[3]) ? fine
        : fault(REFUSE, "the spring is too steep at low or at high for a floating-point number");
}

/* Response at some approach and rate, by the ends of the cache. */
static Response respond(const Model *m, double u, double v)
{
    Law law;
    read_law(m->value, NULL, &law);
    law.o_low = number(m->cache[0]);
    law.A_low = number(m->cache[1]);
    law.o_high = number(m->cache[2]);
    law.A_high = number(m->cache[3]);
    return contact(number(u), number(v), &law);
}

/* Outputs at some approach and rate, which become the model's. */
static Fault enter(Model *m, double u, double v)
{
    const Response r = respond(m, u, v);
    /* the indicator is the force before it is clipped: a force that is inf - inf shows there */
    if (!(isfinite(r.force.x) && isfinite(r.stiffness.x) && isfinite(r.damping.x) && isfinite(r.indicator))) {
        return fault(DISCARD, "the force is too large for a floating-point number");
    }
    m->input[VR_approach] = u;
    m->input[VR_rate] = v;
    m->indicator[0] = r.indicator;
    m->value[VR_force] = r.force.x;
    m->value[VR_stiffness] = r.stiffness.x;
    m->value[VR_damping] = r.damping.x;
    model_watch(m);
    return fine;
}

Fault model_evaluate(Model *m)
{
    return enter(m, m->input[VR_approach], m->input[VR_rate]);
}

Fault model_rates(Model *m)
{
    (void)m;
    return fine;
}

Fault model_step(Model *m, const Motion *motion, double h, double tolerance)
{
    (void)h, (void)tolerance; /* without memory only the end of a step counts */
    return enter(m, motion->input[VR_approach].end, motion->input[VR_rate].end);
}

void model_direction(const Model *m, const double seed[], double along[])
{
    Law law;
    Response r;
    read_law(m->value, seed, &law);
    if (join_law(&law).severity != FINE) {
        return;
    }
    r = contact(dual(m->input[VR_approach], seed[VR_approach]), dual(m->input[VR_rate], seed[VR_rate]), &law);
    along[VR_force] = r.force.d;
    along[VR_stiffness] = r.stiffness.d;
    along[VR_damping] = r.damping.d;
}
