"""Table of the changes of rolling contacts by heat, over M, L, kappa, thermal load Q and the slope of the oil.

In pure rolling, Q = -d eta0/dT u^2/k is what the published factors depend on; their g = ln(1 + 0.1 (4 Q)^0.64)
(`ehlcontact.film_formulas.wilson_heating`) is the unit of all changes here. At given M, L, kappa and Q the Peclet
number of film and surfaces and Roelands' S0 follow the slope of the oil, -d ln(eta0)/dT, up to what alpha and E'
differ in: the slope is the last coordinate. What else differs between oils is in the error bars.

Interpolated, against the isothermal contact on the same grid: ln of the factors on 1 - u, both films, moment and
K over g; changes of C over C at Omega = 0 and g. So nothing changes where Q is 0. Outside the sample its nearest
coordinates are taken, and error bars grow with the distance from its points.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import log
from typing import Any, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.film_formulas import load_number, wilson_heating
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.store import stored
from reduced_models.atlas.interpolation import Neighbours, Radial, error_factor, left_out_errors
from reduced_models.atlas.table import require_shapes

_Floats = NDArray[np.float64]
Entry = Mapping[str, Any]

NUMBERS = ("film_share", "h_central", "h_min", "moment")  # then K and C over frequency
KNOWN = ("M", "L", "kappa", "thermal_load", "slope")  # coordinates of a contact


class Settings(NamedTuple):
    """Of the interpolation; error bars are valid for these."""

    weights: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0, 1.0)  # of the coordinates, in the order of `coordinates`
    nearest: int = 10  # points whose errors make the error bar
    covered: float = 0.97  # share of points that the error bar covers when each is left out


@stored("table of heat", 1)
@dataclass(frozen=True, eq=False)
class HeatTable:
    """Arrays over the n solved contacts."""

    points: _Floats  # (n, 5) M, L, kappa, Q, slope [1/K]
    omega: _Floats  # (k,)
    changes: _Floats  # (n, 4 + 2 k) over g: ln of factors, and differences of C
    metadata: dict[str, Any]  # interpolation; errors of mesh and other oils; command, version, sample

    @property
    def settings(self) -> Settings:
        """Settings of the interpolation."""
        return Settings(
            **{**self.metadata["interpolation"], "weights": tuple(self.metadata["interpolation"]["weights"])}
        )

    def require_complete(self) -> None:
        """Raise `ValueError` or another error of damaged metadata unless all arrays are there and fit.

        Raises
        ------
        ValueError
            An array of another shape, or with numbers that are not finite.
        """
        n, k = len(self.points), self.omega.size
        shapes = {"points": (n, len(KNOWN)), "omega": (k,), "changes": (n, len(NUMBERS) + 2 * k)}
        require_shapes(self, shapes)
        _ = self.settings

    def rounded(self) -> Self:
        """Table in single precision but for the points, as in the file that comes with the library."""
        return replace(self, changes=self.changes.astype(np.float32).astype(float))


def unit_of(thermal_load: float) -> float:
    """g: unit of all changes, minus ln of Wilson and Sheu's factor, at Q."""
    return -log(wilson_heating(thermal_load))


def coordinates(points: _Floats) -> _Floats:
    """Rows of ln N, L^(2/3), ln kappa, ln Q and ln of the slope from rows of the table, shape (n, 5)."""
    M, L, kappa, load, slope = points.T
    N = [load_number(*row) for row in zip(M.tolist(), kappa.tolist(), strict=True)]
    return np.column_stack([np.log(N), L ** (2.0 / 3.0), np.log(kappa), np.log(load), np.log(slope)])


def changes_of(entry: Entry) -> _Floats:
    """Row of the table of an entry of `heat_solve`, shape (4 + 2 k,)."""
    cold, warm = entry["cold"], entry["warm"]
    share = [1.0 - one["approach"] for one in (warm, cold)]
    films = [warm[name] / cold[name] for name in NUMBERS[1:]]
    stiffness = np.divide(warm["stiffness"], cold["stiffness"])
    damping = np.subtract(warm["damping"], cold["damping"]) / cold["damping"][0]
    row = np.concatenate([np.log([share[0] / share[1], *films, *stiffness]), damping])
    return np.asarray(row / unit_of(entry["thermal_load"]))


class HeatSurface:
    """The table as a function of rows (M, L, kappa, Q, slope)."""

    @one_blas_thread()
    def __init__(self, table: HeatTable) -> None:
        self.table, by = table, table.settings
        self._weights = np.array(by.weights)
        self.ends = np.array([table.points.min(axis=0), table.points.max(axis=0)])
        plain = coordinates(table.points)
        self._low, self._high = plain.min(axis=0), plain.max(axis=0)
        x = plain * self._weights
        self._radial, errors = Radial(x, table.changes), left_out_errors(x, table.changes)
        self._neighbours = Neighbours(x, errors, by.nearest)
        self._factor = error_factor(x, errors, by.nearest, by.covered)

    @one_blas_thread()
    def at(self, points: _Floats) -> tuple[_Floats, _Floats]:
        """Changes of contacts and half widths of their error bars, both over g, shape (n, 4 + 2 k)."""
        x = np.clip(coordinates(points), self._low, self._high) * self._weights
        distance = scipy.spatial.distance.cdist(x, self._radial.x)
        found = self._radial.at(x, distance)
        grown, local = self._neighbours.at(distance)
        return found, grown * self._factor * local
