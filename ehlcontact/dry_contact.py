"""`ElasticContact`: force of a dry elastic contact over heights along its track, at fixed approach.

At the approach 1 in Hertz' units (X = x/a, Y = y/b, dry approaches), with a height h(X) of the surfaces, the
pressure P >= 0 leaves no gap where it acts:

    S X^2 + (1 - S) Y^2 - 1 - h(X) + 1/(pi K) iint P dX'dY'/sqrt(kappa^2 (X - X')^2 + (Y - Y')^2) >= 0

on cells of constant pressure, by conjugate gradients with the constraint (Polonsky and Keer, Wear 231, 1999).
"""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from ehlcontact.hertz import shape_factor
from ehlcontact.solver.deflection.coefficients import influence_coefficients

_Floats = NDArray[np.float64]

ALONG, ACROSS = 46, 6  # cells along the track, and across from its middle, over where bodies without load overlap
PRESSED, MOST_STEPS = 1e-4, 200  # convergence of the pressure, over its largest value; steps


class ElasticContact:
    """Dry elastic contact on a grid of cells.

    Parameters
    ----------
    kappa : float
        a/b.

    Attributes
    ----------
    edges : ndarray, shape (m + 1,)
        Of the cells along the track, in semi-axes a.
    first_order : ndarray, shape (m,)
        Approach of smooth surfaces with the force of small heights over the cells, by each of these heights.
    """

    def __init__(self, kappa: float) -> None:
        S = shape_factor(kappa)
        hx, hy = 2.0 / sqrt(S) / ALONG, 1.0 / sqrt(1.0 - S) / ACROSS
        i, j = np.arange(ALONG), np.arange(ACROSS)
        self.edges = np.asarray(hx * (np.arange(ALONG + 1) - 0.5 * ALONG), np.float64)
        gap = S * (hx * (i - 0.5 * (ALONG - 1))) ** 2 + (1.0 - S) * (hy * (j[:, None] + 0.5)) ** 2 - 1.0
        lags = influence_coefficients(ALONG, 2 * ACROSS, hx, hy, kappa)
        cells = lags[np.abs(j[:, None] - j)] + lags[j[:, None] + j + 1]  # and the mirrored one
        self._gap, self._count = gap.ravel(), gap.size
        self._bend = cells[..., np.abs(i[:, None] - i)].transpose(0, 2, 1, 3).reshape(gap.size, gap.size)
        P = self._pressures(np.zeros((1, ALONG)))[0]
        self._smooth, on = P.sum(), P > 0.0
        change = np.zeros_like(P)
        change[on] = np.linalg.solve(self._bend[np.ix_(on, on)], np.ones(on.sum()))
        self.first_order = change.reshape(ACROSS, ALONG).sum(axis=0) / (1.5 * self._smooth)  # of H, by heights

    def force(self, heights: _Floats) -> _Floats:
        """Force over that of smooth surfaces, shape (n,), by heights over the cells along the track, (n, m)."""
        return np.asarray(self._pressures(heights).sum(axis=1) / self._smooth)

    def _pressures(self, heights: _Floats) -> _Floats:
        free = self._gap - np.tile(heights, ACROSS)
        P, way = np.sqrt(np.maximum(-free, 0.0)), np.zeros_like(free)
        before, conjugate = np.ones(len(P)), np.zeros(len(P))
        for _ in range(MOST_STEPS):
            gap, on = free + P @ self._bend, P > 0.0
            squares = np.einsum("ij,ij,ij->i", gap, gap, on)
            way = np.where(on, gap + (conjugate * squares / before)[:, None] * way, 0.0)
            bent = np.einsum("ij,ij->i", way @ self._bend, way)
            step = np.einsum("ij,ij->i", gap, way) / np.where(bent > 0.0, bent, 1.0)
            last, P = P, np.maximum(P - step[:, None] * way, 0.0)
            pressed = (P == 0.0) & (gap < 0.0)
            P = np.where(pressed, -step[:, None] * gap, P)
            before, conjugate = np.where(squares > 0.0, squares, 1.0), np.where(pressed.any(axis=1), 0.0, 1.0)
            if (np.abs(P - last).max(axis=1) <= PRESSED * P.max(axis=1)).all():
                break
        return P


@lru_cache(maxsize=8)
def elastic_contact(kappa: float) -> ElasticContact:
    """The contact of an ellipse ratio, made once."""
    return ElasticContact(kappa)
