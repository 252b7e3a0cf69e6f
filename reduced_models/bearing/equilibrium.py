"""Static equilibrium of springs under a load, and of the ring of a planar bearing on its balls.

The ring with five degrees of freedom: `five_degrees`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, pi
from typing import Protocol

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_finite
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.balls import POSITION, Balls, SpeedState, begin_rest, directions, films_of, press_balls
from reduced_models.bearing.contact_heights import HEIGHT

_Floats = NDArray[np.float64]

BALANCED = 1e-12  # imbalance over the load that ends the iteration
BALANCED_BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
ROUNDING = 1e-15  # imbalance over the forces by which springs press each other, below which steps do not help
# Stiffness given to directions that have none, over that of the others: contacts on one side only leave one.
REGULARISATION = 1e-6
MOST_STEPS = 100  # of which Newton needs a handful where contacts neither open nor close
FIRST_STEP = 1e-9  # [m], along the load, from where all contacts may be open; the search doubles it
SMALLEST_STEP = 1e-18  # [m], rounding of places of balls: under loads of nN nothing comes closer
LONGEST_STEP = 1.0  # no journal travels this far [m]; beyond it the contacts do not stand in the way
STILL = np.zeros(2)  # velocity of a ring at rest
SEATED = 1e-9  # least product of the two stiffnesses of a ring over the square of their sum: below is rounding


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
    elif first is None:
        q = np.zeros(load.size)
        residual = balance(q)
        # Where all contacts are open there is no tangent to follow: first go along the load until they carry it.
        q = _line_search(balance, q, -math.copysign(FIRST_STEP / size, float(load @ residual)) * load)
    else:
        q = first
    for _ in range(MOST_STEPS):
        residual = balance(q)
        error = float(np.linalg.norm(residual))
        if error <= BALANCED * size + ROUNDING * internal:
            return q
        stiffness = springs.tangent(q)
        stiffness += REGULARISATION * max(float(np.trace(stiffness)), size, internal) * np.eye(load.size)
        step = -np.asarray(np.linalg.solve(stiffness, residual), dtype=np.float64)
        if (length := float(np.linalg.norm(step))) > longest:
            step *= longest / length
        if np.linalg.norm(balance(q + step)) < 0.5 * error:
            q = q + step
        elif error <= BALANCED_BY_ROUNDING * size + BALANCED * internal or length <= SMALLEST_STEP:
            return q
        else:
            if step @ residual >= 0.0:  # inertia of balls makes tangents unsymmetric
                step = -residual * float(np.linalg.norm(step)) / error
            q = _line_search(balance, q, step)
    raise ConvergenceError("static equilibrium not found: the iteration stalled", q)


def _line_search(balance: Callable[[_Floats], _Floats], q: _Floats, step: _Floats) -> _Floats:
    """Point on the line at which the forces balance along it; springs that only stiffen have just one."""

    def along(t: float) -> float:
        return float(step @ balance(q + t * step))

    far = 1.0
    while along(far) < 0.0:
        far *= 2.0
        if far * float(np.linalg.norm(step)) > LONGEST_STEP:
            raise ConvergenceError("static equilibrium not found: the contacts do not hold the load", q)
    try:
        return q + float(scipy.optimize.brentq(along, 0.0, far, xtol=1e-300, rtol=1e-12)) * step
    except (ValueError, RuntimeError):  # balls with several places of balance at speed
        raise ConvergenceError("static equilibrium not found: forces that jump with the displacement", q) from None


class StaticBalls:
    """All balls in static equilibrium at one angle of the cage, as `equilibrium` wants contacts.

    Parameters
    ----------
    balls : Balls
    at_speed : SpeedState
        Speed of the shaft: its films and its centrifugal force. That the cage turns, squeezes no film here.
    angle : float
        Of the first ball [rad].
    """

    def __init__(self, balls: Balls, at_speed: SpeedState, angle: float) -> None:
        self.balls, self.at_speed = balls, at_speed._replace(cage=0.0)
        self.normals = np.zeros((balls.number, 2))
        directions(balls, angle, self.normals)
        self.films = films_of(balls)
        begin_rest(self.films)
        self._force, self._stiffness, self._damping = np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))

    def force(self, q: _Floats) -> _Floats:
        """What they carry with the ring at `q`, shape (2,) [N]."""
        self._press(q)
        return self._force.copy()

    def tangent(self, q: _Floats) -> _Floats:
        """Its derivative, shape (2, 2) [N/m]."""
        self._press(q)
        return self._stiffness.copy()

    def _press(self, q: _Floats) -> None:
        arrays = self._force, self._stiffness, self._damping
        press_balls(self.balls, self.at_speed, self.films, self.normals, np.array(q, float), STILL, 0.0, arrays)
        if not np.isfinite(self._force).all():
            raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", q)


@dataclass(frozen=True, eq=False)
class RingEquilibrium:
    """A ring in static equilibrium, and its balls."""

    displacement: _Floats  # (2,) [m]
    normals: _Floats  # (balls, 2)
    approach: _Floats  # (balls, 2) at the inner and at the outer race [m]
    force: _Floats  # (balls, 2) [N]
    stiffness: _Floats  # (2, 2) [N/m]


def ring_equilibrium(still: StaticBalls, load: _Floats) -> RingEquilibrium:
    """Ring on balls in static equilibrium under `load` [N].

    Raises
    ------
    InputError
        A load that does not seat it.
    ConvergenceError
        No balance was found.
    """
    q = np.zeros(2) if not load.any() else equilibrium(still, load)
    stiffness = still.tangent(q)
    if not np.linalg.det(stiffness) > SEATED * np.trace(stiffness) ** 2:
        allowed = "one that presses balls on both sides of its direction; or preload the bearing (clearance < 0)"
        raise InputError("load", load.tolist(), allowed)
    w = still.films.balls[:, POSITION]
    inner = still.normals @ q - still.balls.half_clearance - w
    approach = np.column_stack([inner, w]) + still.films.heights[:, HEIGHT].reshape(-1, 2)
    return RingEquilibrium(q, still.normals, approach, still.films.force.copy(), stiffness)


def direction_of(load: _Floats) -> float:
    """Angle of a load [rad]; that of gravity where there is none."""
    return atan2(load[1], load[0]) if load.any() else atan2(-1.0, 0.0)


def radial_load(load: ArrayLike) -> _Floats:
    """The load; whoever gives a third component wants another bearing."""
    size = np.size(load) if isinstance(load, tuple | list | np.ndarray) else 0
    if size != 2:
        allowed = "a pair (Fx, Fy) [N]: this bearing is planar and takes no axial load, moment or tilt"
        raise InputError("load", load, allowed)
    return as_column("load", load, size=2)


def angle_of(angle: float, name: str = "cage_angle") -> float:
    """An angle of the cage, or another [rad]; raises `InputError` for one in degrees."""
    if abs(require_finite(name, angle)) > 2.0 * pi:
        raise InputError(name, angle, "between -2 pi and 2 pi; angles are in radians")
    return float(angle)
