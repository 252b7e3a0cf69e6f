"""Arguments of `simulate` in groups: time steps, what is kept, how it runs; and the checked inputs of a run.

Times are in the unit of the operating point: seconds for an `OperatingPoint`, 2a/u_sum for a `MoesPoint`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from math import ceil, inf
from typing import Self

from ehlcontact.checks import parts, require_instance, require_nonnegative, require_positive
from ehlcontact.checks.kinds import FILE, Callback
from ehlcontact.checks.machine import require_threads
from ehlcontact.checks.quantity import fields_take
from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint
from ehlcontact.solver.mesh import Mesh
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.speed import SpeedHistory
from ehlcontact.transient.time_step import default_tol

LARGEST_ERROR = 0.1
SMALLEST_ERROR = 1e-8  # the tolerance that goes with it comes near rounding: no step would be small enough
FIRST_STEP = 0.25  # of the motion's own step: what is tried first under error control
MOST_STEPS = 1_000_000  # in fixed steps
ROUNDING = 1e-9  # of a step: an end this much later is met all the same
TOL_SHARE = 3.0  # tol over local error: the last changes of force and approach are then a tenth of the error


@fields_take(tol=parts.TOLERANCE)
@dataclass(frozen=True, slots=True)
class TimeSteps:
    """End of a run and its steps; what is left out follows from the motion, the film and the surfaces.

    Times are in seconds for an `OperatingPoint` and in 2a/u_sum for a `MoesPoint`.

    Parameters
    ----------
    until : float, optional
        End of the run.
    dt : float, optional
        Fixed step, shortened to divide `until` evenly; with `local_error` the step tried first. The default is
        that of the motion, at most 0.1 (2a/u_sum) for tables and ramps and 0.5 for other motions. Over a surface
        feature it is a fortieth of the time in which its wave passes (a tenth of a dent's radius), over
        `Roughness` and functions the time in which it moves by one node.
    periods, steps_per_period : float, optional
        End and step in periods of the motion, in place of `until` and `dt`.
    local_error : float, optional
        Control the step: the estimated local error of each step, in approach (dry approaches), force (static
        loads) and mean film, stays below this. Corners of the motion, snapshots and `until` are met exactly. The
        errors of the steps add up over a run, to about ``local_error**(2/3)`` where bodies have inertia
        (docs/notes/solver.md): for approach and force within g give ``local_error = g**1.5``.
    tol : float, optional
        Residual at which a step counts as solved, relative to the central film at rest; force and approach then
        change by less than tol/30 in the last cycle. The default is 0.003, proportionally less (1e-6 at least)
        where a load moves by less than 0.1 of the static one or a vibration by less than 0.1 dry approaches, and
        at most three times `local_error`.

    Raises
    ------
    InputError
        A number that is not positive, an end or a step given twice, a local error outside its range.
    """

    until: float | None = None
    dt: float | None = None
    periods: float | None = None
    steps_per_period: float | None = None
    local_error: float | None = None
    tol: float | None = None

    def __post_init__(self) -> None:
        for name in self.__slots__:
            if getattr(self, name) is not None:
                object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        for one, other in (("until", "periods"), ("dt", "steps_per_period")):
            if getattr(self, one) is not None and getattr(self, other) is not None:
                raise InputError(other, getattr(self, other), f"left out where {one} is given")
        if self.local_error is not None and not SMALLEST_ERROR <= self.local_error <= LARGEST_ERROR:
            raise InputError("local_error", self.local_error, f"between {SMALLEST_ERROR:g} and {LARGEST_ERROR:g}")

    def end_of(self, motion: Motion, unit: float) -> float:
        """Dimensionless end of a run under this motion; `unit` as in `StepPlan.of`."""
        if self.periods is not None:
            return self.periods * _period(motion, "periods", self.periods)
        return motion.default_end if self.until is None else self.until / unit

    def step_of(self, motion: Motion, unit: float) -> float | None:
        """Dimensionless step that is given; None where it is left out."""
        if self.steps_per_period is not None:
            return _period(motion, "steps_per_period", self.steps_per_period) / self.steps_per_period
        return None if self.dt is None else self.dt / unit


@fields_take(checkpoint=FILE, restart=FILE)
@dataclass(frozen=True, slots=True)
class KeepSettings:
    """What a run keeps besides its history: whole fields, and checkpoints to go on from.

    Parameters
    ----------
    snapshots : sequence of float
        Times whose whole fields are kept, in the unit of `TimeSteps.until`.
    checkpoint : path, optional
        HDF5 file, new or that of `restart`; replaced, in one move, every `checkpoint_every` seconds (0: after
        every step) and at the end, once the start was solved.
    checkpoint_every : float
        Seconds between checkpoints.
    restart : path, optional
        Checkpoint to go on from. The other arguments must be those of its run, except the threads; the record
        then equals that of an uninterrupted run bit for bit. `until` may be later: the stored step goes on, and
        ends at or, where it does not divide `until`, within a step after it.

    Raises
    ------
    InputError
        A snapshot or an interval that is negative.
    """

    snapshots: Iterable[float] = ()
    checkpoint: str | os.PathLike[str] | None = None
    checkpoint_every: float = 60.0
    restart: str | os.PathLike[str] | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.snapshots, Iterable):
            raise InputError("snapshots", self.snapshots, "a list of times")
        times = tuple(require_nonnegative("snapshots", t) for t in self.snapshots)
        object.__setattr__(self, "snapshots", times)
        require_nonnegative("checkpoint_every", self.checkpoint_every)


@fields_take(callback=Callback("time, end"))
@dataclass(frozen=True, slots=True)
class RunSettings:
    """How a run is carried out; its numbers do not depend on it.

    Parameters
    ----------
    threads : int, optional
        As in `solve_steady`.
    throw : bool
        Raise on failure; otherwise look at ``result.status``.
    callback : callable, optional
        Called with time and end, in the unit of `TimeSteps.until`, after every step.

    Raises
    ------
    InputError
        More threads than cores.
    """

    threads: int | None = None
    throw: bool = True
    callback: Callable[[float, float], None] | None = None

    def __post_init__(self) -> None:
        if self.threads is not None:  # what a solve takes by itself is not asked for before it is one
            require_threads("threads", self.threads)


@dataclass(frozen=True, slots=True)
class StepPlan:
    """End and steps of a run, dimensionless, with all defaults filled in."""

    until: float  # end of time
    dT: float  # fixed step, or the first one under error control
    local_error: float | None  # tolerated local error per step; None in fixed steps
    tol: float  # residual at which a step counts as solved, relative to the central film at rest

    @classmethod
    def of(cls, motion: Motion, steps: TimeSteps, unit: float = 1.0, longest: float = inf) -> StepPlan:
        """Plan of a run under this motion, in fixed steps of `longest` at most where none is given.

        Parameters
        ----------
        motion : Motion
        steps : TimeSteps
        unit : float
            The contact's unit of time 2a/u_sum: in seconds for an `OperatingPoint`, 1 for a `MoesPoint`.
        longest : float
            Dimensionless.

        Raises
        ------
        InputError
            A step longer than the run, or too many steps.
        """
        until, given = steps.end_of(motion, unit), steps.step_of(motion, unit)
        tol = default_tol(motion) if steps.tol is None else steps.tol
        default = min(motion.default_step, longest, until)
        if steps.local_error is not None:
            tol = min(tol, TOL_SHARE * steps.local_error)
            default = min(FIRST_STEP * motion.default_step, until)
        dT = default if given is None else given
        end, step = (steps.until or until * unit), (steps.dt or dT * unit)  # as given, to the last digit
        if dT > until:
            raise InputError("dt", step, f"at most until = {end!r}")
        if steps.local_error is None:
            if until / dT > MOST_STEPS:
                most = f"{MOST_STEPS:,}".replace(",", " ")
                raise InputError("dt", step, f"at least until/{most} = {end / MOST_STEPS:g}")
            dT = even_step(until, dT)
        return cls(until, dT, steps.local_error, tol)

    def going_on(self, stored: StepPlan) -> Self:
        """The same in the fixed step of a checkpoint, to the first of its times that is not before `until`."""
        if self.local_error is not None:
            return self
        steps = ceil(self.until / stored.dT - ROUNDING)
        met = abs(steps * stored.dT - self.until) <= ROUNDING * stored.dT
        return replace(self, dT=stored.dT, until=self.until if met else steps * stored.dT)


@dataclass(frozen=True, slots=True)
class RunInputs:
    """Contact, motion and steps of a run, which a restart has to repeat; times are dimensionless."""

    point: MoesPoint
    mesh: Mesh
    motion: Motion
    steps: StepPlan
    snapshots: tuple[float, ...]  # times whose whole fields are kept
    deflection: str  # engine
    speed: SpeedHistory | None = None
    conditions: Conditions = FLOODED


def even_step(until: float, dT: float) -> float:
    """Longest step, `dT` at most, that divides `until` evenly."""
    return until / ceil(until / dT - ROUNDING)


def snapshot_times(keep: KeepSettings, steps: StepPlan, unit: float) -> tuple[float, ...]:
    """Dimensionless times of the snapshots; raises `InputError` for one after the end of the run."""
    for t in keep.snapshots:
        if not t / unit <= steps.until * (1.0 + 1e-9):
            raise InputError("snapshots", t, f"at most until = {steps.until * unit!r}")
    return tuple(t / unit for t in keep.snapshots)


def require_groups(time: object, keep: object, run: object) -> None:
    """Raise `InputError` unless these are the groups of arguments that `simulate` takes."""
    require_instance("time", time, TimeSteps, "a TimeSteps(until=..., dt=..., local_error=..., tol=...)")
    require_instance("keep", keep, KeepSettings, "a KeepSettings(snapshots=..., checkpoint=..., restart=...)")
    require_instance("run", run, RunSettings, "a RunSettings(threads=..., throw=..., callback=...)")


def _period(motion: Motion, name: str, value: float) -> float:
    """Period of a motion; raises `InputError` for one that has none."""
    period: float | None = getattr(motion, "period", None)
    if period is None:
        raise InputError(name, value, f"left out: a {type(motion).__name__} has no period")
    return period
