"""The force law that the linear and the cubic element share, as compiled scalar kernels.

On the validity interval [low, high] the spring is the fitted polynomial (Nonato and Cavalca 2010, eq. 11
restricted to K1, K2, K3, C1). Outside it a polynomial is meaningless (tension, negative stiffness), so it
goes on as a dry Hertz contact would: A (u - o)^(3/2), joined with equal value and slope.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from ehlcontact.errors import InputError, require_finite, require_nonnegative

ADVICE = "(fit again over a wider range of approach, or with the linear model)"


class Law(NamedTuple):
    """Coefficients of the law; ``o_*`` and ``A_*`` belong to the Hertz-like ends."""

    K1: float
    K2: float
    K3: float
    C1: float
    low: float
    high: float
    o_low: float
    A_low: float
    o_high: float
    A_high: float

    @classmethod
    def build(cls, stiffness: Sequence[float], damping: float, valid: Sequence[float]) -> Law:
        """Join the Hertz-like ends to the polynomial with coefficients K1, K2, K3 on (low, high).

        Raises
        ------
        InputError
            A coefficient not finite, C1 negative, ``low >= high``, or a spring force or tangent that is not
            positive at an end of the interval, where no Hertz-like continuation exists.
        """
        K = [require_finite(f"K{i}", value) for i, value in enumerate(stiffness, start=1)]
        C = require_nonnegative("C1", damping)
        ends = {name: require_finite(name, u) for name, u in zip(("low", "high"), valid, strict=True)}
        if ends["low"] >= ends["high"]:
            raise InputError("low", ends["low"], f"below high = {ends['high']!r}")
        joined: list[float] = []
        for name, u in ends.items():
            value = u * (K[0] + u * (K[1] + u * K[2]))
            slope = K[0] + u * (2.0 * K[1] + u * 3.0 * K[2])
            if not value > 0.0:
                raise InputError(f"spring force at {name}", value, f"> 0 {ADVICE}")
            if not slope > 0.0:
                raise InputError(f"spring tangent at {name}", slope, f"> 0 {ADVICE}")
            reach = 1.5 * value / slope
            joined += [u - reach, value / reach**1.5]
        return cls(K[0], K[1], K[2], C, ends["low"], ends["high"], *joined)

    def approach_at(self, force: float) -> float:
        """Approach at which the spring carries `force` > 0; the root of the static law."""
        if force <= spring(self.low, self)[0]:
            return self.o_low + (force / self.A_low) ** (2.0 / 3.0)
        if force >= spring(self.high, self)[0]:
            return self.o_high + (force / self.A_high) ** (2.0 / 3.0)
        return float(brentq(lambda u: spring(u, self)[0] - force, self.low, self.high, xtol=1e-300, rtol=1e-14))


@njit(cache=True)
def spring(u, law):
    """Force and tangent of the spring at approach `u`."""
    if u > law.high:
        reach = u - law.o_high
        return law.A_high * reach**1.5, 1.5 * law.A_high * reach**0.5
    if u < law.low:
        reach = u - law.o_low
        if reach <= 0.0:
            return 0.0, 0.0
        return law.A_low * reach**1.5, 1.5 * law.A_low * reach**0.5
    return (
        u * (law.K1 + u * (law.K2 + u * law.K3)),
        law.K1 + u * (2.0 * law.K2 + u * 3.0 * law.K3),
    )


@njit(cache=True)
def damper(u, law):
    """Damping coefficient and its derivative at approach `u`: C1, fading to zero where the spring does."""
    if u >= law.low:
        return law.C1, 0.0
    width = law.low - law.o_low
    s = (u - law.o_low) / width
    if s <= 0.0:
        return 0.0, 0.0
    return law.C1 * s * s * (3.0 - 2.0 * s), law.C1 * 6.0 * s * (1.0 - s) / width


@njit(cache=True)
def contact(u, v, law):
    """Force, dF/du and dF/dv at approach `u` and rate `v`; all zero where the force would pull."""
    f, k = spring(u, law)
    c, dc = damper(u, law)
    force = f + c * v
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + dc * v, c


@njit(cache=True)
def _fill_contact(u, v, law, out):
    for i in range(u.size):
        out[0, i], out[1, i], out[2, i] = contact(u[i], v[i], law)


@njit(cache=True)
def _fill_parts(u, law, out):
    for i in range(u.size):
        out[0, i] = spring(u[i], law)[0]
        out[1, i] = damper(u[i], law)[0]


def contact_values(law: Law, approach: ArrayLike, rate: ArrayLike) -> NDArray[np.float64]:
    """Force, stiffness and damping, stacked on axis 0, for broadcastable approach and rate."""
    u, v = np.broadcast_arrays(np.asarray(approach, float), np.asarray(rate, float))
    out = np.empty((3, u.size))
    _fill_contact(u.ravel(), v.ravel(), law, out)
    return out.reshape((3, *u.shape))


def part_values(law: Law, approach: ArrayLike) -> NDArray[np.float64]:
    """Spring force and damping coefficient, stacked on axis 0."""
    u = np.asarray(approach, float)
    out = np.empty((2, u.size))
    _fill_parts(u.ravel(), law, out)
    return out.reshape((2, *u.shape))
