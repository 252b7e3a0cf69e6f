"""A ball bearing over time: force of the ring on the balls, step by step, along a motion of the ring."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_rows, require_instance, require_positive
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.jit import jit_exact_loop
from reduced_models.bearing.angular_balls import AngularBalls
from reduced_models.bearing.angular_steps import (
    accept_angular,
    begin_angular_rest,
    begin_angular_step,
    films_of_angular,
    press_angular,
    rest_angular,
)
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.ball_steps import accept, begin_balls, press
from reduced_models.bearing.balls import (
    Balls,
    accept_balls,
    begin_rest,
    begin_step,
    directions,
    films_of,
    press_balls,
    rest_balls,
    speed_state,
    turn_planar,
)
from reduced_models.bearing.contact_heights import ANGLE_RATE, HEIGHT, find_heights
from reduced_models.bearing.equilibrium import angle_of
from reduced_models.bearing.film_heights import heights_in_runs
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

_Floats = NDArray[np.float64]


SETTLED = 1e-9  # of the largest height, by which heights at rest may still change
MOST_TIMES = 60  # that they are looked up for it: a handful


class BallMotion:
    """Balls and films of a bearing in steps, each with its own speed of the shaft and angle of the cage.

    Parameters
    ----------
    balls : Balls
    """

    def __init__(self, balls: Balls) -> None:
        self.balls, self.films = balls, films_of(balls)
        self.at_speed, self.gain = speed_state(balls, 0.0), 0.0
        self._normals = np.zeros((balls.number, 2))
        self._tried = np.zeros(2), np.zeros(2)

    # Places and velocities are copied: for arrays that may only be read, kernels would be compiled a second time.

    def rest(self, omega: float, angle: float, q: _Floats) -> _Floats:
        """Put balls and films at rest with the ring at `q` [m]; force of the ring on the balls, shape (2,) [N].

        Films are those of the speed `omega` [rad/s]; the first ball is at `angle` [rad].
        """
        directions(self.balls, angle, self._normals)
        self.gain = begin_rest(self.films)
        self.at_speed = speed_state(self.balls, omega)._replace(cage=0.0)
        self.films.turned[0, ANGLE_RATE] = angle
        for _ in range(MOST_TIMES):
            force, _, _ = self.forces(q, np.zeros(2))
            rest_balls(self.balls, self.films, self._normals, np.array(q))
            before = self.films.heights[:, HEIGHT].copy()
            turn_planar(self.balls, angle, self.films, 0.0)
            if _settled(before, self.films.heights[:, HEIGHT]):
                break
        return force

    def begin(self, omega: float, angle: float, dt: float) -> None:
        """Begin a step of `dt` [s], at whose end the shaft turns at `omega` and the first ball is at `angle`."""
        self.at_speed = speed_state(self.balls, omega)
        directions(self.balls, angle, self._normals)
        turn_planar(self.balls, angle, self.films, 1.5 / dt)
        self.gain = begin_step(self.balls, self.at_speed, dt, self.films)

    def forces(self, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring at `q`, moving at `v` at the end of the step, and its derivatives by both.

        Not a number where a ball finds no balance.
        """
        self._tried = np.array(q), np.array(v)
        out = np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))
        press_balls(self.balls, self.at_speed, self.films, self._normals, *self._tried, self.gain, out)
        return out

    def ring_approach(self, k: int) -> float:
        """Of both rings at ball `k`, where `forces` was called last [m]."""
        return float(self._normals[k] @ self._tried[0]) - self.balls.half_clearance

    def accept(self) -> None:
        """Move balls and films to the end of the step, as `forces` was called last."""
        accept_balls(self.balls, self.at_speed, self.films, self._normals, *self._tried, self.gain)


class AngularMotion:
    """Balls at contact angles and their films in steps, with the methods of `BallMotion`.

    The angle of the cage, which turns as the balls roll, is `angle`.

    Parameters
    ----------
    balls : AngularBalls
    """

    def __init__(self, balls: AngularBalls) -> None:
        self.balls, self.films, self.gain = balls, films_of_angular(balls), 0.0
        n = len(FIVE)
        self._out = np.zeros(n), np.zeros((n, n)), np.zeros((n, n))

    @property
    def angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]."""
        return float(self.films.cage[1])

    def rest(self, omega: float, angle: float, q: _Floats) -> _Floats:
        """Put balls and films at rest with the ring at `q`, shape (5,); force of the ring, shape (5,)."""
        begin_angular_rest(self.balls, omega, angle, self.films)
        for _ in range(MOST_TIMES):
            rest_angular(self.balls, self.films, np.array(q), (*self._out, np.zeros(len(FIVE))))
            before = self.films.heights[:, HEIGHT].copy()
            if self.balls.heights.shape[0] > 0:
                find_heights(self.balls, self.films, angle, 0.0)
            if _settled(before, self.films.heights[:, HEIGHT]):
                break
        self.gain = 0.0
        return self._out[0].copy()

    def begin(self, omega: float, angle: float, dt: float) -> None:
        """Begin a step of `dt` [s], at whose end the shaft turns at `omega`; the cage's own angle counts."""
        begin_angular_step(self.balls, omega, dt, self.films)
        self.gain = 1.5 / dt

    def forces(self, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring at `q`, moving at `v` at the end of the step, and its derivatives by both.

        Not a number where a ball finds no balance.
        """
        press_angular(self.balls, self.films, np.array(q), np.array(v), self.gain, self._out)
        force, stiffness, damping = self._out
        return force.copy(), stiffness.copy(), damping.copy()

    def accept(self) -> None:
        """Move balls, films and cage to the end of the step, as `forces` was called last."""
        accept_angular(self.balls, self.films, self.gain)


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
    freedoms : {2, 5}, optional
        Degrees of freedom n of the ring: x and y, or x, y, z, tilt_x, tilt_y. By default 5 of an angular contact
        bearing, 2 of others.

    Raises
    ------
    InputError
        A speed that the bearing does not take, a step that is not > 0.
    """

    def __init__(
        self,
        bearing: BallBearing,
        speed_rpm: float,
        dt: float,
        cage_angle: float = -pi / 2.0,
        freedoms: int | None = None,
    ) -> None:
        require_instance("bearing", bearing, BallBearing, "a BallBearing")
        usual = len(PLANAR) if bearing.contact_angle is None else len(FIVE)
        self._size = usual if freedoms is None else freedoms
        if self._size not in (len(PLANAR), len(FIVE)):
            raise InputError("freedoms", freedoms, "2 or 5")
        speed = bearing.speed(speed_rpm)
        self._motion = motion_of(bearing, [speed], self._size)
        self.dt, self._omega = require_positive("dt", dt), speed * RPM_TO_RAD_S
        self._start, self._step = angle_of(cage_angle), 0
        self.rest(np.zeros(self._size))

    @property
    def cage_angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]."""
        return self._angle

    def rest(self, q: ArrayLike) -> _Floats:
        """Put ring, balls and films at rest with the ring at `q`, shape (n,); returns the force on the balls."""
        place = as_column("q", q, size=self._size)
        force = _finite(self._motion.rest(self._omega, self._angle_at(self._step), place), place)
        self._angle = self._angle_at(self._step)
        self._begin()
        return force

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
        place, rate = (as_column(name, x, size=self._size).copy() for name, x in (("q", q), ("v", v)))
        force, stiffness, damping = self._motion.forces(place, rate)
        return _finite(force, place), stiffness, damping

    def accept(self) -> None:
        """Move on to the end of the step, as `forces` was called last."""
        self._motion.accept()
        self._step += 1
        self._angle = self._angle_at(self._step)
        self._begin()

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
        n, moved = self._size, self._motion
        places = as_rows("q", q, np.shape(q)[0], n).copy()  # arrays that are read-only would be compiled for again
        rates = as_rows("v", v, places.shape[0], n).copy()
        force, loads = np.zeros((len(places), n)), np.zeros((len(places), moved.balls.number, 2))
        angles = np.array([self._angle_at(self._step + 1 + i) for i in range(len(places))])
        out = np.zeros(n), np.zeros((n, n)), np.zeros((n, n))
        normals = np.zeros((moved.balls.number, 2))
        _drive(
            moved.balls, moved.films, (self._omega, self.dt, angles, places, rates), normals, out, (force, loads)
        )
        self._step += len(places)
        self._angle = self._angle_at(self._step)
        self._begin()
        return force, loads

    def _angle_at(self, step: int) -> float:
        """Angle of the first ball at the end of a step [rad]; of a cage that rolls with its balls, the last."""
        if isinstance(self._motion, AngularMotion):
            return self._motion.angle if step else self._start
        return self._start + speed_state(self._motion.balls, self._omega).cage * self.dt * step

    def _begin(self) -> None:
        self._motion.begin(self._omega, self._angle_at(self._step + 1), self.dt)


def motion_of(bearing: BallBearing, speeds_rpm: list[float], freedoms: int) -> BallMotion | AngularMotion:
    """Balls and films of a bearing in time, tables of its races made at increasing speeds [rev/min].

    Raises
    ------
    InputError
        A speed that the bearing does not take.
    """
    speeds = [bearing.speed(speed) for speed in speeds_rpm]
    heights = heights_in_runs(bearing, speeds)
    if freedoms == len(PLANAR):
        return BallMotion(bearing._kernel(speeds)._replace(heights=heights))
    return AngularMotion(bearing._angular_balls(speeds)._replace(heights=heights))


def _settled(before: _Floats, heights: _Floats) -> bool:
    return bool(np.abs(heights - before).max() <= SETTLED * np.abs(heights).max())


def _finite(force: _Floats, q: _Floats) -> _Floats:
    if not np.isfinite(force).all():
        raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", None)
    return force


@jit_exact_loop
def _drive(balls, films, motion, normals, pushed, out):
    """Steps along a motion; the first has not begun, or is begun again."""
    omega, dt, angles, q, v = motion
    for i in range(angles.size):
        begin_balls(balls, films, normals, omega, angles[i], dt)
        press(balls, films, normals, omega, q[i], v[i], 1.5 / dt, pushed)
        accept(balls, films, normals, omega, q[i], v[i], 1.5 / dt)
        for j in range(pushed[0].size):
            out[0][i, j] = pushed[0][j]
        for k in range(balls.number):
            out[1][i, k, 0], out[1][i, k, 1] = films.force[k, 0], films.force[k, 1]
