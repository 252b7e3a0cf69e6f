"""Gains of the film memory from K and C over frequency, flooded, with heat or under an oil supply.

Least squares with gains >= 0.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from reduced_models.elements.film_response import DRY, WEIGHT_C, WEIGHT_K, FilterRates

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

HIGHEST = 32.0  # frequency up to which the film memory is fitted
FLOOR = 0.05  # share of the low-frequency damping below which errors of C count absolutely
RIDGE = 0.02  # keeps gains small and smooth over the points where data leave them open
SLOW, SLOW_WEIGHT = 0.3, 10.0  # with heat: frequency up to which C counts so many times, that of rotors and shafts
FADED = 4  # power of what is left of damping, by which what is beside the answers fades


def smooth_gains(
    omega: _Floats, K: _Floats, C: _Floats, rates: FilterRates, low: float, floor: float = FLOOR
) -> _Floats:
    """Gains over `low`, the damping of a flooded isothermal film at low frequency."""
    rows, target = gain_equations(omega, K, C, rates, low, floor)
    return np.asarray(scipy.optimize.nnls(rows, target, maxiter=1000)[0])


def fitted_gains(
    omega: _Floats, K: _Floats, C: _Floats, rates: FilterRates, low: _Floats, faint: float
) -> _Floats:
    """Gains of many answers, K and C of shape (n, k), over their `low`, shape (n,).

    Errors of C below `faint` times its largest, or a small share of `low`, count absolutely.
    """
    floors = [max(FLOOR, faint * float(c.max()) / unit) for c, unit in zip(C, low.tolist(), strict=True)]
    rows = zip(K, C, low.tolist(), floors, strict=True)
    return np.array([smooth_gains(omega, k, c, rates, unit, floor) for k, c, unit, floor in rows])


def heated_gains(
    omega: _Floats, cold: _Complex, hot: _Complex, gains: _Floats, rates: FilterRates, low: float
) -> _Floats:
    """Gains with heat, over `low`: fitted to the answer with heat and what `gains` are beside the isothermal one.

    Of the latter the fourth power of what heat leaves of the low-frequency damping is taken: so heat that changes
    nothing leaves `gains` as they are, and strong heat leaves their errors behind.

    Parameters
    ----------
    omega : ndarray, shape (k,)
        From 0.
    cold, hot : ndarray, shape (k,)
        K + i C of the answers without and with heat.
    gains : ndarray, shape (3 + lags,)
        Of the isothermal element, over `low`.
    rates : FilterRates
    low : float
        Damping of the isothermal answer at low frequency.
    """
    left = min(max(hot.imag[0] / cold.imag[0], 0.0), 1.0) ** FADED
    G = rates.basis(omega) @ gains * (DRY * low)
    K = hot.real + left * (cold.real[0] - omega * G.imag - cold.real)
    C = hot.imag + left * (G.real - cold.imag)
    rows, target = gain_equations(omega, K, C, rates, low, slow=SLOW_WEIGHT)
    target[-gains.size :] = RIDGE * left * gains
    return np.asarray(scipy.optimize.nnls(rows, target, maxiter=1000)[0])


def gain_equations(
    omega: _Floats,
    K: _Floats,
    C: _Floats,
    rates: FilterRates,
    low: float,
    floor: float = FLOOR,
    slow: float = 1.0,
) -> tuple[_Floats, _Floats]:
    """Matrix and right-hand side of `smooth_gains`: rows for C, for K, and for the size of the gains.

    C up to `SLOW` has the weight `slow`.
    """
    used = omega <= HIGHEST
    basis = rates.basis(omega[used]) * DRY
    size = np.maximum(np.abs(C[used]), floor * low) * WEIGHT_C / np.where(omega[used] <= SLOW, slow, 1.0)
    rows = np.vstack(
        [
            basis.real / size[:, None],
            -(omega[used][:, None] * basis.imag) / (WEIGHT_K * K[used])[:, None],
            np.eye(basis.shape[1]) * (RIDGE / low),
        ]
    )
    target = np.concatenate([C[used] / size, (K[used] - K[0]) / (WEIGHT_K * K[used]), np.zeros(basis.shape[1])])
    return rows * low, target
