"""What a study answers about its machine: `MachineState`, K and C over frequency, and runs in time on models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.cli.study.loads import life_options, load_alone, places_of_bearings, ring_load
from ehlcontact.cli.study.machine import bearing_of, carrier_of, disc_of, places_of, rotor_of
from ehlcontact.cli.study.shared_entries import tilt_of
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.store import save
from reduced_models.rotor.compare_bearing_models import (
    BAND,
    CONSTANT,
    DRY,
    FILM,
    FREQUENCIES,
    USUAL,
    USUAL_DAMPING,
    BearingModels,
    compare_bearing_models,
)
from reduced_models.rotor.machine_state import MachineState, machine_state, single_bearing_state

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study
    from reduced_models.bearing.coefficients import BearingCoefficients

NAMES = {
    FILM: "film memory under every ball",
    DRY: "dry Hertz contacts",
    CONSTANT: "constant K and C, of the film at the speed",
    USUAL: f"constant K, dry, and C = {USUAL_DAMPING:g} s K",
}


def answer_of(study: Study, *, fine: bool = True) -> MachineState | str:
    """State of the machine, or of the bearing alone, at the speed of the study; or why there is none.

    Not `fine`: as `machine_state` has it for many machines.
    """
    speed, electric = study.speed_rpm, study.electric
    asked = life_options(study)
    if "electric" in study.model_fields_set:
        asked |= {"voltage": electric.voltage, "breakdown": electric.breakdown}
    try:
        if study.shaft is None:
            tilt = tilt_of(study.operation)
            carrier, name = carrier_of(study, 0), study.support[0].name or ""
            found = single_bearing_state(carrier, load_alone(study), speed, tilt=tilt, name=name, fine=fine)
            return _of_oil(found, electric.permittivity, asked)
        names: list[str] = []
        places: list[float] = []
        for k, (name, place) in enumerate(zip(study.names, places_of(study), strict=True)):
            several = places_of_bearings(study).count(k)
            names += [name] if several == 1 else [f"{name} {number + 1}" for number in range(several)]
            places += [place] * several
        machine = machine_state(rotor_of(study), speed, names=names, positions=places, fine=fine)
        return _of_oil(machine, electric.permittivity, asked)
    except (ConvergenceError, InputError) as error:
        return str(error)


def _of_oil(machine: MachineState, permittivity: float, asked: dict[str, Any]) -> MachineState:
    """A machine with another permittivity of its oil, and other attributes that its numbers follow."""
    supports = tuple(replace(one, permittivity=permittivity) for one in machine.supports)
    return replace(machine, supports=supports, **asked)


def over_frequency(study: Study, machine: MachineState | str) -> Mapping[str, BearingCoefficients]:
    """K and C of the bearings of a machine over frequency, by the support; none where it has no answer."""
    if isinstance(machine, str):
        return {}
    hz = study.operation.hz or study.rotor_hz * np.geomspace(*BAND, FREQUENCIES)
    under: dict[str, Any] = {"speed_rpm": study.speed_rpm, "hz": hz}
    if study.shaft is None:
        found = machine.supports[0].bearing.coefficients(load_alone(study), tilt=tilt_of(study.operation), **under)
        return {study.names[0]: found}
    return {one.name: one.bearing.coefficients(one.state.load, **under) for one in machine.supports}


def run_models(study: Study, folder: Path) -> BearingModels | None:
    """Run the machine in time on models of its bearings, with [in_time]; runs are left in the folder."""
    if study.in_time is None:
        return None
    disc = disc_of(study, 0)
    return compare_bearing_models(
        lambda bearing: rotor_of(study, carriers=[bearing, bearing]),
        bearing_of(study, 0),
        bearing_of(study, 0, oil=False),
        load=-float(ring_load(study, 0)[1]),
        speed_rpm=study.speed_rpm,
        eccentricity=disc.unbalance / disc.mass,
        steps=study.in_time.steps_per_revolution,
        revolutions=study.in_time.revolutions,
        keep=lambda name, run: save(run, folder / f"on_bearings_{name}.h5"),
    )
