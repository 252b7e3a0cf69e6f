"""The force law that the linear and the cubic element share, as compiled scalar kernels.

On [low, high] Nonato and Cavalca (2010), eq. 11 restricted to K1, K2, K3, C1; outside see `ends`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from ehlcontact.checks import require_nonnegative
from reduced_models.elements.ends import Ends, fade, hertz, joined_ends


class ViscousLaw(NamedTuple):
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
    def build(cls, stiffness: Sequence[float], damping: float, low: float, high: float) -> ViscousLaw:
        """Join the ends to the polynomial with coefficients K1, K2, K3 on (low, high).

        Raises
        ------
        InputError
            C1 negative, or a spring force or tangent that is not positive at an end of the interval.
        """
        C = require_nonnegative("C1", damping)
        K1, K2, K3 = stiffness
        ends = joined_ends({name: (u, *polynomial(u, K1, K2, K3)) for name, u in (("low", low), ("high", high))})
        return cls(K1, K2, K3, C, low, high, *ends)

    def approach_at(self, force: float) -> float:
        """Approach at which the spring carries `force` > 0; the root of the static law."""
        ends = Ends(self.o_low, self.A_low, self.o_high, self.A_high)
        outside = ends.approach_at(force, spring(self.low, self)[0], spring(self.high, self)[0])
        if outside is not None:
            return outside
        return float(brentq(lambda u: spring(u, self)[0] - force, self.low, self.high, xtol=1e-300, rtol=1e-14))


@njit(cache=True)
def polynomial(u, K1, K2, K3):
    """Cubic through the origin, and its derivative."""
    return u * (K1 + u * (K2 + u * K3)), K1 + u * (2.0 * K2 + u * 3.0 * K3)


@njit(cache=True)
def spring(u, law):
    """Force and tangent of the spring at approach `u`."""
    if u > law.high:
        return hertz(u - law.o_high, law.A_high)
    if u < law.low:
        return hertz(u - law.o_low, law.A_low)
    return polynomial(u, law.K1, law.K2, law.K3)


@njit(cache=True)
def contact(u, v, law):
    """Force, dF/du and dF/dv at approach `u` and rate `v`; all zero where the force would pull."""
    f, k = spring(u, law)
    s, ds = fade(u, law.low, law.o_low)
    force = f + law.C1 * s * v
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + law.C1 * ds * v, law.C1 * s


@njit(cache=True)
def _fill_contact(u, v, law, out):
    for i in range(u.size):
        out[0, i], out[1, i], out[2, i] = contact(u[i], v[i], law)


@njit(cache=True)
def _fill_parts(u, law, out):
    for i in range(u.size):
        out[0, i] = spring(u[i], law)[0]
        out[1, i] = law.C1 * fade(u[i], law.low, law.o_low)[0]


def contact_values(law: ViscousLaw, approach: ArrayLike, rate: ArrayLike) -> NDArray[np.float64]:
    """Force, stiffness and damping, stacked on axis 0, for broadcastable approach and rate."""
    u, v = np.broadcast_arrays(np.asarray(approach, float), np.asarray(rate, float))
    out = np.empty((3, u.size))
    _fill_contact(u.ravel(), v.ravel(), law, out)
    return out.reshape((3, *u.shape))


def part_values(law: ViscousLaw, approach: ArrayLike) -> NDArray[np.float64]:
    """Spring force and damping coefficient, stacked on axis 0."""
    u = np.asarray(approach, float)
    out = np.empty((2, u.size))
    _fill_parts(u.ravel(), law, out)
    return out.reshape((2, *u.shape))
