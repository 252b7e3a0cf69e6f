"""One HTML page that holds the whole study, figures included."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from math import degrees, pi
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.cli.page import write_page
from ehlcontact.cli.study.answer import NAMES
from ehlcontact.cli.study.differences import RotorFindings
from ehlcontact.cli.study.headline import (
    ball_words,
    calm,
    conditions_of,
    in_sections,
    limits,
    operating_line,
    verdict,
)
from ehlcontact.cli.study.machine import disc_of
from ehlcontact.cli.study.oil_and_heat import columns, skf_words
from ehlcontact.cli.study.points.folder import versions
from ehlcontact.cli.study.reduction import (
    CONTACT_BAND,
    CONTACTS,
    DRAWN,
    DRY,
    FULL,
    LOOKS,
    MEMORY,
    RECORDS,
    ROTOR_BAND,
    UNDAMPED,
)
from ehlcontact.cli.study.results import ContactFindings, Findings
from ehlcontact.cli.study.shared_entries import supply_and_heat, supply_words
from ehlcontact.cli.study.stages import STAGES
from ehlcontact.film.over_time import film_wave
from ehlcontact.film.pictures import coloured_fringes, instants
from ehlcontact.results.contact_map import convergence, film_picture
from ehlcontact.results.picture import Picture, Slides
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.kinematics import RPM_TO_HZ
from reduced_models.bearing.oil_and_heat import OilAndHeat
from reduced_models.bearing.picture import conditions_coefficients, conditions_films, from_load, over_frequency
from reduced_models.fitting.pictures import histories, impedance, loops
from reduced_models.margins.samples import words_of
from reduced_models.rotor import model_pictures as rotor
from reduced_models.rotor.compare_bearing_models import USUAL_DAMPING
from reduced_models.rotor.events import LOST
from reduced_models.rotor.settling import MOST_REVOLUTIONS
from reduced_models.rotor.support_state import SupportState

# Files of a study, and what to say of them; STAGE is what computed one.
FILES = {
    "results.json": "every number of this page, and more, with all digits",
    "study.toml": "the study itself; the same command with it resumes, or makes this page again",
    "machine.fmu": "FMU of the machine, as [export] has it",
    "machine.py": "the same rotor or bearing, made by calls of the library",
    "machine_ross.py": "the rotor in ROSS, on tables of K and C of its bearings",
    "contact.fmu": "FMU of the cubic element fitted in the rotor's band",
    "contact_film.fmu": "FMU of the element with a film memory",
    "elements/*.json": "an element in SI units, for ehlcontact export and for ehlcontact.read",
    "on_bearings_*.h5": "motion of the rotor on whole bearings",
    "periodic.csv": "periodic answers in the order of their branch: speed, motions, stability",
    "periodic.h5": "the branch itself, every period: ehlcontact.read",
    "*.h5": "STAGE: fields or histories",
    "samples.csv": "inputs and numbers of all samples, and why some have none",
    "samples": "the samples in batches",
    "store": "what was computed, by its inputs: a run resumes from it, and nothing else needs it",
}
MEANINGS = {
    FULL: "film solved in every contact and step: what the others are judged by",
    ROTOR_BAND[0]: "cubic spring and damper fitted at the frequency of the rotor's speed",
    MEMORY: "element with the memory of the film, for all frequencies",
    CONTACT_BAND[0]: "cubic spring and damper fitted near the contact's own frequency",
    UNDAMPED: "cubic spring without the damping of the film",
    DRY: "spring of the steel alone, without a film",
}
ALIKE = 1e-6  # relative difference of two bearings that are shown once
STAGE_TITLES = {stage.name: stage.title for stage in STAGES}
TITLES = RECORDS | {MEMORY: "all bands, with film memory"}


def write_report(found: Findings, path: Path) -> Path:
    """Draw the figures and write the page."""
    return write_page(
        path,
        "report.html.j2",
        drawings(found),
        found=found,
        operating_line=operating_line(found),
        limits=limits(found),
        calm=calm(found),
        verdict="" if found.rotors is None else verdict(found.rotors),
        story=in_sections(found),
        ball_words="" if found.contact is None else ball_words(found),
        files=files_beside(path.parent),
        titles=TITLES,
        ways=ways_of_coupling(() if found.contact is None else found.contact.fmus),
        versions=versions(),
        words_of=words_of,
        names=CONTACTS,
        meanings=MEANINGS,
        lost=LOST,
        most_revolutions=MOST_REVOLUTIONS,
        bearings=NAMES,
        usual_damping=USUAL_DAMPING,
        **of_machine(found),
        **conditions(found),
    )


def of_machine(found: Findings) -> dict[str, Any]:
    """What the section of the machine needs beside its state."""
    five = not isinstance(found.machine, str) and any(
        len(one.stiffness) == len(FIVE) for one in found.machine.supports
    )
    axes = [(1, "y"), (0, "x"), *([(2, "z")] if five else [])]
    shown = {"bearings": shown_bearings(found), "coefficients": shown_coefficients(found)}
    more = {"five": five, "axes": axes, "degree": degrees(1.0), "balls": balls, "passages": passages}
    return more | {"shown": shown, "eccentricity": eccentricity_of(found)}


def shown_bearings(found: Findings) -> list[tuple[str, BearingState]]:
    """Names and state of every bearing whose balls carry other loads than those of the ones before."""
    if isinstance(found.machine, str):
        return []
    rows = []
    for support in found.machine.supports:
        for j, (_, state) in enumerate(support.bearings):
            number = f", bearing {j + 1}" if len(support.bearings) > 1 else ""
            rows.append((f"{support.label or 'the bearing'}{number}", state))
    return _once(rows, lambda state: state.force)


def shown_coefficients(found: Findings) -> list[tuple[str, BearingCoefficients]]:
    """Names, and K and C over frequency, of every support that has others than the ones before."""
    return _once(list(found.over_frequency.items()), lambda one: one.stiffness)


def _once(rows: list[tuple[str, Any]], values: Callable[[Any], Any]) -> list[tuple[str, Any]]:
    """Rows without repetition, their names joined where the values are alike."""
    kept: list[tuple[str, Any]] = []
    for name, one in rows:
        for k, (names, other) in enumerate(kept):
            if values(other).shape == values(one).shape and np.allclose(values(other), values(one), rtol=ALIKE):
                kept[k] = f"{names} and {name}", other
                break
        else:
            kept.append((name, one))
    return kept


def eccentricity_of(found: Findings) -> float:
    """Of the unbalance of the first disc [m]; 0 without one."""
    if found.study.shaft is None or not found.study.disc:
        return 0.0
    disc = disc_of(found.study, 0)
    return disc.unbalance / disc.mass if disc.mass > 0.0 else 0.0


def balls(state: BearingState) -> list[tuple[Any, ...]]:
    """Of every ball: place from the load [degrees], forces [N]; contact angles [degrees], films [m] or None."""
    none = [None] * len(state.angles)
    angles = none if state.contact_angles is None else np.degrees(state.contact_angles).tolist()
    films = none if state.h_min is None else state.h_min.tolist()
    return list(zip(from_load(state).tolist(), state.force.tolist(), angles, films, strict=True))


def passages(support: SupportState) -> list[float]:
    """Frequencies at which balls pass outer and inner race [Hz], at the contact angles of the load."""
    bearing, state = support.bearings[0]
    found = (state.orders or bearing.orders).at(support.state.speed_rpm)
    return [found.bpfo, found.bpfi]


def conditions(found: Findings) -> dict[str, Any]:
    """Tables and words of the bearings with heat and with a layer of oil; empty where they are not asked for."""
    if not found.oil_and_heat:
        return {}
    supply, _ = supply_and_heat(found.study.operation, "operation", found.study.lubricant)
    rows = [
        (of, one, *((None, "") if isinstance(one, str) else (columns(one), skf_words(one))))
        for of, one in conditions_of(found)
    ]
    return {"conditions": rows, "supply_words": supply_words(supply)}


def files_beside(folder: Path) -> dict[str, str]:
    """What lies in the folder of a study, in the order of `FILES`, and what each file holds."""
    found = {}
    for pattern, text in FILES.items():
        for path in sorted(folder.glob(pattern)):
            name = path.relative_to(folder).as_posix()
            if name not in found and not name.endswith(".partial.h5"):
                found[name] = text.replace("STAGE", STAGE_TITLES.get(path.stem, path.stem))
    return found


def ways_of_coupling(fmus: Iterable[Mapping[str, Any]]) -> list[tuple[str, list[str], str]]:
    """Each way of coupling in a co-simulation, its largest step in each FMU, and why."""
    told = [fmu["steps"] for fmu in fmus]
    rows = []
    for way in dict.fromkeys(way for steps in told for way in steps):
        found = [steps.get(way, {"step": "-", "why": ""}) for steps in told]
        whys = dict.fromkeys(part for entry in found for part in entry["why"].split("; ") if part)  # each once
        rows.append((way, [entry["step"] for entry in found], "; ".join(whys)))
    return rows


def drawings(found: Findings) -> dict[str, Callable[[], Picture | Slides]]:
    """The pictures by name, each described where the page needs it."""
    pictures = _of_bearings(found)
    if found.contact is not None:
        pictures |= _of_contact(found.contact)
    if found.rotors is not None:
        pictures |= _of_rotor(found.rotors, found.study.jeffcott.unbalance / found.study.jeffcott.disc_mass)
    return pictures


def _of_contact(found: ContactFindings) -> dict[str, Callable[[], Picture | Slides]]:
    reduction, steady, runs = found.reduction, found.steady, found.simulations
    cubic = {name: reduction.fits[name, "cubic"] for name in RECORDS if (name, "cubic") in reduction.fits}
    memory, kicked = reduction.memory_element, found.at_kicked_mode
    frequencies = (2.0 * pi * found.study.rotor_hz, *(() if kicked is None else (kicked["omega"],)))
    return {
        "film_maps": lambda: film_picture(steady)[0],
        "midplane": lambda: film_picture(steady)[1],
        "interferogram": lambda: coloured_fringes(steady),
        "convergence": lambda: convergence(steady),
        "free": lambda: histories(runs["free"], cubic.get("free")),
        "film_wave": lambda: Picture(film_wave(runs["harmonic"]).panels(), columns=1, heights=(340.0,)),
        "instants": lambda: instants(runs["harmonic"]),
        "loops": lambda: loops(runs, cubic, RECORDS),
        "impedance": lambda: impedance(reduction.impedance, memory, list(cubic.values()), frequencies),
    }


def _of_rotor(rotors: RotorFindings, eccentricity: float) -> dict[str, Callable[[], Picture | Slides]]:
    turning, how = {FULL: rotors.unbalance.full, **rotors.unbalance.reduced}, rotors.unbalance.settling[FULL]
    few = {name: turning[name] for name in DRAWN if name in turning}
    decays = rotors.decay.runs, rotors.decay.decrements
    return {
        "orbit": lambda: rotor.settled_orbits(few, how, LOOKS, CONTACTS),
        "response": lambda: rotor.time_response(turning, FULL, DRAWN[:2], how, LOOKS, CONTACTS),
        "spectrum": lambda: rotor.settled_spectra(few, how, LOOKS, CONTACTS),
        "decay": lambda: rotor.decay(*decays, DRAWN, LOOKS, CONTACTS),
        "bode": lambda: rotor.bode(rotors.resonances, LOOKS, CONTACTS, eccentricity),
    }


def _of_bearings(found: Findings) -> dict[str, Callable[[], Picture | Slides]]:
    pictures: dict[str, Callable[[], Picture | Slides]] = {}
    if found.uncertainty is not None and found.uncertainty.drawn:
        pictures["uncertainty"] = found.uncertainty.picture
    if (whole := found.whole) is not None:
        pictures |= {
            "whole_orbits": lambda: rotor.orbits(whole, NAMES),
            "whole_spectra": lambda: rotor.spectra(whole, NAMES),
            "whole_coefficients": lambda: rotor.coefficients(whole, NAMES),
            "whole_response": lambda: rotor.response(whole, NAMES, eccentricity_of(found)),
        }
        if whole.over_speed:
            pictures["whole_speeds"] = lambda: rotor.speeds(whole)
    if not isinstance(machine := found.machine, str):
        pictures["machine"] = machine.picture
        for k, (_, state) in enumerate(shown_bearings(found)):
            pictures[f"balls_{k + 1}"] = state.picture
        if machine.budget is not None and machine.budget.parts:
            pictures["damping"] = machine.budget.picture
        if machine.modes and (response := machine.labelled_response) is not None:
            pictures["response_to_unbalance"] = response.picture
    if found.periodic is not None:
        pictures["periodic"] = found.periodic.picture
    for k, (_, small) in enumerate(shown_coefficients(found)):
        pictures[f"frequency_{k + 1}"] = partial(_over_frequency, small)
    for k, (_, one) in enumerate(conditions_of(found)):
        if isinstance(one, OilAndHeat):
            pictures[f"conditions_films_{k + 1}"] = partial(conditions_films, one)
            pictures[f"conditions_coefficients_{k + 1}"] = partial(conditions_coefficients, one)
    for k, defect in enumerate(found.defects):
        pictures[f"defect_signal{k + 1 if k else ''}"] = defect.picture
    return pictures


def _over_frequency(small: BearingCoefficients) -> Picture:
    return Picture(over_frequency(small, (), small.speed_rpm * RPM_TO_HZ))
