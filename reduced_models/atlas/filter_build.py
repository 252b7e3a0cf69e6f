"""Building the table of contact filters: sample points are solved once and put together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from ehlcontact.store import save
from reduced_models.atlas.filter_points import FILTERED, WAVE_NUMBERS, filter_points, solve_filter
from reduced_models.atlas.filter_table import FilterTable
from reduced_models.atlas.solved_points import Entry, Solve, Solving, require_enough, solved_table

DRAWS, SEED = 72, 7


def build_filters(
    output: Path,
    work: Path,
    draws: int = DRAWS,
    *,
    seed: int = SEED,
    solve: Solve = solve_filter,
    **solving: Unpack[Solving],
) -> FilterTable:
    """Solve the missing points, put the table together and write it; arguments and errors as of `build_atlas`."""
    points = filter_points(draws, seed)
    require_enough("points", points, f"; draws = {draws} have too few in the box")
    command = f"ehlcontact atlas waves --draws {draws} --seed {seed}"
    table = solved_table(points, work, solve, assemble_filters, command, **solving)
    save(table, output, "table of contact filters")
    return table


def assemble_filters(entries: Sequence[Entry], made_by: Mapping[str, Any]) -> FilterTable:
    """Table of the converged entries, in single precision but for the points; `made_by` goes into its metadata.

    Raises
    ------
    InputError
        Too few converged.
    """
    good = [one for one in entries if one["status"] == "converged"]
    require_enough("converged points", good, " (more draws)")
    meshes = Counter(f"{one['n']} from X = {one['domain'][0]:.3g}" for one in good)
    table = FilterTable(
        points=np.array([[one["M"], one["L"], one["kappa"]] for one in good]),
        k=np.array(WAVE_NUMBERS),
        real=np.array([one["real"] for one in good]),
        imag=np.array([one["imag"] for one in good]),
        left_out=np.zeros(0),
        factor=np.zeros(0),
        metadata={
            "box": FILTERED.to_dict(),
            "points": len(good),
            "left_out": len(entries) - len(good),
            "meshes": dict(sorted(meshes.items())),
            "mesh_error": np.median([one["error"] for one in good], axis=0).round(4).tolist(),
            **made_by,
        },
    ).judged()
    single = [one.name for one in fields(table) if one.name not in ("points", "k", "metadata")]
    return replace(table, **{name: getattr(table, name).astype(np.float32).astype(float) for name in single})
