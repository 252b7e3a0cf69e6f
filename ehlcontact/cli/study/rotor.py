"""The rotor of a study, its contacts, and the HDF5 file of a rotor run."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, radians
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import InputError
from ehlcontact.transient.full_contact import FullContact
from reduced_models import (
    ContactElement,
    JeffcottRotor,
    OutsideValidityWarning,
    RotorResult,
    RotorStatus,
    ScaledContact,
    simulate_rotor,
)

HISTORIES = (
    "t",
    "disc",
    "disc_velocity",
    "journal",
    "journal_velocity",
    "approach",
    "rate",
    "force",
    "iterations",
)
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


@dataclass(frozen=True)
class _Header:
    """How `load_rotor` knows its files."""

    kind: str = "RotorResult"
    format: int = 1


def save_rotor(result: RotorResult, path: Path) -> None:
    """Write a rotor run in one move."""
    partial = path.with_name(f".{path.name}.tmp")
    try:
        with h5py.File(partial, "w") as file:
            file.attrs["class"], file.attrs["format"] = _Header.kind, _Header.format
            file.attrs["status"] = str(result.status)
            file.attrs["static_load"] = json.dumps(result.rotor.static_load.tolist())
            for name in HISTORIES:
                file.create_dataset(name, data=getattr(result, name))
        os.replace(partial, path)
    except OSError as error:
        raise InputError("file", str(path), f"a file that can be written ({error.strerror})") from None
    finally:
        partial.unlink(missing_ok=True)


def load_rotor(path: Path, rotor: JeffcottRotor) -> RotorResult:
    """Read a rotor run of the given rotor.

    Raises
    ------
    InputError
        Not a complete file of `save_rotor`.
    """
    try:
        with h5py.File(path, "r") as file:
            if file.attrs["class"] != _Header.kind or file.attrs["format"] != _Header.format:
                raise InputError("file", str(path), "a rotor run of this library")
            values = {name: np.asarray(file[name][...]) for name in HISTORIES}
            status = RotorStatus(str(file.attrs["status"]))
    except (OSError, KeyError) as error:
        raise InputError("file", str(path), f"a complete rotor run of this library ({error})") from None
    return RotorResult(status=status, rotor=rotor, **values)
