"""The film law of the elements with memory, as compiled kernels: dry spring on a film that remembers.

    F = (g(u) + m)_+^(3/2),    g = F_s(u)^(2/3) = u + h_s

F_s is the static force, h_s the film it carries, and m the film that motion has added or taken. All memory runs
in the contact's own time sigma, d sigma = dT/theta with theta = F_s^(1/3), because the contact that the film has
to cross grows with the load. With i = du/d sigma:

    inlet   s' = p_i (i - s)
    fast    y' = p_f (i - y)
    chain   q_1' = nu (phi(s) - q_1),  q_k' = nu (q_(k-1) - q_k),     phi(s) = s + beta s^2/(1 + |beta s|)
    m = c i + g_i s + g_f y + sum_k g_k q_k

The chain carries the film made at the inlet through the contact, its gains weigh how much of it is felt at which
age. phi is monotone and above -1/beta: opening cannot take away more film than there is. Between the ends of a
step u is the cubic through both approaches and rates; for that every filter is advanced exactly, so a step of
any length is stable and a long one ends on the static force plus damping. In continuous time (`film_rates`) the
states are s, y and q_1 ...; all zero at rest.
"""

from __future__ import annotations

from math import exp, log, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import jit_exact
from reduced_models.elements.jet import Jet, half, minus, over, plus, root, through, through3, times

_Floats = NDArray[np.float64]

THETA, RATE, APPROACH, INLET, FAST, CHAIN = range(6)  # entries of a state; the chain is the rest
NOTHING = -400.0  # ln of a force that is none
DIRECT = 3  # gains before those of the chain: viscous, inlet, fast


class FilmLaw(NamedTuple):
    """Static curve, rates of the filters and their gains over the load."""

    x: _Floats  # (n,) ln F_s, increasing
    y: _Floats  # (n,) ln h_s
    slope: _Floats  # (n,) dy/dx
    u: _Floats  # (n,) approach at the nodes, increasing
    gain_x: _Floats  # (k,) ln F_s of the rows of gains
    gains: _Floats  # (k, DIRECT + lags)
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    inlet_saturation: float  # beta


@jit_exact
def _film(x, law):
    """Film h_s and dh_s/dx at x = ln F: Hermite between the nodes, straight beyond them."""
    n = law.x.size
    if x <= law.x[0]:
        h = exp(law.y[0] + law.slope[0] * (x - law.x[0]))
        return h, h * law.slope[0]
    if not x < law.x[n - 1]:  # or not a number
        h = exp(law.y[n - 1] + law.slope[n - 1] * (x - law.x[n - 1]))
        return h, h * law.slope[n - 1]
    k = np.searchsorted(law.x, x) - 1
    w = law.x[k + 1] - law.x[k]
    t = (x - law.x[k]) / w
    d = law.y[k + 1] - law.y[k]
    a, b = w * law.slope[k] - d, d - w * law.slope[k + 1]
    y = law.y[k] + t * d + t * (1.0 - t) * ((1.0 - t) * a + t * b)
    dy = d + (1.0 - 2.0 * t) * ((1.0 - t) * a + t * b) + t * (1.0 - t) * (b - a)
    h = exp(y)
    return h, h * dy / w


@jit_exact
def static(u, law):
    """Give ln F_s, g = F_s^(2/3) and dg/du at approach `u`, by safeguarded Newton steps in ln F_s."""
    n = law.x.size
    low, high = -np.inf, np.inf
    if u < law.u[0]:
        high = law.x[0]
        x = high
        if -u > exp(law.y[0]):  # F hardly matters there: h_s is nearly -u
            x += (log(-u) - law.y[0]) / law.slope[0]
            if x < NOTHING:
                return NOTHING, exp(2.0 / 3.0 * NOTHING), 0.0
    elif not u < law.u[n - 1]:  # or not a number
        low = law.x[n - 1]
        x = low
    else:
        k = np.searchsorted(law.u, u, side="right") - 1
        low, high = law.x[k], law.x[k + 1]
        x = low + (high - low) * (u - law.u[k]) / (law.u[k + 1] - law.u[k])
    g, du = 0.0, 1.0
    for _ in range(100):
        g = exp(2.0 / 3.0 * x)
        h, dh = _film(x, law)
        du = 2.0 / 3.0 * g - dh
        r = g - h - u
        if r > 0.0:
            high = min(high, x)
        else:
            low = max(low, x)
        new = x - min(max(r / du, -2.0), 2.0)
        if not low <= new <= high:
            new = 0.5 * (low + high)
        step = new - x
        x = new
        if abs(step) <= 1e-13 * (1.0 + abs(x)):
            break
    g = exp(2.0 / 3.0 * x)
    return x, g, 2.0 / 3.0 * g / (2.0 / 3.0 * g - _film(x, law)[1])


@jit_exact
def _residence(mu, n, poisson, share):
    """Poisson weights of mean `mu`, and the share of what entered within mu that j lags have passed on."""
    poisson[0] = exp(-mu)
    for k in range(1, n + 1):
        poisson[k] = poisson[k - 1] * mu / k
    if mu < n:  # from the far end, or small shares would drown in rounding
        term, total, k = poisson[n], poisson[n], n
        while term > 1e-17 * total:
            k += 1
            term *= mu / k
            total += term
        share[n] = total
        for k in range(n - 1, -1, -1):
            share[k] = share[k + 1] + poisson[k]
    else:
        share[0] = 1.0
        for k in range(1, n + 1):
            share[k] = share[k - 1] - poisson[k - 1]


@jit_exact
def _moments(j, mu, poisson, share):
    """Response of j lags to inputs 1, t and t^2 of age t (1 at the start of the step), and d/d mu of each."""
    r1 = j * share[j + 1] / mu
    r2 = j * (j + 1) * share[j + 2] / (mu * mu)
    d1 = (j * poisson[j] - r1) / mu
    d2 = (j * (j + 1) * poisson[j + 1] / mu - 2.0 * r2) / mu
    return share[j], r1, r2, poisson[j - 1], d1, d2


@jit_exact
def _one_lag(old, start, end, bump, rate, span, poisson, share):
    """Jet of one lag after input start + (end - start) s + 6 bump s (1 - s); end, bump and span are jets."""
    mu = rate * span.x
    _residence(mu, 3, poisson, share)
    r0, r1, r2, d0, d1, d2 = _moments(1, mu, poisson, share)
    value = old * poisson[0] + start * r1 + end.x * (r0 - r1) + 6.0 * bump.x * (r1 - r2)
    slope = -old * poisson[0] + start * d1 + end.x * (d0 - d1) + 6.0 * bump.x * (d1 - d2)
    return through3(value, slope * rate, span, r0 - r1, end, 6.0 * (r1 - r2), bump)


@jit_exact
def film_entering(s, beta):
    """phi(s), the film that enters the chain, and its derivative."""
    b = beta * s
    d = 1.0 + abs(b)
    return s + b * s / d, 1.0 + b * (1.0 + d) / (d * d)


@jit_exact
def _made(s, beta):
    """Phi of a jet."""
    x, slope = film_entering(s.x, beta)
    return through(x, slope, s)


@jit_exact
def _passed_on(j, states, poisson):
    """What lag `j` now has of what it and the lags before it held at the start; the same of those before alone."""
    held, held_before = 0.0, 0.0
    for i in range(j):
        held += poisson[i] * states[CHAIN + j - 1 - i]
        if i < j - 1:
            held_before += poisson[i] * states[CHAIN + j - 2 - i]
    return held, held_before


@jit_exact
def _between(x, law):
    """Rows of gains on both sides of x = ln F, weight of the second, and its slope."""
    rows = law.gain_x.size
    if rows == 1 or x <= law.gain_x[0]:
        return 0, min(1, rows - 1), 0.0, 0.0
    if not x < law.gain_x[rows - 1]:
        return rows - 2, rows - 1, 1.0, 0.0
    row = np.searchsorted(law.gain_x, x) - 1
    per_x = 1.0 / (law.gain_x[row + 1] - law.gain_x[row])
    return row, row + 1, (x - law.gain_x[row]) * per_x, per_x


@jit_exact
def _weighed(k, q, law, between, x_u):
    """Filter `k` times its gain at the load, whose ln F has the slope `x_u`."""
    row, after, weight, per_x = between
    below, above = law.gains[row, k], law.gains[after, k]
    return times(Jet(below * (1.0 - weight) + above * weight, (above - below) * per_x * x_u, 0.0), q)


@jit_exact
def film_step(law, old, new, dt, u, v):
    """Advance the state `old` into `new`; returns F, dF/du and dF/dv at the end of the step."""
    lags = law.gains.shape[1] - DIRECT
    x, g_x, g_u = static(u, law)
    g = Jet(g_x, g_u, 0.0)
    # own time and own rate at the end
    theta = root(g)
    start, end = old[RATE], times(theta, Jet(v, 0.0, 1.0))
    span = Jet(0.5 * dt * (1.0 / old[THETA] + 1.0 / theta.x), -0.5 * dt * theta.u / (theta.x * theta.x), 0.0)
    # what the straight line between both rates misses of the change of approach
    travel = Jet(u - old[APPROACH], 1.0, 0.0)
    bump = minus(over(travel, span), half(start, end))

    poisson, share = np.empty(lags + 3), np.empty(lags + 3)
    p = law.inlet_rate
    s = _one_lag(old[INLET], start, end, bump, p, span, poisson, share)
    y = _one_lag(old[FAST], start, end, bump, law.fast_rate, span, poisson, share)

    # the film made: its ends, and a bump that keeps its mean, which the balance of the inlet lag gives
    mean = (travel.x - (s.x - old[INLET]) / p) / span.x
    entered = Jet(mean, (travel.u - s.u / p - mean * span.u) / span.x, -s.v / (p * span.x))
    f0 = film_entering(old[INLET], law.inlet_saturation)[0]
    f, f_s = film_entering(s.x, law.inlet_saturation)
    hump = minus(_made(entered, law.inlet_saturation), _made(half(old[INLET], s), law.inlet_saturation))

    between, x_u = _between(x, law), 1.5 * g.u / g.x
    m = _weighed(0, end, law, between, x_u)
    m = plus(m, _weighed(1, s, law, between, x_u))
    m = plus(m, _weighed(2, y, law, between, x_u))
    mu = through(law.lag_rate * span.x, law.lag_rate, span)
    _residence(mu.x, lags + 2, poisson, share)
    for j in range(1, lags + 1):
        held, held_before = _passed_on(j, old, poisson)
        r0, r1, r2, d0, d1, d2 = _moments(j, mu.x, poisson, share)
        value = held + f0 * r1 + f * (r0 - r1) + 6.0 * hump.x * (r1 - r2)
        slope = held_before - held + f0 * d1 + f * (d0 - d1) + 6.0 * hump.x * (d1 - d2)
        q = through3(value, slope, mu, (r0 - r1) * f_s, s, 6.0 * (r1 - r2), hump)
        m = plus(m, _weighed(DIRECT - 1 + j, q, law, between, x_u))
        new[CHAIN + j - 1] = value
    new[THETA], new[RATE], new[APPROACH], new[INLET], new[FAST] = theta.x, end.x, u, s.x, y.x
    w = plus(g, m)
    if w.x <= 0.0:
        return 0.0, 0.0, 0.0
    w_root = sqrt(w.x)
    return w.x * w_root, 1.5 * w_root * w.u, 1.5 * w_root * w.v


@jit_exact
def film_rest(law, u, state):
    """Make `state` that of rest at approach `u`; returns the static force."""
    g = static(u, law)[1]
    state[:] = 0.0
    state[THETA], state[APPROACH] = sqrt(g), u
    return g * sqrt(g)


@jit_exact
def film_drive(law, T, u, v, force):
    """Force along a whole record that starts from rest at u[0], moving at v[0] from then on."""
    state = np.empty(CHAIN + law.gains.shape[1] - DIRECT)
    other = np.empty_like(state)
    force[0] = film_rest(law, u[0], state)
    state[RATE] = state[THETA] * v[0]
    for i in range(1, T.size):
        force[i] = film_step(law, state, other, T[i] - T[i - 1], u[i], v[i])[0]
        state, other = other, state


@jit_exact
def _gain(law, x, k):
    """Gain k at x = ln F."""
    if law.gain_x.size == 1:
        return law.gains[0, k]
    return np.interp(x, law.gain_x, np.ascontiguousarray(law.gains[:, k]))


@jit_exact
def _remembered(law, x, states):
    """Film that the states add."""
    film = 0.0
    for k in range(states.size):
        film += _gain(law, x, k + 1) * states[k]
    return film


@jit_exact
def film_rates(law, states, u, v, rates):
    """Force at approach `u` and rate `v`; fills the time derivatives of the states."""
    x, g, _ = static(u, law)
    theta = sqrt(g)
    i = theta * v
    rates[0] = law.inlet_rate * (i - states[0]) / theta
    rates[1] = law.fast_rate * (i - states[1]) / theta
    fed = film_entering(states[0], law.inlet_saturation)[0]
    for k in range(DIRECT - 1, states.size):
        rates[k] = law.lag_rate * (fed - states[k]) / theta
        fed = states[k]
    w = g + _gain(law, x, 0) * i + _remembered(law, x, states)
    return w * sqrt(w) if w > 0.0 else 0.0


@jit_exact
def film_rate(law, states, u, force):
    """Rate at which the contact carries `force` > 0 at approach `u`."""
    x, g, _ = static(u, law)
    return (force ** (2.0 / 3.0) - g - _remembered(law, x, states)) / (_gain(law, x, 0) * sqrt(g))


@jit_exact
def static_forces(law, u, force):
    """Static force at every approach of the array `u`."""
    for i in range(u.size):
        force[i] = exp(1.5 * log(static(u[i], law)[1]))


@jit_exact
def films(law, x, h, du):
    """Film h_s and slope du_s/dx at every x = ln F of an array."""
    for i in range(x.size):
        h[i], dh = _film(x[i], law)
        du[i] = 2.0 / 3.0 * exp(2.0 / 3.0 * x[i]) - dh
