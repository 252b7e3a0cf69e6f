"""The FMU of a bearing beside the bearing, and the references inside it."""

from __future__ import annotations

from typing import Any

import numpy as np

from fmu.bearing.model import BearingModel
from fmu.bearing.trial import START, BearingTrial, bearing_trial
from fmu.bearing.variables import FORCES, RATES
from fmu.lead import CONTACT
from fmu.references.series import References, Trial
from fmu.spec import ModelSpec
from fmu.verification import Verification
from reduced_models.bearing.race import RACES

TOLERANCE = 1e-6  # of references
ABOUT = (
    "The inner ring vibrates in all directions while the speed falls, and balls part from it, computed in Python"
)


def compare_bearing(slave: Any, exchange: Any, model: BearingModel, spec: ModelSpec) -> Verification:
    """Compare a bearing, in a run with lift-off."""
    trial, names = bearing_trial(model), [FORCES[name] for name in model.names]
    rows = [_inputs(model, trial, k) for k in range(trial.time.size)]
    slave.start(**{CONTACT.name: CONTACT.at_end, "cage_angle_start": START}, **rows[0])
    most = [model.bearing.race(race).heaviest(float(model.speeds[-1]))[0] for race in RACES]
    outside = np.any(trial.balls > most, axis=(1, 2)).tolist()
    found, wrong = [slave.get(*names)], 0
    for k in range(1, trial.time.size):
        slave.set(**rows[k])
        slave.step_to(float(trial.time[k]))
        found.append(slave.get(*names))
        wrong += slave.flag("outside_validity") != outside[k]
    slave.raw.terminate()
    return Verification(
        findings=(),
        states=len(found),
        outside=sum(outside),
        parted=int((trial.balls[:, :, 0] == 0.0).any(axis=1).sum()),
        force=0.0,
        tangents=0.0,
        derivatives=0.0,
        flags=wrong,
        bearing=largest_difference(np.array(found), trial),
    )


def largest_difference(found: Any, trial: BearingTrial) -> float:
    """Of forces and moments (k, n) from those of a trial, over the largest of each kind."""
    scale = np.abs(trial.force).max(axis=0)
    scale[:3] = scale[:3].max()
    scale[3:] = scale[3:].max() if scale.size > 3 else 1.0
    return float((np.abs(found - trial.force) / scale).max())


def bearing_references(model: BearingModel, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a bearing: a run with lift-off."""
    trial = bearing_trial(model)
    inputs = {
        name: np.array([row[name] for row in (_inputs(model, trial, k) for k in range(trial.time.size))])
        for name in _inputs(model, trial, 0)
    }
    results = {FORCES[name]: history for name, history in zip(model.names, trial.force.T, strict=True)}
    parameters = {CONTACT.name: CONTACT.at_end, "cage_angle_start": START}
    return References(Trial(trial.time, inputs, results), None, parameters, TOLERANCE, ABOUT)


def _inputs(model: BearingModel, trial: BearingTrial, k: int) -> dict[str, float]:
    place = dict(zip(model.names, trial.place[k].tolist(), strict=True))
    rates = {RATES[name]: rate for name, rate in zip(model.names, trial.velocity[k].tolist(), strict=True)}
    return place | rates | {"speed": float(trial.speed[k])}
