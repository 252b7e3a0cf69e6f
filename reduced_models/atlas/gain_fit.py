"""Gains of the film memory from K and C over frequency: least squares with gains >= 0."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from reduced_models.elements.film_response import DRY, WEIGHT_C, WEIGHT_K, FilterRates

_Floats = NDArray[np.float64]

HIGHEST = 32.0  # frequency up to which the film memory is fitted
FLOOR = 0.05  # share of the low-frequency damping below which errors of C count absolutely
RIDGE = 0.02  # keeps gains small and smooth over the points where data leave them open


def smooth_gains(
    omega: _Floats, K: _Floats, C: _Floats, rates: FilterRates, low: float, floor: float = FLOOR
) -> _Floats:
    """Gains over `low`, the damping of a flooded isothermal film at low frequency."""
    rows, target = gain_equations(omega, K, C, rates, low, floor)
    return np.asarray(scipy.optimize.nnls(rows, target, maxiter=1000)[0])


def gain_equations(
    omega: _Floats, K: _Floats, C: _Floats, rates: FilterRates, low: float, floor: float = FLOOR
) -> tuple[_Floats, _Floats]:
    """Matrix and right-hand side of `smooth_gains`: rows for C, for K, and for the size of the gains."""
    used = omega <= HIGHEST
    basis = rates.basis(omega[used]) * DRY
    size = np.maximum(np.abs(C[used]), floor * low) * WEIGHT_C
    rows = np.vstack(
        [
            basis.real / size[:, None],
            -(omega[used][:, None] * basis.imag) / (WEIGHT_K * K[used])[:, None],
            np.eye(basis.shape[1]) * (RIDGE / low),
        ]
    )
    target = np.concatenate([C[used] / size, (K[used] - K[0]) / (WEIGHT_K * K[used]), np.zeros(basis.shape[1])])
    return rows * low, target
