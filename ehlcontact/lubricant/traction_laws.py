"""Traction laws: shear stress of an oil over the stress that it would have as a Newtonian liquid.

Equation numbers are those of docs/notes/traction.md. A new law is entered here: a class with `of`, its place in
`LAWS`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import inf
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_float, as_values, require_between, require_choice, require_instance
from ehlcontact.checks.admissible_range import Quantity
from ehlcontact.checks.quantity import fields_take
from ehlcontact.summary import Summary

Array = NDArray[np.float64]

STRESS = Quantity("Pa", (1e5, 1e9), (5e5, 1e9), {"MPa": 1e6})  # Eyring's, of oils: 2 to 10 MPa
LARGEST_SLIDE_ROLL = 2.0  # one surface stands still; beyond, the surfaces run against each other
LITTLE = -18.0  # ln of a stress over Eyring's, below which asinh equals its argument
STRAIGHT = 20.0  # the same, above which asinh is a logarithm


class TractionLaw(Summary):
    """Base of the traction laws."""

    __slots__ = ()
    thins: ClassVar[bool] = False  # whether `thinning` is implemented

    def of(self, log_newton: ArrayLike, p: ArrayLike) -> Array:
        """Shear stress [Pa].

        Parameters
        ----------
        log_newton : array_like
            ln of the Newtonian stress eta u_s/h [Pa]; -inf without sliding.
        p : array_like
            Pressure [Pa], > 0, of a shape that fits.
        """
        raise NotImplementedError

    def limit(self, p: ArrayLike) -> Array:
        """Stress [Pa] that no sliding exceeds at pressures p [Pa]; infinite where there is none."""
        return np.full(np.shape(p), inf)

    def thinning(self, log_newton: ArrayLike) -> tuple[Array, Array]:
        """Logarithms of the effective viscosities of a small flow beside the sliding, over the Newtonian one.

        Along the sliding the slope d tau/d tau_N, across it the ratio tau/tau_N (eqs. 8, 9).
        """
        raise NotImplementedError

    def thinning_slopes(self, log_newton: ArrayLike) -> tuple[Array, Array]:
        """Derivatives of both logarithms of `thinning` to `log_newton`."""
        raise NotImplementedError

    def reduced(self, log_ratio: ArrayLike) -> tuple[Array, Array]:
        """Stress over that of the law, by ln of Newton's over it, and its derivative; of laws with `thinning`."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """Name and numbers, ready for JSON."""
        return {"law": type(self).__name__, **asdict(self)}  # type: ignore[call-overload]

    @staticmethod
    def from_dict(entries: Mapping[str, Any]) -> TractionLaw:
        """Back from `to_dict`; raises `InputError` for an unknown law."""
        given = dict(entries)
        return LAWS[require_choice("law", given.pop("law", None), tuple(LAWS))](**given)


def log_sinh_law(log_ratio: ArrayLike) -> Array:
    """asinh(r) from ln r: shear stress over tau_0 by Eyring's law (eq. 3), without overflow."""
    x = as_values("log_ratio", log_ratio)
    return np.where(x > STRAIGHT, x + np.log(2.0), np.arcsinh(np.exp(np.minimum(x, STRAIGHT))))


@fields_take(stress="Pa")
@dataclass(frozen=True, slots=True)
class Eyring(TractionLaw):
    """Eyring's law: ``tau = tau_0 asinh(eta u_s/(tau_0 h))``.

    Eyring, J. Chem. Phys. 4 (1936) 283-291; Johnson and Tevaarwerk, Proc. R. Soc. A 356 (1977) 215-236.

    Parameters
    ----------
    stress : float
        Eyring stress tau_0 [Pa], 2 to 10 MPa for mineral oils.

    Raises
    ------
    InputError
        A stress outside 0.1 MPa to 1 GPa.
    """

    stress: float = 5e6
    thins: ClassVar[bool] = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "stress", _stress(self.stress))

    def thinning(self, log_newton: ArrayLike) -> tuple[Array, Array]:
        """1/cosh(tau/tau_0) along, and (tau/tau_0)/sinh(tau/tau_0) across: `TractionLaw.thinning`."""
        x = as_values("log_newton", log_newton) - np.log(self.stress)
        along = -0.5 * np.logaddexp(0.0, 2.0 * x)
        little = x < LITTLE
        across = np.where(little, 0.0, np.log(np.where(little, 1.0, log_sinh_law(x))) - np.where(little, 0.0, x))
        return along, across

    def reduced(self, log_ratio: ArrayLike) -> tuple[Array, Array]:
        """asinh(x), and x/(1 + x^2)^(1/2): `TractionLaw.reduced`."""
        x = as_values("log_ratio", log_ratio)
        return log_sinh_law(x), 1.0 / np.hypot(1.0, np.exp(-np.clip(x, -STRAIGHT, STRAIGHT)))

    def thinning_slopes(self, log_newton: ArrayLike) -> tuple[Array, Array]:
        """-x^2/(1 + x^2) along, x/((1 + x^2)^(1/2) asinh x) - 1 across: `TractionLaw.thinning_slopes`."""
        x = as_values("log_newton", log_newton) - np.log(self.stress)
        ratio = np.exp(-np.logaddexp(0.0, -2.0 * x))  # x^2/(1 + x^2)
        little = x < LITTLE
        return -ratio, np.where(little, 0.0, np.sqrt(ratio) / np.where(little, 1.0, log_sinh_law(x)) - 1.0)

    def of(self, log_newton: ArrayLike, p: ArrayLike) -> Array:
        """Shear stress [Pa]: `TractionLaw.of` (eq. 3)."""
        found = log_sinh_law(as_values("log_newton", log_newton) - np.log(self.stress))
        return np.asarray(self.stress * found + 0.0 * as_values("p", p))


@fields_take(stress="Pa")
@dataclass(frozen=True, slots=True)
class Carreau(TractionLaw):
    """Carreau's law over the Newtonian stress: ``tau = tau_N (1 + (tau_N/tau_c)^2)^((n - 1)/2)``.

    Carreau (1972) with a critical stress in place of a critical rate, so that it follows pressure and temperature
    as the viscosity does: Bair, High-Pressure Rheology for Quantitative Elastohydrodynamics (2007), ch. 8.

    Parameters
    ----------
    stress : float
        Critical stress tau_c [Pa]: Newtonian stress above which the oil is shear thinning.
    exponent : float
        n, above 0 and at most 1; 1 is Newtonian.

    Raises
    ------
    InputError
        A stress outside 0.1 MPa to 1 GPa, or another exponent.
    """

    stress: float = 5e6
    exponent: float = 0.5
    thins: ClassVar[bool] = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "stress", _stress(self.stress))
        object.__setattr__(self, "exponent", require_between("exponent", self.exponent, 0.01, 1.0))

    def thinning(self, log_newton: ArrayLike) -> tuple[Array, Array]:
        """``((1 + n x^2)/(1 + x^2))`` of the viscosity along, all of it across: `TractionLaw.thinning`."""
        square = 2.0 * (as_values("log_newton", log_newton) - np.log(self.stress))  # ln of x^2
        across = 0.5 * (self.exponent - 1.0) * np.logaddexp(0.0, square)
        slope = np.logaddexp(0.0, square + np.log(self.exponent)) - np.logaddexp(0.0, square)
        return across + slope, across

    def reduced(self, log_ratio: ArrayLike) -> tuple[Array, Array]:
        """X (1 + x^2)^((n - 1)/2), and x times its derivative: `TractionLaw.reduced`."""
        x = as_values("log_ratio", log_ratio)
        along, across = self.thinning(x + np.log(self.stress))
        return np.exp(x + across), np.exp(x + along)

    def thinning_slopes(self, log_newton: ArrayLike) -> tuple[Array, Array]:
        """As of `thinning`: `TractionLaw.thinning_slopes`."""
        x = as_values("log_newton", log_newton) - np.log(self.stress)
        share, own = (np.exp(-np.logaddexp(0.0, -2.0 * s)) for s in (x, x + 0.5 * np.log(self.exponent)))
        across = (self.exponent - 1.0) * share
        return across + 2.0 * (own - share), across

    def of(self, log_newton: ArrayLike, p: ArrayLike) -> Array:
        """Shear stress [Pa]: `TractionLaw.of` (eq. 4)."""
        log_newton = as_values("log_newton", log_newton)
        thinner = 0.5 * (self.exponent - 1.0) * np.logaddexp(0.0, 2.0 * (log_newton - np.log(self.stress)))
        return np.asarray(np.exp(log_newton + thinner) + 0.0 * as_values("p", p))


@fields_take(base="Pa")
@dataclass(frozen=True, slots=True)
class LimitingShear(TractionLaw):
    """Limiting shear stress: ``tau = tau_L (1 - exp(-tau_N/tau_L))``, ``tau_L = base + coefficient p``.

    Bair and Winer, J. Lubrication Technology 101 (1979) 251-257, their exponential form.

    Parameters
    ----------
    coefficient : float
        Limiting stress over pressure, 0.04 to 0.08 for mineral oils, 0.03 to 0.05 for esters and PAO.
    base : float
        Limiting stress without pressure [Pa].

    Raises
    ------
    InputError
        A coefficient outside 0.001 to 0.5, or a base that is negative or above 0.1 GPa.
    """

    coefficient: float = 0.05
    base: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "coefficient", require_between("coefficient", self.coefficient, 1e-3, 0.5))
        object.__setattr__(self, "base", require_between("base", self.base, 0.0, 1e8))

    def of(self, log_newton: ArrayLike, p: ArrayLike) -> Array:
        """Shear stress [Pa]: `TractionLaw.of` (eq. 5)."""
        most = self.limit(p)
        return np.asarray(
            -most * np.expm1(-np.exp(np.minimum(as_values("log_newton", log_newton) - np.log(most), STRAIGHT)))
        )

    def limit(self, p: ArrayLike) -> Array:
        """Limiting stress [Pa]."""
        return np.asarray(self.base + self.coefficient * as_values("p", p))


LAWS: Mapping[str, type[TractionLaw]] = {law.__name__: law for law in (Eyring, Carreau, LimitingShear)}


def require_law(value: object) -> None:
    """Raise `InputError` unless this is a traction law."""
    require_instance("law", value, TractionLaw, "a traction law: Eyring(...), Carreau(...) or LimitingShear(...)")


def _stress(value: object) -> float:
    """A stress in its range; the message says where MPa seem to be meant."""
    stress = as_float("stress", value)
    STRESS.require("stress", stress)
    return stress
