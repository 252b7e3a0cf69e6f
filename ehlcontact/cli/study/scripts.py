"""The machine of a study in Python: the rotor from the library, and its model in ROSS, as files to run."""

from __future__ import annotations

import re
from collections.abc import Sequence
from keyword import iskeyword
from textwrap import indent
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehlcontact.cli.study.loads import load_alone, ring_load
from ehlcontact.cli.study.machine import (
    bearing_of,
    bearing_part,
    disc_of,
    disc_part,
    places_of,
    set_part,
    shaft_of,
    shaft_part,
    support_parts,
)
from ehlcontact.cli.study.parts import call_text, list_text, numbers_text, python_of
from ehlcontact.cli.study.periodic import settings_of
from ehlcontact.cli.study.shared_entries import tilt_of
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet
from reduced_models.rotor.assembly import shaft_stations
from reduced_models.rotor.machine_state import MODES

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

TABLE = 0.2, 2.0, 10  # speeds of tables for ROSS over that of the study: first, last, number
ROUNDING = 1e-9  # of the largest component of a load
TAKEN = {
    "oil", "shaft", "discs", "supports", "rotor", "mode", "state", "np", "ross", "steel", "lengths", "speeds",
    "elements", "masses", "modal", "branch",
}  # fmt: skip
ROSS = ("import numpy as np", "import ross", "")


class _Bearings(NamedTuple):
    """Bearings and pairs of a study, and the lines that make them."""

    lines: list[str]
    variables: list[str]  # of the carriers
    carriers: list[BallBearing | BearingSet]
    names: dict[int, str]  # of oil, bearings and carriers, by the id of the object
    kinds: set[str]  # of the library, that the lines need
    bearings: list[BallBearing]  # whose ids stand among the names


def python_text(study: Study) -> str:
    """The rotor of a machine, or a bearing alone, by calls of the library; run as a program it prints answers.

    Raises
    ------
    InputError
        What is no machine.
    """
    made = _bearings(study)
    lines, names, kinds = list(made.lines), made.names, set(made.kinds)
    if study.shaft is None:
        name = made.variables[0]
        arguments = [python_of(load_alone(study)), f"speed_rpm={python_of(study.speed_rpm)}"]
        if (tilt := tilt_of(study.operation)) is not None:
            arguments.append(f"tilt={python_of(tilt)}")
        end = [
            f"state = {call_text(f'{name}.equilibrium', arguments)}",
            "",
            'if __name__ == "__main__":',
            "    print(state)",
        ]
        return _file(study, "bearing of study.toml, from the library", kinds, [*lines, *end])
    lines.append(f"shaft = {shaft_part(study).text()}")
    discs = [disc_part(study, k).text() for k in range(len(study.disc))]
    supports = [part.text(names) for part in support_parts(study, made.carriers)]
    lines += [f"discs = {list_text(discs)}", f"supports = {list_text(supports)}"]
    lines += ["rotor = rotor_on_bearings(shaft, discs=discs, supports=supports)", ""]
    lines += [
        'if __name__ == "__main__":',
        f"    for mode in linearise(rotor, {python_of(study.speed_rpm)}).modes({MODES}):",
        '        print(f"{mode.hz:8.1f} Hz, damping ratio {mode.damping_ratio:.2g}")',
    ]
    kinds |= {"Shaft", "Support", "linearise", "rotor_on_bearings"} | ({"Disc"} if discs else set())
    kinds |= {"SqueezeFilmDamper"} if study.damper else set()
    if study.periodic is not None:
        arguments = ["rotor", *(f"{name}={python_of(value)}" for name, value in settings_of(study).items())]
        lines += indent(f"branch = {call_text('periodic', arguments)}", "    ").split("\n")
        lines.append(f"    print(branch{'.with_multipliers()' if study.periodic.stability else ''})")
        kinds.add("periodic")
    return _file(study, "rotor of study.toml, from the library", kinds, lines)


def require_ross(study: Study) -> None:
    """Raise `InputError` for a machine that has no model in ROSS."""
    if study.shaft is None:
        raise InputError("export.ross", True, "left out without [shaft]: ROSS has rotors")
    if study.damper:
        raise InputError("export.ross", True, "left out with [[damper]]: no linear bearing is such a film")
    if study.shaft.stiffness is not None:
        allowed = "left out where shaft.stiffness is given: a shaft of ROSS has a diameter and a mass"
        raise InputError("export.ross", True, allowed)


def ross_text(study: Study) -> str:
    """The machine in ROSS, on tables of K and C of its bearings; run as a program it prints natural frequencies.

    Nodes are those of the library's rotor, housings behind them.

    Raises
    ------
    InputError
        As `require_ross`; what is no machine.
    """
    require_ross(study)
    made = _bearings(study)
    lines = list(made.lines)
    shaft, discs = shaft_of(study), [disc_of(study, k) for k in range(len(study.disc))]
    places = places_of(study)
    stations = shaft_stations(shaft, [*(disc.position for disc in discs), *places])
    nodes = {place: int(np.argmin(np.abs(stations - place))) for place in (*places, *(d.position for d in discs))}
    steel = {"rho": shaft.density, "E": shaft.youngs_modulus, "Poisson": shaft.poisson_ratio}
    section: dict[str, Any] = {"idl": float(shaft.bore[0]), "odl": float(shaft.diameter[0])}
    if shaft.damping_time:
        section["beta"] = shaft.damping_time
    first, last, count = TABLE
    lines += [
        f'steel = ross.Material("steel", {_keywords(steel)})',
        f"lengths = {numbers_text(np.diff(stations).tolist())}",
        f"shaft = [ross.ShaftElement(L=length, {_keywords(section)}, material=steel) for length in lengths]",
        f"discs = {list_text([_disc(disc, nodes[disc.position]) for disc in discs])}",
        f"speeds = {python_of(study.speed_rpm)} * np.linspace({first}, {last}, {count})  # rev/min, of the tables",
    ]
    elements, masses = [], []
    for disc in discs:
        if disc.damping:
            ground: dict[str, Any] = {"n": nodes[disc.position], "kxx": 0.0, "cxx": disc.damping}
            elements.append(f"ross.BearingElement({_keywords(ground)})")
    for k, one in enumerate(study.support):
        node = nodes[places[k]]
        options: dict[str, Any] = {"load": support_load(study, k)}
        if one.spring is not None:
            options |= {"kzz": 0.0, "czz": 0.0}  # its outer ring slides
        if one.journal_mass:
            masses.append(f"ross.PointMass(n={node}, m={python_of(one.journal_mass)})")
        if one.housing_mass is not None:
            housing = len(stations) + sum("housing" in text for text in masses)
            options["n_link"] = housing
            masses.append(f'ross.PointMass(n={housing}, m={python_of(one.housing_mass)}, tag="housing {k + 1}")')
            ground = {"n": housing, "kxx": one.housing_stiffness, "cxx": one.housing_damping}
            ground |= {"kzz": one.housing_stiffness, "czz": one.housing_damping}
            elements.append(f"ross.BearingElement({_keywords(ground)})")
        arguments = [
            str(node),
            "speeds_rpm=speeds",
            *(f"{key}={python_of(value)}" for key, value in options.items()),
        ]
        elements.append(call_text(f"{made.variables[k]}.to_ross", arguments))
    lines += [f"elements = {list_text(elements)}", *([f"masses = {list_text(masses)}"] if masses else [])]
    behind = ", point_mass_elements=masses" if masses else ""
    lines += [
        f"rotor = ross.Rotor(shaft, discs, elements{behind})",
        "",
        'if __name__ == "__main__":',
        f"    modal = rotor.run_modal({python_of(study.speed_rpm)} * np.pi / 30.0)",
        "    print(modal.wn / (2.0 * np.pi))  # Hz",
    ]
    lines.insert(
        0, "# Bearings of ROSS resist no tilt: modes that bend the shaft come out lower than those of the library."
    )
    return _file(study, "study.toml in ROSS (pip install 'ehlcontact[ross]')", made.kinds, lines, ROSS)


def _bearings(study: Study) -> _Bearings:
    made = _Bearings([], variables_of(study.names), [], {}, {"BallBearing"}, [])
    if study.oil is not None:
        made.lines.append(f"oil = {study.oil.part.text()}")
        made.names[id(study.lubricant)] = "oil"
    for k, name in enumerate(made.variables):
        bearing = bearing_of(study, k)
        pair = set_part(study, k, bearing)
        own = name if pair is None else f"{name}_each"
        carrier = bearing if pair is None else pair.made()
        made.lines.append(f"{own} = {bearing_part(study, k).text(made.names)}")
        made.names[id(bearing)] = own
        if pair is not None:
            made.lines.append(f"{name} = {pair.text(made.names)}")
            made.names[id(carrier)] = name
            made.kinds.add("BearingSet")
        made.bearings.append(bearing)
        made.carriers.append(carrier)
    return made


def variables_of(names: Sequence[str]) -> list[str]:
    """Names of supports as variables of Python, drive_end of "drive end"; by number where none."""
    found: list[str] = []
    for k, name in enumerate(names):
        word = re.sub(r"\W+", "_", name.strip().lower()).strip("_")
        usable = word.isidentifier() and word.isascii() and not iskeyword(word) and word not in (*TAKEN, *found)
        found.append(word if usable else f"bearing_{k + 1}")
    return found


def support_load(study: Study, k: int) -> list[float]:
    """Load on a support, with 0 for what is rounding."""
    load = ring_load(study, k)
    most = float(np.abs(load).max())
    return [float(f"{value:.6g}") if abs(value) > ROUNDING * most else 0.0 for value in load.tolist()]


def _keywords(values: dict[str, Any]) -> str:
    return ", ".join(f"{name}={python_of(value)}" for name, value in values.items())


def _disc(disc: Any, node: int) -> str:
    turns = {"m": disc.mass, "Id": disc.diametral_inertia, "Ip": disc.polar_inertia}
    return f"ross.DiskElement(n={node}, {_keywords(turns)})"


def _file(study: Study, what: str, kinds: set[str], lines: Sequence[str], others: Sequence[str] = ()) -> str:
    """The text of a script: what it is, imports, lines."""
    title = study.title.replace("\\", "/").replace('"', "'")
    words = sorted(kinds, key=lambda word: (word.islower(), word))
    imports = ["from ehlcontact import Lubricant"] if study.oil is not None else []
    imports.append(f"from reduced_models import {', '.join(words)}")
    body = "\n".join([f'"""{title}: {what}."""', "", *others, *imports, "", *lines])
    return f"{body}\n"
