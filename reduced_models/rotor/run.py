"""A rotor on ball bearings over time: constant speed, run-up or coast-down."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass, field
from math import ceil
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Status
from ehlcontact.checks import as_column, require_integer, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.store import stored
from ehlcontact.summary import Summary, span
from reduced_models.bearing.ball_bearing import RACES
from reduced_models.bearing.balls import begin_rest, directions, films_of, press_balls, rest_balls, speed_state
from reduced_models.bearing.contact import Films
from reduced_models.bearing.kinematics import RADIANS
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.integrate import LOST, NO_BALANCE, RingState, Steps, ring_state_at, run_block, steps_of
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.speed_profile import SpeedProfile, law_speeds, turning_forces

_Floats = NDArray[np.float64]

LONGEST_BLOCK = 4096  # steps between two looks at Ctrl-C
SPEED_PER_BLOCK = 2e-3  # change of the speed, over the highest, at which gyroscopic forces are renewed
LEAST_STEPS = 16  # per turn of the shaft and per ball passage
KINDS = ("orbit", "spectrum", "waterfall")  # of figures
ORDERS_SHOWN = 20.0  # multiples of the speed, to which spectra go
FARTHEST = 0.05  # of a ball diameter, that a ring may go from the middle: no clearance is as large


@stored("run of a rotor on ball bearings")
@dataclass(frozen=True, eq=False, kw_only=True)
class BearingRun(Summary, Tabled):
    """Histories of a rotor on ball bearings, SI; entry 0 is the start.

    Attributes
    ----------
    t, speed_rpm : ndarray, shape (k,)
        Times [s], speed of the shaft [rev/min].
    displacement, velocity : ndarray, shape (k, N)
        Of the rotor's degrees of freedom [m], [m/s], or rad where they turn.
    ring : ndarray, shape (k, bearings, 2)
        Inner rings against the outer ones [m].
    force : ndarray, shape (k, bearings, 2)
        Of the inner rings on the balls [N].
    iterations : ndarray, shape (k,)
        Evaluations of the bearings in the step.
    largest_load : ndarray, shape (bearings, 2)
        Largest force that any ball had, on the inner and on the outer race [N].
    status : Status
    nodes : ndarray, shape (n, 2)
        Degrees of freedom x, y of the nodes of the rotor that have a name.
    names : tuple of str
        Those names.
    """

    t: _Floats
    speed_rpm: _Floats
    displacement: _Floats
    velocity: _Floats
    ring: _Floats
    force: _Floats
    iterations: NDArray[np.int64]
    largest_load: _Floats
    status: Status
    nodes: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    names: tuple[str, ...] = ()

    LAYOUT: ClassVar[Layout] = Layout(
        rows="t",
        panels=(),
        quantities={
            "t": ("s", "t"),
            "speed_rpm": ("rev/min", "t"),
            "ring": ("m", "t bearing axis"),
            "force": ("N", "t bearing axis"),
            "displacement": ("m, or rad where it turns", "t dof"),
            "velocity": ("m/s, or rad/s where it turns", "t dof"),
            "iterations": ("", "t"),
            "largest_load": ("N", "bearing race"),
        },
        labels={"axis": ("x", "y"), "race": ("inner", "outer")},
        first=0,
    )

    def _summary_lines(self) -> list[str]:
        return [
            f"{self.status} after {len(self.t) - 1} steps to {self.t[-1]:.4g} s, {span(self.speed_rpm)} rev/min",
            f"{self.displacement.shape[1]} degrees of freedom on {self.ring.shape[1]} bearings",
            f"rings within {1e6 * float(np.hypot(*np.moveaxis(self.ring, -1, 0)).max()):.4g} µm of the centre",
            f"largest force on a ball {self.largest_load.max():.4g} N",
            f"nodes {', '.join(self.names)}" if self.names else "nodes without names",
        ]

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        kind: str = "orbit",
        most_hz: float | None = None,
        node: str | tuple[int, int] | None = None,
    ) -> Any:
        """Matplotlib figure of the rings' motion, or of another node's; into a file too where a path is given.

        Parameters
        ----------
        path : path, optional
            The ending gives the format.
        kind : {"orbit", "spectrum", "waterfall"}
            Paths over the last turns; amplitudes over frequency, of the second half of the run; such amplitudes
            of y piece by piece, over the speed or, where that is constant, the time.
        most_hz : float, optional
            End of the frequencies shown; by default 20 times the highest speed, as far as the steps resolve it and
            a waterfall shows anything there.
        node : str or (int, int), optional
            What is shown in place of the rings: the name of a node, as "disc", or its degrees of freedom x, y.

        Raises
        ------
        InputError
            Another kind, a run of fewer than 16 steps, a node that is not there, or the file cannot be written.
        """
        from reduced_models.rotor.picture import draw_run

        if kind not in KINDS:
            raise InputError("kind", kind, f"one of {', '.join(KINDS)}")
        if self.t.size <= LEAST_STEPS:
            raise InputError("steps of the run", self.t.size - 1, f"at least {LEAST_STEPS}, for a figure")
        highest, turning = 0.5 / float(self.t[1] - self.t[0]), float(self.speed_rpm.max()) / 60.0
        if most_hz is not None:
            most_hz = min(require_positive("most_hz", most_hz), highest)
        usual = min(ORDERS_SHOWN * turning, highest) if turning > 0.0 else highest
        return draw_run(self, path, kind, (most_hz, usual), self._shown(node))

    def _shown(self, node: str | tuple[int, int] | None) -> list[tuple[str, _Floats]]:
        """Motions x, y of what a figure shows, with their titles."""
        if node is None:
            return [(f"inner ring of bearing {b}", self.ring[:, b]) for b in range(self.ring.shape[1])]
        named = dict(zip(self.names, map(tuple, self.nodes.tolist()), strict=True))
        pair, most = named.get(node, ()) if isinstance(node, str) else node, self.displacement.shape[1] - 1
        if len(pair) != 2 or not all(0 <= require_integer("node", at, "whole numbers", 0) <= most for at in pair):
            known = f"one of {', '.join(named)}, or " if named else ""
            raise InputError("node", node, f"{known}two degrees of freedom from 0 to {most}")
        titles = {at: name for name, at in named.items()}
        return [(titles.get(pair, f"degrees of freedom {pair[0]}, {pair[1]}"), self.displacement[:, list(pair)])]


@takes(speed_rpm="rev/min", dt="s", until="s")
def simulate_on_bearings(
    rotor: Rotor,
    *,
    speed_rpm: float | SpeedProfile,
    dt: float,
    until: float,
    start: Any = "static",
    tolerance: float = 1e-9,
    rho_inf: float = 0.8,
) -> BearingRun:
    """Integrate a rotor on ball bearings from t = 0 to `until` in steps of `dt`, compiled.

    After the run an `OutsideValidityWarning` tells of a ball that carried more than the atlas knows.

    Generalised-alpha steps, second order: rotor, bearings, balls and films in one loop, Newton's method on the
    rings with exact tangents.

    Parameters
    ----------
    rotor : Rotor
    speed_rpm : float or SpeedProfile
        Of the shaft, constant or over time.
    dt, until : float
        Step and end [s]; the last step may pass `until` by less than dt.
    start : "static" or (ndarray, ndarray)
        At rest in equilibrium; or displacements and velocities, shape (N,), with films at rest there.
    tolerance : float
        Largest imbalance of the forces at the bearings over the load.
    rho_inf : float
        0 to 1: share of amplitude that frequencies far above 1/dt keep per step.

    Returns
    -------
    BearingRun
        With status "interrupted" and what was computed, after Ctrl-C.

    Raises
    ------
    InputError
        A value outside its range, a speed that a bearing does not take, a step too long for the ball passage or
        the turn of the shaft.
    ConvergenceError
        A step found no balance, or a ring left its bearing; ``result`` holds the steps before.
    """
    require_positive("dt", dt)
    steps = max(1, ceil(require_positive("until", until) / dt - 1e-9))
    if not 0.0 <= rho_inf <= 1.0:
        raise InputError("rho_inf", rho_inf, "between 0 and 1")
    course = speed_rpm if isinstance(speed_rpm, SpeedProfile) else SpeedProfile.constant(speed_rpm)
    return _Run(rotor, course, (dt, steps), start, require_positive("tolerance", tolerance), rho_inf).go()


class _Run:
    """One simulation; the arguments are checked."""

    histories: tuple[_Floats, _Floats, _Floats, _Floats, NDArray[np.int64]]
    rings: RingState
    films: tuple[Films, ...]
    state: _Floats  # (4, N), see `run_block`
    _steps: Steps | None = None
    _made_at = 0.0

    def __init__(
        self,
        rotor: Rotor,
        course: SpeedProfile,
        times: tuple[float, int],
        start: Any,
        tolerance: float,
        rho_inf: float,
    ) -> None:
        self.rotor, (self.dt, self.steps), self.rho_inf = rotor, times, rho_inf
        t: _Floats = np.asarray(self.dt * np.arange(self.steps + 1), np.float64)
        self.omega, angle, rise = course.at(t)
        self.t, mounts = t, rotor.mounts
        self._require_short_steps()
        grid = law_speeds(self.omega / RADIANS)
        self.balls = tuple(m.bearing.kernel([m.bearing.speed(s) for s in grid.tolist()]) for m in mounts)
        self.angles = np.column_stack(
            [m.cage_angle + k.cage * angle for m, k in zip(mounts, self.balls, strict=True)]
        )
        self.turned, self.at = turning_forces(rotor, self.omega, angle, rise)
        self._begin(start)
        load = max(float(np.linalg.norm(rotor.load)), float(np.abs(self.turned).max(initial=0.0)))
        self.limits = tolerance * max(load, 1.0), FARTHEST * min(m.bearing.ball_diameter for m in mounts)

    def go(self) -> BearingRun:
        """All steps, or as many as there are before Ctrl-C."""
        at, status = 0, Status.CONVERGED
        try:
            while at < self.steps:
                end = self._end_of_block(at)
                made, how = self._block(at, end)
                at += made
                if how in (NO_BALANCE, LOST):
                    why = "no balance of the forces was found" if how == NO_BALANCE else self._who_left(at)
                    run = self._result(at, Status.FAILED)
                    raise ConvergenceError(f"rotor at t = {self.t[at]:.6g} s: {why}", run)
        except KeyboardInterrupt:
            status = Status.INTERRUPTED
        self._warn_of_overload()
        return self._result(at, status)

    def _warn_of_overload(self) -> None:
        """Tell of balls that carried more than the atlas knows."""
        slowest = float(self.omega.min() / RADIANS)
        for b, (mount, films) in enumerate(zip(self.rotor.mounts, self.films, strict=True)):
            for name, load in zip(RACES, films.largest.tolist(), strict=True):
                most = np.inf if mount.bearing.oil is None else mount.bearing.race(name).loads(slowest)[1]
                if load > most:
                    message = (
                        f"a ball of bearing {b} carried {load:.4g} N on the {name} race (atlas up to {most:.4g} N)"
                    )
                    warnings.warn(message, OutsideValidityWarning, stacklevel=4)

    def _block(self, first: int, end: int) -> tuple[int, int]:
        middle = 0.5 * (self.omega[first] + self.omega[end])
        rotor = self.rotor
        if self._steps is None or (rotor.gyroscopic.any() and middle != self._made_at):
            matrices = rotor.mass, rotor.damping + middle * rotor.gyroscopic, rotor.stiffness
            self._steps = steps_of(matrices, rotor.rings, self.at, rotor.load, self.dt, self.rho_inf)
            self._made_at = middle
        here = slice(first + 1, end + 1)
        course = self.omega[here], self.angles[here], self.turned[here]
        out = tuple(history[here] for history in self.histories)
        made, how = run_block(
            self._steps, self.balls, self.films, self.rings, self.state, course, self.limits, out
        )
        return int(made), int(how)

    def _end_of_block(self, at: int) -> int:
        end = min(at + LONGEST_BLOCK, self.steps)
        if self.rotor.gyroscopic.any():
            off = np.abs(self.omega[at : end + 1] - self.omega[at]) > SPEED_PER_BLOCK * self.omega.max()
            end = at + max(int(np.argmax(off)), 1) if off.any() else end
        return end

    def _begin(self, start: Any) -> None:
        rotor, size, n = self.rotor, self.rotor.size, 2 * len(self.rotor.mounts)
        d, v = self._start(start)
        r, force = rotor.rings @ d, np.zeros(n)
        self.films = tuple(films_of(balls) for balls in self.balls)
        most = max(balls.number for balls in self.balls)
        self.rings = ring_state_at(r, force, self.turned[0], most)
        for b, (balls, films) in enumerate(zip(self.balls, self.films, strict=True)):
            normals, at = self.rings.normals[b], slice(2 * b, 2 * b + 2)
            directions(balls, self.angles[0, b], normals)
            begin_rest(films)
            at_speed = speed_state(balls, self.omega[0])._replace(cage=0.0)
            press_balls(balls, at_speed, films, normals, r[at], np.zeros(2), 0.0, self.rings.pushed)
            rest_balls(balls, films, normals, r[at])
            self.rings.force[at] = self.rings.pushed[0]
        damping = rotor.damping + self.omega[0] * rotor.gyroscopic
        net = rotor.load + self.at @ self.turned[0] - rotor.rings.T @ self.rings.force
        a = np.linalg.solve(rotor.mass, net - damping @ v - rotor.stiffness @ d)
        self.state = np.array([d, v, a, np.zeros(size)])
        rows = self.steps + 1
        self.histories = (
            np.zeros((rows, size)), np.zeros((rows, size)), np.zeros((rows, n)), np.zeros((rows, n)),
            np.zeros(rows, np.int64),
        )  # fmt: skip
        for history, first in zip(self.histories, (d, v, r, self.rings.force), strict=False):
            history[0] = first

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

    def _require_short_steps(self) -> None:
        fastest = float(self.omega.max())
        for mount in self.rotor.mounts:
            passage = mount.bearing.frequencies(fastest / RADIANS).bpfo
            for what, hz in (("ball passage", passage), ("turn of the shaft", fastest / (2.0 * np.pi))):
                if self.dt * hz * LEAST_STEPS > 1.0:
                    most = 1.0 / (hz * LEAST_STEPS)
                    raise InputError("dt", self.dt, f"at most {most:.3g} s, a {LEAST_STEPS}th of the {what}")

    def _who_left(self, at: int) -> str:
        worst = int(np.argmax(np.abs(self.histories[2][at]))) // 2
        far = float(np.hypot(*self.histories[2][at][2 * worst : 2 * worst + 2]))
        return f"the ring of bearing {worst} has left it, {far * 1e3:.3g} mm from the middle"

    def _result(self, made: int, status: Status) -> BearingRun:
        q, v, ring, force, iterations = self.histories
        pairs, kept = (made + 1, len(self.rotor.mounts), 2), slice(0, made + 1)
        return BearingRun(
            t=self.t[kept],
            speed_rpm=self.omega[kept] / RADIANS,
            displacement=q[kept],
            velocity=v[kept],
            ring=ring[kept].reshape(pairs),
            force=force[kept].reshape(pairs),
            iterations=iterations[kept],
            largest_load=np.array([films.largest for films in self.films]),
            status=status,
            nodes=np.array(list(self.rotor.nodes.values()), np.int64).reshape(-1, 2),
            names=tuple(self.rotor.nodes),
        )
