"""Interpolation over the atlas: smooth variables, radial basis functions, and the error bar.

What is interpolated, per point: ln of 1 - u, of Hc and of C at the lowest frequency > 0, each over a published
central film; ln(Hm/Hc); ln K at each frequency; asinh of every C over a small share of that one (C may touch 0).

As coordinates serve Wijnant's load number N, which separates rigid from elastic films, L^(2/3), kappa, and how far
N lies below 3: there the default domain starts to grow, and answers have a kink in the first three coordinates but
none in all four.

Every number of it is one of the atlas's `Interpolation`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from scipy.spatial.distance import cdist

from ehlcontact.hertz import radius_ratio
from ehlcontact.point import MoesPoint
from reduced_models.atlas.table import AtlasTable, Interpolation

_Floats = NDArray[np.float64]


def coordinates(points: _Floats, by: Interpolation) -> _Floats:
    """Coordinates, shape (n, 4), of rows (M, L, kappa)."""
    M, L, kappa = points.T
    log_load = np.log(M) + 0.5 * np.log([radius_ratio(k) for k in kappa.tolist()])
    light = np.maximum(math.log(by.light_load) - log_load, 0.0)
    return np.column_stack([log_load, L ** (2.0 / 3.0), np.log(kappa), light]) * np.array(by.weights)


def leading_film(points: _Floats, by: Interpolation) -> _Floats:
    """Published central film in Hertz units, bounded where the film is thick; shape (n, 1)."""
    film = [MoesPoint(*row).expected_film for row in points.tolist()]
    return np.array([[h / (by.thick + h)] for h in film])


def to_smooth(
    points: _Floats,
    approach: _Floats,
    h_central: _Floats,
    h_min: _Floats,
    K: _Floats,
    C: _Floats,
    by: Interpolation,
) -> _Floats:
    """Smooth variables, shape (n, 4 + 2 k)."""
    low, expected = C[:, by.reference], leading_film(points, by)[:, 0]
    films = [np.log(part / expected) for part in (1.0 - approach, h_central)]
    films += [np.log(h_min / h_central), np.log(low / expected)]
    return np.column_stack([*films, np.log(K), np.arcsinh(C / (by.asinh * low[:, None]))])


def from_smooth(points: _Floats, t: _Floats, by: Interpolation) -> tuple[_Floats, _Floats]:
    """Answers u, Hc, Hm, C_low, K (k), C (k) of rows of smooth variables; and their derivatives to these."""
    k, expected = (t.shape[1] - 4) // 2, leading_film(points, by)
    film, h, low = (expected * np.exp(t[:, [i]]) for i in (0, 1, 3))
    least, K = h * np.exp(t[:, [2]]), np.exp(t[:, 4 : 4 + k])
    C = by.asinh * low * np.sinh(t[:, 4 + k :])
    slopes = np.column_stack([film, h, least, low, K, by.asinh * low * np.cosh(t[:, 4 + k :])])
    return np.column_stack([1.0 - film, h, least, low, K, C]), slopes


def left_out_errors(x: _Floats, t: _Floats) -> _Floats:
    """Error at every node of the interpolation without it, from one inverse (Rippa 1999)."""
    n = len(x)
    polynomial = np.column_stack([np.ones(n), x])
    system = np.block(
        [[cdist(x, x) ** 3, polynomial], [polynomial.T, np.zeros((polynomial.shape[1], polynomial.shape[1]))]]
    )
    inverse = np.linalg.inv(system)
    return (inverse[:n, :n] @ t) / np.diag(inverse)[:n, None]


def error_factor(x: _Floats, errors: _Floats, by: Interpolation) -> _Floats:
    """Factor on the local error with which a share of the nodes lies within, judged by their neighbours alone."""
    distance = cdist(x, x)
    np.fill_diagonal(distance, np.inf)
    nearest = np.argpartition(distance, by.nearest, axis=1)[:, : by.nearest]
    local = np.sqrt(np.mean(errors[nearest] ** 2, axis=1))
    return np.quantile(np.abs(errors) / local, by.covered, axis=0)


class AtlasSurface:
    """The table as a function."""

    def __init__(self, table: AtlasTable) -> None:
        by = self._by = table.interpolation
        self._x = coordinates(table.points, by)
        films = table.approach, table.h_central, table.h_min
        smooth = to_smooth(table.points, *films, table.stiffness, table.damping, by)
        self._smooth = smooth.shape[1]
        values = np.hstack([smooth, table.gains])
        self._interpolant = RBFInterpolator(self._x, values, kernel=by.kernel, degree=by.degree)
        self._squares, self._factor = table.left_out**2, table.factor
        reach = np.partition(cdist(self._x, self._x), by.nearest, axis=1)[:, by.nearest]
        self._usual_reach = float(np.median(reach))

    def at(self, points: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Answers as by `from_smooth`, their slopes, and gains over the low-frequency damping."""
        found = self._interpolant(coordinates(points, self._by))
        return *from_smooth(points, found[:, : self._smooth], self._by), found[:, self._smooth :]

    def bars(self, point: _Floats, values: _Floats, slopes: _Floats, extra: _Floats) -> _Floats:
        """Half widths of the error bars of the answers at one point, each shape (4 + 2 k,); `point` is (3,).

        Where points lie far apart the bars grow with the square of their distance. `extra` adds to the bars of the
        smooth variables.
        """
        distance = cdist(coordinates(point[None], self._by), self._x)[0]
        nearest = np.argpartition(distance, self._by.nearest)[: self._by.nearest]
        sparse = max(distance[nearest].max() / self._usual_reach, 1.0) ** 2
        smooth = sparse * self._factor * np.sqrt(np.mean(self._squares[nearest], axis=0)) + extra
        bars = slopes * smooth
        damping = slice(4 + (bars.size - 4) // 2, None)  # over the low-frequency one, whose error comes on top
        bars[damping] = np.hypot(bars[damping], values[damping] * smooth[3])
        return np.asarray(bars)
