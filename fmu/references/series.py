"""Reference inputs and results of a model as time series."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.lead import inputs_at_end
from fmu.verification import TOLERANCE

_Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """Rows of one experiment.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Increasing; of points that do not follow one another, their number.
    knowns : mapping of str to ndarray, shape (n,)
        What is set, by variable: inputs, for model exchange states too. May be empty.
    unknowns : mapping of str to ndarray, shape (n,)
        What is read then, by variable; a Boolean is 0 or 1.
    """

    time: _Floats
    knowns: Mapping[str, _Floats]
    unknowns: Mapping[str, _Floats]


@dataclass(frozen=True, slots=True, eq=False)
class References:
    """Reference inputs and results of a model.

    Attributes
    ----------
    steps : Trial or None
        Co-simulation, one step from each row to the next. The inputs of a row are set before the step that ends
        there where `parameters` has ``lead`` 0 or ``force_lead`` 1, else before the one that begins there.
    points : Trial or None
        Model exchange: inputs and states, and the derivatives and outputs there.
    parameters : mapping of str to float
        What is set before initialization.
    tolerance : float
        Largest difference that passes, over the number itself and at least 1e-3 of the largest of its column.
    about : str
        What the experiment of `steps` is, in a sentence, for people.
    """

    steps: Trial | None
    points: Trial | None
    parameters: Mapping[str, float] = field(default_factory=dict)
    tolerance: float = TOLERANCE
    about: str = "Inputs, and what the model makes of them"


def rows_of(trial: Trial) -> list[dict[str, float]]:
    """What is set in each row, by variable."""
    return [{name: float(values[k]) for name, values in trial.knowns.items()} for k in range(trial.time.size)]


def walk(slave: Any, references: References) -> _Floats:
    """What an instance for co-simulation makes of the reference inputs, shape (rows, variables)."""
    trial = references.steps
    assert trial is not None
    names, rows, ends = tuple(trial.unknowns), rows_of(trial), inputs_at_end(references.parameters)
    slave.start(**references.parameters, **rows[0])
    found = [slave.read(*names)]
    for k in range(1, trial.time.size):
        slave.set(**rows[k if ends else k - 1])
        slave.step_to(float(trial.time[k]))
        found.append(slave.read(*names))
    return np.array(found)
