"""From the entries of a build to the table of the atlas."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from ehlcontact import Domain, Mesh, MoesPoint
from ehlcontact.errors import InputError
from reduced_models.atlas.box import BOX
from reduced_models.atlas.solve import OMEGAS
from reduced_models.atlas.surface import REFERENCE, coordinates, error_factor, left_out_errors, to_smooth
from reduced_models.atlas.table import AtlasTable
from reduced_models.elements.film_response import DRY, WEIGHT_C, WEIGHT_K, FilterRates

_Floats = NDArray[np.float64]
Entry = Mapping[str, Any]

RATES = FilterRates(lags=14, lag_rate=5.3, inlet_rate=7.8, fast_rate=39.0)  # that fit all points best together
HIGHEST = 32.0  # frequency up to which the film memory is fitted
FLOOR = 0.05  # share of the low-frequency damping below which errors of C count absolutely
RIDGE = 0.02  # keeps gains small and smooth over the points where data leave them open
FEWEST = 20


def assemble(entries: Sequence[Entry], made_by: Mapping[str, Any]) -> AtlasTable:
    """Table of the converged entries; `made_by` goes into its metadata.

    Where the film is so thin that only the near domain was solved, what the oil further out adds to the damping
    and takes from the approach is learnt from the points that were solved on both: it is the coefficient lambda of
    the Reynolds equation times a smooth function of kappa and L, since there the gap is that of the dry contact.

    Raises
    ------
    InputError
        Too few converged.
    """
    good = [e for e in entries if e["status"] == "converged"]
    if len(good) < FEWEST:
        raise InputError("converged points", len(good), f"at least {FEWEST} (more draws)")
    omega = np.array(OMEGAS)
    points = _column(good, "M", "L", "kappa")
    films = [e.get("film", e) for e in good]
    approach, h_central, h_min = _column(films, "approach", "h_central", "h_min").T
    K, C = (np.array([e[name] for e in good]) for name in ("stiffness", "damping"))
    pairs = [e for e in good if e.get("close") is not None]
    far = _FarOil(pairs)
    near = np.array([_is_close(e) for e in good])
    if near.any():
        C[near] += far.damping(points[near])
        ends_near = np.array([_is_close(e) for e in films])
        approach[ends_near] += far.approach(points[ends_near])
    gains = np.array([smooth_gains(omega, k, c) for k, c in zip(K, C, strict=True)])
    law = MoesPoint(*points[0].tolist())
    x, t = coordinates(points), to_smooth(points, approach, h_central, h_min, K, C)
    errors = left_out_errors(x, t)
    metadata = {
        "box": BOX.to_dict(),
        "rates": asdict(RATES),
        "points": len(good),
        "left_out": dict(Counter(str(e["status"]) for e in entries if e["status"] != "converged")),
        "meshes": {f"{n} on {d}": c for (n, d), c in sorted(Counter(map(_mesh, good)).items())},
        "alpha": float(good[0]["alpha"]),
        "eta0": float(good[0]["eta0"]),
        "viscosity": law.viscosity,
        "density": law.density,
        "highest_omega": HIGHEST,
        **made_by,
    }
    return AtlasTable(
        points=points,
        omega=omega,
        approach=approach,
        h_central=h_central,
        h_min=h_min,
        stiffness=K,
        damping=C,
        gains=gains,
        left_out=errors,
        factor=error_factor(x, errors),
        metadata=metadata,
    )


def smooth_gains(omega: _Floats, K: _Floats, C: _Floats) -> _Floats:
    """Gains >= 0 of the film memory over the low-frequency damping, by least squares on C and K."""
    used, low = omega <= HIGHEST, C[REFERENCE]
    basis = RATES.basis(omega[used]) * DRY
    size = np.maximum(np.abs(C[used]), FLOOR * low) * WEIGHT_C
    rows = np.vstack(
        [
            basis.real / size[:, None],
            -(omega[used][:, None] * basis.imag) / (WEIGHT_K * K[used])[:, None],
            np.eye(basis.shape[1]) * (RIDGE / low),
        ]
    )
    target = np.concatenate([C[used] / size, (K[used] - K[0]) / (WEIGHT_K * K[used]), np.zeros(basis.shape[1])])
    return np.asarray(nnls(rows * low, target, maxiter=1000)[0])


class _FarOil:
    """What the default domain has more than the near one, over lambda: linear in ln kappa, its square, and L."""

    def __init__(self, pairs: Sequence[Entry]) -> None:
        self._damping: _Floats = np.zeros((4, len(OMEGAS)))
        self._approach: _Floats = np.zeros(4)
        if len(pairs) < FEWEST:
            return
        points = _column(pairs, "M", "L", "kappa")
        lam = _lambda(points)
        damping = np.array([np.subtract(e["damping"], e["close"]["damping"]) for e in pairs]) / lam[:, None]
        approach = np.array([e["approach"] - e["close"]["approach"] for e in pairs]) / lam
        basis = self._basis(points)
        self._damping = np.asarray(np.linalg.lstsq(basis, damping)[0])
        self._approach = np.asarray(np.linalg.lstsq(basis, approach)[0])

    @staticmethod
    def _basis(points: _Floats) -> _Floats:
        _, L, kappa = points.T
        return np.column_stack([np.ones_like(L), np.log(kappa), np.log(kappa) ** 2, L])

    def damping(self, points: _Floats) -> _Floats:
        return np.asarray(self._basis(points) @ self._damping * _lambda(points)[:, None])

    def approach(self, points: _Floats) -> _Floats:
        return np.asarray(self._basis(points) @ self._approach * _lambda(points))


def _lambda(points: _Floats) -> _Floats:
    return np.array([MoesPoint(*row).lam for row in points.tolist()])


def _column(entries: Sequence[Entry], *names: str) -> _Floats:
    return np.array([[e[name] for name in names] for e in entries])


def _is_close(entry: Entry) -> bool:
    return Mesh(int(entry["n"]), Domain(*entry["domain"])).near


def _mesh(entry: Entry) -> tuple[int, str]:
    return int(entry["n"]), "the near domain" if _is_close(entry) else "the default domain"
