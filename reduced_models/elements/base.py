"""`ContactElement`: interface of all contact elements; coefficients, validity box, quality, source, units."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, ClassVar, Self, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_numbers,
    require_choice,
    require_finite,
    require_instance,
    require_no_others,
    require_positive,
)
from ehlcontact.checks.frequency import (
    Frequency,
    by_name,
    dimensionless,
    is_given,
    one,
    radians_per_second,
)
from ehlcontact.checks.kinds import ENTRIES
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError, warn_user
from ehlcontact.point import Point, Scales
from ehlcontact.results.response import Response
from reduced_models.elements.design_point import DesignPoint, known_scale, require_own_scales
from reduced_models.elements.element_summary import ElementSummary
from reduced_models.elements.film_response import StateSpace
from reduced_models.elements.validity import (
    MARGIN,
    UNITS,
    Band,
    OutsideValidityWarning,
    Validity,
    numbers,
    text_of,
)

TINY_OMEGA = 1e-4  # stands for 0, where damping is the slope of Z: Omega, or rad/s
UNWATCHED = (-math.inf, math.inf, math.inf, -math.inf, math.inf)  # a reach that nothing leaves


@dataclass(frozen=True, kw_only=True)
class _Common:
    """Fields that all elements have, behind the coefficients and the approach of their own."""

    kind: str
    rate: float | None = None
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)


class Box(TypedDict, total=False):
    """Fields that all elements have besides `low` and `high`, as keyword arguments."""

    rate: float | None
    load_range: Band | None
    omega_range: Band | None
    units: str
    fit: Mapping[str, Any] | None
    source: Mapping[str, Any] | None


class ContactElement(ElementSummary, _Common, ABC):
    """Base of all elements, with or without memory.

    A subclass is a frozen dataclass with its coefficients, `low` and `high`, and a `kind`, whose coefficients are
    named in ``kinds``.
    Approach in units of the dry Hertz approach or m, rate in its time derivative, force in units of the static
    load or N: see ``units``.

    ``validity`` holds what the data covered, ``design_point`` the speed and the oil. Motion outside the box
    (`advance`, `state_rates`, ``force`` of single values, `simulate_oscillator`, `simulate_rotor`), at a frequency
    outside the band, or use for another contact (`check`) is warned of once per element and reason. Tangents, the
    spring and arrays are evaluated anywhere without a warning. A `SpringContact` takes the frequency from single
    values too.

    Parameters
    ----------
    low, high : float
        Interval of approach that the coefficients stand for.
    rate : float, optional
        Largest rate, in magnitude, that they stand for.
    load_range, omega_range : (low, high), optional
        Forces and angular frequencies that they stand for: Omega of a dimensionless element, rad/s of one in SI.
    units : {"dimensionless", "SI"}
    fit, source : mapping, optional
        Quality of the fit and where the data came from, kept in the file.
    """

    kinds: ClassVar[Mapping[str, tuple[str, ...]]]  # names of the coefficients of each kind, as in the file
    low: float  # fields of the subclass, so that they follow its coefficients
    high: float
    validity: Validity
    _warned: set[str]
    _reach: tuple[float, float, float, float, float]

    def __post_init__(self) -> None:
        require_choice("kind", self.kind, tuple(self.kinds))
        require_choice("units", self.units, UNITS)
        for name in ("fit", "source"):
            require_instance(name, getattr(self, name), Mapping | None, "a mapping of names to values, or None")
        self._check_coefficients()
        validity = Validity((self.low, self.high), self.rate, self.load_range, self.omega_range)
        fresh = {"validity": validity, "_warned": set(), "_reach": validity.reach}
        for name, value in {**validity.fields(), **fresh}.items():
            object.__setattr__(self, name, value)

    def _check_coefficients(self) -> None:
        """Put each into its plain form, or raise `InputError`."""
        for name in self.parameter_names:
            object.__setattr__(self, name, require_finite(name, getattr(self, name)))

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
    def continuous(
        self, states: NDArray[np.float64], approach: float, rate: float
    ) -> tuple[float, NDArray[np.float64]]:
        """As `state_rates`, without a warning outside the validity box: for the trial points of an integrator."""

    def state_rates(
        self, states: NDArray[np.float64], approach: float, rate: float
    ) -> tuple[float, NDArray[np.float64]]:
        """Force and d(states)/dt in continuous time; all zero at rest, the element's own is not touched.

        The warning outside the validity box counts the trial points of a solver too, and comes once: a later exit
        of the solution is silent. Check the solution itself, with `is_valid` or `Validity.excess` of ``validity``.

        Parameters
        ----------
        states : ndarray, shape (state_count,)
        approach, rate : float

        Raises
        ------
        InputError
            Another number of states, or one of them, approach or rate not finite.
        """
        u, v = require_finite("approach", approach), require_finite("rate", rate)
        values = as_numbers("states", states)
        if values.shape != (self.state_count,) or not np.isfinite(values).all():
            raise InputError("states", values.tolist(), f"{self.state_count} finite numbers")
        force, rates = self.continuous(values, u, v)
        self._watch(u, v, force)
        return force, rates

    @abstractmethod
    def state_space(self, load: float | None = None) -> StateSpace:
        """Linear law about rest under `load`, from approach and rate to the force, in the units of the element."""

    @property
    def _state_names(self) -> list[str]:
        """Of the states in continuous time."""
        return []

    @abstractmethod
    def rate_under(self, states: NDArray[np.float64], approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0: the motion without inertia."""

    @abstractmethod
    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0."""

    def copy(self) -> Self:
        """An equal element with a state of its own, at rest."""
        return replace(self)

    def at_rest(self, approach: float | None = None, *, load: float | None = None) -> Self:
        """A copy at rest at an approach or under a load > 0, by default as `copy`; its states are zero."""
        if approach is not None and load is not None:
            raise InputError("approach and load", (approach, load), "one of the two")
        element = self.copy()
        place = approach if load is None else self.approach_at(require_positive("load", load))
        if place is not None:
            element.rest(place)
        return element

    @abstractmethod
    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        """Fields of the element in SI, its validity box and units apart."""

    @property
    def _beyond(self) -> Mapping[str, str]:
        """What to take instead, by what of the validity box was left: "motion", "frequency"."""
        return {}

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the coefficients that the kind has."""
        return self.kinds[self.kind]

    @property
    def parameters(self) -> dict[str, float]:
        """Coefficients by name."""
        return {name: getattr(self, name) for name in self.parameter_names}

    @property
    def rms(self) -> float | None:
        """RMS error of the force over its standard deviation, None for an element that was not fitted."""
        return None if self.fit is None else self.fit.get("rms")

    @property
    def time(self) -> float | None:
        """Unit of time [s] of an element in SI whose scales are known; None of any other."""
        return self._known("time") if self.units == "SI" else None

    @by_name(1)
    def impedance(
        self,
        *,
        load: float | None = None,
        Omega: ArrayLike | None = None,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
    ) -> Response:
        """Response to approach: Z = K + i w C of a small motion of angular frequency w about rest under `load`.

        Parameters
        ----------
        load : float, optional
            By default the static load that the element was made at.
        Omega, omega, hz, rpm : float or sequence of float
            Frequencies, in exactly one of these. A dimensionless element takes Omega; one in SI rad/s, Hz or
            rev/min, and Omega too where its scales are known.

        Returns
        -------
        Response
            In the units of the element; its `reservation` names a load or a frequency outside the validity box.

        Raises
        ------
        InputError
            Frequencies not given in exactly one way that the element takes; a load that is not > 0, or not known.
        """
        w = self._frequencies(Omega=Omega, omega=omega, hz=hz, rpm=rpm)
        moving = np.maximum(w, TINY_OMEGA)
        Z = self._response(moving, load)
        return Response.to_approach(w, Z, moving, units=self.units, beyond_data=self._beyond_box(w, load))

    def _beyond_box(self, w: NDArray[np.float64], load: float | None) -> str:
        """What of small motions about rest under a load is outside the validity box, in words; else empty."""
        outside, band = self.validity.excess(omega=float(w.max()), units=self.units), self.load_range
        if (
            load is not None
            and band is not None
            and not band[0] / (1.0 + MARGIN) <= load <= band[1] * (1.0 + MARGIN)
        ):
            unit = " N" if self.units == "SI" else ""
            outside = [f"load {load:.4g}{unit} (fitted {text_of(band)}{unit})", *outside]
        return f"outside the validity box of the element: {', '.join(outside)}" if outside else ""

    @abstractmethod
    def _response(self, w: NDArray[np.float64], load: float | None = None) -> NDArray[np.complex128]:
        """Impedance at angular frequencies in the units of the element (Omega or rad/s), shape (k,)."""

    def to_control(self, name: str = "contact") -> Any:
        """Nonlinear python-control system with inputs u, v, output F and the states of `state_rates`.

        ``control.linearize`` differentiates with an absolute step of 1e-6 by default: give it 1e-9 m for an
        element in SI, or use `to_ss`, which is exact.
        """
        import control

        def update(t: float, x: NDArray[np.float64], inputs: NDArray[np.float64], params: object) -> Any:
            return self.state_rates(np.asarray(x), float(inputs[0]), float(inputs[1]))[1]

        def output(t: float, x: NDArray[np.float64], inputs: NDArray[np.float64], params: object) -> Any:
            return np.array([self.state_rates(np.asarray(x), float(inputs[0]), float(inputs[1]))[0]])

        return control.nlsys(update if self.state_count else None, output, **self._signals(name))

    def to_ss(self, load: float | None = None, name: str = "contact") -> Any:
        """Exact python-control ``StateSpace`` about rest under `load`, by default that the element was made at.

        Inputs u, v, output F and states are those of `to_control`, as differences from rest.
        """
        import control

        return control.ss(*self.state_space(load), **self._signals(name))

    def _signals(self, name: str) -> dict[str, Any]:
        states = {"states": self._state_names} if self.state_count else {}
        return {"inputs": ["u", "v"], "outputs": ["F"], "name": name, **states}

    @by_name(None)
    def is_valid(
        self, approach: ArrayLike, rate: ArrayLike = 0.0, **frequency: Unpack[Frequency]
    ) -> bool | NDArray[np.bool_]:
        """Whether the data covered this approach and rate, and motion of the frequency that may be given.

        The box is closed; a bound that is not known does not count. Frequencies are named as for `impedance`.
        """
        return self.validity.covers(approach, rate, self._frequency(frequency))

    @by_name(None)
    def warn_outside(
        self,
        approach: ArrayLike = (),
        rate: ArrayLike = (),
        *,
        force: ArrayLike = (),
        **frequency: Unpack[Frequency],
    ) -> None:
        """Warn, once per element, where a motion leaves the validity box by more than `Validity.excess` overlooks.

        Parameters
        ----------
        approach, rate : array_like
            Of the motion.
        force : array_like
            Contact forces along it.
        **frequency
            Its frequency, named as for `impedance`.
        """
        excess = {
            "motion": self.validity.excess(approach, rate, None, force, self.units),
            "frequency": self.validity.excess(omega=self._frequency(frequency), units=self.units),
        }
        new = {reason: words for reason, words in excess.items() if words and reason not in self._warned}
        if new:
            self._note(set(new))
            left = ", ".join(word for words in new.values() for word in words)
            advice = "".join(f"; {self._beyond[reason]}" for reason in new if reason in self._beyond)
            message = f"{self._summary_name()} used outside its validity box: {left}{advice}"
            warn_user(message, OutsideValidityWarning)

    @by_name(None)
    def check(self, point: Point | None = None, **frequency: Unpack[Frequency]) -> None:
        """Warn, once per element, if it is to stand for another contact, or to move outside its band.

        Parameters
        ----------
        point : MoesPoint or OperatingPoint, optional
            Contact that it shall stand for: a speed, oil or shape that differs by more than a twentieth from
            ``design_point`` is warned of, and a static load outside ``load_range``.
        **frequency
            Of the motion, as of a rotor's speed; named as for `impedance`.
        """
        force: list[float] = []
        if point is not None:
            others = self.design_point.differences(point)
            if others and "point" not in self._warned:
                self._note({"point"})
                words = ", ".join(others)
                message = f"{self._summary_name()} used for another contact than it was made for: {words}"
                warn_user(message, OutsideValidityWarning)
            load, unit = self.design_point.load_of(point), self._known("force") if self.units == "SI" else 1.0
            if load is not None and unit is not None and not others:
                force = [load * unit]
        self.warn_outside(force=force, **frequency)

    def _watch(self, approach: float, rate: float, force: float) -> None:
        """Warn of a single state outside the box, and of a motion outside the band."""
        low, high, fastest, least, most = self._reach
        if not (low <= approach <= high and -fastest <= rate <= fastest and least <= force <= most):
            self.warn_outside(approach, rate, force=force)
        self._follow(approach, rate)

    def _follow(self, approach: float, rate: float) -> None:
        """Take a state as the next one of a motion, for its frequency; nothing where the element is for all."""

    def _note(self, reasons: set[str]) -> None:
        """Note reasons that have been warned of; after "motion" single states are no longer compared."""
        self._warned.update(reasons)
        if "motion" in reasons:
            object.__setattr__(self, "_reach", UNWATCHED)

    @property
    def design_point(self) -> DesignPoint:
        """Speed, oil and shape of the contact that it was made for, as far as its source has them."""
        return DesignPoint.of(self.source, self.units == "SI")

    def _frequencies(self, **frequency: Unpack[Frequency]) -> NDArray[np.float64]:
        """Angular frequencies in the units of the element, shape (k,)."""
        if self.units == "SI":
            return radians_per_second(self.time, **frequency)
        return dimensionless(None, **frequency)

    def _frequency(self, frequency: Frequency) -> float | None:
        """The one in the units of the element, None if none is given."""
        return one("frequency", self._frequencies(**frequency)) if is_given(**frequency) else None

    def _known(self, unit: str) -> float | None:
        """SI value of a unit of the point that the element was made at, where its source has it."""
        return known_scale(self.source, unit)

    def _static_load(self, load: float | None) -> float:
        """`load`, or that of the point that the element was made at."""
        if load is not None:
            return require_positive("load", load)
        static = self._known("force") if self.units == "SI" else 1.0
        if static is None:
            raise InputError("load", None, "given in N: this element does not know the load it was made at")
        return static

    def to_si(self, scales: Scales) -> Self:
        """The element in m, m/s and N.

        Parameters
        ----------
        scales : Scales
            Of the operating point that the dimensionless element was fitted at.

        Raises
        ------
        InputError
            The element is in SI already, or its ``source`` has other scales.
        """
        require_instance("scales", scales, Scales, "the Scales of an operating point")
        if self.units == "SI":
            raise InputError("units", self.units, "dimensionless, to be taken to SI")
        require_own_scales(scales, self.source)
        changes = self._si_coefficients(scales) | self.validity.to_si(scales).fields()
        source = {**(self.source or {}), "scales": asdict(scales)}  # for its unit of time
        return replace(self, **changes, units="SI", source=source)

    def to_dict(self) -> dict[str, Any]:
        """All of it, ready for JSON."""
        return {
            "kind": self.kind,
            "units": self.units,
            "parameters": self.parameters,
            "valid": self.validity.to_dict(),
            "fit": None if self.fit is None else dict(self.fit),
            "source": None if self.source is None else dict(self.source),
        }

    @classmethod
    @takes(entries=ENTRIES)
    def from_dict(cls, entries: Mapping[str, Any]) -> Self:
        """Build the element from `to_dict`.

        Raises
        ------
        InputError
            Another kind or unit, an entry that is missing or no number, coefficients that make no contact.
        """
        kind = require_choice("kind", entries.get("kind"), tuple(cls.kinds))
        require_choice("units", entries.get("units"), UNITS)
        for key in ("parameters", "valid"):
            require_instance(key, entries.get(key), dict, "an object of names and values")
        for key in ("fit", "source"):
            require_instance(key, entries.get(key), dict | None, "an object, or null")
        values = cls._read_coefficients(kind, entries) | Validity.from_dict(entries["valid"]).fields()
        element = cls(
            kind=kind, **values, units=entries["units"], fit=entries.get("fit"), source=entries.get("source")
        )
        known = element.to_dict()
        require_no_others(entries, known)
        for key in ("parameters", "valid"):
            require_no_others(entries[key], known[key], f"{key}.")
        return element

    @classmethod
    def _read_coefficients(cls, kind: str, entries: Mapping[str, Any]) -> dict[str, Any]:
        """Coefficients of that kind, as arguments of the class, from `to_dict`."""
        return numbers("parameters", entries["parameters"], cls.kinds[kind])


def as_approaches(approach: ArrayLike) -> NDArray[np.float64]:
    """Finite approaches of any shape, or `InputError`."""
    u = as_numbers("approach", approach)
    finite = np.isfinite(u)
    if not finite.all():
        raise InputError("approach", float(u[~finite][0]), "finite")
    return u
