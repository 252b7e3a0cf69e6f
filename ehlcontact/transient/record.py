"""Record of a simulation: one entry per step, whole fields at given times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.level import Level
from ehlcontact.status import Status
from ehlcontact.transient.bodies import MotionState
from ehlcontact.transient.transient_film import Step, TransientFilm

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
    leaving: Array  # (ny + 1,): oil on the surfaces behind the contact; empty of a flooded inlet
    step: Step  # that led here
    heat: tuple[float, float, float] | None = None  # warmest oil and surface, and the balance of energy

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
            *film.midplane,
            level.leaving(),
            step,
            None if film.heat is None else film.heat.numbers_of_record(),
        )

    @classmethod
    def of_numbers(
        cls, numbers: Sequence[float], film: Array, pressure: Array, leaving: Array, heat: Array
    ) -> Entry:
        """Entry of a step that was solved, from its `numbers` and profiles."""
        T, u, rate, acceleration, force, load, h_central, h_min, residual, load_residual, cycles = numbers
        step = Step(residual, load_residual, int(cycles), Status.CONVERGED)
        motion = MotionState(T, u, rate, acceleration)
        warm = (float(heat[0]), float(heat[1]), float(heat[2])) if heat.size else None
        return cls(motion, force, load, h_central, h_min, film, pressure, leaving, step, warm)

    def numbers(self) -> tuple[float, ...]:
        """All but the profiles, in the order of `COLUMNS`."""
        m, s = self.motion, self.step
        films = (self.force, self.load, self.h_central, self.h_min)
        return (m.T, m.u, m.rate, m.acceleration, *films, s.residual, s.load_residual, float(s.cycles))


COLUMNS = (
    "t",
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


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """A history as arrays: what a checkpoint keeps and a result is made of."""

    numbers: Array  # (steps + 1, columns), see `COLUMNS`
    film: Array  # (steps + 1, nx + 1) along Y = 0
    pressure: Array  # (steps + 1, nx + 1) along Y = 0
    leaving: Array  # (steps + 1, ny + 1), or (steps + 1, 0) of a flooded inlet
    heat: Array  # (steps + 1, 3) as in `Entry`, or (steps + 1, 0) of an isothermal film
    snapshot_T: Array  # (k,)
    snapshot_H: Array  # (k, nx + 1, ny + 1)
    snapshot_P: Array  # (k, nx + 1, ny + 1)

    @property
    def T(self) -> float:
        """Time reached."""
        return float(self.numbers[-1, 0])

    def columns(self) -> dict[str, Array]:
        """Numbers by name, each of shape (steps + 1,)."""
        return {name: column.copy() for name, column in zip(COLUMNS, self.numbers.T, strict=True)}

    def entries(self) -> list[Entry]:
        """The entries it was made of, each of which was solved."""
        rows = zip(self.numbers.tolist(), self.film, self.pressure, self.leaving, self.heat, strict=True)
        return [Entry.of_numbers(*row) for row in rows]


class History:
    """Entries of a run until now, its snapshots, and the times of further ones."""

    def __init__(self, snapshots: Sequence[float]) -> None:
        self.entries: list[Entry] = []
        self.wanted = sorted(snapshots)
        self.snapshots: list[tuple[float, Array, Array]] = []  # T, H and P of shape (nx + 1, ny + 1)

    @classmethod
    def of(cls, record: Record, snapshots: Sequence[float]) -> History:
        """History that continues a record, with the `snapshots` after its end."""
        history = cls([T for T in snapshots if T > record.T])
        history.entries = record.entries()
        taken = zip(record.snapshot_T.tolist(), record.snapshot_H, record.snapshot_P, strict=True)
        history.snapshots = list(taken)
        return history

    def take_snapshot(self, T: float, film: TransientFilm) -> None:
        """Copy the whole fields for every time of `wanted` that has been reached."""
        while self.wanted and T >= self.wanted[0] - SAME_TIME:
            self.wanted.pop(0)
            self.snapshots.append((T, *film.fields))

    def record(self, level: Level, entries: int | None = None) -> Record:
        """All entries, or the first `entries`, with the snapshots until then; `level` gives their shape."""
        rows = self.entries[:entries]
        taken = [s for s in self.snapshots if s[0] <= rows[-1].motion.T]
        shape = (len(taken), level.nx + 1, level.ny + 1)
        return Record(
            numbers=np.array([entry.numbers() for entry in rows]),
            film=np.array([entry.film for entry in rows]),
            pressure=np.array([entry.pressure for entry in rows]),
            leaving=np.array([entry.leaving for entry in rows]),
            heat=np.array([entry.heat or () for entry in rows]),
            snapshot_T=np.array([T for T, _, _ in taken]),
            snapshot_H=np.array([H for _, H, _ in taken]).reshape(shape),
            snapshot_P=np.array([P for _, _, P in taken]).reshape(shape),
        )
