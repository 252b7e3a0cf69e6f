"""The FMU of a bearing beside the bearing, and the references inside it."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.continuous import StatePoints, state_points
from fmu.bearing.model import BearingModel
from fmu.bearing.trial import START, BearingTrial, bearing_trial
from fmu.bearing.variables import FORCES, RATES
from fmu.comparison import over
from fmu.lead import CONTACT
from fmu.references.series import References, Trial
from fmu.spec import ModelSpec
from fmu.verification import Verification
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]

TOLERANCE = 1e-6  # of references
REFERENCE_POINTS = 2  # each is a row of some 300 states and 300 rates: 6 kB in an FMU
ABOUT = (
    "The inner ring vibrates in all directions while the speed falls, and balls part from it, computed in Python"
)


def compare_bearing(slave: Any, exchange: Any, model: BearingModel, spec: ModelSpec) -> Verification:
    """Compare a bearing, in a run with lift-off; a planar one in model exchange too, at some states."""
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
    forces, rates = (0.0, 0.0) if exchange is None else exchange_differences(exchange, state_points(model), spec)
    return Verification(
        findings=(),
        states=len(found),
        outside=sum(outside),
        parted=int((trial.balls[:, :, 0] == 0.0).any(axis=1).sum()),
        force=0.0,
        tangents=0.0,
        derivatives=0.0,
        flags=wrong,
        bearing=max(largest_difference(np.array(found), trial), forces),
        rates=rates,
    )


def exchange_differences(exchange: Any, points: StatePoints, spec: ModelSpec) -> tuple[float, float]:
    """Largest differences of forces and of rates in model exchange, over the largest of a kind at a point."""
    exchange.start()
    forces, rates = [], []
    for k, states in enumerate(points.states):
        rates.append(exchange.place(states, **_point(points, k)))
        forces.append(exchange.get("force_x", "force_y"))
    kinds = [re.sub(r"\[\d+\]", "", state.name) for state in spec.states]
    found = []
    for kind in dict.fromkeys(kinds):
        these = [k for k, one in enumerate(kinds) if one == kind]
        found.append(_over_largest(np.array(rates)[:, these], points.rates[:, these]))
    return _over_largest(np.array(forces), points.force), max(found)


def _over_largest(found: _Floats, wanted: _Floats) -> float:
    """Of differences in rows, over the largest number of the row; 0 where both rows are 0."""
    size = np.abs(wanted).max(axis=1)
    return over(np.abs(found - wanted).max(axis=1), size)


def _point(points: StatePoints, k: int) -> dict[str, float]:
    (x, y), (velocity_x, velocity_y) = points.place[k].tolist(), points.velocity[k].tolist()
    return {
        "x": x, "y": y, "velocity_x": velocity_x, "velocity_y": velocity_y, "speed": float(points.speed[k])
    }  # fmt: skip


def _point_references(model: BearingModel, spec: ModelSpec) -> Trial:
    """Rows for model exchange: inputs and states; forces and rates there."""
    points, count = state_points(model, REFERENCE_POINTS), REFERENCE_POINTS
    rows = [_point(points, k) for k in range(count)]
    knowns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    knowns |= {state.name: points.states[:, k] for k, state in enumerate(spec.states)}
    unknowns = dict(zip(("force_x", "force_y"), points.force.T, strict=True))
    unknowns |= {rate.name: points.rates[:, k] for k, rate in enumerate(spec.derivatives)}
    return Trial(np.arange(count, dtype=float), knowns, unknowns)


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
    points = _point_references(model, spec) if spec.exchange else None
    return References(Trial(trial.time, inputs, results), points, parameters, TOLERANCE, ABOUT)


def _inputs(model: BearingModel, trial: BearingTrial, k: int) -> dict[str, float]:
    place = dict(zip(model.names, trial.place[k].tolist(), strict=True))
    rates = {RATES[name]: rate for name, rate in zip(model.names, trial.velocity[k].tolist(), strict=True)}
    return place | rates | {"speed": float(trial.speed[k])}
