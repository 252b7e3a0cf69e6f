"""Viscous elements: a spring, linear or cubic in the approach, beside a damper.

Nonato and Cavalca (2010), eqs. 8 and 11 with the terms their Table 2 keeps.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.point import Scales
from reduced_models.elements.memoryless import MemorylessContact
from reduced_models.elements.validity import Band
from reduced_models.elements.viscous_law import ViscousLaw, contact, contact_values, part_values

_Floats = NDArray[np.float64]


class ViscousContact(MemorylessContact):
    """What `LinearContact` and `CubicContact` have in common; build one of those."""

    law: ViscousLaw

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "law", self._law())

    @abstractmethod
    def _law(self) -> ViscousLaw:
        """The force law of the coefficients, checked."""

    def _at(self, approach: float, rate: float) -> tuple[float, float, float]:
        return contact(approach, rate, self.law)

    def _values(self, approach: ArrayLike, rate: ArrayLike) -> _Floats:
        return contact_values(self.law, approach, rate)

    def _springs(self, approach: ArrayLike) -> _Floats:
        return part_values(self.law, approach)

    def _static_approach(self, force: float) -> float:
        return self.law.approach_at(force)

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        return {f"K{i}": scales.force / scales.length**i for i in (1, 2, 3)} | {"C1": scales.damping}


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
    load_range, omega_range : (low, high), optional
        Forces and angular frequencies that they stand for.
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
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: ViscousLaw = field(init=False, repr=False, compare=False)

    kind = "linear"
    parameter_names = ("K1", "C1")

    def _law(self) -> ViscousLaw:
        return ViscousLaw.build((self.K1, 0.0, 0.0), self.C1, self.low, self.high)


@dataclass(frozen=True)
class CubicContact(ViscousContact):
    """Cubic spring and viscous damper, F = K1 u + K2 u^2 + K3 u^3 + C1 u' on [low, high] (eq. 11).

    Parameters
    ----------
    K1, K2, K3, C1 : float
        Coefficients; in SI N/m, N/m^2, N/m^3 and N s/m. Only the root and the tangent of the spring are
        identifiable from a small vibration, not the single K.
    low, high, rate, load_range, omega_range, units, fit, source
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
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: ViscousLaw = field(init=False, repr=False, compare=False)

    kind = "cubic"
    parameter_names = ("K1", "K2", "K3", "C1")

    def _law(self) -> ViscousLaw:
        return ViscousLaw.build((self.K1, self.K2, self.K3), self.C1, self.low, self.high)
