"""Checkpoints: everything that a simulation needs to go on, bit for bit, in one HDF5 file.

A restart takes the inputs of the run (point, motion, grid, tolerances) again as arguments. Those in the file are
only compared with them, and a file of other inputs is refused.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, fields
from math import inf, isfinite
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

import numpy as np

from ehlcontact.conditions import KEYWORDS
from ehlcontact.errors import InputError, warn_user
from ehlcontact.heat import Heat
from ehlcontact.point import MoesPoint
from ehlcontact.quantities import quantities_of
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.level import Level
from ehlcontact.store import save, stored
from ehlcontact.transient.features import Surface, surface_height
from ehlcontact.transient.heat_over_time import HeatState
from ehlcontact.transient.record import OF_HEAT, Array, Record
from ehlcontact.transient.run import Run
from ehlcontact.transient.settings import RunInputs, even_step
from ehlcontact.transient.time_step import StepControl
from ehlcontact.transient.transient_film import FilmState
from ehlcontact.version import __version__

SAME = 1e-12  # of a time or a step: they differ by rounding only


@stored("checkpoint of `simulate`", 4)
@dataclass(frozen=True, slots=True, eq=False)
class Checkpoint:
    """Content of the file: the run up to its last accepted state, and that state."""

    inputs: RunInputs
    record: Record
    film: FilmState  # with the LU factors of the coarsest grid: to make them anew would change the rounding
    control: StepControl | None  # None in fixed steps
    scale: float  # of the residuals
    static_approach: float  # of the steady state under load 1 / dry approach
    seconds: float  # that it took
    version: str
    film_error: ErrorEstimate | None  # of the film at T = 0
    temperature: FilmTemperature | None  # likewise

    @classmethod
    def of(cls, run: Run, inputs: RunInputs, seconds: float) -> Checkpoint:
        """Content for the last accepted state of `run`."""
        kept = run.kept
        return cls(
            inputs=inputs,
            record=run.history.record(run.film.level, kept.entries),
            film=kept.film,
            control=kept.control,
            scale=run.film.scale,
            static_approach=run.static_approach,
            seconds=seconds,
            version=__version__,
            film_error=run.film_error,
            temperature=run.film.temperature,
        )

    def check(
        self,
        asked: RunInputs,
        dT: float | None,
        surface: Surface | None,
        level: Level,
        path: str | os.PathLike[str],
    ) -> None:
        """Raise `InputError` naming the first item that is not as `asked` for.

        A surface is a function and cannot be stored: its heights at the time reached must be the same. The step
        depends on the end: `dT`, the dimensionless step that is given, must give the stored step with the end of
        the first run.
        """

        def same(item: str, stored: Any, wanted: Any) -> None:
            if stored != wanted:
                first, second = _apart(stored, wanted)
                what = f"its {item} is {first}, asked for is {second}"
                raise InputError("restart", str(path), f"a checkpoint of this run: {what}")

        same("version", self.version, __version__)
        ours = self.inputs
        for name in ("point", "deflection"):
            same(name, getattr(ours, name), getattr(asked, name))
        for name, keyword in KEYWORDS.items():
            same(keyword, getattr(ours.conditions, name), getattr(asked.conditions, name))
        for name in ("n", "domain"):
            same(name, getattr(ours.mesh, name), getattr(asked.mesh, name))
        for name in ("local_error", "tol"):
            same(name, getattr(ours.steps, name), getattr(asked.steps, name))
        theirs = asked.motion.to_dict()
        for key, value in ours.motion.to_dict().items():
            same(f"motion.{key}", value, theirs.get(key))
        speeds = [None if one.speed is None else one.speed.to_dict() for one in (ours, asked)]
        same("speed", *speeds)
        if ours.steps.local_error is None and dT is not None:
            wanted = even_step(ours.steps.until, min(dT, ours.steps.until))
            if abs(ours.steps.dT - wanted) > SAME * ours.steps.dT:
                same("dT", ours.steps.dT, dT)
        if not self._fits(level):
            raise InputError("restart", str(path), "a complete checkpoint of `simulate`: its arrays do not fit")
        T = self.record.T
        if any(t <= T and t not in ours.snapshots for t in asked.snapshots):
            same("snapshots", list(ours.snapshots), list(asked.snapshots))
        if asked.steps.until < T * (1.0 - SAME):
            raise InputError("until", asked.steps.until, f"at least {T!r}, which the checkpoint has reached")
        known, height = np.asarray(self.film.surface), np.asarray(surface_height(surface, level.X, level.Y, T))
        if self.film.turned and height.ndim:
            height = height[..., ::-1]
        if height.shape != known.shape or not np.array_equal(height, known):
            same("surface", _heights(known, T), _heights(height, T))

    def _fits(self, level: Level) -> bool:
        """Whether all arrays have the shapes of each other and of the grid, and the state is one of numbers."""
        film, field, conditions = self.film, level.P.shape, self.inputs.conditions
        columns, declared = self.record.by_name(), quantities_of(Record)
        absent = {"layer_behind"} if conditions.supply is None else set[str]()
        absent |= set(OF_HEAT) if conditions.heat is None else set()
        if columns.keys() != {f.name for f in fields(Record)} - absent:
            return False
        steps = columns["t"].size
        sizes = {"t": steps, "x": level.nx + 1, "y": level.ny + 1, "snapshot_t": columns["snapshot_t"].size}
        shapes: list[tuple[np.ndarray, tuple[int, ...]]] = [
            *((array, tuple(sizes[dim] for dim in declared[name].dims)) for name, array in columns.items()),
            *((array, shape) for state in film.effects for array, shape in _of_heat(state, field)),
            *((array, field) for array in (film.P, film.mass, film.mass_before, *(P for _, P in film.past))),
            *((array, field) for array in (film.heating, film.aside) if array is not None),
        ]
        sound = steps > 0 and all(array.shape == shape and np.isfinite(array).all() for array, shape in shapes)
        if film.factors is not None:
            unknowns = film.factors.free.size + 1
            sound &= film.factors.lu[0].shape == (unknowns, unknowns)
            sound &= film.factors.lu[1].shape == (unknowns,)
        following = [one for one in (conditions.heat, conditions.sliding) if one is not None]
        sound &= [isinstance(one, HeatState) for one in film.effects] == [
            isinstance(one, Heat) for one in following
        ]
        sound &= (film.heating is not None) == bool(following)
        sound &= (film.aside is not None) == (conditions.sliding is not None)
        controlled = (self.control is not None) == (self.inputs.steps.local_error is not None)
        return sound and controlled and all(isfinite(x) for x in (self.scale, self.static_approach, film.u))


class CheckpointError(InputError):
    """A run came to its end, but its last checkpoint could not be written; ``result`` holds the run."""

    def __init__(self, error: InputError, result: Any) -> None:
        super().__init__(error.field, error.value, error.allowed)
        self.result = result


class Keeper:
    """Writes the checkpoints of a run that began at `started`, if `path` says where.

    One that cannot be written is tried again when the next is due, and at the end: a run goes on without. Only the
    first ends it, before anything is lost.
    """

    def __init__(self, path: str | os.PathLike[str] | None, every: float, inputs: RunInputs, started: float):
        self.path, self.every, self.inputs, self.started = path, every, inputs, started
        self._tried = -inf
        self._failed = False

    def visit(self, run: Run) -> None:
        """Write if the last one is old enough.

        Raises
        ------
        InputError
            The first one cannot be written.
        """
        if time.perf_counter() - self._tried < self.every:
            return
        first = self._tried == -inf
        try:
            self.write(run)
        except InputError as error:
            if first:
                raise
            if not self._failed:
                warn_user(f"{error}; the run goes on, the last checkpoint stays", RuntimeWarning)
            self._failed = True

    def write(self, run: Run) -> None:
        """Replace the file in one move.

        Raises
        ------
        InputError
            It cannot be written.
        """
        if self.path is not None:
            self._tried = time.perf_counter()
            checkpoint = Checkpoint.of(run, self.inputs, self._tried - self.started)
            save(checkpoint, self.path, "checkpoint")
            self._failed = False


def require_replaceable(path: str | os.PathLike[str], restart: str | os.PathLike[str] | None) -> None:
    """Raise `InputError` if writing checkpoints to `path` would lose a file that the run does not go on from."""
    target = Path(path)
    if target.exists() and not (restart is not None and Path(restart).exists() and target.samefile(restart)):
        raise InputError(
            "checkpoint", str(path), "a new file, or the one given as restart (this one exists, and would be lost)"
        )


def _of_heat(heat: HeatState | None, field: tuple[int, ...]) -> list[tuple[np.ndarray, tuple[int, ...]]]:
    """Arrays of a state of temperatures, with the shapes that they should have."""
    if heat is None:
        return []
    fields = (heat.rise, *heat.stored, *heat.of_rise, *heat.pressure)
    pairs = (heat.walls, *(given for _, _, given in heat.given))
    return [*((array, field) for array in fields), *((array, (2, *field)) for array in pairs)]


def _apart(*values: Any) -> tuple[str, ...]:
    """Unequal values in words: points and domains by the entries in which they differ, with all their digits."""
    if all(isinstance(value, MoesPoint) for value in values) or all(isinstance(value, Domain) for value in values):
        names = [one.name for one in fields(values[0]) if len({getattr(value, one.name) for value in values}) > 1]
        return tuple(", ".join(f"{name}={getattr(value, name)!r}" for name in names) for value in values)
    return tuple(value if isinstance(value, str) else shortened(value) for value in values)


def _heights(G: Array, T: float) -> str:
    if not G.ndim:
        return "none"
    return f"{G.min():.8g} .. {G.max():.8g} (rms {np.sqrt(np.mean(G * G)):.8g}) at T = {T:.6g}"
