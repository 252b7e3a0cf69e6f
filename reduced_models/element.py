"""Viscous contact elements: a spring (linear or cubic in the approach) beside a damper.

Force of either: ``max(0, spring(u) + c(u) u')``, with the extension of `reduced_models.law` outside the
fitted interval. Nonato and Cavalca (2010), eqs. 8 and 11 with the terms their Table 2 keeps.
"""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Self, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError, require_choice, require_nonnegative, require_positive
from ehlcontact.scaling import Scales
from reduced_models.element_file import UNITS, numbers, read_document, write_document
from reduced_models.law import Law, contact, contact_values, part_values

_Floats = NDArray[np.float64]


class ViscousContact(ABC):
    """What `LinearContact` and `CubicContact` have in common; build one of those.

    Approach in units of the dry Hertz approach or m, rate in its time derivative, force in units of the
    static load or N: see ``units``. Stateless, so a step of any length just evaluates the force.
    """

    kind: ClassVar[str]
    parameter_names: ClassVar[tuple[str, ...]]
    low: float
    high: float
    rate: float | None
    units: str
    fit: Mapping[str, Any] | None
    source: Mapping[str, Any] | None
    law: Law

    def __post_init__(self) -> None:
        require_choice("units", self.units, UNITS)
        if self.rate is not None:
            object.__setattr__(self, "rate", require_nonnegative("rate", self.rate))
        object.__setattr__(self, "law", self._law())
        for name in (*self.parameter_names, "low", "high"):
            object.__setattr__(self, name, getattr(self.law, name))

    @abstractmethod
    def _law(self) -> Law:
        """The force law of the coefficients, checked."""

    @property
    def parameters(self) -> dict[str, float]:
        """Coefficients by name."""
        return {name: getattr(self, name) for name in self.parameter_names}

    @overload
    def force(self, approach: float, rate: float) -> float: ...
    @overload
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Contact force, never negative; scalars or arrays that broadcast."""
        return self._value(0, approach, rate)

    @overload
    def stiffness(self, approach: float, rate: float) -> float: ...
    @overload
    def stiffness(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def stiffness(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Exact tangent dF/du; zero where the force is clipped."""
        return self._value(1, approach, rate)

    @overload
    def damping(self, approach: float, rate: float) -> float: ...
    @overload
    def damping(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def damping(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Exact tangent dF/du'; zero where the force is clipped."""
        return self._value(2, approach, rate)

    def spring(self, approach: ArrayLike) -> float | _Floats:
        """Force at zero rate."""
        value = part_values(self.law, approach)[0]
        return value if value.ndim else float(value)

    def damper(self, approach: ArrayLike) -> float | _Floats:
        """Damping coefficient c(u) before the force is clipped."""
        value = part_values(self.law, approach)[1]
        return value if value.ndim else float(value)

    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0.

        Raises
        ------
        InputError
            Force not finite and > 0.
        """
        return self.law.approach_at(require_positive("force", force))

    def is_valid(self, approach: ArrayLike) -> bool | NDArray[np.bool_]:
        """Whether the approach lies in the fitted interval, where the spring is measured, not extended."""
        u = np.asarray(approach, float)
        inside = (u >= self.low) & (u <= self.high)
        return inside if u.ndim else bool(inside)

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step; `dt` is ignored, for the element has no memory."""
        return contact(float(approach), float(rate), self.law)[0]

    def save_state(self) -> object:
        """Nothing to save."""
        return None

    def restore_state(self, state: object) -> None:  # noqa: B027 - no memory, nothing to restore
        """Nothing to restore."""

    def to_si(self, scales: Scales) -> Self:
        """The same element in m, m/s and N.

        Parameters
        ----------
        scales : Scales
            Of the operating point that the dimensionless element was fitted at.

        Raises
        ------
        InputError
            The element is in SI already.
        """
        if self.units == "SI":
            raise InputError("units", self.units, "dimensionless, to be taken to SI")
        factor = {f"K{i}": scales.force / scales.length**i for i in (1, 2, 3)} | {"C1": scales.damping}
        changes: dict[str, Any] = {name: value * factor[name] for name, value in self.parameters.items()}
        changes |= {"low": self.low * scales.length, "high": self.high * scales.length, "units": "SI"}
        changes["rate"] = None if self.rate is None else self.rate * scales.rate
        return replace(self, **changes)  # type: ignore[type-var]

    def to_control(self, name: str = "contact") -> Any:
        """Static python-control system with inputs u, v and output F.

        ``control.linearize`` differentiates with an absolute step of 1e-6 by default: give it 1e-9 m for an
        element in SI, or use `stiffness` and `damping`, which are exact.
        """
        import control

        def output(t: float, x: _Floats, inputs: _Floats, params: object) -> _Floats:
            return np.array([self.advance(0.0, inputs[0], inputs[1])])

        return control.nlsys(None, output, inputs=["u", "v"], outputs=["F"], name=name)

    def to_dict(self) -> dict[str, Any]:
        """Content of the element file, header apart."""
        return {
            "kind": self.kind,
            "units": self.units,
            "parameters": self.parameters,
            "valid": {"low": self.low, "high": self.high, "rate": self.rate},
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
        return cls._from_document(str(path), read_document(path))

    @classmethod
    def _from_document(cls, name: str, document: Mapping[str, Any]) -> Self:
        if document["kind"] != cls.kind:
            raise InputError(name, f"kind {document['kind']!r}", f"of kind {cls.kind!r}")
        values = numbers(name, "parameters", document["parameters"], cls.parameter_names)
        valid = document["valid"]
        values |= numbers(name, "valid", valid, ("low", "high"))
        rate = numbers(name, "valid", valid, ("rate",))["rate"] if valid.get("rate") is not None else None
        details = {key: document.get(key) for key in ("units", "fit", "source")}
        try:
            return cls(**values, rate=rate, **details)  # type: ignore[call-arg]
        except InputError as error:
            raise InputError(f"{name}: {error.field}", error.value, error.allowed) from None

    def _value(self, index: int, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        if isinstance(approach, float) and isinstance(rate, float):  # the inner loop of every integrator
            return contact(approach, rate, self.law)[index]
        value = contact_values(self.law, approach, rate)[index]
        return value if value.ndim else float(value)


@dataclass(frozen=True)
class LinearContact(ViscousContact):
    """Linear spring and viscous damper, F = K1 u + C1 u' on [low, high] (eq. 8).

    Parameters
    ----------
    K1, C1 : float
        Stiffness and damping; in SI N/m and N s/m.
    low, high : float
        Interval of approach that the coefficients stand for.
    rate : float, optional
        Largest rate, in magnitude, that they stand for.
    units : {"dimensionless", "SI"}
    fit, source : mapping, optional
        Quality of the fit and where the data came from, kept in the file.

    Raises
    ------
    InputError
        A value not finite, C1 < 0, low >= high, or a spring that does not push at both ends.
    """

    K1: float
    C1: float
    low: float
    high: float
    rate: float | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: Law = field(init=False, repr=False, compare=False)

    kind = "linear"
    parameter_names = ("K1", "C1")

    def _law(self) -> Law:
        return Law.build((self.K1, 0.0, 0.0), self.C1, (self.low, self.high))


@dataclass(frozen=True)
class CubicContact(ViscousContact):
    """Cubic spring and viscous damper, F = K1 u + K2 u^2 + K3 u^3 + C1 u' on [low, high] (eq. 11).

    Parameters
    ----------
    K1, K2, K3, C1 : float
        Coefficients; in SI N/m, N/m^2, N/m^3 and N s/m. Only the root and the tangent of the spring are
        identifiable from a small vibration, not the single K.
    low, high, rate, units, fit, source
        As for `LinearContact`.

    Raises
    ------
    InputError
        A value not finite, C1 < 0, low >= high, or a spring that does not push and stiffen at both ends.
    """

    K1: float
    K2: float
    K3: float
    C1: float
    low: float
    high: float
    rate: float | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: Law = field(init=False, repr=False, compare=False)

    kind = "cubic"
    parameter_names = ("K1", "K2", "K3", "C1")

    def _law(self) -> Law:
        return Law.build((self.K1, self.K2, self.K3), self.C1, (self.low, self.high))


KINDS: dict[str, type[LinearContact] | type[CubicContact]] = {
    element.kind: element for element in (LinearContact, CubicContact)
}


def load_element(path: str | os.PathLike[str]) -> LinearContact | CubicContact:
    """Read an element file into the class that wrote it.

    Raises
    ------
    InputError
        Missing, truncated or foreign file, newer version, unknown kind; the message names the file.
    """
    document = read_document(path)
    if document["kind"] not in KINDS:
        raise InputError(str(path), f"kind {document['kind']!r}", "of kind " + " or ".join(KINDS))
    return KINDS[document["kind"]]._from_document(str(path), document)
