"""Capacitance between the two bodies of a contact: gaps with oil, as plates that face each other across them.

A gap g in which oil of the thickness t stands, permittivity e, and vapour or air elsewhere, has per area

    eps0 / (t/e + (g - t)).

The surroundings of a film are integrated along rays from its middle to the edge of the ball. Of a film that was
not solved, as those of an element, the gap is that of the dry contact with a film of one thickness under all of
it: `hertz_capacitance`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_positive
from ehlcontact.errors import InputError
from ehlcontact.hertz import ellipse_ratio, elliptic_integrals

Array = NDArray[np.float64]

EPS0 = 8.8541878128e-12  # F/m
OIL = 2.2  # permittivity of mineral and hydrocarbon oils, 2.0 to 2.5
LARGEST = 100.0  # permittivity: that of water is 80
RAYS, PLACES = 24, 48  # of a quadrant; along each of them
_ANGLES, _WEIGHTS = leggauss(RAYS)
_PLACES, _PARTS = leggauss(PLACES)


def require_permittivity(name: str, value: float) -> float:
    """Return a relative permittivity; raises `InputError` for one below 1, and for one in F/m."""
    given = require_finite(name, value)
    if not 1.0 <= given <= LARGEST:
        guess = f" (in F/m? then {given / EPS0:.3g})" if 1e-12 < given < 1e-9 else ""
        raise InputError(name, value, f"relative to vacuum, between 1 and {LARGEST:g}{guess}")
    return given


@dataclass(frozen=True)
class DryGap:
    """Gap of a dry elliptic contact: semi-axes a along rolling, b across, radii and approach [m].

    Unloaded bodies have a = b = 0: a gap that is a paraboloid.
    """

    radius_x: float
    radius_y: float
    a: float
    b: float
    approach: float

    @classmethod
    def under(cls, load: float, unit_pressure: float, radius_x: float, radius_y: float) -> DryGap:
        """Of a load [N], by the Hertz pressure of 1 N [Pa]."""
        if load <= 0.0:
            return cls(radius_x, radius_y, 0.0, 0.0, 0.0)
        kappa = ellipse_ratio(radius_x, radius_y)
        K, E = elliptic_integrals(kappa)
        area = 1.5 / (pi * unit_pressure) * load ** (2.0 / 3.0)
        a = (area * kappa) ** 0.5
        return cls(radius_x, radius_y, a, a / kappa, a * a * K * (1.0 / radius_x + 1.0 / radius_y) / (2.0 * E))

    def at(self, x: Array, y: Array) -> Array:
        """Gap outside the contact ellipse [m]."""
        rigid = 0.5 * (x * x / self.radius_x + y * y / self.radius_y)
        return rigid if self.a == 0.0 else rigid - self.approach * (1.0 - self._deflection(x, y))

    def _deflection(self, x: Array, y: Array) -> Array:
        """Elastic deflection over that in the middle (Johnson, Contact Mechanics, eq. 3.56)."""
        a2, b2 = self.a**2, self.b**2
        square = x * x + y * y - a2 - b2
        start = 0.5 * (square + np.sqrt(square * square + 4.0 * (x * x * b2 + y * y * a2 - a2 * b2)))
        # l = start + scale (v/(1 - v))^2: the integrand is smooth in v from 0 to 1
        scale = np.maximum(start, self.a * self.b)[..., None]
        v = 0.5 * (_PLACES + 1.0)
        out = (v / (1.0 - v)) ** 2
        measure = 0.5 * _PARTS * 2.0 * v / (1.0 - v) ** 3

        first = np.maximum(start, 1e-14 * a2)[..., None] + scale * out
        root = np.sqrt((a2 + first) * (b2 + first) * first)
        value = (1.0 - (x * x)[..., None] / (a2 + first) - (y * y)[..., None] / (b2 + first)) / root
        K, _ = elliptic_integrals(self.a / self.b)
        return np.asarray((value * measure * scale).sum(axis=-1)) * self.b / (2.0 * K)  # over that in the middle


@dataclass(frozen=True, kw_only=True)
class GapCapacitance:
    """Capacitance of a contact by parts [F].

    Attributes
    ----------
    hertz_zone : float
        Under the contact ellipse.
    track : float
        Behind it, where the oil that passed the narrowest gap stands on the surfaces.
    surroundings : float
        Ahead of it and beside it, up to the edge of the ball.
    least, largest : float
        With air in place of oil elsewhere than under the ellipse, except for the oil on the track; and with oil
        everywhere.
    """

    hertz_zone: float
    track: float
    surroundings: float
    least: float
    largest: float

    @property
    def total(self) -> float:
        """All parts together [F]."""
        return self.hertz_zone + self.track + self.surroundings


def hertz_capacitance(
    gap: DryGap,
    film: float,
    permittivity: float = OIL,
    surroundings: float | None = None,
    reach: float | None = None,
) -> GapCapacitance:
    """Capacitance of a dry contact that a film of one thickness separates.

    Parameters
    ----------
    gap : DryGap
    film : float
        Central film [m]; of unloaded bodies their smallest gap.
    permittivity : float
        Of the oil, relative.
    surroundings : float, optional
        Permittivity of what fills the gap elsewhere; the oil by default.
    reach : float, optional
        Radius [m] up to which the bodies face each other; by default the smaller radius of relative curvature.

    Returns
    -------
    GapCapacitance
    """
    h = require_positive("film", film)
    beyond = permittivity if surroundings is None else surroundings
    edge = min(gap.radius_x, gap.radius_y) if reach is None else reach
    phi = 0.25 * pi * (_ANGLES + 1.0)
    cosine, sine = np.cos(phi), np.sin(phi)
    inner = np.zeros_like(phi)
    if gap.a > 0.0:
        inner = 1.0 / np.hypot(cosine / gap.a, sine / gap.b)
    # r = inner + (edge - inner) v^4: fine where the gap opens
    v = 0.5 * (_PLACES + 1.0)
    r = inner[:, None] + (edge - inner)[:, None] * v**4
    weight = (0.25 * pi * _WEIGHTS)[:, None] * (0.5 * _PARTS * 4.0 * v**3) * (edge - inner)[:, None] * r
    x, y = r * cosine[:, None], r * sine[:, None]
    height = h + np.maximum(gap.at(x, y), 0.0)
    everywhere = EPS0 * weight / height
    passed = h + np.where(y > gap.b, np.maximum(gap.at(np.zeros_like(y), np.maximum(y, gap.b)), 0.0), 0.0)
    oil = np.minimum(passed, height)  # what leaves the contact at this place across it
    layers = EPS0 * weight / (oil / permittivity + (height - oil))
    track = 2.0 * float(layers.sum())
    rest = 2.0 * float(everywhere.sum())
    zone = permittivity * EPS0 * pi * gap.a * gap.b / h
    full = 4.0 * float(everywhere.sum())
    return GapCapacitance(
        hertz_zone=zone,
        track=track,
        surroundings=beyond * rest,
        least=zone + track + rest,
        largest=zone + permittivity * full,
    )
