"""Supports inside a rotor: tables of each bearing and damper, and a C file for each contact that differs.

The law of a contact is the model of its own FMU: sources and headers, one after the other, in one file whose
functions carry the name of the law, so that laws of different kinds and tables stand side by side.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fmu import sources as fmu_sources
from fmu.bearing.model import BearingModel
from fmu.bearing.tables import bearing_table, state_size, work_size
from fmu.bearing.variables import PARAMETERS
from fmu.c_headers import c_headers, c_table
from fmu.contact_variables import Element, Film
from fmu.rotor import dampers
from fmu.rotor.model import RotorModel
from fmu.spec import ModelSpec, Variable
from reduced_models.rotor.squeeze_film_damper import SqueezeFilmDamper

# Outputs that the rotor has.
SHOWN = "force", "eccentricity_", "moment_", "largest_", "smallest_", "rolling_", "capacitance", "outside_"
HIDDEN = "outside_approach", "outside_rate", "outside_force"  # of a contact, which the rotor does not tell apart
NUMBERS_OF_DUAL = 2
CONTACT_WORK = 4  # numbers of a step of a contact beside those of its model: enum STEP_... of contact_law.c

_CORE = ("core.c", "core_step.c")  # which the rotor has once
_FUNCTION = re.compile(
    r"^(?!static\b|typedef\b|return\b|else\b)[A-Za-z_][\w *]*?\b(\w+)\([^;]*\)\s*\{", re.MULTILINE
)
_INCLUDE = re.compile(r'^#include "([^"]+)".*$', re.MULTILINE)


def is_bearing(spec: ModelSpec) -> bool:
    """Whether it is the specification of a ball bearing, or of a contact."""
    return "N_DIRECTIONS" in spec.macros


def shown(spec: ModelSpec) -> list[Variable]:
    """Outputs of a support that the rotor has."""
    return [
        one for one in spec.outputs if one.name.startswith(SHOWN) and (is_bearing(spec) or one.name not in HIDDEN)
    ]


def tunable(spec: ModelSpec) -> list[Variable]:
    """Parameters of a support that the rotor has."""
    return [one for one in spec.variables if is_bearing(spec) and one.name in PARAMETERS]


def law_size(spec: ModelSpec) -> int:
    """How many numbers a contact is kept in: a `Model` of ``model.h``."""
    return 1 + len(spec.variables) + len(spec.inputs) + max(1, len(spec.indicators)) + int(spec.macros["N_CACHE"])


@dataclass(frozen=True, slots=True)
class Law:
    """A support inside: numbers of its state and of a step, and its C text, LAW_NAME for its name."""

    size: int
    work: int
    text: str


def contact_law(element: Element, spec: ModelSpec) -> Law:
    """The law of a contact, a file of its own."""
    tangents = ("step_stiffness", "step_damping") if isinstance(element, Film) else ("stiffness", "damping")
    macros = {"LAW_STIFFNESS": f"VR_{tangents[0]}", "LAW_DAMPING": f"VR_{tangents[1]}"}
    size = law_size(spec)
    return Law(size, CONTACT_WORK + size, law_file(spec, "LAW_NAME", "contact_law.c", macros))


def bearing_law(model: BearingModel, spec: ModelSpec) -> Law:
    """A bearing: its tables, and the functions of ``bearing_support.h``."""
    size = state_size(model)
    work = 1 + work_size(model) + state_size(model) + 2 * len(spec.states) * NUMBERS_OF_DUAL
    counts = ", ".join(map(str, (len(model.directions), len(spec.states), len(spec.indicators), size, work)))
    table = bearing_table(model, "LAW_NAME_table")
    return Law(
        size, work, f"{table}static const Support LAW_NAME = {{&LAW_NAME_table, {counts}, BEARING_SUPPORT}};\n"
    )


def damper_law(damper: SqueezeFilmDamper) -> Law:
    """A damper: its numbers, and the functions of ``damper.h``."""
    return Law(dampers.SIZE, dampers.WORK, dampers.damper_text(damper))


def laws_of(model: RotorModel, specs: Sequence[ModelSpec]) -> list[Law]:
    """The law of each support inside."""
    bearings = iter(model.bearings)
    found = []
    for station, spec in zip(model.inside, specs, strict=True):
        if station.is_contact:
            found.append(contact_law(station.mount.contact, spec))
        elif station.is_damper:
            found.append(damper_law(station.mount.damper))
        else:
            found.append(bearing_law(next(bearings), spec))
    return found


def law_names(model: RotorModel, laws: Sequence[Law]) -> tuple[list[str], dict[str, str]]:
    """Name of the law of each support, and text by name of those that differ."""
    texts: dict[str, str] = {}
    names = []
    for station, law in zip(model.inside, laws, strict=True):
        count = sum(name.startswith(station.kind) for name in texts.values())
        names.append(texts.setdefault(law.text, f"{station.kind}_law_{count + 1}"))
    return names, {name: text.replace("LAW_NAME", name) for text, name in texts.items()}


def law_file(
    spec: ModelSpec, name: str, ending: str, macros: dict[str, str], more: dict[str, str] | None = None
) -> str:
    """The model of an FMU as one C file that ends with the C source `ending`.

    `name` is what its functions and its table of functions are called by. What its sources have each for itself
    must differ in name. `more` are headers that `ending` needs.
    """
    starts = np.array([0.0 if v.start is None else float(v.start) for v in spec.variables])
    paths = fmu_sources.source_paths()
    files = {name: path.read_text(encoding="ascii") for name, path in paths.items() if path.suffix in (".c", ".h")}
    tables = {"law_values.h": c_table("law_values", starts) + "\n"} | (more or {})
    files |= c_headers(spec, "") | tables
    sources = [source for source in spec.sources if source not in _CORE]
    functions = sorted({found for source in sources for found in _FUNCTION.findall(files[source])})
    defined = {
        "LAW": name,
        "LAW_SIZE": str(law_size(spec)),
        **macros,
        **{function: f"{name}_{function}" for function in functions},
    }
    root = "\n".join(f'#include "{part}"' for part in (*sources, *tables, ending))
    head = [
        f"/* Generated by ehlcontact: {spec.description}; inside a rotor as in its own FMU. */",
        *(f"#define {macro} {text}" for macro, text in defined.items()),
    ]
    return "\n".join([*head, "", _joined(root, files, set()), ""])


def _joined(text: str, files: dict[str, str], done: set[str]) -> str:
    """A text with the files that it includes in their places, each once."""

    def take(match: re.Match[str]) -> str:
        name = match.group(1)
        if name in done:
            return ""
        done.add(name)
        return _joined(files.get(name, ""), files, done)  # a dry bearing has no films, and does not ask for them

    return _INCLUDE.sub(take, text)
