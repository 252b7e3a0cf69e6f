"""How springs and dampers go on outside the fitted interval of approach, for all memoryless elements.

Outside [low, high] a fitted spring is meaningless (tension, negative stiffness), so it goes on as a dry Hertz
contact would: A (u - o)^(3/2), joined with equal value and slope. The damper fades out below with the spring.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ehlcontact.errors import InputError

ADVICE = "(fit again over a wider range of approach, or with the linear model)"


class Ends(NamedTuple):
    """Origins and factors of the Hertz-like ends."""

    o_low: float
    A_low: float
    o_high: float
    A_high: float

    def approach_at(self, force: float, at_low: float, at_high: float) -> float | None:
        """Approach under `force` where it lies on an end; None between the spring forces at low and high."""
        if force <= at_low:
            return self.o_low + (force / self.A_low) ** (2.0 / 3.0)
        if force >= at_high:
            return self.o_high + (force / self.A_high) ** (2.0 / 3.0)
        return None


def joined_ends(ends: dict[str, tuple[float, float, float]]) -> Ends:
    """Continue a spring beyond "low" and "high", given (approach, force, tangent) at each.

    Raises
    ------
    InputError
        A force or tangent that is not positive, where no Hertz-like continuation exists.
    """
    joined: list[float] = []
    for name, (u, value, slope) in ends.items():
        if not value > 0.0:
            raise InputError(f"spring force at {name}", value, f"> 0 {ADVICE}")
        if not slope > 0.0:
            raise InputError(f"spring tangent at {name}", slope, f"> 0 {ADVICE}")
        reach = 1.5 * value / slope
        joined += [u - reach, value / reach**1.5]
    return Ends(*joined)


@njit(cache=True)
def hertz(reach, factor):
    """Force and tangent of ``factor reach^(3/2)``, zero at and below reach 0."""
    if reach <= 0.0:
        return 0.0, 0.0
    root = np.sqrt(reach)
    return factor * reach * root, 1.5 * factor * root


@njit(cache=True)
def fade(u, low, o_low):
    """Share of the damper at approach `u` and its derivative: 1 from `low` upwards, 0 where the spring ends."""
    if u >= low:
        return 1.0, 0.0
    width = low - o_low
    s = (u - o_low) / width
    if s <= 0.0:
        return 0.0, 0.0
    return s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / width


@njit(cache=True)
def saturate(x, low, high, reach):
    """`x` and slope 1 on [low, high]; beyond, it comes to rest within `reach` with a continuous slope."""
    if x > high:
        t = np.tanh((x - high) / reach)
        return high + reach * t, 1.0 - t * t
    if x < low:
        t = np.tanh((low - x) / reach)
        return low - reach * t, 1.0 - t * t
    return x, 1.0
