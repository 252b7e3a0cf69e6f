"""Elements without memory: a spring beside a damper, one law for all of them.

    F = (f(u) + d(u, u'))_+

On [low, high] f is the spring that was fitted, one kernel for each kind (`kernel_of`). Outside, a fitted spring
is meaningless (tension, negative stiffness), so it goes on as a dry Hertz contact would: A (u - o)^(3/2), joined
with equal value and slope. The damper

    d = s(u) (C1 u' + C2 u'^2 + C3 u'^3 + B4 u u')

fades out below `low` with the spring. Beyond the largest rate the powers of the rate, and outside [low, high] the
mixed term, level off with a continuous slope, so that far away only a viscous damper C1 + B4 u is left.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, overload

import numpy as np
from numba import extending
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_float, as_numbers, require_finite, require_positive
from ehlcontact.errors import InputError
from ehlcontact.jit import jit_exact
from ehlcontact.point import Scales
from reduced_models.elements.base import ContactElement, as_approaches
from reduced_models.elements.small_motion import StateSpace
from reduced_models.elements.validity import LARGEST, require_size

_Floats = NDArray[np.float64]

ADVICE = "(fit again over a wider range of approach, or with the linear model)"


# A law is a NamedTuple: coefficients of the spring, and what all laws have: low, high, C1, C2, C3, B4, the largest
# rate (inf where it is not known), and origins and factors of the ends, which `joined` finds. It is flat, for one
# of NamedTuples takes twice as long to hand to a kernel [measured: 2.5 us instead of 1.5].
Law = Any
_KERNELS: dict[type, Callable] = {}


def kernel_of(kind: type) -> Callable[[Callable], Callable]:
    """Enter a kernel (u, law) -> (force, tangent) as the spring between the ends of laws of class `kind`."""

    def enter(kernel: Callable) -> Callable:
        _KERNELS[kind] = kernel
        return kernel

    return enter


def inside(u: float, law: Law) -> tuple[float, float]:
    """Force and tangent of the spring between the ends, by the kernel of the law's class; kernels call it too."""
    return _KERNELS[type(law)](u, law)


@extending.overload(inside)
def _inside(u, law):
    kernel = _KERNELS[law.instance_class]

    def call(u, law):
        return kernel(u, law)

    return call


def joined(law: Law) -> Law:
    """Return the law with its ends, which continue the spring beyond low and high.

    Raises
    ------
    InputError
        A force or tangent that is not positive at an end, where no Hertz-like continuation exists, or one whose
        coefficients are beyond floating-point numbers.
    """
    ends: dict[str, float] = {}
    for name in ("low", "high"):
        u = getattr(law, name)
        force, slope = inside(u, law)
        if not force > 0.0:
            raise InputError(f"spring force at {name}", force, f"> 0 {ADVICE}")
        if not slope > 0.0:
            raise InputError(f"spring tangent at {name}", slope, f"> 0 {ADVICE}")
        reach = 1.5 * force / slope
        try:
            factor = force / reach**1.5
        except ArithmeticError:  # overflow, or a division by what has become zero
            factor = math.nan
        fits = force <= LARGEST and slope <= LARGEST and math.isfinite(u - reach)
        if not (fits and 0.0 < factor < math.inf):
            values = f"force {force:g}, tangent {slope:g}"
            raise InputError(f"spring at {name}", values, "smaller or larger (the units may be wrong)")
        ends |= {f"o_{name}": u - reach, f"A_{name}": factor}
    return law._replace(**ends)


@jit_exact
def hertz(reach, factor):
    """Force and tangent of ``factor reach^(3/2)``, zero at and below reach 0."""
    if reach <= 0.0:
        return 0.0, 0.0
    root = np.sqrt(reach)
    return factor * reach * root, 1.5 * factor * root


@jit_exact
def fade(u, low, o_low):
    """Share of the damper at approach `u` and its derivative: 1 from `low` upwards, 0 where the spring ends."""
    if u >= low:
        return 1.0, 0.0
    width = low - o_low
    s = (u - o_low) / width
    if s <= 0.0:
        return 0.0, 0.0
    return s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / width


@jit_exact
def saturate(x, low, high, reach):
    """`x` and slope 1 on [low, high]; beyond, it comes to rest within `reach` with a continuous slope."""
    if x > high:
        t = np.tanh((x - high) / reach)
        return high + reach * t, 1.0 - t * t
    if x < low:
        t = np.tanh((low - x) / reach)
        return low - reach * t, 1.0 - t * t
    return x, 1.0


@jit_exact
def spring(u, law):
    """Force and tangent of the spring at approach `u`."""
    if u > law.high:
        return hertz(u - law.o_high, law.A_high)
    if u < law.low:
        return hertz(u - law.o_low, law.A_low)
    return inside(u, law)


@jit_exact
def damper(u, v, law):
    """Force of the damper and its derivatives with respect to `u` and `v`."""
    s, ds = fade(u, law.low, law.o_low)
    if s == 0.0:
        return 0.0, 0.0, 0.0
    if law.C2 == 0.0 and law.C3 == 0.0 and law.B4 == 0.0:  # most are; and 0 inf is no force, however fast
        return law.C1 * s * v, law.C1 * ds * v, law.C1 * s
    at, du = saturate(u, law.low, law.high, 0.5 * (law.high - law.low))
    w, dw = saturate(v, -law.rate, law.rate, law.rate)
    c = law.C1 + law.B4 * at
    # Beyond the largest rate the powers follow their tangent there, along the levelled rate.
    edge = min(max(v, -law.rate), law.rate)
    slope = 2.0 * law.C2 * edge + 3.0 * law.C3 * edge * edge
    powers = edge * edge * (law.C2 + law.C3 * edge) + slope * (w - edge)
    force = c * v + powers
    return s * force, ds * force + s * law.B4 * du * v, s * (c + slope * dw)


@jit_exact
def contact(u, v, law):
    """Force, dF/du and dF/dv at approach `u` and rate `v`; all zero where the force would pull."""
    f, k = spring(u, law)
    d, d_u, d_v = damper(u, v, law)
    force = f + d
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + d_u, d_v


@jit_exact
def fill_contact(u, v, law, out):
    """Write force, dF/du and dF/dv at every point, shape (3, n)."""
    for i in range(u.size):
        out[0, i], out[1, i], out[2, i] = contact(u[i], v[i], law)


@jit_exact
def fill_parts(u, law, out):
    """Write spring force and damping coefficient at zero rate, shape (2, n)."""
    for i in range(u.size):
        out[0, i] = spring(u[i], law)[0]
        out[1, i] = damper(u[i], 0.0, law)[2]


class MemorylessContact(ContactElement):
    """Spring beside damper, never pulling: exact tangents, no state. A subclass gives its law and its units."""

    law: Law
    beyond: ClassVar[Mapping[str, str]] = {
        "frequency": "it is for the band it was made in: a film memory (model 'memory' or 'wide') is for all"
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "law", joined(self._law()))
        require_size("damping", float(np.abs(self._parts([self.low, self.high])[1]).max()))

    @abstractmethod
    def _law(self) -> Law:
        """The law of the coefficients, checked, its ends not yet joined."""

    @abstractmethod
    def _approach_between(self, force: float) -> float:
        """Approach on [low, high] at which the spring carries `force`, which lies between the forces there."""

    @abstractmethod
    def _si_factors(self, scales: Scales) -> dict[str, float]:
        """SI value of the unit of every coefficient."""

    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        factor = self._si_factors(scales)
        return {name: value * factor[name] for name, value in self.parameters.items()}

    @overload
    def force(self, approach: float, rate: float) -> float: ...
    @overload
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Contact force, never negative; scalars or arrays that broadcast.

        Of a single value outside the validity box it warns, once per element; arrays are questions.
        """
        if not (isinstance(approach, float) and isinstance(rate, float)):
            found = self._value(0, approach, rate)
            if isinstance(found, float):
                self._watch(float(approach), float(rate), found)  # type: ignore[arg-type]
            return found
        force = contact(approach, rate, self.law)[0]
        low, high, fastest, least, most = self._reach  # here, for the sake of integrators: a call takes 0.1 us
        if not (low <= approach <= high and -fastest <= rate <= fastest and least <= force <= most):
            self.warn_outside(approach, rate, force=force)
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
        if force <= spring(law.low, law)[0]:
            return float(law.o_low + (force / law.A_low) ** (2.0 / 3.0))
        if force >= spring(law.high, law)[0]:
            return float(law.o_high + (force / law.A_high) ** (2.0 / 3.0))
        return self._approach_between(force)

    def rate_at(self, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0 at this approach: the motion without inertia.

        Raises
        ------
        InputError
            No damper acts there.
        """
        spring, damping = (float(part) for part in self._parts(approach))
        if damping <= 0.0:
            raise InputError(f"damping at approach {approach:g}", damping, "> 0 for a motion without inertia")
        return (force - spring) / damping

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
        """Nothing to restore."""

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
