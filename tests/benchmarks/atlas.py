"""The atlas against solves at points it has never seen.

    python tests/benchmarks/atlas.py --work held-out --points 100 --seed 11 --processes 2

Sobol points even over its box (M and kappa in their logarithm) are solved as a build solves its own, on meshes as
fine, and kept in a folder from which a stopped run goes on. Points whose film is too thin for any mesh of a table
are counted and left out; where the film asked for the region near the contact alone, damping is not compared,
since the atlas speaks of the default region. Beside the errors stand the shares that lie within the error bars.
With ``--between``, K and C at frequencies between those of the atlas too, at every tenth point.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np
from scipy.stats import qmc

from ehlcontact import Domain, Grid, MoesPoint, impedance
from reduced_models import Atlas
from reduced_models.atlas.build import solve_points
from reduced_models.atlas.film import OMEGAS, solve_point
from reduced_models.atlas.surface import shipped_file

NAMES = ("approach", "h_central", "h_min", "moment")


def held_out(atlas, count, seed):
    """Points by name, even over the box; a Hertz pressure beyond it leaves a draw out, and the next one counts."""
    box, found = atlas.box, {}
    for i, (u, v, w) in enumerate(qmc.Sobol(3, seed=seed).random_base2(math.ceil(math.log2(2 * count))).tolist()):
        M, kappa = (low * (high / low) ** share for (low, high), share in ((box.M, u), (box.kappa, w)))
        point = MoesPoint(M, box.L[0] + (box.L[1] - box.L[0]) * v, kappa)
        if point.p_hertz <= box.p_hertz and len(found) < count:
            found[f"held-{i}"] = point
    return found


def is_near(entry):
    """Whether it was solved on the near region."""
    return Domain(*entry["domain"]) == Domain.near()


def rows_of(atlas, entries):
    """Relative errors, and error over bar, of every quantity at every point."""
    rows = []
    for entry in entries:
        answer = atlas.at(MoesPoint(entry["M"], entry["L"], entry["kappa"]))
        film = entry.get("film", entry)
        found = {name: (getattr(answer, name) - film[name], answer.error_bars[name]) for name in NAMES}
        sizes = {name: abs(film[name]) for name in NAMES} | {"approach": max(abs(film["approach"]), 1.0)}
        found["separation"], sizes["separation"] = found["approach"], 1.0 - film["approach"]
        K, C, low = np.array(entry["stiffness"]), np.array(entry["damping"]), OMEGAS.index(0.05)
        found["tangent"], sizes["tangent"] = (answer.stiffness[0] - K[0], answer.error_bars["stiffness"][0]), K[0]
        found["K(Omega)"], sizes["K(Omega)"] = (answer.stiffness - K, answer.error_bars["stiffness"]), K
        if not is_near(entry):
            found["damping"], sizes["damping"] = (
                (answer.damping[low] - C[low], answer.error_bars["damping"][low]),
                C[low],
            )
            found["C(Omega)"], sizes["C(Omega)"] = (answer.damping - C, answer.error_bars["damping"]), C[low]
        row = {"point": [entry[name] for name in ("M", "L", "kappa")]}
        for name, (error, bar) in found.items():
            row[name] = np.atleast_1d(error / sizes[name]), np.atleast_1d(np.abs(error) / bar)
        rows.append(row)
    return rows


def table(rows):
    """Rms, 95 % and largest error, and the share within the bars, all in per cent; and the worst point."""
    result = {}
    for name in dict.fromkeys(name for row in rows for name in row if name != "point"):
        those = [row for row in rows if name in row]
        errors, over = (np.concatenate([row[name][i] for row in those]) for i in (0, 1))
        worst = max(those, key=lambda row: np.abs(row[name][0]).max())
        sizes = np.abs(100.0 * errors)
        figures = np.sqrt(np.mean(sizes**2)), np.quantile(sizes, 0.95), sizes.max(), 100.0 * np.mean(over <= 1.0)
        result[name] = [*map(float, figures), worst["point"]]
    return result


def between(atlas, entries):
    """Largest errors of K, and of C over its value at low frequency, halfway between the frequencies of the atlas.

    Those of the interpolation over frequency alone: solves at the frequencies of the atlas are interpolated too.
    """
    from reduced_models.atlas.frequency_curve import FrequencyCurve

    nodes = np.array(OMEGAS)
    middle = 0.5 * (nodes[1:] + nodes[:-1])
    worst = []
    for entry in entries[::10]:
        point = MoesPoint(entry["M"], entry["L"], entry["kappa"])
        truth = impedance(point, Omega=middle, grid=Grid(n=entry["n"], domain=Domain(*entry["domain"])))
        K, C = (FrequencyCurve(nodes, np.array(entry[name])).at(middle) for name in ("stiffness", "damping"))
        worst.append(
            [np.abs(K / truth.stiffness - 1.0).max(), np.abs(C - truth.damping).max() / entry["damping"][1]]
        )
    return (100.0 * np.max(worst, axis=0)).tolist()


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--atlas", type=Path, default=shipped_file("film"))
    for name, value in (("points", 100), ("seed", 11), ("processes", 2)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--between", action="store_true")
    asked = parser.parse_args()
    atlas = Atlas(asked.atlas)
    points = held_out(atlas, asked.points, asked.seed)
    entries = solve_points(
        points,
        asked.work,
        solve_point,
        processes=asked.processes,
        progress=lambda done, of: sys.stderr.write(f"{done} of {of}\n"),
    )
    solved = [entry for entry in entries if entry["status"] == "converged"]
    result = table(rows_of(atlas, solved))
    sys.stdout.write(f"{len(solved)} of {len(entries)} points solved\n")
    sys.stdout.write("| % | rms | 95 % | worst | in bars | worst at |\n|---|---|---|---|---|---|\n")
    for name, (rms, most, worst, inside, where) in result.items():
        at = ", ".join(f"{x:.4g}" for x in where)
        sys.stdout.write(f"| {name} | {rms:.2g} | {most:.2g} | {worst:.2g} | {inside:.1f} | ({at}) |\n")
    if asked.between:
        K, C = between(atlas, solved)
        sys.stdout.write(f"between the frequencies: K {K:.2g} %, C {C:.2g} %\n")
    if asked.json:
        asked.json.write_text(json.dumps({"solved": len(solved), "of": len(entries), "table": result}, indent=1))


if __name__ == "__main__":
    main()
