"""The motions of the paper as functions of dimensionless time T: free vibration, harmonic load, ramp."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot, inf, pi, sin
from typing import Any, ClassVar

from ehlcontact.checks import parts, require_choice, require_finite, require_positive
from ehlcontact.checks.frequency import dimensionless, fields_by_name, is_given, one
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.transient.bodies import LONGEST_ABRUPT, MADE_AT, Start, UnderLoad, scales_at

SMALL_VIBRATION = 1.5**0.5  # dry angular frequency over Omega_n
STEPS_PER_PERIOD = 80
FARTHEST = 2.0  # dry approaches, from which a free vibration may begin
# Of bodies and loads, in 1/T: below, nothing moves while a bearing turns a thousand times; above, it is hundreds
# of times faster than any body on a film. A frequency beyond was given in other units, or with another mass.
SLOWEST, FASTEST = 1e-6, 1e3
STARTS = {"closing": 1.0, "opening": -1.0}  # sign of the first rate of a free vibration


def _require_frequency(field: str, value: object) -> None:
    """Raise `InputError` unless it is a dimensionless frequency that a contact can have."""
    if not SLOWEST <= require_positive(field, value) <= FASTEST:
        unit = "in units of u_sum/(2a), not rad/s or Hz"
        raise InputError(field, value, f"between {SLOWEST:g} and {FASTEST:g} ({unit})")


@fields_take(made_at=MADE_AT)
@fields_by_name(0, omega_n="Omega_n, dimensionless; FreeVibration.at(point, hz=...) takes SI")
@dataclass(frozen=True, slots=True)
class FreeVibration(UnderLoad):
    """Free vibration of a mass on the contact under constant load 1.

    The bodies are held at ``static approach + offset`` until the film is steady there, then let go at T = 0
    with the given rate. Both are states that the film equations can continue. A rate disturbs only the film
    made from then on; an offset also changes the level of the whole film and takes one transit (T = 2) to
    settle, which spoils a viscous fit. Hence the default: a rate for an amplitude of about 0.1.

    All of it is dimensionless; `at` takes a mass or a frequency of an `OperatingPoint`.

    Parameters
    ----------
    Omega_n : float
        Dimensionless natural frequency of eq. 5.
    offset : float
        Displacement from static equilibrium (units of the dry approach).
    rate : float, optional
        Initial rate du/dT; by default 0 with an offset, else 0.1 times the dry angular frequency.
    start : {"closing", "opening"}, optional
        Sign of the default rate: the bodies approach first (closing, the default), or separate first (opening, as
        in the paper). With a rate its sign says it, with an offset alone the bodies start at rest.
    """

    Omega_n: float
    offset: float = 0.0
    rate: float | None = None
    start: str | None = field(default=None, compare=False)  # `rate` has its sign
    kind: ClassVar[str] = "free"

    def __post_init__(self) -> None:
        _require_frequency("Omega_n", self.Omega_n)
        if abs(require_finite("offset", self.offset)) > FARTHEST:
            raise InputError("offset", self.offset, f"between -{FARTHEST:g} and {FARTHEST:g} dry approaches")
        sign = 1.0 if self.start is None else STARTS[require_choice("start", self.start, tuple(STARTS))]
        if self.rate is None:
            rate = 0.1 * sign * SMALL_VIBRATION * self.Omega_n if self.offset == 0.0 else 0.0
            object.__setattr__(self, "rate", rate)
        if abs(require_finite("rate", self.rate)) > 2.0 * SMALL_VIBRATION * self.Omega_n:
            raise InputError("rate", self.rate, "within +-2 dry approaches times the dry angular frequency")
        if self.offset == 0.0 and self.rate == 0.0:
            raise InputError("offset", self.offset, "nonzero, or rate nonzero: nothing would move")
        if self.start is not None and self.initial_rate * sign <= 0.0:
            allowed = "left out with an offset alone, which starts at rest, or with the sign of the rate"
            raise InputError("start", self.start, allowed)

    @classmethod
    @takes(mass="kg", offset="m", rate="m/s")
    def at(
        cls,
        point: OperatingPoint,
        *,
        mass: float | None = None,
        omega: float | None = None,
        hz: float | None = None,
        offset: float = 0.0,
        rate: float | None = None,
        start: str | None = None,
    ) -> FreeVibration:
        """The same in SI: of a mass [kg], or of one whose small dry vibrations have a frequency [rad/s] or [Hz].

        `offset` is in m and `rate` in m/s; `start` as above.

        Raises
        ------
        InputError
            Not exactly one of mass, omega and hz; a dimensionless point.
        """
        scales = scales_at(point, "FreeVibration(Omega_n)")
        if (mass is not None) == is_given(omega=omega, hz=hz):
            raise InputError("mass", mass, "given, or omega (rad/s) or hz in its place")
        if mass is not None:
            Omega_n = point.Omega_n(mass)
        else:
            Omega_n = one("frequency", dimensionless(scales.time, omega=omega, hz=hz)) / SMALL_VIBRATION
        at_start = None if rate is None else require_finite("rate", rate) / scales.rate
        fastest = 2.0 * SMALL_VIBRATION * Omega_n
        if at_start is not None and abs(at_start) > fastest:
            words = "2 dry approaches times the dry angular frequency, in either direction"
            raise InputError("rate", rate, f"at most {fastest * scales.rate:.3g} m/s, {words}")
        displaced = require_finite("offset", offset) / scales.length
        if abs(displaced) > FARTHEST:
            allowed = f"at most {FARTHEST * scales.length:.3g} m, {FARTHEST:g} dry approaches, on either side"
            raise InputError("offset", offset, allowed)
        return cls(Omega_n=Omega_n, offset=displaced, rate=at_start, start=start, made_at=point)

    @property
    def period(self) -> float:
        """Period of small dry vibrations, 5.13/Omega_n."""
        return 2.0 * pi / (SMALL_VIBRATION * self.Omega_n)

    @takes(T=parts.ANY)
    def load(self, T: float) -> float:
        """Applied load."""
        return 1.0

    @property
    def default_end(self) -> float:
        """2.5 periods."""
        return 2.5 * self.period

    @property
    def default_step(self) -> float:
        """A fraction of the period."""
        return self.period / STEPS_PER_PERIOD

    @property
    def largest_load(self) -> float:
        """Largest film force to expect, for the domain: dry Hertz load at the amplitude of a linear vibration."""
        return (1.0 + abs(self.offset) + abs(self.initial_rate) / (SMALL_VIBRATION * self.Omega_n)) ** 1.5

    @property
    def size(self) -> float:
        """Amplitude of a linear vibration, in dry approaches."""
        return hypot(self.offset, self.initial_rate / (SMALL_VIBRATION * self.Omega_n))

    @property
    def initial_rate(self) -> float:
        """Rate at T = 0."""
        return self.rate or 0.0

    def held(self, static: float) -> Start | None:
        """The approach they are let go from."""
        u = static + self.offset
        return None if self.offset == 0.0 else Start(Balance.of_approach(u), u)

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"kind": self.kind, "Omega_n": self.Omega_n, "offset": self.offset, "rate": self.rate}


@fields_by_name(
    0,
    omega="Omega, dimensionless; HarmonicLoad.at(point, hz=...) takes SI",
    omega_n="Omega_n, dimensionless",
)
@fields_take(made_at=MADE_AT)
@dataclass(frozen=True, slots=True)
class HarmonicLoad(UnderLoad):
    """Load ``1 + amplitude sin(Omega T)``; quasi-static (eq. 6) unless Omega_n gives the bodies inertia.

    All of it is dimensionless; `at` takes the frequency at an `OperatingPoint` in rad/s, Hz or rev/min.

    Parameters
    ----------
    Omega : float
        Dimensionless angular frequency of the load.
    amplitude : float
        Over the static load.
    Omega_n : float, optional
        Of bodies with inertia: dimensionless natural frequency of eq. 5.
    """

    Omega: float
    amplitude: float = 0.1
    Omega_n: float | None = None
    kind: ClassVar[str] = "harmonic"

    def __post_init__(self) -> None:
        _require_frequency("Omega", self.Omega)
        if not 0.0 < require_positive("amplitude", self.amplitude) < 1.0:
            raise InputError("amplitude", self.amplitude, "above 0 and below 1 (the contact must stay loaded)")
        if self.Omega_n is not None:
            _require_frequency("Omega_n", self.Omega_n)

    @classmethod
    def at(
        cls,
        point: OperatingPoint,
        *,
        amplitude: float = 0.1,
        mass: float | None = None,
        omega: float | None = None,
        hz: float | None = None,
        rpm: float | None = None,
    ) -> HarmonicLoad:
        """The same at a frequency in rad/s, Hz or rev/min, on bodies of a mass [kg] or without inertia.

        Raises
        ------
        InputError
            Not exactly one frequency; a dimensionless point.
        """
        scales = scales_at(point, "HarmonicLoad(Omega)")
        Omega = one("frequency", dimensionless(scales.time, omega=omega, hz=hz, rpm=rpm))
        Omega_n = None if mass is None else point.Omega_n(mass)
        return cls(Omega=Omega, amplitude=amplitude, Omega_n=Omega_n, made_at=point)

    @property
    def period(self) -> float:
        """2 pi/Omega."""
        return 2.0 * pi / self.Omega

    @takes(T=parts.ANY)
    def load(self, T: float) -> float:
        """Applied load."""
        return 1.0 + self.amplitude * sin(self.Omega * T)

    @property
    def default_end(self) -> float:
        """Three periods, and no less than the film's transit and one period."""
        return max(3.0 * self.period, 2.0 + self.period)

    @property
    def default_step(self) -> float:
        """A fraction of the period, and at most half a transit through the semi-axis."""
        return min(self.period / STEPS_PER_PERIOD, self.film_step)

    @property
    def load_period(self) -> float:
        """That of the load."""
        return self.period

    @property
    def largest_load(self) -> float:
        """Largest film force to expect."""
        return 1.0 + self.amplitude

    @property
    def size(self) -> float:
        """Amplitude of the load."""
        return self.amplitude

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"kind": self.kind, "Omega": self.Omega, "amplitude": self.amplitude, "Omega_n": self.Omega_n}


@fields_take(made_at=MADE_AT)
@fields_by_name(2, omega_n="Omega_n, dimensionless")
@dataclass(frozen=True, slots=True)
class RampLoad(UnderLoad):
    """Load rising linearly from 1 to `ratio` within `duration`, then constant, on bodies with inertia.

    All of it is dimensionless; `at` takes load, time and mass at an `OperatingPoint` in SI.

    Parameters
    ----------
    ratio : float
        Load at the end, over the static one.
    duration : float
        Of the ramp, in 2a/u_sum.
    Omega_n : float
        Natural frequency of the bodies, in u_sum/(2a).
    """

    ratio: float
    duration: float
    Omega_n: float
    kind: ClassVar[str] = "ramp"
    film_step: ClassVar[float] = LONGEST_ABRUPT

    def __post_init__(self) -> None:
        for name in ("ratio", "duration"):
            require_positive(name, getattr(self, name))
        _require_frequency("Omega_n", self.Omega_n)

    @classmethod
    @takes(load=parts.PRELOAD, duration=parts.SECONDS, mass=parts.MASS)
    def at(cls, point: OperatingPoint, *, load: float, duration: float, mass: float) -> RampLoad:
        """The same in SI: to a load [N] within a duration [s], on bodies of a mass [kg].

        Raises
        ------
        InputError
            A number that is not positive; a dimensionless point.
        """
        scales = scales_at(point, "RampLoad(ratio, duration, Omega_n)")
        ratio = require_positive("load", load) / scales.force
        within = require_positive("duration", duration) / scales.time
        return cls(ratio, within, Omega_n=point.Omega_n(mass), made_at=point)

    @takes(T=parts.ANY)
    def load(self, T: float) -> float:
        """Applied load."""
        return 1.0 + (self.ratio - 1.0) * min(max(T / self.duration, 0.0), 1.0)

    @property
    def corners(self) -> tuple[float, ...]:
        """End of the ramp."""
        return (self.duration,)

    @property
    def default_end(self) -> float:
        """The ramp and two dry periods after it."""
        return self.duration + 4.0 * pi / (SMALL_VIBRATION * self.Omega_n)

    @property
    def default_step(self) -> float:
        """A fraction of the dry period."""
        return 2.0 * pi / (SMALL_VIBRATION * self.Omega_n) / STEPS_PER_PERIOD

    @property
    def largest_load(self) -> float:
        """Largest film force to expect."""
        return max(1.0, self.ratio)

    @property
    def size(self) -> float:
        """Change of the load."""
        return abs(self.ratio - 1.0) or inf  # at a constant load what moves is on the surfaces

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"kind": self.kind, "ratio": self.ratio, "duration": self.duration, "Omega_n": self.Omega_n}
