"""Building the table of contact filters: sample points are solved once and put together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import __version__
from ehlcontact.errors import InputError
from ehlcontact.executors import require_scheduler
from ehlcontact.store import save
from reduced_models.atlas.filter_points import FILTERED, WAVE_NUMBERS, filter_points, solve_filter
from reduced_models.atlas.filter_table import FilterTable
from reduced_models.atlas.solved_points import Solve, solve_points

DRAWS, SEED = 72, 7
FEWEST = 20  # converged points of a table


def build_filters(
    output: Path,
    work: Path,
    draws: int = DRAWS,
    *,
    seed: int = SEED,
    processes: int = 1,
    scheduler: str | None = None,
    progress: Callable[[int, int], None] | None = None,
    solve: Solve = solve_filter,
) -> FilterTable:
    """Solve the missing points, put the table together and write it; arguments and errors as of `build_atlas`."""
    points = filter_points(draws, seed)
    if len(points) < FEWEST:
        raise InputError("points", len(points), f"at least {FEWEST}; draws = {draws} have too few in the box")
    if scheduler is not None:
        require_scheduler(scheduler)
    entries = solve_points(points, work, solve, processes=processes, scheduler=scheduler, progress=progress)
    command = f"ehlcontact atlas waves --draws {draws} --seed {seed}"
    table = assemble_filters(entries, {"command": command, "version": __version__})
    save(table, output, "table of contact filters")
    return table


def assemble_filters(entries: Sequence[Mapping[str, Any]], made_by: Mapping[str, Any]) -> FilterTable:
    """Table of the converged entries, in single precision but for the points; `made_by` goes into its metadata.

    Raises
    ------
    InputError
        Too few converged.
    """
    good = [one for one in entries if one["status"] == "converged"]
    if len(good) < FEWEST:
        raise InputError("converged points", len(good), f"at least {FEWEST} (more draws)")
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
