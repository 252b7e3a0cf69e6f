"""Time to accuracy of a steady film and of a step in time: cost until the result is the converged one on its grid.

"Accurate" is approach, central and smallest film within `RELATIVE` and P within `LARGEST` (largest difference over
the grid) of the fully converged solution on the same grid; "full" is P within `FULL` of it. The converged solution
is found first: cycles until the change of P stays at rounding, or, where they stagnate, with twice the sweeps, or
Newton steps. Then everything is done again from nothing against the clock, which stands while errors are taken.
A step is taken from the middle of a run, again and again: converged, watched, timed, and as `simulate` takes it.
"""

from __future__ import annotations

import resource
import statistics
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isfinite, pi
from typing import Any, NamedTuple
from unittest import mock

import numpy as np
from conv import Bracket, Clock, circumstances
from numpy.typing import NDArray

from ehlcontact import FreeVibration, Grid, HarmonicLoad, MoesPoint, solve_steady
from ehlcontact.solver.acceleration import AcceleratedCycles
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.iterate import LARGEST_SWEEP_FACTOR, falls_slowly
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import Purpose, allows_newton, mesh_for
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.newton import NewtonKrylov
from ehlcontact.transient import transient_film as film_module
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.features import Surface
from ehlcontact.transient.record import History
from ehlcontact.transient.run import Run, march_fixed
from ehlcontact.transient.transient_film import TransientFilm

Advance = Callable[[], None]
Row = dict[str, Any]

LOAD = Balance.of_load()
RELATIVE, LARGEST, FULL = 1e-4, 1e-3, 1e-8
ROUNDING = 1e-10  # change of P below which one that no longer falls is rounding
MOST = 60  # cycles, or Newton steps
PATIENCE, PROGRESS = 20, 0.7  # so many cycles have to bring the error to this share of the least before
WAYS = ("cycles", "careful cycles", "newton", "careful newton")  # in this order the converged film is looked for
MOTIONS: dict[str, Motion] = {"free": FreeVibration(Omega_n=5.13), "harmonic": HarmonicLoad(Omega=2.0 * pi)}
DEFAULT_TOL = 3e-3  # of `simulate`
STEPS_BEFORE = 50  # 0.6 periods: nothing stands still there
OUT_OF_REACH = 1e-16  # a tolerance that is never met: the number of cycles ends the step
ALMOST_EVERY = 0.1  # of a tolerance: how well the converged solution must be known to judge by it


class State(NamedTuple):
    """What is compared."""

    P: NDArray[np.float64]
    approach: float
    h_central: float
    h_min: float
    force: float

    @classmethod
    def of(cls, film: Multigrid) -> State:
        """The present state, P copied."""
        level = film.finest
        return cls(level.P.copy(), float(film.u), level.central_film(), level.lowest_film(), level.force())


class Errors(NamedTuple):
    """Largest difference of P, and relative ones of the others."""

    P: float
    approach: float
    h_central: float
    h_min: float
    force: float

    @classmethod
    def between(cls, state: State, exact: State) -> Errors:
        """Of `state` against `exact`."""
        relative = (abs(a / b - 1.0) for a, b in zip(state[1:], exact[1:], strict=True))
        return cls(float(np.abs(state.P - exact.P).max()), *relative)

    @property
    def accurate(self) -> bool:
        """Whether all are within the accurate measure."""
        return self.P <= LARGEST and max(self.approach, self.h_central, self.h_min) <= RELATIVE


class Reference(NamedTuple):
    """The converged solution, how it was found, and how well it is known."""

    state: State
    way: str
    iterations: int
    uncertainty: float  # of P
    change: float  # of P, in the last iterations

    def knows(self, tolerance: float) -> bool:
        """Whether errors can be judged by this tolerance of P."""
        return self.uncertainty <= ALMOST_EVERY * tolerance


class Trace(NamedTuple):
    """One solve from nothing: entry 0 after full multigrid, then one per cycle."""

    errors: list[Errors]
    wall: list[float]  # s since the start
    cpu: list[float]
    work: float | None  # relaxation per cycle, in V(2,1) cycles


def first(errors: list[Errors], holds: Callable[[Errors], bool]) -> int | None:
    """Cycles after which `holds` is true, and stays so; None without any."""
    last_wrong = max((k for k, one in enumerate(errors) if not holds(one)), default=-1)
    return last_wrong + 1 if last_wrong + 1 < len(errors) else None


def is_full(errors: Errors) -> bool:
    """Whether P is fully converged."""
    return errors.P <= FULL


def film_on(
    point: MoesPoint, mesh: Mesh, way: str = "cycles", threads: int = 1
) -> tuple[Multigrid, Callable[[], None], Advance]:
    """Film, its start (full multigrid), and one iteration of `way`, its sweeps repeated where it falls slowly."""
    film = Multigrid(point, mesh, threads=threads, sweep_factor=2 if way.startswith("careful") else 1)
    if not way.endswith("newton"):
        cycles, changes = AcceleratedCycles(film), []

        def cycle() -> None:
            changes.append(cycles.step(LOAD))
            if falls_slowly(changes):  # as `iterate` does for `solve_steady`
                film.sweep_factor = min(2 * film.sweep_factor, LARGEST_SWEEP_FACTOR)

        return film, lambda: film.full_multigrid(LOAD), cycle

    def start() -> None:
        film.full_multigrid(LOAD)
        film.cycle(LOAD)

    steps = NewtonKrylov(film)
    return film, start, lambda: steps.step(LOAD)


def settle(film: Multigrid, advance: Advance, most: int, way: str = "cycles") -> Reference:
    """Advance until P no longer changes by more than rounding.

    How far P still is from the end follows from its last changes and the factor by which they fall.
    """
    changes: list[float] = []
    while len(changes) < most:
        before = film.finest.P.copy()
        advance()
        changes.append(float(np.abs(film.finest.P - before).max()))
        if not isfinite(changes[-1]) or changes[-1] == 0.0:
            break
        if len(changes) > 8 and changes[-1] < ROUNDING and min(changes[-4:]) > 0.5 * min(changes[:-4]):
            break
        if no_progress(changes):
            break
    span = min(5, len(changes) - 1)
    moved = isfinite(changes[-1]) and max(changes) > 0.0  # Newton steps stay where they are beside NaN
    change = max(changes[-3:]) if moved else float("inf")
    factor = (changes[-1] / max(changes[-1 - span], 1e-300)) ** (1.0 / span) if span and isfinite(change) else 1.0
    return Reference(State.of(film), way, len(changes), change / (1.0 - min(factor, 0.98)), change)


def converge(point: MoesPoint, mesh: Mesh, most: int = MOST, ways: tuple[str, ...] = WAYS) -> Reference:
    """Return the converged solution by the first of `ways` that finds it, else the best known."""
    best: Reference | None = None
    for way in ways:
        if way.endswith("newton") and not allows_newton(mesh):
            continue
        film, start, advance = film_on(point, mesh, way)
        start()
        found = settle(film, advance, most, way)
        if best is None or found.uncertainty < best.uncertainty:
            best = found
        if best.knows(FULL):
            break
    assert best is not None
    return best


def count_work(film: Multigrid) -> Callable[[], float]:
    """Count relaxation sweeps from here on, of all levels, each by its nodes; in V(2,1) cycles."""
    total = [0.0]
    shares = [level.P.size / film.finest.P.size for level in film.levels]
    for level, share in zip(film.levels, shares, strict=True):

        def counted(*arguments: Any, relax: Any = level.relax, share: float = share) -> None:
            total[0] += share
            relax(*arguments)

        level.relax = counted  # type: ignore[method-assign]
    return lambda: total[0] / (3.0 * sum(shares[1:]))


def is_over(errors: list[float]) -> bool:
    """Whether more cycles tell nothing new: full twice over, diverged, or no longer falling."""
    if not isfinite(errors[-1]) or errors[-1] > 1e2:
        return True
    if len(errors) > 1 and max(errors[-2:]) <= FULL:
        return True
    return no_progress(errors)


def no_progress(errors: list[float]) -> bool:
    """Whether errors, or changes, no longer fall; some stay for a while before they do."""
    return len(errors) > PATIENCE and min(errors[-PATIENCE:]) > PROGRESS * min(errors[:-PATIENCE])


def verdict(errors: list[float]) -> str:
    """What became of the errors of P, in words."""
    if errors[-1] <= FULL:
        return "converges"
    if not isfinite(errors[-1]) or errors[-1] > max(1.0, errors[0]):
        return "diverges"
    if no_progress(errors):
        return f"stagnates at {min(errors):.0e}"
    return f"too slow: {errors[-1]:.0e} after {len(errors) - 1}"


def unknown(exact: Reference) -> str:
    """What to say where no iteration has found the converged solution."""
    return "diverges" if not exact.change < 1.0 else f"stagnates: P changes by {exact.change:.0e} per cycle"


def mean_factor(errors: list[float], cycles: int | None) -> float | None:
    """Mean factor of the error of P over the first `cycles` cycles."""
    return None if not cycles else float((errors[cycles] / errors[0]) ** (1.0 / cycles))


def clocked(
    point: MoesPoint, mesh: Mesh, way: str, cycles: int, threads: int = 1, exact: State | None = None
) -> Trace:
    """One solve from nothing, timed after full multigrid and each of `cycles`.

    With the `exact` state errors are taken while the clock stands, and the solve ends where they tell nothing new.
    """
    found, clock = Trace([], [], [], None), Clock()
    with clock:
        film, start, advance = film_on(point, mesh, way, threads)
        start()
    work = count_work(film) if exact else float
    for k in range(cycles + 1):
        found.wall.append(clock.wall)
        found.cpu.append(clock.cpu)
        if exact:
            found.errors.append(Errors.between(State.of(film), exact))
            if is_over([e.P for e in found.errors]):
                break
        if k < cycles:
            with clock:
                advance()
    made = len(found.wall) - 1
    return found._replace(work=work() / made if made and work() else None)


def measure(
    point: MoesPoint,
    n: int,
    *,
    way: str = "cycles",
    most: int = MOST,
    repeat: int = 1,
    newton_nodes: int = 0,
    default: bool = False,
    threads: int = 1,
) -> Row:
    """Everything about one film on one grid; meant for a fresh process, whose peak memory is told.

    Parameters
    ----------
    point : MoesPoint
    n : int
        Intervals along X, on the region that `solve_steady` takes with n given.
    way : str
        What is measured, one of `WAYS`.
    most : int
        Cycles, or steps.
    repeat : int
        Solves of which the median time is told.
    newton_nodes : int
        Largest grid on which the solution of the cycles is compared with Newton's.
    default : bool
        Measure `solve_steady` with its own tolerance too.
    threads : int
        Of a second timing, which stands beside that of one thread; 1 leaves it out.
    """
    mesh = mesh_for(point, Purpose.FILM, grid=Grid(n=n))
    _warm_up(point, way)
    memory = _peak_memory(point, mesh, way)
    exact = converge(point, mesh, most)
    with Bracket() as bracket:
        found = clocked(point, mesh, way, most, exact=exact.state)
        row = judged(found.errors, exact)
        factor = mean_factor(row["errors"], row["full"] and row["full"]["cycles"])
        row |= {"factor": factor, "work": found.work}
        row["factor_v21"] = factor ** (1.0 / found.work) if factor is not None and found.work else None
        needed = max((row[name]["cycles"] for name in ("accurate", "full") if row[name]), default=0)
        runs, shared = [found], []
        for k in range(repeat):
            if k > 0:
                runs.append(clocked(point, mesh, way, needed))
            if threads > 1:
                shared.append(clocked(point, mesh, way, needed, threads))
        for name in ("accurate", "full"):
            if row[name] is not None:
                row[name] |= _median(runs, row[name]["cycles"])
                if shared:
                    timed = _median(shared, row[name]["cycles"])
                    row[f"{name}_shared"] = {"cycles": row[name]["cycles"], "threads": threads, **timed}
        row["start"] = {
            **_median(runs, 0),
            "errors": found.errors[0]._asdict(),
        }
        if default:
            row["solve_steady"] = _as_asked_for(point, n, exact)
    if newton_nodes >= mesh.nodes and not exact.way.endswith("newton") and exact.knows(FULL):
        row["newton_gap"] = _newton_gap(point, mesh, exact, most)
    described = point.to_dict() | {"n": n, "region": list(mesh.domain.as_tuple()), "way": way, "repeat": repeat}
    return bracket.ratios(described | row | {"peak_mb": memory} | circumstances())


def _median(runs: list[Trace], cycles: int) -> dict[str, float]:
    """Median of wall and processor seconds of these runs after so many cycles."""
    return {
        "seconds": statistics.median(run.wall[cycles] for run in runs),
        "cpu": statistics.median(run.cpu[cycles] for run in runs),
    }


def judged(errors: list[Errors], exact: Reference) -> Row:
    """Cycles and verdict of the errors after each cycle, as far as the reference knows."""
    accurate = first(errors, lambda e: e.accurate) if exact.knows(LARGEST) else None
    full = first(errors, is_full) if exact.knows(FULL) else None
    of_P = [e.P for e in errors]
    return {
        "reference": {"way": exact.way, "iterations": exact.iterations, "uncertainty": exact.uncertainty},
        "accurate": None if accurate is None else {"cycles": accurate},
        "full": None if full is None else {"cycles": full},
        "verdict": verdict(of_P) if exact.knows(FULL) else unknown(exact),
        "errors": of_P,
    }


def by_default(state: State, exact: Reference, status: object, cycles: int) -> Row:
    """How far a result at the library's own tolerance is from the converged one."""
    errors = Errors.between(state, exact.state)
    accurate = bool(errors.accurate) if exact.knows(LARGEST) else None
    return {"status": str(status), "cycles": cycles, "accurate": accurate, "errors": errors._asdict()}


def _as_asked_for(point: MoesPoint, n: int, exact: Reference) -> Row:
    """`solve_steady` as a user calls it: its time, and how far it is from the converged solution."""
    with Clock() as clock:
        result = solve_steady(point, grid=Grid(n=n), throw=False)
    state = State(result.p.T, result.approach, result.h_central, result.h_min, result.force)
    return by_default(state, exact, result.status, result.cycles) | {"seconds": clock.wall, "cpu": clock.cpu}


def _newton_gap(point: MoesPoint, mesh: Mesh, exact: Reference, most: int) -> Row:
    """Largest difference of P, and the relative ones, between the solutions of cycles and of Newton steps."""
    newton = converge(point, mesh, most, ("newton",))
    gaps = Errors.between(newton.state, exact.state)._asdict()
    return {"iterations": newton.iterations, "uncertainty": newton.uncertainty, **gaps}


def _warm_up(point: MoesPoint, way: str) -> None:
    """Compile, on the smallest grid."""
    mesh = mesh_for(point, Purpose.FILM, grid=Grid(n=64))
    clocked(point, mesh, way, 1)


def _peak_memory(point: MoesPoint, mesh: Mesh, way: str) -> float:
    """Peak resident memory [MB] of this process after full multigrid and two cycles: what a solve takes."""
    clocked(point, mesh, way, 2)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


class Middle:
    """A run stopped in its middle, and its next step, to be repeated at will."""

    def __init__(
        self,
        point: MoesPoint,
        motion: Motion,
        mesh: Mesh,
        steps: int,
        *,
        dT: float | None = None,
        surface: Surface | None = None,
    ) -> None:
        self.dT = motion.default_step if dT is None else dT
        self.film = TransientFilm(point, mesh, DEFAULT_TOL)
        self.run = Run(self.film, motion, surface, History(()), None, lambda run: None)
        self.status = self.run.start()
        if self.status.ok:
            self.status = march_fixed(self.run, steps, self.dT).status
        self.T = (steps + 1) * self.dT

    def step(self) -> Any:
        """The next step, from the same state every time; returns its `Step`."""
        self.run.back()
        return self.run.advance(self.T, self.dT).step

    @contextmanager
    def cycles(self, number: int) -> Iterator[None]:
        """Steps take exactly `number` cycles, unless they stagnate before."""
        tol = self.film.tol
        self.film.tol = OUT_OF_REACH
        with mock.patch.object(film_module, "STEP_CYCLES", number):
            yield
        self.film.tol = tol

    def share(self, threads: int) -> None:
        """Let so many threads do the work from here on."""
        for level in self.film.multigrid.levels:
            level.share(threads)

    def converged(self, most: int) -> Reference:
        """The step with cycles until P changes by rounding only."""
        self.run.back()
        balance, _ = self.run.motion.balance(self.run.state, self.T, self.dT)
        with self.cycles(1):
            self.step()
        film = self.film.multigrid
        return settle(film, lambda: film.cycle(balance), most)

    def errors(self, exact: State, most: int) -> list[Errors]:
        """Of the extrapolated start, and after every cycle."""
        film, found = self.film.multigrid, []
        cycle = film.cycle

        def watched(balance: Any) -> float:
            if not found:
                found.append(Errors.between(State.of(film), exact))
            if is_over([e.P for e in found]):
                return 0.0
            change: float = cycle(balance)
            found.append(Errors.between(State.of(film), exact))
            return change

        with mock.patch.object(film, "cycle", watched), self.cycles(most):
            self.step()
        return found


def measure_step(
    point: MoesPoint,
    name: str,
    n: int,
    *,
    steps: int = STEPS_BEFORE,
    repeat: int = 9,
    most: int = MOST,
    threads: int = 1,
) -> Row:
    """One step of the motion `name` in the middle of a run on n intervals; `repeat` timed repetitions.

    With more than one thread a second timing stands beside that of one.
    """
    mesh = mesh_for(point, Purpose.RUN, grid=Grid(n=n), largest_load=MOTIONS[name].largest_load)
    Middle(point, MOTIONS[name], mesh_for(point, Purpose.RUN, grid=Grid(n=64)), 3)  # compiles
    middle = Middle(point, MOTIONS[name], mesh, steps)
    row: Row = {"motion": name, "n": n, "region": list(mesh.domain.as_tuple()), "T": middle.T}
    row |= point.to_dict() | circumstances()
    if not middle.status.ok:
        return row | {"verdict": f"the run before the step: {middle.status}", "accurate": None, "full": None}
    exact = middle.converged(most)
    found = middle.errors(exact.state, most)
    row |= judged(found, exact) | {"start": {"errors": found[0]._asdict()}}
    with Bracket() as bracket:
        for key in ("accurate", "full"):
            if row[key] is None:
                continue
            cycles = row[key]["cycles"]
            row[key] |= _timed(middle, cycles, repeat)
            if threads > 1:
                middle.share(threads)
                row[f"{key}_shared"] = {"cycles": cycles, "threads": threads, **_timed(middle, cycles, repeat)}
                middle.share(1)
        step = middle.step()
        state = State.of(middle.film.multigrid)
        row["simulate"] = by_default(state, exact, step.status, step.cycles) | _median_step(middle, repeat)
    return bracket.ratios(row)


def _timed(middle: Middle, cycles: int, repeat: int) -> dict[str, float]:
    """Median seconds of the step with so many cycles."""
    with middle.cycles(cycles):
        return _median_step(middle, repeat)


def _median_step(middle: Middle, repeat: int) -> dict[str, float]:
    clocks = []
    middle.step()  # what else was done since the last step has its arrays out of the caches
    for _ in range(repeat):
        middle.run.back()
        with Clock() as clock:
            middle.run.advance(middle.T, middle.dT)
        clocks.append(clock)
    wall, cpu = ([getattr(clock, kind) for clock in clocks] for kind in ("wall", "cpu"))
    return {"seconds": statistics.median(wall), "cpu": statistics.median(cpu)}
