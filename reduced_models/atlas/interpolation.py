"""Interpolation of the atlas over M, L and kappa: radial basis functions on logarithms of its answers, error bars.

What is interpolated, per point: ln of 1 - u, of Hc, of C at the lowest frequency > 0 and of the moment, each over
a published central film; ln(Hm/Hc); ln K at each frequency; asinh of every C over a small share of that one (C may
touch 0).

As coordinates serve Wijnant's load number N, which separates rigid from elastic films, L^(2/3), kappa; how far N
lies below a light load, where the default domain grows with it (`formulas.lightness` is the rule of both); and the
published film. Three would do, but answers curve more sharply in them than in all five. Hm/Hc follows the side
lobes and bends elsewhere than the others: it has weights of its own, of the first four.

Every number of it is one of the atlas's `Interpolation`.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.film_formulas import expected_film, lightness
from ehlcontact.hertz import radius_ratio
from ehlcontact.process.blas import one_blas_thread
from reduced_models.atlas.table import HEAD, LOW, AtlasTable, Interpolation

_Floats = NDArray[np.float64]

LOBE = 2  # column of ln(Hm/Hc)
THICKEST = 3.0  # film 1 - u up to which K of another oil differs the more the thicker the film
BLOCK = 256  # points looked at together: their distances to all nodes stay in the cache


def films(points: _Floats) -> _Floats:
    """Published central film of rows (M, L, kappa) in dry approaches, shape (n,)."""
    return np.array([expected_film(*row) for row in points.tolist()])


def coordinates(points: _Floats, film: _Floats, by: Interpolation) -> tuple[_Floats, _Floats]:
    """Coordinates of rows (M, L, kappa) and their films: shape (n, 5), and for Hm/Hc (n, 4)."""
    M, L, kappa = points.T
    log_load = np.log(M) + 0.5 * np.log([radius_ratio(k) for k in kappa.tolist()])
    light = [lightness(N, by.light_load, by.light_blend) for N in log_load.tolist()]
    plain = np.column_stack([log_load, L ** (2.0 / 3.0), np.log(kappa), light, np.log(film)])
    return plain * np.array(by.weights), plain[:, :4] * np.array(by.lobe_weights)


def to_smooth(film: _Floats, answers: _Floats, by: Interpolation) -> _Floats:
    """Smooth variables of answers, both shape (n, 5 + 2 k) and in the order of `AtlasTable.answers`."""
    k = (answers.shape[1] - HEAD) // 2
    u, central, least, low, moment = answers[:, :HEAD].T
    expected = film / (by.thick + film)
    head = np.log([(1.0 - u) / expected, central / expected, least / central, low / expected, moment / expected])
    K, C = answers[:, HEAD : HEAD + k], answers[:, HEAD + k :]
    return np.column_stack([head.T, np.log(K), np.arcsinh(C / (by.asinh * low[:, None]))])


def from_smooth(film: _Floats, t: _Floats, by: Interpolation) -> tuple[_Floats, _Floats]:
    """Answers of rows of smooth variables; and their derivatives to these."""
    k = (t.shape[1] - HEAD) // 2
    grown = np.exp(t[:, : HEAD + k])
    grown[:, [0, 1, LOW, HEAD - 1]] *= (film / (by.thick + film))[:, None]
    grown[:, 2] *= grown[:, 1]
    scale = by.asinh * grown[:, [LOW]]
    C = scale * np.sinh(t[:, HEAD + k :])
    slopes = np.column_stack([grown, np.hypot(scale, C)])  # cosh from sinh
    grown[:, 0] = 1.0 - grown[:, 0]
    return np.column_stack([grown, C]), slopes


def _system(x: _Floats) -> _Floats:
    """Of cubic radial functions with a plane beside them."""
    n, plane = len(x), np.column_stack([np.ones(len(x)), x])
    corner = np.zeros((plane.shape[1], plane.shape[1]))
    return np.block([[scipy.spatial.distance.cdist(x, x) ** 3, plane], [plane.T, corner]]) if n else corner


def left_out_errors(x: _Floats, t: _Floats) -> _Floats:
    """Error at every node of the interpolation without it, from one inverse (Rippa 1999)."""
    n = len(x)
    inverse = np.linalg.inv(_system(x))
    return (inverse[:n, :n] @ t) / np.diag(inverse)[:n, None]


def judge(points: _Floats, answers: _Floats, by: Interpolation) -> tuple[_Floats, _Floats]:
    """Errors of all smooth variables at every point without it, shape (n, 5 + 2 k), and their `error_factor`."""
    film = films(points)
    smooth, (x, lobe) = to_smooth(film, answers, by), coordinates(points, film, by)
    errors = left_out_errors(x, smooth)
    errors[:, [LOBE]] = left_out_errors(lobe, smooth[:, [LOBE]])
    return errors, error_factor(x, errors, by.nearest, by.covered)


def error_factor(x: _Floats, errors: _Floats, nearest: int, covered: float) -> _Floats:
    """Factor on the local error that covers a given share of the nodes, each judged by its neighbours."""
    distance = scipy.spatial.distance.cdist(x, x)
    np.fill_diagonal(distance, np.inf)
    _, local = Neighbours(x, errors, nearest).at(distance)
    return np.quantile(np.abs(errors) / local, covered, axis=0)


class Neighbours:
    """The nearest nodes of a place, whose errors make its error bar.

    Attributes
    ----------
    usual_reach : float
        Median distance of the nodes from the farthest of their neighbours.
    """

    def __init__(self, x: _Floats, errors: _Floats, nearest: int) -> None:
        self._squares, self._nearest = errors**2, nearest
        reach = np.partition(scipy.spatial.distance.cdist(x, x), nearest, axis=1)[:, nearest]
        self.usual_reach = float(np.median(reach))

    def at(self, distance: _Floats) -> tuple[_Floats, _Floats]:
        """Growth of error bars, shape (n, 1), and root mean square of the errors, given distances from all nodes.

        Where nodes lie far apart the bars grow with the square of their distance.
        """
        nearest = np.argpartition(distance, self._nearest, axis=1)[:, : self._nearest]
        reach = np.take_along_axis(distance, nearest, axis=1).max(axis=1, keepdims=True)
        local = np.sqrt(np.mean(self._squares[nearest], axis=1))
        return np.maximum(reach / self.usual_reach, 1.0) ** 2, local


class Radial:
    """Cubic radial functions through `values`, shape (n, m), at the nodes `x`, with a plane beside them."""

    def __init__(self, x: _Floats, values: _Floats) -> None:
        self.x = x
        plane = np.zeros((1 + x.shape[1], values.shape[1]))
        self.coefficients = np.linalg.solve(_system(x), np.vstack([values, plane]))
        self.coefficients.setflags(write=False)  # one surface serves every `Atlas` of its file

    def at(self, x: _Floats, distance: _Floats, columns: slice = slice(None)) -> _Floats:
        """Some columns at places `x`, given their distances from the nodes."""
        n, c = len(self.x), self.coefficients[:, columns]
        return np.asarray((distance * distance * distance) @ c[:n] + c[n] + x @ c[n + 1 :])


class AtlasSurface:
    """The table as a function of rows (M, L, kappa)."""

    @one_blas_thread()
    def __init__(self, table: AtlasTable) -> None:
        by = self._by = table.interpolation
        film = films(table.points)
        x, lobe = coordinates(table.points, film, by)
        smooth = to_smooth(film, table.answers, by)
        self._smooth = smooth.shape[1]
        self._all, self._lobe = Radial(x, np.hstack([smooth, table.gains])), Radial(lobe, smooth[:, [LOBE]])
        self._neighbours, self._factor = Neighbours(x, table.left_out, by.nearest), table.factor

    @property
    def coefficients(self) -> tuple[_Floats, _Floats]:
        """Coefficients of the radial functions, for evaluation elsewhere (page of ``ehlcontact explore``).

        Shape (n + 6, 5 + 2 k + gains), and of ln(Hm/Hc), in coordinates of its own, (n + 5,): a row for every
        point, then the constant and the slopes of the plane.
        """
        return self._all.coefficients, self._lobe.coefficients[:, 0]

    @property
    def usual_reach(self) -> float:
        """Median distance of the points from the farthest of their neighbours that make the error bar."""
        return self._neighbours.usual_reach

    @one_blas_thread()
    def at(self, points: _Floats) -> tuple[_Floats, _Floats]:
        """Answers, shape (n, 5 + 2 k), and gains over the low-frequency damping."""
        film = films(points)
        found, _ = self._interpolated(points, film, slice(None))
        return from_smooth(film, found[:, : self._smooth], self._by)[0], found[:, self._smooth :]

    @one_blas_thread()
    def with_bars(self, points: _Floats, extra: _Floats) -> tuple[_Floats, _Floats]:
        """Answers and half widths of their error bars, both shape (n, 5 + 2 k).

        Where nodes lie far apart the bars grow with the square of their distance. `extra`, per unit of the film
        1 - u up to `THICKEST` for K, adds to the bars of the smooth variables; shape (5 + 2 k,).
        """
        blocks = [self._block(points[i : i + BLOCK], extra) for i in range(0, len(points), BLOCK)]
        values, bars = zip(*blocks, strict=True)
        return np.concatenate(values), np.concatenate(bars)

    def _block(self, points: _Floats, extra: _Floats) -> tuple[_Floats, _Floats]:
        by, film = self._by, films(points)
        found, distance = self._interpolated(points, film, slice(self._smooth))
        values, slopes = from_smooth(film, found, by)
        grown, local = self._neighbours.at(distance)
        smooth = grown * self._factor * local
        k = (values.shape[1] - HEAD) // 2
        stiffness, damping = slice(HEAD, HEAD + k), slice(HEAD + k, None)
        if extra.any():
            added = np.tile(extra, (len(points), 1))
            added[:, stiffness] *= np.minimum(1.0 - values[:, :1], THICKEST)
            smooth += added
        bars = slopes * smooth
        # over the low-frequency damping, whose error comes on top
        bars[:, damping] = np.hypot(bars[:, damping], values[:, damping] * smooth[:, [LOW]])
        return values, bars

    def _interpolated(self, points: _Floats, film: _Floats, columns: slice) -> tuple[_Floats, _Floats]:
        """Smooth variables and gains, and the distances from all nodes."""
        x, lobe = coordinates(points, film, self._by)
        distance = scipy.spatial.distance.cdist(x, self._all.x)
        found = self._all.at(x, distance, columns)
        found[:, [LOBE]] = self._lobe.at(lobe, scipy.spatial.distance.cdist(lobe, self._lobe.x))
        return found, distance
