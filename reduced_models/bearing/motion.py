"""A ball bearing over time: force of the ring on the balls, step by step, along a motion of the ring."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_rows, require_instance, require_positive
from ehlcontact.errors import ConvergenceError
from ehlcontact.jit import jit_exact_loop
from reduced_models.bearing.ball_bearing import BallBearing
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
)
from reduced_models.bearing.kinematics import RADIANS

_Floats = NDArray[np.float64]


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

    def rest(self, omega: float, angle: float, q: _Floats) -> _Floats:
        """Put balls and films at rest with the ring at `q` [m]; force of the ring on the balls, shape (2,) [N].

        Films are those of the speed `omega` [rad/s]; the first ball is at `angle` [rad].
        """
        directions(self.balls, angle, self._normals)
        self.gain = begin_rest(self.films)
        self.at_speed = speed_state(self.balls, omega)._replace(cage=0.0)
        force, _, _ = self.forces(q, np.zeros(2))
        rest_balls(self.balls, self.films, self._normals, q)
        return force

    def begin(self, omega: float, angle: float, dt: float) -> None:
        """Begin a step of `dt` [s], at whose end the shaft turns at `omega` and the first ball is at `angle`."""
        self.at_speed = speed_state(self.balls, omega)
        directions(self.balls, angle, self._normals)
        self.gain = begin_step(self.balls, self.at_speed, dt, self.films)

    def forces(self, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring at `q`, moving at `v` at the end of the step, and its derivatives by both.

        Not a number where a ball finds no balance.
        """
        self._tried = q, v
        out = np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))
        press_balls(self.balls, self.at_speed, self.films, self._normals, q, v, self.gain, out)
        return out

    def accept(self) -> None:
        """Move balls and films to the end of the step, as `forces` was called last."""
        accept_balls(self.balls, self.at_speed, self.films, self._normals, *self._tried, self.gain)


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

    Raises
    ------
    InputError
        A speed that the bearing does not take, a step that is not > 0.
    """

    def __init__(self, bearing: BallBearing, speed_rpm: float, dt: float, cage_angle: float = -pi / 2.0) -> None:
        require_instance("bearing", bearing, BallBearing, "a BallBearing")
        speed = bearing.speed(speed_rpm)
        self._motion, self.dt = BallMotion(bearing._kernel(speed)), require_positive("dt", dt)
        self._omega = speed * RADIANS
        self._cage = speed_state(self._motion.balls, self._omega).cage
        self._start, self._step = float(cage_angle), 0
        self.rest(np.zeros(2))

    @property
    def cage_angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]."""
        return self._start + self._cage * self.dt * self._step

    def rest(self, q: ArrayLike) -> _Floats:
        """Put ring, balls and films at rest with the ring at `q` [m]; returns the force on the balls [N]."""
        place = as_column("q", q, size=2)
        force = _finite(self._motion.rest(self._omega, self.cage_angle, place), place)
        self._begin()
        return force

    def forces(self, q: ArrayLike, v: ArrayLike) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring on the balls, the ring at `q` and moving at `v` at the end of the step; tangents.

        Returns
        -------
        force : ndarray, shape (2,)
            In N.
        stiffness, damping : ndarray, shape (2, 2)
            Its exact derivatives by q and v [N/m], [N s/m].

        Raises
        ------
        ConvergenceError
            A ball finds no balance.
        """
        place = np.array(q, float)
        force, stiffness, damping = self._motion.forces(place, np.array(v, float))
        return _finite(force, place), stiffness, damping

    def accept(self) -> None:
        """Move on to the end of the step, as `forces` was called last."""
        self._motion.accept()
        self._step += 1
        self._begin()

    def drive(self, q: ArrayLike, v: ArrayLike) -> tuple[_Floats, _Floats]:
        """Forces along a motion whose rows are the ends of the steps from here, compiled.

        Parameters
        ----------
        q, v : array_like, shape (n, 2)
            Places and velocities of the ring [m], [m/s].

        Returns
        -------
        force : ndarray, shape (n, 2)
            Of the ring on the balls [N].
        balls : ndarray, shape (n, balls, 2)
            Force on every ball, at the inner and the outer race [N].
        """
        places = as_rows("q", q, np.shape(q)[0], 2)
        rates, moved = as_rows("v", v, places.shape[0], 2), self._motion
        balls = moved.balls
        force, loads = np.zeros((len(places), 2)), np.zeros((len(places), balls.number, 2))
        angles = self._start + self._cage * self.dt * np.arange(self._step + 1, self._step + 1 + len(places))
        arrays = np.zeros((balls.number, 2)), np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))
        _drive(balls, moved.at_speed, moved.films, (self.dt, angles, places, rates), arrays, (force, loads))
        self._step += len(places)
        self._begin()
        return force, loads

    def _begin(self) -> None:
        self._motion.begin(self._omega, self._start + self._cage * self.dt * (self._step + 1), self.dt)


def _finite(force: _Floats, q: _Floats) -> _Floats:
    if not np.isfinite(force).all():
        raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", None)
    return force


@jit_exact_loop
def _drive(balls, at_speed, films, motion, arrays, out):
    """Steps along a motion; the first has not begun."""
    dt, angles, q, v = motion
    normals, force = arrays[0], arrays[1]
    for i in range(angles.size):
        directions(balls, angles[i], normals)
        gain = begin_step(balls, at_speed, dt, films)
        press_balls(balls, at_speed, films, normals, q[i], v[i], gain, arrays[1:])
        accept_balls(balls, at_speed, films, normals, q[i], v[i], gain)
        out[0][i, 0], out[0][i, 1] = force[0], force[1]
        for k in range(balls.number):
            out[1][i, k, 0], out[1][i, k, 1] = films.force[k, 0], films.force[k, 1]
