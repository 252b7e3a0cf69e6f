"""Squeeze film dampers inside a rotor: variables, and the C text of one."""

from __future__ import annotations

from fmu.bearing.variables import FORCES, MOTIONS, OUTSIDE, RATES
from fmu.c_headers import c_double
from fmu.spec import ModelSpec, VariableList
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.rotor.squeeze_film_damper import DamperStructure, SqueezeFilmDamper

SOURCES, HEADERS = ("damper.c", "damper_support.c"), ("damper.h",)
ECCENTRICITY = "eccentricity_ratio"
SIZE = 3  # DAMPER_SIZE and DAMPER_WORK of ``damper.h``
WORK = SIZE + 8
THIN = "its film is thinner than a hundredth of its clearance;"  # and stays that of such a gap


def damper_spec(damper: SqueezeFilmDamper) -> ModelSpec:
    """Variables of a damper, as the FMU of a rotor has them."""
    made = VariableList()
    motions = (*PLANAR, *(RATES[name] for name in PLANAR))
    for name in PLANAR:
        made.add(name, "input", "continuous", f"Displacement along {name}", unit="m", start=0.0)
    for name in PLANAR:
        made.add(RATES[name], "input", "continuous", f"Velocity along {name}", unit="m/s", start=0.0)
    for name in PLANAR:
        text, nominal = f"Force of film and spring on the journal along {name}", MOTIONS[name].force_nominal
        made.add(FORCES[name], "output", "continuous", text, unit="N", nominal=nominal, depends=motions)
    text = "Displacement of the journal over the clearance: 1 in contact, where the FMU stops"
    made.add(ECCENTRICITY, "output", "continuous", text, unit="1", nominal=1.0, depends=PLANAR)
    text = "True where the film is thinner than a hundredth of the clearance, of which gap it stays"
    made.add(OUTSIDE, "output", "discrete", text, type="Boolean", depends=PLANAR)
    return ModelSpec(
        name="SqueezeFilmDamper",
        description=f"Squeeze film damper {damper.name}".rstrip(),
        sources=SOURCES,
        headers=HEADERS,
        variables=tuple(made.variables),
        notes=(("Film", "; ".join(damper._summary_lines())),),
        indicators=(("contact", ECCENTRICITY),),
    )


def damper_text(damper: SqueezeFilmDamper) -> str:
    """The damper in C, LAW_NAME for its name."""
    own = damper.structure
    values = ", ".join(c_double(getattr(own, field[0])) for field in DamperStructure._fields_)
    return (
        f"static const Damper LAW_NAME_film = {{{values}}};\n"
        "static const Support LAW_NAME = {&LAW_NAME_film, DAMPER_SUPPORT};\n"
    )
