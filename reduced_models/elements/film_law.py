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
any length is stable and a long one ends on the static force plus damping.
"""

from __future__ import annotations

from math import exp, log, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

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
    squeeze: float  # beta


@njit(cache=True)
def _film(x, law):
    """Film h_s and dh_s/dx at x = ln F: Hermite between the nodes, straight beyond them."""
    n = law.x.size
    if x <= law.x[0]:
        h = exp(law.y[0] + law.slope[0] * (x - law.x[0]))
        return h, h * law.slope[0]
    if x >= law.x[n - 1]:
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


@njit(cache=True)
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
    elif u >= law.u[n - 1]:
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


@njit(cache=True)
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


@njit(cache=True)
def _moments(j, mu, poisson, share):
    """Response of j lags to inputs 1, t and t^2 of age t (1 at the start of the step), and d/d mu of each."""
    r1 = j * share[j + 1] / mu
    r2 = j * (j + 1) * share[j + 2] / (mu * mu)
    d1 = (j * poisson[j] - r1) / mu
    d2 = (j * (j + 1) * poisson[j + 1] / mu - 2.0 * r2) / mu
    return share[j], r1, r2, poisson[j - 1], d1, d2


@njit(cache=True)
def _one_lag(old, start, end, bump, mu, poisson, share):
    """One lag after input start + (end - start) s + 6 bump s (1 - s), with slopes to mu, end and bump."""
    _residence(mu, 3, poisson, share)
    r0, r1, r2, d0, d1, d2 = _moments(1, mu, poisson, share)
    value = old * poisson[0] + start * r1 + end * (r0 - r1) + 6.0 * bump * (r1 - r2)
    slope = -old * poisson[0] + start * d1 + end * (d0 - d1) + 6.0 * bump * (d1 - d2)
    return value, slope, r0 - r1, 6.0 * (r1 - r2)


@njit(cache=True)
def squeezed(s, beta):
    """phi(s) and its derivative."""
    b = beta * s
    d = 1.0 + abs(b)
    return s + b * s / d, 1.0 + b * (1.0 + d) / (d * d)


@njit(cache=True)
def film_step(law, old, new, dt, u, v):
    """Advance the state `old` into `new`; returns F, dF/du and dF/dv at the end of the step."""
    lags = law.gains.shape[1] - DIRECT
    x, g, g_u = static(u, law)
    # own time and own rate at the end
    theta = sqrt(g)
    theta_u = 0.5 * g_u / theta
    span = 0.5 * dt * (1.0 / old[THETA] + 1.0 / theta)
    span_u = -0.5 * dt * theta_u / (theta * theta)
    start, end, end_u, end_v = old[RATE], theta * v, theta_u * v, theta
    # what the straight line between both rates misses of the change of approach
    travel = u - old[APPROACH]
    bump = travel / span - 0.5 * (start + end)
    bump_u = (1.0 - travel / span * span_u) / span - 0.5 * end_u
    bump_v = -0.5 * end_v

    poisson, share = np.empty(lags + 3), np.empty(lags + 3)
    p = law.inlet_rate
    s, s_mu, s_end, s_bump = _one_lag(old[INLET], start, end, bump, p * span, poisson, share)
    s_u = s_mu * p * span_u + s_end * end_u + s_bump * bump_u
    s_v = s_end * end_v + s_bump * bump_v
    y, y_mu, y_end, y_bump = _one_lag(old[FAST], start, end, bump, law.fast_rate * span, poisson, share)
    y_u = y_mu * law.fast_rate * span_u + y_end * end_u + y_bump * bump_u
    y_v = y_end * end_v + y_bump * bump_v

    # the film made: its ends, and a bump that keeps its mean, which the balance of the inlet lag gives
    mean = (travel - (s - old[INLET]) / p) / span
    mean_u = (1.0 - s_u / p - mean * span_u) / span
    mean_v = -s_v / (p * span)
    f0 = squeezed(old[INLET], law.squeeze)[0]
    f, f_s = squeezed(s, law.squeeze)
    f_mean, f_mean_s = squeezed(mean, law.squeeze)
    f_half, f_half_s = squeezed(0.5 * (old[INLET] + s), law.squeeze)
    hump = f_mean - f_half
    hump_u = f_mean_s * mean_u - 0.5 * f_half_s * s_u
    hump_v = f_mean_s * mean_v - 0.5 * f_half_s * s_v

    # gains at the load
    row, weight, per_x = 0, 0.0, 0.0
    rows = law.gain_x.size
    if rows > 1 and x > law.gain_x[0]:
        if x >= law.gain_x[rows - 1]:
            row, weight = rows - 2, 1.0
        else:
            row = np.searchsorted(law.gain_x, x) - 1
            per_x = 1.0 / (law.gain_x[row + 1] - law.gain_x[row])
            weight = (x - law.gain_x[row]) * per_x
    after = min(row + 1, rows - 1)
    x_u = 1.5 * g_u / g

    m, m_u, m_v = 0.0, 0.0, 0.0
    mu = law.lag_rate * span
    mu_u = law.lag_rate * span_u
    _residence(mu, lags + 2, poisson, share)
    for k in range(DIRECT + lags):
        if k == 0:
            q, q_u, q_v = end, end_u, end_v
        elif k == 1:
            q, q_u, q_v = s, s_u, s_v
        elif k == 2:
            q, q_u, q_v = y, y_u, y_v
        else:
            j = k - DIRECT + 1
            held, held_before = 0.0, 0.0
            for i in range(j):
                held += poisson[i] * old[CHAIN + j - 1 - i]
                if i < j - 1:
                    held_before += poisson[i] * old[CHAIN + j - 2 - i]
            r0, r1, r2, d0, d1, d2 = _moments(j, mu, poisson, share)
            q = held + f0 * r1 + f * (r0 - r1) + 6.0 * hump * (r1 - r2)
            q_mu = held_before - held + f0 * d1 + f * (d0 - d1) + 6.0 * hump * (d1 - d2)
            q_u = q_mu * mu_u + (r0 - r1) * f_s * s_u + 6.0 * (r1 - r2) * hump_u
            q_v = (r0 - r1) * f_s * s_v + 6.0 * (r1 - r2) * hump_v
            new[CHAIN + j - 1] = q
        gain = law.gains[row, k] * (1.0 - weight) + law.gains[after, k] * weight
        m += gain * q
        m_u += gain * q_u + (law.gains[after, k] - law.gains[row, k]) * per_x * x_u * q
        m_v += gain * q_v
    new[THETA], new[RATE], new[APPROACH], new[INLET], new[FAST] = theta, end, u, s, y
    w = g + m
    if w <= 0.0:
        return 0.0, 0.0, 0.0
    root = sqrt(w)
    return w * root, 1.5 * root * (g_u + m_u), 1.5 * root * m_v


@njit(cache=True)
def film_rest(law, u, state):
    """Make `state` that of rest at approach `u`; returns the static force."""
    g = static(u, law)[1]
    state[:] = 0.0
    state[THETA], state[APPROACH] = sqrt(g), u
    return g * sqrt(g)


@njit(cache=True)
def film_drive(law, T, u, v, force):
    """Force along a whole record that starts from rest at u[0], moving at v[0] from then on."""
    state = np.empty(CHAIN + law.gains.shape[1] - DIRECT)
    other = np.empty_like(state)
    force[0] = film_rest(law, u[0], state)
    state[RATE] = state[THETA] * v[0]
    for i in range(1, T.size):
        force[i] = film_step(law, state, other, T[i] - T[i - 1], u[i], v[i])[0]
        state, other = other, state


@njit(cache=True)
def static_forces(law, u, force):
    """Static force at every approach of the array `u`."""
    for i in range(u.size):
        force[i] = exp(1.5 * log(static(u[i], law)[1]))


@njit(cache=True)
def films(law, x, h, du):
    """Film h_s and slope du_s/dx at every x = ln F of an array."""
    for i in range(x.size):
        h[i], dh = _film(x[i], law)
        du[i] = 2.0 / 3.0 * exp(2.0 / 3.0 * x[i]) - dh
