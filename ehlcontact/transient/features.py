"""Surface features that travel through the contact: what excites bearings.

A feature is a height G(X, Y, T) *added to the gap* (eq. 3), in dry approaches, even in Y: a dent is positive, a
ridge negative. It moves with one surface at ``dX/dT = speed``: 1 in pure rolling, ``2 u_i/u_sum`` in general. As
motions, features are dimensionless, and their method `at` makes them for an `OperatingPoint` from metres.
Shapes after Venner and Lubrecht, ASME J. Tribology 116 (1994) 751 (ridge) and 118 (1996) 153 (waviness).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from inspect import signature
from math import inf, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts, require_finite, require_nonnegative, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.transient.bodies import OverTime, scales_at

Array = NDArray[np.float64]
Surface = Callable[[Array, Array, float], Array]

PROBED = 8  # every so many nodes are compared with their images at -Y
BETWEEN = (0.5, 0.25, 0.382)  # places between nodes where a feature must be much as the nodes tell
LARGEST_MISS = 0.75  # of the height: fewer than 2.4 nodes to a wave; a step misses half
LINES = 9  # along which that is looked at
FAINT = 1e-9  # dry approaches: features that do not matter
START = -2.5  # semi-axes a: ahead of the contact, where a feature of its size is not felt
RATE_STEP = 1e-6  # of the central difference along the path of the film, in X and T


class SurfaceStep(NamedTuple):
    """A surface over one time step; arrays (ny + 1, nx + 1)."""

    height: Array  # at the end of the step
    at_start: Array  # at its start
    at_previous_start: Array  # at the start of the step before
    rate: Array  # (U d/dX + d/dT) G at the end: what passing film sees; 0 in pure rolling


def require_surface(surface: object, point: Point) -> None:
    """Raise `InputError` unless this is None, or can be called with X, Y and T, and was made for this point."""
    if surface is None:
        return
    if isinstance(surface, OverTime):
        surface.require_point("surface", point)
    fits = callable(surface) and not isinstance(surface, type)
    if fits:
        try:
            signature(surface).bind(0.0, 0.0, 0.0)  # type: ignore[arg-type]
        except ValueError:  # no signature is known of some functions written in C
            pass
        except TypeError:
            fits = False
    if not fits:
        name = getattr(surface, "__name__", None) or type(surface).__name__
        raise InputError("surface", name, "a feature such as Dent(...), a function of X, Y and T, or None")


def surface_height(surface: Surface | None, X: Array, Y: Array, T: float) -> Array | float:
    """Height of `surface` on the grid, shape (Y.size, X.size); 0 without one.

    Raises
    ------
    InputError
        The surface returns another shape, NaN or infinity, or is not even in Y.
    """
    if surface is None:
        return 0.0
    G = np.asarray(surface(X[None, :], Y[:, None], T), dtype=float)
    try:
        G = np.broadcast_to(G, (Y.size, X.size)).copy()
    except ValueError:
        raise InputError("surface", G.shape, f"a function returning shape {(Y.size, X.size)}") from None
    if not np.isfinite(G).all():
        raise InputError("surface", "NaN or infinity", f"finite everywhere (T = {T:g})")
    some = slice(None, None, PROBED)
    mirrored = np.asarray(surface(X[None, some], -Y[some, None], T), dtype=float)
    if not np.allclose(mirrored, G[some, some], rtol=1e-6, atol=1e-12):
        raise InputError("surface", "another for -Y than for Y", "even in Y: only Y >= 0 is computed")
    return G


def require_resolved(surface: Surface, X: Array, Y: Array, T: float) -> None:
    """Raise `InputError` if the nodes along X do not show what lies between them.

    Judged by the height of the whole feature, also beyond the grid: what comes in or goes out is there first, or
    still, with its tails alone.
    """
    mesh, length = X[1] - X[0], X[-1] - X[0]
    wide = np.concatenate([X - length - mesh, X, X + length + mesh])
    some = np.linspace(0, Y.size - 1, min(Y.size, LINES)).astype(int)

    def height(places: Array) -> Array:
        G = np.asarray(surface(places[None, :], Y[some, None], T), dtype=float)
        return np.broadcast_to(G, (some.size, places.size))

    nodes = height(wide)
    largest, missed = float(np.abs(nodes).max()), 0.0
    for share in BETWEEN:
        between = height(wide[:-1] + share * mesh)
        told = (1.0 - share) * nodes[:, :-1] + share * nodes[:, 1:]
        largest = max(largest, float(np.abs(between).max()))
        missed = max(missed, float(np.abs(between - told)[:, X.size : -X.size].max()))
    if missed > LARGEST_MISS * largest and largest > FAINT:
        allowed = f"resolved by the grid, whose mesh is {mesh:.3g} along X: raise n, or smooth it"
        raise InputError("surface", f"{missed:.3g} off between nodes at T = {T:g}", allowed)


def surface_step(
    surface: Surface | None, X: Array, Y: Array, T: float, dT: float, dT_before: float, speed: float = 1.0
) -> SurfaceStep | None:
    """`surface` over the step `dT` that ends at T and follows one of length `dT_before`; None without one.

    `speed` is that of the film at T, over that of the operating point.
    """
    if surface is None:
        return None
    height, before, earlier = (
        np.asarray(surface_height(surface, X, Y, max(time, 0.0))) for time in (T, T - dT, T - dT - dT_before)
    )
    require_resolved(surface, X, Y, T)
    ahead, behind = (
        np.asarray(surface_height(surface, X + speed * step, Y, T + step)) for step in (RATE_STEP, -RATE_STEP)
    )
    return SurfaceStep(height, before, earlier, (ahead - behind) / (2.0 * RATE_STEP))


@dataclass(frozen=True, slots=True)
class Dent(OverTime):
    """Round dent (depth > 0) or bump (depth < 0) centred on Y = 0.

    ``depth cos(pi r/(2 radius)) exp(-2 (r/radius)^2)``, r in the *physical* metric:
    ``r^2 = (X - X0 - speed T)^2 + (Y/kappa)^2`` with lengths in semi-axes a. Beyond r = radius a rim stands out,
    1.7 % of the depth high at 1.2 radius. The shape of Mourier, Mazuyer, Lubrecht and Donnet, Tribology Int. 39
    (2006) 1745, with their ``1.2 r0`` as `radius`.

    Parameters
    ----------
    depth : float
        In dry approaches.
    radius : float
        In semi-axes a.
    start : float
        X0, the place of its centre at T = 0, in semi-axes a.
    kappa : float
        That of the contact, where a circle in metres is none in X, Y.
    speed : float
        dX/dT: 1 is the mean speed of the surfaces.
    """

    depth: float
    radius: float
    start: float = START
    kappa: float = 1.0
    speed: float = 1.0

    def __post_init__(self) -> None:
        require_finite("depth", self.depth)
        require_positive("radius", self.radius)
        require_finite("start", self.start)
        require_positive("kappa", self.kappa)
        require_nonnegative("speed", self.speed)

    @classmethod
    @takes(depth=parts.FILM_HEIGHT, radius=parts.FILM_LENGTH, start=parts.FILM_LENGTH)
    def at(
        cls,
        point: OperatingPoint,
        depth: float,
        radius: float,
        *,
        start: float | None = None,
        speed: float = 1.0,
    ) -> Dent:
        """The same in metres: depth, radius and where it is at T = 0, by default 2.5 semi-axes a ahead.

        Raises
        ------
        InputError
            A dimensionless point; a number outside its range.
        """
        scales = scales_at(point, "Dent(depth, radius)")
        place = START if start is None else require_finite("start", start) / scales.a
        high = require_finite("depth", depth) / scales.length
        own = require_positive("radius", radius) / scales.a
        return cls(high, own, place, kappa=scales.a / scales.b, speed=speed, made_at=point)

    @property
    def passing(self) -> float:
        """Time in which a wave of it passes, in 2a/u_sum; infinite at rest."""
        return _passing(4.0 * self.radius, self.speed)  # the cosine of its shape

    def __call__(self, X: Array, Y: Array, T: float) -> Array:
        """Height at time T."""
        r = np.hypot(X - self.start - self.speed * T, Y / self.kappa) / self.radius
        return self.depth * np.cos(0.5 * pi * r) * np.exp(-2.0 * r * r)


@dataclass(frozen=True, slots=True)
class TransverseRidge(OverTime):
    """Ridge across the rolling direction: ``-height cos(2 pi s) 10^(-10 s^2)``, s = (X - X0 - speed T)/width.

    Parameters
    ----------
    height : float
        In dry approaches.
    width : float
        In semi-axes a.
    start : float
        X0, its place at T = 0, in semi-axes a.
    speed : float
        dX/dT: 1 is the mean speed of the surfaces.
    """

    height: float
    width: float
    start: float = START
    speed: float = 1.0

    def __post_init__(self) -> None:
        require_finite("height", self.height)
        require_positive("width", self.width)
        require_finite("start", self.start)
        require_nonnegative("speed", self.speed)

    @classmethod
    @takes(height=parts.FILM_HEIGHT, width=parts.FILM_LENGTH, start=parts.FILM_LENGTH)
    def at(
        cls,
        point: OperatingPoint,
        height: float,
        width: float,
        *,
        start: float | None = None,
        speed: float = 1.0,
    ) -> TransverseRidge:
        """The same in metres: height, width and where it is at T = 0, by default 2.5 semi-axes a ahead.

        Raises
        ------
        InputError
            A dimensionless point; a number outside its range.
        """
        scales = scales_at(point, "TransverseRidge(height, width)")
        place = START if start is None else require_finite("start", start) / scales.a
        high = require_finite("height", height) / scales.length
        own = require_positive("width", width) / scales.a
        return cls(high, own, place, speed=speed, made_at=point)

    @property
    def passing(self) -> float:
        """Time in which a wave of it passes, in 2a/u_sum; infinite at rest."""
        return _passing(self.width, self.speed)

    def __call__(self, X: Array, Y: Array, T: float) -> Array:
        """Height at time T, the same for all Y."""
        s = (X - self.start - self.speed * T) / self.width
        return -self.height * np.cos(2.0 * pi * s) * 10.0 ** (-10.0 * s * s) + 0.0 * Y


@dataclass(frozen=True, slots=True)
class Waviness(OverTime):
    """Transverse waviness that enters the contact from ``X0 + speed T`` on, with a smooth front.

    Upstream of the front ``amplitude sin(2 pi s)``, s = (X - X0 - speed T)/wavelength, downstream zero.

    Parameters
    ----------
    amplitude : float
        In dry approaches.
    wavelength : float
        In semi-axes a.
    start : float
        X0, the place of the front at T = 0, in semi-axes a.
    speed : float
        dX/dT: 1 is the mean speed of the surfaces.
    """

    amplitude: float
    wavelength: float
    start: float = START
    speed: float = 1.0

    def __post_init__(self) -> None:
        require_finite("amplitude", self.amplitude)
        require_positive("wavelength", self.wavelength)
        require_finite("start", self.start)
        require_nonnegative("speed", self.speed)

    @classmethod
    @takes(amplitude=parts.FILM_HEIGHT, wavelength=parts.FILM_LENGTH, start=parts.FILM_LENGTH)
    def at(
        cls,
        point: OperatingPoint,
        amplitude: float,
        wavelength: float,
        *,
        start: float | None = None,
        speed: float = 1.0,
    ) -> Waviness:
        """The same in metres: amplitude, wavelength and where it is at T = 0, by default 2.5 semi-axes a ahead.

        Raises
        ------
        InputError
            A dimensionless point; a number outside its range.
        """
        scales = scales_at(point, "Waviness(amplitude, wavelength)")
        place = START if start is None else require_finite("start", start) / scales.a
        high = require_finite("amplitude", amplitude) / scales.length
        own = require_positive("wavelength", wavelength) / scales.a
        return cls(high, own, place, speed=speed, made_at=point)

    @property
    def passing(self) -> float:
        """Time in which a wave of it passes, in 2a/u_sum; infinite at rest."""
        return _passing(self.wavelength, self.speed)

    def __call__(self, X: Array, Y: Array, T: float) -> Array:
        """Height at time T, the same for all Y."""
        s = (X - self.start - self.speed * T) / self.wavelength
        front = np.where(s < 0.0, 1.0 - np.exp(-10.0 * np.minimum(s, 0.0) ** 2), 0.0)
        return self.amplitude * front * np.sin(2.0 * pi * s) + 0.0 * Y


def _passing(wave: float, speed: float) -> float:
    return wave / speed if speed > 0.0 else inf
