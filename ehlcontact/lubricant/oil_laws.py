"""`Lubricant`; dimensionless laws of viscosity and density, compiled for the kernels.

Roelands (1966) with p0 = 1.96e8 Pa, Barus (1893), and Dowson-Higginson (1966) density, each as written in
Venner and Lubrecht (2000), ch. 1. A new law is entered here: its name, its numbers in `FluidLaw`, and its branch
in `density` or `log_viscosity`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

from ehlcontact.checks import require_choice, require_finite, require_nonnegative, require_positive
from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.checks.parts import OIL_DENSITY, TEMPERATURE
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.elementary import exponential, logarithm
from ehlcontact.errors import InputError
from ehlcontact.jit import jit_node
from ehlcontact.lubricant.oil import (
    GOLD_PRESSURE,
    GRADE_SCATTER,
    KINEMATIC,
    SHEET_SCATTER,
    USUAL_DENSITY,
    USUAL_DENSITY_15,
    USUAL_INDEX,
    MineralOil,
)
from ehlcontact.summary import Summary

VISCOSITY_LAWS = ("roelands", "barus")
DENSITY_LAWS = ("dowson-higginson", "incompressible")

ROELANDS_P0 = 1.96e8  # Pa
ROELANDS_LOG = 9.67  # ln(1/6.31e-5 Pa s): the viscosity all Roelands curves meet at p = -p0
DOWSON_HIGGINSON_C1 = 5.9e8  # Pa
DOWSON_HIGGINSON_C2 = 1.34  # -


class FluidLaw(NamedTuple):
    """Numbers the compiled laws need; a NamedTuple, because numba passes these by value.

    With ``P = p/p_h``: viscosity is ``exp(alpha_bar P)`` (Barus) or
    ``exp(q ((1 + s P)^z - 1))`` (Roelands); density is ``(d + 1.34 P)/(d + P)`` or 1.
    """

    roelands: bool
    alpha_bar: float  # alpha p_h
    q: float  # ln(eta0) + 9.67
    s: float  # p_h / p0
    z: float  # alpha p0 / q
    compressible: bool
    d: float  # 5.9e8 Pa / p_h


@fields_take(eta0="Pa s", alpha="1/Pa", temperature_slope="1/K", temperature=TEMPERATURE, rho0=OIL_DENSITY)
@dataclass(frozen=True, slots=True)
class Lubricant(Summary):
    """Oil at inlet temperature; `iso_vg` makes one from its grade, `from_viscosities` from its data sheet.

    Parameters
    ----------
    eta0 : float
        Dynamic viscosity at ambient pressure [Pa s].
    alpha : float
        Pressure-viscosity coefficient, d ln(eta)/dp at ambient pressure [1/Pa]; 0 is isoviscous.
    viscosity, density : {"roelands", "barus"}, {"dowson-higginson", "incompressible"}
        Laws of viscosity and density over pressure.
    eta0_scatter, alpha_scatter : float, optional
        How far, relative, the oil itself may be from `eta0` and `alpha`. Only kept: nothing is computed from them.
    temperature_slope : float, optional
        -d ln(eta0)/dT [1/K], for what heat does to a film (`Heat`).
    temperature : float, optional
        Of the inlet, where eta0 holds, in degrees Celsius, for the same.
    rho0 : float, optional
        Density at ambient pressure and that temperature [kg/m3], for `kinematic_viscosity`: 850 without it.

    Raises
    ------
    InputError
        A number outside its range, an unknown law, or an eta0 that Roelands' law cannot take.
    """

    eta0: float = 0.04
    alpha: float = 2.2e-8
    viscosity: str = "roelands"
    density: str = "dowson-higginson"
    eta0_scatter: float | None = field(default=None, kw_only=True)
    alpha_scatter: float | None = field(default=None, kw_only=True)
    temperature_slope: float | None = field(default=None, kw_only=True)
    temperature: float | None = field(default=None, kw_only=True)
    rho0: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "eta0", require_positive("eta0", self.eta0))
        object.__setattr__(self, "alpha", require_nonnegative("alpha", self.alpha))
        require_choice("viscosity", self.viscosity, VISCOSITY_LAWS)
        require_choice("density", self.density, DENSITY_LAWS)
        for name in ("eta0_scatter", "alpha_scatter", "temperature_slope"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, require_nonnegative(name, getattr(self, name)))
        if self.temperature is not None:
            object.__setattr__(self, "temperature", require_finite("temperature", self.temperature))
        INPUTS["alpha"]._replace(zero=True).require("alpha", self.alpha)
        if self.eta0 > INPUTS["eta0"].limits[1]:
            INPUTS["eta0"].require("eta0", self.eta0)
        if self.viscosity == "roelands" and math.log(self.eta0) + ROELANDS_LOG <= 0.0:
            guess = INPUTS["eta0"].slip(self.eta0)
            allowed = "> 6.31e-5 Pa s for Roelands' law"
            raise InputError("eta0", self.eta0, f"{allowed} ({guess})" if guess else allowed)

    @classmethod
    @takes(temperature="degrees Celsius", density_15="kg/m3")
    def iso_vg(
        cls,
        grade: int,
        *,
        temperature: float,
        viscosity_index: float = USUAL_INDEX,
        density_15: float = USUAL_DENSITY_15,
        viscosity: str = "roelands",
        density: str = "dowson-higginson",
    ) -> Lubricant:
        """Mineral oil of an ISO viscosity grade.

        eta0 follows from ASTM D2270, D341 and D1250; `alpha` from the correlation of Gold et al. (2001), such that
        the law passes through its viscosity at 200 MPa. Both stand beside their scatter: ISO 3448 allows a grade
        10 % of viscosity, and `alpha` of mineral oils is known to some 20 %. Who has a measured value takes that:
        ``replace(oil, alpha=2.1e-8, alpha_scatter=0.03)``. See `MineralOil` and docs/assumptions.md.

        Parameters
        ----------
        grade : int
            10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460 or 680: mm2/s at 40 C.
        temperature : float
            Of the inlet, in degrees Celsius; 20 to 120.
        viscosity_index : float
            80 to 120; 95 is common.
        density_15 : float
            Density at 15 C [kg/m3], 800 to 950.
        viscosity : {"roelands", "barus"}
        density : {"dowson-higginson", "incompressible"}

        Raises
        ------
        InputError
            A value outside its range, or an unknown law.
        """
        oil = MineralOil.of_grade(grade, temperature, viscosity_index, density_15)
        return cls._of(oil, viscosity, density, GRADE_SCATTER)

    @classmethod
    @takes(nu40=KINEMATIC, nu100=KINEMATIC, temperature="degrees Celsius", density_15="kg/m3")
    def from_viscosities(
        cls,
        *,
        nu40: float,
        nu100: float,
        temperature: float,
        density_15: float = USUAL_DENSITY_15,
        viscosity: str = "roelands",
        density: str = "dowson-higginson",
    ) -> Lubricant:
        """Oil by its kinematic viscosities at 40 and 100 C, as data sheets have them, of greases for the base oil.

        eta0 follows from ASTM D341 and D1250, `alpha` as in `iso_vg`. That correlation is of mineral oils: with a
        viscosity index outside 80 to 120, `alpha_scatter` is 0.35, and a synthetic oil is on the lower side.

        Parameters
        ----------
        nu40, nu100 : float
            In mm2/s (cSt).
        temperature : float
            Of the inlet, in degrees Celsius; 20 to 120.
        density_15 : float
            Density at 15 C [kg/m3], 800 to 950.
        viscosity : {"roelands", "barus"}
        density : {"dowson-higginson", "incompressible"}

        Raises
        ------
        InputError
            A value outside its range, viscosities of no oil, or an unknown law.
        """
        return cls._of(MineralOil(nu40, nu100, temperature, density_15), viscosity, density, SHEET_SCATTER)

    @classmethod
    def _of(cls, oil: MineralOil, viscosity: str, density: str, eta0_scatter: float) -> Lubricant:
        require_choice("viscosity", viscosity, VISCOSITY_LAWS)
        return cls(
            oil.eta0,
            alpha_through(oil.alpha_secant, oil.eta0, viscosity),
            viscosity,
            density,
            eta0_scatter=eta0_scatter,
            alpha_scatter=oil.alpha_scatter,
            temperature_slope=oil.temperature_slope,
            temperature=oil.temperature,
            rho0=oil.density,
        )

    @property
    def kinematic_viscosity(self) -> float:
        """Viscosity at ambient pressure and the temperature of the inlet [m2/s]."""
        return self.eta0 / (USUAL_DENSITY if self.rho0 is None else self.rho0)

    def law(self, p_hertz: float, alpha_bar: float) -> FluidLaw:
        """Laws in units of the Hertz pressure; `alpha_bar` = alpha p_h.

        Both go to 0 with L, by soft bodies: at L = 0 no pressure compresses the oil, or thickens it. `alpha_bar`
        alone is 0 for an isoviscous oil between hard ones.
        """
        q = math.log(self.eta0) + ROELANDS_LOG
        pressed = p_hertz > 0.0
        return FluidLaw(
            roelands=self.viscosity == "roelands" and alpha_bar > 0.0,
            alpha_bar=alpha_bar,
            q=q,
            s=p_hertz / ROELANDS_P0,
            z=self.alpha * ROELANDS_P0 / q,
            compressible=self.density == "dowson-higginson" and pressed,
            d=DOWSON_HIGGINSON_C1 / p_hertz if pressed else math.inf,
        )


def alpha_through(secant: float, eta0: float, viscosity: str) -> float:
    """`alpha` [1/Pa] with which a law reaches ``ln(eta/eta0) = secant p`` at p = 200 MPa.

    Roelands' law is curved: its slope at ambient pressure lies some 15 % above that secant.
    """
    if viscosity == "barus":
        return secant
    q = math.log(eta0) + ROELANDS_LOG
    z = math.log1p(secant * GOLD_PRESSURE / q) / math.log1p(GOLD_PRESSURE / ROELANDS_P0)
    return z * q / ROELANDS_P0


def secant_over_slope(alpha: float, eta0: float, end: float) -> float:
    """Secant of Roelands' ln(eta) from ambient pressure to where alpha p = `end`, over its slope alpha there."""
    q = math.log(eta0) + ROELANDS_LOG
    return q * math.expm1(alpha * ROELANDS_P0 / q * math.log1p(end / (alpha * ROELANDS_P0))) / end


@jit_node
def density(P, law):
    """Density at P = p/p_h over ambient density, Dowson-Higginson or 1, and its derivative; P a float or lanes."""
    if law.compressible:
        inverse = 1.0 / (law.d + P)
        # 0.34 = C2 - 1, written out because the difference would be rounded
        return (law.d + DOWSON_HIGGINSON_C2 * P) * inverse, 0.34 * law.d * inverse * inverse
    return 1.0 + 0.0 * P, 0.0 * P  # of the type of P


@jit_node
def log_viscosity(P, law):
    """Logarithm of viscosity over eta0 at P = p/p_h, Roelands or Barus, and its derivative; P a float or lanes."""
    if law.roelands:
        base = 1.0 + law.s * P
        power = exponential(law.z * logarithm(base))
        return law.q * (power - 1.0), law.q * law.z * law.s * power / base
    return law.alpha_bar * P, law.alpha_bar + 0.0 * P


@jit_node
def heated(cold, heat, law):
    """`log_viscosity` at another temperature, from that at the inlet's: Roelands' ln(eta) + 9.67, times 1 + heat.

    So the temperature counts more under pressure; of Barus' law too.
    """
    log_eta, slope = cold
    return log_eta + heat * (log_eta + law.q), slope * (1.0 + heat)
