"""`simulate`: a motion drives the transient contact and the history is recorded."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ehlcontact.checks import require_instance, require_nonnegative
from ehlcontact.checks.machine import require_threads
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import Point, Scales, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.mesh import Mesh, Purpose, mesh_for, require_room, wider_meshes
from ehlcontact.status import Status
from ehlcontact.store import load
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.checkpoint import Checkpoint, CheckpointError, Keeper, require_replaceable
from ehlcontact.transient.film import TransientFilm
from ehlcontact.transient.record import History
from ehlcontact.transient.result import SimulationResult
from ehlcontact.transient.roughness import Roughness
from ehlcontact.transient.run import Run, RunEnd, march
from ehlcontact.transient.settings import RunSettings, TimeSteps
from ehlcontact.transient.surface import Dent, Surface, require_surface, surface_height
from ehlcontact.transient.time_step import StepControl, default_fixed_step

LARGEST_MISMATCH = 0.01  # of the kappa of a feature, over that of the contact


@one_blas_thread()
def simulate(
    point: Point,
    motion: Motion,
    *,
    n: int | None = None,
    domain: Domain | None = None,
    until: float | None = None,
    dT: float | None = None,
    error: float | None = None,
    tol: float | None = None,
    snapshots: Sequence[float] = (),
    surface: Surface | None = None,
    deflection: str = "fft",
    threads: int | None = None,
    throw: bool = True,
    callback: Callable[[float, float], None] | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_every: float = 60.0,
    restart: str | os.PathLike[str] | None = None,
) -> SimulationResult:
    """Integrate the transient contact (eqs. 1, 3, 5, 6) from rest under the given motion.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    motion : FreeVibration, HarmonicLoad, RampLoad, PrescribedLoad or PrescribedApproach
    n : int, optional
        Intervals along X, a multiple of 16; by default as many as the inlet needs, 128 or more.
    domain : Domain, optional
        Computed region; by default wide enough for the largest load of the motion. Where the film leaves that one,
        the run begins again on a wider one.
    until, dT : float, optional
        End and (fixed) step of dimensionless time; the motion's own defaults otherwise. That of the step is at
        most 0.1 for tables and ramps and 0.5 for other motions; over a feature a fortieth of the time in which its
        wave passes (a tenth of a dent's radius), over `Roughness` and functions of one's own a node's. The step is
        shortened to divide `until` evenly. With `error`, `dT` is the step tried first.
    error : float, optional
        Steps are not fixed but controlled: the estimated local error of each, in approach (dry approaches), force
        (static loads) and mean film, stays below `error`. Corners of the motion, snapshots and `until` are met.
        Over a run they add up, to about ``error**(2/3)`` where bodies have inertia (docs/solver.md): for approach
        and force within g all the way give ``error = g**1.5``.
    tol : float, optional
        Residual at which a step counts as solved, relative to the central film at rest; force and approach then
        change by less than tol/30 in the last cycle. By default 0.003, and where a load moves less than 0.1 of the
        static one, or a vibration less than 0.1 dry approaches, in proportion less (1e-6 at least), so that the
        motion is told to the same share. With `error`, at most ``3 error``.
    snapshots : sequence of float
        Times whose whole fields are kept.
    surface : callable, optional
        Feature G(X, Y, T) added to the gap, even in Y: `Dent`, `TransverseRidge`, `Waviness`, `Roughness`, or a
        function of one's own. At rest for T <= 0. One made for another `kappa` is warned of.
    deflection : {"fft", "mlmi", "direct"}
        Engine of the elastic deflection, as in `solve_steady`.
    threads : int, optional
        As in `solve_steady`.
    throw : bool
        Raise on failure; otherwise look at ``result.status``.
    callback : callable, optional
        Called with T and `until` after every step.
    checkpoint : path, optional
        HDF5 file, new or that of `restart`; replaced, in one move, every `checkpoint_every` seconds (0: after
        every step) and at the end, once the start was solved.
    checkpoint_every : float
        Seconds between checkpoints.
    restart : path, optional
        Checkpoint to go on from. The other arguments must be those of its run, except `threads`; the record then
        equals that of an uninterrupted run bit for bit. `until` may be later: the stored step goes on, and ends at
        or, where it does not divide `until`, within a step after it.

    Returns
    -------
    SimulationResult
        Ctrl-C ends it early with status ``interrupted`` and all steps done so far.

    Raises
    ------
    InputError
        An argument outside its range; a grid that would not fit into memory; a checkpoint that cannot be written,
        or is not one of this run. Only the first checkpoint ends the run; of the last, ``error.result`` holds the
        run all the same.
    ConvergenceError
        A step did not converge, or did not meet `error` however short (status ``step_too_small``);
        ``error.result`` holds the history so far.
    """
    started = time.perf_counter()
    require_instance("motion", motion, Motion, "a motion such as FreeVibration or HarmonicLoad")
    moes = require_solvable(point, motion.largest_load)
    mesh = mesh_for(moes, Purpose.RUN, n=n, domain=domain, largest_load=motion.largest_load)
    require_room(mesh, moes)
    require_surface(surface)
    _warn_of_shape(surface, moes.kappa)
    spacing = (mesh.domain.x_out - mesh.domain.x_in) / mesh.n
    steps = TimeSteps.of(motion, until, dT, error, tol, default_fixed_step(motion, surface, spacing))
    settings = RunSettings.of(moes, mesh, motion, steps, snapshots, deflection)
    require_nonnegative("checkpoint_every", checkpoint_every)
    if checkpoint is not None:
        require_replaceable(checkpoint, restart)
    threads = require_threads("threads", threads)
    meshes = wider_meshes(mesh, moes, Purpose.RUN, n=n, domain=domain)

    def film_on(mesh: Mesh) -> TransientFilm:
        film = TransientFilm(moes, mesh, steps.tol, deflection, threads)
        if isinstance(surface, Roughness):
            surface.require_fit(film.level.X, film.level.Y, steps.until)
        return film

    earlier = None
    if restart is not None:
        earlier = load(restart, Checkpoint, "restart")
        mesh = next((wider for wider in meshes if wider == earlier.settings.mesh), mesh)
        film = film_on(mesh)
        earlier.check(replace(settings, mesh=mesh), dT, surface, film.level, restart)
        started -= earlier.seconds
        steps = steps.going_on(earlier.settings.steps)
        # the step follows from the end first asked for
        settings = replace(settings, mesh=mesh, steps=earlier.settings.steps)
    keeper = Keeper(checkpoint, checkpoint_every, settings, started)

    def watch(run: Run) -> None:
        keeper.visit(run)
        if callback is not None and run.state.T > 0.0:
            callback(run.state.T, steps.until)

    def from_rest(mesh: Mesh) -> tuple[Run, RunEnd]:
        keeper.settings = replace(settings, mesh=mesh)
        film = film_on(mesh)
        control = None if error is None else StepControl(error, steps.dT)
        run = Run(film, motion, surface, History(settings.snapshots), control, watch)
        end = RunEnd(run.start())
        return run, march(run, steps) if end.status.ok else end

    if earlier is None:
        mesh, run, end = _first_inside(meshes, from_rest)
        settings = keeper.settings = replace(settings, mesh=mesh)
    else:
        run = Run(film, motion, surface, History.of(earlier.record, settings.snapshots), earlier.control, watch)
        run.resume(earlier.film, earlier.scale, earlier.static_approach, earlier.film_error)
        end = march(run, steps)
    unkept = None
    if run.history.entries[0].step.status.ok:  # there is a start to go on from
        try:
            keeper.write(run)
        except InputError as lost:
            unkept = lost
        except KeyboardInterrupt:  # a second one; the file is what it was
            end = RunEnd(Status.INTERRUPTED)
    result = _result(run, settings, scales_of(point), end.status, time.perf_counter() - started)
    if throw and not end.status.ok and end.status is not Status.INTERRUPTED:
        G = surface_height(surface, result.X, result.Y, float(result.T[-1]))
        raise ConvergenceError(_message(result, end, -float(np.min(G))), result)
    if unkept is not None:
        raise CheckpointError(unkept, result)
    return result


def _warn_of_shape(surface: Surface | None, kappa: float) -> None:
    """Say where a feature that is to be round in metres is made for another contact."""
    if isinstance(surface, Dent | Roughness) and abs(surface.kappa - kappa) > LARGEST_MISMATCH * kappa:
        warnings.warn(
            f"kappa = {surface.kappa:.4g} of the surface is not that of the contact, {kappa:.4g}: what it takes "
            f"for round is {surface.kappa / kappa:.3g} times as long across as along, in metres",
            RuntimeWarning,
            stacklevel=4,
        )


def _first_inside(
    meshes: Iterator[Mesh], attempt: Callable[[Mesh], tuple[Run, RunEnd]]
) -> tuple[Mesh, Run, RunEnd]:
    """The run on the first mesh whose region holds the film; that on the very first where none helps."""
    left: tuple[Mesh, Run, RunEnd] | None = None
    for mesh in meshes:
        run, end = attempt(mesh)
        if end.status is not Status.OUT_OF_DOMAIN:
            break
        left = left or (mesh, run, end)
    helped = end.status.ok or end.status is Status.INTERRUPTED
    return left if left is not None and not helped else (mesh, run, end)


def _result(
    run: Run, settings: RunSettings, scales: Scales | None, status: Status, seconds: float
) -> SimulationResult:
    level, record = run.film.level, run.history.record(run.film.level)
    numbers: dict[str, Any] = record.columns()
    if numbers["T"].size > 2:
        columns = (numbers[name] for name in ("T", "approach", "rate", "acceleration"))
        numbers["rate"], numbers["acceleration"] = settings.motion.slopes(*columns)
    return SimulationResult(
        point=settings.point,
        scales=scales,
        domain=settings.mesh.domain,
        n=settings.mesh.n,
        motion=settings.motion,
        X=level.X.copy(),
        Y=level.Y.copy(),
        **numbers,
        h_midplane=record.film,
        p_midplane=record.pressure,
        snapshot_T=record.snapshot_T,
        snapshot_H=record.snapshot_H,
        snapshot_P=record.snapshot_P,
        static_approach=run.static_approach,
        status=status,
        tol=settings.steps.tol,
        film_error=run.film_error,
        seconds=seconds,
    )


def _message(result: SimulationResult, end: RunEnd, highest: float) -> str:
    """Status, time, what is known of step, force and the height of the surface, and advice."""
    notes = [end.note] if end.note else []
    if end.status is Status.OUT_OF_DOMAIN:
        notes.append(f"force so far {result.force.max():.3g} static loads")
    if end.status is not Status.OUT_OF_DOMAIN and highest > abs(result.h_min[-1]):
        notes.append(
            f"the surface stands out by {highest:.3g} dry approaches: one that closes the gap has no film"
        )
    note = f" ({', '.join(notes)})" if notes else ""
    return f"simulation {end.status} at T = {result.T[-1]:.6g}{note}: {end.status.advice}"
