"""Equivalent loads of ball bearings with the factors X and Y, and the least load against skidding.

ISO 281:2007, table 3: P = Fr while Fa/Fr <= e, else X Fr + Y Fa. Bearings up to 15 degrees have e and Y over the
relative axial load Fa/(Z Dw^2) in N and mm, which of deep-groove bearings is f0 Fa/C0; steeper ones have
constants. Between tabulated loads and angles values are interpolated.

ISO 76: P0 = X0 Fr + Y0 Fa, at least Fr.

SKF, Rolling Bearings: balls of a deep-groove bearing may skid under less than kr (nu n/1000)^(2/3) (dm/100)^2 kN,
in mm2/s, rev/min and mm, with dm the mean of bore and outside diameter.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import NamedTuple

import numpy as np

RELATIVE = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)  # axial loads of the table
# (angle, X, e, Y) of deep-groove bearings, and of angular contact bearings of 10 and 15 degrees
BY_LOAD = (
    (
        5.0, 0.56,
        (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44),
        (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00),
    ),
    (
        10.0, 0.46,
        (0.29, 0.32, 0.36, 0.38, 0.40, 0.44, 0.49, 0.54, 0.54),
        (1.88, 1.71, 1.52, 1.41, 1.34, 1.23, 1.10, 1.01, 1.00),
    ),
    (
        15.0, 0.44,
        (0.38, 0.40, 0.43, 0.46, 0.47, 0.50, 0.55, 0.56, 0.56),
        (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00),
    ),
)  # fmt: skip
BY_ANGLE = {  # degrees: X, e, Y
    20.0: (0.43, 0.57, 1.00), 25.0: (0.41, 0.68, 0.87), 30.0: (0.39, 0.80, 0.76), 35.0: (0.37, 0.95, 0.66),
    40.0: (0.35, 1.14, 0.57), 45.0: (0.33, 1.34, 0.50),
}  # fmt: skip
STATIC = {  # degrees: X0, Y0 of ISO 76; 0 is a deep-groove bearing
    0.0: (0.6, 0.5), 5.0: (0.5, 0.52), 10.0: (0.5, 0.50), 15.0: (0.5, 0.46), 20.0: (0.5, 0.42), 25.0: (0.5, 0.38),
    30.0: (0.5, 0.33), 35.0: (0.5, 0.29), 40.0: (0.5, 0.26), 45.0: (0.5, 0.22),
}  # fmt: skip


class AxialFactors(NamedTuple):
    """Factors X and Y of loads above Fa/Fr = e."""

    x: float
    e: float
    y: float


@dataclass(frozen=True)
class LeastLoad:
    """Constants of SKF's least load of a series of deep-groove bearings.

    Attributes
    ----------
    factor : float
        kr.
    mean_diameter : float
        Of bore and outside diameter [m].
    """

    factor: float
    mean_diameter: float

    def at(self, speed_rpm: float, kinematic_viscosity: float) -> float:
        """Least radial load [N] at a speed [rev/min] in an oil of a viscosity [m2/s]."""
        flow = (1e6 * kinematic_viscosity * speed_rpm / 1000.0) ** (2.0 / 3.0)
        return 1e3 * self.factor * flow * (1e3 * self.mean_diameter / 100.0) ** 2


def axial_factors(contact_angle: float, relative_load: float) -> AxialFactors:
    """Factors of a bearing with a nominal contact angle [rad] under a relative axial load Fa/(Z Dw^2) [N/mm2]."""
    angle = degrees(contact_angle)
    rows = [
        (of, x, float(np.interp(relative_load, RELATIVE, e)), float(np.interp(relative_load, RELATIVE, y)))
        for of, x, e, y in BY_LOAD
    ]
    rows += [(of, *factors) for of, factors in BY_ANGLE.items()]
    angles, *columns = map(list, zip(*rows, strict=True))
    x, e, y = (float(np.interp(angle, angles, column)) for column in columns)
    return AxialFactors(x, e, y)


def dynamic_load(radial: float, axial: float, *, contact_angle: float, balls: int, ball_diameter: float) -> float:
    """Equivalent dynamic radial load P [N] of a radial and an axial load [N]; angle in rad, diameter in m."""
    factors = axial_factors(contact_angle, axial / (balls * (1e3 * ball_diameter) ** 2))
    return radial if axial <= factors.e * radial else factors.x * radial + factors.y * axial


def static_load(radial: float, axial: float, contact_angle: float) -> float:
    """Equivalent static radial load P0 [N] of a bearing with a nominal contact angle [rad]."""
    angles = list(STATIC)
    x0, y0 = (
        float(np.interp(degrees(contact_angle), angles, column)) for column in zip(*STATIC.values(), strict=True)
    )
    return max(x0 * radial + y0 * axial, radial)
