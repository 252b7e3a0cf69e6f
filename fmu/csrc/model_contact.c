/* Contact element: cubic spring and viscous damper, without tension. Equations: README.md. */
#include <math.h>
#include <stddef.h>

#include "model.h"

/* A function of the approach with its first two derivatives. */
typedef struct {
    double value, slope, curvature;
} Jet;

/* Force and its derivatives; all zero where the surfaces have parted. */
typedef struct {
    double force;
    double stiffness, damping;                   /* dF/du, dF/du' */
    double stiffness_approach, stiffness_rate;   /* d2F/du2, d2F/du du' = d(damping)/du */
} Response;

static const Jet nothing = {0.0, 0.0, 0.0};

/* g(u) = K1 u + K2 u^2 + K3 u^3 */
static Jet polynomial(const Model *m, double u)
{
    Jet g;
    g.value = u * (m->K1 + u * (m->K2 + u * m->K3));
    g.slope = m->K1 + u * (2.0 * m->K2 + u * 3.0 * m->K3);
    g.curvature = 2.0 * m->K2 + 6.0 * m->K3 * u;
    return g;
}

/* Distance from the zero of the Hertz-like continuation to the end of the interval. */
static double reach(Jet end)
{
    return 1.5 * end.value / end.slope;
}

/* A (u - o)_+^(3/2), with value and slope of the polynomial at the end of the interval. */
static Jet continuation(const Model *m, double end, double u)
{
    const Jet g = polynomial(m, end);
    const double length = reach(g);
    const double x = u - (end - length);
    const double amplitude = g.value / (length * sqrt(length));
    Jet f = nothing;
    if (x > 0.0) {
        const double root = sqrt(x);
        f.value = amplitude * x * root;
        f.slope = 1.5 * amplitude * root;
        f.curvature = 0.75 * amplitude / root;
    }
    return f;
}

static Jet spring(const Model *m, double u)
{
    if (u > m->high) {
        return continuation(m, m->high, u);
    }
    if (u < m->low) {
        return continuation(m, m->low, u);
    }
    return polynomial(m, u);
}

/* c(u) = C1 S(s), s = (u - o)/(low - o), S = 3 s^2 - 2 s^3 on 0..1. */
static Jet damper(const Model *m, double u)
{
    const double length = reach(polynomial(m, m->low));
    const double s = (u - (m->low - length)) / length;
    Jet c = nothing;
    if (u >= m->low) {
        c.value = m->C1;
    } else if (s > 0.0) {
        c.value = m->C1 * (s * s * (3.0 - 2.0 * s));
        c.slope = m->C1 * (6.0 * s * (1.0 - s)) / length;
        c.curvature = m->C1 * (6.0 - 12.0 * s) / (length * length);
    }
    return c;
}

/* F = max(0, g(u) + c(u) u') */
static Response respond(const Model *m)
{
    const Jet g = spring(m, m->approach);
    const Jet c = damper(m, m->approach);
    const double force = g.value + c.value * m->rate;
    Response r = {0.0, 0.0, 0.0, 0.0, 0.0};
    if (force > 0.0) {
        r.force = force;
        r.stiffness = g.slope + c.slope * m->rate;
        r.damping = c.value;
        r.stiffness_approach = g.curvature + c.curvature * m->rate;
        r.stiffness_rate = c.slope;
    }
    return r;
}

/* Address of an input or parameter, NULL for any other reference. */
static const double *settable(const Model *m, unsigned int reference)
{
    switch (reference) {
    case VR_approach: return &m->approach;
    case VR_rate: return &m->rate;
    case VR_K1: return &m->K1;
    case VR_K2: return &m->K2;
    case VR_K3: return &m->K3;
    case VR_C1: return &m->C1;
    case VR_low: return &m->low;
    case VR_high: return &m->high;
    default: return NULL;
    }
}

void model_start(Model *m)
{
    m->approach = START_approach;
    m->rate = START_rate;
    m->K1 = START_K1;
    m->K2 = START_K2;
    m->K3 = START_K3;
    m->C1 = START_C1;
    m->low = START_low;
    m->high = START_high;
}

ModelResult model_get_real(const Model *m, unsigned int reference, double *value)
{
    const double *stored = settable(m, reference);
    Response r;
    if (stored != NULL) {
        *value = *stored;
        return MODEL_OK;
    }
    if (reference != VR_force && reference != VR_stiffness && reference != VR_damping) {
        return MODEL_UNKNOWN;
    }
    if (model_fault(m) != NULL) {
        return MODEL_UNAVAILABLE;
    }
    r = respond(m);
    *value = reference == VR_force ? r.force : reference == VR_stiffness ? r.stiffness : r.damping;
    return MODEL_OK;
}

ModelResult model_set_real(Model *m, unsigned int reference, double value)
{
    switch (reference) {
    case VR_approach: m->approach = value; return MODEL_OK;
    case VR_rate: m->rate = value; return MODEL_OK;
    case VR_K1: m->K1 = value; return MODEL_OK;
    case VR_K2: m->K2 = value; return MODEL_OK;
    case VR_K3: m->K3 = value; return MODEL_OK;
    case VR_C1: m->C1 = value; return MODEL_OK;
    case VR_low: m->low = value; return MODEL_OK;
    case VR_high: m->high = value; return MODEL_OK;
    case VR_force:
    case VR_stiffness:
    case VR_damping: return MODEL_READ_ONLY;
    default: return MODEL_UNKNOWN;
    }
}

ModelResult model_get_boolean(const Model *m, unsigned int reference, int *value)
{
    if (reference != VR_outside_validity) {
        return MODEL_UNKNOWN;
    }
    *value = !(m->low <= m->approach && m->approach <= m->high);
    return MODEL_OK;
}

ModelResult model_partial(const Model *m, unsigned int unknown, unsigned int known, double *value)
{
    const int by_rate = known == VR_rate;
    Response r;
    if (known != VR_approach && known != VR_rate) {
        return MODEL_UNKNOWN;
    }
    if (model_fault(m) != NULL) {
        return MODEL_UNAVAILABLE;
    }
    r = respond(m);
    switch (unknown) {
    case VR_force: *value = by_rate ? r.damping : r.stiffness; return MODEL_OK;
    case VR_stiffness: *value = by_rate ? r.stiffness_rate : r.stiffness_approach; return MODEL_OK;
    case VR_damping: *value = by_rate ? 0.0 : r.stiffness_rate; return MODEL_OK;
    default: return MODEL_UNKNOWN;
    }
}

const char *model_fault(const Model *m)
{
    Jet low, high;
    Response r;
    if (!(isfinite(m->approach) && isfinite(m->rate))) {
        return "approach and rate must be finite";
    }
    if (!(isfinite(m->K1) && isfinite(m->K2) && isfinite(m->K3) && isfinite(m->low) && isfinite(m->high))) {
        return "K1, K2, K3, low and high must be finite";
    }
    if (!(isfinite(m->C1) && m->C1 >= 0.0)) {
        return "C1 must be finite and >= 0";
    }
    if (!(m->low < m->high)) {
        return "low must be below high";
    }
    low = polynomial(m, m->low);
    high = polynomial(m, m->high);
    if (!(low.value > 0.0 && low.slope > 0.0 && high.value > 0.0 && high.slope > 0.0)) {
        return "the spring polynomial must be positive and rising at low and at high";
    }
    r = respond(m);
    if (!(isfinite(r.force) && isfinite(r.stiffness) && isfinite(r.damping))) {
        return "the force is too large for a floating-point number";
    }
    return NULL;
}

const char *model_notice(const Model *m)
{
    if (m->approach < m->low) {
        return "approach is below the validity interval (low): Hertz-like continuation in use";
    }
    if (m->approach > m->high) {
        return "approach is above the validity interval (high): Hertz-like continuation in use";
    }
    return NULL;
}
