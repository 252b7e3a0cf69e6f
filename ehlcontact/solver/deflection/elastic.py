"""Elastic deflection of the two half spaces: a discrete convolution of the pressure (eq. 3, last term).

Pressure is piecewise constant on the cells around the nodes, and the kernel is integrated over a cell exactly
(Love 1929), as in Venner and Lubrecht (2000), app. A. Fields are even in Y and hold Y >= 0 only. Three engines
evaluate the same sum; each is called as ``engine(P)`` and has ``nx``, ``ny`` and ``kernel``:

- `DirectSum`, term by term, O(N^2): the oracle of the tests;
- `FastFourier`, by zero-padded fast transforms, O(N log N) and exact to rounding: the default;
- `mlmi.Mlmi`, multilevel multi-integration, O(N log N) to below the discretisation error.
"""

from __future__ import annotations

from math import pi
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from ehlcontact.checks import require_choice
from ehlcontact.hertz import elliptic_integrals
from ehlcontact.solver.kernels import mlmi as kernels

Array = NDArray[np.float64]
Lags = NDArray[np.integer[Any]]

ENGINES = ("direct", "fft", "mlmi")
BLOCK = 2**15  # numbers transformed along X at a time
MATRICES_UP_TO = 64  # intervals along X, for `MatrixTransforms`; beyond, BLAS starts threads, and waits for them


class Engine(Protocol):
    """What the engines have in common."""

    nx: int
    ny: int
    kernel: Array  # influence coefficients, lags 0..2 ny along Y and 0..nx along X

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        ...


def deflection(nx: int, ny: int, hx: float, hy: float, kappa: float, engine: str = "fft") -> Engine:
    """Make an engine for a half domain of (ny + 1) x (nx + 1) nodes.

    Parameters
    ----------
    nx, ny : int
        Intervals along X and along Y >= 0.
    hx, hy : float
        Mesh sizes.
    kappa : float
        Ellipse ratio a/b.
    engine : {"fft", "direct", "mlmi"}
        Way of summing.

    Raises
    ------
    InputError
        No such engine.
    """
    if require_choice("engine", engine, ENGINES) == "mlmi":
        from ehlcontact.solver.deflection.mlmi import Mlmi

        return Mlmi(nx, ny, hx, hy, kappa)
    return (DirectSum if engine == "direct" else FastFourier)(nx, ny, hx, hy, kappa)


def influence_coefficients(nx: int, ny: int, hx: float, hy: float, kappa: float) -> Array:
    """Deflection at lag (l, k) from unit pressure on one cell, shape (ny, nx) for lags 0..ny-1, 0..nx-1."""
    x = kappa * hx * (np.arange(nx + 1) - 0.5)[None, :]
    y = hy * (np.arange(ny + 1) - 0.5)[:, None]
    return np.diff(np.diff(_primitive(x, y), axis=0), axis=1) / _scale(kappa)


def injected_coefficients(k: Lags, i: Lags, hx: float, hy: float, kappa: float) -> Array:
    """Influence coefficients at the lags `k` along Y and `i` along X only, shape (k.size, i.size)."""
    x = [kappa * hx * (i + side)[None, :] for side in (-0.5, 0.5)]
    y = [hy * (k + side)[:, None] for side in (-0.5, 0.5)]
    corners = _primitive(x[1], y[1]) - _primitive(x[0], y[1]) - _primitive(x[1], y[0]) + _primitive(x[0], y[0])
    return corners / _scale(kappa)


def _primitive(x: NDArray[np.floating[Any]], y: NDArray[np.floating[Any]]) -> Array:
    """Integral of 1/sqrt(x^2 + y^2) over [0, x] x [0, y]."""
    return x * np.arcsinh(y / abs(x)) + y * np.arcsinh(x / abs(y))


def _scale(kappa: float) -> float:
    """Factor of the integral in eq. 3, and of x = kappa X in its primitive."""
    K, _ = elliptic_integrals(kappa)
    return pi * K * kappa


class DirectSum:
    """The convolution term by term, images at Y < 0 included. Parameters as in `deflection`.

    One scratch row is kept: an instance serves one thread at a time.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float) -> None:
        self.nx, self.ny = nx, ny
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        self._row = np.zeros(2 * nx + 1)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1)."""
        W = np.empty((self.ny + 1, self.nx + 1))
        kernels.direct_sum(P, self.kernel, self._row, W)
        return W


class FastFourier:
    """The convolution by zero-padded transforms, on small grids written out as matrix products.

    Parameters as in `deflection`. Periods 4 ny and 2 nx keep images out of the domain, because pressure vanishes
    on the border nodes.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float) -> None:
        self.nx, self.ny = nx, ny
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        transforms = MatrixTransforms if nx <= MATRICES_UP_TO else FastTransforms
        self._transforms: MatrixTransforms | FastTransforms = transforms(self.kernel)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        return self._transforms(P)


class FastTransforms:
    """Convolution of even fields with `kernel`, shape (2 ny + 1, nx + 1), by fast transforms.

    Along Y the even, zero-padded sequence of period 4 ny needs a cosine transform of 2 ny + 1 numbers. As
    pressure fills only the first ny of them and deflection is wanted there only, its even frequencies are a
    cosine transform of ny + 1 numbers and its odd ones a shifted one of ny. Along X a block of rows at a time
    goes to frequencies and back, so that it stays in cache; that gains more than threads do.
    """

    def __init__(self, kernel: Array) -> None:
        self._ny, self._nx = kernel.shape[0] // 2, kernel.shape[1] - 1
        spectrum = fft.dctn(kernel, type=1) / (4 * self._ny)
        self._spectrum = np.concatenate([spectrum[::2], spectrum[1::2]])  # even frequencies first

    def __call__(self, P: Array) -> Array:
        """As `FastFourier`."""
        nx, ny = self._nx, self._ny
        rows = np.empty((2 * ny + 1, nx + 1))
        rows[: ny + 1] = fft.dct(P, 1, axis=0)
        rows[ny + 1 :] = fft.dct(P[:ny], 3, axis=0)
        height = max(1, BLOCK // nx)
        for first in range(0, 2 * ny + 1, height):
            block = slice(first, first + height)
            spectrum = fft.rfft(rows[block], 2 * nx, axis=1)
            spectrum *= self._spectrum[block]
            rows[block] = fft.irfft(spectrum, 2 * nx, axis=1, overwrite_x=True)[:, : nx + 1]
        W = fft.dct(rows[: ny + 1], 1, axis=0)
        W[:ny] += fft.dct(rows[ny + 1 :], 2, axis=0)  # zero at j = ny
        return W


class MatrixTransforms:
    """The same with transforms written out as matrices: on small grids the calls of fast ones cost more."""

    def __init__(self, kernel: Array) -> None:
        ny, nx = kernel.shape[0] // 2, kernel.shape[1] - 1
        spectrum = fft.dctn(kernel, type=1)
        phase = pi / (2 * ny) * np.outer(np.arange(2 * ny + 1), np.arange(ny + 1))
        share = np.where(np.arange(2 * ny + 1) % (2 * ny) == 0, 1.0, 2.0)  # of frequencies that stand for two
        self._across = np.cos(phase) * np.where(np.arange(ny + 1) == 0, 1.0, 2.0)
        self._back_across = np.ascontiguousarray((np.cos(phase) * share[:, None]).T) / (4 * ny)
        phase = pi / nx * np.outer(np.arange(nx + 1), np.arange(nx + 1))
        self._along = np.concatenate([np.cos(phase), np.sin(phase)], axis=1)
        share = np.where(np.arange(nx + 1) % nx == 0, 1.0, 2.0)
        self._back_along = np.ascontiguousarray(self._along.T) / (2 * nx)
        self._spectrum = np.concatenate([spectrum * share, spectrum * share], axis=1)

    def __call__(self, P: Array) -> Array:
        """As `FastFourier`."""
        return self._back_across @ (((self._across @ P @ self._along) * self._spectrum) @ self._back_along)


Deflection = FastFourier  # what the solver uses
