"""The FMU of a bearing beside the bearing, and the references inside it."""

from __future__ import annotations

import re
from collections.abc import Sequence
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
    """Compare a bearing, in a run with lift-off and in model exchange at some states."""
    trial, names = bearing_trial(model), [FORCES[name] for name in model.directions]
    rows = _rows(model, trial)
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
    forces, rates = exchange_differences(exchange, model, spec)
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


def exchange_differences(exchange: Any, model: BearingModel, spec: ModelSpec) -> tuple[float, float]:
    """Largest differences of forces and of rates in model exchange, over the largest of a kind at a point."""
    points = state_points(model)
    exchange.start()
    forces, rates = [], []
    for states, inputs in zip(points.states, _rows(model, points), strict=True):
        rates.append(exchange.place(states, **inputs))
        forces.append(exchange.get(*(FORCES[name] for name in model.directions)))
    kinds = [re.sub(r"\[\d+\]", "", state.name) for state in spec.states]
    found = []
    for kind in dict.fromkeys(kinds):
        these = [k for k, one in enumerate(kinds) if one == kind]
        found.append(_over_largest(np.array(rates)[:, these], points.rates[:, these]))
    kinds_of_force = [slice(0, 3), slice(3, 5)] if len(model.directions) > 3 else [slice(0, 2)]
    gaps = [_over_largest(np.array(forces)[:, at], points.force[:, at]) for at in kinds_of_force]
    return max(gaps), max(found)


def _over_largest(found: _Floats, wanted: _Floats) -> float:
    """Of differences in rows, over the largest number of the row; 0 where both rows are 0."""
    size = np.abs(wanted).max(axis=1)
    return over(np.abs(found - wanted).max(axis=1), size)


def knowns_of(names: Sequence[str], place: _Floats, velocity: _Floats, speed: float) -> dict[str, float]:
    """Inputs of the FMU by name."""
    rates = (RATES[name] for name in names)
    return dict(zip((*names, *rates, "speed"), (*place.tolist(), *velocity.tolist(), float(speed)), strict=True))


def _rows(model: BearingModel, of: StatePoints | BearingTrial) -> list[dict[str, float]]:
    return [knowns_of(model.directions, *row) for row in zip(of.place, of.velocity, of.speed, strict=True)]


def _point_references(model: BearingModel, spec: ModelSpec) -> Trial:
    """Rows for model exchange: inputs and states; forces and rates there."""
    points, count = state_points(model, REFERENCE_POINTS), REFERENCE_POINTS
    rows = _rows(model, points)
    knowns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    knowns |= {state.name: points.states[:, k] for k, state in enumerate(spec.states)}
    unknowns = dict(zip((FORCES[name] for name in model.directions), points.force.T, strict=True))
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
    rows = _rows(model, trial)
    inputs = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    results = {FORCES[name]: history for name, history in zip(model.directions, trial.force.T, strict=True)}
    parameters = {CONTACT.name: CONTACT.at_end, "cage_angle_start": START}
    points = _point_references(model, spec)
    return References(Trial(trial.time, inputs, results), points, parameters, TOLERANCE, ABOUT)
