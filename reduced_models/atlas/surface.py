"""Interpolation over the atlas: smooth variables, radial basis functions, and the error bar.

What is interpolated, per point: ln of 1 - u, of Hc and of C at the lowest frequency > 0, each over a published
central film; ln(Hm/Hc); ln K at each frequency; asinh of every C over a small share of that one (C may touch 0).

As coordinates serve Wijnant's load number N, which separates rigid from elastic films, L^(2/3), kappa, and how far
N lies below 3: there the default domain starts to grow, and answers have a kink in the first three coordinates but
none in all four.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from scipy.spatial.distance import cdist

from ehlcontact.hertz import radius_ratio
from ehlcontact.point import MoesPoint
from reduced_models.atlas.table import AtlasTable

_Floats = NDArray[np.float64]

# Weights of the coordinates, by leave-one-out error.
WEIGHTS = np.array([0.4, 0.114, 0.22, 1.2])
KERNEL, DEGREE = "cubic", 1
LIGHT_LOAD = 3.0  # load number below which the default domain grows, at the time of the build
NEAREST = 10  # points whose errors make the error bar
COVERED = 0.98  # share of points that the error bar covers when each is left out
THICK = 0.1  # film, in dry approaches, beyond which the published one no longer leads
ASINH = 0.02  # of the low-frequency damping: where asinh turns from ln to linear
REFERENCE = 1  # index of the frequency of the low-frequency damping


def coordinates(points: _Floats) -> _Floats:
    """Coordinates, shape (n, 4), of rows (M, L, kappa)."""
    M, L, kappa = points.T
    log_load = np.log(M) + 0.5 * np.log([radius_ratio(k) for k in kappa.tolist()])
    light = np.maximum(math.log(LIGHT_LOAD) - log_load, 0.0)
    return np.column_stack([log_load, L ** (2.0 / 3.0), np.log(kappa), light]) * WEIGHTS


def expected_film(points: _Floats) -> _Floats:
    """Published central film in Hertz units, bounded where the film is thick; shape (n, 1)."""
    film = [MoesPoint(*row).expected_film for row in points.tolist()]
    return np.array([[h / (THICK + h)] for h in film])


def to_smooth(
    points: _Floats, approach: _Floats, h_central: _Floats, h_min: _Floats, K: _Floats, C: _Floats
) -> _Floats:
    """Smooth variables, shape (n, 4 + 2 k)."""
    low, expected = C[:, REFERENCE], expected_film(points)[:, 0]
    films = [np.log(part / expected) for part in (1.0 - approach, h_central)]
    films += [np.log(h_min / h_central), np.log(low / expected)]
    return np.column_stack([*films, np.log(K), np.arcsinh(C / (ASINH * low[:, None]))])


def from_smooth(points: _Floats, t: _Floats) -> tuple[_Floats, _Floats]:
    """Answers u, Hc, Hm, C_low, K (k), C (k) of rows of smooth variables; and their derivatives to these."""
    k, expected = (t.shape[1] - 4) // 2, expected_film(points)
    film, h, low = (expected * np.exp(t[:, [i]]) for i in (0, 1, 3))
    least, K = h * np.exp(t[:, [2]]), np.exp(t[:, 4 : 4 + k])
    C = ASINH * low * np.sinh(t[:, 4 + k :])
    slopes = np.column_stack([film, h, least, low, K, ASINH * low * np.cosh(t[:, 4 + k :])])
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


def error_factor(x: _Floats, errors: _Floats) -> _Floats:
    """Factor on the local error with which `COVERED` of the nodes lie within, judged by their neighbours alone."""
    distance = cdist(x, x)
    np.fill_diagonal(distance, np.inf)
    nearest = np.argpartition(distance, NEAREST, axis=1)[:, :NEAREST]
    local = np.sqrt(np.mean(errors[nearest] ** 2, axis=1))
    return np.quantile(np.abs(errors) / local, COVERED, axis=0)


class AtlasSurface:
    """The table as a function."""

    def __init__(self, table: AtlasTable) -> None:
        self._x = coordinates(table.points)
        smooth = to_smooth(
            table.points, table.approach, table.h_central, table.h_min, table.stiffness, table.damping
        )
        self._smooth = smooth.shape[1]
        self._interpolant = RBFInterpolator(
            self._x, np.hstack([smooth, table.gains]), kernel=KERNEL, degree=DEGREE
        )
        self._squares, self._factor = table.left_out**2, table.factor
        reach = np.partition(cdist(self._x, self._x), NEAREST, axis=1)[:, NEAREST]
        self._usual_reach = float(np.median(reach))

    def at(self, points: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Answers as by `from_smooth`, their slopes, and gains over the low-frequency damping."""
        found = self._interpolant(coordinates(points))
        return *from_smooth(points, found[:, : self._smooth]), found[:, self._smooth :]

    def bars(self, point: _Floats, values: _Floats, slopes: _Floats, extra: _Floats) -> _Floats:
        """Half widths of the error bars of the answers at one point, each shape (4 + 2 k,); `point` is (3,).

        Where points lie far apart the bars grow with the square of their distance. `extra` adds to the bars of the
        smooth variables.
        """
        distance = cdist(coordinates(point[None]), self._x)[0]
        nearest = np.argpartition(distance, NEAREST)[:NEAREST]
        sparse = max(distance[nearest].max() / self._usual_reach, 1.0) ** 2
        smooth = sparse * self._factor * np.sqrt(np.mean(self._squares[nearest], axis=0)) + extra
        bars = slopes * smooth
        damping = slice(
            4 + (bars.size - 4) // 2, None
        )  # given over the low-frequency one, whose error comes on top
        bars[damping] = np.hypot(bars[damping], values[damping] * smooth[3])
        return np.asarray(bars)
