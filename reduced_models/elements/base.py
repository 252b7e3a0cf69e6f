"""What every contact element carries: coefficients, validity box, quality and source, units, file."""

from __future__ import annotations

import math
import os
import warnings
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_choice, require_finite, require_instance, require_nonnegative
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.elements.file import UNITS, band, numbers, read_document, write_document
from reduced_models.elements.validity import MARGIN, OCTAVE, Band, OutsideValidityWarning, text_of

SAME_SCALES = 1e-6  # relative; more than a rounded file or another order of the same arithmetic makes
_SCALED_BY = ("force", "length", "time")


class ContactElement(ABC):
    """Base of all elements, with or without memory.

    A subclass is a frozen dataclass with its coefficients, named in ``parameter_names``, and the fields below.
    Approach in units of the dry Hertz approach or m, rate in its time derivative, force in units of the static
    load or N: see ``units``.

    The validity box holds what the data covered: approach [low, high], largest ``rate``, forces ``load_range``
    and angular frequencies ``omega_range``. Force and tangents may be asked for anywhere; a simulation that
    leaves the box (`advance`, `simulate_oscillator`) warns, once per element.
    """

    kind: ClassVar[str]
    parameter_names: ClassVar[tuple[str, ...]]
    low: float
    high: float
    rate: float | None
    load_range: Band | None
    omega_range: Band | None
    units: str
    fit: Mapping[str, Any] | None
    source: Mapping[str, Any] | None
    _box: tuple[float, float, float]  # low, high and largest rate with the margin
    _warned: bool

    def __post_init__(self) -> None:
        require_choice("units", self.units, UNITS)
        for name in (*self.parameter_names, "low", "high"):
            object.__setattr__(self, name, require_finite(name, getattr(self, name)))
        if self.low >= self.high:
            raise InputError("low", self.low, f"below high = {self.high!r}")
        if self.rate is not None:
            object.__setattr__(self, "rate", require_nonnegative("rate", self.rate))
        for name in ("load_range", "omega_range"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _band(name, getattr(self, name)))
        slack = MARGIN * (self.high - self.low)
        fastest = math.inf if self.rate is None else (1.0 + MARGIN) * self.rate
        object.__setattr__(self, "_box", (self.low - slack, self.high + slack, fastest))
        object.__setattr__(self, "_warned", False)

    @abstractmethod
    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step `dt`, at the approach and rate of that end; moves the state there."""

    @abstractmethod
    def save_state(self) -> object:
        """Copy of the internal state; None without memory."""

    @abstractmethod
    def restore_state(self, state: object) -> None:
        """Go back to a saved state."""

    @abstractmethod
    def rest(self, approach: float) -> float:
        """Put the contact at rest at this approach; returns the static force."""

    @abstractmethod
    def spring(self, approach: ArrayLike) -> float | NDArray[np.float64]:
        """Static force."""

    @abstractmethod
    def spring_tangent(self, approach: float) -> float:
        """Slope of the static force."""

    @abstractmethod
    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """What `advance` would return, and its derivatives dF/du and dF/du'; the state stays."""

    @property
    @abstractmethod
    def state_count(self) -> int:
        """Number of states in continuous time; none without memory."""

    @abstractmethod
    def state_rates(
        self, states: NDArray[np.float64], approach: float, rate: float
    ) -> tuple[float, NDArray[np.float64]]:
        """Force and d(states)/dt in continuous time; the element's own state is not touched."""

    @abstractmethod
    def rate_under(self, states: NDArray[np.float64], approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0: the motion without inertia."""

    @abstractmethod
    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0."""

    def copy(self) -> Self:
        """The same element with a state of its own, at rest."""
        return replace(self)  # type: ignore[type-var]

    @abstractmethod
    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        """Fields of the element in SI, its validity box and units apart."""

    @property
    def parameters(self) -> dict[str, float]:
        """Coefficients by name."""
        return {name: getattr(self, name) for name in self.parameter_names}

    @property
    def rms(self) -> float | None:
        """RMS error of the force over its standard deviation, None for an element that was not fitted."""
        return None if self.fit is None else self.fit.get("rms")

    def is_valid(
        self, approach: ArrayLike, rate: ArrayLike = 0.0, omega: float | None = None
    ) -> bool | NDArray[np.bool_]:
        """Whether the data covered this approach and rate, and motion of angular frequency `omega`.

        The box is closed; a bound that is not known does not count.
        """
        u, v = np.broadcast_arrays(np.asarray(approach, float), np.asarray(rate, float))
        inside = (u >= self.low) & (u <= self.high)
        if self.rate is not None:
            inside &= np.abs(v) <= self.rate
        if omega is not None and self.omega_range is not None:
            inside &= self.omega_range[0] <= omega <= self.omega_range[1]
        return inside if u.ndim else bool(inside)

    def warn_outside(
        self,
        approach: ArrayLike = (),
        rate: ArrayLike = (),
        omega: float | None = None,
        force: ArrayLike = (),
        stacklevel: int = 2,
    ) -> None:
        """Warn, once per element, where a motion leaves the validity box.

        Small excursions go unmentioned: a twentieth of the intervals of approach and load or of the largest
        rate, an octave of frequency.

        Parameters
        ----------
        approach, rate : array_like
            Of the motion.
        omega : float, optional
            Its angular frequency.
        force : array_like
            Contact forces along it.
        """
        if self._warned:
            return
        low, high, fastest = self._box
        u, v = np.asarray(approach, float), np.abs(np.asarray(rate, float))
        said = []
        if u.size and (u.min() < low or u.max() > high):
            worst = u.max() if u.max() - high > low - u.min() else u.min()
            said.append(f"approach {float(worst):.4g} (fitted {text_of((self.low, self.high))})")
        if v.size and v.max() > fastest:
            said.append(f"rate {float(v.max()):.4g} (fitted up to {self.rate:.4g})")
        f = np.asarray(force, float)
        if f.size and self.load_range is not None:
            least, most = self.load_range
            slack = MARGIN * (most - least)
            if f.min() < least - slack or f.max() > most + slack:
                worst = f.max() if f.max() - most > least - f.min() else f.min()
                said.append(f"force {float(worst):.4g} (fitted {text_of(self.load_range)})")
        if omega is not None and self.omega_range is not None:
            if not self.omega_range[0] / OCTAVE <= omega <= self.omega_range[1] * OCTAVE:
                said.append(f"angular frequency {omega:.4g} (fitted {text_of(self.omega_range)})")
        if said:
            object.__setattr__(self, "_warned", True)
            message = f"{type(self).__name__} used outside its validity box: {', '.join(said)}"
            warnings.warn(message, OutsideValidityWarning, stacklevel=stacklevel + 1)

    def to_si(self, scales: Scales) -> Self:
        """The same element in m, m/s and N.

        Parameters
        ----------
        scales : Scales
            Of the operating point that the dimensionless element was fitted at.

        Raises
        ------
        InputError
            The element is in SI already, or its ``source`` knows the scales and they are others.
        """
        require_instance("scales", scales, Scales, "the Scales of an operating point")
        if self.units == "SI":
            raise InputError("units", self.units, "dimensionless, to be taken to SI")
        _require_own_scales(scales, self.source)
        changes = self._si_coefficients(scales)
        changes |= {"low": self.low * scales.length, "high": self.high * scales.length, "units": "SI"}
        changes["rate"] = None if self.rate is None else self.rate * scales.rate
        for name, unit in (("load_range", scales.force), ("omega_range", 1.0 / scales.time)):
            bounds = getattr(self, name)
            changes[name] = None if bounds is None else (bounds[0] * unit, bounds[1] * unit)
        return replace(self, **changes)  # type: ignore[type-var]

    def to_dict(self) -> dict[str, Any]:
        """Content of the element file, header apart."""
        valid: dict[str, Any] = {"low": self.low, "high": self.high, "rate": self.rate}
        for key, bounds in (("load", self.load_range), ("omega", self.omega_range)):
            valid[key] = None if bounds is None else list(bounds)
        return {
            "kind": self.kind,
            "units": self.units,
            "parameters": self.parameters,
            "valid": valid,
            "fit": None if self.fit is None else dict(self.fit),
            "source": None if self.source is None else dict(self.source),
        }

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the element as JSON, replacing an existing file in one move.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        return write_document(path, self.to_dict())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read an element of this class.

        Raises
        ------
        InputError
            Not a readable element file of this kind; the message names the file and what is wrong.
        """
        return cls.from_document(str(path), read_document(path))

    @classmethod
    def from_document(cls, name: str, document: Mapping[str, Any]) -> Self:
        """Build the element from a document of `read_document`; `name` is the file, for messages.

        Raises
        ------
        InputError
            Another kind, an entry that is missing or no number, or coefficients that make no contact.
        """
        if document["kind"] != cls.kind:
            raise InputError(name, f"kind {document['kind']!r}", f"of kind {cls.kind!r}")
        values: dict[str, Any] = {**numbers(name, "parameters", document["parameters"], cls.parameter_names)}
        valid = document["valid"]
        values |= numbers(name, "valid", valid, ("low", "high"))
        values |= {f"{key}_range": band(name, valid, key) for key in ("load", "omega")}
        values["rate"] = None if valid.get("rate") is None else numbers(name, "valid", valid, ("rate",))["rate"]
        values |= {key: document.get(key) for key in ("units", "fit", "source")}
        try:
            return cls(**values)
        except InputError as error:
            raise InputError(f"{name}: {error.field}", error.value, error.allowed) from None


def _require_own_scales(scales: Scales, source: Mapping[str, Any] | None) -> None:
    fitted = None if source is None else source.get("scales")
    if not isinstance(fitted, Mapping):
        return
    known = {name: fitted[name] for name in _SCALED_BY if isinstance(fitted.get(name), int | float)}
    given = {name: getattr(scales, name) for name in known}
    if any(not math.isclose(given[name], known[name], rel_tol=SAME_SCALES) for name in known):
        raise InputError("scales", given, f"those of the point the element was fitted at: {known}")


def _band(name: str, value: Any) -> Band:
    try:
        low, high = value
    except (TypeError, ValueError):
        raise InputError(name, value, "a pair (low, high) of numbers") from None
    low, high = require_finite(name, low), require_finite(name, high)
    if low > high:
        raise InputError(name, (low, high), "a pair with low <= high")
    return low, high
