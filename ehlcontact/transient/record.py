"""What a simulation records: one entry per step, whole fields at the wanted times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.grid import Level
from ehlcontact.transient.film import Step, TransientFilm
from ehlcontact.transient.motion import MotionState

Array = NDArray[np.float64]

SAME_TIME = 1e-9  # of a time: a step this near has reached it


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """One time of the record."""

    motion: MotionState
    force: float
    load: float
    h_central: float
    h_min: float
    film: Array  # (nx + 1,) along Y = 0
    pressure: Array  # (nx + 1,) along Y = 0
    step: Step  # that led here

    @classmethod
    def of(cls, film: TransientFilm, motion: MotionState, load: float, step: Step) -> Entry:
        """Entry of the film as it is."""
        level = film.level
        return cls(
            motion,
            level.force(),
            load,
            level.central_film(),
            level.lowest_film(),
            level.H[0].copy(),
            level.P[0].copy(),
            step,
        )

    def numbers(self) -> tuple[float, ...]:
        """All but the profiles, in the order of `COLUMNS`."""
        m, s = self.motion, self.step
        films = (self.force, self.load, self.h_central, self.h_min)
        return (m.T, m.u, m.rate, m.acceleration, *films, s.residual, s.load_residual, float(s.cycles))


COLUMNS = (
    "T",
    "approach",
    "rate",
    "acceleration",
    "force",
    "load",
    "h_central",
    "h_min",
    "residuals",
    "load_residuals",
    "cycles",
)


class History:
    """The entries so far, and the snapshots taken and still wanted."""

    def __init__(self, snapshots: Sequence[float]) -> None:
        self.entries: list[Entry] = []
        self.wanted = sorted(snapshots)
        self.snapshots: list[tuple[float, Array, Array]] = []  # T, H and P of shape (nx + 1, ny + 1)

    def take_snapshot(self, T: float, level: Level) -> None:
        """Keep the whole fields for every wanted time that has come."""
        while self.wanted and T >= self.wanted[0] - SAME_TIME:
            self.wanted.pop(0)
            self.snapshots.append((T, level.H.T.copy(), level.P.T.copy()))

    def columns(self) -> dict[str, Array]:
        """Numbers of all entries by name, each of shape (steps + 1,)."""
        table = np.array([entry.numbers() for entry in self.entries]).T
        return {name: column.copy() for name, column in zip(COLUMNS, table, strict=True)}

    def profiles(self) -> tuple[Array, Array]:
        """Film and pressure along Y = 0, each (steps + 1, nx + 1)."""
        return np.array([e.film for e in self.entries]), np.array([e.pressure for e in self.entries])

    def snapshot_arrays(self, shape: tuple[int, int]) -> tuple[Array, Array, Array]:
        """Times (k,) and fields H, P (k, nx + 1, ny + 1) of the snapshots."""
        times = np.array([s[0] for s in self.snapshots])
        if not self.snapshots:
            return times, np.empty((0, *shape)), np.empty((0, *shape))
        return times, np.array([s[1] for s in self.snapshots]), np.array([s[2] for s in self.snapshots])
