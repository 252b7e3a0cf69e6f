"""`simulate`: a motion drives the transient contact and the history is recorded."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from math import ceil

import numpy as np

from ehlcontact.domain import Domain, check_domain, check_intervals
from ehlcontact.errors import ConvergenceError, InputError, require_instance, require_nonnegative, require_positive
from ehlcontact.motion import FreeVibration, Motion, PrescribedApproach
from ehlcontact.newton import Balance
from ehlcontact.results import SimulationResult
from ehlcontact.scaling import Point, moes_point, scales_of
from ehlcontact.status import Status
from ehlcontact.steady import central_film
from ehlcontact.surface import Surface, surface_height
from ehlcontact.transient import Step, TransientFilm
from ehlcontact.version import __version__

Array = np.ndarray


class _History:
    """Growing lists of what is recorded at each step."""

    def __init__(self, snapshots: Sequence[float]) -> None:
        self.rows: list[tuple[float, ...]] = []  # T, u, rate, acceleration, force, load, hc, hm
        self.film: list[Array] = []
        self.pressure: list[Array] = []
        self.steps: list[Step] = []
        self.wanted = sorted(snapshots)
        self.snapshots: list[tuple[float, Array, Array]] = []

    def record(self, film: TransientFilm, step: Step, T: float, motion: tuple[float, ...], load: float) -> None:
        level = film.level
        films = (level.force(), load, central_film(level), float(level.H.min()))
        self.rows.append((T, film.u, *motion, *films))
        self.film.append(level.H[0].copy())
        self.pressure.append(level.P[0].copy())
        self.steps.append(step)
        while self.wanted and T >= self.wanted[0] - 1e-9:
            self.wanted.pop(0)
            self.snapshots.append((T, level.H.T.copy(), level.P.T.copy()))


def simulate(
    point: Point,
    motion: Motion,
    *,
    n: int = 128,
    domain: Domain | None = None,
    until: float | None = None,
    dT: float | None = None,
    tol: float = 3e-3,
    snapshots: Sequence[float] = (),
    surface: Surface | None = None,
    throw: bool = True,
    callback: Callable[[float, float], None] | None = None,
) -> SimulationResult:
    """Integrate the transient contact (eqs. 1, 3, 5, 6) from rest under the given motion.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    motion : FreeVibration, HarmonicLoad, RampLoad, PrescribedLoad or PrescribedApproach
    n : int
        Intervals along X, a multiple of 16.
    domain : Domain, optional
        Computed region; by default wide enough for the largest load of the motion.
    until, dT : float, optional
        End and (fixed) step of dimensionless time; the motion's own defaults otherwise. The step is shortened
        to divide `until` evenly.
    tol : float
        Residual at which a step counts as solved, relative to the central film at rest; force and approach then
        change by less than tol/30 in the last cycle.
    snapshots : sequence of float
        Times whose whole fields are kept.
    surface : callable, optional
        Feature G(X, Y, T) added to the gap, even in Y; see `surface`. At rest for T <= 0.
    throw : bool
        Raise on failure; otherwise look at ``result.status``.
    callback : callable, optional
        Called with T and `until` after every step.

    Returns
    -------
    SimulationResult
        Ctrl-C ends it early with status ``interrupted`` and all steps done so far.

    Raises
    ------
    InputError
        An argument outside its range.
    ConvergenceError
        A step did not converge; ``error.result`` holds the history so far.
    """
    started = time.perf_counter()
    moes = moes_point(point)
    require_instance("motion", motion, Motion, "a motion such as FreeVibration or HarmonicLoad")
    n, domain = check_intervals(n), check_domain(domain, moes, motion.largest_load)
    until = motion.default_end if until is None else require_positive("until", until)
    dT = motion.default_step if dT is None else require_positive("dT", dT)
    if dT > until:
        raise InputError("dT", dT, f"at most until = {until!r}")
    for T in snapshots:
        if not require_nonnegative("snapshots", T) <= until * (1.0 + 1e-9):
            raise InputError("snapshots", T, f"at most until = {until!r}")
    film = TransientFilm(moes, domain, n, require_positive("tol", tol))
    history = _History(snapshots)
    static, status = _start(film, motion, history, surface)
    steps = ceil(until / dT - 1e-9)
    if status.ok:
        status = _march(film, motion, history, steps, until / steps, surface, callback)
    result = _collect(film, motion, history, status, static, time.perf_counter() - started, point, domain, n)
    if throw and not status.ok and status is not Status.INTERRUPTED:
        T = result.T[-1]
        raise ConvergenceError(f"simulation {status} at T = {T:.4g}: {status.advice}", result)
    return result


def _start(
    film: TransientFilm, motion: Motion, history: _History, surface: Surface | None
) -> tuple[float, Status]:
    """Static state, then the state the motion starts from; returns the static approach."""
    G = surface_height(surface, film.level.X, film.level.Y, 0.0)
    step = film.start_steady(Balance(0.0, 1.0, 1.0), surface=G)
    static = film.u
    rate = 0.0
    if isinstance(motion, PrescribedApproach):
        rate = motion.rate(0.0)
        if step.status.ok:
            u = motion.approach(0.0)
            step = film.start_steady(Balance(1.0, 0.0, u), u, G)
    elif isinstance(motion, FreeVibration):
        rate = motion.initial_rate
        if step.status.ok and motion.offset != 0.0:
            u = static + motion.offset
            step = film.start_steady(Balance(1.0, 0.0, u), u, G)
    elif step.status.ok and motion.load(0.0) != 1.0:
        step = film.start_steady(Balance(0.0, 1.0, motion.load(0.0)), static, G)
    force = film.level.force()
    load = force if isinstance(motion, PrescribedApproach) else motion.load(0.0)
    acceleration = motion.omega_n**2 * (load - force) if motion.omega_n else 0.0
    history.record(film, step, 0.0, (rate, acceleration), load)
    return static, step.status


def _march(
    film: TransientFilm,
    motion: Motion,
    history: _History,
    steps: int,
    dT: float,
    surface: Surface | None,
    callback: Callable[[float, float], None] | None,
) -> Status:
    """Advance `steps` steps of length `dT`; every step is recorded, also one that fails."""
    _, u, rate, acceleration, *_ = history.rows[0]
    u_before = u - dT * rate
    try:
        for k in range(1, steps + 1):
            T = k * dT
            guess = 2.0 * u - u_before
            if isinstance(motion, PrescribedApproach):
                guess = motion.approach(T)
                balance = Balance(1.0, 0.0, guess)
            elif motion.omega_n:
                # Newmark, beta = 1/4: u_new = predictor + dT^2/4 u''_new, put into eq. 5
                predictor = u + dT * rate + 0.25 * dT * dT * acceleration
                stiffness = 4.0 / (motion.omega_n * dT) ** 2
                balance = Balance(stiffness, 1.0, motion.load(T) + stiffness * predictor)
                guess = predictor + 0.25 * dT * dT * acceleration
            else:
                balance = Balance(0.0, 1.0, motion.load(T))
            G = surface_height(surface, film.level.X, film.level.Y, T)
            step = film.advance(dT, balance, guess, G)
            u_before, u_old, u = u, u, film.u
            if motion.omega_n:
                old = acceleration
                acceleration = 4.0 * (u - predictor) / (dT * dT)
                rate += 0.5 * dT * (old + acceleration)
            elif isinstance(motion, PrescribedApproach):
                rate = motion.rate(T)
            else:
                rate = (u - u_old) / dT
            load = film.level.force() if isinstance(motion, PrescribedApproach) else motion.load(T)
            history.record(film, step, T, (rate, acceleration), load)
            if callback is not None:
                callback(T, steps * dT)
            if not step.status.ok:
                return step.status
    except KeyboardInterrupt:
        return Status.INTERRUPTED
    return Status.CONVERGED


def _collect(
    film: TransientFilm,
    motion: Motion,
    history: _History,
    status: Status,
    static: float,
    seconds: float,
    point: Point,
    domain: Domain,
    n: int,
) -> SimulationResult:
    T, u, rate, acceleration, force, load, h_central, h_min = np.array(history.rows).T.copy()
    if not motion.omega_n and T.size > 2:
        # No motion equation gives these: second-order differences of the record.
        if not isinstance(motion, PrescribedApproach):
            rate = np.gradient(u, T, edge_order=2)
        acceleration = np.gradient(rate, T, edge_order=2)
    shape = (0, film.level.nx + 1, film.level.ny + 1)
    snapshots = history.snapshots
    return SimulationResult(
        point=moes_point(point),
        scales=scales_of(point),
        domain=domain,
        n=n,
        motion=motion,
        X=film.level.X.copy(),
        Y=film.level.Y.copy(),
        T=T,
        approach=u,
        rate=rate,
        acceleration=acceleration,
        force=force,
        load=load,
        h_central=h_central,
        h_min=h_min,
        h_midplane=np.array(history.film),
        p_midplane=np.array(history.pressure),
        residuals=np.array([s.residual for s in history.steps]),
        load_residuals=np.array([s.load_residual for s in history.steps]),
        cycles=np.array([s.cycles for s in history.steps], dtype=float),
        snapshot_T=np.array([s[0] for s in snapshots]),
        snapshot_H=np.array([s[1] for s in snapshots]) if snapshots else np.empty(shape),
        snapshot_P=np.array([s[2] for s in snapshots]) if snapshots else np.empty(shape),
        static_approach=static,
        status=status,
        seconds=seconds,
        version=__version__,
    )
