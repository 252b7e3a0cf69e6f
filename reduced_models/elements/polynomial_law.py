"""The seven-term law of Nonato and Cavalca (2010), eq. 11, as compiled scalar kernels.

Inside the box eq. 11; the spring goes on outside as in `ends`. Beyond the largest rate the powers
of the rate, and outside [low, high] the mixed term, level off with a continuous slope, so that far away only a
viscous damper C1 + B4 u is left.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from ehlcontact.errors import InputError
from reduced_models.elements.ends import Ends, fade, hertz, joined_ends, saturate
from reduced_models.elements.viscous_law import polynomial


class PolynomialLaw(NamedTuple):
    """Coefficients of the law; ``o_*`` and ``A_*`` belong to the Hertz-like ends."""

    K1: float
    C1: float
    K2: float
    C2: float
    K3: float
    C3: float
    B4: float
    low: float
    high: float
    rate: float  # inf where it is not known
    o_low: float
    A_low: float
    o_high: float
    A_high: float

    @classmethod
    def build(cls, coefficients: dict[str, float], low: float, high: float, rate: float) -> PolynomialLaw:
        """Join the ends to the polynomial on (low, high), |u'| <= rate.

        Raises
        ------
        InputError
            A spring force or tangent that is not positive at an end of the interval, or a damper that feeds
            energy into a cycle somewhere in the box or beyond it.
        """
        K = [coefficients[f"K{i}"] for i in (1, 2, 3)]
        ends = joined_ends({name: (u, *polynomial(u, *K)) for name, u in (("low", low), ("high", high))})
        # Even powers of the rate cancel over a cycle; what remains is linear in u and in u'^2: look at corners.
        reach = 0.5 * (high - low)
        cubed = coefficients["C3"] * rate**2 if coefficients["C3"] != 0.0 else 0.0
        for u in (low - reach, high + reach):
            for more in (0.0, cubed):
                damping = coefficients["C1"] + coefficients["B4"] * u + more
                if not damping >= 0.0:
                    raise InputError(
                        f"cycle damping C1 + B4 u + C3 rate^2 at u = {u:.4g}",
                        damping,
                        ">= 0 (fit the cubic model)",
                    )
        return cls(**coefficients, low=low, high=high, rate=rate, **ends._asdict())

    def approach_at(self, force: float) -> float:
        """Approach at which the spring carries `force` > 0; the root of the static law."""
        ends = Ends(self.o_low, self.A_low, self.o_high, self.A_high)
        outside = ends.approach_at(force, spring(self.low, self)[0], spring(self.high, self)[0])
        if outside is not None:
            return outside
        return float(brentq(lambda u: spring(u, self)[0] - force, self.low, self.high, xtol=1e-300, rtol=1e-14))


@njit(cache=True)
def spring(u, law):
    """Force and tangent of the spring at approach `u`."""
    if u > law.high:
        return hertz(u - law.o_high, law.A_high)
    if u < law.low:
        return hertz(u - law.o_low, law.A_low)
    return polynomial(u, law.K1, law.K2, law.K3)


@njit(cache=True)
def damper(u, v, law):
    """Force of the damper and its derivatives with respect to `u` and `v`."""
    s, ds = fade(u, law.low, law.o_low)
    if s == 0.0:
        return 0.0, 0.0, 0.0
    at, du = saturate(u, law.low, law.high, 0.5 * (law.high - law.low))
    w, dw = saturate(v, -law.rate, law.rate, law.rate)
    c = law.C1 + law.B4 * at
    # Beyond the largest rate the powers follow their tangent there, along the levelled rate.
    edge = min(max(v, -law.rate), law.rate)
    slope = 2.0 * law.C2 * edge + 3.0 * law.C3 * edge * edge
    powers = edge * edge * (law.C2 + law.C3 * edge) + slope * (w - edge)
    force = c * v + powers
    return s * force, ds * force + s * law.B4 * du * v, s * (c + slope * dw)


@njit(cache=True)
def contact(u, v, law):
    """Force, dF/du and dF/dv at approach `u` and rate `v`; all zero where the force would pull."""
    f, k = spring(u, law)
    d, d_u, d_v = damper(u, v, law)
    force = f + d
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + d_u, d_v


@njit(cache=True)
def _fill_contact(u, v, law, out):
    for i in range(u.size):
        out[0, i], out[1, i], out[2, i] = contact(u[i], v[i], law)


@njit(cache=True)
def _fill_parts(u, law, out):
    for i in range(u.size):
        out[0, i] = spring(u[i], law)[0]
        out[1, i] = damper(u[i], 0.0, law)[2]


def contact_values(law: PolynomialLaw, approach: ArrayLike, rate: ArrayLike) -> NDArray[np.float64]:
    """Force, stiffness and damping, stacked on axis 0, for broadcastable approach and rate."""
    u, v = np.broadcast_arrays(np.asarray(approach, float), np.asarray(rate, float))
    out = np.empty((3, u.size))
    _fill_contact(u.ravel(), v.ravel(), law, out)
    return out.reshape((3, *u.shape))


def part_values(law: PolynomialLaw, approach: ArrayLike) -> NDArray[np.float64]:
    """Spring force and damping coefficient at zero rate, stacked on axis 0."""
    u = np.asarray(approach, float)
    out = np.empty((2, u.size))
    _fill_parts(u.ravel(), law, out)
    return out.reshape((2, *u.shape))
