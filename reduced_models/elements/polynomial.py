"""The seven-term polynomial of Nonato and Cavalca (2010), eqs. 11 and 12."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from ehlcontact.checks import require_positive
from ehlcontact.point import Scales
from reduced_models.elements.memoryless import MemorylessContact
from reduced_models.elements.polynomial_law import PolynomialLaw, contact, contact_values, damper, part_values
from reduced_models.elements.validity import Band

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class PolynomialContact(MemorylessContact):
    """F = K1 u + C1 u' + K2 u^2 + C2 u'^2 + K3 u^3 + C3 u'^3 + B4 u u' on the box (eq. 11).

    Outside the box see `polynomial_law`. Use the cubic element unless the seven terms are wanted:
    the three further dampers are hardly identifiable (`reduced_models.sensitivity`).

    Parameters
    ----------
    K1, C1, K2, C2, K3, C3, B4 : float
        Coefficients, in the order of eq. 12.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `LinearContact`; without a `rate` the powers of the rate go on for ever.

    Raises
    ------
    InputError
        A value not finite, low >= high, a spring that does not push and stiffen at both ends, or a damper that
        puts energy into a cycle, C1 + B4 u + C3 u'^2 < 0.
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
    rate: float | None = None
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: PolynomialLaw = field(init=False, repr=False, compare=False)

    kind = "polynomial"
    parameter_names = ("K1", "C1", "K2", "C2", "K3", "C3", "B4")

    def __post_init__(self) -> None:
        super().__post_init__()
        fastest = math.inf if self.rate is None else require_positive("rate", self.rate)
        object.__setattr__(self, "law", PolynomialLaw.build(self.parameters, self.low, self.high, fastest))

    def rate_at(self, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0 at this approach.

        Where the damper is not monotone there are several; it is found from the rate of C1 + B4 u alone outwards.

        Raises
        ------
        InputError
            No damper acts there.
        """
        v = super().rate_at(approach, force)

        def excess(rate: float) -> float:
            return float(self.spring(approach)) + damper(approach, rate, self.law)[0] - force

        width = abs(v) if v != 0.0 else 1e-9
        while excess(v - width) * excess(v + width) > 0.0:
            width *= 2.0
        return float(brentq(excess, v - width, v + width, xtol=1e-300, rtol=1e-14))

    def _at(self, approach: float, rate: float) -> tuple[float, float, float]:
        return contact(approach, rate, self.law)

    def _values(self, approach: ArrayLike, rate: ArrayLike) -> _Floats:
        return contact_values(self.law, approach, rate)

    def _springs(self, approach: ArrayLike) -> _Floats:
        return part_values(self.law, approach)

    def _static_approach(self, force: float) -> float:
        return self.law.approach_at(force)

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        f, u, v = scales.force, scales.length, scales.rate
        springs = {f"K{i}": f / u**i for i in (1, 2, 3)}
        return springs | {f"C{i}": f / v**i for i in (1, 2, 3)} | {"B4": f / (u * v)}
