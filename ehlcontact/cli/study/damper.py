"""Squeeze film dampers of a study, as calls of the library."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehlcontact.cli.study.machine import called, support_field
from ehlcontact.cli.study.parts import Part
from ehlcontact.errors import InputError
from reduced_models import SqueezeFilmDamper

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

ENTRIES = {  # where the library calls them otherwise
    "length": "length_mm",
    "diameter": "diameter_mm",
    "clearance": "clearance_um",
}


def damper_parts(study: Study) -> dict[int, Part]:
    """The calls that make the dampers of the machine, by the place of their support in the file.

    Raises
    ------
    InputError
        A support that is none, stands on no springs or has a damper already; no viscosity.
    """
    parts: dict[int, Part] = {}
    for k, one in enumerate(study.damper):
        at = f"damper.{'' if len(study.damper) == 1 else f'{k + 1}.'}"
        place = study.index(one.support, f"{at}support")
        if place in parts:
            raise InputError(f"{at}support", study.names[place], "that of no other damper")
        if study.support[place].housing_stiffness is None:
            allowed = "given, with [[damper]]: the springs that its housing stands on"
            raise InputError(support_field(study, place, "housing_stiffness"), None, allowed)
        viscosity = one.viscosity
        if viscosity is None:
            if study.lubricant is None:
                raise InputError(f"{at}viscosity", None, "given, or [oil]")
            viscosity = study.lubricant.eta0
        part = Part(
            SqueezeFilmDamper,
            {
                "length": 1e-3 * one.length_mm,
                "diameter": 1e-3 * one.diameter_mm,
                "clearance": 1e-6 * one.clearance_um,
                "viscosity": viscosity,
                "cavitation": one.cavitation,
                "seals": one.seals,
                "leakage": one.leakage,
                "groove": one.groove,
            },
        )
        with called(at, ENTRIES):
            part.made()
        parts[place] = part
    return parts
