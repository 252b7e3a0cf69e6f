"""Multilevel multi-integration of the deflection, after Brandt and Lubrecht (1990).

Away from its singularity the kernel is smooth, so a coarse sum, transferred by interpolation of sixth order
from source to coarse source and from coarse node to node, is accurate there; near it the difference

    D(lag) = K(lag) - sum_q w_q K(lag + q),   q = -5, -3, -1, 1, 3, 5 fine steps of the coarsened direction

is added by direct summation. With the fine pressure F and the lifted pressure F* (coarse values on even nodes,
fine ones on odd nodes) one coarsening reads, exactly if D were not cut off,

    W(even) = W_coarse + sum over odd lags of D F*,   W(odd) = sum_q w_q W_coarse + sum over all lags of D F*.

One direction is coarsened at a time, that of the smaller physical step (kappa hx along X, hy along Y): steps
stay alike whatever kappa, and the neighbourhood of D, an ellipse in lags, sqrt((kappa di hx)^2 + (dj hy)^2)
below m steps of the coarsened direction, stays small. The coarse kernel is the fine one at coarse lags.
Venner and Lubrecht (2000), ch. 5, coarsen both directions at once.

Symmetry line: values at Y < 0 are those at Y > 0, taken by reflected index. Borders: pressure is zero outside,
and coarse grids extend up to four nodes beyond the border, where the transposed interpolation puts pressure.
So interpolation is central everywhere and D depends on lag alone, which one-sided interpolation would spoil.
"""

from __future__ import annotations

from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact._kernels import mlmi as kernels
from ehlcontact.elastic import influence_coefficients, injected_coefficients

Array = NDArray[np.float64]

REACH = 5  # of the interpolation, in fine nodes
FEWEST = 8  # intervals of the coarsest grid in either direction, at least
WEIGHTS = {1: kernels.W1, 3: kernels.W3, 5: kernels.W5}


class Grid(NamedTuple):
    """Grid of one level: steps in fine steps, intervals, nodes beyond the border, by direction (Y, X)."""

    step: tuple[int, int]
    intervals: tuple[int, int]
    halo: tuple[int, int]

    @property
    def shape(self) -> tuple[int, int]:
        """Nodes stored: the halo lies on one side along Y, on both along X."""
        return self.intervals[0] + self.halo[0] + 1, self.intervals[1] + 2 * self.halo[1] + 1

    def coarsen(self, axis: int) -> Grid:
        """Grid with every other node along `axis`; its halo holds the reach of the interpolation."""

        def changed(values: tuple[int, int], value: int) -> tuple[int, int]:
            return (value, values[1]) if axis == 0 else (values[0], value)

        return Grid(
            changed(self.step, 2 * self.step[axis]),
            changed(self.intervals, self.intervals[axis] // 2),
            changed(self.halo, 2 if self.halo[axis] == 0 else 4),
        )


class Mlmi:
    """Deflection by multilevel multi-integration on a half domain of (ny + 1) x (nx + 1) nodes.

    The call works in arrays of the instance and allocates the result only, so an instance serves one thread
    at a time.

    Parameters
    ----------
    nx, ny : int
        Intervals along X and along Y >= 0.
    hx, hy : float
        Mesh sizes.
    kappa : float
        Ellipse ratio a/b.
    radius : float, optional
        Neighbourhood m of the corrections in steps of the coarsened direction; by default it grows with the
        number of levels, so that the error falls with the discretisation error.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float, radius: float | None = None) -> None:
        self.nx, self.ny = nx, ny
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        self.radius = default_radius(nx) if radius is None else radius
        h = (hy, kappa * hx)
        coarsest_nodes = 2.0 * np.sqrt((nx + 1) * (ny + 1))
        grid = Grid((1, 1), (ny, nx), (0, 0))
        self._steps: list[_Step] = []
        while grid.intervals[0] * grid.intervals[1] > coarsest_nodes:
            axis = _coarsened_direction(grid, h)
            if axis is None:
                break
            K = _Kernel(hx, hy, kappa, grid.step)
            coarse = grid.coarsen(axis)
            self._steps.append(_Step(grid, coarse, axis, K.correction(grid, axis, self.radius)))
            grid = coarse
        rows, columns = grid.shape
        self._P, self._W, self._row = np.zeros(grid.shape), np.zeros(grid.shape), np.zeros(2 * columns - 1)
        self._K = _Kernel(hx, hy, kappa, grid.step)(np.arange(2 * rows - 1), np.arange(columns))

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        for step in self._steps:
            step.fine_P[...] = P
            kernels.lift(step.arrays)
            P = step.coarse_P
        self._P[...] = P
        kernels.direct_sum(self._P, self._K, self._row, self._W)
        W = self._W
        for step in reversed(self._steps):
            step.coarse_W[...] = W
            kernels.integrate(step.arrays)
            W = step.fine_W
        return np.array(W, order="C")


def default_radius(n: int) -> float:
    """Neighbourhood m of the corrections for n intervals."""
    return 3.0 + 2.0 * log(n)


def _coarsened_direction(grid: Grid, h: tuple[float, float]) -> int | None:
    """Direction of the smaller physical step that can be halved; None at the coarsest grid."""
    possible = [d for d in (0, 1) if grid.intervals[d] % 2 == 0 and grid.intervals[d] // 2 >= FEWEST]
    return min(possible, key=lambda d: h[d] * grid.step[d], default=None)


class _Kernel:
    """Fine influence coefficients at the lags of one level, and their correction kernels."""

    def __init__(self, hx: float, hy: float, kappa: float, step: tuple[int, int]) -> None:
        self.h, self.kappa, self.step = (hy, hx), kappa, step

    def __call__(self, k: Array, i: Array) -> Array:
        """Coefficients at lags `k` along Y and `i` along X in steps of the level."""
        (sy, sx), (hy, hx) = self.step, self.h
        return injected_coefficients(sy * k, sx * i, hx, hy, self.kappa)

    def correction(self, grid: Grid, axis: int, radius: float) -> tuple[Array, NDArray[np.int64]]:
        """D and the widths of its rows, lags along `axis` down the rows."""
        steps = (self.h[0] * self.step[0], self.kappa * self.h[1] * self.step[1])
        along, across = steps[axis], steps[1 - axis]
        k = np.arange(int(radius) + 1)
        k = k[: 2 * (grid.shape[axis] + 2 * REACH)]
        chord = np.sqrt(np.maximum((radius * along) ** 2 - (k * along) ** 2, 0.0))
        width = np.minimum(chord // across + 1, 2 * (grid.shape[1 - axis] + REACH)).astype(np.int64)
        row, column = np.arange(k.size + REACH), np.arange(width.max())
        K = self(row, column) if axis == 0 else self(column, row).T
        D = K[k].copy()
        for q, weight in WEIGHTS.items():
            D -= weight * (K[k + q] + K[np.abs(k - q)])
        D[np.arange(D.shape[1])[None, :] >= width[:, None]] = 0.0
        return np.ascontiguousarray(D), width


class _Step:
    """Arrays of one coarsening and their views in the natural order (Y, X)."""

    def __init__(self, grid: Grid, coarse: Grid, axis: int, correction: tuple[Array, NDArray[np.int64]]) -> None:
        D, width = correction
        across = 1 - axis
        mirrored = 1 if axis == 0 else 2
        rows, columns = grid.shape[axis], grid.shape[across]
        first = 0 if axis == 0 else -grid.halo[1]  # nodes at Y < 0 are not stored
        first_coarse = 0 if axis == 0 else -coarse.halo[1]
        last = first + rows - 1
        last_coarse = first_coarse + coarse.shape[axis] - 1
        reach = max(D.shape[0], REACH)
        margin = D.shape[1] - 1
        origin = max(reach - first, reach - 2 * first_coarse)
        end = max(last + reach, 2 * last_coarse + reach) + origin
        F = np.zeros((end + 1, columns + 2 * margin))
        self.arrays = kernels.Coarsening(
            F=F,
            D=D,
            width=width,
            coarse_W=np.zeros((coarse.shape[axis], columns)),
            W=np.zeros((rows, columns)),
            line=np.zeros(F.shape[1]),
            origin=origin,
            margin=margin,
            first=first,
            first_coarse=first_coarse,
            mirrored=mirrored,
        )
        nodes = slice(margin, margin + columns)
        top = origin + 2 * first_coarse
        views = (
            F[origin + first : origin + last + 1, nodes],
            F[top : top + 2 * coarse.shape[axis] : 2, nodes],
            self.arrays.W,
            self.arrays.coarse_W,
        )
        self.fine_P, self.coarse_P, self.fine_W, self.coarse_W = views if axis == 0 else (v.T for v in views)
