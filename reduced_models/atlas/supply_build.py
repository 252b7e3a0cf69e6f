"""Building the table of oil supply: sample points are solved once under all layers and put together."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from ehlcontact import MoesPoint
from ehlcontact.store import save
from reduced_models.atlas.build import INTERPOLATION
from reduced_models.atlas.sample import OVERSHOOT, between, overshot, sobol
from reduced_models.atlas.solved_points import Entry, Solving, require_enough, solved_table
from reduced_models.atlas.supply_solve import INTERVALS, RATIOS, SUPPLY_OMEGAS, solve_supply
from reduced_models.atlas.supply_table import FAINT, REFERENCE, SupplyTable, share_of_layer
from reduced_models.atlas.table import Box

_Floats = NDArray[np.float64]

# Weights for the smallest errors of points left out: kappa counts for more than in the atlas, the film for less.
SUPPLY_INTERPOLATION = replace(INTERPOLATION, weights=(0.4, 0.2, 0.6, 1.0, 0.25), covered=0.95)
SUPPLY_DRAWS, SUPPLY_SEED = 256, 31
SUPPLY_BOX = Box(M=(10.0, 20000.0), L=(4.0, 26.0), kappa=(0.08, 1.0), p_hertz=4.1e9)
SAMPLED = Box(M=(9.5, 21000.0), L=(3.8, 26.5), kappa=(0.077, 1.05), p_hertz=4.2e9)  # with a margin
LIGHTEST, MARGIN = 8.0, 0.9  # load number of the lightest contacts, and of the draws over it
SLOWEST_FADE = 1.0  # power of r by which changes fade, at least, where the front lies ahead of the region


def sample_supply(draws: int, seed: int) -> dict[str, MoesPoint]:
    """Points to solve by name, of a Sobol sequence; those of too thin a film or too high a pressure fall away."""
    shares = overshot(sobol(3, draws, seed), OVERSHOOT)
    M, L, kappa = SAMPLED.M, SAMPLED.L, SAMPLED.kappa
    points: dict[str, MoesPoint] = {}
    for i, (u, v, w) in enumerate(shares.tolist()):
        point = MoesPoint(between(M, u), L[0] + (L[1] - L[0]) * v, between(kappa, w))
        light = point.load_number < MARGIN * LIGHTEST
        if not light and point.inlet_width >= INTERVALS[-1][0] and point.p_hertz <= SAMPLED.p_hertz:
            points[f"supply-{i}"] = point
    return points


def build_supply(
    output: Path,
    work: Path,
    draws: int = SUPPLY_DRAWS,
    *,
    seed: int = SUPPLY_SEED,
    **solving: Unpack[Solving],
) -> SupplyTable:
    """Solve the missing points, put the table together and write it; arguments and errors as of `build_atlas`."""
    points = sample_supply(draws, seed)
    require_enough("points", points, f"; draws = {draws} have too few in the box")
    command = f"ehlcontact atlas supply --draws {draws} --seed {seed}"
    table = solved_table(points, work, solve_supply, assemble_supply, command, **solving).rounded()
    save(table, output, "table of oil supply")
    return table


def assemble_supply(entries: Sequence[Entry], made_by: Mapping[str, Any]) -> SupplyTable:
    """Table of the converged entries; `made_by` goes into its metadata.

    Raises
    ------
    InputError
        Too few converged.
    """
    found = [(e, changes_of(e)) for e in entries if e["status"] == "converged"]
    good = [(e, rows) for e, rows in found if rows is not None]
    require_enough("converged points", good, " (more draws)")
    ahead = sum(one is None for e, _ in good for one in e["starved"])
    return SupplyTable(
        points=np.array([[e["M"], e["L"], e["kappa"]] for e, _ in good]),
        ratios=np.array(RATIOS),
        omega=np.array(SUPPLY_OMEGAS),
        changes=np.array([rows for _, rows in good]),
        metadata={
            "box": SUPPLY_BOX.to_dict(),
            "narrowest": INTERVALS[-1][0],
            "lightest": LIGHTEST,
            "interpolation": asdict(SUPPLY_INTERPOLATION),
            "points": len(good),
            "left_out": len(entries) - len(good),
            "front_ahead": ahead,
            "meshes": {str(n): count for n, count in sorted(Counter(e["n"] for e, _ in good).items())},
            **made_by,
        },
    )


def changes_of(entry: Entry) -> _Floats | None:
    """Smooth variables of an entry, (m, 4 + 2 k); None where the thinnest layers have no film.

    Layers so thick that the film begins ahead of the region are taken to fade from the last two that do not.
    """
    rows = [
        None if one is None else _change(entry, one, r)
        for r, one in zip(entry["ratios"], entry["starved"], strict=True)
    ]
    known = [row for row in rows if row is not None]
    solved = len(known)
    if solved < len(rows) // 2 or any(row is None for row in rows[:solved]):
        return None
    r = np.array(entry["ratios"])
    for k in range(solved, len(rows)):
        before, last = known[solved - 2], known[solved - 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            power = np.log(before / last) / np.log(r[solved - 1] / r[solved - 2])
        power = np.maximum(np.nan_to_num(power, nan=SLOWEST_FADE, posinf=SLOWEST_FADE), SLOWEST_FADE)
        known.append(last * (r[solved - 1] / r[k]) ** power)
    return np.array(known)


def _change(entry: Entry, starved: Mapping[str, Any], ratio: float) -> _Floats:
    """Smooth variables of one layer, see `reduced_models.atlas.supply_table`."""
    flooded = entry["flooded"]
    share = starved["h_central"] / flooded["h_central"]
    curve = float(share_of_layer(np.array([ratio]), np.array([entry["kappa"]]))[0])
    lobe = starved["h_min"] / flooded["h_min"] / share
    approach = (starved["approach"] - flooded["approach"]) / (1.0 - flooded["approach"])
    moment = starved["moment"] / flooded["moment"] - 1.0
    K = np.log(np.divide(starved["stiffness"], flooded["stiffness"]))
    C = np.array(flooded["damping"])
    unit = np.maximum(C, FAINT * C[SUPPLY_OMEGAS.index(REFERENCE)])
    return np.concatenate(
        [
            [math.log(share / curve), math.log(lobe), approach, moment],
            K,
            np.arcsinh((starved["damping"] - C) / unit),
        ]
    )
