"""Static equilibrium of springs under a load. The springs of a bearing: `ring`."""

from __future__ import annotations

import math
from collections.abc import Callable
from math import atan2, pi
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite
from ehlcontact.errors import ConvergenceError, InputError

_Floats = NDArray[np.float64]

BALANCED = 1e-12  # imbalance over the load that ends the iteration
BALANCED_BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
ROUNDING = 1e-15  # imbalance over the forces by which springs press each other, below which steps do not help
# Stiffness given to directions that have none, over that of the others: contacts on one side only leave one.
REGULARISATION = 1e-6
MOST_STEPS = 100  # of which Newton needs a handful where contacts neither open nor close
FIRST_STEP = 1e-7  # [m], along the load, from where all contacts may be open
GROWTH = 4.0  # of such a step, until contacts hold the load
ROUGHLY = 0.1  # of the forces along a step, that are left at the end of a search along it
LEAST_SHARE = 0.1  # of a bracket, by which each step of that search makes it smaller
SMALLEST_STEP = 1e-18  # [m], rounding of places of balls: under loads of nN nothing comes closer
LONGEST_STEP = 1.0  # no journal travels this far [m]; beyond it the contacts do not stand in the way


class Springs(Protocol):
    """Springs on one body, as a force over its displacement."""

    def force(self, q: _Floats) -> _Floats:
        """What they carry with the body at `q`, shape (directions,) [N]."""

    def tangent(self, q: _Floats) -> _Floats:
        """Its derivative, shape (directions, directions) [N/m]."""


def equilibrium(
    springs: Springs,
    load: _Floats,
    longest: float = math.inf,
    first: _Floats | None = None,
    internal: float = 0.0,
) -> _Floats:
    """Find the displacement, shape (directions,) [m], at which springs carry `load` [N].

    Newton's method with the analytic tangents. Springs that only stiffen have a convex potential, so a step
    that does not bring the balance closer is replaced by the minimum along it. Steps are at most `longest` [m].
    With a `first` place the search begins there. `internal` are the forces [N] by which springs press each other
    at the origin: their rounding errors remain however small the load is.

    Raises
    ------
    InputError
        No load, and springs that do not press each other.
    ConvergenceError
        The contacts do not stand against the load; ``result`` is the last position.
    """
    size = float(np.linalg.norm(load))
    if size == 0.0 and internal == 0.0:
        raise InputError("static load", 0.0, "different from zero to press the contacts")

    def balance(q: _Floats) -> _Floats:
        return springs.force(q) - load

    if first is None and size <= internal:
        q = np.zeros(load.size)
        residual = balance(q)
    elif first is None:
        q = np.zeros(load.size)
        residual = balance(q)
        # Where all contacts are open there is no tangent to follow: first go along the load until they carry it.
        ahead = -math.copysign(FIRST_STEP / size, float(load @ residual)) * load
        q, residual = _line_search(balance, q, ahead, residual)
    else:
        q = first
        residual = balance(q)
    for _ in range(MOST_STEPS):
        error = float(np.linalg.norm(residual))
        if error <= BALANCED * size + ROUNDING * internal:
            return q
        stiffness = springs.tangent(q)
        stiffness += REGULARISATION * max(float(np.trace(stiffness)), size, internal) * np.eye(load.size)
        step = -np.asarray(np.linalg.solve(stiffness, residual), dtype=np.float64)
        if (length := float(np.linalg.norm(step))) > longest:
            step *= longest / length
        after = balance(q + step)
        if np.linalg.norm(after) < 0.5 * error:
            q, residual = q + step, after
        elif error <= BALANCED_BY_ROUNDING * size + BALANCED * internal or length <= SMALLEST_STEP:
            return q
        else:
            if step @ residual >= 0.0:  # inertia of balls makes tangents unsymmetric
                step = -residual * float(np.linalg.norm(step)) / error
            q, residual = _line_search(balance, q, step, residual)
    raise ConvergenceError("static equilibrium not found: the iteration stalled", q)


def _line_search(
    balance: Callable[[_Floats], _Floats], q: _Floats, step: _Floats, residual: _Floats
) -> tuple[_Floats, _Floats]:
    """Point on the line at which the forces along it balance, roughly, and the imbalance there.

    Springs that only stiffen have just one such point.
    """
    start = float(step @ residual)
    low, high, by_low, by_high, t = 0.0, math.inf, start, math.inf, 1.0
    for _ in range(MOST_STEPS):
        place = q + t * step
        after = balance(place)
        along = float(step @ after)
        if abs(along) <= ROUGHLY * abs(start):
            return place, after
        if along < 0.0:
            low, by_low = t, along
        else:
            high, by_high = t, along
        if high == math.inf:
            t *= GROWTH
            if t * float(np.linalg.norm(step)) > LONGEST_STEP:
                raise ConvergenceError("static equilibrium not found: the contacts do not hold the load", q)
        else:
            t = low + (high - low) * min(max(by_low / (by_low - by_high), LEAST_SHARE), 1.0 - LEAST_SHARE)
    raise ConvergenceError("static equilibrium not found: forces that jump with the displacement", q)


def direction_of(load: _Floats) -> float:
    """Angle of a load [rad]; that of gravity where there is none."""
    return atan2(load[1], load[0]) if load.any() else atan2(-1.0, 0.0)


def angle_of(angle: float, name: str = "cage_angle") -> float:
    """An angle of the cage, or another [rad]; raises `InputError` for one in degrees."""
    if abs(require_finite(name, angle)) > 2.0 * pi:
        raise InputError(name, angle, "between -2 pi and 2 pi; angles are in radians")
    return float(angle)
