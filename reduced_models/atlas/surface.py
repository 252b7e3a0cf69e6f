"""`Surface`: a table of the atlas as a function of its points, with error bars.

Cubic radial functions go through the smooth variables of all points, over the coordinates of the recipe. The error
bar of a place follows from the errors of the nearest points, each interpolated from all others.
"""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.store import read as read_file
from reduced_models.atlas.table import Table, recipe_named

_Floats = NDArray[np.float64]

BLOCK = 256  # points evaluated together: their distances to all nodes stay in the cache
MOST_OPEN = 4  # files that a process keeps beside those of the library


def _system(x: _Floats) -> _Floats:
    """Matrix of cubic radial functions with a plane beside them."""
    n, plane = len(x), np.column_stack([np.ones(len(x)), x])
    corner = np.zeros((plane.shape[1], plane.shape[1]))
    return np.block([[scipy.spatial.distance.cdist(x, x) ** 3, plane], [plane.T, corner]]) if n else corner


def left_out_errors(x: _Floats, values: _Floats) -> _Floats:
    """Error at every node of the interpolation without it, from one inverse (Rippa 1999)."""
    n = len(x)
    inverse = np.linalg.inv(_system(x))
    return (inverse[:n, :n] @ values) / np.diag(inverse)[:n, None]


def error_factor(x: _Floats, errors: _Floats, nearest: int, covered: float) -> _Floats:
    """Factor on the local error that covers a given share of the nodes, each judged by its neighbours."""
    distance = scipy.spatial.distance.cdist(x, x)
    np.fill_diagonal(distance, np.inf)
    _, local = Neighbours(x, errors, nearest).at(distance)
    ratio = np.divide(np.abs(errors), local, out=np.zeros_like(errors), where=local > 0.0)  # 0 of what is constant
    return np.quantile(ratio, covered, axis=0)


@one_blas_thread()
def errors_of(table: Table) -> tuple[_Floats, _Floats]:
    """Errors of all smooth variables at every point without it, and their `error_factor`."""
    recipe, by = recipe_named(table.recipe), table.interpolation
    unit = recipe.unit(table, table.points)
    smooth, (x, *apart) = recipe.smooth(table, unit), recipe.coordinates(table, table.points, unit)
    errors = left_out_errors(x, smooth)
    for column, own in zip(recipe.apart, apart, strict=True):
        errors[:, [column]] = left_out_errors(own, smooth[:, [column]])
    errors = recipe.sizes(errors)
    return errors, error_factor(x, errors, by.nearest, by.covered)


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


class Surface:
    """A table as a function of rows of coordinates, as its recipe has them.

    Parameters
    ----------
    table : Table
    """

    @one_blas_thread()
    def __init__(self, table: Table) -> None:
        self.table, self._recipe = table, recipe_named(table.recipe)
        unit = self._recipe.unit(table, table.points)
        smooth = self._recipe.smooth(table, unit)
        x, *apart = self._recipe.coordinates(table, table.points, unit)
        self._smooth = slice(smooth.shape[1])
        self._low, self._high = x.min(axis=0), x.max(axis=0)
        self._all = Radial(x, np.hstack([smooth, self._recipe.beside(table)]))
        self._apart = [(c, Radial(own, smooth[:, [c]])) for c, own in zip(self._recipe.apart, apart, strict=True)]
        kept = self._recipe.keeps_errors
        errors, self._factor = (table["left_out"], table["factor"]) if kept else errors_of(table)
        self._neighbours = Neighbours(x, errors, table.interpolation.nearest)

    @property
    def coefficients(self) -> tuple[_Floats, ...]:
        """Coefficients of the radial functions, for evaluation elsewhere (page of ``ehlcontact explore``).

        Shape (n + 1 + d, columns) in d coordinates: a row for every point, then the constant and the slopes of the
        plane; then those of every column with coordinates of its own, shape (n + 1 + its coordinates,).
        """
        return self._all.coefficients, *(radial.coefficients[:, 0] for _, radial in self._apart)

    @property
    def usual_reach(self) -> float:
        """Median distance of the points from the farthest of their neighbours that make the error bar."""
        return self._neighbours.usual_reach

    @one_blas_thread()
    def at(self, points: _Floats, **more: Any) -> tuple[_Floats, _Floats]:
        """Values at rows of coordinates and half widths of their error bars, as the recipe returns them.

        Where nodes lie far apart the bars grow with the square of their distance. `more` goes to the recipe's
        ``values``.
        """
        blocks = [self._block(points[i : i + BLOCK], more) for i in range(0, len(points), BLOCK)]
        values, bars = zip(*blocks, strict=True)
        return np.concatenate(values), np.concatenate(bars)

    @one_blas_thread()
    def beside(self, points: _Floats) -> tuple[_Floats, _Floats]:
        """Values without error bars, and the columns that are interpolated as they are."""
        unit, columns, _ = self._interpolated(points, slice(None))
        smooth = columns[:, self._smooth]
        values, _ = self._recipe.values(self.table, points, unit, smooth, np.zeros(smooth.shape))
        return values, columns[:, self._smooth.stop :]

    def _block(self, points: _Floats, more: dict[str, Any]) -> tuple[_Floats, _Floats]:
        unit, smooth, distance = self._interpolated(points, self._smooth)
        grown, local = self._neighbours.at(distance)
        return self._recipe.values(self.table, points, unit, smooth, grown * self._factor * local, **more)

    def _interpolated(self, points: _Floats, columns: slice) -> tuple[_Floats, _Floats, _Floats]:
        """Unit of the smooth variables, their values, and the distances from all nodes."""
        recipe = self._recipe
        unit = recipe.unit(self.table, points)
        x, *apart = recipe.coordinates(self.table, points, unit)
        if recipe.clipped:
            x = np.clip(x, self._low, self._high)
        distance = scipy.spatial.distance.cdist(x, self._all.x)
        smooth = self._all.at(x, distance, columns)
        for (column, radial), own in zip(self._apart, apart, strict=True):
            smooth[:, [column]] = radial.at(own, scipy.spatial.distance.cdist(own, radial.x))
        return unit, smooth, distance


_OPEN: dict[tuple[int, ...], Surface] = {}  # by device, inode, size and time of the file


@cache
def shipped(recipe: str) -> Surface:
    """The table of a recipe that comes with the library, read once."""
    return opened(shipped_file(recipe), recipe)


def shipped_file(recipe: str) -> Path:
    """File of the table that comes with the library."""
    return Path(__file__).with_name(f"{recipe}.h5")


def opened(path: str | os.PathLike[str], recipe: str) -> Surface:
    """Table of a file and its interpolation; read once, and again when the file has been changed or replaced.

    Raises
    ------
    InputError
        No readable table of this recipe.
    """
    try:
        status = os.stat(os.fspath(path))
        version: tuple[int, ...] = status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns
    except (OSError, TypeError, ValueError):
        version = ()  # reading raises what is wrong with it
    surface = _OPEN.get(version) or Surface(read_file(path, Table, "atlas"))
    if surface.table.recipe != recipe:
        allowed = f"a table of an atlas of recipe {recipe!r}, not {surface.table.recipe!r}"
        raise InputError("atlas", str(path), allowed)
    if version not in _OPEN:
        while len(_OPEN) >= MOST_OPEN:
            del _OPEN[next(iter(_OPEN))]
        _OPEN[version] = surface
    return surface
