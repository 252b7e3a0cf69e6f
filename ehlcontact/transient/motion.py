"""What drives a transient contact: loads and motions as functions of dimensionless time T.

A motion gives the load ``f_ext(T)`` (static load 1), whether the bodies have inertia (``omega_n``), and how
the record starts. With inertia the approach obeys ``u''/Omega_n^2 + f = f_ext`` (eq. 5); without it the film
carries the load at every instant (eq. 6); `PrescribedApproach` drives u itself. Its ``corners`` are the times at
which its slope jumps: controlled time steps end there and begin anew.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import pi, sin
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_finite, require_positive
from ehlcontact.errors import InputError
from ehlcontact.transient.table import Tabulated, as_table

SMALL_VIBRATION = 1.5**0.5  # dry angular frequency over Omega_n
STEPS_PER_PERIOD = 80
CORNER = 0.3  # jump of a table's slope, over its steepest, that counts as a corner; 1/20 period of a sine is 0.31


@dataclass(frozen=True, slots=True)
class FreeVibration:
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
    corners: ClassVar[tuple[float, ...]] = ()

    def __post_init__(self) -> None:
        require_positive("omega_n", self.omega_n)
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

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"kind": self.kind, "omega_n": self.omega_n, "offset": self.offset, "rate": self.rate}


@dataclass(frozen=True, slots=True)
class HarmonicLoad:
    """Load ``1 + amplitude sin(omega T)``; quasi-static (eq. 6) unless omega_n gives the bodies inertia."""

    omega: float
    amplitude: float = 0.1
    omega_n: float | None = None
    kind: ClassVar[str] = "harmonic"
    corners: ClassVar[tuple[float, ...]] = ()

    def __post_init__(self) -> None:
        require_positive("omega", self.omega)
        if not 0.0 < require_positive("amplitude", self.amplitude) < 1.0:
            raise InputError("amplitude", self.amplitude, "above 0 and below 1 (the contact must stay loaded)")
        if self.omega_n is not None:
            require_positive("omega_n", self.omega_n)

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
class RampLoad:
    """Load rising linearly from 1 to `ratio` within `duration`, then constant, on bodies with inertia."""

    ratio: float
    duration: float
    omega_n: float
    kind: ClassVar[str] = "ramp"

    def __post_init__(self) -> None:
        for name in ("ratio", "duration", "omega_n"):
            require_positive(name, getattr(self, name))

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


@dataclass(frozen=True, slots=True, eq=False)
class PrescribedLoad(Tabulated):
    """Load given by a table (linear interpolation) on bodies with (`omega_n`) or without inertia."""

    T: ArrayLike
    values: ArrayLike
    omega_n: float | None = None
    kind: ClassVar[str] = "load"
    _table: tuple[NDArray[np.float64], NDArray[np.float64]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        table = as_table("values", self.T, self.values)
        if not (table[1] > 0.0).all():
            raise InputError("values", float(table[1].min()), "loads > 0 (the contact must stay loaded)")
        if self.omega_n is not None:
            require_positive("omega_n", self.omega_n)
        object.__setattr__(self, "_table", table)

    @classmethod
    def from_function(
        cls, load: Callable[[float], float], until: float, steps: int = 1000, omega_n: float | None = None
    ) -> PrescribedLoad:
        """Sample a function of T on [0, until]."""
        T = np.linspace(0.0, require_positive("until", until), steps + 1)
        return cls(T, [load(t) for t in T], omega_n)

    def load(self, T: float) -> float:
        """Applied load."""
        return float(np.interp(T, *self._table))

    @property
    def corners(self) -> tuple[float, ...]:
        """Times of the table at which its slope jumps by more than `CORNER` of its steepest slope."""
        T, values = self._table
        slope = np.diff(values) / np.diff(T)
        jump = np.abs(np.diff(slope)) > CORNER * np.abs(slope).max()
        return tuple(T[1:-1][jump].tolist())

    @property
    def largest_load(self) -> float:
        """Largest load of the table."""
        return float(self._table[1].max())

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        T, values = self._table
        return {"kind": self.kind, "T": T.tolist(), "values": values.tolist(), "omega_n": self.omega_n}


@dataclass(frozen=True, slots=True, eq=False)
class PrescribedApproach(Tabulated):
    """Approach u(T) given by a table (cubic spline, so that the rate is continuous)."""

    T: ArrayLike
    values: ArrayLike
    kind: ClassVar[str] = "approach"
    corners: ClassVar[tuple[float, ...]] = ()
    omega_n: ClassVar[None] = None
    _table: tuple[NDArray[np.float64], NDArray[np.float64]] = field(init=False, repr=False)
    _spline: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        from scipy.interpolate import CubicSpline

        table = as_table("values", self.T, self.values)
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "_spline", CubicSpline(*table))

    def approach(self, T: float) -> float:
        """Prescribed approach."""
        return float(self._spline(T))

    def rate(self, T: float) -> float:
        """Rate of the prescribed approach."""
        return float(self._spline(T, 1))

    @property
    def largest_load(self) -> float:
        """Dry Hertz load at the largest approach."""
        return max(1.0, float(self._table[1].max())) ** 1.5

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        T, values = self._table
        return {"kind": self.kind, "T": T.tolist(), "values": values.tolist()}


Motion = FreeVibration | HarmonicLoad | RampLoad | PrescribedLoad | PrescribedApproach

_KINDS = {cls.kind: cls for cls in (FreeVibration, HarmonicLoad, RampLoad, PrescribedLoad, PrescribedApproach)}


def motion_from_dict(data: dict[str, Any]) -> Motion:
    """Rebuild a motion from `to_dict`."""
    arguments = dict(data)
    kind = arguments.pop("kind", None)
    if kind not in _KINDS:
        raise InputError("motion.kind", kind, "one of " + ", ".join(_KINDS))
    return _KINDS[kind](**arguments)
