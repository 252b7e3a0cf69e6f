"""A bearing in the time domain: its force on a shaft that moves as it is told, step by step, films and all."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_rows, require_positive
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.jit import jit_exact_loop
from reduced_models.bearing.balls import (
    Balls,
    SpeedState,
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


class BearingMotion:
    """A bearing on a shaft of constant speed, in steps of one length.

    A step is tried as often as wanted (`forces`), from where the films are, and then accepted. The balls go round
    with the cage from step to step.

    Parameters
    ----------
    balls : Balls
        ``bearing.kernel(speed_rpm)``, or of several speeds about it.
    speed_rpm : float
        Of the shaft.
    dt : float
        Length of all steps [s].
    cage_angle : float
        Of the first ball at the start [rad].
    """

    def __init__(self, balls: Balls, speed_rpm: float, dt: float, cage_angle: float = -pi / 2.0) -> None:
        self.balls, self.dt = balls, require_positive("dt", dt)
        omega = speed_rpm * RADIANS
        if balls.inner.x.size and not balls.speeds[0] <= omega <= balls.speeds[-1]:
            low, high = balls.speeds[0] / RADIANS, balls.speeds[-1] / RADIANS
            raise InputError("speed_rpm", speed_rpm, f"between {low:.6g} and {high:.6g}, the speeds of these laws")
        self.at_speed = speed_state(balls, omega)
        self.films = films_of(balls)
        self._start, self._step = float(cage_angle), 0
        self._normals = np.zeros((balls.number, 2))
        self._gain, self._tried = 0.0, (np.zeros(2), np.zeros(2))
        self.rest(np.zeros(2))

    @property
    def cage_angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]."""
        return self._start + self.at_speed.cage * self.dt * self._step

    def rest(self, q: ArrayLike) -> _Floats:
        """Put ring, balls and films at rest with the ring at `q` [m]; returns the force on the balls [N]."""
        place = as_column("q", q, size=2)
        directions(self.balls, self.cage_angle, self._normals)
        begin_rest(self.films)
        force, *_ = self._press(self.at_speed._replace(cage=0.0), place, np.zeros(2), 0.0)
        rest_balls(self.balls, self.films, self._normals, place)
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
        self._tried = np.array(q, float), np.array(v, float)
        return self._press(self.at_speed, *self._tried, self._gain)

    def accept(self) -> None:
        """Move on to the end of the step, as `forces` was asked last."""
        accept_balls(self.balls, self.at_speed, self.films, self._normals, *self._tried, self._gain)
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
        rates = as_rows("v", v, places.shape[0], 2)
        force, loads = np.zeros((len(places), 2)), np.zeros((len(places), self.balls.number, 2))
        angles = self._start + self.at_speed.cage * self.dt * np.arange(
            self._step + 1, self._step + 1 + len(places)
        )
        arrays = self._normals, np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))
        _drive(self.balls, self.at_speed, self.films, (self.dt, angles, places, rates), arrays, (force, loads))
        self._step += len(places)
        self._begin()
        return force, loads

    def _begin(self) -> None:
        angle = self._start + self.at_speed.cage * self.dt * (self._step + 1)
        directions(self.balls, angle, self._normals)
        self._gain = begin_step(self.balls, self.at_speed, self.dt, self.films)

    def _press(
        self, at_speed: SpeedState, q: _Floats, v: _Floats, gain: float
    ) -> tuple[_Floats, _Floats, _Floats]:
        force, stiffness, damping = np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))
        press_balls(self.balls, at_speed, self.films, self._normals, q, v, gain, (force, stiffness, damping))
        if not np.isfinite(force).all():
            raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", None)
        return force, stiffness, damping


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
