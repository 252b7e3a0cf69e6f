"""`Validity`: approach, rate, load and frequency that the data of an element covered; the warning outside it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_numbers, require_finite, require_nonnegative
from ehlcontact.errors import InputError
from ehlcontact.point import Scales

MARGIN = 0.05  # share of the intervals of approach and load, and of the largest rate, that goes unmentioned
STILL = 1e-6  # spread of an approach over its size, below which its frequency means nothing
OCTAVE = (
    2.0  # of frequency that goes unmentioned: in the contact's own band damping changes by a fifth over an octave
)
TURNS = 8  # half cycles over which `HalfCycles` takes a frequency
SMALL = 0.25  # of the largest half cycle, below which one is left out
FADING = 0.99  # of the largest, for each that is left out

# Magnitude of any number of an element, in SI or not, powers of a length in the divisor apart: stiffnesses in N/m
# come to 1e10. Beyond it the units are wrong, and products of several overflow.
LARGEST = 1e15

UNITS = ("dimensionless", "SI")  # of elements and records

Band = tuple[float, float]


class OutsideValidityWarning(UserWarning):
    """An element was used outside the data that it was fitted to; warned once per element and reason."""


@dataclass(frozen=True)
class Validity:
    """What the data covered, a closed box; a bound that is None is not known and does not count.

    Raises
    ------
    InputError
        A bound that is no number or pair of numbers, low >= high, or a negative rate. Bounds are called as in the
        constructor of an element.
    """

    approach: Band
    rate: float | None = None  # largest, in magnitude
    load: Band | None = None  # contact forces
    omega: Band | None = None  # angular frequencies, Omega or rad/s
    # low, high, largest rate, least and most force, all with the margin
    reach: tuple[float, float, float, float, float] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        low, high = self.approach
        low, high = require_finite("low", low), require_finite("high", high)
        if low >= high:
            raise InputError("low", low, f"below high = {high!r}")
        rate = None if self.rate is None else require_nonnegative("rate", self.rate)
        for name, size in (("low", low), ("high", high), ("rate", rate or 0.0)):
            require_size(name, size)
        slack = MARGIN * (high - low)
        fastest = math.inf if rate is None else (1.0 + MARGIN) * rate
        load = _band("load_range", self.load)
        least, most = (-math.inf, math.inf) if load is None else load
        more = MARGIN * (most - least) if load is not None else 0.0
        checked = {
            "approach": (low, high),
            "rate": rate,
            "load": load,
            "omega": _band("omega_range", self.omega, least=0.0),
            "reach": (low - slack, high + slack, fastest, least - more, most + more),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, approach: ArrayLike, rate: ArrayLike | None, force: ArrayLike, omegas: ArrayLike) -> Validity:
        """The box round all samples of a motion, whose rate may be unknown, and round its frequencies."""
        u, f, w = (np.asarray(values, float) for values in (approach, force, omegas))
        fastest = None if rate is None else float(np.abs(np.asarray(rate, float)).max())
        return cls(_around(u), fastest, _around(f), _around(w))

    def covers(
        self, approach: ArrayLike, rate: ArrayLike = 0.0, omega: float | None = None
    ) -> bool | NDArray[np.bool_]:
        """Whether approach, rate and frequency lie in the box; scalars or arrays that broadcast."""
        u, v = np.broadcast_arrays(as_numbers("approach", approach), as_numbers("rate", rate))
        inside = (u >= self.approach[0]) & (u <= self.approach[1])
        if self.rate is not None:
            inside &= np.abs(v) <= self.rate
        if omega is not None and self.omega is not None:
            inside &= self.omega[0] <= omega <= self.omega[1]
        return inside if u.ndim else bool(inside)

    def excess(
        self,
        approach: ArrayLike = (),
        rate: ArrayLike = (),
        omega: float | None = None,
        force: ArrayLike = (),
        units: str = "dimensionless",
    ) -> list[str]:
        """What of a motion lies outside, in words; small excursions go unmentioned.

        Those are a twentieth of the intervals of approach and load and of the largest rate, and an octave of
        frequency. `omega` is in the units of the box, which are `units`.
        """
        outside = []
        m, speed, newton = (" m", " m/s", " N") if units == "SI" else ("", "", "")
        worst = _outside(approach, self.approach)
        if worst is not None:
            outside.append(f"approach {worst:.4g}{m} (fitted {text_of(self.approach)}{m})")
        v = np.abs(np.asarray(rate, float))
        if v.size and v.max() > self.reach[2]:
            outside.append(f"rate {float(v.max()):.4g}{speed} (fitted up to {self.rate:.4g}{speed})")
        worst = None if self.load is None else _outside(force, self.load)
        if self.load is not None and worst is not None:
            outside.append(f"force {worst:.4g}{newton} (fitted {text_of(self.load)}{newton})")
        if omega is not None and self.omega is not None:
            if not self.omega[0] / OCTAVE <= omega <= self.omega[1] * OCTAVE:
                outside.append(f"{frequency_text((omega,), units)} (fitted {frequency_text(self.omega, units)})")
        return outside

    def to_si(self, scales: Scales) -> Validity:
        """The box in m, m/s, N and rad/s."""
        return Validity(
            _scaled(self.approach, scales.length),
            None if self.rate is None else self.rate * scales.rate,
            None if self.load is None else _scaled(self.load, scales.force),
            None if self.omega is None else _scaled(self.omega, 1.0 / scales.time),
        )

    def fields(self) -> dict[str, Any]:
        """The box as arguments of an element."""
        low, high = self.approach
        return {"low": low, "high": high, "rate": self.rate, "load_range": self.load, "omega_range": self.omega}

    def to_dict(self) -> dict[str, Any]:
        """The box as the object ``valid`` of an element's file."""
        named = {key.removesuffix("_range"): value for key, value in self.fields().items()}
        return {key: list(value) if isinstance(value, tuple) else value for key, value in named.items()}

    @classmethod
    def from_dict(cls, valid: Mapping[str, Any]) -> Validity:
        """Read the object ``valid``; all but low and high may be absent or null.

        Raises
        ------
        InputError
            An entry that is missing, no number or no pair of numbers.
        """
        ends = numbers("valid", valid, ("low", "high"))
        rate = None if valid.get("rate") is None else numbers("valid", valid, ("rate",))["rate"]
        return cls((ends["low"], ends["high"]), rate, _read_band(valid, "load"), _read_band(valid, "omega"))


class HalfCycles:
    """Angular frequency of a motion of which approach and rate come one by one, without their times.

    Between two changes of sign of its rate a harmonic motion moves by twice its amplitude A, and its largest rate
    is A omega. The frequency is the root of the sum of (A omega)^2 over the sum of A^2, of `TURNS` half cycles on
    end. Half cycles much smaller than the largest are left out. A drift without change of sign has no frequency,
    and values whose approach does not follow the rate, as those of a table, have none.
    """

    __slots__ = ("amplitudes", "count", "fastest", "largest", "outside", "peak", "place", "rates", "rising")

    def __init__(self) -> None:
        self.rising, self.peak, self.place = True, 0.0, math.nan  # where the rate changed its sign last
        self.largest, self.fastest = 0.0, 0.0  # half cycle: distance, rate
        self._begin()

    def _begin(self) -> None:
        self.count, self.rates, self.amplitudes = 0, 0.0, 0.0
        self.outside = False  # whether the frequency before, of this motion, was outside the band

    def turn(self, approach: float, rate: float) -> float | None:
        """End a half cycle at `approach`, where `rate` has another sign; the frequency after `TURNS` of them."""
        moved = approach - self.place if self.rising else self.place - approach
        peak, size = self.peak, STILL * abs(approach)
        self.rising, self.peak, self.place = rate > 0.0, abs(rate), approach
        if not moved > max(SMALL * self.largest, size):
            if moved <= 0.0 and peak > SMALL * self.fastest:
                self._begin()
            self.largest, self.fastest = FADING * self.largest, FADING * self.fastest
            return None
        if SMALL * moved > self.largest:
            self._begin()
        self.largest, self.fastest = max(self.largest, moved), max(self.fastest, peak)
        self.count += 1
        self.rates += peak**2
        self.amplitudes += 0.25 * moved**2
        if self.count < TURNS:
            return None
        omega = math.sqrt(self.rates / self.amplitudes)
        self.count, self.rates, self.amplitudes = 0, 0.0, 0.0
        return omega


def frequency_of(approach: NDArray[np.float64], rate: NDArray[np.float64]) -> float | None:
    """RMS angular frequency of a motion; None where it hardly moves."""
    if approach.size == 0:
        return None
    spread = float(np.std(approach))
    return float(np.std(rate)) / spread if spread > STILL * float(np.abs(approach).max()) else None


def text_of(band: Band) -> str:
    """The band in words."""
    return f"{band[0]:.4g} to {band[1]:.4g}"


def frequency_text(values: tuple[float, ...], units: str) -> str:
    """One frequency or a band in words: Omega, or in SI Hz of rad/s."""
    unit = 2.0 * math.pi if units == "SI" else 1.0
    numbers = " to ".join(_plain(w / unit) for w in dict.fromkeys(values))
    return f"{numbers} Hz" if units == "SI" else f"Omega {numbers}"


def _plain(value: float) -> str:
    """Four digits, and no exponent for kilohertz."""
    return f"{float(f'{value:.4g}'):.0f}" if 1e4 <= value < 1e7 else f"{value:.4g}"


def _around(values: NDArray[np.float64]) -> Band:
    return float(values.min()), float(values.max())


def _outside(values: ArrayLike, band: Band) -> float | None:
    """The value farthest outside `band`, None where all lie inside or within the margin."""
    array = np.asarray(values, float)
    if not array.size:
        return None
    (low, high), (least, most) = band, _around(array)
    slack = MARGIN * (high - low)
    if least < low - slack or most > high + slack:
        return most if most - high > low - least else least
    return None


def _scaled(band: Band, unit: float) -> Band:
    return band[0] * unit, band[1] * unit


def require_size(field: str, value: float, largest: float = LARGEST) -> None:
    """Raise `InputError` for a number of an element that is larger in magnitude than any contact has."""
    if not abs(value) <= largest:
        raise InputError(field, value, f"at most {largest:g} in magnitude (the units may be wrong)")


def _band(name: str, value: Any, least: float = -math.inf) -> Band | None:
    if value is None:
        return None
    try:
        low, high = value
    except (TypeError, ValueError):
        raise InputError(name, value, "a pair (low, high) of numbers") from None
    low, high = require_finite(name, low), require_finite(name, high)
    if low > high or low < least:
        limit = f", both >= {least:g}" if least > -math.inf else ""
        raise InputError(name, (low, high), f"a pair with low <= high{limit}")
    for end in (low, high):
        require_size(name, end)
    return low, high


def _read_band(valid: Mapping[str, Any], key: str) -> Band | None:
    value = valid.get(key)
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"valid.{key}", value, "a pair of finite numbers, or null")
    pair = numbers(f"valid.{key}", {"low": value[0], "high": value[1]}, ("low", "high"))
    return pair["low"], pair["high"]


def numbers(section: str, entries: Mapping[str, Any], required: tuple[str, ...]) -> dict[str, float]:
    """Return the `required` entries of a section as floats.

    Raises
    ------
    InputError
        One is absent or not a finite number.
    """
    values: dict[str, float] = {}
    for key in required:
        value = entries.get(key)
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not math.isfinite(value):  # type: ignore[arg-type]
            raise InputError(f"{section}.{key}", value, "a finite number")
        values[key] = float(value)  # type: ignore[arg-type]
    return values
