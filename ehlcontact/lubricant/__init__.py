"""Lubricant: its data by numbers or ISO grade, and its viscosity and density laws for the kernels.

======= =======================================================================================
module  responsibility
======= =======================================================================================
``oil_laws`` `Lubricant`; the laws of viscosity and density, dimensionless and compiled
``traction_laws`` `Eyring`, `Carreau`, `LimitingShear`: non-Newtonian shear stress of an oil
``oil`` mineral oils by viscosities or grade, at a temperature: viscosity, density, their slopes and scatter
======= =======================================================================================
"""

from ehlcontact.lubricant.oil import MineralOil
from ehlcontact.lubricant.oil_laws import (
    DENSITY_LAWS,
    VISCOSITY_LAWS,
    FluidLaw,
    Lubricant,
    density,
    heated,
    log_viscosity,
)
from ehlcontact.lubricant.traction_laws import Carreau, Eyring, LimitingShear, TractionLaw

__all__ = [
    "DENSITY_LAWS",
    "VISCOSITY_LAWS",
    "Carreau",
    "Eyring",
    "FluidLaw",
    "LimitingShear",
    "Lubricant",
    "MineralOil",
    "TractionLaw",
    "density",
    "heated",
    "log_viscosity",
]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
