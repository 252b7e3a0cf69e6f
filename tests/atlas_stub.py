"""Stand-ins for the solvers of the atlas that worker processes can import: smooth in the point, done at once."""

from __future__ import annotations

import json
import math
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import Domain, MoesPoint
from ehlcontact.content_store import ContentStore
from ehlcontact.film_formulas import film_of_layer, layer_sharpness
from reduced_models.atlas.build import entry_key
from reduced_models.atlas.film import OMEGAS
from reduced_models.atlas.heat import HEAT_OMEGAS
from reduced_models.atlas.supply import OMEGAS as SUPPLY_OMEGAS
from reduced_models.atlas.supply import RATIOS
from reduced_models.atlas.table import recipe_named
from reduced_models.atlas.waves import WAVE_NUMBERS, dry_filter

PAUSE = 0.05


def solve(point: MoesPoint) -> dict[str, Any]:
    """Entry of a contact that is a dry spring on a film of the published thickness."""
    film = replace(point, L=max(point.L, 1e-3)).expected_film
    omega = np.array(OMEGAS)
    entry = {"M": point.M, "L": point.L, "kappa": point.kappa, "alpha": point.alpha, "eta0": point.eta0}
    entry |= {"version": "stub", "n": 64, "domain": list(Domain().as_tuple()), "approach": 1.0 - 1.2 * film}
    entry |= {"h_central": film, "h_min": 0.7 * film, "moment": 0.3 * film, "seconds": 0.0}
    stiffness = 1.5 / (1.0 + 0.1 * film) * (1.0 + 0.02 * film * omega / (1.0 + omega))
    damping = film * (0.1 + 0.6 / (1.0 + (omega / 2.0) ** 2))
    entry |= {"stiffness": stiffness.tolist(), "damping": damping.tolist()}
    # A few fail, as they do in earnest.
    return entry | {"status": "stagnated" if math.sin(1e4 * point.M) > 0.95 else "converged"}


def solve_slowly(point: MoesPoint) -> dict[str, Any]:
    """Entry of `solve`, so late that a build can be killed before it ends."""
    time.sleep(PAUSE)
    return solve(point)


def supplied(point: MoesPoint, T: float = 20.0, G: float = 0.3) -> dict[str, Any]:
    """Entry of a contact under layers whose C is that of a film less that of a store of oil ahead of it."""
    w, r = np.array(SUPPLY_OMEGAS), np.array(RATIOS)
    C = 0.05 / (1.0 + w**2)
    flooded = {"approach": 0.9, "h_central": 0.1, "h_min": 0.08, "moment": 0.01}
    flooded |= {"stiffness": [1.5] * w.size, "damping": C.tolist()}
    starved = [
        {
            "approach": 1.0 - 0.1 * s,
            "h_central": 0.1 * s,
            "h_min": 0.08 * s,
            "moment": 0.01 * s,
            "stiffness": [1.5 + 0.02 * (1.0 - s)] * w.size,
            "damping": (s**4 * C - (1.0 - s) * G / (1.0 + (T * w) ** 2)).tolist(),
        }
        for s in film_of_layer(r, 1.1 * layer_sharpness(point.kappa)).tolist()
    ]
    entry = {"M": point.M, "L": point.L, "kappa": point.kappa, "n": 64, "status": "converged"}
    return entry | {"Omega": list(w), "ratios": list(RATIOS), "flooded": flooded, "starved": starved}


def heated(contact: Any) -> dict[str, Any]:
    """Entry of a contact in which heat makes all numbers smaller by a tenth."""
    point = contact.point
    moes, heat = point.moes, contact.heat.at(point)
    cold: dict[str, Any] = dict.fromkeys(("approach", "h_central", "h_min", "moment"), 0.5)
    cold |= {name: [2.0] * len(HEAT_OMEGAS) for name in ("stiffness", "damping")}
    warm = {name: np.multiply(0.9, value).tolist() for name, value in cold.items()}
    entry = {"M": moes.M, "L": moes.L, "kappa": moes.kappa, "slope": heat.temperature_slope, "status": "converged"}
    return entry | {"thermal_load": heat.load(moes, point.scales), "cold": cold, "warm": warm, "n": 64}


def waved(point: MoesPoint) -> dict[str, Any]:
    """Entry of a contact whose filter is that of a dry one that is longer by its inlet."""
    k = np.array(WAVE_NUMBERS)
    longer = dry_filter(k * (1.0 + 0.2 * point.inlet_width)) * np.exp(0.05j * k * point.inlet_width)
    entry = {"M": point.M, "L": point.L, "kappa": point.kappa, "version": "stub", "status": "converged"}
    entry |= {"n": 64, "domain": [-4.5, 1.5, 3.0], "error": [0.01] * k.size}
    return entry | {"real": longer.real.tolist(), "imag": longer.imag.tolist()}


ENTRIES = {"film": solve, "supply": supplied, "heat": heated, "waves": waved}


def entries(recipe: str, *numbers: int) -> list[dict[str, Any]]:
    """Entries of a sample, in its order."""
    return [ENTRIES[recipe](point) for point in recipe_named(recipe).sample(*numbers).values()]


def prefill(recipe: str, work: Path, *numbers: int) -> None:
    """Folder of a build with the recipe's own solver that has nothing left to solve."""
    store, kind = ContentStore(work, "work folder"), recipe_named(recipe)
    for point in kind.sample(*numbers).values():
        store.put(entry_key(kind.solve, point), json.dumps(ENTRIES[recipe](point)).encode())
