"""Where the ring of a bearing stands under a load, balls in a given position."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_finite
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.balls import Balls, Turn, begin_rest, directions, films_of, press_balls
from reduced_models.rotor.equilibrium import equilibrium

_Floats = NDArray[np.float64]

STILL = np.zeros(2)  # velocity of a ring at rest
SEATED = 1e-9  # least product of the two stiffnesses of a ring over the square of their sum: below is rounding


class StaticBalls:
    """All balls at rest at one angle of the cage, as `equilibrium` wants contacts.

    Parameters
    ----------
    balls : Balls
    turn : Turn
        Speed of the shaft: its films and its centrifugal force. That the cage turns, squeezes no film here.
    angle : float
        Of the first ball [rad].
    """

    def __init__(self, balls: Balls, turn: Turn, angle: float) -> None:
        self.balls, self._turn = balls, turn._replace(cage=0.0)
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
        press_balls(self.balls, self._turn, self.films, self.normals, np.asarray(q, float), STILL, 0.0, arrays)
        if not np.isfinite(self._force).all():
            raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", q)


@dataclass(frozen=True, eq=False)
class Standing:
    """A ring at rest, and its balls."""

    displacement: _Floats  # (2,) [m]
    normals: _Floats  # (balls, 2)
    approach: _Floats  # (balls, 2) at the inner and at the outer race [m]
    force: _Floats  # (balls, 2) [N]
    stiffness: _Floats  # (2, 2) [N/m]


def stand(balls: Balls, turn: Turn, load: _Floats, angle: float) -> Standing:
    """Ring under `load` [N], the first ball at `angle`.

    Raises
    ------
    InputError
        A load that does not seat it.
    ConvergenceError
        No balance was found.
    """
    still = StaticBalls(balls, turn, angle)
    q = np.zeros(2) if not load.any() else equilibrium(still, load)  # type: ignore[arg-type]
    stiffness = still.tangent(q)
    if not np.linalg.det(stiffness) > SEATED * np.trace(stiffness) ** 2:
        allowed = "one that presses balls on both sides of its direction; or preload the bearing (clearance < 0)"
        raise InputError("load", load.tolist(), allowed)
    w = still.films.w[:, 0]
    inner = still.normals @ q - balls.half_clearance - w
    return Standing(q, still.normals, np.column_stack([inner, w]), still.films.force.copy(), stiffness)


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


def angle_of(angle: float) -> float:
    """An angle of the cage [rad]; raises `InputError` for one in degrees."""
    if abs(require_finite("cage_angle", angle)) > 2.0 * pi:
        raise InputError("cage_angle", angle, "between -2 pi and 2 pi; angles are in radians")
    return float(angle)
