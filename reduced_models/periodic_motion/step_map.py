"""`StepMap`: one period of steps of a rotor as a map of numbers onto numbers.

Rotor, bearings, balls, films and contacts are numbers at the start of a period, and numbers at its end. A motion
is periodic where both are equal; the derivative of the map has the Floquet multipliers. The steps are those of
`simulate_rotor`, so that a run from a fixed point stays there.

Balls of a bearing pass, or its cage stands still at several positions, over which its forces are means: several
bearings in one place, each with its share (`mean_bearing`). With balls that pass the cage goes on by a pitch in a
period, ball k takes the place of ball k + 1, and their records are moved on: equal states have equal numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import compress, pairwise
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_integer, require_positive
from ehlcontact.errors import InputError
from ehlcontact.status import Status
from reduced_models.bearing.features import RaceWaviness
from reduced_models.bearing.motion import BallMotion
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.excitation import (
    PASSAGE,
    UNBALANCE,
    Excitation,
    PeriodicForce,
    require_excitation,
)
from reduced_models.periodic_motion.mean_bearing import mean_result, mean_rotor
from reduced_models.rotor.contact_protocol import has_tangents
from reduced_models.rotor.integrate_compiled import CompiledSteps
from reduced_models.rotor.integrate_python import PythonSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor, Unbalance
from reduced_models.rotor.simulate import run_result
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

# Imbalance of a step over the forces: differences of maps are taken. In Python rounding may not hide it.
BALANCED, BALANCED_IN_PYTHON = 1e-12, 1e-10
SEEN = 16  # times in a period at which numbers are looked at for their scale
EVALUATIONS = 60  # of contacts in a step
DRIVEN = 3  # periods for which films follow a given motion before the map begins
POSITIONS = 4  # of the cage of a mean bearing
APART, CAGES_APART = 1e-9, 1e-7  # shares by which equal passage frequencies, and cages that turn alike, differ
LEAST_SHARE, LEAST_VARIATION = 1e-2, 1e-4  # of the largest freedom's motion, of a number's value: least scale
# Numbers of balls, films and surfaces that a step leads on; others are outputs, slopes or sums.
BALL = "place", "rate", "factor", "speed_sum", "lift", "force"
FILM = "approach", "rate", "own", "inlet", "fast", "entered", "chain"
DRY = FILM[:2]  # the others stay what they are, and would be eigenvalues of the balls' change of places
SURFACE = "rotation", "height"


class StepMap:
    """Map of the numbers of a rotor over a period, or several, of what excites it.

    Parameters
    ----------
    rotor : Rotor
    speed_rpm : float
        Of the shaft [rev/min].
    excitation : "unbalance", "passage" or PeriodicForce
    periods : int
        Periods of the excitation in one of the map.
    steps : int
        In a period of the excitation.
    positions : int
        Of the cage of a mean bearing.
    bearing : int, optional
        Of which balls pass, among the ball bearings of the rotor, the others being means; None: of all of them.
    period : float, optional
        Of a passage [s], where contact angles change the speed of the cage.
    start : PeriodicAnswer, (ndarray, ndarray) or "static"
        Motion from which films and balls begin: another answer, places and velocities at t = 0, or equilibrium.
    rho_inf : float
        As of `simulate_rotor`.

    Attributes
    ----------
    rotor : Rotor
        As it is excited: without unbalances under ball passage, with its mean bearings.
    run : PreparedRun
    steps, periods : int
        Steps of the map, periods of the excitation in it.
    numbers : ndarray
        At the start; the fixed point where it was found.
    scale : ndarray
        Of the numbers: how far they go in a period.

    Raises
    ------
    InputError
        Another excitation, bearings with different passage frequencies, features that break the symmetry of the
        passage, contacts whose state is not made of numbers; what `simulate_rotor` refuses.
    """

    def __init__(
        self,
        rotor: Rotor,
        speed_rpm: float,
        excitation: Excitation,
        *,
        periods: int = 1,
        steps: int = 256,
        positions: int = POSITIONS,
        bearing: int | None = 0,
        period: float | None = None,
        start: Any = "static",
        rho_inf: float = 0.8,
    ) -> None:
        require_excitation(excitation, rotor)
        self.periods = require_integer("periods", periods, "a whole number >= 1", 1)
        self.steps = require_integer("steps", steps, "a whole number >= 16", 16) * periods
        require_integer("positions", positions, "a whole number >= 1", 1)
        self.excitation, self.speed_rpm, self.given = excitation, require_positive("speed_rpm", speed_rpm), rotor
        self._again = partial(
            StepMap, periods=periods, steps=steps, positions=positions, bearing=bearing, rho_inf=rho_inf
        )
        passing = [excitation == PASSAGE and bearing in (k, None) for k in range(len(rotor.ball_bearings))]
        self._copies = [1 if passes else positions for passes in passing]
        self._passes = np.repeat(passing, self._copies).tolist()
        once = self._period(list(compress(rotor.ball_bearings, passing)), period)
        self.rotor = mean_rotor(_excited(rotor, excitation), self._copies)
        places, speeds = _motion(start, rotor, speed_rpm, self.steps)
        begin = places[0].copy(), speeds[0].copy()
        self.run = run = PreparedRun(self.rotor, speed_rpm, once / steps, self.steps, begin, rho_inf)
        if isinstance(excitation, PeriodicForce):
            self._apply(excitation)
        for balls, passes in zip(run.balls, self._passes, strict=True):
            balls.core.structure.cage_held = not passes
        self._drive(places, speeds)
        self._integrator = _integrator(run)
        self._core = self._integrator.core
        self._groups = list(self._grouped())
        self._angles = [balls.angle for balls in run.balls]
        self._turned = [1.0 for _ in run.balls]
        self._hold(None)
        self.numbers = self._taken()
        self.scale = self._measured()

    @property
    def period(self) -> float:
        """Of the map [s]."""
        return float(self.run.dt * self.steps)

    @property
    def residual(self) -> float:
        """Largest difference of places between end and start of the last period, over the largest place."""
        places = self.run.histories.displacement
        return float(np.abs(places[self.steps] - places[0]).max() / np.abs(places).max())

    def __call__(self, numbers: _Floats) -> _Floats:
        """Numbers a period later.

        Raises
        ------
        ConvergenceError
            A step found no balance, or a ring left its bearing.
        """
        self._put(numbers)
        self._advance(0, self.steps)
        return self._taken()

    def along(self, numbers: _Floats, after: _Floats, direction: _Floats, size: float) -> _Floats:
        """Derivative of the map along a direction, both over `scale`, by a difference.

        Parameters
        ----------
        numbers, after : ndarray
            Where the derivative is, and where the map leads from there.
        direction : ndarray
        size : float
            Of the change, over `scale`: forces have kinks of the power 3/2, and rounding its share of small ones.
        """
        change = size * self.scale
        return np.asarray((self(numbers + change * direction) - after) / change)

    def march(self, numbers: _Floats, count: int) -> _Floats:
        """Numbers after `count` periods; they become those of the map."""
        for _ in range(count):
            numbers = self(numbers)
            self._hold(numbers)
        self.numbers = numbers
        return numbers

    def settle(self, numbers: _Floats) -> None:
        """Take numbers as those of the start, and their scale from the period after them."""
        self.begin(numbers)
        self.scale = self._measured()

    def begin(self, numbers: _Floats) -> None:
        """Take numbers as those of the start."""
        self._hold(numbers)
        self.numbers = numbers

    def result(self, numbers: _Floats, status: Status = Status.CONVERGED) -> RotorResult:
        """The period from these numbers as a run."""
        self._put(numbers)
        self._advance(0, self.steps)
        self.run.histories.force[0] = self.run.histories.force[self.steps]
        return mean_result(run_result(self.run, self.steps, status), self.given, self._copies)

    def at(self, rotor: Rotor, speed_rpm: float, excitation: Excitation, period: float | None = None) -> StepMap:
        """A map of another setting that begins with the state of this one."""
        n = self.rotor.size
        here = self.numbers[:n], self.numbers[n : 2 * n]
        other = self._again(rotor, speed_rpm, excitation, period=period, start=here)
        other.settle(self.numbers)
        return other

    @property
    def places(self) -> _Floats:
        """Displacements of the rotor at the start, shape (N,); a copy."""
        return self.numbers[: self.rotor.size].copy()

    @property
    def cage_left(self) -> float:
        """By how much a cage missed its pitch in the last period, over the pitch; 0 where all stand."""
        return max((abs(share - 1.0) for share in self._turned), default=0.0)

    @property
    def passage(self) -> float:
        """Period of the excitation with which the cages would have gone on by their pitch [s].

        Raises
        ------
        InputError
            Cages that turn at different speeds.
        """
        turned = list(compress(self._turned, self._passes))
        if np.ptp(turned) > CAGES_APART:
            shown = ", ".join(f"{share:.8g}" for share in turned)
            raise InputError(
                "cages", f"going on by {shown} pitches", "equally fast: else the motion is quasi-periodic"
            )
        return self.period / self.periods / float(np.mean(turned))

    @property
    def reservation(self) -> str:
        """What the excitation leaves out, in words; else empty."""
        if self.excitation == PASSAGE and self.given.unbalances:
            return "unbalances are left out: with balls that pass they have no common period"
        if self.excitation != PASSAGE and self.given.ball_bearings:
            return "bearings are means over positions of the cage: the passage of balls is left out"
        return ""

    def _period(self, passing: Sequence[BearingMount], period: float | None) -> float:
        """Of the excitation [s]; of the balls of these bearings where they pass."""
        for mount in self.given.ball_bearings:
            for feature in mount.ball_bearing.features:
                if not (isinstance(feature, RaceWaviness) and feature.race == "outer"):
                    allowed = "waviness of an outer race: others do not repeat themselves with the motion"
                    raise InputError("features", str(feature), allowed)
        if isinstance(self.excitation, PeriodicForce):
            return 1.0 / self.excitation.hz
        if self.excitation == UNBALANCE:
            return 60.0 / self.speed_rpm
        if not passing:
            last = len(self.given.ball_bearings) - 1
            raise InputError("bearing", self._again.keywords["bearing"], f"from 0 to {last}, of the ball bearings")
        hz = [mount.ball_bearing.frequencies(self.speed_rpm).bpfo for mount in passing]
        if max(hz) - min(hz) > APART * max(hz):
            shown = ", ".join(f"{one:.6g}" for one in hz)
            allowed = "the same at all bearings whose balls pass: else the motion is quasi-periodic"
            raise InputError("passage", f"of {shown} Hz", allowed)
        return 1.0 / hz[0] if period is None else period

    def _apply(self, force: PeriodicForce) -> None:
        """Put a force among those that turn with the shaft."""
        n, most = self.rotor.size, max(np.size(values) for values in force.amplitudes.values())
        phase = 2.0j * pi * self.periods * np.arange(self.steps + 1) / self.steps
        waves = np.exp(phase[:, None] * np.arange(most + 1))
        self.run.turning[:] = 0.0
        self.run.turning[:, -2 * n :: 2] = np.real(waves @ force.spectrum(n, most, 1))

    def _drive(self, places: _Floats, speeds: _Floats) -> None:
        """Films and balls as after some periods of this motion, and the rotor with their forces at its start."""
        run, geometry, again = self.run, self.rotor.geometry, slice(1, None)
        times = -(-DRIVEN // self.periods)
        r, rate = (motion @ geometry.points.T @ geometry.normals.T for motion in (places, speeds))
        for at, balls, passes in zip(run.ball_directions, run.balls, self._passes, strict=True):
            for _ in range(times):
                driven = balls.drive(run.omega[0], run.dt, r[again, at] + run.shift[at], rate[again, at])[0]
                _moved_on(balls, self.periods if passes else 0)
                run.histories.force[0, at] = driven[-1]
        for k, mount in enumerate(self.rotor.contacts):
            contact = mount.contact
            if contact.save_state() is not None:
                if not has_tangents(contact):
                    raise InputError(f"contacts[{k}]", type(contact).__name__, "an element: its state is numbers")
                for _ in range(times):
                    for u, v in zip(r[again, k] + mount.offset, rate[again, k], strict=True):
                        run.histories.force[0, k] = contact.advance(run.dt, float(u), float(v))
        M, C, K = self.rotor.matrices(run.omega[0])
        carried = geometry.points.T @ (geometry.normals.T @ (geometry.counts * run.histories.force[0]))
        run.state[2] = np.linalg.solve(M, run.applied(0) - carried - C @ run.state[1] - K @ run.state[0])

    def _grouped(self) -> Iterator[tuple[int, NDArray[np.int64], float]]:
        """Numbers of the state that a step leads on: piece, places in it, least share of the group's scale."""
        n, p = self.rotor.size, len(self.rotor.geometry.points)
        for first in (0, n, 2 * n):
            yield 0, np.arange(first, first + n), LEAST_SHARE
        yield 0, np.arange(3 * n + 3 * p, 3 * n + 4 * p), 1.0
        for piece, balls in enumerate(self.run.balls, 1):
            core, count = balls.core, np.arange(balls.state.size, dtype=np.float64)
            films = core.films(count), FILM if balls.balls.inner.x.size else DRY
            for records, names in ((core.balls(count), BALL), films, (core.surfaces(count), SURFACE)):
                for name in names:
                    yield piece, records[name].ravel().astype(np.int64), 1.0
            yield piece, core.head(count)["cage"].ravel().astype(np.int64), 1.0
            for row in core.seat(count)[1:]:
                yield piece, row.astype(np.int64), LEAST_SHARE
        for piece, saved in enumerate(self._memories(), 1 + len(self.run.balls)):
            yield piece, np.arange(saved.size), 0.0

    def _memories(self) -> list[_Floats]:
        """States of the contacts that have a memory."""
        saved = (mount.contact.save_state() for mount in self.rotor.contacts)
        return [np.asarray(state, np.float64) for state in saved if state is not None]

    def _pieces(self) -> list[_Floats]:
        """The whole state: rotor with bearings in C, or rotor and bearings, and contacts."""
        return [self._core.state, *self._integrator.bearing_states, *self._memories()]

    def _hold(self, numbers: _Floats | None) -> None:
        """Keep the whole state, but for its numbers, as it is; at the start of a period sums begin anew."""
        if numbers is not None:
            self._place(numbers)
        states = self._integrator.bearing_states
        for angle, balls, state in zip(self._angles, self.run.balls, states, strict=True):
            surfaces = balls.core.surfaces(state)
            surfaces["fatigue"], surfaces["largest"], surfaces["angle"] = 0.0, 0.0, 0.0
            balls.core.head(state)["angle"], balls.core.shaft(state)[:] = angle, 0.0
        self._frames = [piece.copy() for piece in self._pieces()]
        self._force = self.run.histories.force[0 if numbers is None else self.steps].copy()

    def _put(self, numbers: _Floats) -> None:
        """State of the start with these numbers, and the first entry of the histories."""
        for piece, frame in zip(self._pieces(), self._frames, strict=True):
            piece[:] = frame
        self._place(numbers)
        histories, geometry, (d, v, _) = self.run.histories, self.rotor.geometry, self._core.motion
        histories.displacement[0], histories.velocity[0] = d, v
        histories.motion[0] = geometry.normals @ (geometry.points @ d)
        histories.rate[0] = geometry.normals @ (geometry.points @ v)
        histories.force[0] = self._force

    def _place(self, numbers: _Floats) -> None:
        """Write numbers into the state."""
        pieces, first = self._pieces(), 0
        for piece, places, _ in self._groups:
            pieces[piece][places] = numbers[first : first + places.size]
            first += places.size
        memories = iter(pieces[1 + len(self.run.balls) :])
        for mount in self.rotor.contacts:
            if mount.contact.save_state() is not None:
                mount.contact.restore_state(next(memories))
        for balls, state in zip(self.run.balls, self._integrator.bearing_states, strict=True):
            if state is not balls.state:
                balls.state[:] = state

    def _advance(self, first: int, end: int) -> None:
        self._integrator.advance(float(self.run.omega[0]), first, end, lambda made: None)

    def _taken(self) -> _Floats:
        """Numbers of the state, the records of the balls moved on by a pitch where they have passed."""
        pieces = self._pieces()
        for k, balls in enumerate(self.run.balls):
            if not self._passes[k]:
                continue
            state = pieces[k + 1].copy()
            turned = float(balls.core.head(state)["angle"][0]) - self._angles[k]
            if turned > 0.0:
                self._turned[k] = turned * balls.balls.number / (2.0 * pi * self.periods)
                _rotated(balls, state, self.periods)
                pieces[k + 1] = state
        return np.concatenate([pieces[piece][places] for piece, places, _ in self._groups])

    def _measured(self) -> _Floats:
        """How far every number goes in the period from the start."""
        self._put(self.numbers)
        seen, ends = [self.numbers], np.linspace(0, self.steps, SEEN * self.periods + 1).astype(int).tolist()
        for first, end in pairwise(ends):
            self._advance(first, end)
            pieces = self._pieces()
            seen.append(np.concatenate([pieces[piece][places] for piece, places, _ in self._groups]))
        history, scale, first = np.array(seen), np.ones(self.numbers.size), 0
        for _, places, share in self._groups:
            here = slice(first, first + places.size)
            moved, most = np.ptp(history[:, here], axis=0), np.abs(history[:, here]).max(initial=0.0)
            least = max(share * moved.max(initial=0.0), LEAST_VARIATION * most)
            scale[here] = np.maximum(moved, least) if least > 0.0 else 1.0
            first += places.size
        # rounding is large in velocities, and in accelerations
        by_order = scale[: 3 * self.rotor.size].reshape(3, -1)
        by_order[1] = np.maximum(by_order[1], by_order[0] * 2.0 * pi / self.period)
        by_order[2] = np.maximum(by_order[2], by_order[1] / self.run.dt)
        return scale


def _integrator(run: PreparedRun) -> CompiledSteps | PythonSteps:
    """Steps whose forces balance to rounding."""
    if not run.compiled:
        return PythonSteps(run, BALANCED_IN_PYTHON, EVALUATIONS)
    steps = CompiledSteps(run, BALANCED)
    numbers = steps.core.structure
    numbers.allowed, numbers.balanced, numbers.floor = 0.0, BALANCED, 1.0  # shares of the forces, or rounding
    return steps


def _rotated(balls: BallMotion, state: _Floats, by: int) -> None:
    """Move the records of the balls on by so many places."""
    for records in (balls.core.balls(state), balls.core.films(state), balls.core.surfaces(state)):
        records[:] = np.roll(records, by, axis=0)


def _moved_on(balls: BallMotion, pitches: int) -> None:
    """Take the cage back by so many pitches, every ball in the place of one behind it."""
    if pitches:
        _rotated(balls, balls.state, pitches)
        balls.core.head(balls.state)["angle"] -= 2.0 * pi / balls.balls.number * pitches


def _excited(rotor: Rotor, excitation: Excitation) -> Rotor:
    """The rotor with what excites it alone; of a force, with unbalances of 0 everywhere, which get it."""
    if excitation == UNBALANCE:
        return rotor
    if excitation == PASSAGE:
        return replace(rotor, unbalances=())
    places = tuple(Unbalance(x=k, y=None, amount=0.0) for k in range(rotor.size))
    return replace(rotor, unbalances=places)


def _motion(start: Any, rotor: Rotor, speed_rpm: float, steps: int) -> tuple[_Floats, _Floats]:
    """Places and velocities over a period, shape (steps + 1, N)."""
    if isinstance(start, PeriodicAnswer):
        return resampled(start.run.displacement, steps), resampled(start.run.velocity, steps)
    if isinstance(start, str):
        start = rotor.equilibrium(speed_rpm), np.zeros(rotor.size)
    places, speeds = np.tile(start[0], (steps + 1, 1)), np.zeros((steps + 1, rotor.size))
    speeds[0] = start[1]
    return places, speeds


def resampled(history: _Floats, steps: int) -> _Floats:
    """A periodic history, shape (k + 1, N), at `steps` + 1 times over the same period, by its harmonics."""
    spectrum, samples = np.fft.rfft(history[:-1], axis=0), len(history) - 1
    if steps == samples:
        return history
    found = np.fft.irfft(spectrum[: steps // 2 + 1], steps, axis=0) * (steps / samples)
    return np.concatenate([found, found[:1]])
