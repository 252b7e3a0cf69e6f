"""`simulate`: the transient contact under a motion, recorded as a history."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain
from time import perf_counter
from typing import Any

import numpy as np

from ehlcontact.checks import require_instance
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.machine import require_threads
from ehlcontact.checks.quantity import takes
from ehlcontact.conditions import Conditions, between_smooth_surfaces
from ehlcontact.errors import ConvergenceError, InputError, warn_user
from ehlcontact.heat import Heat
from ehlcontact.point import Point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import Purpose, wider_meshes
from ehlcontact.status import Status
from ehlcontact.store import read
from ehlcontact.supply import OilLayer
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.checkpoint import Checkpoint, CheckpointError, Keeper, require_replaceable
from ehlcontact.transient.features import Dent, Surface, require_surface, surface_height
from ehlcontact.transient.prescribed import passed_over_note, unit_hint
from ehlcontact.transient.record import History
from ehlcontact.transient.result import SimulationResult
from ehlcontact.transient.roughness import Roughness
from ehlcontact.transient.run import Run, RunEnd, march
from ehlcontact.transient.settings import (
    KeepSettings,
    RunInputs,
    RunSettings,
    StepPlan,
    TimeSteps,
    require_groups,
    snapshot_times,
)
from ehlcontact.transient.speed import SpeedHistory, require_speed, surface_at
from ehlcontact.transient.time_step import StepControl, default_fixed_step
from ehlcontact.transient.transient_film import TransientFilm

BY_MOTION, HISTORY_ONLY, UNATTENDED = TimeSteps(), KeepSettings(), RunSettings()  # the defaults
LARGEST_MISMATCH = 0.01  # of the kappa of a feature, over that of the contact


@takes(
    grid=Object(Grid, "a Grid"),
    time=Object(TimeSteps, "a TimeSteps"),
    keep=Object(KeepSettings, "a KeepSettings"),
    run=Object(RunSettings, "a RunSettings"),
    speed=Object(SpeedHistory, "a SpeedHistory"),
)
@between_smooth_surfaces
@one_blas_thread()
def simulate(
    point: Point,
    motion: Motion,
    *,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    sliding: ShearThinning | None = None,
    time: TimeSteps = BY_MOTION,
    speed: SpeedHistory | None = None,
    surface: Surface | None = None,
    keep: KeepSettings = HISTORY_ONLY,
    run: RunSettings = UNATTENDED,
) -> SimulationResult:
    """Integrate the transient contact (eqs. 1, 3, 5, 6) from rest under the given motion.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    motion : FreeVibration, HarmonicLoad, RampLoad, PrescribedLoad or PrescribedApproach
        Dimensionless at every point; its class method ``at(point, ...)`` takes seconds, newton and metres, for an
        `OperatingPoint`.
    grid : Grid
        Intervals along X, by default as many as the inlet needs, 128 or more; computed region, by default wide
        enough for the largest load of the motion (where the film leaves it, the run begins again on a wider one);
        engine of the elastic deflection.
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact, the same at all times, as in `solve_steady`. What leaves is
        ``result.layer_behind``. By default the inlet is flooded up to the border of the region. Where the surfaces
        turn back, they bring back what has left.
    thermal : Heat, or True for ``Heat()``, optional
        Let the film heat up: oil and surfaces store heat, and its viscosity follows in every step (docs/heat.md).
        By default the film has the temperature of the inlet.
    sliding : ShearThinning, optional
        Shear thinning of the film by sliding, as in `solve_steady`, in proportion to the speed of the surfaces.
    time : TimeSteps
        End, step, tolerances; in seconds for an `OperatingPoint`, in 2a/u_sum for a `MoesPoint`.
    speed : SpeedHistory, optional
        Speed of the surfaces over time, constant by default. The film begins steady at its first speed; all scales
        stay those of `point`. Where surfaces roll back, the region is as long behind the contact as ahead of it,
        and what is ahead then counts as flooded, but with a `supply`.
    surface : callable, optional
        Feature G(X, Y, T) added to the gap, even in Y: `Dent`, `TransverseRidge`, `Waviness`, `Roughness`, or a
        function of one's own. At rest for T <= 0. One made for another `kappa` gives a warning. With a `speed` it
        is called with the way of the surfaces, int U dT, in the place of T. Under a `supply` the layer lies on it.
    keep : KeepSettings
        Snapshots of whole fields, checkpoints, restart.
    run : RunSettings
        ``RunSettings(threads=, throw=, callback=)``: threads as in `solve_steady`; whether a failure is raised; a
        function that is called after every step.

    Returns
    -------
    SimulationResult
        Ctrl-C ends it early with status ``interrupted`` and all steps done so far.

    Raises
    ------
    InputError
        An argument outside its range; a motion or speed that ``at`` made for another point; a grid that would not
        fit into memory; a checkpoint that cannot be written, or is not one of this run. Only the first checkpoint
        ends the run; of the last, ``error.result`` holds the run all the same.
    ConvergenceError
        A step did not converge, or did not meet the local error however short (status ``step_too_small``);
        ``error.result`` holds the history so far.
    """
    started = perf_counter()
    require_instance("motion", motion, Motion, "a motion such as FreeVibration or HarmonicLoad")
    hint = unit_hint(motion, point)
    try:
        moes = require_solvable(point, motion.largest_load)
    except InputError as outside:
        if not hint:
            raise
        raise InputError(outside.field, outside.value, f"{outside.allowed}; {hint}") from None
    motion.require_point("motion", point)
    require_grid(grid)
    require_groups(time, keep, run)
    conditions = Conditions.of(supply=supply, thermal=thermal, sliding=sliding).at(point)
    require_surface(surface, point)
    require_speed(speed, grid, point)
    reverses = speed is not None and speed.reverses
    wider = wider_meshes(moes, Purpose.RUN, grid, largest_load=motion.largest_load, reverses=reverses)
    mesh = next(wider)
    meshes = chain([mesh], wider)
    _warn_of_shape(surface, moes.kappa)
    spacing = (mesh.domain.x_out - mesh.domain.x_in) / mesh.n
    unit = point.scales.time
    steps = StepPlan.of(motion, time, unit, default_fixed_step(motion, surface, spacing, speed))
    _warn_of_steps(point, motion, speed, steps)
    if hint:
        warn_user(f"the motion hardly fits this contact: {hint}", RuntimeWarning)
    inputs = RunInputs(
        moes, mesh, motion, steps, snapshot_times(keep, steps, unit), grid.deflection, speed, conditions
    )
    if keep.checkpoint is not None:
        require_replaceable(keep.checkpoint, keep.restart)
    threads = require_threads("threads", run.threads)

    def film_on(mesh: Mesh) -> TransientFilm:
        film = TransientFilm.under(conditions, moes, scales_of(point), mesh, steps.tol, grid.deflection, threads)
        if isinstance(surface, Roughness):
            way = steps.until if speed is None else speed.farthest(steps.until)
            surface.require_fit(film.level.X, film.level.Y, way)
        return film

    earlier = None
    if keep.restart is not None:
        earlier = read(keep.restart, Checkpoint, "restart")
        mesh = next((other for other in meshes if other == earlier.inputs.mesh), mesh)
        film = film_on(mesh)
        given = time.step_of(motion, unit)
        earlier.check(replace(inputs, mesh=mesh), given, surface_at(surface, speed), film.level, keep.restart)
        started -= earlier.seconds
        steps = steps.going_on(earlier.inputs.steps)
        # the step follows from the end first asked for
        inputs = replace(inputs, mesh=mesh, steps=earlier.inputs.steps)
    keeper = Keeper(keep.checkpoint, keep.checkpoint_every, inputs, started)

    def watch(under_way: Run) -> None:
        keeper.visit(under_way)
        if run.callback is not None and under_way.state.T > 0.0:
            run.callback(under_way.state.T * unit, steps.until * unit)

    def from_rest(mesh: Mesh) -> tuple[Run, RunEnd]:
        keeper.inputs = replace(inputs, mesh=mesh)
        film = film_on(mesh)
        control = None if steps.local_error is None else StepControl(steps.local_error, steps.dT)
        film_run = Run(film, motion, surface, History(inputs.snapshots), control, watch, speed)
        end = RunEnd(film_run.start())
        return film_run, march(film_run, steps) if end.status.ok else end

    if earlier is None:
        mesh, film_run, end = _first_inside(meshes, from_rest)
        inputs = keeper.inputs = replace(inputs, mesh=mesh)
    else:
        history = History.of(earlier.record, inputs.snapshots)
        film_run = Run(film, motion, surface, history, earlier.control, watch, speed)
        film.temperature = earlier.temperature
        film_run.resume(earlier.film, earlier.scale, earlier.static_approach, earlier.film_error)
        end = march(film_run, steps)
    unkept = None
    if film_run.history.entries[0].step.status.ok:  # there is a start to go on from
        try:
            keeper.write(film_run)
        except InputError as lost:
            unkept = lost
        except KeyboardInterrupt:  # a second one; the file is what it was
            end = RunEnd(Status.INTERRUPTED)
    own = _result(film_run, inputs, end.status, perf_counter() - started)
    result = own.in_units_of(point)
    if run.throw and not end.status.ok and end.status is not Status.INTERRUPTED:
        G = surface_height(film_run.surface, own.x, own.y, float(own.t[-1]))
        raise ConvergenceError(_message(own, end, -float(np.min(G))), result)
    if unkept is not None:
        raise CheckpointError(unkept, result)
    return result


def _warn_of_shape(surface: Surface | None, kappa: float) -> None:
    """Say where a feature that is to be round in metres is made for another contact."""
    if isinstance(surface, Dent | Roughness) and abs(surface.kappa - kappa) > LARGEST_MISMATCH * kappa:
        warn_user(
            f"kappa = {surface.kappa:.4g} of the surface is not that of the contact, {kappa:.4g}: what it takes "
            f"for round is {surface.kappa / kappa:.3g} times as long across as along, in metres",
            RuntimeWarning,
        )


def _warn_of_steps(point: Point, motion: Motion, speed: SpeedHistory | None, steps: StepPlan) -> None:
    """Say where fixed steps pass over changes of a table: most often its times are in another unit."""
    if steps.local_error is not None:
        return
    T = np.linspace(0.0, steps.until, round(steps.until / steps.dT) + 1)
    if note := passed_over_note((motion, speed), T, point):
        warn_user(note, RuntimeWarning)


def _first_inside(
    meshes: Iterator[Mesh], attempt: Callable[[Mesh], tuple[Run, RunEnd]]
) -> tuple[Mesh, Run, RunEnd]:
    """The run on the first mesh whose region holds the film; that on the very first where none helps."""
    left: tuple[Mesh, Run, RunEnd] | None = None
    for mesh in meshes:
        run, end = attempt(mesh)
        if end.status not in (Status.OUT_OF_DOMAIN, Status.BEYOND_REGION):
            break
        left = left or (mesh, run, end)
    helped = end.status.ok or end.status is Status.INTERRUPTED
    return left if left is not None and not helped else (mesh, run, end)


def _result(run: Run, inputs: RunInputs, status: Status, seconds: float) -> SimulationResult:
    """Result of a run, in Moes units."""
    level, supply = run.film.level, inputs.conditions.supply
    columns: dict[str, Any] = run.history.record(level).by_name()
    if columns["t"].size > 2:
        course = (columns[name] for name in ("t", "approach", "rate", "acceleration"))
        columns["rate"], columns["acceleration"] = inputs.motion.slopes(*course)
    return SimulationResult(
        point=inputs.point,
        domain=inputs.mesh.domain,
        n=inputs.mesh.n,
        motion=inputs.motion,
        speed=inputs.speed,
        x=level.X.copy(),
        y=level.Y.copy(),
        **columns,
        static_approach=run.static_approach,
        status=status,
        tol=inputs.steps.tol,
        film_error=run.film_error,
        seconds=seconds,
        supply=supply,
        layer=None if supply is None else level.inflow.copy(),
        sliding=inputs.conditions.sliding,
        temperature=run.film.temperature,
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
    return f"simulation {end.status} at T = {result.t[-1]:.6g}{note}: {end.status.advice}"
