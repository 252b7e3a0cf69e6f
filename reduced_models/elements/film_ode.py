"""The film law in continuous time: the differential equations of its filters, as compiled kernels.

States are the inlet lag s, the fast lag y and the chain q_1 ... of `film_law`; all zero at rest.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit

from reduced_models.elements.film_law import DIRECT, squeezed, static


@njit(cache=True)
def _gain(law, x, k):
    """Gain k at x = ln F."""
    if law.gain_x.size == 1:
        return law.gains[0, k]
    return np.interp(x, law.gain_x, np.ascontiguousarray(law.gains[:, k]))


@njit(cache=True)
def _remembered(law, x, states):
    """Film that the states add."""
    film = 0.0
    for k in range(states.size):
        film += _gain(law, x, k + 1) * states[k]
    return film


@njit(cache=True)
def film_rates(law, states, u, v, rates):
    """Force at approach `u` and rate `v`; fills the time derivatives of the states."""
    x, g, _ = static(u, law)
    theta = sqrt(g)
    i = theta * v
    rates[0] = law.inlet_rate * (i - states[0]) / theta
    rates[1] = law.fast_rate * (i - states[1]) / theta
    fed = squeezed(states[0], law.squeeze)[0]
    for k in range(DIRECT - 1, states.size):
        rates[k] = law.lag_rate * (fed - states[k]) / theta
        fed = states[k]
    w = g + _gain(law, x, 0) * i + _remembered(law, x, states)
    return w * sqrt(w) if w > 0.0 else 0.0


@njit(cache=True)
def film_rate(law, states, u, force):
    """Rate at which the contact carries `force` > 0 at approach `u`."""
    x, g, _ = static(u, law)
    return (force ** (2.0 / 3.0) - g - _remembered(law, x, states)) / (_gain(law, x, 0) * sqrt(g))
