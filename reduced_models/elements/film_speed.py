"""Speed at which the film in a contact was made, while the speed of the surfaces changes; compiled.

Films of different speeds are in a contact at the same time: that at the inlet is of the present speed, that on its
way through the contact of earlier ones. A static film grows as U^p, p = `FILM_GROWTH`, so the mean film in the
contact is that of the speed V with

    V^p = (c z + g_i s + g_f y + sum_k g_k q_k)/(c + g_i + g_f + sum_k g_k),    z = U^p,

where s, y and q_k are the filters of `film_law`, with z as their input in the place of the own rate (and without
saturation), and the gains are those of the film memory: the film of a past speed is forgotten as that of a past
motion is. All states are z at constant speed, and V = U then.
"""

from __future__ import annotations

import numpy as np

from ehlcontact.jit import jit_exact
from reduced_models.elements.film_filters import chain_moments, lag_moments, pass_on, poisson_shares
from reduced_models.elements.film_law import interval

FILM_GROWTH = 0.67  # of films with speed (Hamrock and Dowson 1977)
NOW, SLOW_INLET, QUICK, AGES = range(4)  # entries of the state of a film's speed: z, s, y, and the chain


@jit_exact
def _lag(old, start, end, rate, span):
    """One lag at the end of a step whose input goes straight from `start` to `end`."""
    kept, r0, r1, _ = lag_moments(rate * span, 3.0)
    return old * kept + start * r1 + end * (r0 - r1)


@jit_exact
def speed_step(old, new, z, span, rates):
    """Advance the state `old` into `new` while the input goes straight to `z`.

    `span` is the length of the step in own time; `rates` are those of chain, inlet and fast filter.
    """
    lags, start = old.size - AGES, old[NOW]
    lag_rate, inlet_rate, fast_rate = rates
    s = _lag(old[SLOW_INLET], start, z, inlet_rate, span)
    new[NOW], new[SLOW_INLET], new[QUICK] = z, s, _lag(old[QUICK], start, z, fast_rate, span)
    # into the chain goes s: its ends, and a bump that keeps its mean
    mean = 0.5 * (start + z) - (s - old[SLOW_INLET]) / (inlet_rate * span)
    bump = mean - 0.5 * (old[SLOW_INLET] + s)
    mu = lag_rate * span
    poisson, share = np.empty(lags + 3), np.empty(lags + 3)
    poisson_shares(mu, lags + 2, lags + 2.0, poisson, share)
    new[AGES:] = 0.0
    pass_on(old[AGES:], poisson, new[AGES:])
    for j in range(1, lags + 1):
        r0, r1, r2 = chain_moments(j, 1.0 / mu, share)
        new[AGES + j - 1] += old[SLOW_INLET] * r1 + s * (r0 - r1) + 6.0 * bump * (r1 - r2)


@jit_exact
def film_speed(law, x, state):
    """V^p of a state, with the gains of `law` at x = ln F."""
    last = law.gain_x.size - 2
    row = min(max(interval(law.gain_x, x), 0), max(last, 0))
    weight = 0.0
    if last >= 0:
        weight = min(max((x - law.gain_x[row]) / (law.gain_x[row + 1] - law.gain_x[row]), 0.0), 1.0)
    total, gains = 0.0, 0.0
    for k in range(state.size):
        gain = law.gains[row, k]
        if weight > 0.0:
            gain += weight * (law.gains[row + 1, k] - gain)
        total += gain * state[k]
        gains += gain
    return total / gains
