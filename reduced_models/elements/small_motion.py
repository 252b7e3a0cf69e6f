"""Small motion of film contacts about rest: one description, as an impedance and as a state space.

About rest the law of `reduced_models.elements.film_law` is linear: with the own time tau of the contact, its
filters are fed by i = tau u', and

    dF = stiffness du + slope dm,    dm = c i + g_i s + g_f y + sum_k g_k q_k

    Z(s) = stiffness + slope s tau G(s tau)

with G of `reduced_models.elements.film_response`. Units are those of force, approach and time that the fields
have: the reference load and its dry approach, or N, m and s.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

FILTERS = DIRECT - 1  # states of a film before those of its chain: inlet and fast


class StateSpace(NamedTuple):
    """Linear system x' = A x + B w, f = C x + D w; w holds displacements, then their rates."""

    A: _Floats  # (n, n)
    B: _Floats  # (n, inputs)
    C: _Floats  # (forces, n)
    D: _Floats  # (forces, inputs)


class SmallMotion(NamedTuple):
    """Contacts about rest, shape S: () of one contact, (k,) of k contacts with the same filters."""

    stiffness: float | _Floats  # S, slope of the static force
    slope: float | _Floats  # S, dF/dm
    tau: float | _Floats  # S, own time
    gains: _Floats  # S + (DIRECT + lags,); none in a dry contact
    rates: FilterRates | None  # in own time; None in a dry contact
    made: float | _Floats = 1.0  # S, film that a unit of the inlet's state lets into the chain; cancels in Z

    @classmethod
    def stack(cls, contacts: Sequence[SmallMotion]) -> SmallMotion:
        """Contacts with the same filters as one, shape (k,)."""
        stiffness, slope, tau, gains, rates, made = zip(*contacts, strict=True)
        return cls(np.array(stiffness), np.array(slope), np.array(tau), np.array(gains), rates[0], np.array(made))

    def impedance(self, s: ArrayLike) -> _Complex:
        """Z of a motion exp(s t) at complex `s`, whose shape broadcasts against that of the contacts."""
        own = np.asarray(s, complex) * self.tau
        if self.rates is None:
            return np.asarray(self.stiffness + 0.0 * own)
        return np.asarray(self.stiffness + self.slope * own * (self.rates.transfer(own) * self.gains).sum(axis=-1))

    def state_space(self, *index: int) -> StateSpace:
        """System from (u, u') to the force; states inlet, fast, chain. `index` is the contact of several."""
        stiffness, slope, tau, gains = (np.asarray(part)[index] for part in self[:4])
        if self.rates is None:
            return StateSpace(
                np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([[float(stiffness), 0.0]])
            )
        made = float(np.broadcast_to(self.made, np.shape(self.stiffness))[index])
        rates, size = self.rates, FILTERS + self.rates.lags
        A = np.diag(np.array([-rates.inlet_rate, -rates.fast_rate, *[-rates.lag_rate] * rates.lags]) / tau)
        for j in range(FILTERS, size):
            A[j, 0 if j == FILTERS else j - 1] = rates.lag_rate / tau * (made if j == FILTERS else 1.0)
        shares = gains[1:].copy()
        shares[FILTERS:] /= made
        fed = np.zeros((size, 2))
        fed[:FILTERS, 1] = rates.inlet_rate, rates.fast_rate
        return StateSpace(A, fed, slope * shares[None], np.array([[float(stiffness), slope * gains[0] * tau]]))
