"""Elastic deflection of the two half spaces: a discrete convolution of the pressure (eq. 3, last term).

Pressure is piecewise constant on the cells around the nodes, and the kernel is integrated over a cell exactly
(Love 1929), as in Venner and Lubrecht (2000), app. A. The sum is evaluated by zero-padded fast transforms,
exact to rounding. Fields are even in Y and hold Y >= 0 only, so a cosine transform serves that direction and
half the work is saved.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from ehlcontact.hertz import elliptic_integrals

Array = NDArray[np.float64]

FFT_WORKERS = 2


def influence_coefficients(nx: int, ny: int, hx: float, hy: float, kappa: float) -> Array:
    """Deflection at lag (l, k) from unit pressure on one cell, shape (ny, nx) for lags 0..ny-1, 0..nx-1."""
    K, _ = elliptic_integrals(kappa)
    x = kappa * hx * (np.arange(nx + 1) - 0.5)[None, :]
    y = hy * (np.arange(ny + 1) - 0.5)[:, None]
    primitive = x * np.arcsinh(y / abs(x)) + y * np.arcsinh(x / abs(y))
    return np.diff(np.diff(primitive, axis=0), axis=1) / (pi * K * kappa)


class Deflection:
    """Convolution with the influence coefficients on a half domain of (ny + 1) x (nx + 1) nodes.

    Parameters
    ----------
    nx, ny : int
        Intervals along X and along Y >= 0.
    hx, hy : float
        Mesh sizes.
    kappa : float
        Ellipse ratio a/b.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float) -> None:
        self.nx, self.ny = nx, ny
        # Even sequences of period 4 ny and 2 nx: both zero paddings that keep images out of the domain,
        # because pressure vanishes on the boundary nodes.
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        self._spectrum = fft.dctn(self.kernel, type=1) / (4 * ny)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer boundary nodes."""
        nx, ny = self.nx, self.ny
        spectrum = fft.rfft(fft.dct(P, 1, 2 * ny + 1, axis=0, workers=FFT_WORKERS), 2 * nx, axis=1,
                            workers=FFT_WORKERS, overwrite_x=True)
        spectrum *= self._spectrum
        rows = fft.irfft(spectrum, 2 * nx, axis=1, workers=FFT_WORKERS, overwrite_x=True)[:, : nx + 1]
        return np.ascontiguousarray(fft.dct(rows, 1, axis=0, workers=FFT_WORKERS)[: ny + 1])
