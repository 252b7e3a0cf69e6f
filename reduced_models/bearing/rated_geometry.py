"""`geometry_from_ratings`: balls of a bearing estimated from the load ratings that its maker prints.

Few pairs of number and diameter of balls fit both C and C0: these are the `candidates`, which `ball_sets` finds.
The best of them is the estimate, their ends are its interval. Inch sizes come first, for all balls of the
catalogue have them. A printed f0, which depends on Dw/Dpw alone, makes the interval of Dw smaller.

The ratings of the standards are for grooves of 0.52. Many makers print a C that is higher by some per cent for
their steel, NSK in newer tables 5 %, with a C0 of the standard: that is `dynamic_excess`. Others rate the grooves
that they grind, as GMN: that is `conformity`. Ratings do not say which: both are for those who know the maker.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, pi
from typing import Any

from ehlcontact.checks import parts, require_between
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, counted, note_line
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.ball_sets import (
    FEWEST,
    LEAST_BALLS,
    BallSet,
    filling,
    is_inch,
    mean_diameter,
    rated_balls,
    sets_for_conformities,
    sets_for_conformity,
)
from reduced_models.bearing.catalogue import USUAL_CONFORMITY
from reduced_models.bearing.clearance import clearance_of_class
from reduced_models.bearing.grooves import require_contact_angle
from reduced_models.life.load_ratings import dynamic_rating as rated_dynamic
from reduced_models.life.load_ratings import grouped, require_rating
from reduced_models.life.load_ratings import static_rating as rated_static

PITCH = (-0.006, 0.032)  # of printed pitch diameters above the mean of bore and outside diameter
MOST_STATIC = 2.0  # C0 over C
TOLERANCE, TOLERANCES = 0.02, (1e-3, 0.2)
EXCESSES = (0.0, 0.5)
CONFORMITIES = (0.505, 0.56)
F0 = (8.0, 17.0)
OTHERS = "C may be above ISO 281 (dynamic_excess=0.08), or rated for other grooves (conformity=(0.515, 0.53))"
NO_INCH = f"no ball of an inch size fits: {OTHERS}"
ESTIMATE = "balls estimated from C and C0"
USUAL_BALL, USUAL_FILL = 0.58, 0.75  # of the section and of the pitch circle, for the size of a rating


@dataclass(frozen=True, kw_only=True)
class RatedGeometry(Summary):
    """Balls of a bearing as its load ratings give them: an estimate.

    Attributes
    ----------
    candidates : tuple of BallSet
        All balls whose ratings are within the tolerance: inch sizes first, and of each the best first. With an
        interval of conformities, deep groove bearings with balls over some 190 degrees come first, and angular
        contact bearings whose conformity is nearest to 0.52.
    pitch_diameter : float
        Mean of bore and outside diameter [m].
    pitch_interval : (float, float)
        In m; those of the catalogue are 0.5 % below to 3.1 % (an insert bearing) above that mean.
    bore, outside, dynamic_rating, static_rating, f0, contact_angle, conformity, dynamic_excess, tolerance
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
    conformity: float | tuple[float, float]
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
        """Why the estimate may be none; else empty."""
        if not is_inch(self.ball_diameter):
            return NO_INCH
        if self.contact_angle is None:
            angle = filling(self.balls, self.ball_diameter, self.pitch_diameter)
            return "" if angle >= FEWEST else f"few balls, over {angle:.0f} degrees: {OTHERS}"
        if isinstance(self.conformity, float):
            return ""
        return (
            "the number of balls goes with the conformity: take that of a bearing of this maker with these balls"
        )

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
        """The bearing with the balls of a candidate and the ratings; its name says that they are an estimate.

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
        balls, diameter = self.candidates[candidate][:2]
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
                "dynamic_rating": self.dynamic_rating,
                "static_rating": self.static_rating,
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
            "conformity": self.conformity if isinstance(self.conformity, float) else list(self.conformity),
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
    conformity: float | tuple[float, float] = USUAL_CONFORMITY,
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
    conformity : float or (float, float)
        Groove radius over ball diameter for which the maker rates: 0.52 in the standards. With an interval, as
        (0.515, 0.53), balls of inch sizes are found with the conformity of it for which C and C0 fit. A maker's
        own is the `BallSet.conformity` of a deep groove bearing with balls of this size.
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
    conformity = _require_conformity(conformity, excess)
    printed = dynamic, static, f0
    usual_groove = conformity if isinstance(conformity, float) else USUAL_CONFORMITY
    sets = sets_for_conformity(bore, outside, contact_angle, printed, excess, usual_groove)
    if isinstance(conformity, float):
        fitting = [one for one in sets if one.misfit <= tolerance]
        fitting.sort(key=lambda one: not is_inch(one.ball_diameter))
    else:
        fitting = sets_for_conformities(bore, outside, contact_angle, printed, tolerance, conformity)
    if not fitting:
        allowed = f"that of balls which fit C, C0 and both diameters within {100.0 * tolerance:.3g} %"
        if sets:
            best = sets[0]
            allowed += (
                f"; nearest: {best.balls} of {1e3 * best.ball_diameter:.4g} mm, {100.0 * best.misfit:.2g} % off"
            )
        hint = "" if excess or conformity != USUAL_CONFORMITY else f"; {OTHERS}"
        raise InputError("dynamic_rating", dynamic_rating, allowed + hint)
    pitch = mean_diameter(bore, outside)
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
        conformity=conformity,
        dynamic_excess=excess,
        tolerance=tolerance,
    )


def _require_conformity(value: object, excess: float) -> float | tuple[float, float]:
    """A conformity or an interval of them; raises `InputError` for others, and for an interval with excess."""
    if not isinstance(value, (tuple, list)):
        return require_between("conformity", value, *CONFORMITIES)
    allowed = (
        f"a number between {CONFORMITIES[0]:g} and {CONFORMITIES[1]:g}, or two of them, the smaller one first"
    )
    if len(value) != 2:
        raise InputError("conformity", value, allowed)
    low, high = (require_between("conformity", end, *CONFORMITIES) for end in value)
    if low >= high:
        raise InputError("conformity", value, allowed)
    if excess:
        raise InputError("conformity", value, "one number beside dynamic_excess: an interval of both is none")
    return low, high


def _usual_ratings(bore: float, outside: float, angle: float) -> tuple[float, float]:
    """C and C0 [N] of a bearing of this size with balls of usual size and number."""
    pitch, diameter = mean_diameter(bore, outside), 0.5 * USUAL_BALL * (outside - bore)
    number = max(LEAST_BALLS, round(USUAL_FILL * pi * pitch / diameter))
    balls = rated_balls(number, diameter, pitch, angle)
    return rated_dynamic(balls), rated_static(balls)
