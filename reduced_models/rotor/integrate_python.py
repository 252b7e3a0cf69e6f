"""Time integration (generalised-alpha) in Python, for supports without a compiled kernel: full films, elements.

The matrices and equations are those of `integrate_compiled`. Only the balance of a step is found here, on the
displacements of the points at which supports act, by Newton's method or, for contacts without tangents, secants.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from reduced_models.bearing.balls import Balls, accept_balls, begin_step, directions, press_balls, speed_state
from reduced_models.rotor.contact import ContactForces
from reduced_models.rotor.integrate_compiled import Steps
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount, ContactMount, is_ball_bearing

_Floats = NDArray[np.float64]

NOISE = 3.0  # change of force, over the allowed imbalance of one contact, that a secant needs to be believed
OVERSHOOT = 2.0  # growth of the imbalance that halves the way to the last place: a contact opens or closes


class RunningSupport(Protocol):
    """Supports over the steps of a run: a group of contacts, or one ball bearing."""

    def begin(self, omega: float, angle: float) -> None:
        """Begin a step at whose end the shaft turns at `omega` [rad/s] and the first ball is at `angle`."""

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes along its line of motion and rate."""

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move to the end of the step, as `at` was called last."""

    def rewind(self) -> None:
        """Go back to the start of the step."""


class RunningContacts:
    """All contacts of a rotor."""

    def __init__(self, mounts: Sequence[ContactMount], dt: float, gain: float) -> None:
        self.forces = ContactForces([mount.contact for mount in mounts], dt, gain)
        self._offsets = np.array([mount.offset for mount in mounts])

    def start(self, r: _Floats, rate: _Floats) -> _Floats:
        """Forces at the very start of a run."""
        return self.forces.start(r + self._offsets, rate)

    def begin(self, omega: float, angle: float) -> None:
        """Begin a step; contacts do not depend on the speed of the shaft here."""
        self.forces.begin()

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes, a diagonal matrix."""
        force = self.forces.at(r + self._offsets, rate)
        return force, np.diag(self.forces.last_slopes)

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""
        return np.diag(self.forces.slopes(r + self._offsets, rate))

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move to the end of the step."""
        self.forces.accept(r + self._offsets, rate)

    def rewind(self) -> None:
        """Go back to the start of the step."""
        self.forces.rewind()


class RunningBalls:
    """One ball bearing, whose films and balls are at rest where the run starts."""

    def __init__(self, balls: Balls, films: object, dt: float, gain: float) -> None:
        self._balls, self._films, self._dt, self._gain = balls, films, dt, gain
        self._normals = np.zeros((balls.number, 2))
        self._pushed = np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2))
        self._state = speed_state(balls, 0.0)
        self._own = 0.0

    def begin(self, omega: float, angle: float) -> None:
        """Begin a step at whose end the shaft turns at `omega` [rad/s] and the first ball is at `angle`."""
        self._state = speed_state(self._balls, omega)
        directions(self._balls, angle, self._normals)
        self._own = begin_step(self._balls, self._state, self._dt, self._films)

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes, shape (2, 2)."""
        press_balls(self._balls, self._state, self._films, self._normals, r, rate, self._own, self._pushed)
        force, stiffness, damping = self._pushed
        return force.copy(), stiffness + self._gain * damping

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""
        return self.at(r, rate)[1]

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move to the end of the step."""
        accept_balls(self._balls, self._state, self._films, self._normals, r, rate, self._own)

    def rewind(self) -> None:
        """Nothing: balls move where a step is accepted."""


class PythonSteps:
    """Steps of a run with supports in Python, which stand at the start of a step until it is accepted.

    Parameters
    ----------
    supports : sequence of (slice, RunningSupport)
        With their places among the motions of all supports.
    geometry : (ndarray, ndarray, ndarray)
        Displacements of the points at which supports act from those of the rotor, shape (n, N); motions of the
        supports from those of the points, shape (m, n); how often each force acts, shape (m,).
    state : ndarray, shape (4, N)
        Displacement, velocity and acceleration; room.
    histories : tuple of ndarray
        Displacement and velocity (k, N), motion, rate and force of the supports (k, m), evaluations (k,).
    limits : (float, int)
        Largest imbalance of a step [N], and evaluations.
    """

    def __init__(
        self,
        supports: Sequence[tuple[slice, RunningSupport]],
        geometry: tuple[_Floats, _Floats, _Floats],
        state: _Floats,
        histories: tuple[_Floats, ...],
        limits: tuple[float, int],
    ) -> None:
        self._supports = supports
        self._points, self._normals, self._counts = geometry
        self._pull = self._counts[:, None] * self._normals  # (m, n): forces of the points are force @ pull
        self._state, self._histories = state, histories
        self._allowed, self._most = limits
        self._torn = False

    def advance(self, steps: Steps, i: int, course: tuple[_Floats, _Floats, _Floats]) -> None:
        """Make step `i` of a run, counted from 1; `ConvergenceError` leaves the histories as they were."""
        omega, angles, turned = course
        displacement, velocity, approach, rate, force, iterations = self._histories
        d, v, a = self._state[:3]
        share = 1.0 - steps.weight
        held = steps.weight * turned[i] + share * turned[i - 1]
        free = steps.constant + self._state[:3].ravel() @ steps.past.reshape(-1, d.size) + held @ steps.turning
        free -= (share * (force[i - 1] @ self._pull)) @ steps.columns
        gain, by_d, by_v, by_a = steps.velocity
        past_rate = by_d * d + by_v * v + by_a * a
        for k, (_, support) in enumerate(self._supports, start=angles.shape[1] - len(self._supports)):
            support.begin(omega[i], angles[i, k] if k >= 0 else 0.0)  # contacts, which come first, have no angle
        q_free, point_rate = self._points @ free, self._points @ past_rate
        q, r, r_rate, found, count = self._balance(steps, q_free, point_rate, self._predict(steps, i, q_free))
        new = free + (steps.D @ (q - q_free)) @ steps.columns
        a0, a1, a2, a3 = steps.acceleration
        self._state[2] = a0 * new + a1 * d + a2 * v + a3 * a
        self._state[1], self._state[0] = gain * new + past_rate, new
        displacement[i], velocity[i], approach[i], rate[i] = new, self._state[1], r, r_rate
        force[i], iterations[i] = found, count
        self._torn = False  # last: Ctrl-C may come between any two lines

    def rewind(self) -> None:
        """Supports back to the end of the last step that is in the histories."""
        if self._torn:
            for _, support in self._supports:
                support.rewind()

    def _predict(self, steps: Steps, i: int, q_free: _Floats) -> _Floats:
        """Place of the points from extrapolated motions and forces, tied together by the slopes.

        Extrapolating the force alone fails where a support is stiffer than the inertia in a step, the motion
        alone where it is softer; the linear model through both is good in either case.
        """
        r, rate, force = (_extrapolated(history, i - 1) for history in self._histories[2:5])
        slopes = np.zeros((r.size, r.size))
        for columns, support in self._supports:
            slopes[columns, columns] = support.expected(r[columns], rate[columns])
        right = steps.D @ q_free - steps.weight * ((force - slopes @ r) @ self._pull)
        return np.asarray(np.linalg.solve(self._system(steps, slopes), right), dtype=np.float64)

    def _balance(
        self, steps: Steps, q_free: _Floats, point_rate: _Floats, q: _Floats
    ) -> tuple[_Floats, _Floats, _Floats, _Floats, int]:
        """Newton's method for ``D (q - q_free) + weight F = 0``: points, motions, rates, forces, evaluations."""
        error, previous, last = math.inf, math.inf, q
        force, slopes = np.zeros(len(self._normals)), np.zeros((len(self._normals), len(self._normals)))
        for iteration in range(1, self._most + 1):
            r, rate = self._normals @ q, self._normals @ (steps.velocity[0] * q + point_rate)
            self._torn = True
            for columns, support in self._supports:
                force[columns], slopes[columns, columns] = support.at(r[columns], rate[columns])
            residual = steps.D @ (q - q_free) + steps.weight * (force @ self._pull)
            error = float(np.linalg.norm(residual))
            if error <= self._allowed:
                for columns, support in self._supports:
                    support.accept(r[columns], rate[columns])
                return q, r, rate, force, iteration
            if not math.isfinite(error):
                break
            if error > OVERSHOOT * previous:
                q = 0.5 * (q + last)  # a kink lies between
                continue
            previous, last = error, q
            q = q - np.linalg.solve(self._system(steps, slopes), residual)
        raise ConvergenceError(
            f"force imbalance {error:.3g} N above {self._allowed:.3g} N in {iteration} iterations", None
        )

    def _system(self, steps: Steps, slopes: _Floats) -> _Floats:
        return np.asarray(steps.D + steps.weight * (self._pull.T @ slopes @ self._normals))


def _extrapolated(history: _Floats, n: int) -> _Floats:
    """Values after entry `n` of a history, from the last four or as many as there are."""
    if n >= 3:
        return 4.0 * (history[n] + history[n - 2]) - 6.0 * history[n - 1] - history[n - 3]
    if n == 2:
        return 3.0 * (history[n] - history[n - 1]) + history[n - 2]
    return 2.0 * history[n] - history[n - 1] if n == 1 else history[0]


def active_mounts(rotor: Rotor) -> tuple[list[ContactMount], list[BearingMount]]:
    """Supports that are not linear: contacts, then ball bearings."""
    contacts = [mount for mount in rotor.mounts if isinstance(mount, ContactMount)]
    return contacts, [
        mount for mount in rotor.mounts if isinstance(mount, BearingMount) and is_ball_bearing(mount)
    ]


def geometry_of(rotor: Rotor) -> tuple[_Floats, _Floats, _Floats]:
    """`points`, `normals` and `counts` of `PythonSteps`, for contacts, then ball bearings."""
    contacts, bearings = active_mounts(rotor)
    places = list(dict.fromkeys(place for mount in contacts for place in mount.ends[0] if place is not None))
    points = np.concatenate([np.eye(rotor.size)[places], *(mount.rows(rotor.size) for mount in bearings)])
    normals = np.zeros((len(contacts) + 2 * len(bearings), len(points)))
    for k, mount in enumerate(contacts):
        normals[k, : len(places)] = mount.rows(rotor.size)[0, places]
    normals[len(contacts) :, len(places) :] = np.eye(2 * len(bearings))
    counts = np.array([mount.count for mount in contacts] + [1.0] * 2 * len(bearings))
    ranks = [0 if k == 0 else np.linalg.matrix_rank(points[:k]) for k in range(len(points) + 1)]
    kept = [k for k in range(len(points)) if ranks[k + 1] > ranks[k]]
    if len(kept) < len(points):  # a contact on the journal of a bearing, say
        normals = np.asarray(normals @ np.linalg.lstsq(points[kept].T, points.T)[0].T)
    return points[kept], normals, counts
