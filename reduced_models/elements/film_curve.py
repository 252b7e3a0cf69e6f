"""Static curve of a film law: nodes from loads and approaches, or from a film that is a power of the load."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_positive
from ehlcontact.errors import InputError
from reduced_models.elements.film_law import FilmLaw, films

_Floats = NDArray[np.float64]

LEAST_EXPONENT = 0.02  # of a film h_s = film F^-exponent, or the force would end at some approach
# A film far thicker than the deformation carries F like h^-1/2 (rigid surfaces, Kapitza 1955). Below the table
# the slope of ln h_s goes to that over one decade of load and stays; above, it stays what it is at the end.
RIGID_SLOPE = -2.0
DECADE = math.log(10.0)
CHECKS = 16  # points per interval at which the curve is checked to rise


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
    force = as_column("loads", loads, least=2, increasing=True)
    require_positive("loads[0]", float(force[0]))
    u = as_column("approach", approach, size=force.size, increasing=True)
    film = force ** (2.0 / 3.0) - u
    if np.any(film <= 0.0):
        at = int(np.argmin(film))
        raise InputError(
            f"approach[{at}]", float(u[at]), f"below the dry one, {float(force[at] ** (2.0 / 3.0))!r}"
        )
    x, y = np.log(force), np.log(film)
    if x.size == 2:
        slope = np.full(2, (y[1] - y[0]) / (x[1] - x[0]))
    else:
        slope = scipy.interpolate.PchipInterpolator(x, y).derivative()(x)
    if (
        y[1] > y[0]
    ):  # a film that grows with a light load, as under a layer: PCHIP's end may be three times as steep
        slope[0] = min(slope[0], (y[1] - y[0]) / (x[1] - x[0]))
    slope[-1] = min(slope[-1], 0.0)
    below = x[0] - DECADE, y[0] - 0.5 * DECADE * (slope[0] + RIGID_SLOPE)
    return {
        "x": np.append(below[0], x),
        "y": np.append(below[1], y),
        "slope": np.append(RIGID_SLOPE, slope),
        "u": np.append(np.exp(2.0 / 3.0 * below[0]) - np.exp(below[1]), u),
    }


def film_and_exponent(approach: float, tangent: float) -> tuple[float, float]:
    """Static film at load 1 and how it thins with the load, from approach and static tangent K_0 there.

    1/K_0 = 2/3 + exponent film, the derivative of u = F^(2/3) - film F^-exponent; but at least `LEAST_EXPONENT`.
    """
    film = 1.0 - approach
    return film, max((1.0 / tangent - 2.0 / 3.0) / film, LEAST_EXPONENT)


def approach_under(load: Any, film: float, exponent: float) -> Any:
    """Static approach u = F^(2/3) - film F^-exponent under a load F, a number or an array."""
    return load ** (2.0 / 3.0) - film * load**-exponent


def power_nodes(film: float, exponent: float) -> dict[str, _Floats]:
    """Nodes of ln h_s over ln F for `FilmLaw`, of a film h_s = film F^-exponent."""
    x = np.array([-1.0, 1.0])  # a straight line: any two points
    y = math.log(film) - exponent * x
    return {"x": x, "y": y, "slope": np.full(2, -exponent), "u": np.exp(2.0 / 3.0 * x) - np.exp(y)}


def require_rising(law: FilmLaw) -> None:
    """Raise `InputError` unless the approach rises with the load between all nodes."""
    t = np.linspace(0.0, 1.0, CHECKS)
    x = (law.x[:-1, None] + t * np.diff(law.x)[:, None]).ravel()
    h, du = np.empty((2, x.size))
    films(law, x, h, du)
    if not np.all(du > 0.0):
        load = float(np.exp(x[np.argmin(du)]))
        raise InputError("approach", f"falling near load {load:.4g}", "rising with the load (more loads help)")
