"""Squeeze film dampers of a study, as calls of the library."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehlcontact.cli.study.machine import called, support_field
from ehlcontact.cli.study.parts import Part
from ehlcontact.errors import InputError
from reduced_models import SqueezeFilmDamper
from reduced_models.bearing.catalogue import catalogue_row

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

SHORT = 0.5  # length over diameter of an open film, or of half a grooved one, up to which it is a short bearing
OF_THE_BEARING = 0.95  # of its outside diameter as by the pitch circle, which is known within that
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
        if (outside := _outside(study, place)) is not None and one.diameter_mm < OF_THE_BEARING * outside:
            allowed = (
                f"the outside diameter of the bearing in the damper's journal, some {outside:.2g} mm, or more"
            )
            raise InputError(f"{at}diameter_mm", one.diameter_mm, allowed)
        parts[place] = part
    return parts


def _outside(study: Study, place: int) -> float | None:
    """Outside diameter of the bearing at a support [mm]: the pitch circle is in the middle; None: not known."""
    name = study.support[place].bearing
    row = None if name is None else catalogue_row(name)[1]
    return None if row is None or row.bore is None else 1e3 * (2.0 * row.pitch_diameter - row.bore)


def too_long(study: Study) -> list[str]:
    """Open dampers that are too long for a short bearing, in words, with the error of it."""
    said = []
    for one in study.damper:
        land = one.length_mm / (2.0 if one.groove else 1.0)
        if one.seals == "open" and land > SHORT * one.diameter_mm:
            ratio = land / one.diameter_mm
            name = study.names[study.index(one.support, "damper.support")]
            said.append(
                f"the open film of the damper of {name} is {ratio:.3g} diameters long, beyond {SHORT:g}, up to"
                f" which a short bearing holds: its force is {ratio**2 / 3.0:.3g} times that with sealed ends"
            )
    return said
