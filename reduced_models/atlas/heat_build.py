"""Building the table of heat: a sample of contacts is solved once, with heat and without, and put together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from ehlcontact.store import save
from reduced_models.atlas.build import BOX
from reduced_models.atlas.heat_sample import sample_heated
from reduced_models.atlas.heat_solve import HEAT_OMEGAS, solve_heated
from reduced_models.atlas.heat_table import KNOWN, HeatTable, Settings, changes_of
from reduced_models.atlas.solved_points import Entry, Solving, require_enough, solved_table

HEAT_DRAWS, HEAT_SEED = 256, 11
SETTINGS = Settings(weights=(0.6, 0.145, 0.08, 0.45, 0.5))  # of least error, about, when each point is left out


def build_heat(
    output: Path,
    work: Path,
    draws: int = HEAT_DRAWS,
    *,
    seed: int = HEAT_SEED,
    **solving: Unpack[Solving],
) -> HeatTable:
    """Solve the missing contacts and write the table of all; arguments and errors as of `build_atlas`."""
    contacts = sample_heated(draws, seed, BOX)
    require_enough("contacts", contacts, f"; draws = {draws} have too few")
    command = f"ehlcontact atlas heat --draws {draws} --seed {seed}"
    table = solved_table(contacts, work, solve_heated, assemble_heat, command, **solving).rounded()
    save(table, output, "table of heat")
    return table


def assemble_heat(
    entries: Sequence[Entry], made_by: Mapping[str, Any], settings: Settings = SETTINGS
) -> HeatTable:
    """Table of the converged entries; `made_by` goes into its metadata.

    Raises
    ------
    InputError
        Too few converged.
    """
    good = [one for one in entries if one["status"] == "converged"]
    require_enough("converged contacts", good, " (more draws)")
    return HeatTable(
        points=np.array([[one[name] for name in KNOWN] for one in good]),
        omega=np.array(HEAT_OMEGAS),
        changes=np.array([changes_of(one) for one in good]),
        metadata={
            "interpolation": settings._asdict(),
            "points": len(good),
            "left_out": dict(Counter(str(e["status"]) for e in entries if e["status"] != "converged")),
            "meshes": {str(n): count for n, count in sorted(Counter(e["n"] for e in good).items())},
            **made_by,
        },
    )
