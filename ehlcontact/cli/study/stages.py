"""The long computations of a study, each a function of the study alone with one result."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.sections import Contact
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.jit import compilation_told
from ehlcontact.process.worker import report
from ehlcontact.solver.grid import Grid
from ehlcontact.status import Status
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad
from ehlcontact.transient.settings import KeepSettings, RunSettings, TimeSteps

Update = Callable[[float, float], None]  # done, total
FRAMES = 24  # of a period: whole fields that the report can run through
SPACING = 0.1  # seconds between reports


class Answer(NamedTuple):
    """How a task ended."""

    entry: dict[str, Any]  # status, message, seconds; of a finalised point also what `finalise_point` adds
    content: bytes | None = None  # of the file of a stage, converged or not


class Steps(NamedTuple):
    """Time steps of a computation."""

    period: float | None  # dimensionless; None where it follows from the film
    periods: float
    per_period: int
    on_rotor: bool = False  # films in all contacts of the rotor, else in one

    @property
    def number(self) -> int:
        """Number of steps."""
        return ceil(self.periods * self.per_period - 1e-9)


@dataclass(frozen=True, slots=True)
class Stage:
    """One computation of a study.

    Attributes
    ----------
    name, title : str
    parts : tuple of str
        Parts of `Study.fingerprint` that, with the contact, decide whether an earlier result holds.
    cost : float
        Of one step of one contact, or of a steady solve, in convolutions ("conv", docs/solver_development.md) per
        thousand nodes: geometric mean of the two studies in examples/, whose own costs are up to a factor 1.5 on
        either side. It depends on the length of a step: hardly a cycle in a free vibration, three at the rotor's
        frequency.
    steps : callable, optional
        `Steps` of a study; None of a steady film.
    compute : callable
        Study and progress to a result.
    full_films, checks : bool
        Whether it is only done for [full_films], or for half_step in it.
    """

    name: str
    title: str
    parts: tuple[str, ...]
    cost: float
    steps: Callable[[Study], Steps] | None
    compute: Callable[[Study, Update], Any]
    full_films: bool = False
    checks: bool = False

    def wanted(self, study: Study) -> bool:
        """Whether the study includes this computation."""
        if study.contact is None:
            return False
        films = study.full_films
        return not self.full_films or (films is not None and (films.half_step or not self.checks))

    def file(self, folder: Path) -> Path:
        """Where the converged result stands."""
        return folder / f"{self.name}.h5"

    def partial(self, folder: Path) -> Path:
        """Where a result stands that did not get to its end."""
        return folder / f"{self.name}.partial.h5"


def _steady(study: Study, update: Update) -> Any:
    from ehlcontact.steady import MAX_CYCLES, solve_steady

    return solve_steady(
        study.point,
        grid=Grid(n=_contact(study).n, domain=study.domain),
        throw=False,
        callback=lambda cycle, residual: update(cycle, MAX_CYCLES),
    )


def _simulate(
    study: Study,
    motion: FreeVibration | HarmonicLoad,
    steps: Steps,
    update: Update,
    snapshots: Sequence[float] = (),
) -> Any:
    from ehlcontact.transient.simulate import simulate

    return simulate(
        study.point,
        motion,
        grid=Grid(n=_contact(study).n_transient, domain=study.domain),
        time=TimeSteps(periods=steps.periods, steps_per_period=steps.per_period),
        keep=KeepSettings(snapshots=[T * study.point.scales.time for T in snapshots]),
        run=RunSettings(throw=False, callback=update),
    )


def _contact(study: Study) -> Contact:
    assert study.contact is not None  # of a stage that is wanted
    return study.contact


def _steps(motion: FreeVibration | HarmonicLoad, settings: Any) -> Steps:
    return Steps(motion.period, settings.periods, settings.steps_per_period)


def _free_steps(study: Study) -> Steps:
    return _steps(study.free_motion, _contact(study).free)


def _free(study: Study, update: Update) -> Any:
    return _simulate(study, study.free_motion, _free_steps(study), update)


def _harmonic_steps(study: Study) -> Steps:
    return _steps(study.harmonic_motion, _contact(study).harmonic)


def _harmonic(study: Study, update: Update) -> Any:
    steps = _harmonic_steps(study)
    kept = frame_times(study.harmonic_motion.period, steps.periods, steps.per_period)
    return _simulate(study, study.harmonic_motion, steps, update, kept)


def frame_times(period: float, periods: float, steps: int) -> list[float]:
    """Times of steps of the last period whose whole fields the report shows, `FRAMES` at most and its start."""
    stride = -(-steps // FRAMES)
    last = round(periods * steps)
    first = max(last - steps, 0)
    return [k * period / steps for k in range(first, last + 1, stride)]


def _band_steps(study: Study) -> Steps:
    return _steps(study.rotor_motion, _contact(study).rotor_band)


def _rotor_band(study: Study, update: Update) -> Any:
    return _simulate(study, study.rotor_motion, _band_steps(study), update)


def _rotor_steps(halvings: int, study: Study) -> Steps:
    films = study.full_films
    assert films is not None
    per_turn = films.steps_per_revolution * 2**halvings
    return Steps(study.rotor_motion.period, films.revolutions, per_turn, on_rotor=True)


def _rotor(halvings: int, study: Study, update: Update) -> Any:
    from ehlcontact.cli.study.rotor import run_full

    return run_full(study, halvings, update)


def _decay_steps(halvings: int, study: Study) -> Steps:
    films = study.full_films
    assert films is not None
    return Steps(None, films.decay_periods, films.decay_steps_per_period * 2**halvings, on_rotor=True)


def _decay(halvings: int, study: Study, update: Update) -> Any:
    from ehlcontact.cli.study.rotor import run_decay_full

    return run_decay_full(study, halvings, update)


def _on_rotor(name: str, title: str, cost: float, steps: Any, compute: Any, halvings: int) -> Stage:
    parts = "grid", "full_films"
    return Stage(
        name, title, parts, cost, partial(steps, halvings), partial(compute, halvings), True, halvings > 0
    )


STAGES = (  # the longest first
    _on_rotor("rotor_half_step", "rotor again, half the step", 1.16, _rotor_steps, _rotor, 1),
    _on_rotor("decay_half_step", "decay again, half the step", 0.70, _decay_steps, _decay, 1),
    _on_rotor("rotor_full", "rotor on full contacts", 1.90, _rotor_steps, _rotor, 0),
    _on_rotor("decay", "decay after a kick", 1.67, _decay_steps, _decay, 0),
    Stage("steady", "steady film", ("grid",), 3.5, None, _steady),
    Stage("free", "free vibration", ("grid", "free"), 0.59, _free_steps, _free),
    Stage("harmonic", "harmonic load, contact band", ("grid", "harmonic"), 0.91, _harmonic_steps, _harmonic),
    Stage("rotor_band", "harmonic load, rotor band", ("grid", "rotor_band"), 1.03, _band_steps, _rotor_band),
)


def stages_of(study: Study) -> tuple[Stage, ...]:
    """Computations of a study, the longest first."""
    return tuple(stage for stage in STAGES if stage.wanted(study))


def stage_named(name: str) -> Stage:
    """The stage of a name."""
    return next(stage for stage in STAGES if stage.name == name)


def solve_stage(key: str, study: Study, name: str) -> Answer:
    """Solve a stage of the study of one point, on this machine or on a cluster; `key` is for the reports.

    Workers write no files: the run writes the content of what they return, converged or not.
    """
    from ehlcontact.store import content_of

    started = time.perf_counter()
    status, result = Status.FAILED, None
    try:
        with reporting() as update:
            result = stage_named(name).compute(study, update)
        status, message = result.status, result.status.advice
    except ConvergenceError as error:
        result, message = error.result, str(error)
    except InputError as error:
        message = str(error)
    except KeyboardInterrupt:
        status, message = Status.INTERRUPTED, "stopped before anything could be kept"
    # not a single failed step, but a result
    content = content_of(result) if status.ok or hasattr(result, "force") else None
    return Answer({"status": str(status), "message": message, "seconds": time.perf_counter() - started}, content)


@contextmanager
def reporting() -> Iterator[Update]:
    """Give ``update(done, total)``, which reports to the run, as compilations are; each kind seldom."""
    last = dict.fromkeys(("update", "compiling"), 0.0)

    def seldom(kind: str, value: tuple[float, float] | None) -> None:
        now = time.perf_counter()
        if now - last[kind] > SPACING:
            last[kind] = now
            report(value)

    with compilation_told(lambda: seldom("compiling", None)):
        yield lambda done, total: seldom("update", (done, total))
