"""Reference inputs and results of a model as time series."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.results.picture import Panel, draw
from ehlcontact.results.table import frame_of
from ehlcontact.summary import Summary
from fmu.verify import TOLERANCE

_Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Trial(Summary):
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

    def _summary_lines(self) -> list[str]:
        return [f"{self.time.size} rows", f"set {', '.join(self.knowns)}", f"read {', '.join(self.unknowns)}"]

    def to_pandas(self) -> Any:
        """``pandas.DataFrame``, a column for each variable; raises `InputError` where pandas is not installed."""
        columns = {"time": self.time, **self.knowns, **self.unknowns}
        rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        return frame_of(rows, "time", {})

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure of every variable, over time or number; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        panels = [
            Panel((self.time, "time, or number"), [("", values, None)], f"{name} ({how})")
            for how, table in (("set", self.knowns), ("read", self.unknowns))
            for name, values in table.items()
        ]
        return draw(f"Trial: {self.time.size} rows", panels, path)


@dataclass(frozen=True, slots=True, eq=False)
class References(Summary):
    """Reference inputs and results of a model.

    Attributes
    ----------
    steps : Trial or None
        Co-simulation, one step from each row to the next. The inputs of a row are set before the step that ends
        there where `parameters` has ``input_meaning`` 2 (end), else before the one that begins there.
    points : Trial or None
        Model exchange: inputs and states, and the derivatives and outputs there.
    parameters : mapping of str to float
        What is set before initialization; of an enumeration its number.
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

    def _summary_lines(self) -> list[str]:
        sizes = {"co-simulation": self.steps, "model exchange": self.points}
        lines = [f"{trial.time.size} rows of {name}" for name, trial in sizes.items() if trial is not None]
        return [", ".join(lines) or "nothing", f"within {self.tolerance:.1g} of the number"]

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure of the steps, or of the points where there are no steps; see `Trial.plot`.

        Raises
        ------
        InputError
            There is neither, or the file cannot be written.
        """
        trial = self.points if self.steps is None else self.steps
        if trial is None:
            raise InputError("steps", None, "there, or points, for a figure")
        return trial.plot(path)
