"""`simulate`: a motion drives the transient contact and the history is recorded."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Sequence
from math import ceil, inf

import numpy as np

from ehlcontact.checks import require_instance, require_nonnegative, require_positive
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.origin import __version__
from ehlcontact.point import Point, moes_point, scales_of
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.mesh import Purpose, mesh_for
from ehlcontact.status import Status
from ehlcontact.transient.checkpoint import Checkpoint, Task, load_checkpoint, require_replaceable
from ehlcontact.transient.film import TransientFilm
from ehlcontact.transient.motion import Motion
from ehlcontact.transient.record import History
from ehlcontact.transient.result import SimulationResult
from ehlcontact.transient.run import End, Run, march_controlled, march_fixed
from ehlcontact.transient.step import StepControl
from ehlcontact.transient.surface import Surface, surface_height

LARGEST_ERROR = 0.1
FIRST_STEP = 0.25  # of the motion's own step: what is tried first under error control
MOST_STEPS = 1_000_000  # in fixed steps
TOL_SHARE = 3.0  # tol over error: the last changes of force and approach are then a tenth of the error


def simulate(
    point: Point,
    motion: Motion,
    *,
    n: int | None = None,
    domain: Domain | None = None,
    until: float | None = None,
    dT: float | None = None,
    error: float | None = None,
    tol: float = 3e-3,
    snapshots: Sequence[float] = (),
    surface: Surface | None = None,
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
        Computed region; by default wide enough for the largest load of the motion.
    until, dT : float, optional
        End and (fixed) step of dimensionless time; the motion's own defaults otherwise. The step is shortened
        to divide `until` evenly. With `error`, `dT` is the step tried first.
    error : float, optional
        Steps are not fixed but controlled: the estimated local error of each, in approach (dry approaches), force
        (static loads) and mean film, stays below `error`. Corners of the motion, snapshots and `until` are met.
    tol : float
        Residual at which a step counts as solved, relative to the central film at rest; force and approach then
        change by less than tol/30 in the last cycle. With `error`, at most ``3 error``.
    snapshots : sequence of float
        Times whose whole fields are kept.
    surface : callable, optional
        Feature G(X, Y, T) added to the gap, even in Y; see `surface`. At rest for T <= 0.
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
        Checkpoint to go on from. The other arguments must be those of its run (`until` may be later, if the step
        still divides it); the record then equals that of an uninterrupted run bit for bit.

    Returns
    -------
    SimulationResult
        Ctrl-C ends it early with status ``interrupted`` and all steps done so far.

    Raises
    ------
    InputError
        An argument outside its range; a checkpoint that cannot be written, or is not one of this run.
    ConvergenceError
        A step did not converge, or did not meet `error` however short (status ``step_too_small``);
        ``error.result`` holds the history so far.
    """
    started = time.perf_counter()
    task, end_time = _task(point, motion, n, domain, until, dT, error, tol, snapshots)
    require_nonnegative("checkpoint_every", checkpoint_every)
    if not (surface is None or callable(surface)):
        raise InputError("surface", surface, "a function of X, Y and T, or None")
    if checkpoint is not None:
        require_replaceable(checkpoint, restart)
    film = TransientFilm(task.point, task.domain, task.n, task.tol)
    earlier = None
    if restart is not None:
        earlier = load_checkpoint(restart)
        earlier.check(task, end_time, surface, film.level, restart)
    spent = earlier.seconds if earlier else 0.0
    written = -inf

    def seconds() -> float:
        return spent + time.perf_counter() - started

    def store(run: Run) -> None:
        nonlocal written
        if checkpoint is not None:
            Checkpoint.of(run, task, seconds()).save(checkpoint)
            written = time.perf_counter()

    def watch(run: Run) -> None:
        if time.perf_counter() - written >= checkpoint_every:
            store(run)
        if callback is not None and run.state.T > 0.0:
            callback(run.state.T, end_time)

    if earlier:
        run = Run(film, motion, surface, earlier.history(snapshots), earlier.step_control(), watch)
        run.resume(earlier.film_state(), earlier.scale, earlier.static_approach)
        end = End(Status.CONVERGED)
    else:
        control = None if error is None else StepControl(error, task.dT)
        run = Run(film, motion, surface, History(snapshots), control, watch)
        end = End(run.start())
    if end.status.ok:
        try:
            if error is None:
                end = march_fixed(run, round(end_time / task.dT), earlier.dT if earlier else task.dT)
            else:
                end = march_controlled(run, end_time)
        except KeyboardInterrupt:
            end = End(Status.INTERRUPTED)
        store(run)
    result = _collect(run, task, point, end.status, seconds())
    if throw and not end.status.ok and end.status is not Status.INTERRUPTED:
        G = surface_height(surface, film.level.X, film.level.Y, float(result.T[-1]))
        raise ConvergenceError(_message(result, end, -float(np.min(G))), result)
    return result


def _task(
    point: Point,
    motion: Motion,
    n: int | None,
    domain: Domain | None,
    until: float | None,
    dT: float | None,
    error: float | None,
    tol: float,
    snapshots: Sequence[float],
) -> tuple[Task, float]:
    """Checked arguments with their defaults, and the end of the run."""
    moes = moes_point(point)
    require_instance("motion", motion, Motion, "a motion such as FreeVibration or HarmonicLoad")
    mesh = mesh_for(moes, Purpose.RUN, n=n, domain=domain, largest_load=motion.largest_load)
    end = motion.default_end if until is None else require_positive("until", until)
    tol = require_positive("tol", tol)
    default = motion.default_step
    if error is not None:
        if not require_positive("error", error) <= LARGEST_ERROR:
            raise InputError("error", error, f"above 0 and at most {LARGEST_ERROR}")
        tol = min(tol, TOL_SHARE * error)
        default = min(FIRST_STEP * default, end)
    dT = default if dT is None else require_positive("dT", dT)
    if dT > end:
        raise InputError("dT", dT, f"at most until = {end!r}")
    if error is None:
        if end / dT > MOST_STEPS:
            raise InputError(
                "dT", dT, f"at least until/{MOST_STEPS:,}".replace(",", " ") + f" = {end / MOST_STEPS:g}"
            )
        dT = end / ceil(end / dT - 1e-9)
    if not isinstance(snapshots, Iterable):
        raise InputError("snapshots", snapshots, "a list of times")
    for T in snapshots:
        if not require_nonnegative("snapshots", T) <= end * (1.0 + 1e-9):
            raise InputError("snapshots", T, f"at most until = {end!r}")
    return Task(moes, mesh.domain, mesh.n, motion, tol, dT, error, tuple(snapshots)), end


def _collect(run: Run, task: Task, point: Point, status: Status, seconds: float) -> SimulationResult:
    numbers, motion, level = run.history.columns(), task.motion, run.film.level
    T = numbers["T"]
    if T.size > 2:
        integrated = numbers["approach"], numbers["rate"], numbers["acceleration"]
        numbers["rate"], numbers["acceleration"] = motion.slopes(T, *integrated)
    h_midplane, p_midplane = run.history.profiles()
    snapshot_T, snapshot_H, snapshot_P = run.history.snapshot_arrays((level.nx + 1, level.ny + 1))
    return SimulationResult(
        point=task.point,
        scales=scales_of(point),
        domain=task.domain,
        n=task.n,
        motion=motion,
        X=level.X.copy(),
        Y=level.Y.copy(),
        **numbers,
        h_midplane=h_midplane,
        p_midplane=p_midplane,
        snapshot_T=snapshot_T,
        snapshot_H=snapshot_H,
        snapshot_P=snapshot_P,
        static_approach=run.static_approach,
        status=status,
        seconds=seconds,
        version=__version__,
    )


def _message(result: SimulationResult, end: End, highest: float) -> str:
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
