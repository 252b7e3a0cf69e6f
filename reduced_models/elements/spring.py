"""`SpringContact`: elements without memory, a spring beside a damper; equations in `spring_law`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self, Unpack, overload

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_float,
    as_numbers,
    parts,
    require_finite,
    require_nonnegative,
    require_positive,
    shown,
)
from ehlcontact.checks.frequency import Frequency
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.base import Box, ContactElement, as_approaches
from reduced_models.elements.film_response import StateSpace
from reduced_models.elements.spring_law import (
    A_HIGH,
    A_LOW,
    O_HIGH,
    O_LOW,
    RATE,
    contact,
    damper,
    fill_contact,
    fill_parts,
    inside,
    joined,
    require_dissipation,
    require_rising,
    spring,
    spring_law,
)
from reduced_models.elements.validity import HalfCycles, require_size

_Floats = NDArray[np.float64]


@stored("contact element")
@dataclass(frozen=True, kw_only=True)
class SpringContact(ContactElement):
    """Spring beside a viscous damper, never pulling: exact tangents, no memory; made by one of its constructors.

    F = K1 u + K2 u^2 + K3 u^3 + K (u + u0)^n + F0 + C1 u' + C2 u'^2 + C3 u'^3 + B4 u u' on [low, high], of which
    each kind has some terms: `linear`, `cubic`, `polynomial` (Nonato and Cavalca 2010, eqs. 8, 11 and 12) and
    `power`, of the literature after them. Outside the box see `reduced_models.elements.spring_law`.

    A damper is for one band. Single values of `force`, `advance` and `state_rates` are taken as a motion. Where
    its frequency is outside ``omega_range`` by more than an octave, over eight half cycles and over the next
    eight, the element warns once.

    Parameters
    ----------
    kind : {"linear", "cubic", "polynomial", "power"}
    K1, K2, K3 : float
        Coefficients of the powers of the approach; in SI N/m, N/m^2, N/m^3.
    K, n, u0, F0 : float
        Factor > 0 and exponent > 0 of the shifted approach, its shift with u0 + low > 0, and an offset of the
        force; in SI N/m^n, 1, m and N.
    C1, C2, C3, B4 : float
        Coefficients of the damper; in SI N s/m, N s^2/m^2, N s^3/m^3 and N s/m^2.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`.

    Attributes
    ----------
    law : ndarray, shape (18,)
        Coefficients and ends, by the names in `reduced_models.elements.spring_law`.

    Raises
    ------
    InputError
        A value not finite, C1 < 0, low >= high, a spring that does not push and stiffen at both ends or falls in
        between, or a damper that puts energy into a cycle, C1 + B4 u + C3 u'^2 < 0.
    """

    K1: float = 0.0
    K2: float = 0.0
    K3: float = 0.0
    K: float = 0.0
    n: float = 1.5
    u0: float = 0.0
    F0: float = 0.0
    C1: float = 0.0
    C2: float = 0.0
    C3: float = 0.0
    B4: float = 0.0
    low: float
    high: float

    kinds: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "linear": ("K1", "C1"),
        "cubic": ("K1", "K2", "K3", "C1"),
        "polynomial": ("K1", "C1", "K2", "C2", "K3", "C3", "B4"),
        "power": ("K", "n", "u0", "F0", "C1"),
    }
    law: _Floats = field(init=False, repr=False, compare=False)

    @classmethod
    def linear(cls, K1: float, C1: float, low: float, high: float, **box: Unpack[Box]) -> Self:
        """Linear spring and viscous damper, F = K1 u + C1 u' (eq. 8).

        Parameters
        ----------
        K1, C1 : float
        low, high : float
            Ends of the approach; `rate` and other bounds as for the class.
        """
        return cls(kind="linear", K1=K1, C1=C1, low=low, high=high, **box)

    @classmethod
    def cubic(
        cls, K1: float, K2: float, K3: float, C1: float, low: float, high: float, **box: Unpack[Box]
    ) -> Self:
        """Cubic spring and viscous damper, F = K1 u + K2 u^2 + K3 u^3 + C1 u' (eq. 11 as Table 2 reduces it).

        Only the root and the tangent of the spring are identifiable from a small vibration, not the single K.

        Parameters
        ----------
        K1, K2, K3, C1 : float
        low, high : float
            Ends of the approach; `rate` and other bounds as for the class.
        """
        return cls(kind="cubic", K1=K1, K2=K2, K3=K3, C1=C1, low=low, high=high, **box)

    @classmethod
    def polynomial(
        cls,
        K1: float,
        C1: float,
        K2: float,
        C2: float,
        K3: float,
        C3: float,
        B4: float,
        low: float,
        high: float,
        **box: Unpack[Box],
    ) -> Self:
        """F = K1 u + C1 u' + K2 u^2 + C2 u'^2 + K3 u^3 + C3 u'^3 + B4 u u' (eq. 11).

        Use the cubic unless the seven terms are wanted: the three further dampers are hardly identifiable
        (`reduced_models.sensitivity`).

        Parameters
        ----------
        K1, C1, K2, C2, K3, C3, B4 : float
            In the order of eq. 12.
        low, high : float
            Ends of the approach; `rate` and other bounds as for the class. Without a `rate` the powers of the
            rate go on for ever.
        """
        terms = {"K1": K1, "C1": C1, "K2": K2, "C2": C2, "K3": K3, "C3": C3, "B4": B4}
        return cls(kind="polynomial", **terms, low=low, high=high, **box)

    @classmethod
    def power(
        cls, K: float, n: float, u0: float, F0: float, C1: float, low: float, high: float, **box: Unpack[Box]
    ) -> Self:
        """F = K (u + u0)^n + F0 + C1 u'; a dry point contact has n = 3/2, u0 = F0 = 0.

        Outside [low, high] the spring goes on like a Hertz contact, as that of every kind, so that it lets go
        where the surfaces part whatever F0 is.

        Parameters
        ----------
        K, n, u0, F0, C1 : float
        low, high : float
            Ends of the approach; `rate` and other bounds as for the class.
        """
        return cls(kind="power", K=K, n=n, u0=u0, F0=F0, C1=C1, low=low, high=high, **box)

    _cycles: HalfCycles | None = field(init=False, repr=False, compare=False)  # None: no band, or warned of it

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "_cycles", None if self.omega_range is None else HalfCycles())
        object.__setattr__(self, "law", joined(self._law()))
        require_rising(self.law)
        require_size("damping", float(np.abs(self._parts([self.low, self.high])[1]).max()))

    @property
    def _beyond(self) -> Mapping[str, str]:
        text = "it is for the band it was made in: a film memory (model 'memory' or 'wide') is for all"
        return {"frequency": text}

    def _check_coefficients(self) -> None:
        super()._check_coefficients()
        others = {name for names in self.kinds.values() for name in names} - set(self.parameter_names)
        for name in sorted(others):
            if getattr(self, name) != getattr(SpringContact, name):
                raise InputError(name, getattr(self, name), f"left out of a {self.kind} element")

    def _law(self) -> _Floats:
        """The law of the coefficients, checked, its ends not yet joined."""
        law = spring_law(low=self.low, high=self.high, **self.parameters)
        if self.kind == "polynomial":
            if self.rate is not None:
                law[RATE] = require_positive("rate", self.rate)
            require_dissipation(law)
        else:
            require_nonnegative("C1", self.C1)
        if self.kind == "power":
            for name in ("K", "n"):
                require_positive(name, getattr(self, name))
            require_positive("low + u0", self.low + self.u0)
        return law

    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        factors = self._si_factors(scales)
        return {name: value * factors[name] for name, value in self.parameters.items()}

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        f, u, v = scales.force, scales.length, scales.rate
        factors = {f"K{i}": f / u**i for i in (1, 2, 3)} | {"K": f / u**self.n, "n": 1.0, "u0": u, "F0": f}
        return factors | {"C1": scales.damping, "C2": f / v**2, "C3": f / v**3, "B4": f / (u * v)}

    def si_jacobian(self, scales: Scales) -> _Floats:
        """Derivatives of the coefficients in SI to the dimensionless ones, in their order, shape (k, k).

        The unit of K of a power law depends on its exponent n.
        """
        factors, names = self._si_factors(scales), self.parameter_names
        jacobian = np.diag([factors[name] for name in names])
        if "n" in names:
            jacobian[names.index("K"), names.index("n")] = -self.K * factors["K"] * math.log(scales.length)
        return jacobian

    @overload
    def force(self, approach: float, rate: float) -> float: ...
    @overload
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Contact force, never negative; scalars or arrays that broadcast.

        Of a single value outside the validity box it warns, once per element; arrays are questions.
        """
        if not (isinstance(approach, float) and isinstance(rate, float)):
            values = self._value(0, approach, rate)
            if isinstance(values, float):
                self._watch(float(approach), float(rate), values)  # type: ignore[arg-type]
            return values
        force = contact(approach, rate, self.law)[0]
        low, high, fastest, least, most = self._reach  # here, for the sake of integrators: a call takes 0.1 us
        if not (low <= approach <= high and -fastest <= rate <= fastest and least <= force <= most):
            self.warn_outside(approach, rate, force=force)
        if self._cycles is not None:
            self._follow(approach, rate)
        return force

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
        return _plain(self._parts(approach)[0])

    def spring_tangent(self, approach: float) -> float:
        """Slope of the force at zero rate."""
        return contact(require_finite("approach", approach), 0.0, self.law)[1]

    def damper(self, approach: ArrayLike) -> float | _Floats:
        """Damping coefficient c(u) at zero rate, before the force is clipped."""
        return _plain(self._parts(approach)[1])

    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0.

        Raises
        ------
        InputError
            Force not finite and > 0.
        """
        law, force = self.law, require_positive("force", force)
        if force <= spring(self.low, law)[0]:
            return float(law[O_LOW] + (force / law[A_LOW]) ** (2.0 / 3.0))
        if force >= spring(self.high, law)[0]:
            return float(law[O_HIGH] + (force / law[A_HIGH]) ** (2.0 / 3.0))
        if self.kind == "power":
            return float(((force - self.F0) / self.K) ** (1.0 / self.n)) - self.u0
        ends = {"xtol": 1e-300, "rtol": 1e-14}
        return float(scipy.optimize.brentq(lambda u: inside(u, law)[0] - force, self.low, self.high, **ends))

    @takes(approach=parts.ANY, force=parts.ANY)
    def rate_at(self, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0 at this approach: the motion without inertia.

        Where a polynomial damper is not monotone there are several; the search goes outwards from that of
        C1 + B4 u.

        Raises
        ------
        InputError
            No damper acts there, or none of its rates makes up for the force.
        """
        static, damping = (float(part) for part in self._parts(approach))
        if damping <= 0.0:
            raise InputError(f"damping at approach {approach:g}", damping, "> 0 for a motion without inertia")
        v = (force - static) / damping
        if self.kind != "polynomial":
            return v

        def excess(rate: float) -> float:
            return static + damper(approach, rate, self.law)[0] - force

        width = abs(v) if v != 0.0 else 1e-9
        while excess(v - width) * excess(v + width) > 0.0:
            width *= 2.0
            if not math.isfinite(width):
                raise InputError(f"force at approach {approach:g}", force, "one that some rate gives")
        return float(scipy.optimize.brentq(excess, v - width, v + width, xtol=1e-300, rtol=1e-14))

    def state_space(self, load: float | None = None) -> StateSpace:
        """Linear law about rest under `load`, without states: F = K u + C u'."""
        u = self.approach_at(self._static_load(load))
        through = np.array([[self.spring_tangent(u), float(self._parts(u)[1])]])
        return StateSpace(np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), through)

    def _response(self, w: _Floats, load: float | None = None) -> NDArray[np.complex128]:
        """As `impedance`, at angular frequencies in the units of the element, shape (k,): one K, one C."""
        K, C = self.state_space(load).D[0].tolist()
        return np.asarray(K + 1j * w * C)

    @property
    def state_count(self) -> int:
        """No states."""
        return 0

    def continuous(self, states: _Floats, approach: float, rate: float) -> tuple[float, _Floats]:
        """Force, and the rates of no states."""
        return contact(float(approach), float(rate), self.law)[0], states

    def rate_under(self, states: _Floats, approach: float, force: float) -> float:
        """As `rate_at`, whatever the states."""
        return self.rate_at(approach, force)

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step; `dt` is ignored, for the element has no memory."""
        as_float("dt", dt)
        approach, rate = as_float("approach", approach), as_float("rate", rate)
        if not (math.isfinite(approach) and math.isfinite(rate)):
            raise InputError("approach and rate", (approach, rate), "finite")
        force = contact(approach, rate, self.law)[0]
        self._watch(approach, rate, force)
        return force

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force, dF/du and dF/du' at the end of a step; `dt` is ignored."""
        return contact(as_float("approach", approach), as_float("rate", rate), self.law)

    def rest(self, approach: float) -> float:
        """Force at rest; there is no state to set."""
        return contact(require_finite("approach", approach), 0.0, self.law)[0]

    def save_state(self) -> object:
        """Nothing to save."""
        return None

    def restore_state(self, state: object) -> None:
        """Nothing to restore; raises `InputError` for a state of a contact that has one."""
        if state is not None:
            raise InputError("state", shown(state), "None: this contact has no memory")

    def _follow(self, approach: float, rate: float) -> None:
        """Take a state as the next one of a motion; warn where its frequency is outside the band twice on end."""
        cycles = self._cycles
        if cycles is None:
            return
        speed = rate if cycles.rising else -rate
        if speed > cycles.peak:
            cycles.peak = speed
        elif speed < 0.0 and (omega := cycles.turn(approach, rate)) is not None:
            outside = bool(self.validity.excess(omega=omega))
            if outside and cycles.outside:
                frequency: Frequency = {"omega": omega} if self.units == "SI" else {"Omega": omega}
                self.warn_outside(**frequency)
            cycles.outside = outside

    def _note(self, reasons: set[str]) -> None:
        super()._note(reasons)
        if "frequency" in reasons:
            object.__setattr__(self, "_cycles", None)

    def _value(self, index: int, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        if isinstance(approach, float) and isinstance(rate, float):
            return contact(approach, rate, self.law)[index]
        u, v = np.broadcast_arrays(as_numbers("approach", approach), as_numbers("rate", rate))
        out = np.empty((3, u.size))
        fill_contact(u.ravel(), v.ravel(), self.law, out)
        return _plain(out[index].reshape(u.shape))

    def _parts(self, approach: ArrayLike) -> _Floats:
        """Spring force and damping coefficient at zero rate, stacked on axis 0."""
        u = as_approaches(approach)
        out = np.empty((2, u.size))
        fill_parts(u.ravel(), self.law, out)
        return out.reshape((2, *u.shape))


def _plain(value: _Floats) -> float | _Floats:
    return value if value.ndim else float(value)
