"""Entries of the table of oil supply without any solve: a film, and a store of oil ahead of it."""

import json

import numpy as np

from ehlcontact.content_store import ContentStore, key_of
from ehlcontact.film_formulas import film_of_layer, layer_sharpness
from reduced_models.atlas.supply_build import sample_supply
from reduced_models.atlas.supply_solve import RATIOS, SUPPLY_OMEGAS, solve_supply


def made_up(point, T=20.0, G=0.3):
    """Entry of a contact whose C is that of a film less that of a store ahead of it, without any solve."""
    w, m = np.array(SUPPLY_OMEGAS), len(RATIOS)
    r = np.array(RATIOS)
    share = film_of_layer(r, 1.1 * layer_sharpness(point.kappa))
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
        for s in share.tolist()
    ]
    named = {"M": point.M, "L": point.L, "kappa": point.kappa, "n": 64, "status": "converged"}
    return named | {"Omega": list(w), "ratios": list(RATIOS), "flooded": flooded, "starved": starved[:m]}


def prefill(work, draws, seed):
    """Folder of a build that has nothing left to solve."""
    store = ContentStore(work, "work folder")
    for point in sample_supply(draws, seed).values():
        key = key_of([solve_supply.__module__, solve_supply.__qualname__, point.to_dict()])
        store.put(key, json.dumps(made_up(point)).encode())
