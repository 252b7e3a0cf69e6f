"""Static equilibrium of springs under a load: a ring on its balls (`ring`), a rotor on its supports.

Newton's method with the exact slopes. Contacts act as springs that only pull or push, and only stiffen: their
potential is convex (nearly, for the orbits of balls depend on their angles), so that a step that does not bring
the balance closer is shortened to where the forces along it balance.
"""

from __future__ import annotations

import math
from math import atan2, pi
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite
from ehlcontact.errors import ConvergenceError, InputError

_Floats = NDArray[np.float64]

GUESS = 1e8  # N/m, springs in place of the contacts, on which a search begins
OPEN = 1.0  # N/m, beside the slopes of contacts that are open in some direction
BALANCED = 1e-12  # imbalance over the load that ends the search
BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
ROUNDING = 1e-15  # imbalance over the forces by which springs press each other, below which steps do not help
ROUGHLY = 0.1  # of the forces along a step, that are left at the end of a search along it
LEAST_SHARE = 0.1  # of a bracket, by which each step of that search makes it smaller
MOST_STEPS, MOST_SHORTENED = 60, 30  # of both
SMALLEST_STEP = 1e-18  # [m], rounding of places of balls: under loads of nN nothing comes closer


class Springs(Protocol):
    """Springs under a load, over the displacement of what they carry, shape (n,)."""

    pressed: float  # forces by which they press each other, where `imbalance` was computed last [N]

    def imbalance(self, q: _Floats) -> _Floats:
        """Forces that they carry with it at `q`, less the load, shape (n,) [N]."""

    def tangent(self, q: _Floats) -> _Floats:
        """Derivative of these forces, `OPEN` added where springs may be open, shape (n, n) [N/m]."""

    def too_long(self, step: _Floats) -> float:
        """At least 1: how many times longer a step is than one along which springs are followed."""


def equilibrium(springs: Springs, first: _Floats, size: float) -> _Floats:
    """Find the displacement, shape (n,) [m], at which springs carry their load, from a first one.

    The load has the `size` [N]. Rounding errors of the forces by which springs press each other remain however
    small it is.

    Raises
    ------
    ConvergenceError
        The springs do not stand against the load; ``result`` is the last displacement.
    """
    q, residual = first, springs.imbalance(first)
    for _ in range(MOST_STEPS):
        error = float(np.linalg.norm(residual))
        if error <= BALANCED * size + ROUNDING * springs.pressed:
            return q
        tangent = springs.tangent(q)
        step = -np.asarray(np.linalg.solve(tangent, residual), np.float64)
        if error <= BY_ROUNDING * size + BALANCED * springs.pressed or np.linalg.norm(step) <= SMALLEST_STEP:
            after = springs.imbalance(q + step)  # whole steps, while they help
            if not np.linalg.norm(after) < 0.5 * error:
                return q
            q, residual = q + step, after
            continue
        if step @ residual >= 0.0:  # inertia of balls makes slopes unsymmetric
            step = -residual / np.diag(tangent)
        q, residual = _along(springs, q, residual, step / springs.too_long(step))
    left = f"the contacts do not hold {np.linalg.norm(residual):.3g} N of a load of {size:.3g} N"
    raise ConvergenceError(f"static equilibrium not found: {left}", q)


def _along(springs: Springs, q: _Floats, residual: _Floats, step: _Floats) -> tuple[_Floats, _Floats]:
    """Place along a step from `q`, closer to balance or where forces along it balance, and the imbalance there."""
    error, start = float(np.linalg.norm(residual)), float(step @ residual)
    low, high, by_low, by_high, t = 0.0, math.inf, start, math.inf, 1.0
    for k in range(MOST_SHORTENED):
        try:
            after = springs.imbalance(q + t * step)
        except ConvergenceError:  # of a ball
            after = np.full(q.size, math.nan)
        along = float(step @ after)
        if np.linalg.norm(after) < 0.5 * error or abs(along) <= ROUGHLY * abs(start) or (t == 1.0 and along < 0.0):
            return q + t * step, after
        if along < 0.0:
            low, by_low = t, along
        else:
            high, by_high = t, along
        falsi = by_low / (by_low - by_high) if math.isfinite(by_high) and k % 2 else 0.5
        t = low + (high - low) * min(max(falsi, LEAST_SHARE), 1.0 - LEAST_SHARE)
    raise ConvergenceError("static equilibrium not found: forces that jump with the displacement", q)


def direction_of(load: _Floats) -> float:
    """Angle of a load [rad]; that of gravity where there is none."""
    return atan2(load[1], load[0]) if load.any() else atan2(-1.0, 0.0)


def angle_of(angle: float, name: str = "cage_angle") -> float:
    """An angle of the cage, or another [rad]; raises `InputError` for one in degrees."""
    if abs(require_finite(name, angle)) > 2.0 * pi:
        raise InputError(name, angle, "between -2 pi and 2 pi; angles are in radians")
    return float(angle)
