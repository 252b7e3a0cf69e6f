"""Impedance of a bearing at complex frequencies: a rational function, for every gain is one of a filter.

A ball has Z = Z_i Z_o/(Z_i + Z_o) of its two contacts in series (m s^2 beside Z_o if it has inertia), each of them

    Z(s) = k + s tau (dF/dm) G(s tau)

with the transfer function G of the film's filters. Balls stand still while the ring vibrates: what they see change
as they travel is no part of it. Over a ball passage Z is the mean of positions of the cage, each with the ring
where the same load puts it: on the imaginary axis that is `BallBearing.coefficients`, to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.balls import Balls, SpeedState
from reduced_models.bearing.coefficients import SmallContact, small_contact
from reduced_models.bearing.equilibrium import RingEquilibrium
from reduced_models.bearing.loss import Loss, response
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


class Contacts(NamedTuple):
    """Contacts of many balls with one race about rest, arrays over the balls as in `SmallContact`."""

    stiffness: _Floats
    slope: _Floats
    tau: _Floats
    gains: _Floats  # (balls, DIRECT + lags)
    rates: FilterRates | None  # None: dry

    @classmethod
    def of(cls, found: Sequence[SmallContact]) -> Contacts:
        """Contacts, which have one law, as arrays."""
        stiffness, slope, tau, gains, rates = zip(*found, strict=True)
        return cls(np.array(stiffness), np.array(slope), np.array(tau), np.array(gains), rates[0])

    def impedance(self, s: complex) -> _Complex:
        """Z(s) of all of them [N/m]."""
        if self.rates is None:
            return self.stiffness.astype(complex)
        own = s * self.tau
        return np.asarray(self.stiffness + self.slope * own * (self.rates.transfer(own) * self.gains).sum(axis=1))


class SmallBalls(NamedTuple):
    """All balls of a bearing about rest, at one position of the cage or at several."""

    inner: Contacts
    outer: Contacts
    normals: _Floats  # (positions * balls, 2)
    positions: int
    loss: Loss
    inertia: float  # of a ball along its normal [kg]

    @classmethod
    def of(cls, balls: Balls, at_speed: SpeedState, standings: Sequence[RingEquilibrium]) -> SmallBalls:
        """From where the ring stands at each position."""
        approach = np.concatenate([standing.approach for standing in standings])
        inner, outer = (
            Contacts.of([small_contact(law, transit, at_speed.speed_row, u) for u in column.tolist()])
            for law, transit, column in zip(
                (balls.inner, balls.outer), (at_speed.inner, at_speed.outer), approach.T, strict=True
            )
        )
        normals = np.concatenate([at.normals for at in standings])
        return cls(inner, outer, normals, len(standings), balls.loss, balls.inertia)

    def impedance(self, s: complex) -> _Complex:
        """Of the ring, shape (2, 2) [N/m], at a frequency s [1/s] of exp(s t)."""
        inner, outer = self.inner.impedance(s), self.outer.impedance(s) + self.inertia * s * s
        both = inner + outer
        series = np.divide(inner * outer, both, out=np.zeros_like(both), where=both != 0.0)
        return np.asarray((self.normals.T * series) @ self.normals * (response(self.loss, s) / self.positions))
