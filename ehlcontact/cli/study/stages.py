"""The long computations of a study, each a function of the study alone with one result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import ConvergenceError
from ehlcontact.solver.grid import Grid
from ehlcontact.status import Status
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad
from ehlcontact.transient.settings import KeepSettings, RunSettings, TimeSteps

Update = Callable[[float, float], None]  # done, total
FRAMES = 24  # of a period: whole fields that the report can run through


class Outcome(NamedTuple):
    """How a stage ended, with what to say about it."""

    status: Status
    message: str = ""


@dataclass(frozen=True, slots=True)
class Stage:
    """One computation; `sections` of the study decide whether an earlier file still holds."""

    name: str
    title: str
    sections: tuple[str, ...]
    compute: Callable[[Study, Update], Any]
    checks: bool = False  # only for [check] half_step

    def wanted(self, study: Study) -> bool:
        """Whether the study includes this computation."""
        return study.check.half_step or not self.checks

    def file(self, folder: Path) -> Path:
        """Where the converged result stands."""
        return folder / f"{self.name}.h5"

    def partial(self, folder: Path) -> Path:
        """Where a result stands that did not get to its end."""
        return folder / f"{self.name}.partial.h5"

    def run(self, study: Study, update: Update) -> tuple[Outcome, bytes | None]:
        """Compute; give how it ended and the content of the file, also of a result that is not converged."""
        from ehlcontact.store import content_of

        try:
            result = self.compute(study, update)
            outcome = Outcome(result.status, result.status.advice)
        except ConvergenceError as error:
            result, outcome = error.result, Outcome(Status.FAILED, str(error))
        except KeyboardInterrupt:
            return Outcome(Status.INTERRUPTED, "stopped before anything could be kept"), None
        # not a single failed step, but a result
        return outcome, content_of(result) if outcome.status.ok or hasattr(result, "force") else None


def _steady(study: Study, update: Update) -> Any:
    from ehlcontact.steady import MAX_CYCLES, solve_steady

    return solve_steady(
        study.point,
        grid=Grid(n=study.solver.n, domain=study.domain),
        throw=False,
        callback=lambda cycle, residual: update(cycle, MAX_CYCLES),
    )


def _simulate(
    study: Study,
    motion: FreeVibration | HarmonicLoad,
    periods: float,
    steps: int,
    update: Update,
    snapshots: Sequence[float] = (),
) -> Any:
    from ehlcontact.transient.simulate import simulate

    return simulate(
        study.point,
        motion,
        grid=Grid(n=study.solver.n_transient, domain=study.domain),
        time=TimeSteps(periods=periods, steps_per_period=steps),
        keep=KeepSettings(snapshots=[T * study.point.scales.time for T in snapshots]),
        run=RunSettings(throw=False, callback=update),
    )


def _free(study: Study, update: Update) -> Any:
    return _simulate(study, study.free_motion, study.free.periods, study.free.steps_per_period, update)


def _harmonic(study: Study, update: Update) -> Any:
    settings = study.harmonic
    kept = frame_times(study.harmonic_motion.period, settings.periods, settings.steps_per_period)
    return _simulate(study, study.harmonic_motion, settings.periods, settings.steps_per_period, update, kept)


def frame_times(period: float, periods: float, steps: int) -> list[float]:
    """Times of steps of the last period whose whole fields the report shows, `FRAMES` at most and its start."""
    stride = -(-steps // FRAMES)
    last = round(periods * steps)
    first = max(last - steps, 0)
    return [k * period / steps for k in range(first, last + 1, stride)]


def _rotor_band(study: Study, update: Update) -> Any:
    settings = study.rotor
    return _simulate(study, study.rotor_motion, settings.fit_periods, settings.fit_steps_per_period, update)


def _rotor_full(study: Study, update: Update) -> Any:
    from ehlcontact.cli.study.rotor import run_full

    return run_full(study, 0, update)


def _rotor_half_step(study: Study, update: Update) -> Any:
    from ehlcontact.cli.study.rotor import run_full

    return run_full(study, 1, update)


def _decay(study: Study, update: Update) -> Any:
    from ehlcontact.cli.study.free_decay import run_decay_full

    return run_decay_full(study, 0, update)


def _decay_half_step(study: Study, update: Update) -> Any:
    from ehlcontact.cli.study.free_decay import run_decay_full

    return run_decay_full(study, 1, update)


STAGES = (  # the longest first
    Stage("rotor_half_step", "rotor again, half the step", ("solver", "rotor"), _rotor_half_step, True),
    Stage("decay_half_step", "decay again, half the step", ("solver", "rotor"), _decay_half_step, True),
    Stage("rotor_full", "rotor on full contacts", ("solver", "rotor"), _rotor_full),
    Stage("decay", "decay after a kick", ("solver", "rotor"), _decay),
    Stage("steady", "steady film", ("solver",), _steady),
    Stage("free", "free vibration", ("solver", "free"), _free),
    Stage("harmonic", "harmonic load, contact band", ("solver", "harmonic"), _harmonic),
    Stage("rotor_band", "harmonic load, rotor band", ("solver", "rotor"), _rotor_band),
)


def stages_of(study: Study) -> tuple[Stage, ...]:
    """Computations of a study, the longest first."""
    return tuple(stage for stage in STAGES if stage.wanted(study))


def stage_named(name: str) -> Stage:
    """Look a stage up."""
    return next(stage for stage in STAGES if stage.name == name)
