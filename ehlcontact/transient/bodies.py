"""Motion of the bodies: base classes with the equation that closes a step, end, default step and corners.

There are three kinds: a prescribed approach (`prescribed.PrescribedApproach`), and bodies under a load, with or
without inertia. With inertia the approach obeys ``u''/Omega_n^2 + f = f_ext`` (eq. 5), integrated by Newmark's
rule; without it the film carries the load at every instant (eq. 6). A `Motion` gives the `Balance` that closes
a step and the state of the bodies after it, so that no other code depends on the kind.

Every motion is dimensionless: times in 2a/u_sum, loads over the static one, approaches over the dry one. The class
method `at` of each makes it for an `OperatingPoint` from SI: seconds, newton, metres, kilograms, rad/s or Hz.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import astuple, dataclass, field
from math import inf, isclose
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import shown
from ehlcontact.checks.kinds import Object
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point, Scales
from ehlcontact.solver.balance import Balance

Array = NDArray[np.float64]
MADE_AT = Object(OperatingPoint, "an OperatingPoint")

# Fixed steps, in the time in which the film goes on by a semi-axis. Under a load that bends from 1 to 1.3 and back
# within T = 2 the shorter one leaves 0.2 % of the smallest film open, 0.25 leaves 2 %, 0.5 leaves 7 % and 1 leaves
# 13 % ((200, 10, 0.5), n = 64).
LONGEST_SMOOTH, LONGEST_ABRUPT = 0.5, 0.1

SAME_POINT = 1e-9  # of a unit: points that differ by less, as by rounding, are one

_KINDS: dict[str, type[Motion]] = {}


@dataclass(frozen=True, slots=True)
class MotionState:
    """Motion of the bodies at one time."""

    T: float
    u: float  # mutual approach / dry approach
    rate: float  # du/dT
    acceleration: float  # d2u/dT2; 0 where no equation of motion gives it


def scales_at(point: object, dimensionless: str) -> Scales:
    """Return the SI units of a point, or raise `InputError`; `dimensionless` is the call for a `MoesPoint`."""
    if not isinstance(point, OperatingPoint):
        allowed = f"an OperatingPoint; a dimensionless one takes {dimensionless}"
        raise InputError("point", shown(point), allowed)
    return point.scales


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OverTime:
    """Motion, speed or surface over dimensionless time, with the point at which it was made from SI units.

    Attributes
    ----------
    made_at : OperatingPoint or None
        Whose seconds, metres and newton it was given in. Not part of what it is: neither compared nor stored.
    """

    made_at: OperatingPoint | None = field(default=None, repr=False, compare=False)
    MADE_BY: ClassVar[str] = "at(point, ...)"

    def require_point(self, name: str, point: Point) -> None:
        """Raise `InputError`, with its `name`, at a point where it would not be what SI units said of it.

        The Moes point of the point where it was made is no other one.
        """
        own = self.made_at
        if own is None:
            return
        if isinstance(point, OperatingPoint):
            theirs, ours = astuple(own.scales), astuple(point.scales)
        else:
            theirs, ours = ((one.M, one.L, one.kappa) for one in (own.moes, point))
        if not all(isclose(a, b, rel_tol=SAME_POINT) for a, b in zip(theirs, ours, strict=True)):
            allowed = f"made with {type(self).__name__}.{self.MADE_BY} of the point of this run"
            raise InputError(name, "made at another operating point", allowed)


class Start(NamedTuple):
    """What holds the contact still until T = 0, in place of the static load."""

    balance: Balance
    u: float  # guess


class Motion(OverTime, ABC):
    """Motion of a contact: equation that closes a step, state of the bodies, end and default step of a run."""

    __slots__ = ()
    kind: ClassVar[str]  # its name in files
    film_step: ClassVar[float] = LONGEST_SMOOTH  # fixed step that the film allows, whatever the motion's own

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
        """Step that resolves the motion itself; a fixed step of a run is `film_step` at most."""

    @property
    def load_period(self) -> float:
        """Period of a load that goes on swinging; infinite where there is none."""
        return inf

    @property
    @abstractmethod
    def largest_load(self) -> float:
        """Largest film force to expect, for the domain."""

    @property
    def size(self) -> float:
        """How far it leads away from rest, in static loads or dry approaches: where it is small, `tol` follows it.

        Infinite where the approach is given: the film alone is to be found then, and its error falls with the
        motion by itself.
        """
        return inf

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
    """Bodies under the load ``f_ext(T)`` (static load 1), with inertia if they have an `Omega_n`."""

    __slots__ = ()
    Omega_n: float | None

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
        acceleration = self.Omega_n**2 * (self.load(0.0) - force) if self.Omega_n else 0.0
        return MotionState(0.0, u, self.initial_rate, acceleration)

    def balance(self, now: MotionState, T: float, dT: float) -> tuple[Balance, float]:
        """Newmark's rule, or the load itself."""
        if not self.Omega_n:
            return Balance.of_load(self.load(T)), now.u + dT * now.rate
        predictor = _predictor(now, dT)
        guess = predictor + 0.25 * dT * dT * now.acceleration
        return Balance.newmark(self.Omega_n, dT, self.load(T), predictor), guess

    def after(self, now: MotionState, u: float, T: float, dT: float) -> MotionState:
        """Newmark's rule with gamma = 1/2; without inertia the mean rate of the step."""
        if not self.Omega_n:
            return MotionState(T, u, (u - now.u) / dT, 0.0)
        acceleration = 4.0 * (u - _predictor(now, dT)) / (dT * dT)
        return MotionState(T, u, now.rate + 0.5 * dT * (now.acceleration + acceleration), acceleration)

    def slopes(self, T: Array, approach: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
        """As integrated; without inertia no equation gives them."""
        if self.Omega_n:
            return rate, acceleration
        rate = np.gradient(approach, T, edge_order=2)
        return rate, np.gradient(rate, T, edge_order=2)

    def free(self, approach: float, force: float) -> tuple[float, ...]:
        """Without inertia the force is the load."""
        return (approach, force) if self.Omega_n else (approach,)


def _predictor(now: MotionState, dT: float) -> float:
    """Approach `dT` ahead by Newmark's rule (beta = 1/4), but for the share of the new acceleration."""
    return now.u + dT * now.rate + 0.25 * dT * dT * now.acceleration
