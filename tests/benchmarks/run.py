"""Benchmarks, as ratios to one reference operation ("conv", see `conv`) timed before and after each.

    python tests/benchmarks/run.py                        # all rows on the default grids
    python tests/benchmarks/run.py --only "steady 6205" --n 128 256 512 1024 2048 --json run.json
    python tests/benchmarks/run.py --list                 # names of the rows

Steady films and steps in time are measured as `time_to_accuracy` says. Every row runs in a fresh
process, after JIT compilation; wall seconds are the median of a few repetitions, processor seconds stand beside. A
JSON file keeps each row as it comes, and a second call measures only what is missing, or was refused because the
machine was busy. Nothing here asserts a time.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from conv import Bracket, circumstances, median_seconds
from fmu_steps import fmu_steps
from row_file import Row, RowFile, Task, measure_missing
from time_to_accuracy import MOTIONS, measure, measure_step

from ehlcontact import FreeVibration, Grid, Lubricant, MoesPoint, impedance, simulate
from ehlcontact.solver.deflection import make_deflection
from reduced_models import BallBearing, BearingMotion, ContactRecord, fit

POINT = MoesPoint(200, 10, 0.5)
TEXTBOOK = {"viscosity": "barus", "density": "incompressible"}  # of Venner and Lubrecht
STEADY = {
    "200-10-0.5": POINT,
    "200-10-1": MoesPoint(200, 10, 1),
    "6205": MoesPoint(2900, 19, 0.107),
    "20-10-1": MoesPoint(20, 10, 1),
    "20-10-1-barus": MoesPoint(20, 10, 1, **TEXTBOOK),
    "200-10-1-barus": MoesPoint(200, 10, 1, **TEXTBOOK),
}
GRIDS, LARGEST_STEP_GRID = (128, 256, 512, 1024, 2048), 1024
DEFAULT_GRIDS = (128, 256, 512)
LARGEST_DIRECT = 512  # intervals: the direct sum takes 16 times as long with every doubling
BEARING_STEPS, BEARING_DT = 1000, 2e-5  # s
NEWTON_NODES = 40_000  # grids on which cycles are compared with Newton steps: n = 256 of `Domain()`


def steady(name: str, n: int, repeat: int | None = None, threads: int = 1) -> Row:
    """Full multigrid and cycles from nothing to the accurate measure, and to full convergence."""
    repeat = repeat or (5 if n <= 256 else 3)
    return measure(STEADY[name], n, repeat=repeat, newton_nodes=NEWTON_NODES, default=True, threads=threads)


def transient_step(motion: str, n: int, repeat: int | None = None, threads: int = 1) -> Row:
    """One step in the middle of a run, likewise."""
    return measure_step(POINT, motion, n, repeat=repeat or (9 if n <= 512 else 5), threads=threads)


def fitted_element() -> Row:
    """A cubic element from nothing: steady state, 2.5 periods of free vibration, fit."""
    outcome: dict[str, float] = {}

    def work() -> None:
        record = ContactRecord.from_result(simulate(POINT, FreeVibration(Omega_n=5.13), grid=Grid(n=64)))
        result = fit(record, model="cubic")
        outcome.update(root=result.root or np.nan, tangent=result.tangent or np.nan, **result.parameters)

    return _timed(work, 3) | outcome


def impedance_of_twelve() -> Row:
    """Impedance at twelve frequencies."""
    omega = np.concatenate([[0.0], np.geomspace(0.05, 30.0, 11)])
    return _timed(lambda: impedance(POINT, Omega=omega), 3) | {"n": impedance(POINT, Omega=omega).n}


def bearing(kernel: str) -> Row:
    """A thousand steps of a moved 6205, its 18 contacts with memory: by its kernel, or one element each."""
    made = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    t = BEARING_DT * np.arange(BEARING_STEPS + 1)
    q = np.column_stack([1e-6 + 2e-6 * np.sin(2e3 * t) ** 2, -1.2e-5 + 4e-6 * np.sin(1.4e3 * t) ** 2])
    v = np.gradient(q, BEARING_DT, axis=0)
    if kernel == "elements":  # once per step: an iteration asks several times
        elements = [made.element(race, 3000.0) for race in ("inner", "outer")] * made.balls
        return _timed(lambda: [element.drive(t, -0.5 * q[:, 1], -0.5 * v[:, 1]) for element in elements], 5)
    run = BearingMotion(made, 3000.0, BEARING_DT)
    run.rest(q[0])
    return _timed(lambda: run.drive(q[1:], v[1:]), 5)


def deflection(engine: str, n: int) -> Row:
    """One deflection of a film's pressure, steep where it cavitates; its largest error against fast transforms."""
    kappa, hx = 0.5, 6.0 / n
    X, Y = np.linspace(-4.5, 1.5, n + 1), np.linspace(0.0, 3.0, n // 2 + 1)[:, None]
    inlet = np.exp(-3.0 * np.maximum(-X - 0.9, 0.0)) * np.exp(-3.0 * np.maximum(Y - 0.9, 0.0))
    P = np.maximum(np.sqrt(np.maximum(1.0 - X**2 - Y**2, 0.0)), 0.05 * inlet * (X < 0.9))
    P[:, [0, -1]] = 0.0
    P[-1] = 0.0
    chosen, exact = (make_deflection(n, n // 2, hx, hx, kappa, name) for name in (engine, "fft"))
    return _timed(lambda: chosen(P), 5) | {"error": float(np.abs(chosen(P) - exact(P)).max())}


def _timed(work: Any, repetitions: int) -> Row:
    with Bracket() as bracket:
        row: Row = dict(median_seconds(work, repetitions))
    return bracket.ratios(row) | circumstances()


def tasks(grids: tuple[int, ...], repeat: int | None = None, threads: int = 1) -> list[Task]:
    """All rows on these grids; weights are seconds, about."""
    found = [
        Task(f"steady {name} {n}", steady, (name, n, repeat, threads), 4 + n * n * 8e-5)
        for name in STEADY
        for n in grids
    ]
    found += [
        Task(f"step {motion} {n}", transient_step, (motion, n, repeat, threads), 3 + n * n * 1e-4)
        for motion in MOTIONS
        for n in grids
        if n <= LARGEST_STEP_GRID
    ]
    found.append(Task("fitted cubic element", fitted_element, (), 5.0))
    found.append(Task("impedance, 12 frequencies", impedance_of_twelve, (), 5.0))
    found += [Task(f"bearing, 1000 steps, {kernel}", bearing, (kernel,), 5.0) for kernel in ("kernel", "elements")]
    found += [
        Task(f"FMU, a million steps, {kind}, lead {lead:g}", fmu_steps, (kind, lead), 6.0)
        for kind in ("cubic", "film")
        for lead in (1.5, 0.0)
    ]
    return found + [
        Task(f"deflection {engine} {n}", deflection, (engine, n), 3.0)
        for n in grids
        for engine in ("fft", "mlmi", "direct")
        if engine != "direct" or n <= LARGEST_DIRECT
    ]


def line(key: str, row: Row) -> str:
    """A row in words."""
    parts = []
    for name in ("accurate", "accurate_shared", "full", "full_shared", "solve_steady", "simulate"):
        if row.get(name):
            part = row[name]
            note = "" if part.get("accurate", True) else " (not accurate)"
            parts.append(f"{name} {part['cycles']} cycles {_ratio(part)}{note}")
    if "seconds" in row:
        parts.append(_ratio(row))
    if row.get("factor") is not None:
        parts.append(f"factor {row['factor']:.2f} per cycle of {row['work']:.1f} V(2,1)")
    parts += [str(row[name]) for name in ("verdict",) if name in row]
    if "us" in row:
        parts.append(f"{row['us']:.3f} us a step")
    if "peak_mb" in row:
        parts.append(f"{row['peak_mb']:.0f} MB")
    if row.get("newton_gap"):
        parts.append(f"Newton within {row['newton_gap']['P']:.0e} of P")
    if row.get("refused"):
        parts.append(f"BUSY: {row['refused']}")
    elif "conv_ms" in row:
        before, after = row["conv_ms"]
        parts.append(f"conv {before:.2f} and {after:.2f} ms")
    return f"{key:26s} " + "; ".join(parts)


def _ratio(part: Row) -> str:
    """Conv by the wall and by processor time, and seconds."""
    if part.get("cpu_conv") is None:
        return f"{part['seconds']:.3g} s"
    if part["conv"] is None:
        return f"{part['cpu_conv']:.3g} conv by cpu ({part['seconds']:.3g} s)"
    return f"{part['conv']:.3g} conv ({part['cpu_conv']:.3g} cpu, {part['seconds']:.3g} s)"


def main() -> None:
    """Run the rows and print them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[""], help="rows whose names hold one of these texts")
    parser.add_argument("--n", type=int, nargs="+", default=DEFAULT_GRIDS, help="intervals along X")
    parser.add_argument("--repeat", type=int, help="repetitions of which the median is told")
    parser.add_argument("--threads", type=int, default=1, help="of films and steps, timed beside one")
    parser.add_argument("--tries", type=int, default=2, help="of rows refused because the machine was busy")
    parser.add_argument("--json", type=Path, help="file for the rows; gone on with where it exists")
    parser.add_argument("--again", action="store_true", help="forget what the file holds")
    parser.add_argument("--list", action="store_true", help="names of the rows")
    arguments = parser.parse_args()
    found = tasks(tuple(arguments.n), arguments.repeat, arguments.threads)
    wanted = [task for task in found if any(t in task.key for t in arguments.only)]
    if arguments.list:
        print("\n".join(task.key for task in wanted))
        return
    file = RowFile(arguments.json, "run.py", again=arguments.again)
    measure_missing(file, wanted, line, tries=arguments.tries)


if __name__ == "__main__":
    main()
