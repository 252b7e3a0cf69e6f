"""Table of the changes by an oil supply over M, L, kappa and r, the layer over what the flooded film lets through.

What is interpolated, per point and r, against the flooded contact on the same grid: ln of the central film's
share over the curve ``r/(1 + r^g)^(1/g)`` with the g of the ellipse; ln of the share of h_min/h_c; the changes of
approach, over 1 - u, and of the moment, over itself; ln of the factor on K at each frequency; asinh of the change
of C over the flooded C there (or a small share of that at low frequency, where it is smaller): far below -1 where
the oil ahead of the contact comes and goes in time with it.

Radial functions over M, L and kappa (`reduced_models.atlas.interpolation`) have all of these at every r of the
table at once; between these cubics over asinh(r). Beyond the last r all changes fade like 1/r; below the first the
film follows the curve.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.film_formulas import film_of_layer, layer_sharpness
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.store import stored
from reduced_models.atlas.interpolation import (
    Neighbours,
    Radial,
    coordinates,
    error_factor,
    films,
    left_out_errors,
)
from reduced_models.atlas.table import Box, Interpolation, require_shapes

_Floats = NDArray[np.float64]

NUMBERS = 4  # changes of central film, h_min/h_c, approach, moment; then K and C over frequency
FAINT = 0.05  # share of the low-frequency C below which changes of C are over that
LIGHT = 3  # coordinate of the atlas that says how light a load is
REFERENCE = 0.05  # frequency of that C, as in the atlas
LOW_OMEGA = 0.01  # where frequencies begin to count by their ratio
BENT = 0.5  # share of the distance between cubic and straight line over r that error bars grow by


class SupplyChange(NamedTuple):
    """Changes of n contacts: rows of the smooth variables, (n, 4 + 2 k), and half widths of their error bars."""

    rows: _Floats
    bars: _Floats


@stored("table of oil supply", 1)
@dataclass(frozen=True, eq=False)
class SupplyTable:
    """Arrays over the n solved points."""

    points: _Floats  # (n, 3) M, L, kappa
    ratios: _Floats  # (m,) r
    omega: _Floats  # (k,)
    changes: _Floats  # (n, m, 4 + 2 k) smooth variables
    metadata: dict[str, Any]  # box, narrowest inlet, interpolation; command, version, sample, what was left out

    @property
    def box(self) -> Box:
        """Ranges of M, L, kappa and Hertz pressure."""
        return Box.from_dict(self.metadata["box"])

    @property
    def narrowest(self) -> float:
        """Width of the narrowest inlets, in semi-axes: thinner films are not in the table."""
        return float(self.metadata["narrowest"])

    @property
    def lightest(self) -> float:
        """Load number of the lightest contacts: of lighter ones the front lies far ahead."""
        return float(self.metadata["lightest"])

    @property
    def interpolation(self) -> Interpolation:
        """Settings of the interpolation, which are those of the atlas."""
        return Interpolation(**self.metadata["interpolation"])

    def require_complete(self) -> None:
        """Raise `ValueError` or another error of damaged metadata unless all arrays are there and fit.

        Raises
        ------
        ValueError
            An array of another shape, or with numbers that are not finite.
        """
        n, m, k = len(self.points), self.ratios.size, self.omega.size
        shapes = {"points": (n, 3), "ratios": (m,), "omega": (k,), "changes": (n, m, NUMBERS + 2 * k)}
        require_shapes(self, shapes)
        _ = self.box, self.narrowest, self.lightest, self.interpolation

    def rounded(self) -> Self:
        """Table with changes in half precision, 5e-4 of each, as in the file that comes with the library."""
        return replace(self, changes=self.changes.astype(np.float16).astype(np.float32))


def share_of_layer(ratio: _Floats, kappa: _Floats) -> _Floats:
    """Central film over the flooded one by the curve with the g of the ellipse."""
    sharpness = np.array([layer_sharpness(k) for k in np.atleast_1d(kappa).tolist()])
    return np.asarray(film_of_layer(ratio, sharpness))


class SupplySurface:
    """The table as a function of rows (M, L, kappa) and r."""

    @one_blas_thread()
    def __init__(self, table: SupplyTable) -> None:
        self.table, by = table, table.interpolation
        self._by, x = by, _places(table.points, by)
        n, m, q = table.changes.shape
        flat = np.asarray(table.changes, float).reshape(n, m * q)
        self._radial, errors = Radial(x, flat), left_out_errors(x, flat)
        self._neighbours = Neighbours(x, errors, by.nearest)
        self._factor = error_factor(x, errors, by.nearest, by.covered)

    @one_blas_thread()
    def at(self, points: _Floats, ratio: _Floats) -> SupplyChange:
        """Changes of contacts, rows (M, L, kappa), each under its own r, shape (n,)."""
        nodes, q = self.table.ratios, self.table.changes.shape[2]
        x = _places(points, self._by)
        distance = scipy.spatial.distance.cdist(x, self._radial.x)
        found = self._radial.at(x, distance).reshape(len(points), nodes.size, q)
        grown, local = self._neighbours.at(distance)
        bars = (grown * (local * self._factor)).reshape(found.shape)
        x, place = np.arcsinh(nodes), np.arcsinh(np.clip(ratio, nodes[0], nodes[-1]))
        straight = _linear(x, place)
        rows, between = _between(x, found, place), np.einsum("nm,nmq->nq", straight, found)
        spread = np.einsum("nm,nmq->nq", straight, bars) + BENT * np.abs(rows - between)
        fade = np.minimum(nodes[-1] / ratio, 1.0)[:, None]
        return SupplyChange(rows * fade, spread * fade)


def _places(points: _Floats, by: Interpolation) -> _Floats:
    """Coordinates of the atlas but for that of light loads, which is 0 at all of these."""
    x, _ = coordinates(points, films(points), by)
    return np.delete(x, LIGHT, axis=1)


def _between(nodes: _Floats, values: _Floats, place: _Floats) -> _Floats:
    """Modified Akima's cubics, which do not overshoot, through values (n, m, q) at nodes (m,), at places (n,)."""
    cubics = scipy.interpolate.Akima1DInterpolator(nodes, values, axis=1, method="makima").c
    cell = np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, nodes.size - 2)
    c, s = cubics[:, cell, np.arange(place.size)], (place - nodes[cell])[:, None]
    return np.asarray(((c[0] * s + c[1]) * s + c[2]) * s + c[3])


def _linear(nodes: _Floats, place: _Floats) -> _Floats:
    """Weights of the nodes in a straight line between them, shape (n, m)."""
    return np.array([np.interp(place, nodes, unit) for unit in np.eye(nodes.size)]).T
