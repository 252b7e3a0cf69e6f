"""Rings on their seats: thick cylinders that press each other, grow by it, and turn.

Rings, shaft and housing are thick cylinders in plane stress, rings up to the bottoms of their grooves (Lame;
Timoshenko and Goodier, Theory of Elasticity, sections 28 and 32). At the seat of a ring on its shaft

    I = p d [ (D2 + d2)/(D2 - d2)/Er + nur/Er + (d2 + b2)/(d2 - b2)/Es - nus/Es ],

with interference I and pressure p, bore d and groove diameter D of the ring, bore b of the shaft, and squares d2;
the groove grows by 2 p d2 D/(Er (D2 - d2)). A ring that turns is wider at radius r, between a and b, by

    u = rho omega^2 (3 + nu)(1 - nu)/(8 E) r [a^2 + b^2 - (1 + nu)/(3 + nu) r^2 + (1 + nu)/(1 - nu) a^2 b^2/r^2].
"""

from __future__ import annotations

from math import cos, inf, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.catalogue import ROWS
from reduced_models.bearing.tolerances import outside_of

_Floats = NDArray[np.float64]


class Material(NamedTuple):
    """Elasticity, density and expansion of a ring, a shaft or a housing."""

    youngs_modulus: float  # Pa
    poisson_ratio: float
    density: float  # kg/m3
    expansion: float  # 1/K


MATERIALS = {
    "steel": Material(2.06e11, 0.3, 7800.0, 11.5e-6),
    "bearing steel": Material(2.06e11, 0.3, 7800.0, 12.5e-6),
    "stainless steel": Material(2.0e11, 0.3, 7900.0, 16.0e-6),
    "cast iron": Material(1.1e11, 0.26, 7200.0, 10.5e-6),
    "aluminium": Material(7.0e10, 0.33, 2700.0, 23.5e-6),
    "silicon nitride": Material(3.1e11, 0.27, 3200.0, 3.2e-6),
}


class Seats(NamedTuple):
    """Diameters [m]: bores of shaft and bearing, grooves, outside of bearing and housing."""

    b: float
    d: float
    groove_inner: float
    groove_outer: float
    D: float
    housing: float

    @classmethod
    def of(
        cls,
        bearing: BallBearing,
        bore: float | None,
        outside: float | None,
        hollow: float,
        housing: float | None,
        needs: tuple[bool, bool],
    ) -> Seats:
        """Of a bearing; nan where bore or outside diameter is not known and `needs` not."""
        row = ROWS.get(bearing.name)
        d = bore if bore is not None else None if row is None else row.bore
        D = outside if outside is not None else outside_of(bearing.name, d)
        for name, value, needed in (("bore", d, needs[0]), ("outside", D, needs[1])):
            if value is None and needed:
                allowed = "given in metres: that of this bearing is not known, and fits need it"
                raise InputError(name, None, allowed)
        inner, outer = groove_bottoms(bearing)
        if d is not None and not d < inner:
            raise InputError("bore", d, f"below {inner:.5g} m, the diameter of the inner groove")
        if D is not None and not D > outer:
            raise InputError("outside", D, f"above {outer:.5g} m, the diameter of the outer groove")
        if d is not None and not hollow < d:
            raise InputError("shaft_bore", hollow, f"below {d:.5g} m, the bore of the bearing")
        if D is not None and housing is not None and not housing > D:
            raise InputError("housing_outside", housing, f"above {D:.5g} m, the outside diameter of the bearing")
        return cls(
            hollow, nan if d is None else d, inner, outer, nan if D is None else D, housing if housing else inf
        )


def groove_bottoms(bearing: BallBearing) -> tuple[float, float]:
    """Diameters of the bottoms of the inner and the outer groove [m]; less two balls they leave the clearance.

    Balls on the pitch circle touch both grooves at the contact angle; centres of grooves lie off their bottoms.
    """
    ball, cosine = bearing.ball_diameter, cos(bearing.contact_angle or 0.0)
    inner, outer = bearing.conformity_inner, bearing.conformity_outer
    return (
        bearing.pitch_diameter + ball * ((2.0 * inner - 1.0) * cosine - 2.0 * inner),
        bearing.pitch_diameter - ball * ((2.0 * outer - 1.0) * cosine - 2.0 * outer),
    )


def spinning(material: Material, a: float, b: float, r: float, omega: float) -> float:
    """Displacement [m] at radius r of a disc from radius a (0: solid) to b that turns [rad/s]."""
    E, nu, rho = material.youngs_modulus, material.poisson_ratio, material.density
    hole = (1.0 + nu) / (1.0 - nu) * a**2 * b**2 / r**2
    shape = a**2 + b**2 - (1.0 + nu) / (3.0 + nu) * r**2 + hole
    return rho * omega**2 * (3.0 + nu) * (1.0 - nu) / (8.0 * E) * r * shape


def opened(ring: Material, shaft: Material, seat: Seats, omega: float) -> float:
    """By how much rotation [rad/s] opens the seat of the inner ring, in diameter [m]."""
    at = 0.5 * seat.d
    own = spinning(ring, at, 0.5 * seat.groove_inner, at, omega)
    return 2.0 * (own - spinning(shaft, 0.5 * seat.b, at, at, omega))


def inner_ring(overlap: _Floats, seat: Seats, ring: Material, shaft: Material) -> tuple[_Floats, _Floats]:
    """Pressure on the seat of the inner ring, and growth of its groove."""
    bore2, groove2, hole2 = seat.d**2, seat.groove_inner**2, seat.b**2
    yielding = ((groove2 + bore2) / (groove2 - bore2) + ring.poisson_ratio) / ring.youngs_modulus
    yielding += ((bore2 + hole2) / (bore2 - hole2) - shaft.poisson_ratio) / shaft.youngs_modulus
    pressure = overlap / (seat.d * yielding)
    return pressure, 2.0 * pressure * bore2 * seat.groove_inner / (ring.youngs_modulus * (groove2 - bore2))


def outer_ring(overlap: _Floats, seat: Seats, ring: Material, housing: Material) -> tuple[_Floats, _Floats]:
    """Pressure on the seat of the outer ring, and shrinkage of its groove."""
    outside2, groove2, block2 = seat.D**2, seat.groove_outer**2, seat.housing**2
    thick = 1.0 if seat.housing == inf else (block2 + outside2) / (block2 - outside2)
    yielding = (thick + housing.poisson_ratio) / housing.youngs_modulus
    yielding += ((outside2 + groove2) / (outside2 - groove2) - ring.poisson_ratio) / ring.youngs_modulus
    pressure = overlap / (seat.D * yielding)
    return pressure, 2.0 * pressure * outside2 * seat.groove_outer / (ring.youngs_modulus * (outside2 - groove2))


def interferences(first: tuple[float, float], second: tuple[float, float]) -> _Floats:
    """First less second deviation: greatest, mean and least."""
    return np.array([first[1] - second[0], 0.5 * (sum(first) - sum(second)), first[0] - second[1]])
