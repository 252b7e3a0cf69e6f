"""`geometry_from_ratings`: balls of a bearing estimated from the load ratings that its maker prints.

ISO 76 and ISO 281 define both ratings by the balls, lengths in mm, ratings in N:

    C0 = f0 Z Dw^2 cos a,    C = 1.3 fc (cos a)^0.7 Z^(2/3) Dw^1.8,    fc and f0 of Dw cos a/Dpw.

Z is whole, Dw a multiple of 1/64 inch or of 0.5 mm, and Dpw near the mean of bore and outside diameter. Few pairs
of Z and Dw then fit both ratings: these are the `candidates`. The best of them is the estimate, their ends are its
interval. Inch sizes come first, for all balls of the catalogue have them. A printed f0, which depends on Dw/Dpw
alone, makes the interval of Dw smaller.

f0 and C0 are those of 4.2 GPa at the most loaded ball, in grooves of 0.52, with the 207 GPa of ISO/TR 10657.

The ratings of the standards are for grooves of 0.52. A maker may print others: GMN's are up to 11 % below and 9 %
above (C), 15 % below and 14 % above (C0), by the size of the ball. The search then finds other balls or none: its
interval holds for ratings of the standards. Many makers print a C that is higher by some per cent for their steel,
NSK in newer tables 5 %, with a C0 of the standard: that is `dynamic_excess`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, degrees, pi
from typing import Any, NamedTuple

import numpy as np

from ehlcontact import Geometry
from ehlcontact.checks import parts, require_between
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.hertz import hertz_contact
from ehlcontact.summary import Summary, counted, note_line
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.catalogue import INCH, USUAL_CONFORMITY
from reduced_models.bearing.clearance import clearance_of_class
from reduced_models.bearing.grooves import require_contact_angle
from reduced_models.bearing.race import RACES
from reduced_models.life.internal_geometry import InternalGeometry
from reduced_models.life.load_ratings import dynamic_rating as rated_dynamic
from reduced_models.life.load_ratings import grouped, require_rating
from reduced_models.life.load_ratings import static_rating as rated_static

RATED_MODULUS = 207e9  # Pa, of ISO/TR 10657
STEEL_DENSITY = 7800.0  # kg/m3
STEPS = (INCH / 64.0, 0.5e-3)  # m, of ball diameters
SAME_STEP = 1e-3  # of a step: diameters are rounded
SECTION = (0.3, 0.72)  # ball over half the difference of both diameters: rings of 14 % of it under their grooves
FILLED = 205.0  # degrees between the first and the last ball beside an eccentric inner ring: deep groove bearings
LEAST_BALLS, MOST_BALLS = 5, 60
PITCH = (-0.006, 0.032)  # of printed pitch diameters above the mean of bore and outside diameter
MOST_STATIC = 2.0  # C0 over C
TOLERANCE, TOLERANCES = 0.02, (1e-3, 0.2)
EXCESSES = (0.0, 0.5)
F0 = (8.0, 17.0)
F0_TOLERANCE = 0.02  # of printed values, which makers round and read from tables
NO_INCH = "no ball of an inch size fits: C may be above ISO 281 (dynamic_excess), or rated for other grooves"
ESTIMATE = "balls estimated from C and C0"
USUAL_BALL, USUAL_FILL = 0.58, 0.75  # of the section and of the pitch circle, for the size of a rating


class BallSet(NamedTuple):
    """Balls that fit the ratings.

    Attributes
    ----------
    balls : int
    ball_diameter : float
        In m.
    misfit : float
        Largest relative difference of their C, C0 and f0 from those that are given.
    """

    balls: int
    ball_diameter: float
    misfit: float


@dataclass(frozen=True, kw_only=True)
class RatedGeometry(Summary):
    """Balls of a bearing as its load ratings give them: an estimate.

    Attributes
    ----------
    candidates : tuple of BallSet
        All balls whose ratings are within the tolerance: inch sizes first, and of each the best first.
    pitch_diameter : float
        Mean of bore and outside diameter [m].
    pitch_interval : (float, float)
        In m; those of the catalogue are 0.5 % below to 3.1 % (an insert bearing) above that mean.
    bore, outside, dynamic_rating, static_rating, f0, contact_angle, dynamic_excess, tolerance
        As given; m, N, rad.
    """

    candidates: tuple[BallSet, ...]
    pitch_diameter: float
    pitch_interval: tuple[float, float]
    bore: float
    outside: float
    dynamic_rating: float
    static_rating: float
    f0: float | None
    contact_angle: float | None
    dynamic_excess: float
    tolerance: float

    @property
    def balls(self) -> int:
        """Number of balls that fits best."""
        return self.candidates[0].balls

    @property
    def ball_diameter(self) -> float:
        """Ball diameter that fits best [m]."""
        return self.candidates[0].ball_diameter

    @property
    def balls_interval(self) -> tuple[int, int]:
        """Least and largest number of balls of all candidates."""
        numbers = [one.balls for one in self.candidates]
        return min(numbers), max(numbers)

    @property
    def ball_interval(self) -> tuple[float, float]:
        """Least and largest ball diameter of all candidates [m]."""
        diameters = [one.ball_diameter for one in self.candidates]
        return min(diameters), max(diameters)

    @property
    def reservation(self) -> str:
        """Why the estimate may be none; empty where a ball of an inch size fits."""
        return "" if _is_inch(self.ball_diameter) else NO_INCH

    def _summary_lines(self) -> list[str]:
        best = self.candidates[0]
        ends = [
            f"{1e3 * low:.4g} to {1e3 * high:.4g} mm" for low, high in (self.ball_interval, self.pitch_interval)
        ]
        angle = "" if self.contact_angle is None else f", contact angle {degrees(self.contact_angle):.4g} degrees"
        rated = f"C {grouped(self.dynamic_rating)} N, C0 {grouped(self.static_rating)} N"
        return [
            f"estimate of {best.balls} balls of {1e3 * best.ball_diameter:.4g} mm "
            f"on {1e3 * self.pitch_diameter:.4g} mm{angle}",
            f"from {rated}{'' if self.f0 is None else f', f0 {self.f0:.4g}'}, misfit {100.0 * best.misfit:.2g} %",
            f"within {100.0 * self.tolerance:.3g} %: {counted(len(self.candidates), 'set')} of balls, "
            f"{self.balls_interval[0]} to {self.balls_interval[1]} of {ends[0]}; pitch diameter {ends[1]}",
            *note_line(self.reservation),
        ]

    def bearing(self, candidate: int = 0, **options: Any) -> BallBearing:
        """The bearing with the balls of a candidate; its name says that they are an estimate.

        Summaries, reports, pictures, JSON and FMUs of the bearing and of its results have that name.

        Parameters
        ----------
        candidate : int
            Index of `candidates`; 0 fits best.
        **options
            Any other argument of `BallBearing`, or another value than the estimate. ``clearance`` may be a class,
            "C2", "CN", "C3" or "C4"; the note that the balls are an estimate is put behind a ``name``.

        Raises
        ------
        InputError
            No such candidate; what `BallBearing` refuses.
        """
        if (
            isinstance(candidate, bool)
            or not isinstance(candidate, int)
            or not 0 <= candidate < len(self.candidates)
        ):
            raise InputError("candidate", candidate, f"a whole number from 0 to {len(self.candidates) - 1}")
        balls, diameter, _ = self.candidates[candidate]
        given = options.pop("name", "")
        if not isinstance(given, str):
            raise InputError("name", given, "text")
        if isinstance(options.get("clearance"), str):
            options["clearance"] = clearance_of_class(options["clearance"], self.bore)
        angle = {} if self.contact_angle is None else {"contact_angle": self.contact_angle}
        return BallBearing(
            **{
                "balls": balls,
                "ball_diameter": diameter,
                "pitch_diameter": self.pitch_diameter,
                **angle,
                **options,
            },
            name=f"{given}, {ESTIMATE}" if given else f"bearing with {ESTIMATE}",
        )

    def to_dict(self) -> dict[str, Any]:
        """Estimate, intervals, all candidates and what they are from, ready for JSON; SI."""
        return {
            "estimate": True,
            "balls": self.balls,
            "balls_interval": list(self.balls_interval),
            "ball_diameter": self.ball_diameter,
            "ball_interval": list(self.ball_interval),
            "pitch_diameter": self.pitch_diameter,
            "pitch_interval": list(self.pitch_interval),
            "reservation": self.reservation,
            "candidates": [one._asdict() for one in self.candidates],
            "bore": self.bore,
            "outside": self.outside,
            "dynamic_rating": self.dynamic_rating,
            "static_rating": self.static_rating,
            "f0": self.f0,
            "contact_angle": self.contact_angle,
            "dynamic_excess": self.dynamic_excess,
            "tolerance": self.tolerance,
        }


@takes(
    bore=parts.SHAFT_DIAMETER, outside=parts.SHAFT_DIAMETER, dynamic_rating=parts.RATING,
    static_rating=parts.RATING, contact_angle="rad",
)  # fmt: skip
def geometry_from_ratings(
    bore: float,
    outside: float,
    *,
    dynamic_rating: float,
    static_rating: float,
    f0: float | None = None,
    contact_angle: float | None = None,
    dynamic_excess: float = 0.0,
    tolerance: float = TOLERANCE,
) -> RatedGeometry:
    """Number and diameter of the balls and pitch diameter from printed load ratings, each with an interval.

    Parameters
    ----------
    bore, outside : float
        Diameters of the bearing [m].
    dynamic_rating, static_rating : float
        Basic load ratings C and C0 of a row of balls [N].
    f0 : float, optional
        Factor of the static rating that some makers print.
    contact_angle : float, optional
        Of an angular contact bearing [rad]. By default a deep-groove bearing, whose balls are put in beside the
        eccentric inner ring, which limits their number.
    dynamic_excess : float
        By which share of it C may be above that of ISO 281, as makers print it who count on better steel: 0.08 for
        SKF's Explorer bearings. The interval is wider then.
    tolerance : float
        Largest relative difference of C and C0 of candidates; f0 may differ by 2 %.

    Returns
    -------
    RatedGeometry
        The balls that fit best, all that fit, and `RatedGeometry.bearing`.

    Raises
    ------
    InputError
        An outside diameter that is not above the bore; ratings in kN; C0 above twice C; balls that fit nowhere,
        with the nearest ones.
    """
    if outside <= bore:
        raise InputError("outside", outside, f"above the bore, {bore:g} m")
    angle = 0.0
    if contact_angle is not None:
        require_contact_angle(contact_angle)
        angle = float(contact_angle)
    if f0 is not None:
        f0 = require_between("f0", f0, *F0)
    tolerance = require_between("tolerance", tolerance, *TOLERANCES)
    usual = _usual_ratings(bore, outside, angle)
    dynamic = require_rating("dynamic_rating", dynamic_rating, usual[0])
    static = require_rating("static_rating", static_rating, usual[1])
    if static > MOST_STATIC * dynamic:
        allowed = f"at most {MOST_STATIC:g} times C, {grouped(dynamic)} N, for a radial ball bearing"
        raise InputError("static_rating", static_rating, f"{allowed}; are C and C0 swapped?")
    excess = require_between("dynamic_excess", dynamic_excess, *EXCESSES)
    sets = _ball_sets(bore, outside, contact_angle, (dynamic, static, f0), excess)
    fitting = sorted(
        (one for one in sets if one.misfit <= tolerance), key=lambda one: not _is_inch(one.ball_diameter)
    )
    if not fitting:
        allowed = f"that of balls which fit C, C0 and both diameters within {100.0 * tolerance:.3g} %"
        if sets:
            best = sets[0]
            allowed += (
                f"; nearest: {best.balls} of {1e3 * best.ball_diameter:.4g} mm, {100.0 * best.misfit:.2g} % off"
            )
        hint = "" if excess else "; makers may print C above ISO 281: dynamic_excess=0.08"
        raise InputError("dynamic_rating", dynamic_rating, allowed + hint)
    pitch = _pitch(bore, outside)
    return RatedGeometry(
        candidates=tuple(fitting),
        pitch_diameter=pitch,
        pitch_interval=(pitch * (1.0 + PITCH[0]), pitch * (1.0 + PITCH[1])),
        bore=float(bore),
        outside=float(outside),
        dynamic_rating=dynamic,
        static_rating=static,
        f0=f0,
        contact_angle=contact_angle,
        dynamic_excess=excess,
        tolerance=tolerance,
    )


def _pitch(bore: float, outside: float) -> float:
    return 0.5 * (bore + outside)


def _ball_sets(
    bore: float,
    outside: float,
    contact_angle: float | None,
    printed: tuple[float, float, float | None],
    excess: float,
) -> list[BallSet]:
    """All balls with room between the rings and beside each other, the best first; printed are C, C0 and f0."""
    dynamic, static, f0 = printed
    pitch, angle = _pitch(bore, outside), contact_angle or 0.0
    sets = []
    for diameter in _diameters(bore, outside):
        half = asin(diameter / pitch)
        most = int(min(MOST_BALLS, np.ceil(pi / half) - 1))
        if contact_angle is None:
            most = min(most, 1 + int(np.radians(FILLED) / (2.0 * half)))
        one = _rated(1, diameter, pitch, angle)
        c, c0 = rated_dynamic(one), rated_static(one)
        factor = c0 / (1e6 * diameter**2 * cos(angle))
        if f0 is not None:
            if abs(factor / f0 - 1.0) > F0_TOLERANCE:
                continue
            c0 *= f0 / factor
        for number in range(LEAST_BALLS, most + 1):
            own = number ** (2.0 / 3.0) * c
            nearest = min(max(dynamic / (1.0 + excess), own), dynamic)  # of what C by ISO 281 may be
            sets.append(BallSet(number, diameter, max(abs(number * c0 / static - 1.0), abs(own / nearest - 1.0))))
    return sorted(sets, key=lambda balls: balls.misfit)


def _is_inch(diameter: float) -> bool:
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


def _rated(balls: int, diameter: float, pitch: float, angle: float) -> InternalGeometry:
    """Balls in grooves of 0.52 as the standards rate them."""
    pressures = []
    for race in RACES:
        material = {"e1": RATED_MODULUS, "e2": RATED_MODULUS, "nu1": 0.3, "nu2": 0.3}
        body = Geometry.ball_bearing(diameter, pitch / cos(angle), USUAL_CONFORMITY, race, **material)
        pressures.append(float(hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure))
    return InternalGeometry(
        name="",
        balls=balls,
        ball_diameter=diameter,
        pitch_diameter=pitch,
        conformity_inner=USUAL_CONFORMITY,
        conformity_outer=USUAL_CONFORMITY,
        contact_angle=angle,
        unit_pressures=(pressures[0], pressures[1]),
        ball_density=STEEL_DENSITY,
    )


def _usual_ratings(bore: float, outside: float, angle: float) -> tuple[float, float]:
    """C and C0 [N] of a bearing of this size with balls of usual size and number."""
    pitch, diameter = _pitch(bore, outside), 0.5 * USUAL_BALL * (outside - bore)
    number = max(LEAST_BALLS, round(USUAL_FILL * pi * pitch / diameter))
    balls = _rated(number, diameter, pitch, angle)
    return rated_dynamic(balls), rated_static(balls)
