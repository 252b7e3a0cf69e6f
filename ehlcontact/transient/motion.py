"""What drives a transient contact: loads and motions as functions of dimensionless time T.

Three kinds: a driven approach (`prescribed.PrescribedApproach`), and bodies under a load, with inertia or without.
With it the approach obeys ``u''/Omega_n^2 + f = f_ext`` (eq. 5), integrated by Newmark's rule; without it the film
carries the load at every instant (eq. 6). A `Motion` says by which `Balance` a step is closed and how the bodies
move once it is solved, so that nobody else asks which kind it is.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import pi, sin
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_positive
from ehlcontact.errors import InputError
from ehlcontact.solver.balance import Balance

Array = NDArray[np.float64]

SMALL_VIBRATION = 1.5**0.5  # dry angular frequency over Omega_n
STEPS_PER_PERIOD = 80

# Of bodies and loads, in 1/T: below, nothing moves while a bearing turns a thousand times; above, it is hundreds
# of times faster than any body on a film. A frequency beyond was given in other units, or with another mass.
SLOWEST, FASTEST = 1e-6, 1e3

_KINDS: dict[str, type[Motion]] = {}


@dataclass(frozen=True, slots=True)
class MotionState:
    """Motion of the bodies at one time."""

    T: float
    u: float  # mutual approach / dry approach
    rate: float  # du/dT
    acceleration: float  # d2u/dT2; 0 where no equation of motion gives it


class Start(NamedTuple):
    """What holds the contact still until T = 0, in place of the static load."""

    balance: Balance
    u: float  # guess


class Motion(ABC):
    """What drives a contact: closes its steps, moves its bodies, and says how long and in what steps it runs."""

    __slots__ = ()
    kind: ClassVar[str]  # its name in files

    def __init_subclass__(cls) -> None:
        if "kind" in vars(cls):
            _KINDS[cls.kind] = cls

    @property
    def corners(self) -> tuple[float, ...]:
        """Times at which the slope jumps: controlled steps end there and begin anew."""
        return ()

    @property
    @abstractmethod
    def default_end(self) -> float:
        """Time at which a run ends."""

    @property
    @abstractmethod
    def default_step(self) -> float:
        """Fixed step of a run."""

    @property
    @abstractmethod
    def largest_load(self) -> float:
        """Largest film force to expect, for the domain."""

    @abstractmethod
    def applied(self, T: float, force: float) -> float:
        """Load on the bodies: the motion's own, or, where the approach is driven, the film `force` it takes."""

    @abstractmethod
    def held(self, static: float) -> Start | None:
        """What holds the contact at rest before T = 0; None if that is load 1, with the approach `static`."""

    @abstractmethod
    def begin(self, u: float, force: float) -> MotionState:
        """State at T = 0, of the film at rest with approach `u` and film force `force`."""

    @abstractmethod
    def balance(self, now: MotionState, T: float, dT: float) -> tuple[Balance, float]:
        """Equation that closes the step of length `dT` from `now` to `T`, and a guess of the approach there."""

    @abstractmethod
    def after(self, now: MotionState, u: float, T: float, dT: float) -> MotionState:
        """State at `T`, where the step from `now` led to the approach `u`."""

    @abstractmethod
    def slopes(self, T: Array, approach: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
        """Rate and acceleration of a record, shape (k,): as integrated, else second-order differences of it."""

    @abstractmethod
    def free(self, approach: float, force: float) -> tuple[float, ...]:
        """Those of two errors that count: what is prescribed has none."""

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """For storage."""

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Motion:
        """Rebuild a motion of any kind from `to_dict`.

        Raises
        ------
        InputError
            An unknown kind.
        """
        arguments = dict(data)
        kind = arguments.pop("kind", None)
        if kind not in _KINDS:
            raise InputError("motion.kind", kind, "one of " + ", ".join(_KINDS))
        return _KINDS[kind](**arguments)


class UnderLoad(Motion):
    """Bodies under the load ``f_ext(T)`` (static load 1), with inertia if they have an `omega_n`."""

    __slots__ = ()
    omega_n: float | None

    @abstractmethod
    def load(self, T: float) -> float:
        """Applied load."""

    @property
    def initial_rate(self) -> float:
        """Rate at T = 0."""
        return 0.0

    def applied(self, T: float, force: float) -> float:
        """The load, whatever the film carries."""
        return self.load(T)

    def held(self, static: float) -> Start | None:
        """The load at T = 0, where that is not 1."""
        load = self.load(0.0)
        return None if load == 1.0 else Start(Balance.of_load(load), static)

    def begin(self, u: float, force: float) -> MotionState:
        """At the initial rate, accelerated by what the film does not carry."""
        acceleration = self.omega_n**2 * (self.load(0.0) - force) if self.omega_n else 0.0
        return MotionState(0.0, u, self.initial_rate, acceleration)

    def balance(self, now: MotionState, T: float, dT: float) -> tuple[Balance, float]:
        """Newmark's rule, or the load itself."""
        if not self.omega_n:
            return Balance.of_load(self.load(T)), now.u + dT * now.rate
        predictor = _predictor(now, dT)
        guess = predictor + 0.25 * dT * dT * now.acceleration
        return Balance.newmark(self.omega_n, dT, self.load(T), predictor), guess

    def after(self, now: MotionState, u: float, T: float, dT: float) -> MotionState:
        """Newmark's rule with gamma = 1/2; without inertia the mean rate of the step."""
        if not self.omega_n:
            return MotionState(T, u, (u - now.u) / dT, 0.0)
        acceleration = 4.0 * (u - _predictor(now, dT)) / (dT * dT)
        return MotionState(T, u, now.rate + 0.5 * dT * (now.acceleration + acceleration), acceleration)

    def slopes(self, T: Array, approach: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
        """As integrated; without inertia no equation gives them."""
        if self.omega_n:
            return rate, acceleration
        rate = np.gradient(approach, T, edge_order=2)
        return rate, np.gradient(rate, T, edge_order=2)

    def free(self, approach: float, force: float) -> tuple[float, ...]:
        """Without inertia the force is the load."""
        return (approach, force) if self.omega_n else (approach,)


def _require_frequency(field: str, value: object) -> None:
    """Raise `InputError` unless it is a dimensionless frequency that a contact can have."""
    if not SLOWEST <= require_positive(field, value) <= FASTEST:
        unit = "in units of u_sum/(2a), not rad/s or Hz"
        raise InputError(field, value, f"between {SLOWEST:g} and {FASTEST:g} ({unit})")


def _predictor(now: MotionState, dT: float) -> float:
    """Approach `dT` ahead by Newmark's rule (beta = 1/4), but for the share of the new acceleration."""
    return now.u + dT * now.rate + 0.25 * dT * dT * now.acceleration


@dataclass(frozen=True, slots=True)
class FreeVibration(UnderLoad):
    """Free vibration of a mass on the contact under constant load 1.

    The bodies are held at ``static approach + offset`` until the film is steady there, then let go at T = 0
    with the given rate. Both are states that the film equations can continue. A rate disturbs only the film
    made from then on; an offset also changes the level of the whole film and takes one transit (T = 2) to
    settle, which spoils a viscous fit. Hence the default: a rate for an amplitude of about 0.1.

    Parameters
    ----------
    omega_n : float
        Dimensionless natural frequency Omega_n of eq. 5.
    offset : float
        Displacement from static equilibrium (units of the dry approach).
    rate : float, optional
        Initial rate du/dT; by default 0 with an offset, else 0.1 times the dry angular frequency.
    """

    omega_n: float
    offset: float = 0.0
    rate: float | None = None
    kind: ClassVar[str] = "free"

    def __post_init__(self) -> None:
        _require_frequency("omega_n", self.omega_n)
        if abs(require_finite("offset", self.offset)) > 2.0:
            raise InputError("offset", self.offset, "between -2 and 2 dry approaches")
        if self.rate is None:
            rate = 0.1 * SMALL_VIBRATION * self.omega_n if self.offset == 0.0 else 0.0
            object.__setattr__(self, "rate", rate)
        if abs(require_finite("rate", self.rate)) > 2.0 * SMALL_VIBRATION * self.omega_n:
            raise InputError("rate", self.rate, "within +-2 dry approaches times the dry angular frequency")
        if self.offset == 0.0 and self.rate == 0.0:
            raise InputError("offset", self.offset, "nonzero, or rate nonzero: nothing would move")

    @property
    def period(self) -> float:
        """Period of small dry vibrations, 5.13/Omega_n."""
        return 2.0 * pi / (SMALL_VIBRATION * self.omega_n)

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
        return (1.0 + abs(self.offset) + abs(self.initial_rate) / (SMALL_VIBRATION * self.omega_n)) ** 1.5

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
        return {"kind": self.kind, "omega_n": self.omega_n, "offset": self.offset, "rate": self.rate}


@dataclass(frozen=True, slots=True)
class HarmonicLoad(UnderLoad):
    """Load ``1 + amplitude sin(omega T)``; quasi-static (eq. 6) unless omega_n gives the bodies inertia."""

    omega: float
    amplitude: float = 0.1
    omega_n: float | None = None
    kind: ClassVar[str] = "harmonic"

    def __post_init__(self) -> None:
        _require_frequency("omega", self.omega)
        if not 0.0 < require_positive("amplitude", self.amplitude) < 1.0:
            raise InputError("amplitude", self.amplitude, "above 0 and below 1 (the contact must stay loaded)")
        if self.omega_n is not None:
            _require_frequency("omega_n", self.omega_n)

    @property
    def period(self) -> float:
        """2 pi/omega."""
        return 2.0 * pi / self.omega

    def load(self, T: float) -> float:
        """Applied load."""
        return 1.0 + self.amplitude * sin(self.omega * T)

    @property
    def default_end(self) -> float:
        """Three periods, and no less than the film's transit and one period."""
        return max(3.0 * self.period, 2.0 + self.period)

    @property
    def default_step(self) -> float:
        """A fraction of the period, and at most half a transit through the semi-axis."""
        return min(self.period / STEPS_PER_PERIOD, 0.5)

    @property
    def largest_load(self) -> float:
        """Largest film force to expect."""
        return 1.0 + self.amplitude

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"kind": self.kind, "omega": self.omega, "amplitude": self.amplitude, "omega_n": self.omega_n}


@dataclass(frozen=True, slots=True)
class RampLoad(UnderLoad):
    """Load rising linearly from 1 to `ratio` within `duration`, then constant, on bodies with inertia."""

    ratio: float
    duration: float
    omega_n: float
    kind: ClassVar[str] = "ramp"

    def __post_init__(self) -> None:
        for name in ("ratio", "duration"):
            require_positive(name, getattr(self, name))
        _require_frequency("omega_n", self.omega_n)

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
        return self.duration + 4.0 * pi / (SMALL_VIBRATION * self.omega_n)

    @property
    def default_step(self) -> float:
        """A fraction of the dry period."""
        return 2.0 * pi / (SMALL_VIBRATION * self.omega_n) / STEPS_PER_PERIOD

    @property
    def largest_load(self) -> float:
        """Largest film force to expect."""
        return max(1.0, self.ratio)

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"kind": self.kind, "ratio": self.ratio, "duration": self.duration, "omega_n": self.omega_n}
