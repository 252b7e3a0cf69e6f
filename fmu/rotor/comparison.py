"""The FMU of a rotor with its ball bearings beside the rotor, and the references inside it."""

from __future__ import annotations

from typing import Any

import numpy as np

from fmu.bearing.variables import FORCES
from fmu.lead import ROTOR
from fmu.references.series import References, Trial, walk
from fmu.rotor.model import RotorModel
from fmu.rotor.trial import RotorTrial, rotor_trial
from fmu.shaft.comparison import sizes
from fmu.spec import ModelSpec
from fmu.verification import Verification
from reduced_models.bearing.race import RACES

TOLERANCE = 1e-6  # of references
ABOUT = "The speed rises, unbalances grow, forces lift the rotor off; steps of simulate_rotor, in Python"


def compare_rotor(slave: Any, exchange: Any, model: RotorModel, spec: ModelSpec) -> Verification:
    """Compare a rotor, in a run-up with lift-off."""
    trial = rotor_trial(model)
    references = _references(trial, model, spec)
    found = walk(slave, references)
    slave.raw.terminate()
    assert references.steps is not None
    histories = np.array(list(references.steps.unknowns.values())).T
    gaps = np.abs(found - histories).max(axis=0) / sizes(histories)
    return Verification(states=len(found), parted=trial.parted, motion=float(gaps.max()))


def rotor_references(model: RotorModel, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a rotor with its ball bearings."""
    return _references(rotor_trial(model), model, spec)


def _references(trial: RotorTrial, model: RotorModel, spec: ModelSpec) -> References:
    inputs = {v.name: trial.inputs[:, k] for k, v in enumerate(spec.inputs)}
    settings = {ROTOR.name: ROTOR.at_end, "inner_step": model.inner_step}
    if model.inertia is not None:
        settings["speed_start"] = float(trial.speed[0])
    return References(Trial(trial.time, inputs, _results(trial, model, spec)), None, settings, TOLERANCE, ABOUT)


def _results(trial: RotorTrial, model: RotorModel, spec: ModelSpec) -> dict[str, Any]:
    names = [v.name for v in spec.outputs]
    found = dict(zip(names, [*trial.displacement.T, *trial.velocity.T], strict=False))
    rings = [
        f"bearing[{b}].{FORCES[name]}"
        for b, mount in enumerate(model.stations, start=1)
        for name in mount.directions
    ]
    found |= dict(zip(rings, trial.force.T, strict=True))
    for b in range(len(model.stations)):
        found |= {f"bearing[{b + 1}].largest_load_{race}": trial.load[:, b, k] for k, race in enumerate(RACES)}
    turning = {"angle": trial.angle} | ({} if model.inertia is None else {"speed": trial.speed})
    return found | turning
