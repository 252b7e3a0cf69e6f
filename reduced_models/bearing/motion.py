"""A ball bearing over time: force of the ring on the balls, step by step, along a motion of the ring."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import c_double, c_int
from functools import partial
from math import nan, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_rows, require_finite, require_instance, require_positive
from ehlcontact.checks.inputs import as_numbers
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.ball import Balls
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.core_bearing import CoreBearing, pointer
from reduced_models.bearing.equilibrium import angle_of
from reduced_models.bearing.film_heights import heights_in_runs
from reduced_models.bearing.freedoms import directions_of
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.life.bearing_life import STANDING, TURNING

_Floats = NDArray[np.float64]

FASTEST, FARTHEST = 1e3, 0.1  # m/s, rad/s and m, rad: of a ring
LEAST_STEPS = 16  # per turn of the shaft and per ball passage


class BallMotion:
    """Balls and films of a bearing in steps, each with its own speed of the shaft, by the C core.

    The ring moves in the first n of its five directions (`freedoms.FIVE`); in the others it is held at 0.

    Parameters
    ----------
    balls : Balls
    directions : tuple of str
        In which the ring moves, as of `BearingMotion`.

    Attributes
    ----------
    core : CoreBearing
    state, work : ndarray
        Of the bearing at the end of the last step, and of a step, which C writes: `CoreBearing` shows what is in
        them.
    loads : ndarray, shape (balls, 2)
        Forces of all balls at the inner and the outer race, at the end of the last step accepted [N]; a view.
    places : ndarray, shape (balls, 2)
        Of their centres from that of the outer groove, outward and along the shaft, there [m]; a view.
    speed_sums : ndarray, shape (balls, 2)
        Sums of both surface speeds over the speed of the shaft, there [m]; a view.
    """

    def __init__(self, balls: Balls, directions: tuple[str, ...]) -> None:
        self.balls, self.directions = balls, directions
        self.core = core = CoreBearing(balls, directions)
        self.state, self.work = core.start(), core.work()
        self._head, self._tried = core.head(self.state), core.ball_steps(self.work)
        self._surfaces = core.surfaces(self.state)
        self.loads: _Floats = core.balls(self.state)["force"]
        self.places: _Floats = core.balls(self.state)["place"][:, 0]
        self.speed_sums: _Floats = core.balls(self.state)["speed_sum"][:, :, 0]
        n = len(directions)
        self._place, self._rate, self._force = np.zeros((3, n))
        self._stiffness, self._damping = np.zeros((2, n, n))
        self._own = own = core.address, pointer(self.state), pointer(self.work)
        ring = map(pointer, (self._place, self._rate, self._force))
        self._press = partial(core.library.bearing_press, *own, *ring)
        slopes = map(pointer, (self._stiffness, self._damping))
        self._slopes = partial(core.library.bearing_slopes, core.address, own[2], *slopes)
        self._accept = partial(core.library.bearing_accept, *own)

    @property
    def angle(self) -> float:
        """Of the first ball, at the end of the last step accepted [rad]; the cage turns as the balls roll."""
        return float(self._head["angle"][0])

    @property
    def cage(self) -> float:
        """Speed of the cage over that of the shaft, there."""
        return float(self._head["cage"][0, 0])

    @property
    def largest(self) -> _Floats:
        """Largest force that any ball has had at either race, shape (2,) [N]."""
        return np.asarray(self._surfaces["largest"].max(axis=0))

    @property
    def mean_loads(self) -> _Floats:
        """Forces of all balls at both races since the start, shape (balls, 2, 2) [N].

        Means over the turns of the shaft with the exponents 3 and 10/3; 0 where it has not turned.
        """
        turned = abs(float(self.core.shaft(self.state)[0]))
        sums = self._surfaces["fatigue"]
        means = sums / turned if turned > 0.0 else np.zeros_like(sums)
        return np.asarray(means ** (1.0 / np.array([TURNING, STANDING])))

    @property
    def full_films(self) -> NDArray[np.void]:
        """Force [N], its slope [N/m] and the approach [m] there, of full films in place of elements.

        Records of shape (balls, 2); a view, which may be written. A contact with a slope of 0 has its element.
        """
        return self._surfaces["full"]

    def approach(self, k: int, race: str) -> float:
        """Of ball `k` and a race, features left out, where `forces` was called last [m]."""
        ball, grooves = self._tried[k], self.balls.grooves
        if race == RACES[0]:
            return float(np.hypot(*(ball["c"] - ball["place"])) - grooves.inner)
        return float(np.hypot(*ball["place"]) - grooves.outer)

    def rest(self, omega: float, angle: float, q: _Floats) -> _Floats:
        """Put balls and films at rest with the ring at `q`, shape (n,); force of the ring on them, shape (n,).

        Films are those of the speed `omega` [rad/s]; the first ball is at `angle` [rad]. Not a number where a ball
        finds no balance.
        """
        self._place[:] = q
        given = *self._own, c_double(omega), c_double(angle), pointer(self._place), pointer(self._force)
        return self._answer(self.core.library.bearing_rest_at(*given))

    def begin(self, omega: float, dt: float) -> None:
        """Begin a step of `dt` [s], at whose end the shaft turns at `omega` [rad/s]."""
        self.core.library.bearing_begin(*self._own, c_double(dt), c_double(omega))

    def forces(self, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Force of the ring at `q`, moving at `v` at the end of the step, and its derivatives by both.

        Not a number where a ball finds no balance.
        """
        self._place[:], self._rate[:] = q, v
        force = self._answer(self._press())
        self._slopes()
        return force, self._stiffness.copy(), self._damping.copy()

    def accept(self) -> None:
        """Move balls, films and cage to the end of the step, as `forces` was called last."""
        self._accept()

    def drive(self, omega: float, dt: float, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats]:
        """Forces (k, n) of the ring, and of all balls (k, balls, 2), over steps that end at `q` and `v` (k, n).

        Not numbers from where on a ball finds no balance.
        """
        loads = np.full((len(q), self.balls.number, 2), nan)
        return self._drive(omega, dt, q, v, loads=loads), loads

    def tangents(self, omega: float, dt: float, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """As `drive`: forces (k, n), and their slopes by q and v at the end of each step, (k, n, n)."""
        stiffness, damping = np.full((2, *q.shape, q.shape[1]), nan)
        force = self._drive(omega, dt, q, v, stiffness=stiffness, damping=damping)
        return force, stiffness, damping

    def _drive(self, omega: float, dt: float, q: _Floats, v: _Floats, **found: _Floats) -> _Floats:
        """Forces over steps; `found`, arrays of "loads", or "stiffness" and "damping", are written as far."""
        motion, force = [np.ascontiguousarray(x, np.float64) for x in (q, v)], np.full(q.shape, nan)
        out = (found.get(name) for name in ("loads", "stiffness", "damping"))
        arrays = (None if array is None else pointer(array) for array in (*motion, force, *out))
        made = self.core.library.bearing_drive(*self._own, c_double(dt), c_double(omega), c_int(len(q)), *arrays)
        force[made:] = nan  # what the step that failed has left
        return force

    def _answer(self, why: bytes | None) -> _Floats:
        return self._force.copy() if why is None else np.full(self._force.size, nan)


class BearingMotion:
    """A bearing on a shaft of constant speed, in steps of one length.

    A step is tried as often as wanted (`forces`), from where the films are, and then accepted. The balls go round
    with the cage from step to step.

    Parameters
    ----------
    bearing : BallBearing
    speed_rpm : float
        Of the shaft; below 0 it turns backward, from y to x.
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
        A speed that the bearing does not take; a step that is not > 0, or longer than a 16th of the ball passage
        or of a turn of the shaft; other directions.
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
        backward = require_finite("speed_rpm", speed_rpm) < 0.0
        speed = bearing.speed(abs(speed_rpm))
        self._motion, self._size = motion_of(bearing, [speed], moving, backward=backward), len(moving)
        self.dt, self._omega = require_positive("dt", dt), (-speed if backward else speed) * RPM_TO_RAD_S
        require_short_steps(bearing, speed, self.dt)
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
        if abs(place).max() > FARTHEST:
            raise InputError("q", place.tolist(), f"at most {FARTHEST:g} m or rad in magnitude")
        if abs(rate).max() > FASTEST:
            raise InputError("v", rate.tolist(), f"at most {FASTEST:g} m/s or rad/s in magnitude")
        force, stiffness, damping = self._motion.forces(place, rate)
        return _finite(force, place), stiffness, damping

    def accept(self) -> None:
        """Move on to the end of the step, as `forces` was called last."""
        self._motion.accept()
        self._motion.begin(self._omega, self.dt)

    def drive(self, q: ArrayLike, v: ArrayLike) -> tuple[_Floats, _Floats]:
        """Forces along a motion whose rows are the ends of the steps from here.

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
        places = as_numbers("q", q)
        places = as_rows("q", places, len(np.atleast_1d(places)), self._size)
        found = self._motion.drive(self._omega, self.dt, places, as_rows("v", v, places.shape[0], self._size))
        self._motion.begin(self._omega, self.dt)
        return found

    def _put(self, angle: float, q: _Floats) -> _Floats:
        """Put all at rest with the ring at `q` and the first ball at `angle`, and begin a step."""
        force = _finite(self._motion.rest(self._omega, angle, q), q)
        self._motion.begin(self._omega, self.dt)
        return force


def require_short_steps(bearing: BallBearing, speed_rpm: float, dt: float) -> None:
    """Raise `InputError` for steps [s] in which balls or shaft go too far for their motion to be seen."""
    passage, turn = bearing.frequencies(speed_rpm).bpfo, speed_rpm / 60.0
    for what, hz in (("ball passage", passage), ("turn of the shaft", turn)):
        if dt * hz * LEAST_STEPS > 1.0:
            most = 1.0 / (hz * LEAST_STEPS)
            raise InputError("dt", dt, f"at most {most:.3g} s, a {LEAST_STEPS}th of the {what}")


def motion_of(
    bearing: BallBearing, speeds_rpm: list[float], directions: tuple[str, ...], *, backward: bool = False
) -> BallMotion:
    """Balls and films of a bearing in time, tables of its races made at increasing speeds [rev/min].

    The shaft turns forward, or `backward`: its speed is below 0.

    Raises
    ------
    InputError
        A speed that the bearing does not take.
    """
    speeds = [bearing.speed(speed) for speed in speeds_rpm]
    heights = heights_in_runs(bearing, speeds, backward)
    return BallMotion(bearing.tables.balls(speeds)._replace(heights=heights), directions)


def _finite(force: _Floats, q: _Floats) -> _Floats:
    if not np.isfinite(force).all():
        raise ConvergenceError(f"a ball finds no balance with the ring at {q.tolist()} m", None)
    return force
