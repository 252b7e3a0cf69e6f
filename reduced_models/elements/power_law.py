"""The power law K (u + u0)_+^n + F0 + C u' as compiled scalar kernels; its ends are in `ends`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_nonnegative, require_positive
from reduced_models.elements.ends import Ends, fade, hertz, joined_ends


class PowerLaw(NamedTuple):
    """Coefficients of the law; ``o_*`` and ``A_*`` belong to the Hertz-like ends."""

    K: float
    n: float
    u0: float
    F0: float
    C: float
    low: float
    high: float
    o_low: float
    A_low: float
    o_high: float
    A_high: float

    @classmethod
    def build(cls, coefficients: Mapping[str, float], low: float, high: float) -> PowerLaw:
        """Join the ends to the power law on (low, high).

        Raises
        ------
        InputError
            K, n or u + u0 not positive, C negative, or a spring force that is not positive at an end.
        """
        K, n = (require_positive(name, coefficients[name]) for name in ("K", "n"))
        require_nonnegative("C", coefficients["C"])
        shift, offset = coefficients["u0"], coefficients["F0"]
        require_positive("low + u0", low + shift)
        values = {name: (u, *power(u, K, n, shift, offset)) for name, u in (("low", low), ("high", high))}
        return cls(**coefficients, low=low, high=high, **joined_ends(values)._asdict())

    def approach_at(self, force: float) -> float:
        """Approach at which the spring carries `force` > 0; the root of the static law."""
        ends = Ends(self.o_low, self.A_low, self.o_high, self.A_high)
        outside = ends.approach_at(force, spring(self.low, self)[0], spring(self.high, self)[0])
        if outside is not None:
            return outside
        return float(((force - self.F0) / self.K) ** (1.0 / self.n)) - self.u0


@njit(cache=True)
def power(u, K, n, shift, offset):
    """Force of the power law and its derivative, where u + u0 > 0."""
    reach = u + shift
    part = K * reach**n
    return part + offset, n * part / reach


@njit(cache=True)
def spring(u, law):
    """Force and tangent of the spring at approach `u`."""
    if u > law.high:
        return hertz(u - law.o_high, law.A_high)
    if u < law.low:
        return hertz(u - law.o_low, law.A_low)
    return power(u, law.K, law.n, law.u0, law.F0)


@njit(cache=True)
def contact(u, v, law):
    """Force, dF/du and dF/dv at approach `u` and rate `v`; all zero where the force would pull."""
    f, k = spring(u, law)
    s, ds = fade(u, law.low, law.o_low)
    force = f + law.C * s * v
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + law.C * ds * v, law.C * s


@njit(cache=True)
def _fill_contact(u, v, law, out):
    for i in range(u.size):
        out[0, i], out[1, i], out[2, i] = contact(u[i], v[i], law)


@njit(cache=True)
def _fill_parts(u, law, out):
    for i in range(u.size):
        out[0, i] = spring(u[i], law)[0]
        out[1, i] = law.C * fade(u[i], law.low, law.o_low)[0]


def contact_values(law: PowerLaw, approach: ArrayLike, rate: ArrayLike) -> NDArray[np.float64]:
    """Force, stiffness and damping, stacked on axis 0, for broadcastable approach and rate."""
    u, v = np.broadcast_arrays(np.asarray(approach, float), np.asarray(rate, float))
    out = np.empty((3, u.size))
    _fill_contact(u.ravel(), v.ravel(), law, out)
    return out.reshape((3, *u.shape))


def part_values(law: PowerLaw, approach: ArrayLike) -> NDArray[np.float64]:
    """Spring force and damping coefficient, stacked on axis 0."""
    u = np.asarray(approach, float)
    out = np.empty((2, u.size))
    _fill_parts(u.ravel(), law, out)
    return out.reshape((2, *u.shape))
