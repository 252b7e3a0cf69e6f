"""The power-law element of the literature that followed Nonato and Cavalca (2010)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.point import Scales
from reduced_models.elements.memoryless import MemorylessContact
from reduced_models.elements.power_law import PowerLaw, contact, contact_values, part_values
from reduced_models.elements.validity import Band

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class PowerLawContact(MemorylessContact):
    """F = K (u + u0)_+^n + F0 + C u' on [low, high].

    A dry point contact has n = 3/2, u0 = F0 = 0. Outside [low, high] the spring goes on like a Hertz contact, as
    that of every other element, so that it lets go where the surfaces part whatever F0 is.

    Parameters
    ----------
    K : float
        Factor, > 0; in SI N/m^n.
    n : float
        Exponent, > 0.
    u0 : float
        Shift of the approach, with u0 + low > 0.
    F0 : float
        Offset of the force.
    C : float
        Damping coefficient, >= 0.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `LinearContact`.

    Raises
    ------
    InputError
        A value not finite or outside its range, or a spring that does not push at both ends.
    """

    K: float
    n: float
    u0: float
    F0: float
    C: float
    low: float
    high: float
    rate: float | None = None
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: PowerLaw = field(init=False, repr=False, compare=False)

    kind = "power"
    parameter_names = ("K", "n", "u0", "F0", "C")

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "law", PowerLaw.build(self.parameters, self.low, self.high))

    def _at(self, approach: float, rate: float) -> tuple[float, float, float]:
        return contact(approach, rate, self.law)

    def _values(self, approach: ArrayLike, rate: ArrayLike) -> _Floats:
        return contact_values(self.law, approach, rate)

    def _springs(self, approach: ArrayLike) -> _Floats:
        return part_values(self.law, approach)

    def _static_approach(self, force: float) -> float:
        return self.law.approach_at(force)

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        unit = scales.force / scales.length**self.n
        return {"K": unit, "n": 1.0, "u0": scales.length, "F0": scales.force, "C": scales.damping}
