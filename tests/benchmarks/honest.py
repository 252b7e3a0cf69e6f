"""The honest measure of a steady film: what it costs until the result is that of the converged film on its grid.

"Honest" is approach, central and smallest film within `RELATIVE` and P within `LARGEST` (largest difference over
the grid) of the fully converged solution on the same grid; "full" is P within `FULL` of it. The converged solution
is found first: cycles until the change of P stays at rounding, or, where they stagnate, thorough ones, or Newton
steps. Then everything is done again from nothing against the clock, which stands still while errors are taken.
"""

from __future__ import annotations

import inspect
import resource
import statistics
from collections.abc import Callable
from math import isfinite
from typing import Any, NamedTuple

import numpy as np
from conv import Bracket, Clock, circumstances
from numpy.typing import NDArray

from ehlcontact import Grid, MoesPoint, solve_steady
from ehlcontact.solver.acceleration import AcceleratedCycles
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.iterate import LARGEST_SWEEP_FACTOR, falls_slowly
from ehlcontact.solver.mesh import Mesh, Purpose, allows_newton, mesh_for
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.newton import NewtonKrylov

Advance = Callable[[], None]

LOAD = Balance.of_load()
RELATIVE, LARGEST, FULL = 1e-4, 1e-3, 1e-8
ROUNDING = 1e-10  # change of P below which one that no longer falls is rounding
MOST = 60  # cycles, or Newton steps
PATIENCE, PROGRESS = 20, 0.7  # so many cycles have to bring the error to this share of the least before
WAYS = ("cycles", "thorough cycles", "newton", "thorough newton")  # in this order the converged film is looked for
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
    def honest(self) -> bool:
        """Whether all are within the honest measure."""
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

    def first(self, holds: Callable[[Errors], bool]) -> int | None:
        """Cycles after which `holds` is true, and stays so."""
        last_wrong = max((k for k, errors in enumerate(self.errors) if not holds(errors)), default=-1)
        return last_wrong + 1 if last_wrong + 1 < len(self.errors) else None


def is_full(errors: Errors) -> bool:
    """Whether P is fully converged."""
    return errors.P <= FULL


def film_on(
    point: MoesPoint, mesh: Mesh, way: str = "cycles", threads: int = 1
) -> tuple[Multigrid, Callable[[], None], Advance]:
    """Film, its start (full multigrid), and one iteration of `way`, its sweeps repeated where it falls slowly."""
    options = {"threads": threads} | ({"sweep_factor": 2} if way.startswith("thorough") else {})
    known = inspect.signature(Multigrid).parameters  # earlier versions, measured beside, know neither
    options = {name: value for name, value in options.items() if name in known}
    film = Multigrid(point, mesh, **options)
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
        if way.endswith("newton") and not allows_newton(mesh, point):
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


def trace(point: MoesPoint, mesh: Mesh, exact: State, way: str = "cycles", most: int = MOST) -> Trace:
    """Solve from nothing until P is full, or never will be; errors are taken while the clock stands."""
    clock, errors = Clock(), []
    wall, cpu = [], []
    with clock:
        film, start, advance = film_on(point, mesh, way)
        start()
    work = count_work(film)
    while True:
        errors.append(Errors.between(State.of(film), exact))
        wall.append(clock.wall)
        cpu.append(clock.cpu)
        if len(errors) > most or is_over([e.P for e in errors]):
            break
        with clock:
            advance()
    cycles = len(errors) - 1
    return Trace(errors, wall, cpu, work() / cycles if cycles and work() else None)


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
    point: MoesPoint, mesh: Mesh, way: str, cycles: int, threads: int = 1
) -> tuple[list[float], list[float]]:
    """Wall and processor seconds of one solve from nothing, after full multigrid and each of `cycles`."""
    wall, cpu, clock = [], [], Clock()
    with clock:
        _, start, advance = film_on(point, mesh, way, threads)
        start()
    for k in range(cycles + 1):
        wall.append(clock.wall)
        cpu.append(clock.cpu)
        if k < cycles:
            with clock:
                advance()
    return wall, cpu


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
) -> dict[str, Any]:
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
        found = trace(point, mesh, exact.state, way, most)
        row = _judged(found, exact)
        needed = max((row[name]["cycles"] for name in ("honest", "full") if row[name]), default=0)
        runs, shared = [(found.wall, found.cpu)], []
        for k in range(repeat):
            if k > 0:
                runs.append(clocked(point, mesh, way, needed))
            if threads > 1:
                shared.append(clocked(point, mesh, way, needed, threads))
        for name in ("honest", "full"):
            if row[name] is not None:
                row[name] |= _median(runs, row[name]["cycles"])
                if shared:
                    timed = _median(shared, row[name]["cycles"])
                    row[f"{name}_shared"] = {"cycles": row[name]["cycles"], "threads": threads, **timed}
        row["start"] = {
            "seconds": statistics.median(wall[0] for wall, _ in runs),
            "cpu": statistics.median(cpu[0] for _, cpu in runs),
            "errors": found.errors[0]._asdict(),
        }
        if default:
            row["solve_steady"] = _as_asked_for(point, n, exact)
    if newton_nodes >= mesh.nodes(point.kappa) and not exact.way.endswith("newton") and exact.knows(FULL):
        row["newton_gap"] = _newton_gap(point, mesh, exact, most)
    described = point.to_dict() | {"n": n, "region": list(mesh.domain.as_tuple()), "way": way, "repeat": repeat}
    return bracket.ratios(described | row | {"peak_mb": memory} | circumstances())


def _median(runs: list[tuple[list[float], list[float]]], cycles: int) -> dict[str, float]:
    """Median of wall and processor seconds of these runs, as `clocked` gives them, after so many cycles."""
    return {name: statistics.median(run[k][cycles] for run in runs) for k, name in enumerate(("seconds", "cpu"))}


def _judged(found: Trace, exact: Reference) -> dict[str, Any]:
    """Cycles, factors and verdict of a trace, as far as the reference knows."""
    errors = [e.P for e in found.errors]
    honest = found.first(lambda e: e.honest) if exact.knows(LARGEST) else None
    full = found.first(is_full) if exact.knows(FULL) else None
    factor = mean_factor(errors, full)
    return {
        "reference": {"way": exact.way, "iterations": exact.iterations, "uncertainty": exact.uncertainty},
        "honest": None if honest is None else {"cycles": honest},
        "full": None if full is None else {"cycles": full},
        "factor": factor,
        "work": found.work,
        "factor_v21": factor ** (1.0 / found.work) if factor is not None and found.work else None,
        "verdict": verdict(errors) if exact.knows(FULL) else unknown(exact),
        "errors": errors,
    }


def _as_asked_for(point: MoesPoint, n: int, exact: Reference) -> dict[str, Any]:
    """`solve_steady` as a user calls it: its time, and how far it is from the converged solution."""
    with Clock() as clock:
        result = solve_steady(point, grid=Grid(n=n), throw=False)
    state = State(result.P.T, result.approach, result.h_central, result.h_min, result.force)
    errors = Errors.between(state, exact.state)
    return {
        "seconds": clock.wall,
        "cpu": clock.cpu,
        "status": str(result.status),
        "cycles": result.cycles,
        "honest": bool(errors.honest) if exact.knows(LARGEST) else None,
        "errors": errors._asdict(),
    }


def _newton_gap(point: MoesPoint, mesh: Mesh, exact: Reference, most: int) -> dict[str, Any]:
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
