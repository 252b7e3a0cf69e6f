"""Multilevel multi-integration of the deflection, after Brandt and Lubrecht (1990).

Away from its singularity the kernel is smooth, so there a coarse sum serves, with interpolation of sixth order
in place of source nodes and of target nodes. Near it the difference

    D(lag) = K(lag) - sum_q w_q K(lag + q),   q = -5, -3, -1, 1, 3, 5 fine steps of the coarsened direction

is summed directly. With P the fine pressure on odd nodes and the coarse one on even nodes, one coarsening
reads, and would be exact if D were not cut off,

    W(even) = W_coarse + sum over odd lags of D P,   W(odd) = sum_q w_q W_coarse + sum over all lags of D P.

One direction is coarsened at a time, that of the smaller physical step (kappa hx along X, hy along Y). So steps
stay alike whatever kappa, and the neighbourhood of D, the ellipse of lags sqrt((kappa di hx)^2 + (dj hy)^2)
below m steps of the coarsened direction, stays small. The coarse kernel is the fine one at coarse lags.
Venner and Lubrecht (2000), ch. 5, where both directions are coarsened at once.

Symmetry line: values at Y < 0 are those at Y > 0, by reflected index. Borders: pressure is zero outside, and
coarse grids go on for up to four nodes beyond the border, where the transposed interpolation puts pressure.
So interpolation is central everywhere and D depends on the lag alone; one-sided interpolation would make it
depend on the node.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.process.threads import CALLING_THREAD
from ehlcontact.solver.deflection.coefficients import influence_coefficients, injected_coefficients
from ehlcontact.solver.kernels import mlmi as kernels

Array = NDArray[np.float64]
Pair = tuple[int, int]  # by direction: (Y, X)

REACH = 5  # of the interpolation, in fine nodes
WEIGHTS = {1: kernels.W1, 3: kernels.W3, 5: kernels.W5}
FEWEST = 8  # intervals of the coarsest grid in either direction, at least
# A level of step H, cut off at m H, errs by about H/m^6, and its cost grows as m^2 / H^2: the coarser, the wider.
COARSER_WIDER = 0.2


class Grid(NamedTuple):
    """Grid of one level."""

    step: Pair  # in steps of the finest grid
    intervals: Pair
    halo: Pair  # nodes beyond the border: on one side along Y, on both along X

    @property
    def shape(self) -> Pair:
        """Nodes stored."""
        return self.intervals[0] + self.halo[0] + 1, self.intervals[1] + 2 * self.halo[1] + 1

    @property
    def first(self) -> Pair:
        """First node stored: the symmetry line, and one at or before the inlet border."""
        return 0, -self.halo[1]

    def coarsen(self, axis: int) -> Grid:
        """Grid with every other node along `axis`, and a halo for the reach of the interpolation."""

        def changed(pair: Pair, value: int) -> Pair:
            return (value, pair[1]) if axis == 0 else (pair[0], value)

        return Grid(
            changed(self.step, 2 * self.step[axis]),
            changed(self.intervals, self.intervals[axis] // 2),
            changed(self.halo, 4 if self.halo[axis] else 2),
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
        Neighbourhood m of the corrections on the finest grid, in steps of the coarsened direction; coarser
        grids have wider ones. By default it grows with nx so that the error falls with the discretisation error.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float, radius: float | None = None) -> None:
        self.nx, self.ny = nx, ny
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        self.radius = 7.0 * (nx / 64.0) ** (1.0 / 6.0) if radius is None else radius
        physical = (hy, kappa * hx)
        grid = Grid((1, 1), (ny, nx), (0, 0))
        coarsest_nodes = 2.0 * np.sqrt((nx + 1) * (ny + 1))  # the direct sum of so many costs O(N)
        self._coarsenings: list[_Coarsening] = []
        while grid.intervals[0] * grid.intervals[1] > coarsest_nodes:
            possible = [d for d in (0, 1) if grid.intervals[d] % 2 == 0 and grid.intervals[d] >= 2 * FEWEST]
            if not possible:
                break
            steps = [physical[d] * grid.step[d] for d in (0, 1)]
            axis = min(possible, key=steps.__getitem__)
            wider = (steps[axis] / min(physical)) ** COARSER_WIDER
            correction = correction_kernel(grid, axis, self.radius * wider, (hx, hy, kappa))
            self._coarsenings.append(_Coarsening(grid, axis, correction))
            grid = grid.coarsen(axis)
        rows, columns = grid.shape
        self.team = CALLING_THREAD
        self._P, self._W, self._row = np.zeros(grid.shape), np.zeros(grid.shape), np.zeros(2 * columns - 1)
        lags = grid.step[0] * np.arange(2 * rows - 1), grid.step[1] * np.arange(columns)
        self._K = injected_coefficients(*lags, hx, hy, kappa)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1)."""
        for c in self._coarsenings:
            c.P[...] = P
            kernels.lift(c.arrays)
            P = c.coarse_P
        self._P[...] = P
        kernels.direct_sum(self._P, self._K, self._row, self._W)
        W = self._W
        for c in reversed(self._coarsenings):
            c.coarse_W[...] = W
            kernels.integrate(c.arrays)
            W = c.W
        return np.array(W, order="C")


def correction_kernel(
    grid: Grid, axis: int, radius: float, mesh: tuple[float, float, float]
) -> tuple[Array, NDArray[np.int64]]:
    """D by lag, down the rows along `axis`, and the number of lags of each row within the neighbourhood.

    Parameters
    ----------
    grid : Grid
        The finer grid.
    axis : int
        Direction coarsened.
    radius : float
        Neighbourhood in steps of `grid` along `axis`.
    mesh : tuple of float
        hx, hy, kappa.
    """
    hx, hy, kappa = mesh
    steps = (hy * grid.step[0], kappa * hx * grid.step[1])
    along, across = steps[axis], steps[1 - axis]
    # No lag is longer than twice a grid and what lies beyond its border.
    longest = [2 * (nodes + 2 * REACH) for nodes in grid.shape]
    k = np.arange(min(int(radius) + 1, longest[axis]))
    half_chord = along * np.sqrt(radius**2 - k**2)
    width = np.minimum(half_chord // across + 1, longest[1 - axis]).astype(np.int64)
    row, column = np.arange(k.size + REACH), np.arange(width.max() + 1)  # kernels take two columns at a time
    if axis == 0:
        K = injected_coefficients(grid.step[0] * row, grid.step[1] * column, hx, hy, kappa)
    else:
        K = injected_coefficients(grid.step[0] * column, grid.step[1] * row, hx, hy, kappa).T
    D = K[k] - sum(weight * (K[k + q] + K[abs(k - q)]) for q, weight in WEIGHTS.items())
    return np.where(column < width[:, None], D, 0.0), width


class _Coarsening:
    """Work arrays of one coarsening, and views of them as fields (Y, X) of the fine and of the coarse grid."""

    def __init__(self, grid: Grid, axis: int, correction: tuple[Array, NDArray[np.int64]]) -> None:
        D, width = correction
        coarse = grid.coarsen(axis)
        rows, coarse_rows, columns = grid.shape[axis], coarse.shape[axis], grid.shape[1 - axis]
        first, top = grid.first[axis], 2 * coarse.first[axis]  # top: fine node at the first coarse one
        last = max(first + rows - 1, top + 2 * (coarse_rows - 1))
        reach, margin = max(D.shape[0], REACH), D.shape[1]
        origin = reach - min(first, top)
        P = np.zeros((origin + last + reach + 1, columns + 2 * margin))
        self.arrays = kernels.Coarsening(
            P=P,
            D=np.ascontiguousarray(D),
            width=width,
            coarse=np.zeros((coarse_rows, columns)),
            W=np.zeros((rows, columns)),
            line=np.zeros(P.shape[1]),
            origin=origin,
            margin=margin,
            first=first,
            first_coarse=coarse.first[axis],
            along_y=axis == 0,
        )
        nodes = slice(margin, margin + columns)
        fine = P[origin + first :, nodes][:rows]
        lifted = P[origin + top :: 2, nodes][:coarse_rows]
        views = [fine, lifted, self.arrays.W, self.arrays.coarse]
        self.P, self.coarse_P, self.W, self.coarse_W = views if axis == 0 else [view.T for view in views]
