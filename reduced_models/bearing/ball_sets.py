"""Balls that fit the load ratings of a bearing: the search of `geometry_from_ratings`.

ISO 76 and ISO 281 define both ratings by the balls, lengths in mm, ratings in N:

    C0 = f0 Z Dw^2 cos a,    C = 1.3 fc (cos a)^0.7 Z^(2/3) Dw^1.8,    fc and f0 of Dw cos a/Dpw.

Z is whole, Dw a multiple of 1/64 inch or of 0.5 mm, and Dpw near the mean of bore and outside diameter. f0 and C0
are those of 4.2 GPa at the most loaded ball, with the 207 GPa of ISO/TR 10657.

The ratings of the standards are for grooves of 0.52. A maker may rate those that it grinds: by them

    C is proportional to (2 f/(2 f - 1))^0.41, C0 to the load under which such a contact has 4.2 GPa,

which is about C^1.5 whatever the conformity f. GMN's ratings are such: C is 11 % below to 9 % above that of the
standards and C0 15 % below to 14 % above, by the size of the ball. C^1.5/C0 then gives the ball diameter without
f, and the number of balls goes with f.

Deep groove bearings still have one answer. Their balls are put in beside the eccentric inner ring: they take 177
to 201 degrees of the circle in this catalogue, some 190. The number in angular contact bearings is open unless f
is given.
"""

from __future__ import annotations

from math import asin, cos, degrees, pi
from typing import NamedTuple

import numpy as np

from ehlcontact import Geometry
from ehlcontact.hertz import hertz_contact
from reduced_models.bearing.catalogue import INCH, USUAL_CONFORMITY
from reduced_models.bearing.race import RACES
from reduced_models.life.internal_geometry import InternalGeometry
from reduced_models.life.load_ratings import dynamic_rating as rated_dynamic
from reduced_models.life.load_ratings import static_rating as rated_static

RATED_MODULUS = 207e9  # Pa, of ISO/TR 10657
STEEL_DENSITY = 7800.0  # kg/m3
STEPS = (INCH / 64.0, 0.5e-3)  # m, of ball diameters
SAME_STEP = 1e-3  # of a step: diameters are rounded
SECTION = (0.3, 0.72)  # ball over half the difference of both diameters: rings of 14 % of it under their grooves
# degrees between the first and the last ball of a deep groove bearing: least, usual and largest
FEWEST, FILLED, MOST_FILLED = 170.0, 190.0, 205.0
SPREAD, USUAL_MISFIT = 5.0, 0.005  # standard deviations: of that angle in degrees, of printed ratings
LEAST_BALLS, MOST_BALLS = 5, 60
GROOVE_POWER = 0.41  # of 2 f/(2 f - 1) in C
STATIC_POWER = 1.5  # of C in C0, over conformities
F0_TOLERANCE = 0.02  # of printed values, which makers round and read from tables


class BallSet(NamedTuple):
    """Balls that fit the ratings.

    Attributes
    ----------
    balls : int
    ball_diameter : float
        In m.
    misfit : float
        Largest relative difference of their C, C0 and f0 from those that are given.
    conformity : float
        Groove radius over ball diameter for which the ratings are: 0.52 of the standards, or the maker's own.
    """

    balls: int
    ball_diameter: float
    misfit: float
    conformity: float = USUAL_CONFORMITY


def mean_diameter(bore: float, outside: float) -> float:
    """Mean of bore and outside diameter, near which the pitch diameter is [m]."""
    return 0.5 * (bore + outside)


def sets_for_conformity(
    bore: float,
    outside: float,
    contact_angle: float | None,
    printed: tuple[float, float, float | None],
    excess: float,
    grooves: float,
) -> list[BallSet]:
    """All balls with room between the rings and beside each other, the best first; printed are C, C0 and f0."""
    dynamic, static, f0 = printed
    pitch, angle = mean_diameter(bore, outside), contact_angle or 0.0
    sets = []
    for diameter in _diameters(bore, outside):
        one = rated_balls(1, diameter, pitch, angle, grooves)
        c, c0 = rated_dynamic(rated_balls(1, diameter, pitch, angle)) * _groove_factor(grooves), rated_static(one)
        factor = c0 / (1e6 * diameter**2 * cos(angle))
        if f0 is not None:
            if abs(factor / f0 - 1.0) > F0_TOLERANCE:
                continue
            c0 *= f0 / factor
        for number in range(LEAST_BALLS, _most_balls(diameter, pitch, contact_angle) + 1):
            own = number ** (2.0 / 3.0) * c
            nearest = min(max(dynamic / (1.0 + excess), own), dynamic)  # of what C by ISO 281 may be
            misfit = max(abs(number * c0 / static - 1.0), abs(own / nearest - 1.0))
            sets.append(BallSet(number, diameter, misfit, grooves))
    return sorted(sets, key=lambda balls: balls.misfit)


def sets_for_conformities(
    bore: float,
    outside: float,
    contact_angle: float | None,
    printed: tuple[float, float, float | None],
    tolerance: float,
    interval: tuple[float, float],
) -> list[BallSet]:
    """Balls of inch sizes with the conformity of an interval for which C and C0 fit, the likeliest first."""
    dynamic, static, f0 = printed
    pitch, angle = mean_diameter(bore, outside), contact_angle or 0.0
    sets: list[tuple[float, BallSet]] = []
    for diameter in filter(is_inch, _diameters(bore, outside)):
        usual = rated_balls(1, diameter, pitch, angle)
        for number in range(LEAST_BALLS, _most_balls(diameter, pitch, contact_angle) + 1):
            share = dynamic / (number ** (2.0 / 3.0) * rated_dynamic(usual))
            for _ in range(2):  # first C is met; then C and C0 have a share of the misfit each
                grooves = _conformity_of(share)
                if not interval[0] <= grooves <= interval[1]:
                    break
                c = share * number ** (2.0 / 3.0) * rated_dynamic(usual)
                c0 = number * rated_static(rated_balls(1, diameter, pitch, angle, grooves))
                misfit = max(abs(c / dynamic - 1.0), abs(c0 / static - 1.0))
                share *= (static / c0) ** (1.0 / (1.0 + STATIC_POWER))
            else:
                factor = c0 / (1e6 * number * diameter**2 * cos(angle))
                if misfit <= tolerance and (f0 is None or abs(factor / f0 - 1.0) <= F0_TOLERANCE):
                    balls = BallSet(number, diameter, misfit, grooves)
                    sets.append((_unlikeness(balls, pitch, contact_angle), balls))
    return [balls for _, balls in sorted(sets, key=lambda one: one[0])]


def _most_balls(diameter: float, pitch: float, contact_angle: float | None) -> int:
    """How many balls go in; deep groove bearings are filled beside the eccentric inner ring."""
    half = asin(diameter / pitch)
    most = int(min(MOST_BALLS, np.ceil(pi / half) - 1))
    return most if contact_angle is not None else min(most, 1 + int(np.radians(MOST_FILLED) / (2.0 * half)))


def filling(number: int, diameter: float, pitch: float) -> float:
    """Angle between the first and the last of balls that touch each other [degrees]."""
    return degrees(2.0 * (number - 1) * asin(diameter / pitch))


def _unlikeness(balls: BallSet, pitch: float, contact_angle: float | None) -> float:
    """How far balls are from usual ones: squares of angle and misfit over their spread, or of the conformity."""
    if contact_angle is not None:
        return abs(balls.conformity - USUAL_CONFORMITY)
    return ((filling(*balls[:2], pitch) - FILLED) / SPREAD) ** 2 + (balls.misfit / USUAL_MISFIT) ** 2


def _groove_factor(conformity: float) -> float:
    """C in grooves of this conformity over that in grooves of the standards."""
    usual = 2.0 * USUAL_CONFORMITY / (2.0 * USUAL_CONFORMITY - 1.0)
    return float((2.0 * conformity / (2.0 * conformity - 1.0) / usual) ** GROOVE_POWER)


def _conformity_of(factor: float) -> float:
    """Conformity with this `_groove_factor`."""
    usual = 2.0 * USUAL_CONFORMITY / (2.0 * USUAL_CONFORMITY - 1.0)
    ratio = usual * factor ** (1.0 / GROOVE_POWER)
    return float(ratio / (2.0 * (ratio - 1.0)))


def is_inch(diameter: float) -> bool:
    """Whether a ball has a multiple of 1/64 inch."""
    return abs(diameter / STEPS[0] - round(diameter / STEPS[0])) < SAME_STEP


def _diameters(bore: float, outside: float) -> list[float]:
    """Multiples of both steps that leave room for both rings [m], to a micrometre of the inch sizes as printed."""
    section = 0.5 * (outside - bore)
    low, high = (share * section for share in SECTION)
    found = {
        round(k * step, 7) for step in STEPS for k in range(max(1, int(np.ceil(low / step))), int(high / step) + 1)
    }
    return sorted(found)


def rated_balls(
    balls: int, diameter: float, pitch: float, angle: float, conformity: float = USUAL_CONFORMITY
) -> InternalGeometry:
    """Balls in grooves as the standards rate them."""
    pressures = []
    for race in RACES:
        material = {"e1": RATED_MODULUS, "e2": RATED_MODULUS, "nu1": 0.3, "nu2": 0.3}
        body = Geometry.ball_bearing(diameter, pitch / cos(angle), conformity, race, **material)
        pressures.append(float(hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure))
    return InternalGeometry(
        name="",
        balls=balls,
        ball_diameter=diameter,
        pitch_diameter=pitch,
        conformity_inner=conformity,
        conformity_outer=conformity,
        contact_angle=angle,
        unit_pressures=(pressures[0], pressures[1]),
        ball_density=STEEL_DENSITY,
    )
