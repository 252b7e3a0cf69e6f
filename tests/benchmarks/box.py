"""Steady solves over the whole box of rolling bearings, unattended.

Run with ``python tests/benchmarks/box.py [--points 300] [--seed 7] [--json FILE]``. Points of a scrambled Sobol
sequence over log M, L and log kappa, those with a Hertz pressure below 3.5 GPa; grid, domain and method are left
to `solve_steady`. Prints every failure as it comes, the convergence factors and the worst ten. With ``--json`` it
goes on where an interrupted run of the same seed stopped.
"""

from __future__ import annotations

import argparse
import json
from math import exp, log
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from ehlcontact import MoesPoint, solve_steady

M_RANGE, L_RANGE, KAPPA_RANGE = (5.0, 30000.0), (0.0, 25.0), (0.08, 5.0)
LARGEST_PRESSURE = 3.5e9


def box_points(number: int, seed: int) -> list[MoesPoint]:
    """First `number` points of the sequence, less those with too high a Hertz pressure."""
    unit = qmc.Sobol(3, scramble=True, seed=seed).random(2 ** int(np.ceil(np.log2(number))))[:number]
    points = []
    for a, b, c in unit:
        M = exp(log(M_RANGE[0]) + a * log(M_RANGE[1] / M_RANGE[0]))
        L = L_RANGE[0] + b * (L_RANGE[1] - L_RANGE[0])
        kappa = exp(log(KAPPA_RANGE[0]) + c * log(KAPPA_RANGE[1] / KAPPA_RANGE[0]))
        points.append(MoesPoint(M, L, kappa))
    return [point for point in points if point.p_hertz < LARGEST_PRESSURE]


def measure(point: MoesPoint) -> dict[str, Any]:
    """One solve; the convergence factor is the geometric mean over its cycles, or Newton steps, to tolerance."""
    result = solve_steady(point, throw=False)
    drop = result.residuals[-1] / result.residuals[0]
    return {
        "M": point.M,
        "L": point.L,
        "kappa": point.kappa,
        "p_hertz": point.p_hertz,
        "status": str(result.status),
        "cycles": result.cycles,
        "factor": float(drop ** (1.0 / result.cycles)) if result.cycles and np.isfinite(drop) else None,
        "n": result.n,
        "domain": result.domain.as_tuple(),
        "approach": result.approach,
        "h_central": result.h_central,
        "h_min": result.h_min,
        "residual": result.residual,
        "error": result.summary()["error"],
        "seconds": result.seconds,
    }


def line(row: dict[str, Any]) -> str:
    """A row in words."""
    factor = "   -" if row["factor"] is None else f"{row['factor']:.2f}"
    return (
        f"M {row['M']:8.1f}  L {row['L']:5.2f}  kappa {row['kappa']:.3f}  {row['status']:13s} n {row['n']:4d}  "
        f"cycles {row['cycles']:2d}  factor {factor}  Hm {row['h_min']:.5f}  {row['seconds']:.1f} s"
    )


def main() -> None:
    """Run and report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    points = box_points(arguments.points, arguments.seed)
    rows: list[dict[str, Any]] = []
    if arguments.json is not None and arguments.json.exists():
        known = json.loads(arguments.json.read_text())
        if known["seed"] == arguments.seed:
            rows = known["rows"][: len(points)]
    print(f"seed {arguments.seed}: {len(points)} of {arguments.points} points below 3.5 GPa, {len(rows)} known")
    measure(MoesPoint(20.0, 5.0, 0.5))  # compiles
    for point in points[len(rows) :]:
        rows.append(measure(point))
        if rows[-1]["status"] != "converged":
            print(line(rows[-1]), flush=True)
        if arguments.json is not None:
            arguments.json.write_text(json.dumps({"seed": arguments.seed, "rows": rows}))
    good = [row for row in rows if row["status"] == "converged"]
    factors = [row["factor"] for row in good if row["factor"] is not None]
    print(f"converged {len(good)} of {len(rows)} ({len(good) / len(rows):.1%})")
    print(f"factor per cycle: median {np.median(factors):.3f}, worst {max(factors):.2f}")
    print(f"seconds: median {np.median([row['seconds'] for row in rows]):.2f}")
    print("worst ten:")
    for row in sorted(rows, key=lambda row: (row["status"] == "converged", -(row["factor"] or 1.0)))[:10]:
        print("  " + line(row))


if __name__ == "__main__":
    main()
