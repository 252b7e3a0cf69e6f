"""A stand-in for the solver that worker processes can import: smooth in the point, and done at once."""

from __future__ import annotations

import json
import math
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import Domain, MoesPoint
from ehlcontact.content_store import ContentStore, key_of
from reduced_models.atlas.build import SEED
from reduced_models.atlas.sample import sample_points
from reduced_models.atlas.solve import OMEGAS, solve_point

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


def prefill(work: Path, draws: int, light_draws: int, seed: int = SEED) -> None:
    """Folder of a build with `solve_point` that has nothing left to solve."""
    store = ContentStore(work, "work folder")
    for point in sample_points(draws, light_draws, seed).values():
        key = key_of([solve_point.__module__, solve_point.__qualname__, point.to_dict()])
        store.put(key, json.dumps(solve(point)).encode())


def solve_slowly(point: MoesPoint) -> dict[str, Any]:
    """The same, so that a build can be killed before it ends."""
    time.sleep(PAUSE)
    return solve(point)
