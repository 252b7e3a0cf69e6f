"""Reference inputs and results of the FMU of a bearing: a run with lift-off, and states in model exchange."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.continuous import StatePoints, state_points
from fmu.bearing.model import BearingModel
from fmu.bearing.set_model import SetModel
from fmu.bearing.trial import START, BearingTrial, bearing_trial
from fmu.bearing.variables import FORCES, RATES
from fmu.lead import CONTACT
from fmu.references.series import References, Trial
from fmu.spec import ModelSpec
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]

TOLERANCE = 1e-6  # of references
REFERENCE_POINTS = 2  # each is a row of some 300 states and 300 rates: 6 kB in an FMU
ABOUT = (
    "The inner ring vibrates in all directions while the speed falls, and balls part from it, computed in Python"
)


def bearing_trials(model: BearingModel | SetModel, spec: ModelSpec) -> References:
    """What the FMU of a bearing is compared on."""
    trial, points = bearing_trial(model), state_points(model)
    names = [FORCES[name] for name in model.directions]
    fastest = float(model.speeds[-1])
    most = np.concatenate(
        [
            np.tile([bearing.race(race).heaviest(fastest)[0] for race in RACES], (bearing.balls, 1))
            for bearing in (seat.model.bearing for seat in model.seats)
        ]
    )
    outside = np.any(trial.balls > most, axis=(1, 2))
    forces = dict(zip(names, trial.force.T, strict=True))
    sizes = dict(zip(names, force_scales(trial), strict=True)) | {"outside_validity": 1.0}
    fields = dict.fromkeys(names, "bearing") | {"outside_validity": "flags"}
    steps = Trial(trial.time, _columns(model, trial), forces | {"outside_validity": outside}, sizes, fields)
    return References(
        steps,
        _points(model, spec, points),
        {CONTACT.name: CONTACT.at_end} | {f"{seat.label}cage_angle_start": START for seat in model.seats},
        TOLERANCE,
        ABOUT,
        outside=int(outside.sum()),
        parted=int((trial.balls[:, :, 0] == 0.0).any(axis=1).sum()),
    )


def bearing_references(trials: References) -> References:
    """Those that an FMU has inside: the forces of the run, and some of the states."""
    assert trials.steps is not None and trials.points is not None
    forces = {name: values for name, values in trials.steps.unknowns.items() if name != "outside_validity"}
    return replace(
        trials,
        steps=Trial(trials.steps.time, trials.steps.knowns, forces),
        points=trials.points.first(REFERENCE_POINTS),
    )


def _points(model: BearingModel | SetModel, spec: ModelSpec, points: StatePoints) -> Trial:
    """Rows for model exchange: inputs and states; forces and rates, measured by the largest of a kind in a row."""
    knowns = _columns(model, points)
    knowns |= {state.name: points.states[:, k] for k, state in enumerate(spec.states)}
    directions = ("tilts" if name.startswith("tilt") else "linear" for name in model.directions)
    forces = [(FORCES[name], kind) for name, kind in zip(model.directions, directions, strict=True)]
    rates = [
        (rate.name, re.sub(r"\[\d+\]", "", state.name))
        for rate, state in zip(spec.derivatives, spec.states, strict=True)
    ]
    unknowns: dict[str, _Floats] = {}
    sizes: dict[str, _Floats] = {}
    for named, columns in ((forces, points.force), (rates, points.rates)):
        kinds = np.array([kind for _, kind in named])
        for (name, kind), column in zip(named, columns.T, strict=True):
            unknowns[name] = column
            sizes[name] = np.abs(columns[:, kinds == kind]).max(axis=1)
    fields = {name: "bearing" for name, _ in forces} | {name: "rates" for name, _ in rates}
    return Trial(np.arange(len(points.states), dtype=float), knowns, unknowns, sizes, fields)


def knowns_of(names: Sequence[str], place: _Floats, velocity: _Floats, speed: float) -> dict[str, float]:
    """Inputs of the FMU by name."""
    rates = (RATES[name] for name in names)
    return dict(zip((*names, *rates, "speed"), (*place.tolist(), *velocity.tolist(), float(speed)), strict=True))


def _columns(model: BearingModel | SetModel, of: StatePoints | BearingTrial) -> dict[str, _Floats]:
    """Inputs by name, over time or points."""
    names = (*model.directions, *(RATES[name] for name in model.directions), "speed")
    return dict(zip(names, np.column_stack([of.place, of.velocity, of.speed]).T, strict=True))


def force_scales(trial: BearingTrial) -> _Floats:
    """Largest force or moment of a run, by its kind, shape (n,)."""
    scale = np.asarray(np.abs(trial.force).max(axis=0))
    for kind in (slice(0, 3), slice(3, 5)):  # behind them outer rings
        scale[kind] = scale[kind].max(initial=0.0)
    return scale
