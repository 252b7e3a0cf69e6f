"""The FMU of a shaft beside the shaft in Python, and the references inside it."""

from __future__ import annotations

from typing import Any

import numpy as np

from fmu.lead import HELD_PARALLEL, ROTOR, force_lead_for
from fmu.references.series import References, Trial, walk
from fmu.shaft.model import ShaftModel
from fmu.shaft.reference_shaft import ShaftTrial, shaft_trial
from fmu.spec import ModelSpec
from fmu.verification import Verification

TOLERANCE = 1e-6  # of references
ABOUT = "The forces of the bearings vary while the speed rises, computed in Python"


def compare_shaft(slave: Any, exchange: Any, model: ShaftModel, spec: ModelSpec) -> Verification:
    """Compare a shaft, in a run with forces that vary and a speed that rises."""
    references = shaft_references(model, spec)
    found = walk(slave, references)
    slave.raw.terminate()
    assert references.steps is not None
    histories = np.array(list(references.steps.unknowns.values())).T
    gaps = np.abs(found - histories).max(axis=0)
    return Verification(states=len(found), motion=float((gaps / sizes(histories)).max()))


def sizes(histories: Any) -> Any:
    """What each output moves in a run, or where it stands."""
    return np.maximum(np.maximum(np.ptp(histories, axis=0), 1e-3 * np.abs(histories).max(axis=0)), 1e-12)


def shaft_references(model: ShaftModel, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a shaft."""
    trial = shaft_trial(model)
    inputs = {v.name: trial.inputs[:, k] for k, v in enumerate(spec.inputs)}
    return References(
        Trial(trial.time, inputs, _outputs(trial, spec)), None, _settings(trial, model), TOLERANCE, ABOUT
    )


def _outputs(trial: ShaftTrial, spec: ModelSpec) -> dict[str, Any]:
    histories = [*trial.motion.T, *trial.velocity.T, trial.angle, trial.speed]
    return dict(zip((v.name for v in spec.outputs), histories, strict=False))


def _settings(trial: ShaftTrial, model: ShaftModel) -> dict[str, float]:
    """Parameters of the trial."""
    held = {ROTOR.name: force_lead_for(HELD_PARALLEL)}
    return held if model.inertia is None else held | {"speed_start": float(trial.speed[0])}
