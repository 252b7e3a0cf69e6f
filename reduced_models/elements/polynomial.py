"""Polynomials of Nonato and Cavalca (2010), eqs. 8, 11 and 12: linear, cubic, and all seven terms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import scipy

from ehlcontact.checks import require_nonnegative, require_positive
from ehlcontact.errors import InputError
from ehlcontact.jit import jit_exact
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.spring import ADVICE, MemorylessContact, damper, kernel_of


class PolynomialLaw(NamedTuple):
    """Eq. 11 between the ends; see `reduced_models.elements.spring`."""

    low: float
    high: float
    K1: float
    C1: float
    K2: float = 0.0
    C2: float = 0.0
    K3: float = 0.0
    C3: float = 0.0
    B4: float = 0.0
    rate: float = math.inf
    o_low: float = math.nan
    A_low: float = math.nan
    o_high: float = math.nan
    A_high: float = math.nan


@kernel_of(PolynomialLaw)
@jit_exact
def cubic(u, law):
    """Cubic through the origin, and its derivative."""
    return u * (law.K1 + u * (law.K2 + u * law.K3)), law.K1 + u * (2.0 * law.K2 + u * 3.0 * law.K3)


class _PolynomialContact(MemorylessContact):
    """Base of the three: one law, in which coefficients that an element does not have are zero."""

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_rising(self.law)

    def _law(self) -> PolynomialLaw:
        return PolynomialLaw(self.low, self.high, **self.parameters)

    def _approach_between(self, force: float) -> float:
        law = self.law
        return float(
            scipy.optimize.brentq(lambda u: cubic(u, law)[0] - force, law.low, law.high, xtol=1e-300, rtol=1e-14)
        )


class ViscousContact(_PolynomialContact):
    """Base of `LinearContact` and `CubicContact`, whose only damper is C1."""

    C1: float

    def _law(self) -> PolynomialLaw:
        require_nonnegative("C1", self.C1)
        return super()._law()

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        return {f"K{i}": scales.force / scales.length**i for i in (1, 2, 3)} | {"C1": scales.damping}


@stored("contact element")
@dataclass(frozen=True)
class LinearContact(ViscousContact):
    """Linear spring and viscous damper, F = K1 u + C1 u' on [low, high] (eq. 8).

    Parameters
    ----------
    K1, C1 : float
        Stiffness and damping; in SI N/m and N s/m.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`.

    Raises
    ------
    InputError
        A value not finite, C1 < 0, low >= high, or a spring that does not push at both ends.
    """

    K1: float
    C1: float
    low: float
    high: float

    kind = "linear"
    parameter_names = ("K1", "C1")


@stored("contact element")
@dataclass(frozen=True)
class CubicContact(ViscousContact):
    """Cubic spring and viscous damper, F = K1 u + K2 u^2 + K3 u^3 + C1 u' on [low, high] (eq. 11).

    Parameters
    ----------
    K1, K2, K3, C1 : float
        Coefficients; in SI N/m, N/m^2, N/m^3 and N s/m. Only the root and the tangent of the spring are
        identifiable from a small vibration, not the single K.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`.

    Raises
    ------
    InputError
        A value not finite, C1 < 0, low >= high, a spring that does not push and stiffen at both ends, or one
        that falls in between.
    """

    K1: float
    K2: float
    K3: float
    C1: float
    low: float
    high: float

    kind = "cubic"
    parameter_names = ("K1", "K2", "K3", "C1")


@stored("contact element")
@dataclass(frozen=True)
class PolynomialContact(_PolynomialContact):
    """F = K1 u + C1 u' + K2 u^2 + C2 u'^2 + K3 u^3 + C3 u'^3 + B4 u u' on the box (eq. 11).

    Outside the box see `reduced_models.elements.spring`. Use the cubic element unless the seven terms are wanted:
    the three further dampers are hardly identifiable (`reduced_models.sensitivity`).

    Parameters
    ----------
    K1, C1, K2, C2, K3, C3, B4 : float
        Coefficients, in the order of eq. 12.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`; without a `rate` the powers of the rate go on for ever.

    Raises
    ------
    InputError
        A value not finite, low >= high, a spring that does not push and stiffen at both ends or falls in between,
        or a damper that puts energy into a cycle, C1 + B4 u + C3 u'^2 < 0.
    """

    K1: float
    C1: float
    K2: float
    C2: float
    K3: float
    C3: float
    B4: float
    low: float
    high: float

    kind = "polynomial"
    parameter_names = ("K1", "C1", "K2", "C2", "K3", "C3", "B4")

    def rate_at(self, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0 at this approach.

        Where the damper is not monotone there are several; it is found from the rate of C1 + B4 u alone outwards.

        Raises
        ------
        InputError
            No damper acts there, or none of its rates makes up for the force.
        """
        v = super().rate_at(approach, force)

        def excess(rate: float) -> float:
            return float(self.spring(approach)) + damper(approach, rate, self.law)[0] - force

        width = abs(v) if v != 0.0 else 1e-9
        while excess(v - width) * excess(v + width) > 0.0:
            width *= 2.0
            if not math.isfinite(width):
                raise InputError(f"force at approach {approach:g}", force, "one that some rate gives")
        return float(scipy.optimize.brentq(excess, v - width, v + width, xtol=1e-300, rtol=1e-14))

    def _law(self) -> PolynomialLaw:
        fastest = math.inf if self.rate is None else require_positive("rate", self.rate)
        law = super()._law()._replace(rate=fastest)
        _require_dissipation(law)
        return law

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        f, u, v = scales.force, scales.length, scales.rate
        springs = {f"K{i}": f / u**i for i in (1, 2, 3)}
        return springs | {f"C{i}": f / v**i for i in (1, 2, 3)} | {"B4": f / (u * v)}


def _require_rising(law: PolynomialLaw) -> None:
    """Raise `InputError` where a spring that rises at both ends falls in between."""
    if law.K3 <= 0.0:  # the tangent is a line, or highest in the middle
        return
    lowest = -law.K2 / (3.0 * law.K3)  # where the tangent is lowest
    if law.low < lowest < law.high:
        slope = cubic(lowest, law)[1]
        if not slope > 0.0:
            raise InputError(f"spring tangent at approach {lowest:.4g}", slope, f"> 0 {ADVICE}")


def _require_dissipation(law: PolynomialLaw) -> None:
    """Raise `InputError` where a damper feeds energy into a cycle somewhere in the box or beyond it."""
    # Even powers of the rate cancel over a cycle; what remains is linear in u and in u'^2: look at corners.
    reach = 0.5 * (law.high - law.low)
    cubed = law.C3 * law.rate**2 if law.C3 != 0.0 else 0.0
    for u in (law.low - reach, law.high + reach):
        for more in (0.0, cubed):
            damping = law.C1 + law.B4 * u + more
            if not damping >= 0.0:
                raise InputError(
                    f"cycle damping C1 + B4 u + C3 rate^2 at u = {u:.4g}", damping, ">= 0 (fit the cubic model)"
                )
