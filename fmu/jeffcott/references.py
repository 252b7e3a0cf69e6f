"""References inside the FMU of a Jeffcott rotor: its short run, and its equations in states of that run."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fmu.jeffcott.model import JeffcottModel
from fmu.jeffcott.reference_rotor import accelerations, felt_by
from fmu.lead import ROTOR
from fmu.references.series import References, Trial
from fmu.spec import ModelSpec

_Floats = NDArray[np.float64]

EVERY = 20  # steps of the run between states for model exchange
FILM = 0.02  # size of the states of the films there
ABOUT = "A short run from beside its rest, with an unbalance that shows and further forces, computed in Python"
TOLERANCE = 1e-5  # of references: Python and C balance the contacts to a billionth of the load, each for itself


def jeffcott_references(model: JeffcottModel, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a rotor, which turns with an unbalance that shows.

    Parameters
    ----------
    model : JeffcottModel
    spec : ModelSpec
        Of its FMU.
    """
    run = model.run
    names = [variable.name for variable in spec.states]
    count = run.motion.shape[1]
    parameters = {ROTOR.name: ROTOR.at_end, "inner_step": run.dt} | dict(
        zip(names[:count], run.motion[0].tolist(), strict=True)
    )
    # positions: of velocities the errors of the balance show more
    results = dict(zip(names[: count // 2], run.motion.T[: count // 2], strict=True))
    if model.elements:
        results |= {f"force[{i}]": history for i, history in enumerate(run.force.T, start=1)}
    steps = Trial(np.asarray(run.dt * np.arange(len(run.motion)), np.float64), run.inputs, results)
    return References(steps, _points(model, names), parameters, TOLERANCE, ABOUT)


def _points(model: JeffcottModel, names: list[str]) -> Trial:
    """Derivatives in states of the run, with films away from rest."""
    rotor, run = model.rotor, model.run
    count = run.motion.shape[1]
    at = np.arange(EVERY, len(run.motion), EVERY)
    size = count // 2
    journal = slice(size // 2, size)
    films = FILM * np.cos(np.outer(at, 1.0 + np.arange(len(names) - count - 1)))
    angle = 0.5 + 0.1 * np.arange(at.size)
    rows, forces = [], []
    for k, n in enumerate(at):
        motion = run.motion[n]
        inputs = {name: float(history[n]) for name, history in run.inputs.items()}
        u, v = rotor.normals @ motion[journal] + rotor.offsets, rotor.normals @ motion[size:][journal]
        felt = felt_by(model.elements, films[k], u, v) if model.elements else None
        force = run.force[n] if felt is None else felt.force
        rates = [motion[size:], accelerations(rotor, motion, float(angle[k]), force, inputs), [inputs["speed"]]]
        rows.append(np.concatenate([*rates, np.empty(0) if felt is None else felt.rates]))
        forces.append(force)
    unknowns = dict(zip((f"der({name})" for name in names), np.array(rows).T, strict=True))
    if model.elements:
        unknowns |= {f"force[{i}]": values for i, values in enumerate(np.array(forces).T, start=1)}
    states = dict(zip(names, np.column_stack([run.motion[at], angle, films]).T, strict=True))
    given = {name: history[at] for name, history in run.inputs.items()}
    return Trial(np.arange(at.size, dtype=float), states | given, unknowns)
