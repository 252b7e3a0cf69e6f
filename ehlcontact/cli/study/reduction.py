"""From the records of a study to elements: fits and element files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import Scales
from ehlcontact.results import Response
from ehlcontact.results.picture import BLUE, GREEN, GREY, ORANGE, PURPLE, RED
from ehlcontact.store import save
from ehlcontact.transient.motion import HarmonicLoad
from ehlcontact.transient.result import SimulationResult
from reduced_models import ContactRecord, SpringContact, fit, fit_memory
from reduced_models.fitting.memory_fit import OMEGAS
from reduced_models.fitting.result import FitResult, MemoryFit
from reduced_models.rotor.baselines import dry_contact, without_damper

RECORDS = {"free": "free vibration", "harmonic": "harmonic, contact band", "rotor_band": "harmonic, rotor band"}
MODELS: tuple[Literal["linear", "cubic"], ...] = ("linear", "cubic")
MEMORY = "memory"  # the film-memory element, fitted to all records and the impedance together
ROTOR_BAND = ("rotor_band", "cubic")  # the element of the FMU and of the rotor: fitted at its load and frequency
CONTACT_BAND = ("harmonic", "cubic")  # fitted in the contact's own band, not in the rotor's
FULL, UNDAMPED, DRY = "full", "undamped", "dry"  # the whole film; and what there is without film, or its damper
# What a rotor runs on, in words.
CONTACTS = {
    FULL: "full film",
    ROTOR_BAND[0]: "cubic of the rotor's band",
    MEMORY: "film memory",
    CONTACT_BAND[0]: "cubic of the contact's band",
    UNDAMPED: "cubic without damper",
    DRY: "dry Hertz contact",
}
LOOKS = {  # colours and dashes in pictures
    FULL: (BLUE, "-"),
    ROTOR_BAND[0]: (RED, "--"),
    MEMORY: (GREEN, "--"),
    CONTACT_BAND[0]: (ORANGE, "-."),
    UNDAMPED: (PURPLE, ":"),
    DRY: (GREY, "-."),
}
DRAWN = (FULL, ROTOR_BAND[0], DRY)  # where all would be too many


@dataclass(frozen=True)
class Reduction:
    """Fits in SI by (record, model), and why some pairs have none; and the one element for all records."""

    fits: Mapping[tuple[str, str], FitResult]
    refused: Mapping[tuple[str, str], str]
    memory: MemoryFit | str  # or why there is none
    impedance: Response
    scales: Scales

    def element(self, record: str, model: str) -> Any:
        """The element, None where the fit was refused."""
        found = self.fits.get((record, model))
        return None if found is None else found.element

    @property
    def memory_element(self) -> Any:
        """The film-memory element, None where the fit was refused."""
        return None if isinstance(self.memory, str) else self.memory.element

    @property
    def chosen(self) -> SpringContact:
        """SI element of the FMU and the rotor.

        Raises
        ------
        InputError
            It could not be fitted.
        """
        element = self.element(*ROTOR_BAND)
        if element is None:
            raise InputError(
                "rotor_band fit", self.refused[ROTOR_BAND], "a cubic element; raise contact.rotor_band.amplitude"
            )
        return element

    @property
    def rotor_elements(self) -> dict[str, Any]:
        """SI elements that the rotor runs on: the chosen one, two others where they were fitted, and baselines."""
        others = {MEMORY: self.memory_element, CONTACT_BAND[0]: self.element(*CONTACT_BAND)}
        fitted = {ROTOR_BAND[0]: self.chosen} | {
            name: found for name, found in others.items() if found is not None
        }
        return fitted | {UNDAMPED: without_damper(self.chosen), DRY: dry_contact(self.scales)}


def reduce_records(
    simulations: Mapping[str, SimulationResult],
    response: Response,
    scales: Scales,
    known: Mapping[str, Any],
) -> Reduction:
    """Fit every model to every record; a fit that makes no contact is kept as the reason why.

    The film memory is fitted to the impedance too. Elements carry what is `known` in their ``source``: what is
    assumed of the study's oil, film and roughness, and the bearing of the contact, which the records do not have.
    """
    fits: dict[tuple[str, str], FitResult] = {}
    refused: dict[tuple[str, str], str] = {}
    records = []
    for record, simulation in simulations.items():
        window = _window(simulation)
        records.append(ContactRecord.from_result(simulation))
        for model in MODELS:
            try:
                fits[record, model] = _with_source(fit(records[-1], model, window), known)
            except InputError as error:
                refused[record, model] = str(error)
    memory: MemoryFit | str
    try:
        memory = _with_source(fit_memory(_at_memory_frequencies(response), records), known)
    except (InputError, ConvergenceError) as error:
        memory = str(error)
    return Reduction(fits, refused, memory, response, scales)


def _at_memory_frequencies(response: Response) -> Response:
    """At the frequencies that a film memory is fitted at: more at the slow end would outweigh the others."""
    Omega = response.dimensionless.omega
    return response[np.isclose(Omega[:, None], OMEGAS, rtol=1e-9, atol=0.0).any(axis=1)]  # but for rounding


def contact_text(study: Study) -> str:
    """Bearing, race, load, speed and oil of the contact in one line."""
    oil, contact = study.oil, study.contact
    assert oil is not None and contact is not None
    viscosity = "" if oil.eta0 is None else f" of {numeral(oil.eta0)} Pa s"
    return (
        f"{study.carrier.label}, {contact.race} race, most loaded ball of {numeral(study.radial_load)} N at "
        f"{numeral(study.speed_rpm)} rpm, {oil.label}{viscosity}"
    )


def _with_source(found: Any, known: Mapping[str, Any]) -> Any:
    """The fit with an element that keeps what is known of it."""
    source = {**(found.element.source or {}), **known}
    return replace(found, element=replace(found.element, source=source))


def _window(simulation: SimulationResult) -> tuple[float, float] | None:
    """Last two thirds of a harmonic record, rounded to whole periods; otherwise left to `fit`.

    Over whole periods the misfit of the spring and the rate are orthogonal, so that the one does not leak into
    the damping, which at rotor frequency is a thousandth of the force. `ContactRecord.default_window` has the
    same rule but for two things: this window is a hair longer, so that rounding of the times never drops its
    first sample (as it does from the 6205's record in the contact's band), and at least a period.
    """
    if not isinstance(simulation.motion, HarmonicLoad):
        return None
    end, period = float(simulation.t[-1]), simulation.motion.period * simulation.point.scales.time
    periods = max(1, int(end / period * 2.0 / 3.0 + 1e-9))
    return max(0.0, end - periods * period - 1e-9 * end), end


def save_elements(reduction: Reduction, folder: Path) -> list[Path]:
    """Write every element as JSON, in SI."""
    target = folder / "elements"
    target.mkdir(exist_ok=True)
    files = []
    for (record, model), found in reduction.fits.items():
        files.append(save(found.element, target / f"{record}_{model}.json"))
    if not isinstance(reduction.memory, str):
        files.append(save(reduction.memory.element, target / f"{MEMORY}.json"))
    return files
