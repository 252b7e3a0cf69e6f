"""Steady solves over the whole box of rolling bearings, unattended, and the thinnest of them on twice the grid.

    python tests/benchmarks/box.py --seed 7 --count 500 --json box-7.json --jobs 2
    python tests/benchmarks/box.py --seed 7 --count 500 --json box-7.json --jobs 2 --thin 60

Points of a scrambled Sobol sequence over ln M, L and ln kappa within `MEASURED` of
`ehlcontact.checks.admissible_range`: the first `count` of those below its Hertz pressure; grid, region and
method are the defaults of `solve_steady`. Every failure is printed as it comes, then statuses, convergence
factors and the worst ten. With ``--thin`` the converged ones with the thinnest films are solved again on twice
the grid, on the same region: a smallest film that moves by more than `LARGEST_MOVE` was not solved, whatever its
status says. A JSON file keeps each row as it comes; a second call solves only what is missing.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from math import exp, inf, log, log2
from pathlib import Path
from typing import NamedTuple

import numpy as np
from conv import circumstances
from row_file import Row, RowFile, Task, measure_missing
from scipy.stats import qmc

from ehlcontact import Domain, Grid, MoesPoint, solve_steady
from ehlcontact.checks.admissible_range import MEASURED
from ehlcontact.errors import InputError
from ehlcontact.solver.acceleration import AcceleratedCycles
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.iterate import IterationHistory, StoppingCriteria, iterate
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.status import Status
from ehlcontact.steady import APPROACH_TOLERANCE, LARGEST_RESIDUAL, LOAD_TOLERANCE, MAX_CYCLES

LARGEST_MOVE = 0.1  # of the smallest film on twice the grid
LARGEST_GRID = 4_000_000  # nodes of the twice finer grid: some gigabytes
CLOSE = 0.75  # distance of lines over that of nodes, in metres, below which `solve_steady` chose close lines
SHOWN = 10


def box_points(count: int, seed: int) -> list[MoesPoint]:
    """First `count` points of the sequence with a Hertz pressure in the box; more points add to the fewer."""
    points: list[MoesPoint] = []
    draws = 2 ** int(np.ceil(np.log2(max(count, 1))))
    while len(points) < count:
        draws *= 2
        unit = qmc.Sobol(3, scramble=True, seed=seed).random(draws)
        points = [point for point in map(_point, unit) if point.p_hertz < MEASURED.p_hertz][:count]
    return points


def _point(unit: np.ndarray) -> MoesPoint:
    (M_low, M_high), (L_low, L_high), (kappa_low, kappa_high) = MEASURED.M, MEASURED.L, MEASURED.kappa
    a, b, c = (float(x) for x in unit)
    M = exp(log(M_low) + a * log(M_high / M_low))
    return MoesPoint(M, L_low + b * (L_high - L_low), exp(log(kappa_low) + c * log(kappa_high / kappa_low)))


def solve(M: float, L: float, kappa: float) -> Row:
    """One solve; the convergence factor is the geometric mean over its cycles, or Newton steps, to tolerance."""
    point = MoesPoint(M, L, kappa)
    result = solve_steady(point, throw=False, budget=inf)
    drop = result.residuals[-1] / result.residuals[0]
    return {
        "M": M,
        "L": L,
        "kappa": kappa,
        "p_hertz": point.p_hertz,
        "status": str(result.status),
        "cycles": result.cycles,
        "factor": float(drop ** (1.0 / result.cycles)) if result.cycles and np.isfinite(drop) else None,
        "n": result.n,
        "apart": float((result.y[1] - result.y[0]) / (kappa * (result.x[1] - result.x[0]))),
        "domain": result.domain.as_tuple(),
        "approach": result.approach,
        "h_central": result.h_central,
        "h_min": result.h_min,
        "residual": result.residual,
        "error_estimate": result.to_dict()["error_estimate"],
        "seconds": result.seconds,
    }


def solve_finer(row: Row) -> Row:
    """The same film on twice the grid, and how far its films and its approach have moved, of the finer ones."""
    domain, point = Domain(*row["domain"]), MoesPoint(row["M"], row["L"], row["kappa"])
    lines = 2 ** round(-log2(row["apart"])) if row["apart"] < CLOSE else 1  # the number of lines was rounded up
    mesh = Mesh(2 * row["n"], domain, point.kappa, lines)
    found: Row = {"of": row["key"], "M": row["M"], "L": row["L"], "kappa": row["kappa"], "n": mesh.n}
    found["estimate"] = row["error_estimate"]["h_min_relative"]
    if not mesh.nodes <= LARGEST_GRID:
        return found | {"status": "not solved: the grid has too many nodes", "move": None}
    try:
        result = (
            finer_close_lines(point, mesh)
            if mesh.y_refinement > 1
            else solve_steady(point, grid=Grid(n=mesh.n, domain=domain), throw=False)
        )
    except InputError as refused:  # too little memory
        return found | {"status": f"not solved: {refused}", "move": None}
    moves = {
        name: abs(row[of] / getattr(result, of) - 1.0) if result.status.ok else None
        for name, of in (("move", "h_min"), ("move_central", "h_central"), ("move_approach", "approach"))
    }
    return found | {"status": str(result.status), "h_min": result.h_min, "seconds": result.seconds} | moves


class Finer(NamedTuple):
    """What of a film is compared."""

    status: Status
    approach: float
    h_central: float
    h_min: float
    seconds: float


def finer_close_lines(point: MoesPoint, mesh: Mesh) -> Finer:
    """As `solve_steady`, which has no close lines where n is given: cycles, then with load continuation."""
    started = time.perf_counter()
    mesh.require_memory()
    for load_continuation in (False, True):
        film, load = Multigrid(point, mesh, load_continuation=load_continuation), Balance.of_load()
        scale = film.finest.dry_residual()
        film.full_multigrid(load)
        goal = StoppingCriteria(
            scale, LARGEST_RESIDUAL, MAX_CYCLES, LOAD_TOLERANCE, APPROACH_TOLERANCE, pressure=1e-5
        )
        status = iterate(film, load, AcceleratedCycles(film).step, goal, IterationHistory())
        if status.ok:
            break
    level = film.finest
    return Finer(status, film.u, level.central_film(), level.lowest_film(), time.perf_counter() - started)


def line(key: str, row: Row) -> str:
    """A row in words."""
    where = f"{key:>4s}  M {row['M']:8.1f}  L {row['L']:5.2f}  kappa {row['kappa']:.3f}" if "M" in row else key
    if "of" in row:
        moved = "-" if row["move"] is None else f"{100 * row['move']:.2g} %"
        told = f", estimate {100 * row['estimate']:.2g} %"
        return f"{where}  n {row['n']:4d}  {row['status']}: smallest film moves by {moved}{told}"
    if "n" not in row:
        return f"{where}  {row['status']}: {row.get('verdict', '')}"
    factor = "   -" if row["factor"] is None else f"{row['factor']:.2f}"
    return (
        f"{where}  {row['status']:13s} n {row['n']:4d}  cycles {row['cycles']:2d}  factor {factor}  "
        f"Hm {row['h_min']:.5f}  {row['seconds']:.1f} s"
    )


def failure(key: str, row: Row) -> str:
    """A row in words, where it failed; otherwise nothing to say."""
    return line(key, row) if row["status"] != "converged" else ""


def thinnest(rows: list[Row], number: int) -> list[Row]:
    """Converged rows with the smallest films."""
    return sorted((row for row in rows if row["status"] == "converged"), key=lambda row: row["h_min"])[:number]


def summary(rows: list[Row], thin: list[Row]) -> list[str]:
    """What came out, in lines."""
    good = [row for row in rows if row["status"] == "converged"]
    counts = Counter(str(row["status"]) for row in rows)
    told = ", ".join(f"{number} {status}" for status, number in counts.most_common())
    lines = [f"converged {len(good)} of {len(rows)} ({len(good) / max(len(rows), 1):.1%}): {told}"]
    factors = [row["factor"] for row in good if row["factor"] is not None]
    if factors:
        lines.append(f"factor per cycle: median {np.median(factors):.3f}, worst {max(factors):.2f}")
        seconds = [row["seconds"] for row in rows if "seconds" in row]
        lines.append(f"seconds: median {np.median(seconds):.2f}, all {sum(seconds) / 60.0:.1f} min")
    if thin:
        known = [row for row in thin if row.get("move") is not None]  # none of a process that died
        moves = [row["move"] for row in known]
        moved = [row for row in known if row["move"] > LARGEST_MOVE]
        lines.append(
            f"smallest film of the {len(thin)} thinnest on twice the grid: {len(moves)} solved there, of which "
            f"{len(moved)} move by more than {100 * LARGEST_MOVE:.0f} %"
            + (f"; median {100 * np.median(moves):.2g} %, worst {100 * max(moves):.2g} %" if moves else "")
            + f"; {sum(row['estimate'] <= LARGEST_MOVE for row in moved)} of these had an estimate below that"
        )
        told_apart = [row for row in thin if row in moved or row not in known]
        lines += ["  " + line(row.get("of", row.get("key", "")), row) for row in told_apart]
    return lines


def main() -> None:
    """Run and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500, help="points")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--thin", type=int, default=0, help="thinnest films to solve again on twice the grid")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--json", type=Path, help="file for the rows; gone on with where it exists")
    parser.add_argument("--again", action="store_true", help="forget what the file holds")
    arguments = parser.parse_args()
    file = RowFile(arguments.json, "box.py", {"seed": arguments.seed}, arguments.again)
    file.more["made"] = circumstances()
    points = box_points(arguments.count, arguments.seed)
    wanted = [Task(str(k), solve, (p.M, p.L, p.kappa), 1.0) for k, p in enumerate(points)]
    for task in wanted:
        if file.rows.get(task.key, {}).get("M", task.arguments[0]) != task.arguments[0]:
            parser.error(
                f"{arguments.json}: point {task.key} is another; the box has changed, --again overwrites it"
            )
    print(f"seed {arguments.seed}: {len(points)} points below {MEASURED.p_hertz * 1e-9:g} GPa")
    measure_missing(file, wanted, failure, jobs=arguments.jobs, lasting=True, tries=2)
    rows = [file.rows[task.key] for task in wanted]
    thin = thinnest(rows, arguments.thin)
    again = [Task(f"thin {row['key']}", solve_finer, (row,), float(row["n"]) ** 2) for row in thin]
    measure_missing(file, again, line, jobs=arguments.jobs, tries=2)
    print("\n".join(summary(rows, [file.rows[task.key] for task in again])))
    print("worst ten:")
    for row in sorted(rows, key=lambda row: (row["status"] == "converged", -(row.get("factor") or 1.0)))[:SHOWN]:
        print("  " + line(row["key"], row))


if __name__ == "__main__":
    main()
