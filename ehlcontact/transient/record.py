"""Record of a simulation: its columns, one entry per step, whole fields at given times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.quantities import (
    ACCELERATION,
    FORCE,
    LENGTH,
    NUMBER,
    PRESSURE,
    RATE,
    TIME,
    quantities_of,
)
from ehlcontact.solver.level import Level
from ehlcontact.status import Status
from ehlcontact.transient.bodies import MotionState
from ehlcontact.transient.transient_film import Step, TransientFilm

Array = NDArray[np.float64]

SAME_TIME = 1e-9  # of a time: a step this near has reached it


@dataclass(frozen=True, eq=False, kw_only=True)
class SmoothColumns:
    """What a simulation knows between its steps too, over its times."""

    __slots__ = ()

    t: Annotated[Array, TIME.over("t")]
    approach: Annotated[Array, LENGTH.over("t")]
    rate: Annotated[Array, RATE.over("t")]
    force: Annotated[Array, FORCE.over("t")]
    load: Annotated[Array, FORCE.over("t")]
    h_central: Annotated[Array, LENGTH.over("t")]
    h_min: Annotated[Array, LENGTH.over("t")]


@dataclass(frozen=True, eq=False, kw_only=True)
class Columns(SmoothColumns):
    """All that a simulation keeps over its steps: columns of its record, its checkpoint and its result.

    A column that a run does not have is None: a flooded inlet has no `layer_behind`, an isothermal film none of
    `OF_HEAT`.
    """

    __slots__ = ()

    acceleration: Annotated[Array, ACCELERATION.over("t", listed=False)]
    h_midplane: Annotated[Array, LENGTH.over("t x", listed=False)]
    p_midplane: Annotated[Array, PRESSURE.over("t x", listed=False)]
    residuals: Annotated[Array, NUMBER.over("t", listed=False)]
    load_residuals: Annotated[Array, NUMBER.over("t", listed=False)]
    cycles: Annotated[Array, NUMBER.over("t", listed=False)]
    layer_behind: Annotated[Array | None, LENGTH.over("t y", listed=False)] = None
    warmest_oil: Annotated[Array | None, NUMBER.over("t", listed=False)] = None
    warmest_surface: Annotated[Array | None, NUMBER.over("t", listed=False)] = None
    heat_balance: Annotated[Array | None, NUMBER.over("t", listed=False)] = None
    snapshot_t: Annotated[Array, TIME.over("snapshot_t", listed=False)]
    snapshot_h: Annotated[Array, LENGTH.over("snapshot_t x y", listed=False)]
    snapshot_p: Annotated[Array, PRESSURE.over("snapshot_t x y", listed=False)]


OF_HEAT = ("warmest_oil", "warmest_surface", "heat_balance")


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """One time of the record: state of the motion, the step that led here, and its row of the `Columns`."""

    motion: MotionState
    step: Step
    row: Mapping[str, Any]  # numbers, and profiles of shape (nx + 1,) or (ny + 1,), by name

    @classmethod
    def of(cls, film: TransientFilm, motion: MotionState, load: float, step: Step) -> Entry:
        """Entry of the film as it is."""
        level = film.level
        h_midplane, p_midplane = film.midplane
        row: dict[str, Any] = {
            "t": motion.T,
            "approach": motion.u,
            "rate": motion.rate,
            "acceleration": motion.acceleration,
            "force": level.force(),
            "load": load,
            "h_central": level.central_film(),
            "h_min": level.lowest_film(),
            "residuals": step.residual,
            "load_residuals": step.load_residual,
            "cycles": step.cycles,
            "h_midplane": h_midplane,
            "p_midplane": p_midplane,
        }
        behind = level.leaving()
        if behind.size:
            row["layer_behind"] = behind
        for effect in film.effects:
            row |= effect.columns()
        return cls(motion, step, row)

    @classmethod
    def of_row(cls, row: Mapping[str, Any]) -> Entry:
        """Entry of a step that was solved, from its row."""
        motion = MotionState(row["t"], row["approach"], row["rate"], row["acceleration"])
        step = Step(row["residuals"], row["load_residuals"], int(row["cycles"]), Status.CONVERGED)
        return cls(motion, step, row)


@dataclass(frozen=True, slots=True, eq=False)
class Record(Columns):
    """A history as arrays, in Moes units: what a checkpoint keeps and a result is made of."""

    @property
    def T(self) -> float:
        """Time reached."""
        return float(self.t[-1])

    def by_name(self) -> dict[str, Array]:
        """All columns that the run has."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return {name: column for name, column in values.items() if column is not None}

    def entries(self) -> list[Entry]:
        """The entries it was made of, each of which was solved."""
        declared = quantities_of(Record)
        over_t = {name: column for name, column in self.by_name().items() if declared[name].dims[0] == "t"}
        rows = zip(*(c.tolist() if c.ndim == 1 else c for c in over_t.values()), strict=True)
        return [Entry.of_row(dict(zip(over_t, row, strict=True))) for row in rows]


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
        taken = zip(record.snapshot_t.tolist(), record.snapshot_h, record.snapshot_p, strict=True)
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
            **{name: np.array([entry.row[name] for entry in rows], dtype=float) for name in rows[0].row},
            snapshot_t=np.array([T for T, _, _ in taken]),
            snapshot_h=np.array([H for _, H, _ in taken]).reshape(shape),
            snapshot_p=np.array([P for _, _, P in taken]).reshape(shape),
        )
