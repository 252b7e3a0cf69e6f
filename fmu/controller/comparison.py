"""The FMU of a speed controller beside the controller in Python, and the references inside it."""

from __future__ import annotations

from typing import Any

import numpy as np

from fmu.controller.model import SpeedController
from fmu.lead import CONTACT
from fmu.references.series import References, Trial, walk
from fmu.spec import ModelSpec
from fmu.verification import Verification

STEPS = 400  # of the trial
TOLERANCE = 1e-9  # of references
ABOUT = "A speed that leaves its set point until the torque is limited, both ways, and comes back"


def controller_trial(controller: SpeedController) -> Trial:
    """Set point, speed and torque over time: the proportional and the integral part both pass the limit."""
    limit, kp, ki = controller.torque_limit, controller.proportional_gain, controller.integral_gain
    size = 2.0 * limit / kp if kp > 0.0 else limit  # of the difference
    span = min(2.0 * limit / (ki * size), 1.0) if ki > 0.0 else 1.0
    t = np.asarray(np.linspace(0.0, 4.0 * span, STEPS + 1), np.float64)
    turns = 2.0 * np.pi * t / t[-1]
    speed, wanted = 200.0 + 0.7 * size * np.sin(2.0 * turns), 200.0 + 0.6 * size * np.sin(turns)
    given = {"speed_set_point": wanted, "speed": speed}
    return Trial(t, given, {"torque": controller.torque(t, speed, wanted)})


def compare_controller(slave: Any, exchange: Any, controller: SpeedController, spec: ModelSpec) -> Verification:
    """Compare a controller step by step."""
    references = controller_references(controller, spec)
    found = walk(slave, references)
    slave.raw.terminate()
    assert references.steps is not None
    gap = np.abs(found[:, 0] - references.steps.unknowns["torque"]).max()
    return Verification(states=len(found), motion=float(gap / controller.torque_limit))


def controller_references(controller: SpeedController, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a controller."""
    return References(controller_trial(controller), None, _settings(), TOLERANCE, ABOUT)


def _settings() -> dict[str, float]:
    """Parameters of the trial: its inputs are those of the ends of steps."""
    return {CONTACT.name: CONTACT.at_end}
