"""`operating_clearance`: radial clearance of a mounted, warm, turning bearing from class, fits, warmth and speed.

All is linear (`seats`), so free rings and shafts are warmed and turned first; what then overlaps at the seats is
pressed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, sin, sqrt
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts, require_choice, require_finite, require_instance
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError, warn_user
from ehlcontact.quantities import LENGTH, PRESSURE, SPEED
from ehlcontact.results.table import Display, QuantityTable
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.catalogue import designation_of
from reduced_models.bearing.clearance import clearance_limits
from reduced_models.bearing.grooves import distance_of_centres
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.ring import free_clearance
from reduced_models.bearing.seats import (
    MATERIALS,
    Material,
    Seats,
    inner_ring,
    interferences,
    opened,
    outer_ring,
    spinning,
)
from reduced_models.bearing.tolerances import (
    bore_limits,
    deviation,
    housing_limits,
    outside_limits,
    shaft_limits,
)
from reduced_models.elements.validity import OutsideValidityWarning

_Floats = NDArray[np.float64]

CASES = ("least", "mean", "largest")  # clearance: of the tightest fits, of the middles, of the loosest ones
REFERENCE = 20.0  # degrees Celsius, of drawings
PICOMETRES = 6  # decimals of micrometres in summaries
NO_FIT = "no fit"


@dataclass(frozen=True, eq=False, kw_only=True)
class OperatingClearance(QuantityTable):
    """Clearance of a bearing in operation: its initial one, less what fits, temperatures and speed take.

    Each array has three cases: the least clearance that the tolerances allow, their middles, the largest one.

    Attributes
    ----------
    name : str
        Of the bearing.
    initial : ndarray, shape (3,)
        Radial clearance before mounting [m]: the play across the bearing.
    inner_interference, outer_interference : ndarray, shape (3,)
        Of the inner ring on its shaft and of the outer ring in its housing, in diameter, cold and at rest, less
        what smoothing takes [m]; below 0 a gap.
    inner_pressed, outer_pressed : ndarray, shape (3,)
        What overlaps at these seats in operation [m]; below 0 a gap: the ring is loose. 0 of a seat without fit.
    inner_pressure, outer_pressure : ndarray, shape (3,)
        At the seats in operation [Pa].
    by_inner_fit, by_outer_fit, by_temperature, by_speed : ndarray, shape (3,)
        What each takes off the clearance [m]. The fits are those in operation.
    clearance : ndarray, shape (3,)
        In operation [m]; below 0 the bearing is preloaded by so much.
    probable : ndarray, shape (2,)
        Limits of the clearance [m] where the deviations of class, bore, shaft, outside diameter and housing are
        independent and each within its limits with as many standard deviations as the sum.
    loose_from : float
        Speed [rev/min] from which the inner ring of the loosest fit has no pressure on its seat; infinite where
        the shaft grows faster, or without fit.
    speed_rpm : float
    temperatures : mapping of str to float
        Of shaft, inner ring, balls, outer ring and housing [degrees Celsius].
    fits : tuple of str
        Of shaft and housing, or "no fit".
    turning : str
        Ring that turns relative to the load: "inner" or "outer". It creeps where its seat is loose.
    """

    name: str
    initial: Annotated[_Floats, LENGTH.over("case")]
    inner_interference: Annotated[_Floats, LENGTH.over("case")]
    outer_interference: Annotated[_Floats, LENGTH.over("case")]
    inner_pressed: Annotated[_Floats, LENGTH.over("case")]
    outer_pressed: Annotated[_Floats, LENGTH.over("case")]
    inner_pressure: Annotated[_Floats, PRESSURE.over("case")]
    outer_pressure: Annotated[_Floats, PRESSURE.over("case")]
    by_inner_fit: Annotated[_Floats, LENGTH.over("case")]
    by_outer_fit: Annotated[_Floats, LENGTH.over("case")]
    by_temperature: Annotated[_Floats, LENGTH.over("case")]
    by_speed: Annotated[_Floats, LENGTH.over("case")]
    clearance: Annotated[_Floats, LENGTH.over("case")]
    probable: Annotated[_Floats, LENGTH.over("limit")]
    loose_from: Annotated[float, SPEED]
    speed_rpm: Annotated[float, SPEED]
    temperatures: Mapping[str, float]
    fits: tuple[str, str]
    turning: str = "inner"

    DISPLAY: ClassVar[Display] = Display(rows="case", labels={"case": CASES, "limit": CASES[::2]})

    @property
    def mean(self) -> float:
        """Clearance in operation with all deviations in the middle of their limits [m]."""
        return float(self.clearance[1])

    @property
    def turning_pressed(self) -> _Floats:
        """What overlaps at the seat of the ring that turns, in operation [m]; below 0 a gap."""
        return self.outer_pressed if self.turning == "outer" else self.inner_pressed

    def loose_of(self, name: str) -> str:
        """That the ring that turns is loose, in words: "the inner ring of 6206 is loose on its shaft"."""
        seat = "in its housing" if self.turning == "outer" else "on its shaft"
        return f"the {self.turning} ring of {name} is loose {seat}"

    @property
    def fits_in_words(self) -> str:
        """Fits of shaft and housing: "k5 and H6"."""
        return NO_FIT if set(self.fits) == {NO_FIT} else " and ".join(self.fits)

    def _summary_lines(self) -> list[str]:
        def um(values: _Floats) -> str:
            return " / ".join(f"{round(1e6 * value, PICOMETRES) + 0.0:.3g}" for value in values)

        left_out = {part for part, fit in zip(("shaft", "housing"), self.fits, strict=True) if fit == NO_FIT}
        warm = ", ".join(f"{part} {value:g}" for part, value in self.temperatures.items() if part not in left_out)
        takes_off = [
            f"inner fit {um(self.by_inner_fit)}",
            f"outer fit {um(self.by_outer_fit)}",
            f"temperature {um(self.by_temperature)}",
            f"speed {um(self.by_speed)}",
        ]
        named = self.loose_from < inf and self.turning == "inner"
        loose = f"; inner ring loose from {self.loose_from:.4g} rev/min" if named else ""
        return [
            f"{self.name}, {self.fits_in_words}, {self.speed_rpm:.5g} rev/min; {warm} °C",
            f"clearance {um(self.clearance)} µm (least / mean / largest), probable {um(self.probable)} µm",
            f"before mounting {um(self.initial)} µm; taken by {', '.join(takes_off[:2])} µm",
            f"{', '.join(takes_off[2:])} µm{loose}",
        ]

    @takes()
    def of(self, bearing: BallBearing) -> BallBearing:
        """The bearing with the mean clearance in operation; of angular contact with the angle that this makes.

        Parameters
        ----------
        bearing : BallBearing

        Returns
        -------
        BallBearing

        Raises
        ------
        InputError
            An angular contact bearing without any play left: its contact angle is 0.
        """
        require_instance("bearing", bearing, BallBearing, "a BallBearing")
        if bearing.contact_angle is None:
            return replace(bearing, clearance=self.mean)
        return replace(bearing, contact_angle=self._angle(bearing))

    def offset(self, bearing: BallBearing) -> float:
        """Axial offset [m] by which the mean change of clearance presses an angular contact bearing of a set.

        Its neighbour, whose rings are as far apart as before, takes it up: add it to the offsets of a `BearingSet`
        of the bearings that `of` gives. It is positive where the fits take clearance.

        Parameters
        ----------
        bearing : BallBearing
            As before mounting.

        Raises
        ------
        InputError
            A deep-groove bearing; no play left.
        """
        if bearing.contact_angle is None:
            raise InputError("bearing", bearing.name or "deep groove", "an angular contact bearing")
        distance = distance_of_centres(bearing)
        return distance * (sin(bearing.contact_angle) - sin(self._angle(bearing)))

    def _angle(self, bearing: BallBearing) -> float:
        distance = distance_of_centres(bearing)
        if not 0.0 < self.mean < 2.0 * distance:
            allowed = "one with play left: fits, temperatures and speed take all of the clearance of its angle"
            raise InputError("bearing", bearing.name, allowed)
        return float(np.arccos(1.0 - 0.5 * self.mean / distance))


@takes(
    bore=parts.SHAFT_DIAMETER, outside=parts.SHAFT_DIAMETER, shaft_bore=parts.BORE,
    housing_outside=parts.SHAFT_DIAMETER, speed_rpm=parts.SPEED_OR_NONE, smoothing="m",
)  # fmt: skip
def operating_clearance(
    bearing: BallBearing | str,
    *,
    fit: tuple[Any, Any] = (None, None),
    initial: str | float | tuple[float, float] | None = None,
    bore: float | None = None,
    outside: float | None = None,
    shaft_bore: float = 0.0,
    housing_outside: float | None = None,
    shaft_material: str = "steel",
    housing_material: str = "steel",
    ball_material: str = "bearing steel",
    temperatures: Mapping[str, float] | None = None,
    speed_rpm: float = 0.0,
    smoothing: float = 0.0,
) -> OperatingClearance:
    """Clearance of a bearing on its seats, warm and turning.

    Parameters
    ----------
    bearing : BallBearing or str
        Or its name in the catalogue. A load that stands still turns relative to its ``turning`` ring.
    fit : (str, str), optional
        Classes of ISO 286 of shaft and housing, as ``("k5", "H6")``; a deviation [m], or (lower, upper), in place
        of either. None of a seat that takes nothing, as where the clearance is that after mounting: by default
        both, for temperatures and speed alone.
    initial : str, float or (float, float), optional
        Before mounting: a class, "CN" by default of a deep-groove bearing, a number, or limits [m]. Of an angular
        contact bearing and of one that is given as a `BallBearing`, its own.
    bore, outside : float, optional
        Of the bearing [m]; known of the catalogue's. Fits and, the bore, the speed need them.
    shaft_bore : float
        Of a hollow shaft [m].
    housing_outside : float, optional
        Of the housing [m]; without it the housing is a thick block.
    shaft_material, housing_material, ball_material : str
        "steel", "bearing steel", "stainless steel", "cast iron", "aluminium" or "silicon nitride". Rings have the
        elasticity and density of the bearing and the expansion of bearing steel.
    temperatures : mapping, optional
        "inner" and "outer" [degrees Celsius], 20 where left out; "shaft" and "housing", as their rings where left
        out; "balls", the mean of both rings where left out.
    speed_rpm : float
        Of the shaft.
    smoothing : float
        Interference that the roughness of both surfaces of a seat takes [m]: of ground seats some 3 um.

    Returns
    -------
    OperatingClearance

    Warns
    -----
    OutsideValidityWarning
        A ring that turns, relative to a load that stands still, and is loose on its seat in operation. A loose
        ring that stands still does not creep.

    Raises
    ------
    InputError
        Classes that are none, or in the wrong order; a bearing whose bore or outside diameter is not known;
        temperatures in kelvin; a shaft bore beyond the bearing's.

    Examples
    --------
    >>> from reduced_models import operating_clearance
    >>> warm = {"shaft": 60.0, "inner": 65.0, "outer": 55.0, "housing": 50.0}
    >>> found = operating_clearance("6206", fit=("k5", "H6"), temperatures=warm, speed_rpm=9000.0)
    """
    own = _bearing(bearing)
    if not isinstance(fit, tuple | list) or len(fit) != 2:
        raise InputError("fit", fit, 'classes of shaft and housing, as ("k5", "H6")')
    on_shaft, in_housing = (one is not None for one in fit)
    needs = on_shaft or speed_rpm > 0.0, in_housing
    seat = Seats.of(own, bore, outside, shaft_bore, housing_outside, needs)
    shaft, housing, balls = (
        _material(name, given)
        for name, given in (
            ("shaft_material", shaft_material),
            ("housing_material", housing_material),
            ("ball_material", ball_material),
        )
    )
    ring = Material(own.youngs_modulus, own.poisson_ratio, own.density, MATERIALS["bearing steel"].expansion)
    limits = _initial(bearing, own, initial, seat.d)
    if not 0.0 <= smoothing <= 1e-4:
        raise InputError("smoothing", smoothing, "between 0 and 1e-4 m")
    nothing = np.zeros(len(CASES))
    warm = _temperatures(temperatures)
    rise = {part: value - REFERENCE for part, value in warm.items()}
    omega = speed_rpm * RPM_TO_RAD_S

    inner, pressed_in, p_in, growth, loose_from = nothing, nothing, nothing, nothing, inf
    outer, pressed_out, p_out, shrinkage = nothing, nothing, nothing, nothing
    tolerances = []  # of each fit: what it takes, limits of shaft or housing, limits of the ring
    if on_shaft:
        tight = shaft_limits(fit[0], seat.d) if isinstance(fit[0], str) else deviation("fit[0]", fit[0])
        inner = interferences(tight, bore_limits(seat.d)) - smoothing
        heated = seat.d * (shaft.expansion * rise["shaft"] - ring.expansion * rise["inner"])
        pressed_in = inner + heated - opened(ring, shaft, seat, omega)
        p_in, growth = inner_ring(np.maximum(pressed_in, 0.0), seat, ring, shaft)
        per_square = opened(ring, shaft, seat, 1000.0 * RPM_TO_RAD_S) / 1e6  # over the square of rev/min
        hold = float(inner[2] + heated)
        loose_from = 0.0 if hold <= 0.0 else sqrt(hold / per_square) if per_square > 0.0 else inf
        tolerances.append((growth, tight, bore_limits(seat.d)))
    if in_housing:
        tight = housing_limits(fit[1], seat.D) if isinstance(fit[1], str) else deviation("fit[1]", fit[1])
        outer = interferences(outside_limits(seat.D), tight) - smoothing
        heated = seat.D * (ring.expansion * rise["outer"] - housing.expansion * rise["housing"])
        pressed_out = outer + heated
        p_out, shrinkage = outer_ring(np.maximum(pressed_out, 0.0), seat, ring, housing)
        tolerances.append((shrinkage, tight, outside_limits(seat.D)))
    # against balls as warm as they are, and all of it as warm as the balls: play is a length then
    warmth = ring.expansion * (
        seat.groove_inner * (rise["inner"] - rise["balls"]) - seat.groove_outer * (rise["outer"] - rise["balls"])
    )
    play = 0.0 if own.contact_angle is None else free_clearance(distance_of_centres(own), own.contact_angle)
    apart = 2.0 * own.ball_diameter * (balls.expansion - ring.expansion) - ring.expansion * play
    warmth += rise["balls"] * apart
    at = 0.5 * seat.groove_inner
    spun = 2.0 * spinning(ring, 0.5 * seat.d, at, at, omega) if omega > 0.0 else 0.0
    before = np.array([limits[0], 0.5 * sum(limits), limits[1]])
    after = before - growth - shrinkage - warmth - spun
    result = OperatingClearance(
        name=own.name or "ball bearing",
        initial=before,
        inner_interference=inner,
        outer_interference=outer,
        inner_pressed=pressed_in,
        outer_pressed=pressed_out,
        inner_pressure=p_in,
        outer_pressure=p_out,
        by_inner_fit=growth,
        by_outer_fit=shrinkage,
        by_temperature=np.full(3, warmth),
        by_speed=np.full(3, spun),
        clearance=after,
        probable=_probable(after, before, tolerances),
        loose_from=loose_from,
        speed_rpm=float(speed_rpm),
        temperatures=warm,
        fits=(_fit_words(fit[0]), _fit_words(fit[1])),
        turning="inner" if own.ring_speeds.inner else "outer",
    )
    if result.turning_pressed[1] < 0.0:
        warn_user(
            f"{result.loose_of(result.name)} in operation: a gap of {-1e6 * result.turning_pressed[1]:.3g} µm"
            " with mean deviations",
            OutsideValidityWarning,
        )
    return result


def _probable(
    after: _Floats, before: _Floats, tolerances: list[tuple[_Floats, tuple[float, float], tuple[float, float]]]
) -> _Floats:
    """Mean clearance, less and more the root of the sum of the squares of half the widths of its limits."""
    widths = [np.ptp(before)]
    for change, *pair in tolerances:
        sizes = np.array([high - low for low, high in pair])
        if sizes.sum() > 0.0:
            widths.extend(np.ptp(change) * sizes / sizes.sum())
    half = 0.5 * float(np.linalg.norm(widths))
    return np.array([after[1] - half, after[1] + half])


def _bearing(bearing: BallBearing | str) -> BallBearing:
    if isinstance(bearing, str):
        known = designation_of(bearing).name
        return BallBearing.catalogue(known)
    require_instance("bearing", bearing, BallBearing, "a BallBearing, or a name of the catalogue")
    return bearing


def _initial(
    given: BallBearing | str, bearing: BallBearing, initial: str | float | tuple[float, float] | None, bore: float
) -> tuple[float, float]:
    if initial is None:
        if bearing.contact_angle is not None:
            own = free_clearance(distance_of_centres(bearing), bearing.contact_angle)
            return own, own
        if not isinstance(given, str):
            return bearing.clearance, bearing.clearance
        return clearance_limits(designation_of(given).clearance or "CN", bore)
    if bearing.contact_angle is not None:
        raise InputError("initial", initial, "left out of an angular contact bearing: it follows from its angle")
    return clearance_limits(initial, bore) if isinstance(initial, str) else deviation("initial", initial)


def _material(name: str, given: str) -> Material:
    require_choice(name, given, tuple(MATERIALS))
    return MATERIALS[given]


def _temperatures(given: Mapping[str, float] | None) -> dict[str, float]:
    wanted = ("shaft", "inner", "outer", "housing", "balls")
    if given is not None and not isinstance(given, Mapping):
        raise InputError("temperatures", given, f"a mapping of {', '.join(wanted)} to degrees Celsius")
    for name in given or {}:
        if name not in wanted:
            raise InputError("temperatures", name, f"of {', '.join(wanted)}")
    own = {}
    for name, value in (given or {}).items():
        own[name] = parts.TEMPERATURE.take(f"temperatures[{name!r}]", value, True)
    inner, outer = own.get("inner", REFERENCE), own.get("outer", REFERENCE)
    usual = {"shaft": inner, "inner": inner, "outer": outer, "housing": outer, "balls": 0.5 * (inner + outer)}
    return usual | own


def _fit_words(fit: Any) -> str:
    if fit is None:
        return NO_FIT
    if isinstance(fit, str):
        return fit.strip()
    values = fit if isinstance(fit, tuple | list) else (fit,)
    return " to ".join(f"{1e6 * require_finite('fit', one):g}" for one in values) + " µm"
