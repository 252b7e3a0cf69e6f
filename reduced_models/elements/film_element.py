"""Base of the contact elements with a film memory: state, steps, tangents, impedance."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import asdict, fields
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_column,
    as_float,
    require_between,
    require_finite,
    require_nonnegative,
    require_positive,
)
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.elements.base import ContactElement, as_approaches
from reduced_models.elements.film_curve import require_rising
from reduced_models.elements.film_filters import CHAIN, DIRECT
from reduced_models.elements.film_law import (
    FilmLaw,
    film_drive,
    film_made,
    film_rate,
    film_rates,
    film_rest,
    film_step,
    static,
    static_forces,
)
from reduced_models.elements.film_response import DRY, FilterRates
from reduced_models.elements.small_motion import SmallMotion, StateSpace
from reduced_models.elements.validity import numbers, require_size

_Floats = NDArray[np.float64]

# All of them dimensionless, and of the order of 0.01 to 100 in the atlas.
RATES = (1e-6, 1e6)
FILMS = (1e-9, 1e6)
LARGEST_GAIN = 1e6
_SCALES = tuple(f.name for f in fields(Scales))


def units_of(scales: Scales | None) -> tuple[float, float, float]:
    """Units of force, approach and time: N, m and s, or 1 of a dimensionless element."""
    return (1.0, 1.0, 1.0) if scales is None else (scales.force, scales.length, scales.time)


class FilmContact(ContactElement):
    """Dry Hertz spring on a film with memory; equations in `reduced_models.elements.film_law`.

    The element carries a state and starts at rest under its reference load; one element must not serve two
    contacts (take a `copy`). Its coefficients are dimensionless always; in SI it holds the ``scales`` and
    converts what goes in and out.
    """

    for_every_load: ClassVar[bool] = True  # a contact that is made for growing
    tables: ClassVar[tuple[str, ...]]  # those of `parameter_names` that are no single numbers
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    inlet_saturation: float
    scales: Scales | None  # a field of the subclass
    law: FilmLaw
    _state: _Floats
    _next: _Floats

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.scales is None) != (self.units == "dimensionless"):
            raise InputError("scales", self.scales, "given for an element in SI, and only there")
        object.__setattr__(self, "law", self._first_law())
        size = CHAIN + self.lags
        object.__setattr__(self, "_state", np.zeros(size))
        object.__setattr__(self, "_next", np.zeros(size))
        self.rest(self.approach_at(self._units[0]))

    def _first_law(self) -> FilmLaw:
        """Checked law that the element begins with."""
        return self._law_of(self._tables(), self.inlet_saturation)

    def _law_of(self, tables: Mapping[str, _Floats], inlet_saturation: float) -> FilmLaw:
        """Law of these tables, or `InputError`."""
        rim = self.for_every_load and inlet_saturation > 0.0
        law = FilmLaw(
            **tables,
            lag_rate=self.lag_rate,
            inlet_rate=self.inlet_rate,
            fast_rate=self.fast_rate,
            inlet_saturation=inlet_saturation,
            rim=1.0 if rim else 0.0,
        )
        require_size("gains", float(np.abs(law.gains).max()), LARGEST_GAIN)
        require_rising(law)
        rates = FilterRates(law.gains.shape[1] - DIRECT, law.lag_rate, law.inlet_rate, law.fast_rate)
        if not rates.passive(law.gains):
            least = min(rates.least_dissipation(row) for row in law.gains)
            raise InputError("least dissipation of gains", least, ">= 0 at every frequency (passive)")
        return law

    def _check_coefficients(self) -> None:
        self._check_rates()
        saturation = require_nonnegative("inlet_saturation", self.inlet_saturation)
        require_size("inlet_saturation", saturation, LARGEST_GAIN)
        object.__setattr__(self, "inlet_saturation", saturation)

    def _check_rates(self) -> None:
        for name in ("lag_rate", "inlet_rate", "fast_rate"):
            object.__setattr__(self, name, require_between(name, getattr(self, name), *RATES))

    @property
    def parameters(self) -> dict[str, Any]:
        """Coefficients and tables by name, dimensionless."""
        return {name: np.asarray(getattr(self, name)).tolist() for name in self.parameter_names}

    @abstractmethod
    def _tables(self) -> dict[str, _Floats]:
        """Static curve and gains over the load, as `FilmLaw` has them."""

    @property
    def lags(self) -> int:
        """Number of lags that carry the film through the contact."""
        return int(self.law.gains.shape[1]) - DIRECT

    @property
    def rates(self) -> FilterRates:
        """Rates of the filters."""
        return FilterRates(self.lags, self.lag_rate, self.inlet_rate, self.fast_rate)

    @property
    def time(self) -> float | None:
        """Unit of time [s] of an element in SI."""
        return None if self.scales is None else self.scales.time

    @cached_property
    def _units(self) -> tuple[float, float, float]:
        return units_of(self.scales)

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step `dt` > 0, at the approach and rate of that end; moves the state there.

        The step may have any length: between its ends the approach is taken as the cubic through both
        approaches and rates, and every filter is integrated exactly.
        """
        u, v = as_float("approach", approach), as_float("rate", rate)
        f, length, time = self._units
        own = require_step(dt) / time
        force = film_step(self.law, self._state, self._next, own, u / length, v / length * time)[0]
        if not math.isfinite(force):
            raise InputError("approach and rate", (u, v), "finite")
        old = self._state
        object.__setattr__(self, "_state", self._next)
        object.__setattr__(self, "_next", old)
        self._watch(u, v, float(force) * f)
        return float(force) * f

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force, dF/du and dF/du' at the end of a step from the present state, which stays where it is.

        These are the exact derivatives of what `advance` would return, memory included.
        """
        f, length, time = self._units
        u, v = as_float("approach", approach) / length, as_float("rate", rate) / length * time
        force, stiffness, damping = film_step(self.law, self._state, self._next, require_step(dt) / time, u, v)
        return float(force) * f, float(stiffness) * f / length, float(damping) * f / length * time

    def save_state(self) -> object:
        """Copy of the film's state."""
        return self._state.copy()

    def restore_state(self, state: object) -> None:
        """Go back to a saved state."""
        self._state[:] = state  # type: ignore[call-overload]

    def rest(self, approach: float) -> float:
        """Put the contact at rest at this approach, with the film of a steady contact; returns the force."""
        f, length, _ = self._units
        return float(film_rest(self.law, require_finite("approach", approach) / length, self._state)) * f

    def drive(self, T: ArrayLike, approach: ArrayLike, rate: ArrayLike) -> _Floats:
        """Force along a whole record, from rest at its first approach; the element's own state stays.

        Parameters
        ----------
        T, approach, rate : array_like, shape (N,)
            Increasing times and the motion, in the units of the element. The motion sets in with ``rate[0]``.

        Returns
        -------
        ndarray, shape (N,)
            Outside the validity box it warns, once per element.

        Raises
        ------
        InputError
            Times that do not increase, another number of approaches or rates, an entry that is not finite.
        """
        f, length, time = self._units
        t = as_column("T", T, increasing=True)
        u, v = as_column("approach", approach, size=t.size), as_column("rate", rate, size=t.size)
        force = np.empty(t.size)
        film_drive(self.law, t / time, u / length, v / length * time, force)
        self.warn_outside(u, v, force=force * f)
        return force * f

    def spring(self, approach: ArrayLike) -> float | _Floats:
        """Static force."""
        f, length, _ = self._units
        u = as_approaches(approach) / length
        force = np.empty(u.size)
        static_forces(self.law, u.ravel(), force)
        return force.reshape(u.shape) * f if u.ndim else float(force[0]) * f

    def spring_tangent(self, approach: float) -> float:
        """Slope of the static force."""
        f, length, _ = self._units
        _, g, g_u = static(require_finite("approach", approach) / length, self.law)
        return 1.5 * math.sqrt(g) * g_u * f / length

    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0."""
        f, length, _ = self._units
        target = require_positive("force", force) / f
        x = math.log(target)
        k = int(np.clip(np.searchsorted(self.law.x, x) - 1, 0, self.law.x.size - 2))
        low, high = self.law.u[k], self.law.u[k + 1]
        reach = high - low
        while self._static_x(low) > x:
            low, reach = low - reach, 2.0 * reach
        while self._static_x(high) < x:
            high, reach = high + reach, 2.0 * reach
        found = scipy.optimize.brentq(lambda u: self._static_x(u) - x, low, high, xtol=1e-15, rtol=1e-14)
        return float(found) * length

    def _static_x(self, u: float) -> float:
        return float(static(u, self.law)[0])

    def _response(self, w: _Floats, load: float | None = None) -> NDArray[np.complex128]:
        """As `impedance`, at angular frequencies in the units of the element, shape (k,)."""
        return self.small_motion(load).impedance(1j * w)

    def small_motion(self, load: float | None = None) -> SmallMotion:
        """Linear law about rest under `load`, by default the reference load, in the units of the element."""
        f, length, time = self._units
        at = 1.0 if load is None else require_positive("load", load) / f
        own = at ** (1.0 / 3.0)  # length of the contact, and so its time, over that under the reference load
        tangent = self.spring_tangent(self.approach_at(at * f))
        x = math.log(at)
        slope, tau, made = DRY * own * f / length, own * time, float(film_made(x, self.law))
        return SmallMotion(tangent, slope, tau, self.gains_at(x), self.rates, made)

    def gains_at(self, x: float | _Floats) -> _Floats:
        """Gains at x = ln F, shape (3 + lags,) + that of x, with F in units of the reference load."""
        return np.array([np.interp(x, self.law.gain_x, column) for column in self.law.gains.T])

    @property
    def state_count(self) -> int:
        """Number of states of the film in continuous time."""
        return 2 + self.lags

    def continuous(self, states: _Floats, approach: float, rate: float) -> tuple[float, _Floats]:
        """Force and d(states)/dt in continuous time: what `advance` does with a motion cubic within the step."""
        f, length, time = self._units
        rates = np.empty(states.size)
        force = film_rates(self.law, np.ascontiguousarray(states), approach / length, rate / length * time, rates)
        return float(force) * f, rates / time

    def rate_under(self, states: _Floats, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0: the motion without inertia."""
        f, length, time = self._units
        states = np.ascontiguousarray(states)  # of any layout: compiled once
        return float(film_rate(self.law, states, approach / length, force / f)) * length / time

    @property
    def _state_names(self) -> list[str]:
        return ["s", "y", *(f"q{k}" for k in range(1, self.lags + 1))]

    def state_space(self, load: float | None = None) -> StateSpace:
        """Linear law about rest under `load`; states s, y, q1 ... are those of `state_rates`."""
        A, fed, C, D = self.small_motion(load).state_space()
        unit = self._units[1]
        return StateSpace(A, fed / unit, C * unit, D)

    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        return {"scales": scales}  # the coefficients stay dimensionless

    def to_dict(self) -> dict[str, Any]:
        """All of it, ready for JSON; ``parameters`` dimensionless, ``scales`` of an SI element."""
        return super().to_dict() | {"scales": None if self.scales is None else asdict(self.scales)}

    @classmethod
    def _read_coefficients(cls, kind: str, entries: Mapping[str, Any]) -> dict[str, Any]:
        parameters, scales = entries["parameters"], entries.get("scales")
        scalars = tuple(name for name in cls.kinds[kind] if name not in cls.tables)
        values: dict[str, Any] = {**numbers("parameters", parameters, scalars)}
        for name in cls.tables:
            values[name] = parameters.get(name)
            if not isinstance(values[name], list):
                raise InputError(f"parameters.{name}", values[name], "a list of numbers")
        if scales is not None:
            if not isinstance(scales, dict):
                raise InputError("scales", scales, "an object or null")
            values["scales"] = Scales(**numbers("scales", scales, _SCALES))
        return values


def require_step(dt: float) -> float:
    """Return a length of a step, or raise `InputError`."""
    if not 0.0 < as_float("dt", dt) < math.inf:
        raise InputError("dt", dt, "finite and > 0")
    return float(dt)
