"""`simulate_rotor`: a rotor on its supports over time, at constant speed, in a run-up or a coast-down."""

from __future__ import annotations

from collections.abc import Callable
from itertools import chain
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import TransientContact
from ehlcontact.checks import parts, require_instance, require_integer, require_positive, shown
from ehlcontact.checks.kinds import Callback, Count, Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError, warn_user
from ehlcontact.status import Status
from reduced_models.bearing.height_tables import LEAST_STEPS, shortest_meeting
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import beyond_loads
from reduced_models.bearing.solved_balls import damping_left_out, warn_of_damping_left_out
from reduced_models.elements.validity import OutsideValidityWarning, frequency_of
from reduced_models.life.history import BearingHistory
from reduced_models.rotor.contact_protocol import Contact
from reduced_models.rotor.integrate_compiled import CompiledSteps
from reduced_models.rotor.integrate_python import PythonSteps
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.nodes import flat_nodes
from reduced_models.rotor.prepared_run import Histories, PreparedRun
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.speed_profile import SpeedProfile, law_speeds
from reduced_models.rotor.supports import bearing_names, is_damper

_Floats = NDArray[np.float64]

COMPILED_TOLERANCE, TOLERANCE = 1e-9, 1e-6  # on ball bearings alone; with contacts
MOST_STEPS = 20_000_000  # of a run: every step is kept in memory, 3 GB of twenty signals

Integrator = CompiledSteps | PythonSteps


@takes(
    rotor=Object(Rotor, "a Rotor"),
    speed_rpm="rev/min",
    dt=parts.STEP,
    until=parts.SECONDS,
    max_iterations=Count(1, 100_000),
    callback=Callback("step, steps"),
    rho_inf=parts.SHARE,
)
def simulate_rotor(
    rotor: Rotor,
    *,
    speed_rpm: float | SpeedProfile | None = None,
    dt: float,
    until: float,
    start: Any = "static",
    tolerance: float | None = None,
    max_iterations: int = 30,
    rho_inf: float = 0.8,
    callback: Callable[[int, int], object] | None = None,
) -> RotorResult:
    """Integrate a rotor on its supports from t = 0 to `until` in steps of `dt`.

    Generalised-alpha steps (second order); everything linear is condensed onto the points at which supports act,
    so that each step solves only for their motion, by Newton's method with exact tangents, or secants for contacts
    that have none. On ball bearings and squeeze film dampers alone rotor, bearings, balls and films run in one
    loop in C. Contacts run in Python; every evaluation starts each contact from its state at the start of the
    step.

    Elements warn, once: before the run where the rotor's speed lies outside their band, or a mount has the point
    of another contact than they were made for; after it where it left their validity box. A bearing of which a
    ball carried more than the atlas has warns after the run, and so does, once, one whose elements leave out
    damping below zero under its oil supply (docs/oil_supply.md).

    Parameters
    ----------
    rotor : Rotor
        Its contacts in SI, those with a memory each their own object; they are left at the
        state of the end.
    speed_rpm : float or SpeedProfile, optional
        Of the shaft [rev/min], constant or over time; by default that of the rotor. Below 0 it turns from y to x.
    dt, until : float
        Step and end [s]; the last step may pass `until` by less than dt.
    start : "static" or (ndarray, ndarray)
        At rest in equilibrium; or displacements and velocities, of shape (N,) each, with the contacts in the state
        in which they are given, and bearings at rest there.
    tolerance : float, optional
        Largest imbalance of the forces at the supports over the load: by default 1e-6 with contacts, where each
        evaluation may be a solve, and 1e-9 without; with a `TransientContact` of a larger `tol` than its default
        as many times larger, for the noise of its force grows with it.
    max_iterations : int
        Evaluations of each contact in a step.
    rho_inf : float
        0 to 1: share of amplitude that frequencies far above 1/dt keep per step.
    callback : callable, optional
        Called as ``callback(step, steps)`` after every step, or block of steps on ball bearings.

    Returns
    -------
    RotorResult
        With status "interrupted" and what was computed, after Ctrl-C. Its `reservation` names features of
        bearings for which the steps are too long, and balls with loads outside the atlas.

    Raises
    ------
    InputError
        A value outside its range, a speed that a bearing does not take, a step too long for the ball passage or
        the turn of the shaft; a contact with a memory in two mounts; a speed below 0 of a rotor with parts that
        are for one direction of it, as of `linearise`.
    ConvergenceError
        A step found no balance, a contact in it did not converge, a ring left its bearing, or the journal of a
        damper touched its housing; ``result`` holds the steps before.
    """
    steps = steps_until(dt, until)
    max_iterations = require_integer("max_iterations", max_iterations, "a whole number >= 1", 1)
    if tolerance is not None:
        require_positive("tolerance", tolerance)
    require_instance("rotor", rotor, Rotor, "a Rotor")
    speed_rpm = rotor.speed_rpm if speed_rpm is None else speed_rpm
    if speed_rpm is None:
        raise InputError("speed_rpm", None, "given: that of the shaft")
    _check_contacts(rotor)
    rotor.check_contacts(0.0 if isinstance(speed_rpm, SpeedProfile) else speed_rpm)
    run = PreparedRun(rotor, speed_rpm, dt, steps, start, rho_inf)
    if run.compiled:
        integrator: Integrator = CompiledSteps(run, COMPILED_TOLERANCE if tolerance is None else tolerance)
    else:
        allowed = default_tolerance(rotor) if tolerance is None else tolerance
        integrator = PythonSteps(run, allowed, max_iterations)
    return integrate(run, integrator, callback)


def default_tolerance(rotor: Rotor) -> float:
    """Tolerance of the balance of forces; larger with full films that are solved more coarsely than by default."""
    films = (mount.contact for mount in rotor.contacts)
    coarsest = max((film.coarseness for film in films if isinstance(film, TransientContact)), default=1.0)
    return TOLERANCE * max(coarsest, 1.0)


def steps_until(dt: float, until: float) -> int:
    """Number of steps `dt` [s] of a run; raises `InputError` for a step, an end or a number outside its range."""
    require_positive("dt", dt)
    if require_positive("until", until) / dt > MOST_STEPS:
        raise InputError("until", until, f"at most {MOST_STEPS * dt:g} s: {MOST_STEPS:.0e} steps of dt, all kept")
    return max(1, ceil(until / dt - 1e-9))  # but for rounding of the quotient


def integrate(
    run: PreparedRun, integrator: Integrator, callback: Callable[[int, int], object] | None
) -> RotorResult:
    """All steps, or as many as there are before Ctrl-C."""

    def progress(made: int) -> None:
        if callback is not None:
            callback(made, run.steps)

    status = Status.CONVERGED
    try:
        for first, end, omega in run.blocks():
            integrator.advance(omega, first, end, progress)
    except KeyboardInterrupt:
        status = Status.INTERRUPTED
        integrator.rewind()
    except ConvergenceError as error:
        integrator.rewind()
        result = run_result(run, integrator.made, Status.FAILED)
        raise ConvergenceError(f"rotor at t = {run.t[integrator.reached]:.6g} s: {error}", result) from error
    result = run_result(run, integrator.made, status)
    for message in _beyond_loads(run)[0]:
        warn_user(message, OutsideValidityWarning)
    _warn_of_damping(run)
    warn_of_contacts(run.rotor, result)
    return result


def _check_contacts(rotor: Rotor) -> None:
    contacts = [mount.contact for mount in rotor.contacts]
    for i, contact in enumerate(contacts):
        if not isinstance(contact, Contact):
            raise InputError(f"contacts[{i}]", shown(contact), "a Contact (advance, save and restore state)")
        if getattr(contact, "units", "SI") != "SI":
            units = getattr(contact, "units", "")
            raise InputError(f"contacts[{i}].units", units, "SI: a film or an element of an OperatingPoint")
        if any(contact is other for other in contacts[:i]) and contact.save_state() is not None:
            raise InputError(f"contacts[{i}]", "used twice", "its own object: it has a memory (take a copy)")


def run_result(run: PreparedRun, made: int, status: Status) -> RotorResult:
    """Histories of a run as far as its first `made` steps."""
    kept, histories = slice(0, made + 1), run.histories
    entries = Histories._make(history[kept] for history in histories)
    columns, approach, rate, force = support_histories(run.rotor, entries, run.omega[kept], run.shift)
    names, places = flat_nodes(run.rotor.nodes)
    largest = np.array([one.largest for one in run.balls]).reshape(-1, 2)
    balls = zip(run.rotor.ball_bearings, run.rotor.ball_bearing_names, run.balls, strict=True)
    return RotorResult(
        t=run.t[kept],
        speed_rpm=run.omega[kept] / RPM_TO_RAD_S,
        displacement=histories.displacement[kept],
        velocity=histories.velocity[kept],
        approach=approach,
        rate=rate,
        force=force,
        iterations=histories.evaluations[kept],
        largest_load=largest,
        status=status,
        reservation="; ".join(filter(None, [_long_steps(run, largest), *chain(*_beyond_loads(run))])),
        columns=columns,
        names=names,
        places=places,
        ball_bearings=tuple(
            BearingHistory(name=name, internals=mount.ball_bearing.tables.internals, mean_loads=one.mean_loads)
            for mount, name, one in balls
        ),
        dampers=run.rotor.film_damper_names,
    )


def _long_steps(run: PreparedRun, largest: _Floats) -> str:
    """Features of bearings that balls meet in too few steps, in words; else empty."""
    notes, fastest = [], float(np.abs(run.omega).max()) / RPM_TO_RAD_S
    rows = zip(run.rotor.ball_bearings, run.rotor.ball_bearing_names, largest.max(axis=1).tolist(), strict=True)
    for mount, name, force in rows:
        met = shortest_meeting(mount.ball_bearing, fastest, force)
        if met is not None and run.dt * LEAST_STEPS > met[0]:
            size = next(f"{key}={getattr(met[1], key):g}" for key in ("waves", "length") if hasattr(met[1], key))
            short = f"a ball meets {type(met[1]).__name__}({size}) of {name} in {met[0]:.3g} s"
            notes.append(f"steps of {run.dt:.3g} s are too long: {short}, so dt <= {met[0] / LEAST_STEPS:.2g} s")
    return "; ".join(notes)


def support_histories(
    rotor: Rotor, histories: Histories, omega: _Floats, shift: _Floats
) -> tuple[tuple[str, ...], _Floats, _Floats, _Floats]:
    """Names, motions, rates and forces of the directions of all supports: contacts, then bearings.

    Parameters
    ----------
    rotor : Rotor
    histories : Histories
        k entries of it.
    omega : ndarray, shape (k,)
        Of the shaft [rad/s].
    shift : ndarray
        Displacement of rings beside that of the rotor, 0 of contacts, as of `PreparedRun`.
    """
    r, v, force = histories.motion, histories.rate, histories.force
    offsets, first = np.array([mount.offset for mount in rotor.contacts]), len(rotor.contacts)
    names = [f"contact {i}" for i in range(first)]
    found = [(r[:, :first] + offsets, v[:, :first], force[:, :first])]
    with_balls, with_films = iter(rotor.ball_columns), iter(rotor.film_damper_columns)
    for mount, name in zip(rotor.bearings, bearing_names(rotor.bearings), strict=True):
        names += [f"{name} {direction}" for direction in mount.directions]
        if isinstance(mount.bearing, LinearBearing):
            rows = mount.rows(rotor.size).T
            moved, moving = histories.displacement @ rows, histories.velocity @ rows
            K, C = mount.bearing.at(omega / RPM_TO_RAD_S)
            found.append((moved, moving, (K @ moved[..., None] + C @ moving[..., None])[..., 0]))
        else:
            at = next(with_films if is_damper(mount) else with_balls)
            found.append((r[:, at] + shift[at], v[:, at], force[:, at]))
    motions, rates, forces = (np.hstack(parts) for parts in zip(*found, strict=True))
    return tuple(names), motions, rates, forces


def _beyond_loads(run: PreparedRun) -> tuple[list[str], list[str]]:
    """Where balls carried more, and where all carried less, than the atlas has, in words."""
    slowest = float(law_speeds(run.omega / RPM_TO_RAD_S)[0])
    heavy: list[str] = []
    light: list[str] = []
    for mount, name, balls in zip(run.rotor.ball_bearings, run.rotor.ball_bearing_names, run.balls, strict=True):
        more, less = beyond_loads(mount.ball_bearing, name, slowest, balls.largest)
        heavy, light = heavy + more, light + less
    return heavy, light


def _warn_of_damping(run: PreparedRun) -> None:
    """Warn of starved bearings whose elements leave out damping below zero."""
    fastest = float(law_speeds(run.omega / RPM_TO_RAD_S)[-1])
    for mount, name, balls in zip(run.rotor.ball_bearings, run.rotor.ball_bearing_names, run.balls, strict=True):
        words = damping_left_out(mount.ball_bearing, fastest, balls.largest)
        warn_of_damping_left_out(mount.ball_bearing, name, words)


def warn_of_contacts(rotor: Rotor, result: RotorResult) -> None:
    """Let the elements warn where the run left their validity box."""
    for i, mount in enumerate(rotor.contacts):
        contact = mount.contact
        warn = getattr(contact, "warn_outside", None)
        if warn is not None:
            u, v, f = result.approach[:, i], result.rate[:, i], result.force[:, i]
            warn(u, v, force=f, omega=frequency_of(u, v))
