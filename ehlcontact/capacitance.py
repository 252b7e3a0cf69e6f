"""Capacitance between the two bodies of a contact: gaps with oil, as plates that face each other across them.

A gap g in which oil of the thickness t stands, permittivity e, and vapour or air elsewhere, has per area

    eps0 / (t/e + (g - t)).

Of a film that was not solved, as those of an element, the gap is that of the dry contact with a film of one
thickness under all of it: `hertz_capacitance`. It is integrated over ellipses that are confocal with the contact,
along which the integrals of its deflection are constant, to the edge of the ball.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
import scipy
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_finite
from ehlcontact.errors import InputError
from ehlcontact.hertz import ellipse_ratio

Array = NDArray[np.float64]

EPS0 = 8.8541878128e-12  # F/m
OIL = 2.2  # permittivity of mineral and hydrocarbon oils, 2.0 to 2.5
VOLTAGE = 10.0  # V between the rings, where a study has none of its own
BREAKDOWN = 15.0  # V/um from which films are said to break down, where no limit is given: not from data
LARGEST = 100.0  # permittivity: that of water is 80
RAYS, ELLIPSES = 16, 24  # of a quadrant; between the contact and the edge of the ball
_ANGLES, _WEIGHTS = leggauss(RAYS)
_PLACES, _PARTS = leggauss(ELLIPSES)
DOUBLINGS = 4  # of Carlson's integrals, which are then within 1e-9
AT_ONCE = 64  # contacts, whose places fit a cache


def require_permittivity(name: str, value: float) -> float:
    """Return a relative permittivity; raises `InputError` for one below 1, and for one in F/m."""
    given = require_finite(name, value)
    if not 1.0 <= given <= LARGEST:
        guess = f" (in F/m? then {given / EPS0:.3g})" if 1e-12 < given < 1e-9 else ""
        raise InputError(name, value, f"relative to vacuum, between 1 and {LARGEST:g}{guess}")
    return given


@dataclass(frozen=True, eq=False)
class DryGap:
    """Gaps of dry elliptic contacts, in arrays of one shape; lengths in metres.

    Attributes
    ----------
    radius_x, radius_y : ndarray
        Radii of relative curvature, along rolling and across.
    a, b : ndarray
        Semi-axes of the contact along them; of unloaded bodies 0: a gap that is a paraboloid.
    approach : ndarray
    """

    radius_x: Array
    radius_y: Array
    a: Array
    b: Array
    approach: Array

    @classmethod
    def under(cls, load: ArrayLike, unit_pressure: ArrayLike, radius_x: ArrayLike, radius_y: ArrayLike) -> DryGap:
        """Of loads [N], by the Hertz pressure of 1 N [Pa]."""
        given = (np.asarray(value, float) for value in (load, unit_pressure, radius_x, radius_y))
        force, unit, rx, ry = np.broadcast_arrays(*given)
        ratios, which = np.unique(rx / ry, return_inverse=True)
        kappa = np.array([ellipse_ratio(ratio, 1.0) for ratio in ratios.tolist()])[which].reshape(force.shape)
        K, E = scipy.special.ellipk(1.0 - kappa**2), scipy.special.ellipe(1.0 - kappa**2)
        area = 1.5 / (pi * unit) * np.maximum(force, 0.0) ** (2.0 / 3.0)
        a = np.sqrt(area * kappa)
        return cls(rx, ry, a, a / kappa, a * a * K * (1.0 / rx + 1.0 / ry) / (2.0 * E))

    def at(self, x: Array, y: Array) -> Array:
        """Gap outside the contact ellipse [m]."""
        a2, b2 = self.a**2, self.b**2
        square = x * x + y * y - a2 - b2
        outside = 0.5 * (square + np.sqrt(square * square + 4.0 * (x * x * b2 + y * y * a2 - a2 * b2)))
        return self.on_ellipse(np.maximum(outside, 0.0), x * x, y * y)

    def on_ellipse(self, outside: Array, x2: Array, y2: Array) -> Array:
        """Gap [m] at squared places [m2] on a confocal ellipse, its squared semi-axes larger by `outside` [m2]."""
        whole, along, across = _integrals(self.a**2 + outside, self.b**2 + outside, outside)
        kappa = np.divide(self.a, self.b, out=np.ones(self.a.shape), where=self.b > 0.0)
        K = scipy.special.ellipk(1.0 - kappa**2)
        deflection = (whole - x2 * along - y2 * across) * self.b / (2.0 * K)  # over that in the middle
        rigid = 0.5 * (x2 / self.radius_x + y2 / self.radius_y)
        return np.asarray(np.maximum(rigid - self.approach * (1.0 - deflection), 0.0))

    def __getitem__(self, which: Any) -> DryGap:
        """Some of them."""
        return DryGap(*(value[which] for value in self._values))

    def reshaped(self, *shape: int) -> DryGap:
        """Arrays of another shape."""
        return DryGap(*(value.reshape(shape) for value in self._values))

    @property
    def _values(self) -> tuple[Array, ...]:
        return self.radius_x, self.radius_y, self.a, self.b, self.approach


def _integrals(x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """Integrals over s from 0 of 1, 1/(x + s), 1/(y + s), over sqrt((x + s)(y + s)(z + s)).

    They are 2 R_F(x, y, z) and 2/3 R_D of these with x and y last, by doublings of all three together (Carlson,
    Numer. Algorithms 10 (1995) 13). The deflection outside an ellipse is made of them (Johnson, Contact Mechanics,
    eq. 3.56).
    """
    sums, share = [np.zeros_like(x), np.zeros_like(x)], 1.0
    for _ in range(DOUBLINGS):
        rx, ry, rz = np.sqrt(x), np.sqrt(y), np.sqrt(z)
        step = rx * (ry + rz) + ry * rz
        sums[0] += share / (rx * (x + step))
        sums[1] += share / (ry * (y + step))
        x, y, z, share = 0.25 * (x + step), 0.25 * (y + step), 0.25 * (z + step), 0.25 * share
    mean = (x + y + z) / 3.0
    X, Y = 1.0 - x / mean, 1.0 - y / mean
    e2, e3 = X * Y - (X + Y) ** 2, -X * Y * (X + Y)
    first = 2.0 * (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / np.sqrt(mean)
    return first, 2.0 * (sums[0] + share * _last(y, z, x) / 3.0), 2.0 * (sums[1] + share * _last(x, z, y) / 3.0)


def _last(x: Array, y: Array, z: Array) -> Array:
    """R_D(x, y, z) of arguments that hardly differ."""
    mean = (x + y + 3.0 * z) / 5.0
    X, Y = 1.0 - x / mean, 1.0 - y / mean
    Z, both = -(X + Y) / 3.0, X * Y
    e2, e3 = both - 6.0 * Z * Z, (3.0 * both - 8.0 * Z * Z) * Z
    e4, e5 = 3.0 * (both - Z * Z) * Z * Z, both * Z * Z * Z
    series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
    return np.asarray((series + 3.0 * e5 / 26.0) / (mean * np.sqrt(mean)))


@dataclass(frozen=True, kw_only=True)
class GapCapacitance:
    """Capacitance of contacts by parts [F], arrays of the shape of the gaps.

    Attributes
    ----------
    hertz_zone : ndarray
        Under the contact ellipse.
    track : ndarray
        Behind it, where the oil that passed the narrowest gap stands on the surfaces.
    surroundings : ndarray
        Ahead of it and beside it, up to the edge of the ball.
    least, largest : ndarray
        With air in place of oil elsewhere than under the ellipse, except for the oil on the track; and with oil
        everywhere.
    """

    hertz_zone: Array
    track: Array
    surroundings: Array
    least: Array
    largest: Array

    @property
    def total(self) -> Array:
        """All parts together [F]."""
        return self.hertz_zone + self.track + self.surroundings


def hertz_capacitance(
    gap: DryGap,
    film: ArrayLike,
    permittivity: float = OIL,
    surroundings: float | None = None,
    reach: ArrayLike | None = None,
) -> GapCapacitance:
    """Capacitance of dry contacts that a film of one thickness each separates.

    Within some 1e-6 of finer quadrature, within 1e-5 where the approach is thousands of films.

    Parameters
    ----------
    gap : DryGap
        Of contacts, arrays of any shape.
    film : float or ndarray
        Central film [m]; of unloaded bodies their smallest gap.
    permittivity : float
        Of the oil, relative.
    surroundings : float, optional
        Permittivity of what fills the gap elsewhere; the oil by default.
    reach : float or ndarray, optional
        Radius [m] up to which the bodies face each other; by default the smaller radius of relative curvature.

    Returns
    -------
    GapCapacitance

    Raises
    ------
    InputError
        A film that is not positive.
    """
    h = np.broadcast_to(np.asarray(film, float), gap.a.shape)
    if not np.all(np.isfinite(h) & (h > 0.0)):
        raise InputError("film", film, "positive and finite")
    beyond = permittivity if surroundings is None else surroundings
    edge = np.broadcast_to(np.minimum(gap.radius_x, gap.radius_y) if reach is None else reach, gap.a.shape)
    flat, films, ends, shape = gap.reshaped(-1), h.reshape(-1), edge.reshape(-1), gap.a.shape
    slices = [slice(k, k + AT_ONCE) for k in range(0, flat.a.size, AT_ONCE)]
    parts = [_outside(flat[some], films[some], permittivity, ends[some]) for some in slices]
    layers, everywhere = (EPS0 * np.concatenate(part).reshape(shape) for part in zip(*parts, strict=True))
    zone = permittivity * EPS0 * pi * gap.a * gap.b / h
    return GapCapacitance(
        hertz_zone=zone,
        track=layers,
        surroundings=beyond * everywhere,
        least=zone + layers + everywhere,
        largest=zone + 2.0 * permittivity * everywhere,
    )


def _outside(gap: DryGap, film: Array, permittivity: float, reach: Array) -> tuple[Array, Array]:
    """Integrals of the inverse of layers of oil and vacuum, and of the gap, over half of what is outside [m]."""
    own = gap.reshaped(-1, 1, 1)
    h = film[:, None, None]
    phi = 0.25 * pi * (_ANGLES + 1.0)
    cosine2, sine2 = np.cos(phi) ** 2, np.sin(phi) ** 2
    a2, b2 = own.a**2, own.b**2
    edge = (reach**2)[:, None, None] - a2 * cosine2 - b2 * sine2
    # ellipses are fine where the gap is that of a film wider than under the contact
    relative = np.divide(h, own.approach, out=np.zeros(h.shape), where=own.approach > 0.0)
    wide = 2.0 * h / (1.0 / own.radius_x + 1.0 / own.radius_y) + own.a * own.b * relative ** (2.0 / 3.0)
    last = np.sqrt(np.log1p(edge / wide))
    w = 0.5 * (_PLACES + 1.0)[:, None] * last
    outside = wide * np.expm1(w * w)
    x2, y2 = (a2 + outside) * cosine2, (b2 + outside) * sine2
    area = 0.5 * ((a2 + outside) * sine2 + (b2 + outside) * cosine2) / np.sqrt((a2 + outside) * (b2 + outside))
    weight = area * (outside + wide) * w * _PARTS[:, None] * last * (0.25 * pi * _WEIGHTS)
    height = h + own.on_ellipse(outside, x2, y2)
    beside = np.maximum(y2 - b2, 0.0)  # of the contact: places on its line across, at which the gap is not 0
    passed = h + np.where(beside > 0.0, own.on_ellipse(beside, np.zeros_like(y2), b2 + beside), 0.0)
    oil = np.minimum(passed, height)  # what leaves the contact at this place across it
    layers = weight / (oil / permittivity + (height - oil))
    return 2.0 * layers.sum(axis=(1, 2)), 2.0 * (weight / height).sum(axis=(1, 2))
