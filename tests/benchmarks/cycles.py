"""Cycles, and what they cost, over 24 points of the box and all grids on which their films are resolved.

    python tests/benchmarks/cycles.py --json cycles.json                     # everything: hours at n = 2048
    python tests/benchmarks/cycles.py --n 128 256 --points 1 4 20:10:.7

For each: cycles until P is within 1e-8 of the converged film, the mean factor by which its error falls, that
factor per V(2,1) cycle worth of relaxation, and what becomes of the cycles otherwise, as in
`time_to_accuracy`. A JSON file keeps each row as it comes; a second call measures only what is missing.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from row_file import Row, RowFile, Task, measure_missing
from time_to_accuracy import WAYS, measure

from ehlcontact import Grid, MoesPoint
from ehlcontact.solver.mesh_choice import Purpose, mesh_for

GRIDS = (128, 256, 512, 1024, 2048)
RESOLVED = 0.6  # mesh over inlet width up to which a film is resolved, as in `ehlcontact.solver.mesh_choice`
MOST_CYCLES, MOST_STEPS, LARGEST_FACTOR = 12, 8, 0.3  # asked for: per V(2,1) cycle worth of relaxation
LARGEST_GAP = 1e-9  # of P, between the solutions of cycles and of Newton steps
# Eight that were asked for, and sixteen chosen one after the other as far as possible from all before, in ln M, L
# and ln kappa, of 1024 Sobol points over M 5 to 30000, L 0 to 30, kappa 0.045 to 1 below 3.5 GPa.
POINTS: tuple[tuple[float, float, float], ...] = (
    (200, 10, 0.5),
    (20, 10, 1),
    (1000, 10, 1),
    (2900, 19, 0.107),  # a 6205
    (10000, 15, 0.09),
    (50, 0, 1),
    (5, 12, 0.12),
    (500, 8, 3),
    (11, 30, 0.43),
    (14, 29, 0.048),
    (310, 1, 0.058),
    (28000, 0, 0.19),
    (1200, 26, 0.54),
    (71, 23, 0.15),
    (5.7, 0, 0.23),
    (30000, 4, 0.77),
    (18000, 1, 0.05),
    (7700, 15, 0.37),
    (4200, 30, 0.057),
    (100, 16, 0.052),
    (550, 0, 0.27),
    (7.8, 4, 0.049),
    (40, 20, 0.6),
    (250, 10, 0.13),
)


def resolved(point: MoesPoint, n: int) -> bool:
    """Whether the mesh of n intervals sees the inlet of the film."""
    return mesh_for(point, Purpose.FILM, grid=Grid(n=n)).size <= RESOLVED * point.inlet_width


def chosen(texts: list[str]) -> list[tuple[float, float, float]]:
    """Points by number, from 1, or as M:L:kappa; all of them without texts."""
    found = []
    for text in texts:
        if ":" in text:
            M, L, kappa = (float(part) for part in text.split(":"))
            found.append((M, L, kappa))
        else:
            found.append(POINTS[int(text) - 1])
    return found or list(POINTS)


def tasks(points: list[tuple[float, float, float]], grids: list[int], way: str, newton: int = 0) -> list[Task]:
    """One for each point and grid on which it is resolved, the coarse grids first; weights are seconds, about."""
    return [
        Task(f"{M:g}:{L:g}:{kappa:g} {n}", solve, (M, L, kappa, n, way, newton), 4.0 + n * n * 6e-5)
        for n in grids
        for M, L, kappa in points
        if resolved(MoesPoint(M, L, kappa), n)
    ]


def solve(M: float, L: float, kappa: float, n: int, way: str, newton: int) -> Row:
    """One row; grids of up to `newton` nodes are solved by Newton steps too."""
    return measure(MoesPoint(M, L, kappa), n, way=way, newton_nodes=newton)


def fault(row: Row) -> str:
    """What a row lacks of what is asked for; nothing if all is well."""
    if row.get("full") is None:
        return str(row["verdict"])
    newton = row["way"].endswith("newton")
    most = MOST_STEPS if newton else MOST_CYCLES
    faults = [f"more than {most} {row['way']}"] if row["full"]["cycles"] > most else []
    if not newton and row["factor_v21"] is not None and row["factor_v21"] > LARGEST_FACTOR:
        faults.append(f"factor per V(2,1) above {LARGEST_FACTOR:g}")
    gap = row.get("newton_gap")
    if gap and not gap["P"] <= LARGEST_GAP:
        known = f", known to {gap['uncertainty']:.0e}" if gap["uncertainty"] > LARGEST_GAP else ""
        faults.append(f"{gap['P']:.0e} of P from Newton's solution{known}")
    return ", ".join(faults)


def line(key: str, row: Row) -> str:
    """A row in words."""
    if row.get("full") is None:
        return f"{key:24s} {row['verdict']}"
    factors = f"factor {row['factor']:.3f}" if row["factor"] else "factor -"
    if row["factor_v21"]:
        factors += f", per V(2,1) {row['factor_v21']:.3f}"
    cost = f"{row['full']['seconds']:.3g} s"
    if row["full"].get("cpu_conv") and not row["full"].get("conv"):
        cost = f"{row['full']['cpu_conv']:.3g} conv by cpu, {cost}"
    elif row["full"].get("conv"):
        cost = f"{row['full']['conv']:.3g} conv ({row['full']['cpu_conv']:.3g} cpu), {cost}"
    wrong = fault(row)
    note = f"  <- {wrong}" if wrong else ""
    return f"{key:24s} {row['full']['cycles']:3d} to 1e-8, {factors}, {cost}{note}"


def main() -> None:
    """Run and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", nargs="+", default=[], help="numbers from 1 to 24, or M:L:kappa")
    parser.add_argument("--n", type=int, nargs="+", default=GRIDS, help="intervals along X")
    parser.add_argument("--way", choices=WAYS, default="cycles")
    parser.add_argument("--newton", type=int, default=0, help="nodes up to which Newton steps are compared")
    parser.add_argument("--jobs", type=int, default=1, help="processes; with more than one, times mean little")
    parser.add_argument("--json", type=Path, help="file for the rows; gone on with where it exists")
    parser.add_argument("--again", action="store_true", help="forget what the file holds")
    arguments = parser.parse_args()
    file = RowFile(arguments.json, "cycles.py", {"way": arguments.way}, arguments.again)
    wanted = tasks(chosen(arguments.points), list(arguments.n), arguments.way, arguments.newton)
    measure_missing(file, wanted, line, jobs=arguments.jobs)
    rows = [file.rows[task.key] for task in wanted]
    bad = [row for row in rows if fault(row)]
    print(f"{len(rows) - len(bad)} of {len(rows)} as asked for")
    for row in bad:
        print(f"  {row['key']:24s} {fault(row)}")


if __name__ == "__main__":
    main()
