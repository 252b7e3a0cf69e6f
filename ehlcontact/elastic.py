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

THREADED_FROM = 256  # intervals along X; below, starting threads costs more than it saves
DENSE_UP_TO = 16  # intervals along X; below, a matrix product is faster than any transform


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
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        self._workers = 2 if nx >= THREADED_FROM else 1
        if nx <= DENSE_UP_TO:
            self._matrix = self._dense()
        else:
            # Even sequences of period 4 ny and 2 nx: zero padding that keeps images out of the domain,
            # because pressure vanishes on the border nodes.
            self._spectrum = fft.dctn(self.kernel, type=1) / (4 * ny)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        nx, ny = self.nx, self.ny
        if nx <= DENSE_UP_TO:
            return (self._matrix @ P.ravel()).reshape(P.shape)
        rows = fft.dct(P, 1, 2 * ny + 1, axis=0, workers=self._workers)
        spectrum = fft.rfft(rows, 2 * nx, axis=1, workers=self._workers)
        spectrum *= self._spectrum
        rows = fft.irfft(spectrum, 2 * nx, axis=1, workers=self._workers, overwrite_x=True)[:, : nx + 1]
        return fft.dct(rows, 1, axis=0, workers=self._workers)[: ny + 1]

    def _dense(self) -> Array:
        """Influence of every node on every node, images at Y < 0 included."""
        j, i = (index.ravel() for index in np.indices((self.ny + 1, self.nx + 1)))
        lag = np.abs(i[:, None] - i[None, :])
        matrix = self.kernel[np.abs(j[:, None] - j[None, :]), lag]
        image = self.kernel[np.minimum(j[:, None] + j[None, :], 2 * self.ny), lag]
        return matrix + np.where(j[None, :] > 0, image, 0.0)
