"""Contact force of the film-memory elements: a dry Hertz spring on an oil film that lags behind the motion.

    F = (g(u) + m)_+^(3/2),    g = F_s(u)^(2/3) = u + h_s

F_s is the static force, h_s its film, and m the film that motion has added or taken. The film has to cross a
contact that grows with the load, so all filters run in a time sigma scaled by the size of the contact,
d sigma = dT/theta with theta = F_s^(1/3). With the rate i = du/d sigma in that time:

    inlet   s' = p_i (i - s)
    fast    y' = p_f (i - y)
    chain   q_k' = nu (q_(k-1) - q_k) + r (q_0 - q_k),   q_0 = G phi(s),   phi(s) = s + beta s^2/(1 + |beta s|)
    m = c i + g_i s + g_f y + sum_k (g_k/G) q_k,    G = sum_k |g_k|

The chain carries the film made at the inlet through the contact, and the shares g_k/G weigh the film of each age.
All gains depend on the load. G is that of the load at which the film is made: a film that closing surfaces trap
under a light load keeps its thickness while the load rises, until it has crossed the contact. About one load, and
so in all small motions, G cancels; with a single row of gains it is set to 1. phi is monotone and above -1/beta,
the saturation of the inlet: opening cannot take away more film than there is. An element for every load has a rim,
on closing an edge that moves into oil and makes film like its speed to the power of 2/3: phi = ((1 + 3/2 beta
s)^(2/3) - 1)/beta. Where its contact grows from theta_0 to theta, the share 1 - theta_0/theta of it is new, and
has film that the whole rim makes now, r = max(theta', 0)/theta; elsewhere r = 0. So film trapped by a fast return
fills the contact at once, and fades from then on. Between the ends of a step u is the cubic through both
approaches and rates, and every filter is advanced exactly (`film_filters`), so a step of any length is stable and
a long one ends on the static force plus damping. In continuous time (`film_rates`) the states are s, y and q_1
...; at rest all are zero.
"""

from __future__ import annotations

from math import exp, log, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import inner, jit_exact
from reduced_models.elements.film_filters import (
    CHAIN,
    DIRECT,
    FAST,
    INLET,
    chain_moments,
    filter_rates,
    lag_moments,
    pass_on,
    poisson_shares,
)
from reduced_models.elements.jet import Jet, half, minus, over, plus, root, through, through3, times

_Floats = NDArray[np.float64]

THETA, RATE, APPROACH = range(3)  # entries of a state before those of its filters; the rate is the own one
NOTHING = -400.0  # ln of a force that is none
LEAST_MADE = 1e-9  # added to G, so that shares of it exist where a row of gains has no chain


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
    rim: float  # film that the rim of a growing contact makes, over that of the inlet; 0: it does not


@jit_exact
def interval(knots, x):
    """Index of the last of the increasing `knots` below `x`, -1 where none is.

    Not np.searchsorted, which takes as long to compile as all of `film_step`.
    """
    low, high = 0, knots.size
    while low < high:
        middle = (low + high) // 2
        if knots[middle] < x:
            low = middle + 1
        else:
            high = middle
    return low - 1


@inner
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
    k = interval(law.x, x)
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
        k = interval(law.u, u)
        if law.u[k + 1] == u:
            k += 1
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


@inner
@jit_exact
def _one_lag(old, start, end, bump, rate, span):
    """Jet of one lag at the end of a step; end, bump and span are jets."""
    mu = rate * span.x
    kept, r0, r1, r2 = lag_moments(mu, 3.0)
    d1, d2 = (kept * mu - r1) / mu, (kept * mu - 2.0 * r2) / mu
    value = old * kept + start * r1 + end.x * (r0 - r1) + 6.0 * bump.x * (r1 - r2)
    slope = -old * kept + start * d1 + end.x * (kept - d1) + 6.0 * bump.x * (d1 - d2)
    return through3(value, slope * rate, span, r0 - r1, end, 6.0 * (r1 - r2), bump)


@jit_exact
def film_entering(s, saturation, rim):
    """phi(s), the film that enters the chain, and its derivative."""
    b = saturation * s
    if rim > 0.0 and b > 0.0:
        c = (1.0 + 1.5 * b) ** (1.0 / 3.0)
        return 1.5 * s * (c + 1.0) / (c * c + c + 1.0), 1.0 / c  # (c^2 - 1)/beta without a difference
    d = 1.0 + abs(b)
    return s + b * s / d, 1.0 + b * (1.0 + d) / (d * d)


@inner
@jit_exact
def _entering(s, law):
    """Film that enters the chain, of a jet."""
    x, slope = film_entering(s.x, law.inlet_saturation, law.rim)
    return through(x, slope, s)


@inner
@jit_exact
def _between(x, law):
    """Rows of gains on both sides of x = ln F, weight of the second, and its slope."""
    rows = law.gain_x.size
    if rows == 1 or x <= law.gain_x[0]:
        return 0, min(1, rows - 1), 0.0, 0.0
    if not x < law.gain_x[rows - 1]:
        return rows - 2, rows - 1, 1.0, 0.0
    row = interval(law.gain_x, x)
    per_x = 1.0 / (law.gain_x[row + 1] - law.gain_x[row])
    return row, row + 1, (x - law.gain_x[row]) * per_x, per_x


@inner
@jit_exact
def _gain(k, law, between):
    """Gain `k` at the load."""
    row, after, weight, _ = between
    return law.gains[row, k] * (1.0 - weight) + law.gains[after, k] * weight


@inner
@jit_exact
def _made(x, law):
    """Film that a unit of phi lets into the chain at x = ln F, and its slope."""
    if law.gain_x.size == 1:
        return 1.0, 0.0
    row, after, weight, per_x = _between(x, law)
    here, there = LEAST_MADE, LEAST_MADE
    for k in range(DIRECT, law.gains.shape[1]):
        here += abs(law.gains[row, k])
        there += abs(law.gains[after, k])
    return here + weight * (there - here), (there - here) * per_x


@inner
@jit_exact
def _weighed(k, q, law, between, x_u):
    """Filter `k` times its gain at the load, whose ln F has the slope `x_u`."""
    row, after, _, per_x = between
    slope = (law.gains[after, k] - law.gains[row, k]) * per_x * x_u
    return times(Jet(_gain(k, law, between), slope, 0.0), q)


@inner
@jit_exact
def _with_rim(q, stayed, passed, kept, rim):
    """Lag `q` of a contact that has grown, and kept the share `kept` of what it held at the start.

    Of `q`, `stayed` is what the lag would hold of the start; what came in by the inlet, the share `passed`, has
    grown half as long. The rest, so that all shares make 1, is film of the `rim`.
    """
    late = root(kept)
    fresh = minus(minus(Jet(1.0, 0.0, 0.0), kept), times(minus(late, kept), passed))
    return plus(plus(times(late, q), times(minus(kept, late), stayed)), times(fresh, rim))


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

    p = law.inlet_rate
    s = _one_lag(old[INLET], start, end, bump, p, span)
    y = _one_lag(old[FAST], start, end, bump, law.fast_rate, span)

    # the film made: its ends, and a bump that keeps its mean, which the balance of the inlet lag gives
    mean = (travel.x - (s.x - old[INLET]) / p) / span.x
    entered = Jet(mean, (travel.u - s.u / p - mean * span.u) / span.x, -s.v / (p * span.x))
    between, x_u = _between(x, law), 1.5 * g.u / g.x
    made0, (made_x, by_x) = _made(3.0 * log(old[THETA]), law)[0], _made(x, law)
    made = Jet(made_x, by_x * x_u, 0.0)
    f0 = made0 * film_entering(old[INLET], law.inlet_saturation, law.rim)[0]
    f = times(made, _entering(s, law))
    hump = minus(times(half(made0, made), _entering(entered, law)), half(f0, f))

    m = _weighed(0, end, law, between, x_u)
    m = plus(m, _weighed(1, s, law, between, x_u))
    m = plus(m, _weighed(2, y, law, between, x_u))
    mu = through(law.lag_rate * span.x, law.lag_rate, span)
    per_mu, poisson, share, held = 1.0 / mu.x, np.empty(lags + 3), np.empty(lags + 3), np.zeros(lags + 1)
    poisson_shares(mu.x, lags + 2, lags + 2.0, poisson, share)
    pass_on(old[CHAIN:], poisson, held[1:])
    grows = law.rim > 0.0 and theta.x > old[THETA]
    kept = Jet(1.0, 0.0, 0.0)  # of the contact, where it has grown
    if grows:
        kept = through(old[THETA] / theta.x, -old[THETA] / (theta.x * theta.x), theta)
    rim, carried = Jet(0.0, 0.0, 0.0), Jet(0.0, 0.0, 0.0)
    for j in range(1, lags + 1):
        r0, r1, r2 = chain_moments(j, per_mu, share)
        d0, d1 = poisson[j - 1], (j * poisson[j] - r1) * per_mu
        d2 = (j * (j + 1) * poisson[j + 1] * per_mu - 2.0 * r2) * per_mu
        value = held[j] + f0 * r1 + f.x * (r0 - r1) + 6.0 * hump.x * (r1 - r2)
        slope = held[j - 1] - held[j] + f0 * d1 + f.x * (d0 - d1) + 6.0 * hump.x * (d1 - d2)
        q = through3(value, slope, mu, r0 - r1, f, 6.0 * (r1 - r2), hump)
        if grows:
            stayed, passed = through(held[j], held[j - 1] - held[j], mu), through(r0, d0, mu)
            if j == 1:
                # What the first lag has got, a mean over the step that forgets: the film at the end of a long one.
                got = over(minus(q, stayed), passed)
                rim = Jet(law.rim * got.x, law.rim * got.u, law.rim * got.v)
            q = _with_rim(q, stayed, passed, kept, rim)
        carried = plus(carried, _weighed(DIRECT - 1 + j, q, law, between, x_u))
        new[CHAIN + j - 1] = q.x
    new[THETA], new[RATE], new[APPROACH], new[INLET], new[FAST] = theta.x, end.x, u, s.x, y.x
    w = plus(g, plus(m, over(carried, made)))
    if w.x <= 0.0:
        return 0.0, 0.0, 0.0
    w_root = sqrt(w.x)
    return w.x * w_root, 1.5 * w_root * w.u, 1.5 * w_root * w.v


@jit_exact
def film_rest(law, u, state):
    """Set `state` to rest at approach `u`; returns the static force."""
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


@inner
@jit_exact
def _film_of_states(law, between, made, states):
    """Film that the states add."""
    film, carried = 0.0, 0.0
    for k in range(DIRECT - 1):
        film += _gain(k + 1, law, between) * states[k]
    for k in range(DIRECT - 1, states.size):
        carried += _gain(k + 1, law, between) * states[k]
    return film + carried / made


@jit_exact
def film_rates(law, states, u, v, rates):
    """Force at approach `u` and rate `v`; fills the time derivatives of the states."""
    x, g, g_u = static(u, law)
    theta = sqrt(g)
    made, between = _made(x, law)[0], _between(x, law)
    fed = made * film_entering(states[0], law.inlet_saturation, law.rim)[0]
    filter_rates(law, fed, theta, v, states, rates)
    if law.rim > 0.0 and v > 0.0:
        for k in range(DIRECT - 1, states.size):
            rates[k] += 0.5 * g_u / g * v * (law.rim * fed - states[k])
    w = g + _gain(0, law, between) * (theta * v) + _film_of_states(law, between, made, states)
    return w * sqrt(w) if w > 0.0 else 0.0


@jit_exact
def film_rate(law, states, u, force):
    """Rate at which the contact carries `force` > 0 at approach `u`."""
    x, g, _ = static(u, law)
    between = _between(x, law)
    film = _film_of_states(law, between, _made(x, law)[0], states)
    return (force ** (2.0 / 3.0) - g - film) / (_gain(0, law, between) * sqrt(g))


@jit_exact
def film_made(x, law):
    """Film that a unit of phi lets into the chain at x = ln F."""
    return _made(x, law)[0]


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
