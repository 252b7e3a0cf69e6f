"""`simulate_rotor`: a rotor on its supports over time, at constant speed, in a run-up or a coast-down."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Status
from ehlcontact.checks import as_column, require_integer, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.balls import (
    Films,
    begin_rest,
    directions,
    films_of,
    press_balls,
    rest_balls,
    speed_state,
)
from reduced_models.bearing.kinematics import RADIANS
from reduced_models.bearing.race import RACES
from reduced_models.elements.validity import OutsideValidityWarning, frequency_of
from reduced_models.rotor.contact import Contact
from reduced_models.rotor.integrate_compiled import (
    LOST,
    NO_BALANCE,
    RingState,
    Steps,
    ring_state_at,
    run_block,
    steps_of,
)
from reduced_models.rotor.integrate_python import (
    NOISE,
    PythonSteps,
    RunningBalls,
    RunningContacts,
    RunningSupport,
    active_mounts,
    geometry_of,
)
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState
from reduced_models.rotor.nodes import flat_nodes
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Mount, Rotor
from reduced_models.rotor.speed_profile import SpeedProfile, law_speeds, turning_forces
from reduced_models.rotor.supports import BearingMount, ContactMount, LinearBearing

_Floats = NDArray[np.float64]

LONGEST_BLOCK = 4096  # steps between two looks at Ctrl-C
SPEED_PER_BLOCK = 2e-3  # change of the speed, over the highest, at which gyroscopic forces are renewed
LEAST_STEPS = 16  # per turn of the shaft and per ball passage, on ball bearings
FARTHEST = 0.05  # of a ball diameter, that a ring may go from the middle: no clearance is as large
TOLERANCE = {True: 1e-9, False: 1e-6}  # by whether all supports have a kernel


@takes(speed_rpm="rev/min", dt="s", until="s")
def simulate_rotor(
    rotor: Rotor | JeffcottRotor,
    contacts: Sequence[Contact] | None = None,
    *,
    speed_rpm: float | SpeedProfile | None = None,
    dt: float,
    until: float,
    start: Any = "static",
    tolerance: float | None = None,
    max_iterations: int = 30,
    rho_inf: float = 0.8,
    callback: Callable[[int, int], object] | None = None,
) -> RotorResult:
    """Integrate a rotor on its supports from t = 0 to `until` in steps of `dt`.

    Generalised-alpha steps (second order); everything linear is condensed onto the points at which supports act,
    so that each step solves only for their motion, by Newton's method with exact tangents, or secants for contacts
    that have none. On ball bearings alone rotor, bearings, balls and films run in one compiled loop. Contacts run
    in Python; every evaluation starts each contact from its state at the start of the step.

    Elements warn, once: before the run where the rotor's speed lies outside their band, or a mount has the point
    of another contact than they were made for; after it where it left their validity box. A bearing of which a
    ball carried more than the atlas has warns after the run.

    Parameters
    ----------
    rotor : Rotor or JeffcottRotor
    contacts : sequence of Contact, optional
        Of a `JeffcottRotor`: one per mount, in SI (see `ScaledContact`); those with a memory each their own
        object. They are left at the state of the end.
    speed_rpm : float or SpeedProfile, optional
        Of the shaft [rev/min], constant or over time; by default that of a `JeffcottRotor`.
    dt, until : float
        Step and end [s]; the last step may pass `until` by less than dt.
    start : "static", RotorState or (ndarray, ndarray)
        At rest in equilibrium; or displacements and velocities, of shape (N,) each, with the contacts in the state
        in which they are given, and bearings at rest there.
    tolerance : float, optional
        Largest imbalance of the forces at the supports over the load: by default 1e-6 with contacts, where each
        evaluation may be a solve, and 1e-9 without.
    max_iterations : int
        Evaluations of each contact in a step.
    rho_inf : float
        0 to 1: share of amplitude that frequencies far above 1/dt keep per step.
    callback : callable, optional
        Called as ``callback(step, steps)`` after every step, or block of steps on ball bearings.

    Returns
    -------
    RotorResult
        With status "interrupted" and what was computed, after Ctrl-C.

    Raises
    ------
    InputError
        A value outside its range, a speed that a bearing does not take, a step too long for the ball passage or
        the turn of the shaft; a wrong number of contacts, or one with a memory in two mounts.
    ConvergenceError
        A step found no balance, a contact in it did not converge, or a ring left its bearing; ``result`` holds the
        steps before.
    """
    require_positive("dt", dt)
    steps = max(1, ceil(require_positive("until", until) / dt - 1e-9))  # but for rounding of the quotient
    if not 0.0 <= rho_inf <= 1.0:
        raise InputError("rho_inf", rho_inf, "between 0 and 1")
    max_iterations = require_integer("max_iterations", max_iterations, "a whole number >= 1", 1)
    if tolerance is not None:
        require_positive("tolerance", tolerance)
    whole, start = _whole_rotor(rotor, contacts, start)
    if speed_rpm is None:
        if not isinstance(rotor, JeffcottRotor):
            raise InputError("speed_rpm", None, "given: that of the shaft")
        speed_rpm = rotor.speed_rpm
    profile = speed_rpm if isinstance(speed_rpm, SpeedProfile) else SpeedProfile.constant(speed_rpm)
    run = _Run(whole, profile, (dt, steps), start, (tolerance, max_iterations, rho_inf))
    result = run.go(callback)
    _warn_of_contacts(whole, result)
    return result


def _whole_rotor(
    rotor: Rotor | JeffcottRotor, contacts: Sequence[Contact] | None, start: Any
) -> tuple[Rotor, Any]:
    """The rotor with its contacts, and its start as displacements and velocities where it is a state."""
    if isinstance(rotor, JeffcottRotor):
        whole = rotor.on([] if contacts is None else contacts)
        _check_contacts(whole.mounts)
        rotor.check(contacts or (), stacklevel=5)
        start = rotor.motion(start) if isinstance(start, RotorState) else start
        return whole, start
    if not isinstance(rotor, Rotor):
        raise InputError("rotor", type(rotor).__name__, "a Rotor or JeffcottRotor")
    if contacts is not None:
        raise InputError("contacts", len(contacts), "left out: those of a Rotor are in its mounts")
    _check_contacts(rotor.mounts)
    return rotor, start


def _check_contacts(mounts: Sequence[Mount]) -> None:
    contacts = [mount.contact for mount in mounts if isinstance(mount, ContactMount)]
    for i, contact in enumerate(contacts):
        if not isinstance(contact, Contact):
            raise InputError(
                f"contacts[{i}]", type(contact).__name__, "a Contact (advance, save and restore state)"
            )
        if getattr(contact, "units", "SI") != "SI":
            units = getattr(contact, "units", "")
            raise InputError(f"contacts[{i}].units", units, "SI; see to_si and ScaledContact")
        if any(contact is other for other in contacts[:i]) and contact.save_state() is not None:
            raise InputError(f"contacts[{i}]", "used twice", "its own object: it has a memory (take a copy)")


class _Run:
    """One simulation; the arguments are checked."""

    films: tuple[Films, ...]
    state: _Floats  # (4, N), see `run_block`
    rings: RingState
    histories: tuple[Any, ...]  # displacement, velocity, motion, rate and force of the supports, evaluations
    made = 0  # steps
    _steps: Steps
    _made_at: float | None = None

    def __init__(
        self,
        rotor: Rotor,
        profile: SpeedProfile,
        times: tuple[float, int],
        start: Any,
        settings: tuple[float | None, int, float],
    ) -> None:
        self.rotor, (self.dt, self.steps) = rotor, times
        tolerance, most, self.rho_inf = settings
        self.t: _Floats = np.asarray(self.dt * np.arange(self.steps + 1), np.float64)
        self.omega, angle, rise = profile.at(self.t)
        self.contacts, self.bearings = active_mounts(rotor)
        self._require_short_steps()
        grid = law_speeds(self.omega / RADIANS)
        self.balls = tuple(
            m.ball_bearing.kernel([m.ball_bearing.speed(s) for s in grid.tolist()]) for m in self.bearings
        )
        cages = [m.cage_angle + k.cage * angle for m, k in zip(self.bearings, self.balls, strict=True)]
        self.angles = np.column_stack(cages) if cages else np.zeros((self.t.size, 0))
        self.turned, self.at = turning_forces(rotor, self.omega, angle, rise)
        self.geometry = geometry_of(rotor)
        self._renew_steps(0, self._end_of_block(0))
        self._begin(start)
        compiled = bool(self.bearings) and not self.contacts
        tolerance = TOLERANCE[compiled] if tolerance is None else tolerance
        load = max(float(np.linalg.norm(rotor.load)), float(np.abs(self.turned).max(initial=0.0)))
        farthest = FARTHEST * min((m.ball_bearing.ball_diameter for m in self.bearings), default=np.inf)
        self.limits = tolerance * max(load, 1.0), farthest
        self.python = None if compiled else self._python_steps(tolerance, most)

    def go(self, callback: Callable[[int, int], object] | None) -> RotorResult:
        """All steps, or as many as there are before Ctrl-C."""
        status = Status.CONVERGED
        try:
            while self.made < self.steps:
                end = self._end_of_block(self.made)
                self._renew_steps(self.made, end)
                if self.python is None:
                    self._compiled_block(self.made, end)
                    if callback is not None:
                        callback(self.made, self.steps)
                    continue
                for i in range(self.made + 1, end + 1):
                    self.python.advance(self._steps, i, (self.omega, self.angles, self.turned))
                    self.made = i
                    if callback is not None:
                        callback(i, self.steps)
        except KeyboardInterrupt:
            status = Status.INTERRUPTED
            if self.python is not None:
                self.python.rewind()
        except ConvergenceError as error:
            if self.python is None:
                raise
            self.python.rewind()
            self._raise(str(error), self.made + 1, error)
        self._warn_of_overload()
        return self._result(self.made, status)

    def _raise(self, why: str, at: int, error: ConvergenceError | None = None) -> None:
        run = self._result(self.made, Status.FAILED)
        raise ConvergenceError(f"rotor at t = {self.t[at]:.6g} s: {why}", run) from error

    def _compiled_block(self, first: int, end: int) -> None:
        here = slice(first + 1, end + 1)
        course = self.omega[here], self.angles[here], self.turned[here]
        d, v, r, _, force, iterations = (history[here] for history in self.histories)
        out = d, v, r, force, iterations
        made, how = run_block(
            self._steps, self.balls, self.films, self.rings, self.state, course, self.limits, out
        )
        self.made += int(made)
        if how in (NO_BALANCE, LOST):
            why = "no balance of the forces was found" if how == NO_BALANCE else self._who_left(self.made)
            self._raise(why, self.made)

    def _renew_steps(self, first: int, end: int) -> None:
        """Matrices of the steps of a block, at the speed in its middle."""
        middle = 0.5 * (self.omega[first] + self.omega[end])
        if self._made_at is None or (self._changes_with_speed and middle != self._made_at):
            matrices = self.rotor.matrices(middle)
            self._steps = steps_of(matrices, self.geometry[0], self.at, self.rotor.load, self.dt, self.rho_inf)
            self._made_at = middle

    @property
    def _changes_with_speed(self) -> bool:
        bearings = [mount.bearing for mount in self.rotor.mounts if isinstance(mount, BearingMount)]
        tables = (b for b in bearings if isinstance(b, LinearBearing) and b.speeds_rpm is not None)
        return bool(self.rotor.gyroscopic.any()) or any(True for _ in tables)

    def _end_of_block(self, at: int) -> int:
        end = min(at + LONGEST_BLOCK, self.steps)
        if self._changes_with_speed:
            off = np.abs(self.omega[at : end + 1] - self.omega[at]) > SPEED_PER_BLOCK * self.omega.max()
            end = at + max(int(np.argmax(off)), 1) if off.any() else end
        return end

    def _begin(self, start: Any) -> None:
        """State, histories and supports at the start."""
        rotor, size = self.rotor, self.rotor.size
        points, normals, counts = self.geometry
        d, v = self._start(start)
        static = isinstance(start, str)
        r, rate, force = normals @ (points @ d), normals @ (points @ v), np.zeros(len(normals))
        first = len(self.contacts)
        if self.contacts:
            self._group = RunningContacts(self.contacts, self.dt, self._steps.velocity[0])
            if static:
                for mount, approach in zip(self.contacts, r.tolist(), strict=False):
                    mount.contact.rest(approach + mount.offset)
            force[:first] = self._group.start(r[:first], rate[:first])
        self.films = tuple(films_of(balls) for balls in self.balls)
        most = max((balls.number for balls in self.balls), default=0)
        self.rings = ring_state_at(r[first:], force[first:], self.turned[0], most)
        for b, (balls, films) in enumerate(zip(self.balls, self.films, strict=True)):
            normal, at = self.rings.normals[b], slice(first + 2 * b, first + 2 * b + 2)
            directions(balls, self.angles[0, b], normal)
            begin_rest(films)
            speed = speed_state(balls, self.omega[0])._replace(cage=0.0)
            press_balls(balls, speed, films, normal, r[at], np.zeros(2), 0.0, self.rings.pushed)
            rest_balls(balls, films, normal, r[at])
            force[at] = self.rings.pushed[0]
        self.rings.force[:] = force[first:]
        M, C, K = rotor.matrices(self.omega[0])
        net = rotor.load + self.at @ self.turned[0] - points.T @ (normals.T @ (counts * force))
        a = np.linalg.solve(M, net - C @ v - K @ d)
        self.state = np.array([d, v, a, np.zeros(size)])
        rows, m = self.steps + 1, len(normals)
        self.histories = (*np.zeros((2, rows, size)), *np.zeros((3, rows, m)), np.zeros(rows, np.int64))
        for history, value in zip(self.histories, (d, v, r, rate, force), strict=False):
            history[0] = value

    def _start(self, start: Any) -> tuple[_Floats, _Floats]:
        size = self.rotor.size
        if isinstance(start, str):
            if start != "static":
                raise InputError("start", start, "'static', or displacements and velocities")
            return self.rotor.equilibrium(float(self.omega[0] / RADIANS)), np.zeros(size)
        try:
            d, v = start
        except (TypeError, ValueError):
            raise InputError("start", type(start).__name__, "'static', or displacements and velocities") from None
        return np.array(as_column("displacements", d, size=size)), np.array(as_column("velocities", v, size=size))

    def _python_steps(self, tolerance: float, most: int) -> PythonSteps:
        """Steps in Python; the allowed imbalance is a share of the largest of the forces at the start."""
        rotor, counts = self.rotor, self.geometry[2]
        d, _, _, _, force, _ = (history[0] for history in self.histories)
        _, _, K = rotor.matrices(self.omega[0])
        carried = np.abs(self.geometry[1].T @ (counts * force)).max(initial=0.0)
        turning = np.abs(self.turned).max(initial=0.0)
        scale = float(max(np.abs(rotor.load).sum(), np.abs(K @ d).max(), turning, carried))
        allowed, first = tolerance * (scale if scale > 0.0 else 1.0), len(self.contacts)
        supports: list[tuple[slice, RunningSupport]] = []
        if self.contacts:
            self._group.forces.noise = NOISE * allowed / counts[:first].max()
            supports.append((slice(0, first), self._group))
        for b, (balls, films) in enumerate(zip(self.balls, self.films, strict=True)):
            running = RunningBalls(balls, films, self.dt, self._steps.velocity[0])
            supports.append((slice(first + 2 * b, first + 2 * b + 2), running))
        return PythonSteps(supports, self.geometry, self.state, self.histories, (allowed, most))

    def _require_short_steps(self) -> None:
        fastest = float(self.omega.max())
        for mount in self.bearings:
            passage = mount.ball_bearing.frequencies(fastest / RADIANS).bpfo
            for what, hz in (("ball passage", passage), ("turn of the shaft", fastest / (2.0 * np.pi))):
                if self.dt * hz * LEAST_STEPS > 1.0:
                    most = 1.0 / (hz * LEAST_STEPS)
                    raise InputError("dt", self.dt, f"at most {most:.3g} s, a {LEAST_STEPS}th of the {what}")

    def _warn_of_overload(self) -> None:
        """Warn of balls that carried more than the atlas knows."""
        slowest = float(self.omega.min() / RADIANS)
        for b, (mount, films) in enumerate(zip(self.bearings, self.films, strict=True)):
            for name, load in zip(RACES, films.largest.tolist(), strict=True):
                most = (
                    np.inf if mount.ball_bearing.oil is None else mount.ball_bearing.race(name).loads(slowest)[1]
                )
                if load > most:
                    message = (
                        f"a ball of bearing {b} carried {load:.4g} N on the {name} race (atlas up to {most:.4g} N)"
                    )
                    warnings.warn(message, OutsideValidityWarning, stacklevel=4)

    def _who_left(self, at: int) -> str:
        worst = int(np.argmax(np.abs(self.histories[2][at]))) // 2
        far = float(np.hypot(*self.histories[2][at][2 * worst : 2 * worst + 2]))
        return f"the ring of bearing {worst} has left it, {far * 1e3:.3g} mm from the middle"

    def _result(self, made: int, status: Status) -> RotorResult:
        kept, rotor = slice(0, made + 1), self.rotor
        q, v, r, rate, force, iterations = (history[kept] for history in self.histories)
        if self.python is None:
            rate = v @ self.geometry[0].T
        r = r + np.array([mount.offset for mount in self.contacts] + [0.0] * 2 * len(self.bearings))
        names, places = flat_nodes(rotor.nodes)
        contacts, bearings = (range(1, len(self.contacts) + 1), range(len(self.bearings)))
        return RotorResult(
            t=self.t[kept],
            speed_rpm=self.omega[kept] / RADIANS,
            displacement=q,
            velocity=v,
            approach=r,
            rate=rate,
            force=force,
            iterations=iterations,
            largest_load=np.array([films.largest for films in self.films]).reshape(-1, 2),
            status=status,
            columns=(*(f"contact {i}" for i in contacts), *(f"bearing {b} {x}" for b in bearings for x in "xy")),
            names=names,
            places=places,
        )


def _warn_of_contacts(rotor: Rotor, result: RotorResult) -> None:
    """Let the elements warn where the run left their validity box."""
    contacts = [mount.contact for mount in rotor.mounts if isinstance(mount, ContactMount)]
    for i, contact in enumerate(contacts):
        warn = getattr(contact, "warn_outside", None)
        if warn is not None:
            u, v, f = result.approach[:, i], result.rate[:, i], result.force[:, i]
            warn(u, v, force=f, omega=frequency_of(u, v), stacklevel=4)
