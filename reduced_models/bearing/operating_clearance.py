"""`operating_clearance`: radial clearance of a mounted, warm, turning bearing from class, fits, warmth and speed.

Rings, shaft and housing are thick cylinders in plane stress, rings up to the bottoms of their grooves (Lame;
Timoshenko and Goodier, Theory of Elasticity, sections 28 and 32). At the seat of a ring on its shaft

    I = p d [ (D2 + d2)/(D2 - d2)/Er + nur/Er + (d2 + b2)/(d2 - b2)/Es - nus/Es ],

with interference I and pressure p, bore d and groove diameter D of the ring, bore b of the shaft, and squares d2;
the groove grows by 2 p d2 D/(Er (D2 - d2)). A ring that turns is wider at radius r, between a and b, by

    u = rho omega^2 (3 + nu)(1 - nu)/(8 E) r [a^2 + b^2 - (1 + nu)/(3 + nu) r^2 + (1 + nu)/(1 - nu) a^2 b^2/r^2].

All is linear, so free rings and shafts are warmed and turned first; what then overlaps at the seats is pressed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, inf, sin, sqrt
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts, require_choice, require_finite, require_instance
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError, warn_user
from ehlcontact.quantities import LENGTH, PRESSURE, SPEED
from ehlcontact.results.table import Display, QuantityTable
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.catalogue import ROWS, designation_of
from reduced_models.bearing.clearance import clearance_limits
from reduced_models.bearing.grooves import distance_of_centres
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.ring import free_clearance
from reduced_models.bearing.tolerances import (
    bore_limits,
    deviation,
    housing_limits,
    outside_limits,
    outside_of,
    shaft_limits,
)
from reduced_models.elements.validity import OutsideValidityWarning

_Floats = NDArray[np.float64]

CASES = ("least", "mean", "largest")  # clearance: of the tightest fits, of the middles, of the loosest ones
REFERENCE = 20.0  # degrees Celsius, of drawings


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
        What overlaps at these seats in operation [m]; below 0 a gap: the ring is loose.
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
        the shaft grows faster.
    speed_rpm : float
    temperatures : mapping of str to float
        Of shaft, inner ring, balls, outer ring and housing [degrees Celsius].
    fits : tuple of str
        Of shaft and housing.
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

    DISPLAY: ClassVar[Display] = Display(rows="case", labels={"case": CASES, "limit": CASES[::2]})

    @property
    def mean(self) -> float:
        """Clearance in operation with all deviations in the middle of their limits [m]."""
        return float(self.clearance[1])

    def _summary_lines(self) -> list[str]:
        def um(values: _Floats) -> str:
            return " / ".join(f"{1e6 * value + 0.0:.3g}" for value in values)

        warm = ", ".join(f"{part} {value:g}" for part, value in self.temperatures.items())
        takes_off = [
            f"inner fit {um(self.by_inner_fit)}",
            f"outer fit {um(self.by_outer_fit)}",
            f"temperature {um(self.by_temperature)}",
            f"speed {um(self.by_speed)}",
        ]
        loose = "" if self.loose_from == inf else f"; inner ring loose from {self.loose_from:.4g} rev/min"
        return [
            f"{self.name}, {self.fits[0]} and {self.fits[1]}, {self.speed_rpm:.5g} rev/min; {warm} °C",
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
    fit: tuple[Any, Any],
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
        Or its name in the catalogue.
    fit : (str, str)
        Classes of ISO 286 of shaft and housing, as ``("k5", "H6")``; a deviation [m], or (lower, upper), in place
        of either.
    initial : str, float or (float, float), optional
        Before mounting: a class, "CN" by default of a deep-groove bearing, a number, or limits [m]. Of an angular
        contact bearing and of one that is given as a `BallBearing`, its own.
    bore, outside : float, optional
        Of the bearing [m]; known of the catalogue's.
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
        An inner ring that is loose on its shaft in operation.

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
    seat = _Seats.of(own, bore, outside, shaft_bore, housing_outside)
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
    if not isinstance(fit, tuple | list) or len(fit) != 2:
        raise InputError("fit", fit, 'classes of shaft and housing, as ("k5", "H6")')
    tight_shaft = shaft_limits(fit[0], seat.d) if isinstance(fit[0], str) else deviation("fit[0]", fit[0])
    tight_housing = housing_limits(fit[1], seat.D) if isinstance(fit[1], str) else deviation("fit[1]", fit[1])
    if not 0.0 <= smoothing <= 1e-4:
        raise InputError("smoothing", smoothing, "between 0 and 1e-4 m")
    inner = _cases(tight_shaft, bore_limits(seat.d)) - smoothing
    outer = _cases(outside_limits(seat.D), tight_housing) - smoothing
    warm = _temperatures(temperatures)
    rise = {part: value - REFERENCE for part, value in warm.items()}
    omega = speed_rpm * RPM_TO_RAD_S

    turned = _opened(ring, shaft, seat, omega)
    heated_in = seat.d * (shaft.expansion * rise["shaft"] - ring.expansion * rise["inner"])
    heated_out = seat.D * (ring.expansion * rise["outer"] - housing.expansion * rise["housing"])
    pressed_in, pressed_out = inner + heated_in - turned, outer + heated_out
    p_in, growth = _inner_ring(np.maximum(pressed_in, 0.0), seat, ring, shaft)
    p_out, shrinkage = _outer_ring(np.maximum(pressed_out, 0.0), seat, ring, housing)
    warmth = (
        ring.expansion * (seat.groove_inner * rise["inner"] - seat.groove_outer * rise["outer"])
        + 2.0 * own.ball_diameter * balls.expansion * rise["balls"]
    )
    spun = 2.0 * spinning(ring, seat.d / 2.0, seat.groove_inner / 2.0, seat.groove_inner / 2.0, omega)
    before = np.array([limits[0], 0.5 * sum(limits), limits[1]])
    after = before - growth - shrinkage - warmth - spun
    per_square = _opened(ring, shaft, seat, 1000.0 * RPM_TO_RAD_S) / 1e6  # over the square of rev/min
    hold = float(inner[2] + heated_in)
    loose_from = 0.0 if hold <= 0.0 else sqrt(hold / per_square) if per_square > 0.0 else inf
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
        probable=_probable(after, before, growth, shrinkage, seat, (tight_shaft, tight_housing)),
        loose_from=loose_from,
        speed_rpm=float(speed_rpm),
        temperatures=warm,
        fits=(_fit_words(fit[0]), _fit_words(fit[1])),
    )
    if pressed_in[1] < 0.0:
        warn_user(
            f"the inner ring of {result.name} is loose on its shaft in operation: a gap of"
            f" {-1e6 * pressed_in[1]:.3g} µm with mean deviations",
            OutsideValidityWarning,
        )
    return result


class _Seats(NamedTuple):
    """Diameters [m]: bores of shaft and bearing, grooves, outside of bearing and housing."""

    b: float
    d: float
    groove_inner: float
    groove_outer: float
    D: float
    housing: float

    @classmethod
    def of(
        cls, bearing: BallBearing, bore: float | None, outside: float | None, hollow: float, housing: float | None
    ) -> _Seats:
        row = ROWS.get(bearing.name)
        d = bore if bore is not None else None if row is None else row.bore
        if d is None:
            raise InputError("bore", None, "given in metres: that of this bearing is not known, and fits need it")
        D = outside if outside is not None else outside_of(bearing.name, d)
        if D is None:
            allowed = "given in metres: that of this bearing is not known, and fits need it"
            raise InputError("outside", None, allowed)
        inner, outer = groove_bottoms(bearing)
        if not d < inner:
            raise InputError("bore", d, f"below {inner:.5g} m, the diameter of the inner groove")
        if not D > outer:
            raise InputError("outside", D, f"above {outer:.5g} m, the diameter of the outer groove")
        if not hollow < d:
            raise InputError("shaft_bore", hollow, f"below {d:.5g} m, the bore of the bearing")
        if housing is not None and not housing > D:
            raise InputError("housing_outside", housing, f"above {D:.5g} m, the outside diameter of the bearing")
        return cls(hollow, d, inner, outer, D, inf if housing is None else housing)


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


def _opened(ring: Material, shaft: Material, seat: _Seats, omega: float) -> float:
    """By how much rotation [rad/s] opens the seat of the inner ring, in diameter [m]."""
    at = 0.5 * seat.d
    own = spinning(ring, at, 0.5 * seat.groove_inner, at, omega)
    return 2.0 * (own - spinning(shaft, 0.5 * seat.b, at, at, omega))


def _inner_ring(overlap: _Floats, seat: _Seats, ring: Material, shaft: Material) -> tuple[_Floats, _Floats]:
    """Pressure on the seat of the inner ring, and growth of its groove."""
    bore2, groove2, hole2 = seat.d**2, seat.groove_inner**2, seat.b**2
    yielding = ((groove2 + bore2) / (groove2 - bore2) + ring.poisson_ratio) / ring.youngs_modulus
    yielding += ((bore2 + hole2) / (bore2 - hole2) - shaft.poisson_ratio) / shaft.youngs_modulus
    pressure = overlap / (seat.d * yielding)
    return pressure, 2.0 * pressure * bore2 * seat.groove_inner / (ring.youngs_modulus * (groove2 - bore2))


def _outer_ring(overlap: _Floats, seat: _Seats, ring: Material, housing: Material) -> tuple[_Floats, _Floats]:
    """Pressure on the seat of the outer ring, and shrinkage of its groove."""
    outside2, groove2, block2 = seat.D**2, seat.groove_outer**2, seat.housing**2
    thick = 1.0 if seat.housing == inf else (block2 + outside2) / (block2 - outside2)
    yielding = (thick + housing.poisson_ratio) / housing.youngs_modulus
    yielding += ((outside2 + groove2) / (outside2 - groove2) - ring.poisson_ratio) / ring.youngs_modulus
    pressure = overlap / (seat.D * yielding)
    return pressure, 2.0 * pressure * outside2 * seat.groove_outer / (ring.youngs_modulus * (outside2 - groove2))


def _cases(first: tuple[float, float], second: tuple[float, float]) -> _Floats:
    """First less second deviation: greatest, mean and least."""
    return np.array([first[1] - second[0], 0.5 * (sum(first) - sum(second)), first[0] - second[1]])


def _probable(
    after: _Floats,
    before: _Floats,
    growth: _Floats,
    shrinkage: _Floats,
    seat: _Seats,
    fits: tuple[tuple[float, float], tuple[float, float]],
) -> _Floats:
    """Mean clearance, less and more the root of the sum of the squares of half the widths of its limits."""
    widths = [np.ptp(before)]
    for change, pair in (
        (growth, (fits[0], bore_limits(seat.d))),
        (shrinkage, (fits[1], outside_limits(seat.D))),
    ):
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
    if isinstance(fit, str):
        return fit.strip()
    values = fit if isinstance(fit, tuple | list) else (fit,)
    return " to ".join(f"{1e6 * require_finite('fit', one):g}" for one in values) + " µm"
