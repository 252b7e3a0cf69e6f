"""Building the atlas: sample points are solved once, stored in a work file, and assembled into a table.

The numbers by which that is done stand here and, those of the interpolation and of other oils, in `table`; they go
into the file of the atlas and are read from there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Domain, MoesPoint
from ehlcontact.film_formulas import LIGHT_BLEND, LIGHT_LOAD
from ehlcontact.store import save
from reduced_models.atlas import interpolation
from reduced_models.atlas.gain_fit import FLOOR, HIGHEST, RIDGE, smooth_gains
from reduced_models.atlas.sample import SAMPLED, sample_points
from reduced_models.atlas.solve import FILM, OMEGAS, solve_point
from reduced_models.atlas.solved_points import FEWEST, Entry, Solve, Solving, require_enough, solved_table
from reduced_models.atlas.table import AtlasTable, Box, Interpolation, OtherOil
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

DRAWS, LIGHT_DRAWS, SEED = 448, 256, 4
BOX = Box(M=(1.0, 30000.0), L=(0.0, 30.0), kappa=(0.045, 1.0), p_hertz=4.1e9)
# By tests/benchmarks/tune_atlas.py, other weights lower the error of points left out by less than 2 %, and the
# slopes for other oils cover what is left at light, middle and heavy load.
INTERPOLATION = Interpolation(
    weights=(0.4, 0.16, 0.33, 0.905, 0.476),
    lobe_weights=(0.112, 0.083, 0.223, 2.78),
    light_load=LIGHT_LOAD,
    light_blend=LIGHT_BLEND,
    thick=0.1,
    asinh=0.02,
    reference=1,
    nearest=10,
    covered=0.98,
)
OIL = OtherOil(
    alpha=(1e-8, 4e-8),
    eta0=(0.002, 1.0),
    secant=1.8,
    film=(0.06, 0.006),
    stiffness=(0.08, 0.01),
    damping=(0.13, 0.012),
    moment=(0.055, 0.01),
)
# That fit all points together, by that script: those of the atlas before, without light loads, fit a third worse.
RATES = FilterRates(lags=14, lag_rate=6.42, inlet_rate=14.9, fast_rate=43.0)


def build_atlas(
    output: Path,
    work: Path,
    draws: int = DRAWS,
    light_draws: int = LIGHT_DRAWS,
    *,
    seed: int = SEED,
    solve: Solve = solve_point,
    **solving: Unpack[Solving],
) -> AtlasTable:
    """Solve the missing points, assemble the table and write it.

    Killed at any moment and called again it goes on, also with more draws. The file does not depend on who solved
    the points, nor on how often the build was interrupted.

    Parameters
    ----------
    output : Path
        The atlas.
    work : Path
        Folder of solved points, made if it does not exist.
    draws, light_draws : int
        Over the box, and over its light loads; see `reduced_models.atlas.sample.sample_points`.
    seed : int
        Of the Sobol sequence.
    solve : callable
        Of one point; to be found by name in every worker.
    **solving
        Processes, scheduler and progress, as of `reduced_models.atlas.solved_points.solve_points`.

    Raises
    ------
    InputError
        No folder, no scheduler at that address, or too few points that converged.
    """
    points = sample_points(draws, light_draws, seed)
    advice = f"; draws = {draws} and light_draws = {light_draws} have too few in the box"
    require_enough("points", points, advice)  # before they are solved
    command = f"ehlcontact atlas build --draws {draws} --light-draws {light_draws} --seed {seed}"
    table = solved_table(points, work, solve, assemble, command, **solving)
    save(table.rounded(), output, "atlas")
    return table


def assemble(entries: Sequence[Entry], made_by: Mapping[str, Any]) -> AtlasTable:
    """Table of the converged entries; `made_by` goes into its metadata.

    Where the film is so thin that only the near domain was solved, what the oil further out adds to damping and
    moment and takes from the approach is learnt from the points that were solved on both: it is the coefficient
    lambda of the Reynolds equation times a smooth function of kappa and L, since there the gap is that of the dry
    contact.

    Raises
    ------
    InputError
        Too few converged.
    """
    if not all(isinstance(e["status"], str) for e in entries):
        raise TypeError("a status that is no word")
    good = [e for e in entries if e["status"] == "converged"]
    require_enough("converged points", good, " (more draws)")
    omega = np.array(OMEGAS)
    points = _column(good, "M", "L", "kappa")
    steady = [e.get("film", e) for e in good]
    film = dict(zip(FILM, _column(steady, *FILM).T, strict=True))
    K, C = (np.array([e[name] for e in good]) for name in ("stiffness", "damping"))
    far = _FarOil([e for e in good if e.get("close") is not None])
    near = np.array([_is_near(e) for e in good])
    if near.any():
        C[near] += far.adds("damping", points[near])
        ends_near = np.array([_is_near(e) for e in steady])
        for name in ("approach", "moment"):
            film[name][ends_near] += far.adds(name, points[ends_near])
    table = AtlasTable(
        points=points,
        omega=omega,
        **film,
        stiffness=K,
        damping=C,
        gains=np.array(
            [smooth_gains(omega, k, c, RATES, c[INTERPOLATION.reference]) for k, c in zip(K, C, strict=True)]
        ),
        left_out=np.empty(0),
        factor=np.empty(0),
        metadata={**_metadata(entries, good), **made_by, "sampled": SAMPLED.to_dict()},
    )
    return judged(table)


def judged(table: AtlasTable) -> AtlasTable:
    """Table with leave-one-out errors, from which its error bars follow."""
    left_out, factor = interpolation.judge(table.points, table.answers, table.interpolation)
    return replace(table, left_out=left_out, factor=factor)


def _metadata(entries: Sequence[Entry], good: Sequence[Entry]) -> dict[str, Any]:
    """Settings and sources of the table."""
    law = MoesPoint(good[0]["M"], good[0]["L"], good[0]["kappa"])
    meshes = Counter((int(e["n"]), "the near domain" if _is_near(e) else "the default domain") for e in good)
    near = next((list(e["domain"]) for e in good if _is_near(e)), None)
    return {
        "box": BOX.to_dict(),
        "rates": asdict(RATES),
        "highest_omega": HIGHEST,
        "gain_fit": {"floor": FLOOR, "ridge": RIDGE},
        "interpolation": asdict(INTERPOLATION),
        "oil": asdict(OIL),
        "points": len(good),
        "left_out": dict(Counter(str(e["status"]) for e in entries if e["status"] != "converged")),
        "meshes": {f"{n} on {region}": count for (n, region), count in sorted(meshes.items())},
        "near_domain": near,
        "alpha": float(good[0]["alpha"]),
        "eta0": float(good[0]["eta0"]),
        "viscosity": law.viscosity,
        "density": law.density,
    }


class _FarOil:
    """What the default domain has more than the near one, over lambda: linear in ln kappa, its square, and L."""

    def __init__(self, pairs: Sequence[Entry]) -> None:
        self._adds: dict[str, _Floats] = {}
        if len(pairs) < FEWEST:
            return
        points = _column(pairs, "M", "L", "kappa")
        basis, lam = self._basis(points), _lambda(points)
        for name in ("damping", "approach", "moment"):
            more = np.array([np.subtract(e[name], e["close"][name]) for e in pairs])
            self._adds[name] = np.asarray(np.linalg.lstsq(basis, (more.T / lam).T)[0])

    @staticmethod
    def _basis(points: _Floats) -> _Floats:
        _, L, kappa = points.T
        return np.column_stack([np.ones_like(L), np.log(kappa), np.log(kappa) ** 2, L])

    def adds(self, name: str, points: _Floats) -> _Floats:
        """Correction of an answer at every point; 0 if too few points determine it."""
        if name not in self._adds:
            return np.zeros(1)
        return np.asarray(((self._basis(points) @ self._adds[name]).T * _lambda(points)).T)


def _lambda(points: _Floats) -> _Floats:
    return np.array([MoesPoint(*row).lam for row in points.tolist()])


def _column(entries: Sequence[Entry], *names: str) -> _Floats:
    return np.array([[e[name] for name in names] for e in entries])


def _is_near(entry: Entry) -> bool:
    """Whether an entry was solved on the near region."""
    return Domain(*entry["domain"]) == Domain.near()
