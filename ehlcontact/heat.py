"""`Heat`: what the heating of a film needs of oil and surfaces, as an input.

How the solver uses it: `ehlcontact.solver.film_heat`; equations and sources: docs/notes/heat.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import inf, log, pi, sqrt
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_between, require_finite
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.lubricant.oil import KELVIN, typical_temperature_slope
from ehlcontact.lubricant.oil_laws import ROELANDS_LOG
from ehlcontact.lubricant.traction_laws import Carreau, Eyring
from ehlcontact.point import MoesPoint, OperatingPoint, Point, Scales
from ehlcontact.summary import Summary

ROELANDS_COLD = 135.0  # K: Roelands counts temperatures from -135 C
COLDEST = -0.3  # of that of the inlet over Roelands' -135 C: only iterates are colder
LARGEST_HEATED = 1.0  # slide-to-roll ratio
RANGES = {
    "slide_roll": (-LARGEST_HEATED, LARGEST_HEATED),
    "temperature": (-50.0, 250.0),
    "temperature_slope": (0.0, 0.2),
    "conductivity": (0.05, 1.0),
    "heat_capacity": (5e5, 5e6),
    "expansion": (0.0, 2e-3),
    "eyring_stress": (1e5, 1e9),
}
EFFUSIVITIES = (100.0, 1e5)
STANDING = "between -1 and 1: near 2 one surface stands still, and the heat here needs surfaces that move"
SAME = 1.0  # K: temperatures of the heat and of the viscosity this close are one
MINERAL_OIL = 0.134  # W/(m K), measured of FVA 3 (Schwarz et al. 2023, table A1); mineral oils 0.12 to 0.15


class HeatNumbers(NamedTuple):
    """Numbers of the energy equation at an operating point, temperatures in K."""

    convection: float  # rho c/p_h, 1/K
    conduction: float  # 12 k a/(p_h u_mean delta_H^2), 1/K
    expansion: float  # 1/K
    inlet: float  # K
    slide_roll: float  # without sign
    shear: float  # ln of eta0 times the sliding speed over delta_H, over that stress; -inf without sliding
    stress: float  # of the law of sliding, times a/(p_h delta_H)
    law: Eyring | Carreau  # of the stress of sliding
    walls: tuple[float, float]  # rise of each surface after a unit of heat over a unit of sqrt(X), K
    temperature_scale: float  # of the inlet over Roelands' -135 C, K
    exponent: float  # S0 of Roelands

    def heating(self, temperature: NDArray[np.float64]) -> NDArray[np.float64]:
        """Relative change of ln(eta) + 9.67 at a temperature [K] above that of the inlet: Roelands (eq. 9)."""
        return np.expm1(-self.exponent * np.log1p(np.maximum(temperature / self.temperature_scale, COLDEST)))


OF_OIL = "temperature", "temperature_slope"  # by default those of the oil


@fields_take(temperature="degrees Celsius", temperature_slope="1/K", conductivity="W/(m K)", eyring_stress="Pa")
@dataclass(frozen=True, slots=True)
class Heat(Summary):
    """Data of oil and surfaces for a film that heats up.

    Parameters
    ----------
    slide_roll : float
        Slide-to-roll ratio: (u1 - u2)/u_mean, -1 to 1; u1 is the speed of the first body. Left out, it is that of
        `ShearThinning`, where that is given. At 2 the other would
        stand still, and its warming is modelled as that of a surface in motion.
    temperature : float, optional
        Of the oil in the inlet and of the surfaces ahead of it, in degrees Celsius; by default the oil's, and
        only for an oil that has none: the viscosity is that at this temperature.
    temperature_slope : float, optional
        -d ln(eta0)/dT [1/K] there; by default the oil's.
    conductivity : float
        Of the oil [W/(m K)].
    heat_capacity : float
        Of the oil per volume, rho c [J/(m3 K)].
    expansion : float
        Thermal expansion of the oil [1/K]: compression heats it.
    effusivity : float or (float, float)
        (k rho c)^(1/2) of both bodies, or of each [W s^0.5/(m2 K)]; bearing steel by default.
    eyring_stress : float
        Eyring stress [Pa], for the heat that sliding makes; with `ShearThinning` the stress is that of its law.

    Raises
    ------
    InputError
        A value outside its range.

    Examples
    --------
    >>> Heat(slide_roll=0.05).conductivity
    0.134
    """

    FIELD_UNITS: ClassVar[Mapping[str, str]] = {
        "heat_capacity": "J/(m3 K)",
        "expansion": "1/K",
        "effusivity": "W s^0.5/(m2 K)",
    }

    slide_roll: float = 0.0
    temperature: float | None = None
    temperature_slope: float | None = None
    conductivity: float = MINERAL_OIL
    heat_capacity: float = 1.7e6
    expansion: float = 6.5e-4
    effusivity: Any = 13_000.0
    eyring_stress: float = 5e6

    def __post_init__(self) -> None:
        for name, ends in RANGES.items():
            if getattr(self, name) is not None or name not in OF_OIL:
                number = require_finite(name, getattr(self, name))
                if name == "slide_roll" and abs(number) > LARGEST_HEATED:
                    raise InputError(name, number, STANDING)
                object.__setattr__(self, name, require_between(name, number, *ends))
        pair = self.effusivity if isinstance(self.effusivity, tuple | list) else (self.effusivity,) * 2
        if len(pair) != 2:
            raise InputError("effusivity", self.effusivity, "one number, or a pair: of both bodies")
        object.__setattr__(
            self, "effusivity", tuple(require_between("effusivity", one, *EFFUSIVITIES) for one in pair)
        )

    def at(self, point: Point) -> Heat:
        """The same with temperature and slope of the oil of this point, where they are not given.

        Raises
        ------
        InputError
            A dimensionless point; an oil without these data, or with its viscosity at another temperature.
        """
        if not isinstance(point, OperatingPoint):
            allowed = "left out at a dimensionless point: heat has to do with metres, seconds and kelvin"
            raise InputError("thermal", type(self).__name__, allowed)
        oil = point.lubricant
        slope = oil.temperature_slope if self.temperature_slope is None else self.temperature_slope
        warm = oil.temperature if self.temperature is None else self.temperature
        if slope is None:
            typical = typical_temperature_slope(oil.eta0)
            allowed = f"given in Heat [1/K]; a typical mineral oil of {oil.eta0:.3g} Pa s has {typical:.2g}, "
            raise InputError("temperature_slope", None, allowed + "and one by its grade (iso_vg) its own")
        if warm is None:
            raise InputError("temperature", None, "given in Heat: that of the inlet in degrees Celsius")
        if oil.temperature is not None and abs(warm - oil.temperature) > SAME:
            allowed = f"left out: the oil has its viscosity at {oil.temperature:g} C (give an oil at {warm:g} C)"
            raise InputError("temperature", warm, allowed)
        return replace(self, temperature=warm, temperature_slope=slope)

    def numbers(self, moes: MoesPoint, scales: Scales, law: Eyring | Carreau | None = None) -> HeatNumbers:
        """Dimensionless numbers of the energy equation; temperature and slope are known (`at`).

        `law` is that of the stress of sliding, by default Eyring's with the stress given.
        """
        assert self.temperature is not None and self.temperature_slope is not None
        law = Eyring(self.eyring_stress) if law is None else law
        speed, film, p_hertz = scales.a / scales.time, scales.length, scales.pressure
        slide = abs(self.slide_roll)
        faster = 1.0 if self.slide_roll >= 0.0 else -1.0
        unit = p_hertz * speed * film / scales.a  # W/m2
        walls = (
            unit * sqrt(scales.a / (pi * speed * (1.0 + 0.5 * slide * side))) / body
            for side, body in zip((1.0, -1.0), self.effusivity[:: int(faster)], strict=True)
        )
        first, second = walls
        above = self.temperature + ROELANDS_COLD
        return HeatNumbers(
            convection=self.heat_capacity / p_hertz,
            conduction=12.0 * self.conductivity * scales.a / (p_hertz * speed * film * film),
            expansion=self.expansion,
            inlet=self.temperature + KELVIN,
            slide_roll=slide,
            shear=log(moes.eta0 * speed * slide / (film * law.stress)) if slide else -inf,
            stress=law.stress * scales.a / (p_hertz * film),
            law=law,
            walls=(first, second),
            temperature_scale=above,
            exponent=self.temperature_slope * above / (log(moes.eta0) + ROELANDS_LOG),
        )

    def load(self, moes: MoesPoint, scales: Scales) -> float:
        """Thermal load Q: ``-d eta0/dT u_mean^2/k``."""
        assert self.temperature_slope is not None
        return self.temperature_slope * moes.eta0 * (scales.a / scales.time) ** 2 / self.conductivity

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return asdict(self) | {"effusivity": list(self.effusivity)}

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> Heat:
        """Back from `to_dict`."""
        return cls(**entries)
