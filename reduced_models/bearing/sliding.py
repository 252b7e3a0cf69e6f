"""`bearing_friction`: sliding in the contacts of a bearing by differential slip and spin, with a traction law.

Equation numbers: docs/notes/traction.md. A groove is curved across rolling, so only two lines of a contact
roll without slip (Heathcote, Proc. Inst. Automobile Engineers 15 (1921) 569). Pressure is that of Hertz, the film
that of its centre, and the temperature that of the inlet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import log, pi
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Heat, OperatingPoint
from ehlcontact.checks import parts
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import wilson_heating
from ehlcontact.jit import plain
from ehlcontact.lubricant import LimitingShear, TractionLaw, log_viscosity
from ehlcontact.lubricant.traction_laws import require_law
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES, Race

_Floats = NDArray[np.float64]

LINES, PLACES = 480, 16  # of the quadrature: across rolling, where the slip changes its sign, and along
USUAL_LAW = LimitingShear(0.07)  # mineral oil in bearings: docs/notes/traction.md
WIDEST = 1.0  # slide-to-roll ratio within which that of a free contact lies
TABLE = np.linspace(0.0, 1.0, 801)  # pressures over Hertz's between which ln(eta) is linear
SLOWEST = 1e-300  # slip over the rolling speed whose logarithm is a number


@lru_cache(maxsize=1)
def _quadrature() -> tuple[_Floats, ...]:
    """Pressure over Hertz's, x/a, y/b and weight of the nodes of an ellipse, the weights together 1."""
    across = ((np.arange(LINES) + 0.5) / LINES - 0.5)[:, None] * pi
    along = ((np.arange(PLACES) + 0.5) / PLACES) * pi
    half, high = np.cos(across), np.sin(along)  # half the length of a line, and the pressure's share on it
    weights = half**2 * high
    fields = half * high, half * np.cos(along), np.sin(across) + 0.0 * along, weights / weights.sum()
    return tuple(field.ravel() for field in fields)


class SlidingContact:
    """Contact of a ball with a groove: traction and power over the slip of its middle.

    Parameters
    ----------
    point : OperatingPoint
    film : float
        In m.
    law : TractionLaw
    radius_across : float
        Of the surface that both bodies share, across rolling [m] (eq. 10).
    spin_to_roll : float
        Angular speed of both surfaces against each other about their normal over that of rolling.
    """

    def __init__(
        self, point: OperatingPoint, film: float, law: TractionLaw, radius_across: float, spin_to_roll: float = 0.0
    ) -> None:
        s, moes, rx = point.scales, point.moes, point.geometry.radius_x
        P, X, Y, weights = _quadrature()
        self.speed, self._law, self._weights = 0.5 * point.u_sum, law, weights * pi * s.a * s.b
        viscosity, fluid = plain(log_viscosity), moes.law
        log_eta = np.interp(P, TABLE, [viscosity(one, fluid)[0] for one in TABLE.tolist()])
        self._p = s.pressure * P
        self._newton = log_eta + log(moes.eta0 * self.speed / film)
        x, y = s.a * X, s.b * Y
        # slip of the race against the ball over the rolling speed, but for that of the middle (eq. 11)
        self._along = y * y / (2.0 * radius_across * rx) + spin_to_roll * y / rx
        self._across = -spin_to_roll * x / rx

    def _stress(self, slip: float) -> tuple[_Floats, _Floats, _Floats]:
        along = self._along + slip
        size = np.hypot(along, self._across)
        return along, size, self._law.of(self._newton + np.log(np.maximum(size, SLOWEST)), self._p)

    def traction(self, slip: float) -> float:
        """Force along rolling of the race on the ball [N], where the race is faster by `slip` in the middle."""
        along, size, stress = self._stress(slip)
        return float(self._weights @ (stress * along / np.maximum(size, SLOWEST)))

    def power(self, slip: float) -> float:
        """Power of sliding [W]."""
        _, size, stress = self._stress(slip)
        return self.speed * float(self._weights @ (stress * size))

    def slip(self, force: float = 0.0) -> float:
        """Slip of the middle under a traction [N] that the contact can carry; without one two lines roll."""
        return float(scipy.optimize.brentq(lambda one: self.traction(one) - force, -WIDEST, WIDEST, xtol=1e-9))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BearingFriction(Summary):
    """Moments of friction of a ball bearing, computed and by SKF's published model [N m].

    Attributes
    ----------
    rolling : float
        Rolling torque of the films (`BearingState.rolling_torque`), times `inlet_heat`.
    inlet_heat : float
        Thermal reduction factor of the film by Wilson and Sheu; 1 without heat.
    sliding : float
        Torque by differential slip and spin in all contacts.
    by_contact : ndarray, shape (balls, 2)
        The same of each contact.
    skf_rolling, skf_sliding : float or None
        As of `BearingState`.
    law : TractionLaw
    """

    rolling: float
    inlet_heat: float
    sliding: float
    by_contact: _Floats
    skf_rolling: float | None
    skf_sliding: float | None
    law: TractionLaw

    def _summary_lines(self) -> list[str]:
        parts = f"rolling {1e3 * self.rolling:.4g} N mm, sliding {1e3 * self.sliding:.4g} N mm"
        lines = [parts, f"by {self.law}; inlet heat reduces the rolling part to {100.0 * self.inlet_heat:.3g} %"]
        if self.skf_rolling is not None and self.skf_sliding is not None:
            lines.append(f"SKF: {1e3 * self.skf_rolling:.4g} and {1e3 * self.skf_sliding:.4g} N mm")
        return lines

    def to_dict(self) -> dict[str, Any]:
        """Moments of the bearing and the traction law, ready for JSON."""
        names = "rolling", "inlet_heat", "sliding", "skf_rolling", "skf_sliding"
        return {name: getattr(self, name) for name in names} | {"law": str(self.law)}

    @property
    def total(self) -> float:
        """Rolling and sliding together."""
        return self.rolling + self.sliding

    @property
    def skf_total(self) -> float | None:
        """The same by SKF."""
        if self.skf_rolling is None or self.skf_sliding is None:
            return None
        return self.skf_rolling + self.skf_sliding


@takes(
    bearing=Object(BallBearing, "a BallBearing"),
    load="N",
    speed_rpm=parts.SPEED,
)
def bearing_friction(
    bearing: Any, load: ArrayLike, *, speed_rpm: float, law: TractionLaw, heat: bool = True
) -> BearingFriction:
    """Moments of friction of a `BallBearing` in oil: rolling of its films, sliding by a traction law.

    Parameters
    ----------
    bearing : BallBearing
    load : tuple of 2, 3 or 5 float
        As of `BallBearing.equilibrium`.
    speed_rpm : float
        Of the shaft [rev/min].
    law : TractionLaw
        `ehlcontact.Eyring`, `Carreau` or `LimitingShear`.
    heat : bool
        Multiply the rolling torque by the thermal reduction factor; needs an oil with `temperature_slope`. Films
        of a bearing with `thermal` are hot already: theirs is not multiplied.

    Raises
    ------
    InputError
        A dry bearing; as of `BallBearing.equilibrium`; heat of an oil without its data.
    """
    return friction_at(bearing, oiled_state(bearing, load, speed_rpm, law), law, heat=heat)


def friction_at(bearing: Any, state: BearingState, law: TractionLaw, *, heat: bool) -> BearingFriction:
    """The same in a state of the bearing that is known, with films."""
    omega = state.speed_rpm * RPM_TO_RAD_S
    power = np.zeros(state.force.shape)
    for k, column in np.ndindex(power.shape):
        contact = sliding_contact(bearing, state, k, column, law)
        power[k, column] = 0.0 if contact is None else contact.power(contact.slip())
    share = _inlet_heat(bearing, state) if heat and bearing.thermal is None else 1.0
    assert state.rolling_torque is not None
    return BearingFriction(
        rolling=share * state.rolling_torque,
        inlet_heat=share,
        sliding=float(power.sum() / omega),
        by_contact=power / omega,
        skf_rolling=state.skf_rolling,
        skf_sliding=state.skf_sliding,
        law=law,
    )


def oiled_state(
    bearing: Any, load: ArrayLike, speed_rpm: float, law: TractionLaw, tilt: ArrayLike | None = None
) -> BearingState:
    """State of a bearing in oil; raises `InputError` for a dry one, or without a traction law."""
    require_oil(bearing, law)
    state: BearingState = bearing.equilibrium(load, speed_rpm=speed_rpm, tilt=tilt)
    return state


def require_oil(bearing: Any, law: TractionLaw) -> None:
    """Raise `InputError` for a dry bearing, or without a traction law."""
    require_law(law)
    if bearing.oil is None:
        raise InputError("oil", None, "given to the bearing: a dry one has no films")


def sliding_contact(
    bearing: Any, state: BearingState, ball: int, column: int, law: TractionLaw
) -> SlidingContact | None:
    """Contact of a ball with a race; None below the lightest load of the atlas, taken as unloaded."""
    race, load = race_at(bearing, state, ball, column), float(state.force[ball, column])
    assert state.h_central is not None
    if load < race.loads(state.speed_rpm)[0]:
        return None
    spin = 0.0 if state.spin_to_roll is None else float(state.spin_to_roll[ball, column])
    return SlidingContact(
        race.point(load, state.speed_rpm),
        float(state.h_central[ball, column]),
        law,
        radius_across(race.conformity, race.ball_diameter),
        spin,
    )


def radius_across(conformity: float, ball_diameter: float) -> float:
    """Radius of the surface that ball and groove share: its curvature is the mean of both (eq. 10)."""
    return 2.0 * conformity * ball_diameter / (2.0 * conformity + 1.0)


def race_at(bearing: Any, state: BearingState, ball: int, column: int) -> Race:
    """Race of a contact; of a ball at a contact angle, for that angle and speed of orbit."""
    race: Race = bearing.race(RACES[column])
    if state.contact_angles is None or state.orbit is None:
        return race
    angle = float(state.contact_angles[ball, column])
    orbit = float(bearing.ring_speeds.from_outer(state.orbit[ball]))
    gamma = bearing.ball_diameter / bearing.pitch_diameter * np.cos(angle)
    ring = (1.0 - orbit) * (1.0 - gamma) if column == 0 else orbit * (1.0 + gamma)
    return race.at_angle(bearing.pitch_diameter, angle, float(ring) * bearing.pitch_diameter)


def _inlet_heat(bearing: Any, state: BearingState) -> float:
    """Thermal reduction factor at the inner contact of the most loaded ball; it hardly depends on the load."""
    ball = state.heaviest
    race = race_at(bearing, state, ball, 0)
    point = race.point(max(float(state.force[ball, 0]), race.loads(state.speed_rpm)[0]), state.speed_rpm)
    return wilson_heating(Heat().at(point).load(point.moes, point.scales))
