"""Inputs and results of a model as time series; what an FMU makes of the inputs, and how far that is off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.lead import inputs_at_end
from fmu.verification import TOLERANCE

_Floats = NDArray[np.float64]

DIGITS = 7  # of times, places and rates, which are exact in the files then
LEAST_SHARE = 1e-3  # of the size of a column: what a difference is divided by at least


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
        What is read then, by variable; a Boolean is 0 or 1, and "force / rate" a partial derivative.
    sizes : mapping of str to float or ndarray, shape (n,)
        What differences of a variable are divided by; by default the number, at least 1e-3 of the largest of its
        column.
    fields : mapping of str to str
        By variable the field of `Verification` that has its largest difference.
    """

    time: _Floats
    knowns: Mapping[str, _Floats]
    unknowns: Mapping[str, _Floats]
    sizes: Mapping[str, Any] = field(default_factory=dict)
    fields: Mapping[str, str] = field(default_factory=dict)

    @property
    def rows(self) -> list[dict[str, float]]:
        """What is set in each row, by variable."""
        return [{name: float(values[k]) for name, values in self.knowns.items()} for k in range(self.time.size)]

    def first(self, count: int) -> Trial:
        """Its first rows, as files have them."""
        knowns, unknowns = (
            {name: values[:count] for name, values in columns.items()} for columns in (self.knowns, self.unknowns)
        )
        return Trial(self.time[:count], knowns, unknowns)

    def differences(self, found: _Floats) -> dict[str, _Floats]:
        """Of results, shape (n, variables), from the unknowns, over their sizes; infinite where no number."""
        gaps = {}
        for column, (name, expected) in zip(found.T, self.unknowns.items(), strict=True):
            size = self.sizes[name] if name in self.sizes else floored(expected, np.abs(expected).max())
            size, error = np.broadcast_to(size, column.shape), np.abs(column - expected)
            share = np.divide(error, size, out=np.where(error > 0.0, np.inf, 0.0), where=size > 0.0)
            gaps[name] = np.where(np.isfinite(error), share, np.inf)
        return gaps


@dataclass(frozen=True, slots=True, eq=False)
class References:
    """Inputs and results of a model, inside its FMU or for its verification.

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
    outside, parted : int
        Rows of `steps` outside the validity interval, and with balls or contacts that carry nothing.
    """

    steps: Trial | None
    points: Trial | None
    parameters: Mapping[str, float] = field(default_factory=dict)
    tolerance: float = TOLERANCE
    about: str = "Inputs, and what the model makes of them"
    outside: int = 0
    parted: int = 0


def rounded(values: _Floats) -> _Floats:
    """Inputs of a trial with as many digits as files have."""
    return np.vectorize(lambda value: float(f"{value:.{DIGITS}g}"), otypes=[float])(values)


def floored(expected: _Floats, scale: float | _Floats) -> _Floats:
    """Magnitude of the expected values, at least 1e-3 of `scale`."""
    return np.asarray(np.maximum(np.abs(expected), LEAST_SHARE * np.abs(scale)))


def walk(slave: Any, references: References) -> _Floats:
    """What an instance for co-simulation makes of the inputs of the steps, shape (rows, variables)."""
    trial = references.steps
    assert trial is not None
    names, rows, ends = tuple(trial.unknowns), trial.rows, inputs_at_end(references.parameters)
    slave.start(**references.parameters, **rows[0])
    found = [slave.read(*names)]
    for k in range(1, trial.time.size):
        slave.set(**rows[k if ends else k - 1])
        slave.step_to(float(trial.time[k]))
        found.append(slave.read(*names))
    return np.array(found)


def visit(exchange: Any, references: References) -> _Floats:
    """Derivatives and outputs of an instance for model exchange at the points, shape (rows, variables)."""
    trial = references.points
    assert trial is not None
    derivatives = [unknown.variable for unknown in exchange.description.derivatives]
    states = [variable.derivative.name for variable in derivatives]
    places = {variable.name: k for k, variable in enumerate(derivatives)}
    others = [name for name in trial.unknowns if name not in places]
    exchange.start()
    found = []
    for row in trial.rows:
        x = np.array([row.pop(name) for name in states])
        rates = exchange.place(x, **row)
        read = dict(zip(others, exchange.read(*others), strict=True))
        found.append([rates[places[name]] if name in places else read[name] for name in trial.unknowns])
    return np.array(found)
