"""Static curve of a film law: loads and approaches to interpolation nodes, from lift-off to overload."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from ehlcontact.errors import InputError
from reduced_models.elements.film_law import FilmLaw, films

_Floats = NDArray[np.float64]

LEAST_EXPONENT = 0.02  # of a film h_s = film F^-exponent, or the force would end at some approach
# A film far thicker than the deformation carries F like h^-1/2 (rigid surfaces, Kapitza 1955). Below the table
# the slope of ln h_s goes to that over one decade of load and stays; above, it stays what it is at the end.
RIGID_SLOPE = -2.0
DECADE = math.log(10.0)
CHECKS = 16  # points per interval at which the curve is checked to rise


def increasing(name: str, values: ArrayLike, least: int = 1) -> _Floats:
    """Return `values` as a one-dimensional, finite, strictly increasing array, or raise `InputError`."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(name, type(values).__name__, "numbers") from None
    if array.ndim != 1 or array.size < least:
        raise InputError(f"shape of {name}", array.shape, f"one-dimensional with at least {least}")
    if not np.all(np.isfinite(array)):
        raise InputError(name, "NaN or infinity", "finite")
    if np.any(np.diff(array) <= 0.0):
        at = int(np.argmax(np.diff(array) <= 0.0))
        raise InputError(f"{name}[{at + 1}]", float(array[at + 1]), f"above the one before, {float(array[at])!r}")
    return array


def curve_nodes(loads: ArrayLike, approach: ArrayLike) -> dict[str, _Floats]:
    """Nodes of ln h_s over ln F (PCHIP: monotone where the data are, no overshoot) for `FilmLaw`.

    Parameters
    ----------
    loads : array_like, shape (n,), n >= 2
        Increasing, > 0, in units of the reference load.
    approach : array_like, shape (n,)
        Static approach under each load, increasing, below the dry approach F^(2/3): what is missing is film.

    Raises
    ------
    InputError
        Tables that cannot be used; it names the entry.
    """
    force, u = increasing("loads", loads, 2), increasing("approach", approach, 2)
    if force[0] <= 0.0:
        raise InputError("loads[0]", float(force[0]), "> 0")
    if u.size != force.size:
        raise InputError("length of approach", u.size, f"that of loads, {force.size}")
    film = force ** (2.0 / 3.0) - u
    if np.any(film <= 0.0):
        at = int(np.argmin(film))
        raise InputError(
            f"approach[{at}]", float(u[at]), f"below the dry one, {float(force[at] ** (2.0 / 3.0))!r}"
        )
    x, y = np.log(force), np.log(film)
    slope = np.full(2, (y[1] - y[0]) / (x[1] - x[0])) if x.size == 2 else PchipInterpolator(x, y).derivative()(x)
    slope[-1] = min(slope[-1], 0.0)
    below = x[0] - DECADE, y[0] - 0.5 * DECADE * (slope[0] + RIGID_SLOPE)
    return {
        "x": np.append(below[0], x),
        "y": np.append(below[1], y),
        "slope": np.append(RIGID_SLOPE, slope),
        "u": np.append(np.exp(2.0 / 3.0 * below[0]) - np.exp(below[1]), u),
    }


def require_rising(law: FilmLaw) -> None:
    """Raise `InputError` unless the approach rises with the load between all nodes."""
    t = np.linspace(0.0, 1.0, CHECKS)
    x = (law.x[:-1, None] + t * np.diff(law.x)[:, None]).ravel()
    h, du = np.empty((2, x.size))
    films(law, x, h, du)
    if not np.all(du > 0.0):
        load = float(np.exp(x[np.argmin(du)]))
        raise InputError("approach", f"falling near load {load:.4g}", "rising with the load (more loads help)")


def as_rows(name: str, values: ArrayLike | Sequence[Sequence[float]], rows: int) -> _Floats:
    """Return `values` as a finite array of shape (rows, k), k >= 4, or raise `InputError`."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(name, type(values).__name__, "rows of numbers, all of one length") from None
    if array.ndim != 2 or array.shape[0] != rows or array.shape[1] < 4:
        raise InputError(f"shape of {name}", array.shape, f"({rows}, 3 + number of lags)")
    if not np.all(np.isfinite(array)):
        raise InputError(name, "NaN or infinity", "finite")
    return array
