"""The simulations of the paper, each kept in one file of the output folder: an interrupted run resumes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import pi
from pathlib import Path
from typing import TypeVar

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import complain
from ehlcontact.cli.progress import progress
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import MoesPoint
from ehlcontact.results import SteadyResult
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Grid
from ehlcontact.status import Status
from ehlcontact.steady import solve_steady
from ehlcontact.store import read, save
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad, RampLoad
from ehlcontact.transient.result import SimulationResult
from ehlcontact.transient.settings import KeepSettings, RunSettings, TimeSteps
from ehlcontact.transient.simulate import simulate
from ehlcontact.version import __version__

POINT = MoesPoint(200.0, 10.0, 0.5)
VALIDATION_POINT = MoesPoint(58.07, 4.62, 1.0)
# Fig. 2: approach over M at three L; the paper does not say for which ellipse. A circle, as Wijnant's formula.
STATIC_LOADS = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0)
STATIC_OILS = (0.0, 15.0, 20.0)
# The first turn of the central film in the paper's Fig. 6 is a valley close to T = 1, which its text says too: its
# free vibrations begin by opening.
OPENING = "opening"


@dataclass(frozen=True, slots=True)
class Case:
    """One transient simulation."""

    name: str  # as in the paper's tables: 1 to 6, validation
    title: str
    motion: Motion
    point: MoesPoint = POINT
    domain: Domain | None = None
    until: float | None = None
    snapshots: tuple[float, ...] = ()

    def file(self, n: int) -> str:
        """Name of its file on `n` intervals."""
        return f"case_{self.name}_n{n}.h5"


CASES = {
    case.name: case
    for case in (
        Case("1", "free vibration, Ω_n = 10.26", FreeVibration(Omega_n=10.26, start=OPENING)),
        Case(
            "2",
            "free vibration, Ω_n = 5.13",
            FreeVibration(Omega_n=5.13, start=OPENING),
            snapshots=tuple(0.25 * k for k in range(8)),
        ),
        Case("3", "free vibration, Ω_n = 2.56", FreeVibration(Omega_n=2.56, start=OPENING)),
        Case("4", "harmonic load, Ω = π", HarmonicLoad(Omega=pi)),
        Case("5", "harmonic load, Ω = 2π", HarmonicLoad(Omega=2.0 * pi), snapshots=(0.0, 0.5, 1.0, 2.0)),
        Case("6", "harmonic load, Ω = 4π", HarmonicLoad(Omega=4.0 * pi)),
        Case(
            "validation",
            "load ramp, Ω_n = 2.4",
            RampLoad(3.67, 1.69, Omega_n=2.4),
            VALIDATION_POINT,
            Domain(-5.0, 3.0, 4.0),
            5.6,
            tuple(0.8 * k for k in range(8)),
        ),
    )
}
FREE, HARMONIC, RAMP = ("1", "2", "3"), ("4", "5", "6"), ("validation",)

Kind = TypeVar("Kind", SimulationResult, SteadyResult)


@dataclass
class Runs:
    """What has been computed; cases that did not converge are in ``failed``, with the reason."""

    n: int
    cases: dict[str, SimulationResult] = field(default_factory=dict)
    static: dict[tuple[float, float], SteadyResult] = field(default_factory=dict)  # by (M, L)
    failed: dict[str, str] = field(default_factory=dict)


def compute(folder: Path, n: int, names: Sequence[str], static: bool) -> Runs:
    """Compute what is not in the folder yet.

    Parameters
    ----------
    folder : Path
        Of the files.
    n : int
        Intervals along X.
    names : sequence of str
        Cases that are wanted.
    static : bool
        Whether the steady solves of Fig. 2 are wanted.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C; what was finished is in the folder.
    """
    runs, wanted = Runs(n), [CASES[name] for name in names]
    points = [MoesPoint(M, L, 1.0) for L in STATIC_OILS for M in STATIC_LOADS] if static else []
    todo = len(wanted) + len(points)
    for k, case in enumerate(wanted, start=1):
        result = _simulated(folder / case.file(n), case, n, f"{k} of {todo}: {case.title}, n = {n}")
        if result.status.ok:
            runs.cases[case.name] = result
        else:
            at = f"{result.status} at T = {numeral(result.t[-1])}" if result.t.size else str(result.status)
            runs.failed[f"case {case.name}, n = {n}"] = f"{at}: {result.status.advice}"
    for k, point in enumerate(points, start=len(wanted) + 1):
        steady = _solved(folder, point, n, f"{k} of {todo}: steady film, M = {point.M:g}, L = {point.L:g}", runs)
        if steady is not None:
            runs.static[point.M, point.L] = steady
    return runs


def _simulated(path: Path, case: Case, n: int, label: str) -> SimulationResult:
    kept = _stored(path, SimulationResult)
    if kept is not None and _is(kept, case, n):
        return kept
    with progress(label) as update:
        result = simulate(
            case.point,
            case.motion,
            grid=Grid(n=n, domain=case.domain),
            time=TimeSteps(until=case.until),
            keep=KeepSettings(snapshots=_until(case)),
            run=RunSettings(throw=False, callback=update),
        )
    if result.status is Status.INTERRUPTED:
        raise KeyboardInterrupt
    if result.status.ok:
        save(result, path)
    return result


def _until(case: Case) -> Sequence[float]:
    end = case.motion.default_end if case.until is None else case.until
    return [T for T in case.snapshots if T <= end * (1.0 + 1e-9)]


def _is(kept: SimulationResult, case: Case, n: int) -> bool:
    """Whether a stored result is the one wanted, made by this version."""
    domain = kept.domain if case.domain is None else case.domain
    wanted = (case.point, case.motion.to_dict(), n, domain, __version__, len(_until(case)))
    found = (kept.point, kept.motion.to_dict(), kept.n, kept.domain, kept.version, kept.snapshot_t.size)
    return wanted == found and kept.status.ok


def _solved(folder: Path, point: MoesPoint, n: int, label: str, runs: Runs) -> SteadyResult | None:
    path = folder / f"steady_M{point.M:g}_L{point.L:g}_n{n}.h5"
    kept = _stored(path, SteadyResult)
    if kept is not None and (kept.point, kept.n, kept.version) == (point, n, __version__):
        return kept
    try:
        with progress(label):
            result = solve_steady(point, grid=Grid(n=n))
    except ConvergenceError as error:
        runs.failed[f"steady film, M = {point.M:g}, L = {point.L:g}"] = str(error)
        return None
    save(result, path)
    return result


def _stored(path: Path, kind: type[Kind]) -> Kind | None:
    """What a file holds; None if there is none, or one that cannot be used, which is said."""
    if not path.is_file():
        return None
    try:
        return read(path, kind)
    except InputError:
        complain(f"{path} is damaged: it is made again")
        return None
