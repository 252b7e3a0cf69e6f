"""Layers of oil under repeated passes of contacts: closed form of thin ones, and `oil_passes`, which solves films.

Under a ball a thin layer m = rho h, on both surfaces together, is a film between parallel surfaces under the
pressure of Hertz, which presses it aside. On the line in the middle, over one pass,

    dm/dX = kappa^2 m^3/(lambda rho^2 eta) d2P/dY2,    d2P/dY2 = -(1 - X^2)^(-1/2),

so that m^-2 grows by the same amount in every pass (van Zoelen, Venner and Lugt, Proc. IMechE Part J 223 (2009)
541-552):

    m_n^-2 = m_0^-2 + n S,    S = 2 kappa^2/lambda int_0^pi dtheta/(rho^2 eta)(P = sin theta).

In 1/m^2, S is proportional to the time that the oil is under the ball. In place of the integral that paper has
``pi ((pi alpha p_h/2)^1.5 + 1)^(-2/3)``, which for Barus' law is within 4 % of it from alpha p_h = 8 on.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import cycle
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_numbers, parts, require_instance, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.jit import plain
from ehlcontact.lubricant import density, log_viscosity
from ehlcontact.point import POINT, MoesPoint, OperatingPoint, Point, moes_point
from ehlcontact.results import SteadyResult
from ehlcontact.steady import solve_steady
from ehlcontact.supply import OilLayer, layer_on

Array = NDArray[np.float64]

ANGLES = 64  # of Gauss' rule over theta


def side_flow(point: Point) -> float:
    """S: by how much layer^-2 grows in a pass, in 1/m^2; of a dimensionless point over dry approaches.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    """
    moes = moes_point(point)
    places, weights = np.polynomial.legendre.leggauss(ANGLES)
    pressures = np.sin(0.25 * pi * (places + 1.0)).tolist()  # from 0 to pi/2: the other half is alike
    rho = np.array([plain(density)(P, moes.law)[0] for P in pressures])
    eta = np.exp([plain(log_viscosity)(P, moes.law)[0] for P in pressures])
    growth = 2.0 * moes.kappa**2 / moes.lam * 0.5 * pi * float(weights @ (1.0 / (rho * rho * eta)))
    return growth / point.scales.length**2


@takes(point=POINT, layer=parts.ANY)
def layer_after_passes(point: Point, layer: float, passes: ArrayLike) -> Array:
    """Thin layer on the line in the middle after passes of a contact, without any return of oil.

    The closed form above. It holds where the layer is well below what the flooded film lets through (0.3 of it and
    less): thicker ones lose more in the inlet.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    layer : float
        Before the first pass, on both surfaces together, in m; of a dimensionless point over the dry approach.
    passes : float or array_like
        At least 0.

    Raises
    ------
    InputError
        A layer that is not positive; passes below 0.
    """
    if isinstance(point, OperatingPoint):
        parts.LAYER.require("layer", layer)
    count = as_numbers("passes", passes)
    if not np.all((count >= 0.0) & np.isfinite(count)):
        raise InputError("passes", passes, "finite numbers >= 0")
    return np.asarray((require_positive("layer", layer) ** -2.0 + side_flow(point) * count) ** -0.5)


def oil_passes(contacts: Point | Sequence[Point], supply: OilLayer, **options: Any) -> Iterator[SteadyResult]:
    """Films of successive contacts of a ball, each on the oil that the previous ones left; an endless iterator.

    With one contact a ball passes the same track again and again. With several, as of a ball with the inner and
    with the outer race, every race has its own track: what leaves a contact stays in equal halves on the track
    and on the ball, and the ball carries its half to the next contact. Layers are functions over y.

    Parameters
    ----------
    contacts : MoesPoint, OperatingPoint, or sequence of OperatingPoint
    supply : OilLayer
        Before the first pass, on track and ball together, the same at all contacts.
    **options
        As of `solve_steady`.

    Yields
    ------
    SteadyResult
        ``layer`` and ``layer_behind`` are those before and after this pass.

    Raises
    ------
    InputError
        Several contacts that are not all in SI.

    Examples
    --------
    >>> from itertools import islice
    >>> from ehlcontact import Grid, MoesPoint, OilLayer
    >>> films = islice(oil_passes(MoesPoint(20, 10, 1), OilLayer(H=0.15), grid=Grid(64)), 3)
    >>> [round(film.h_central, 4) for film in films]
    [0.1295, 0.1273, 0.125]
    """
    points = list(contacts) if isinstance(contacts, Sequence) else [contacts]
    require_instance("supply", supply, OilLayer, "an OilLayer(h, ...)")
    if not points:
        raise InputError("contacts", "none", "one or more")
    if len(points) > 1 and any(isinstance(point, MoesPoint) for point in points):
        raise InputError("contacts", "dimensionless", "OperatingPoints, where there are several")
    return _passes(points, supply, options)


def _passes(points: list[Point], supply: OilLayer, options: dict[str, Any]) -> Iterator[SteadyResult]:
    film = solve_steady(points[0], supply=supply, **options)
    tracks = [_half(film, film.layer)] * len(points)
    for k in cycle(range(len(points))):
        yield film
        tracks[k] = ball = _half(film, film.layer_behind)
        following = (k + 1) % len(points)
        layer = _together(points[following], tracks[following], ball)
        film = solve_steady(points[following], supply=layer, **options)


def _half(film: SteadyResult, layer: Array | None) -> tuple[Array, Array]:
    """Places across and half of a layer there, in the units of the film."""
    assert layer is not None
    return film.y, 0.5 * layer


def _together(point: Point, track: tuple[Array, Array], ball: tuple[Array, Array]) -> OilLayer:
    """Layers of track and ball, as the supply of their contact."""
    y = np.union1d(track[0], ball[0])
    both = np.interp(y, *track) + np.interp(y, *ball)
    return layer_on(point, both, y)
