"""A ball bearing over time: force of the ring on the balls, step by step, along a motion of the ring."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_rows, require_instance, require_positive
from ehlcontact.errors import ConvergenceError
from ehlcontact.jit import jit_exact_loop
from reduced_models.bearing.ball import Balls, films_of
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.ball_steps import (
    accept_balls,
    begin_rest,
    begin_step,
    press_balls,
    rest_balls,
)
from reduced_models.bearing.contact_heights import HEIGHT, find_heights
from reduced_models.bearing.equilibrium import angle_of
from reduced_models.bearing.film_heights import heights_in_runs
from reduced_models.bearing.freedoms import FIVE, directions_of
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]


SETTLED = 1e-9  # of the largest height, by which heights at rest may still change
MOST_TIMES = 60  # that they are looked up for it: a handful


class BallMotion:
    """Balls and films of a bearing in steps, each with its own speed of the shaft.

    The ring moves in the first n of its five directions (`freedoms.FIVE`); in the others it is held at 0.

    Parameters
    ----------
    balls : Balls
    directions : tuple of str
        In which the ring moves, as of `BearingMotion`.
    """

    def __init__(self, balls: Balls, directions: tuple[str, ...]) -> None:
        self.balls, self.films, self.directions = balls, films_of(balls), directions
        n = len(FIVE)
        self._gain, self._moving = 0.0, len(directions)
        self._out = np.zeros(n), np.zeros((n, n)), np.zeros((n, n))

    @property
    def angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]; the cage turns as the balls roll."""
        return float(self.films.cage[1])

    @property
    def cage(self) -> float:
        """Speed of the cage over that of the shaft, there."""
        return float(self.films.cage[2])

    def approach(self, k: int, race: str) -> float:
        """Of ball `k` and a race, features left out, where `forces` was called last [m]."""
        place, grooves = self.films.place[k], self.balls.grooves
        if race == RACES[0]:
            return float(np.hypot(*(self.films.tried[k, :2] - place)) - grooves.inner)
        return float(np.hypot(*place) - grooves.outer)

    def rest(self, omega: float, angle: float, q: _Floats) -> _Floats:
        """Put balls and films at rest with the ring at `q`, shape (n,); force of the ring on them, shape (n,).

        Films are those of the speed `omega` [rad/s]; the first ball is at `angle` [rad].
        """
        place = np.array(q)  # for arrays that may only be read, kernels would be compiled a second time
        begin_rest(self.balls, omega, angle, self.films)
        for _ in range(MOST_TIMES):
            rest_balls(self.balls, self.films, place, (*self._out, np.zeros(place.size)))
            before = self.films.heights[:, HEIGHT].copy()
            if self.balls.heights.shape[0] > 0:
                find_heights(self.balls, self.films, angle, 0.0)
            if _settled(before, self.films.heights[:, HEIGHT]):
                break
        self._gain = 0.0
        return self._out[0][: self._moving].copy()

    def begin(self, omega: float, dt: float) -> None:
        """Begin a step of `dt` [s], at whose end the shaft turns at `omega` [rad/s]."""
        begin_step(self.balls, omega, dt, self.films)
        self._gain = 1.5 / dt

    def forces(self, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring at `q`, moving at `v` at the end of the step, and its derivatives by both.

        Not a number where a ball finds no balance.
        """
        n = self._moving
        press_balls(self.balls, self.films, np.array(q), np.array(v), self._gain, self._out)
        force, stiffness, damping = self._out
        return force[:n].copy(), stiffness[:n, :n].copy(), damping[:n, :n].copy()

    def accept(self) -> None:
        """Move balls, films and cage to the end of the step, as `forces` was called last."""
        accept_balls(self.balls, self.films, self._gain)

    def drive(self, omega: float, dt: float, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats]:
        """Forces (k, n) of the ring, and of all balls (k, balls, 2), over steps that end at `q` and `v` (k, n)."""
        n, loads = self._moving, np.zeros((len(q), self.balls.number, 2))
        force = np.zeros((len(q), n))
        _drive(self.balls, self.films, (omega, dt, np.array(q), np.array(v)), self._out, (force, loads))
        return force, loads


class BearingMotion:
    """A bearing on a shaft of constant speed, in steps of one length.

    A step is tried as often as wanted (`forces`), from where the films are, and then accepted. The balls go round
    with the cage from step to step.

    Parameters
    ----------
    bearing : BallBearing
    speed_rpm : float
        Of the shaft.
    dt : float
        Length of all steps [s].
    cage_angle : float
        Of the first ball at the start [rad].
    directions : tuple of str, optional
        The n directions in which the ring moves: ("x", "y"), ("x", "y", "z") or all five, with "tilt_x" and
        "tilt_y". In the others it is held at 0. By default all five of an angular contact bearing, x and y of
        others.

    Raises
    ------
    InputError
        A speed that the bearing does not take, a step that is not > 0, other directions.
    """

    def __init__(
        self,
        bearing: BallBearing,
        speed_rpm: float,
        dt: float,
        cage_angle: float = -pi / 2.0,
        directions: Sequence[str] | None = None,
    ) -> None:
        require_instance("bearing", bearing, BallBearing, "a BallBearing")
        moving = directions_of(directions, bearing.contact_angle is not None)
        speed = bearing.speed(speed_rpm)
        self._motion, self._size = motion_of(bearing, [speed], moving), len(moving)
        self.dt, self._omega = require_positive("dt", dt), speed * RPM_TO_RAD_S
        self._put(angle_of(cage_angle), np.zeros(self._size))

    @property
    def cage_angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]."""
        return self._motion.angle

    def rest(self, q: ArrayLike) -> _Floats:
        """Put ring, balls and films at rest with the ring at `q`, shape (n,); returns the force on the balls."""
        return self._put(self._motion.angle, as_column("q", q, size=self._size))

    def forces(self, q: ArrayLike, v: ArrayLike) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring on the balls, the ring at `q` and moving at `v` at the end of the step; tangents.

        Returns
        -------
        force : ndarray, shape (n,)
            In N, N m.
        stiffness, damping : ndarray, shape (n, n)
            Its derivatives by q and v [N/m], [N s/m].

        Raises
        ------
        InputError
            Not n finite numbers each.
        ConvergenceError
            A ball finds no balance.
        """
        place, rate = (as_column(name, x, size=self._size) for name, x in (("q", q), ("v", v)))
        force, stiffness, damping = self._motion.forces(place, rate)
        return _finite(force, place), stiffness, damping

    def accept(self) -> None:
        """Move on to the end of the step, as `forces` was called last."""
        self._motion.accept()
        self._motion.begin(self._omega, self.dt)

    def drive(self, q: ArrayLike, v: ArrayLike) -> tuple[_Floats, _Floats]:
        """Forces along a motion whose rows are the ends of the steps from here, compiled.

        Parameters
        ----------
        q, v : array_like, shape (k, n)
            Places and velocities of the ring [m], [m/s].

        Returns
        -------
        force : ndarray, shape (k, n)
            Of the ring on the balls [N].
        balls : ndarray, shape (k, balls, 2)
            Force on every ball, at the inner and the outer race [N].
        """
        places = as_rows("q", q, np.shape(q)[0], self._size)
        found = self._motion.drive(self._omega, self.dt, places, as_rows("v", v, places.shape[0], self._size))
        self._motion.begin(self._omega, self.dt)
        return found

    def _put(self, angle: float, q: _Floats) -> _Floats:
        """Put all at rest with the ring at `q` and the first ball at `angle`, and begin a step."""
        force = _finite(self._motion.rest(self._omega, angle, q), q)
        self._motion.begin(self._omega, self.dt)
        return force


def motion_of(bearing: BallBearing, speeds_rpm: list[float], directions: tuple[str, ...]) -> BallMotion:
    """Balls and films of a bearing in time, tables of its races made at increasing speeds [rev/min].

    Raises
    ------
    InputError
        A speed that the bearing does not take.
    """
    speeds = [bearing.speed(speed) for speed in speeds_rpm]
    heights = heights_in_runs(bearing, speeds)
    return BallMotion(bearing.tables.balls(speeds)._replace(heights=heights), directions)


def _settled(before: _Floats, heights: _Floats) -> bool:
    return bool(np.abs(heights - before).max() <= SETTLED * np.abs(heights).max())


def _finite(force: _Floats, q: _Floats) -> _Floats:
    if not np.isfinite(force).all():
        raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", None)
    return force


@jit_exact_loop
def _drive(balls, films, motion, pushed, out):
    """Steps along a motion; the first has not begun, or is begun again."""
    omega, dt, q, v = motion
    for i in range(q.shape[0]):
        begin_step(balls, omega, dt, films)
        press_balls(balls, films, q[i], v[i], 1.5 / dt, pushed)
        accept_balls(balls, films, 1.5 / dt)
        for j in range(q.shape[1]):
            out[0][i, j] = pushed[0][j]
        for k in range(balls.number):
            out[1][i, k, 0], out[1][i, k, 1] = films.force[k, 0], films.force[k, 1]
