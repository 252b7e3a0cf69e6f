"""What a run is asked for, checked and with its defaults: a restart must be asked for the same."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import ceil, inf
from typing import Self

from ehlcontact.checks import require_choice, require_nonnegative, require_positive
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint
from ehlcontact.solver.deflection import ENGINES
from ehlcontact.solver.mesh import Mesh
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.time_step import default_tol

LARGEST_ERROR = 0.1
SMALLEST_ERROR = 1e-8  # the tolerance that goes with it comes near rounding: no step would be small enough
FIRST_STEP = 0.25  # of the motion's own step: what is tried first under error control
MOST_STEPS = 1_000_000  # in fixed steps
ROUNDING = 1e-9  # of a step: an end this much later is met all the same
TOL_SHARE = 3.0  # tol over error: the last changes of force and approach are then a tenth of the error


@dataclass(frozen=True, slots=True)
class TimeSteps:
    """How far a run goes, and in what steps."""

    until: float  # end of time
    dT: float  # fixed step, or the first one under error control
    error: float | None  # tolerated local error per step; None in fixed steps
    tol: float  # residual at which a step counts as solved, relative to the central film at rest

    @classmethod
    def of(
        cls,
        motion: Motion,
        until: float | None,
        dT: float | None,
        error: float | None,
        tol: float | None,
        longest: float = inf,
    ) -> TimeSteps:
        """Arguments of `simulate`; where they are None, what the motion needs, in steps of `longest` at most.

        Raises
        ------
        InputError
            One outside its range.
        """
        until = motion.default_end if until is None else require_positive("until", until)
        tol = default_tol(motion) if tol is None else require_positive("tol", tol)
        default = min(motion.default_step, longest, until)
        if error is not None:
            if not SMALLEST_ERROR <= require_positive("error", error) <= LARGEST_ERROR:
                raise InputError("error", error, f"between {SMALLEST_ERROR:g} and {LARGEST_ERROR:g}")
            tol = min(tol, TOL_SHARE * error)
            default = min(FIRST_STEP * motion.default_step, until)
        dT = default if dT is None else require_positive("dT", dT)
        if dT > until:
            raise InputError("dT", dT, f"at most until = {until!r}")
        if error is None:
            if until / dT > MOST_STEPS:
                most = f"{MOST_STEPS:,}".replace(",", " ")
                raise InputError("dT", dT, f"at least until/{most} = {until / MOST_STEPS:g}")
            dT = until / ceil(until / dT - ROUNDING)
        return cls(until, dT, error, tol)

    def going_on(self, stored: TimeSteps) -> Self:
        """The same in the fixed step of a checkpoint, to the first of its times that is not before `until`."""
        if self.error is not None:
            return self
        steps = ceil(self.until / stored.dT - ROUNDING)
        met = abs(steps * stored.dT - self.until) <= ROUNDING * stored.dT
        return replace(self, dT=stored.dT, until=self.until if met else steps * stored.dT)


@dataclass(frozen=True, slots=True)
class RunSettings:
    """Contact, motion, steps and what is kept of them."""

    point: MoesPoint
    mesh: Mesh
    motion: Motion
    steps: TimeSteps
    snapshots: tuple[float, ...]  # times whose whole fields are kept
    deflection: str  # engine

    @classmethod
    def of(
        cls,
        point: MoesPoint,
        mesh: Mesh,
        motion: Motion,
        steps: TimeSteps,
        snapshots: Iterable[float],
        deflection: str = "fft",
    ) -> RunSettings:
        """The same, with snapshots and engine checked.

        Raises
        ------
        InputError
            A snapshot that is no time of the run; no such engine.
        """
        require_choice("deflection", deflection, tuple(ENGINES))
        if not isinstance(snapshots, Iterable):
            raise InputError("snapshots", snapshots, "a list of times")
        times = tuple(snapshots)
        for T in times:
            if not require_nonnegative("snapshots", T) <= steps.until * (1.0 + 1e-9):
                raise InputError("snapshots", T, f"at most until = {steps.until!r}")
        return cls(point, mesh, motion, steps, times, deflection)
