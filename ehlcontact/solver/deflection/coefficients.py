"""Influence coefficients: the deflection by unit pressure on one cell, integrated exactly (Love 1929)."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.hertz import elliptic_integrals

Array = NDArray[np.float64]
Lags = NDArray[np.integer[Any]]


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
