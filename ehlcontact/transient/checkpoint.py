"""Checkpoints: everything a simulation needs to go on bit for bit, in one HDF5 file.

What drives the run (point, motion, grid, tolerances) is stored to be compared, not to be used: whoever restarts
says again what is wanted, and a file of anything else is refused.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import hdf5
from ehlcontact.errors import InputError
from ehlcontact.origin import __version__
from ehlcontact.point import MoesPoint
from ehlcontact.solver.coarse import Factors
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Level
from ehlcontact.status import Status
from ehlcontact.transient.film import FilmState, Step
from ehlcontact.transient.motion import Motion, MotionState
from ehlcontact.transient.record import Array, Entry, History
from ehlcontact.transient.run import Run
from ehlcontact.transient.step import StepControl
from ehlcontact.transient.surface import Surface, surface_height


@dataclass(frozen=True, slots=True)
class Task:
    """What a run was asked for: a restart must be asked for the same."""

    point: MoesPoint
    domain: Domain
    n: int
    motion: Motion
    tol: float
    dT: float  # fixed step, or the first one under error control
    error: float | None
    snapshots: tuple[float, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Checkpoint:
    """Contents of the file."""

    # the task
    point: MoesPoint
    domain: Domain
    n: int
    motion: Motion
    tol: float
    dT: float
    error: float | None
    snapshots: list[float]
    # the record
    numbers: Array  # (entries, columns), see `history.COLUMNS`
    film: Array  # (entries, nx + 1)
    pressure: Array  # (entries, nx + 1)
    snapshot_T: Array  # (k,)
    snapshot_H: Array  # (k, nx + 1, ny + 1)
    snapshot_P: Array  # (k, nx + 1, ny + 1)
    # the present state
    control: list[float]  # step, last_error, first; empty in fixed steps
    static_approach: float
    scale: float
    P: Array
    past_steps: Array  # (0 to 2,)
    past_pressures: Array  # (0 to 2, ny + 1, nx + 1)
    mass: Array
    mass_before: Array
    last_step: float
    surface: Array  # (ny + 1, nx + 1), or () without one
    # LU factors of the coarsest grid, kept from step to step: dropping them would change the rounding
    lu: Array
    pivots: NDArray[np.int32]
    free_nodes: NDArray[np.intp]
    equation: list[float]
    seconds: float
    version: str

    @classmethod
    def of(cls, run: Run, task: Task, seconds: float) -> Checkpoint:
        """Contents for the last sound state of `run`."""
        kept = run.kept
        film, factors, control = kept.film, kept.film.factors, kept.control
        entries = run.history.entries[: kept.entries]
        known = History(())
        known.entries = entries
        known.snapshots = [s for s in run.history.snapshots if s[0] <= entries[-1].motion.T]
        profiles = known.profiles()
        level = run.film.level
        times, H, P = known.snapshot_arrays((level.nx + 1, level.ny + 1))
        return cls(
            point=task.point,
            domain=task.domain,
            n=task.n,
            motion=task.motion,
            tol=task.tol,
            dT=task.dT,
            error=task.error,
            snapshots=list(task.snapshots),
            numbers=np.array([entry.numbers() for entry in entries]),
            film=profiles[0],
            pressure=profiles[1],
            snapshot_T=times,
            snapshot_H=H,
            snapshot_P=P,
            control=[] if control is None else [control.step, control.last_error, control.first],
            static_approach=run.static_approach,
            scale=run.film.scale,
            P=film.P,
            past_steps=np.array([step for step, _ in film.past]),
            past_pressures=np.array([P for _, P in film.past]),
            mass=film.mass,
            mass_before=film.mass_before,
            last_step=film.dT,
            surface=np.asarray(film.surface),
            lu=np.empty((0, 0)) if factors is None else factors.lu[0],
            pivots=np.empty(0, dtype=np.int32) if factors is None else factors.lu[1],
            free_nodes=np.empty(0, dtype=np.intp) if factors is None else factors.free,
            equation=[] if factors is None else list(factors.equation),
            seconds=seconds,
            version=__version__,
        )

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Replace the file in one move.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        return hdf5.write(self, path, "checkpoint")

    def history(self, wanted: Sequence[float]) -> History:
        """Record so far, with those of the `wanted` snapshots that are still to come."""
        history = History([T for T in wanted if T > self.T])
        for row, film, pressure in zip(self.numbers.tolist(), self.film, self.pressure, strict=True):
            T, u, rate, acceleration, force, load, h_central, h_min, residual, load_residual, cycles = row
            step = Step(residual, load_residual, int(cycles), Status.CONVERGED)
            motion = MotionState(T, u, rate, acceleration)
            history.entries.append(Entry(motion, force, load, h_central, h_min, film, pressure, step))
        history.snapshots = list(zip(self.snapshot_T.tolist(), self.snapshot_H, self.snapshot_P, strict=True))
        return history

    def film_state(self) -> FilmState:
        """The film at the end of the record."""
        factors = None
        if self.equation:
            c_t, stiffness, weight = self.equation
            # LAPACK's order, in which the factors came: the other one is solved with other rounding
            lu = np.asfortranarray(self.lu)
            factors = Factors((lu, self.pivots), self.free_nodes.astype(np.intp), (c_t, stiffness, weight))
        return FilmState(
            P=self.P,
            past=tuple(zip(self.past_steps.tolist(), self.past_pressures, strict=True)),
            mass=self.mass,
            mass_before=self.mass_before,
            u=float(self.numbers[-1, 1]),
            dT=self.last_step,
            surface=self.surface if self.surface.ndim else 0.0,
            factors=factors,
        )

    def step_control(self) -> StepControl | None:
        """The step control as it was; None in fixed steps."""
        if self.error is None:
            return None
        step, last_error, first = self.control
        return StepControl(self.error, step, last_error, int(first))

    @property
    def T(self) -> float:
        """Time reached."""
        return float(self.numbers[-1, 0])

    def check(
        self, task: Task, until: float, surface: Surface | None, level: Level, path: str | os.PathLike[str]
    ) -> None:
        """Raise `InputError` naming the first item that is not as in `task`.

        A surface is a function and cannot be stored: its heights at the time reached must be the same.
        """

        def same(item: str, stored: Any, asked: Any) -> None:
            if stored != asked:
                raise InputError(
                    "restart",
                    str(path),
                    f"a checkpoint of this run: its {item} is {_brief(stored)}, asked for is {_brief(asked)}",
                )

        same("version", self.version, __version__)
        for name in ("point", "domain", "n", "error", "tol"):
            same(name, getattr(self, name), getattr(task, name))
        ours, theirs = self.motion.to_dict(), task.motion.to_dict()
        for key in ours:
            same(f"motion.{key}", ours[key], theirs.get(key))
        if self.error is None and abs(self.dT - task.dT) > 1e-12 * self.dT:
            same("dT", self.dT, task.dT)
        if any(T <= self.T and T not in self.snapshots for T in task.snapshots):
            same("snapshots", self.snapshots, list(task.snapshots))
        if until < self.T:
            raise InputError("until", until, f"at least {self.T!r}, which the checkpoint has reached")
        height = np.asarray(surface_height(surface, level.X, level.Y, self.T))
        if height.shape != self.surface.shape or not np.array_equal(height, self.surface):
            same("surface", _heights(self.surface, self.T), _heights(height, self.T))


def load_checkpoint(path: str | os.PathLike[str]) -> Checkpoint:
    """Read a checkpoint.

    Raises
    ------
    InputError
        No such file, not a checkpoint, truncated, or written by a newer version.
    """
    checkpoint: Checkpoint = hdf5.read(
        path, {Checkpoint.__name__: Checkpoint}, "restart", "checkpoint of `simulate`"
    )
    return checkpoint


def require_replaceable(path: str | os.PathLike[str], restart: str | os.PathLike[str] | None) -> None:
    """Raise `InputError` if writing checkpoints to `path` would lose a file that the run does not go on from."""
    target = Path(path)
    if target.exists() and not (restart is not None and Path(restart).exists() and target.samefile(restart)):
        raise InputError(
            "checkpoint", str(path), "a new file, or the one given as restart (this one exists, and would be lost)"
        )


def _brief(value: Any) -> str:
    return str(value) if isinstance(value, MoesPoint | Domain | str) else shortened(value)


def _heights(G: Array, T: float) -> str:
    if not G.ndim:
        return "none"
    return f"{G.min():.8g} .. {G.max():.8g} (rms {np.sqrt(np.mean(G * G)):.8g}) at T = {T:.6g}"
