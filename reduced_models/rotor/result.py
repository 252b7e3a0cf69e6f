"""What a rotor run leaves behind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Status
from reduced_models.rotor.jeffcott import JeffcottRotor

_Floats = NDArray[np.float64]
RotorStatus = Status  # its public name; a run ends as converged, interrupted or failed


@dataclass(frozen=True, eq=False)
class RotorResult:
    """Histories of a rotor run in SI; entry 0 is the start. N times, C contacts."""

    t: _Floats  # (N,) [s]
    disc: _Floats  # (N, 2) [m]
    disc_velocity: _Floats  # (N, 2) [m/s]
    journal: _Floats  # (N, 2) [m]
    journal_velocity: _Floats  # (N, 2) [m/s]
    approach: _Floats  # (N, C) [m]
    rate: _Floats  # (N, C) [m/s]
    force: _Floats  # (N, C) on one contact of one bearing [N]
    iterations: NDArray[np.int64]  # (N,) evaluations of every contact in the step
    status: Status
    rotor: JeffcottRotor

    def __post_init__(self) -> None:
        for values in vars(self).values():
            if isinstance(values, np.ndarray):
                values.setflags(write=False)
