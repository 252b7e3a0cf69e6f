"""The rotor of a study on full contacts and on elements: its runs, their HDF5 file, and how they differ."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from math import cos, radians
from pathlib import Path
from typing import Any

import h5py

from ehlcontact.cli.study.reduction import CHOSEN
from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import InputError
from ehlcontact.files import hdf5
from ehlcontact.status import Status
from ehlcontact.transient.full_contact import FullContact
from reduced_models import (
    Comparison,
    ContactElement,
    JeffcottRotor,
    OutsideValidityWarning,
    RotorResult,
    ScaledContact,
    compare,
    simulate_rotor,
)

HISTORIES = tuple(f.name for f in fields(RotorResult) if f.name not in ("status", "rotor"))
FORMAT = 1  # of the file of a run
TOLERANCE = 1e-5  # of the force balance: not below the noise of the full film


def build_rotor(study: Study) -> JeffcottRotor:
    """Rotor of the study, pressed down so that every contact carries the load of the operating point."""
    r, ball = study.rotor, study.ball_load
    vee = r.arrangement == "vee"
    half_angle = radians(r.half_angle_deg)
    bearings = 2
    needed = bearings * ball * (2.0 * cos(half_angle) if vee else 1.0)
    weight = (r.disc_mass + r.journal_mass) * 9.81
    settings: dict[str, Any] = {
        "disc_mass": r.disc_mass,
        "journal_mass": r.journal_mass,
        "shaft_stiffness": r.shaft_stiffness,
        "shaft_damping": r.shaft_damping,
        "disc_damping": r.disc_damping,
        "unbalance": r.unbalance,
        "speed_rpm": study.bearing.speed_rpm,
        "bearings": bearings,
        "load": (0.0, weight - needed),
    }
    if vee:
        return JeffcottRotor.vee(half_angle=half_angle, **settings)
    return JeffcottRotor.vertical(**settings)


def time_step(study: Study, halvings: int = 0) -> float:
    """Step of the rotor runs [s]."""
    return 60.0 / study.bearing.speed_rpm / (study.rotor.steps_per_revolution * 2**halvings)


def run_full(study: Study, halvings: int, revolutions: float, callback: Callable[[int, int], None]) -> RotorResult:
    """Rotor with the whole film in every contact, from rest when the unbalance sets in."""
    point, rotor = study.point, build_rotor(study)
    contacts = [
        ScaledContact(FullContact(point, n=study.solver.n_transient, domain=study.domain), point.scales)
        for _ in rotor.mounts
    ]
    start = rotor.state_at([c.contact.static_approach * point.scales.length for c in contacts])
    return simulate_rotor(
        rotor,
        contacts,
        dt=time_step(study, halvings),
        until=revolutions * 60.0 / study.bearing.speed_rpm,
        start=start,
        tolerance=TOLERANCE,
        callback=callback,
    )


def run_reduced(study: Study, element: ContactElement, halvings: int, revolutions: float) -> RotorResult:
    """The same run with an SI element in every contact, from its own rest.

    What comes of leaving a validity box is what the study shows, so it is not told.
    """
    rotor = build_rotor(study)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutsideValidityWarning)
        return simulate_rotor(
            rotor,
            [element.copy() for _ in rotor.mounts],
            dt=time_step(study, halvings),
            until=revolutions * 60.0 / study.bearing.speed_rpm,
            tolerance=TOLERANCE,
        )


def save_rotor(result: RotorResult, path: Path) -> None:
    """Write the histories of a rotor run in one move; what rotor it was stands in the study."""
    with hdf5.making(path, "file") as file:
        file.attrs["format"] = FORMAT
        hdf5.set_text(file, "class", RotorResult.__name__)
        hdf5.set_text(file, "status", str(result.status))
        hdf5.set_text(file, "static_load", json.dumps(result.rotor.static_load.tolist()))
        for name in HISTORIES:
            hdf5.put(file, name, getattr(result, name))


def load_rotor(path: Path, rotor: JeffcottRotor) -> RotorResult:
    """Read a rotor run of the given rotor.

    Raises
    ------
    InputError
        Not a complete file of `save_rotor`.
    """
    try:
        with h5py.File(path, "r") as file:
            ours = hdf5.text_of(file, "class") == RotorResult.__name__ and file.attrs["format"] == FORMAT
            values = {name: hdf5.take(file[name]) for name in HISTORIES if ours}
            status = Status(hdf5.text_of(file, "status"))
    except Exception as error:  # whatever h5py and numpy raise on what is damaged
        raise InputError("file", str(path), f"a complete rotor run of this library ({error})") from None
    if not ours:
        raise InputError("file", str(path), "a rotor run of this library")
    return RotorResult(status=status, rotor=rotor, **values)


@dataclass(frozen=True)
class RotorComparison:
    """The rotor on full contacts against the rotor on elements, and how much of it is the time step."""

    full: RotorResult
    full_half: RotorResult  # half the step, shorter
    reduced: Mapping[str, RotorResult]  # by element; the chosen one is among them
    whole: Mapping[str, Comparison]  # full against each reduced run, from the start
    last: Mapping[str, Comparison]  # likewise, the last revolution
    half: Comparison  # full against the chosen element, both with half the step
    step_full: Comparison  # full with the step against full with half of it
    step_reduced: Comparison  # the same for the chosen element: what the rotor's integrator contributes

    def to_dict(self) -> dict[str, Any]:
        """All numbers."""
        pairs = {"whole": self.whole, "last_revolution": self.last}
        return {
            **{name: {key: c.to_dict() for key, c in group.items()} for name, group in pairs.items()},
            "half_step": self.half.to_dict(),
            "step_full": self.step_full.to_dict(),
            "step_reduced": self.step_reduced.to_dict(),
            "evaluations_per_step": {
                "full": float(self.full.iterations[1:].mean()),
                "full_half_step": float(self.full_half.iterations[1:].mean()),
            },
        }


def compare_rotors(study: Study, elements: Mapping[str, ContactElement], folder: Path) -> RotorComparison:
    """Run the rotor on SI elements, by name, and compare it with the stored runs on full contacts."""
    rotor, chosen = build_rotor(study), CHOSEN[0]
    full, full_half = (load_rotor(folder / f"{name}.h5", rotor) for name in ("rotor_full", "rotor_half_step"))
    r = study.rotor
    reduced = {name: run_reduced(study, element, 0, r.revolutions) for name, element in elements.items()}
    reduced_half = run_reduced(study, elements[chosen], 1, r.check_revolutions)
    before_last = float(full.t[-1]) - 60.0 / study.bearing.speed_rpm
    return RotorComparison(
        full=full,
        full_half=full_half,
        reduced=reduced,
        whole={name: compare(full, run) for name, run in reduced.items()},
        last={name: compare(full, run, discard=before_last) for name, run in reduced.items()},
        half=compare(full_half, reduced_half),
        step_full=compare(full, full_half),
        step_reduced=compare(reduced[chosen], reduced_half),
    )
