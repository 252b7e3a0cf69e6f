"""Fine features through a contact, on finer and finer grids: every step, what it costs and how right it is.

    python tests/benchmarks/fine.py --n 256 512 1024 --case rolling sliding rough [--until 0.2] [--json fine.json]

Steps of one mesh size. Of every passage: statuses and cycles of all steps, seconds of a step, and of one step in
the middle and the last the distance from the fully converged one (as `time_to_accuracy`). Of every two grids the
change of the film by the feature is compared within 0.85 of the Hertz radius, and of three the order follows.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from conv import Bracket, Clock, circumstances
from numpy.typing import NDArray
from time_to_accuracy import MOST, Errors, Middle, State

from ehlcontact import Dent, Domain, Grid, MoesPoint, PrescribedLoad, Roughness
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from ehlcontact.transient.features import Surface

NEAR = Domain(-2.5, 1.5, 2.0)
MOURIER, ROUGH = MoesPoint(63.7817, 5.78819, 1.0), MoesPoint(200.0, 10.0, 1.0)
FILM = 0.08168  # central one at ROUGH, n = 128
WITHIN = 0.85  # of the Hertz radius
CASES: dict[str, tuple[MoesPoint, Surface, float]] = {
    "rolling": (MOURIER, Dent(0.11699, 0.13602, -1.5), 1.875),
    "sliding": (MOURIER, Dent(0.10696, 0.18868, -1.375, speed=0.5), 2.0),
    "rough": (ROUGH, Roughness.synthetic(0.1 * FILM, 0.5, 1 / 16, length=4, width=2, seed=1, start=-1.25), 1.0),
    "finer": (ROUGH, Roughness.synthetic(0.1 * FILM, 0.5, 1 / 32, length=4, width=2, seed=1, start=-1.25), 1.25),
}


def passage(case: str, n: int, until: float | None) -> tuple[dict[str, Any], NDArray[np.float64]]:
    """All steps of a case: a row of figures, and the change of the film at the end over the central one."""
    point, surface, end = CASES[case]
    mesh, dT = mesh_for(point, Purpose.RUN, grid=Grid(n=n, domain=NEAR)), (NEAR.x_out - NEAR.x_in) / n
    steps = round((end if until is None else until) / dT)
    Middle(
        point, steady_load(end), mesh_for(point, Purpose.RUN, grid=Grid(n=64, domain=NEAR)), 2, dT=dT
    )  # compiles
    middle = Middle(point, steady_load(end), mesh, 0, dT=dT, surface=surface)
    level, seconds, cpu, told = middle.film.level, [], [], []
    rest, central = level.H.copy(), level.central_film()
    with Bracket() as bracket:
        for k in range(1, steps + 1):
            middle.T = k * dT
            exact = middle.converged(MOST) if k in (steps // 2, steps) else None
            middle.run.back()
            with Clock() as clock:
                entry = middle.run.advance(middle.T, dT)
            middle.run.keep(entry)
            seconds.append(clock.wall)
            cpu.append(clock.cpu)
            if exact is not None:
                errors = Errors.between(State.of(middle.film.multigrid), exact.state)
                told.append({"T": middle.T, "cycles": entry.step.cycles, **errors._asdict()})
            if not entry.step.status.ok:
                break
    entries = middle.run.history.entries[1:]
    row = {
        "case": case,
        "n": n,
        "steps": len(entries),
        "statuses": sorted({str(e.step.status) for e in entries}),
        "cycles": [float(np.mean([e.step.cycles for e in entries])), max(e.step.cycles for e in entries)],
        "seconds": statistics.median(seconds),
        "cpu": statistics.median(cpu),
        "errors": told,
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        **circumstances(),
    }
    return bracket.ratios(row), (level.H - rest) / central


def steady_load(until: float) -> PrescribedLoad:
    """Constant load, no inertia."""
    return PrescribedLoad(np.linspace(0.0, until, 4), np.ones(4))


def distances(grids: list[int], changes: list[NDArray[np.float64]]) -> list[float]:
    """RMS differences of the changes from grid to grid, over that of the finest, on the nodes of the coarsest."""
    X = np.linspace(NEAR.x_in, NEAR.x_out, grids[0] + 1)
    Y = np.linspace(0.0, NEAR.y_max, changes[0].shape[0])
    inside = np.hypot(X, Y[:, None]) < WITHIN
    common = [change[:: n // grids[0], :: n // grids[0]][inside] for n, change in zip(grids, changes, strict=True)]
    size = np.sqrt(np.mean(common[-1] ** 2))
    return [float(np.sqrt(np.mean((a - b) ** 2)) / size) for a, b in pairwise(common)]


def main() -> None:
    """Print a line for every passage, and the distances."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--n", type=int, nargs="+", default=[256, 512, 1024], help="grids, each twice the one before"
    )
    parser.add_argument("--case", nargs="+", choices=CASES, default=["rolling", "sliding", "rough"])
    parser.add_argument("--until", type=float, help="end of the runs, instead of that of the case")
    parser.add_argument("--json", type=Path, help="file for the rows")
    options = parser.parse_args()
    rows = []
    for case in options.case:
        changes = []
        for n in options.n:
            row, change = passage(case, n, options.until)
            rows.append(row)
            changes.append(change)
            print(json.dumps(row), flush=True)
            if options.json:
                options.json.write_text(json.dumps(rows, indent=1))
        print(
            case, "distance from grid to grid:", *(f"{d:.2e}" for d in distances(options.n, changes)), flush=True
        )


if __name__ == "__main__":
    main()
