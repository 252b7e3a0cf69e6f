"""Newton loop of a rotor's step in Python, for supports other than ball bearings and dampers: films, elements.

The step is that of `core_rotor`. Its balance is found on the displacements of the points at which supports act, by
Newton's method or, for contacts without tangents, secants.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from reduced_models.bearing.motion import BallMotion
from reduced_models.rotor.contact_protocol import has_tangents
from reduced_models.rotor.core_rotor import CoreRotor, FreeStep
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.squeeze_film_damper import DamperSteps

_Floats = NDArray[np.float64]

NOISE = 3.0  # change of force, over the allowed imbalance of one contact, that a secant needs to be believed
# Imbalance over the allowed one that a step may be left with where further iterations do not help: a full film's
# force is good to tol/30 of its static load, 1e-4 by default (`transient_film`); nothing below can be balanced.
LEFT_BY_FILMS = 10.0
OVERSHOOT = 2.0  # growth of the imbalance that halves the way to the last place: a contact opens or closes


class RunningSupport(Protocol):
    """Supports over the steps of a run: a group of contacts, one ball bearing, or one damper."""

    def begin(self, omega: float) -> None:
        """Begin a step at whose end the shaft turns at `omega` [rad/s]."""

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes along its line of motion and rate."""

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move to the end of the step, as `at` was called last."""

    def rewind(self) -> None:
        """Go back to the start of the step."""


class BallSteps:
    """One ball bearing over steps of one length `dt` [s]; `gain` leads from displacement to rate in a step.

    `shift` is the displacement of its ring beside that of the rotor.
    """

    def __init__(self, motion: BallMotion, dt: float, gain: float, shift: _Floats) -> None:
        self._motion, self._dt, self._gain, self._shift = motion, dt, gain, shift

    def begin(self, omega: float) -> None:
        """Begin a step at whose end the shaft turns at `omega` [rad/s]."""
        self._motion.begin(omega, self._dt)

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes, shape (directions, directions)."""
        force, stiffness, damping = self._motion.forces(r + self._shift, rate)
        return force, stiffness + self._gain * damping

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""
        return self.at(r, rate)[1]

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move to the end of the step."""
        self._motion.accept()

    def rewind(self) -> None:
        """Nothing: balls move where a step is accepted."""


class PythonSteps:
    """Steps of a run with supports in Python, which stand at the start of a step until it is accepted.

    Parameters
    ----------
    run : PreparedRun
    tolerance : float
        Largest imbalance over the largest of the forces at the start.
    most : int
        Evaluations in a step.
    bearings : sequence of RunningSupport, optional
        The ball bearings; by default `BallSteps` of each.

    Attributes
    ----------
    core : CoreRotor
    bearing_states : list of ndarray
        Numbers of every ball bearing.
    """

    made = reached = 0  # steps, and the last one that was begun

    def __init__(
        self, run: PreparedRun, tolerance: float, most: int, bearings: Sequence[RunningSupport] | None = None
    ) -> None:
        self._run, self._most, self._in_step = run, most, False
        self.core, self._matrices_at = CoreRotor(run.rotor, run.dt, run.rho_inf), math.nan
        _, self._normals, counts = run.rotor.geometry
        self._to_points = counts[:, None] * self._normals  # (m, n): forces of the points are force @ to_points
        d, force = run.histories.displacement[0], run.histories.force[0]
        self.core.put(run.state, force @ self._to_points, run.applied(0))
        _, _, K = run.rotor.matrices(run.omega[0])
        carried = np.abs(self._normals.T @ (counts * force)).max(initial=0.0)
        turning, load = np.abs(run.turning).max(initial=0.0), np.abs(run.rotor.load).sum()
        scale = float(max(load, np.abs(K @ d).max(), turning, carried))
        self._scale = scale if scale > 0.0 else 1.0
        self._allowed = tolerance * self._scale
        self._has_films = not all(has_tangents(mount.contact) for mount in run.rotor.contacts)
        self.bearing_states = [balls.state for balls in run.balls]
        self._supports: list[tuple[slice, RunningSupport]] = []
        first = len(run.rotor.contacts)
        if first:
            run.contacts.noise = NOISE * self._allowed / counts[:first].max()
            self._supports.append((slice(0, first), run.contacts))
        if bearings is None:
            bearings = [
                BallSteps(balls, run.dt, run.contacts.gain, run.shift[at])
                for at, balls in zip(run.ball_directions, run.balls, strict=True)
            ]
        self._supports += zip(run.ball_directions, bearings, strict=True)
        rotor = run.rotor
        for mount, name, at in zip(
            rotor.film_dampers, rotor.film_damper_names, rotor.film_damper_columns, strict=True
        ):
            self._supports.append((at, DamperSteps(mount.damper, run.contacts.gain, name)))

    def advance(self, omega: float, first: int, end: int, progress: Callable[[int], None]) -> None:
        """Make the steps of one block, of matrices at `omega`; `progress` takes the number made, after each.

        Raises
        ------
        ConvergenceError
            A step found no balance, or a contact in it did not converge, and the histories stay as they were; or
            the ring of a ball bearing left it.
        """
        if math.isnan(self._matrices_at) or (self._run.rotor.changes_with_speed and omega != self._matrices_at):
            self.core.take_matrices(omega)
            self._matrices_at = omega
        for i in range(first + 1, end + 1):
            self.reached = i
            self._step(i)
            self.made = i
            lost = self._run.lost(i - 1, i)
            if lost is not None:
                raise ConvergenceError(lost[1], None)
            progress(i)

    def _step(self, i: int) -> None:
        """Make step `i` of the run, counted from 1."""
        run, core = self._run, self.core
        step = core.free_step(run.applied(i))
        for _, support in self._supports:
            support.begin(run.omega[i])
        q, r, r_rate, found, count = self._balance(step, self._predict(step, i))
        # by what brings the points there: rotor and supports stay together where the balance leaves an imbalance
        core.end_step(q, (step.stiffness @ (step.free - q)) / step.weight, found @ self._to_points)
        d, v, run.state[2] = core.motion
        for history, value in zip(run.histories, (d, v, r, r_rate, found, count), strict=True):
            history[i] = value
        self._in_step = False  # last: Ctrl-C may come between any two lines

    def rewind(self) -> None:
        """Supports back to the end of the last step that is in the histories."""
        if self._in_step:
            for _, support in self._supports:
                support.rewind()

    def _predict(self, step: FreeStep, i: int) -> _Floats:
        """Place of the points from extrapolated motions and forces, tied together by the slopes.

        Extrapolating the force alone fails where a support is stiffer than the inertia in a step, the motion
        alone where it is softer; the linear model through both is good in either case.
        """
        r, rate, force = (_extrapolated(history, i - 1) for history in self._run.histories[2:5])
        slopes = np.zeros((r.size, r.size))
        for columns, support in self._supports:
            slopes[columns, columns] = support.expected(r[columns], rate[columns])
        right = step.stiffness @ step.free - step.weight * ((force - slopes @ r) @ self._to_points)
        return np.asarray(np.linalg.solve(self._system(step, slopes), right), dtype=np.float64)

    def _balance(self, step: FreeStep, q: _Floats) -> tuple[_Floats, _Floats, _Floats, _Floats, int]:
        """Newton's method for ``D (q - free) + weight F = 0``: points, motions, rates, forces, evaluations."""
        error, previous, last = math.inf, math.inf, q
        force, slopes = np.zeros(len(self._normals)), np.zeros((len(self._normals), len(self._normals)))
        for iteration in range(1, self._most + 1):
            r, rate = self._normals @ q, self._normals @ (step.gain * q + step.history)
            self._in_step = True
            for columns, support in self._supports:
                force[columns], slopes[columns, columns] = support.at(r[columns], rate[columns])
            residual = step.stiffness @ (q - step.free) + step.weight * (force @ self._to_points)
            error = float(np.linalg.norm(residual))
            left = LEFT_BY_FILMS if iteration == self._most and self._has_films else 1.0
            if error <= left * self._allowed:
                for columns, support in self._supports:
                    support.accept(r[columns], rate[columns])
                return q, r, rate, force, iteration
            if not math.isfinite(error):
                break
            if error > OVERSHOOT * previous:
                q = 0.5 * (q + last)  # a kink lies between
                continue
            previous, last = error, q
            q = q - np.linalg.solve(self._system(step, slopes), residual)
        found = f"force imbalance {error:.3g} N above {self._allowed:.3g} N in {iteration} iterations"
        hint = self.core.rounding_hint(q, self._allowed, self._scale)
        if not hint and self._has_films:
            hint = (
                ": the force of a contact that is solved in every step is good to its own tolerance; take a "
                "smaller tol of TransientContact, or a larger tolerance of simulate_rotor"
            )
        raise ConvergenceError(found + hint, None)

    def _system(self, step: FreeStep, slopes: _Floats) -> _Floats:
        return np.asarray(step.stiffness + step.weight * (self._to_points.T @ slopes @ self._normals))


def _extrapolated(history: _Floats, n: int) -> _Floats:
    """Values after entry `n` of a history, from the last four or as many as there are."""
    if n >= 3:
        return 4.0 * (history[n] + history[n - 2]) - 6.0 * history[n - 1] - history[n - 3]
    if n == 2:
        return 3.0 * (history[n] - history[n - 1]) + history[n - 2]
    return 2.0 * history[n] - history[n - 1] if n == 1 else history[0]
