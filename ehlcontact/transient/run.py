"""Run of a simulation: film and motion advanced together, in fixed or in controlled steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.status import Status
from ehlcontact.transient.bodies import Motion, MotionState
from ehlcontact.transient.features import Surface, surface_height, surface_step
from ehlcontact.transient.record import Entry, History
from ehlcontact.transient.settings import StepPlan
from ehlcontact.transient.speed import SpeedHistory, surface_at
from ehlcontact.transient.time_step import (
    StepControl,
    difference,
    local_error,
    longest_step,
    next_time,
    shortest_step,
)
from ehlcontact.transient.transient_film import FilmState, TransientFilm

# No shorter step mends these
HOPELESS = (Status.OUT_OF_DOMAIN, Status.BEYOND_REGION, Status.UNRESOLVED, Status.STARVED)
RESTART_CUT = 0.25  # of the step, where the motion turns a corner


@dataclass(frozen=True, slots=True)
class RunEnd:
    """How a run ended, and what to say about the time step."""

    status: Status
    note: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class SavedRun:
    """Last sound state of a run; its motion is that of the last of its entries."""

    film: FilmState
    entries: int
    control: StepControl | None


class Run:
    """Film, motion and record of one simulation, and the last sound state: `kept`.

    `control` is None in fixed steps; `watch` is called after every step kept.
    """

    def __init__(
        self,
        film: TransientFilm,
        motion: Motion,
        surface: Surface | None,
        history: History,
        control: StepControl | None,
        watch: Callable[[Run], None],
        speed: SpeedHistory | None = None,
    ) -> None:
        self.film, self.motion, self.speed = film, motion, speed
        self.surface = surface_at(surface, speed)
        self.history, self.control = history, control
        self.static_approach = film.u
        film.keeps_oil = speed is not None and speed.reverses
        self.film_error: ErrorEstimate | None = None  # of the film at T = 0
        self._watch = watch
        self.state: MotionState
        self.kept: SavedRun

    def start(self) -> Status:
        """Static state, then the state the motion starts from, with the acceleration that its force gives."""
        film, motion = self.film, self.motion
        if self.speed is not None:
            film.set_speed(self.speed(0.0))
        G = surface_height(self.surface, film.level.X, film.level.Y, 0.0)
        balance = Balance.of_load()
        step = film.start_steady(balance, surface=G)
        self.static_approach = film.u
        held = motion.held(film.u)
        if step.status.ok and held is not None:
            balance = held.balance
            step = film.start_steady(*held, G)
        if step.status.ok:
            self.film_error = film.error_at_rest(balance)
        force = film.level.force()
        self.state = motion.begin(film.u, force)
        self.keep(Entry.of(film, self.state, motion.applied(0.0, force), step))
        return step.status

    def resume(
        self, state: FilmState, scale: float, static_approach: float, film_error: ErrorEstimate | None
    ) -> None:
        """Go on from the last entry of the history, and the film state that belongs to it."""
        self.film.scale, self.static_approach, self.film_error = scale, static_approach, film_error
        self.film.restore_state(state)
        self.state = self.history.entries[-1].motion
        self._mark()

    def advance(self, T: float, dT: float) -> Entry:
        """Step of length `dT` to time `T`; film and motion move, nothing is recorded."""
        film, motion, now = self.film, self.motion, self.state
        balance, guess = motion.balance(now, T, dT)
        if self.speed is not None:
            film.set_speed(self.speed(T))
        U = 1.0 if self.speed is None else self.speed(T)
        feature = surface_step(self.surface, film.level.X, film.level.Y, T, dT, film.last_step, U)
        step = film.advance(dT, balance, guess, feature)
        self.state = motion.after(now, film.u, T, dT)
        return Entry.of(film, self.state, motion.applied(T, film.level.force()), step)

    def keep(self, *entries: Entry) -> None:
        """Record the entries, the last of which is the present state."""
        self.history.take_snapshot(self.state.T, self.film)
        self.history.entries.extend(entries)
        if entries[-1].step.status.ok:
            self._mark()
            self._watch(self)

    def _mark(self) -> None:
        control = None if self.control is None else replace(self.control)
        self.kept = SavedRun(self.film.save_state(), len(self.history.entries), control)

    def back(self) -> None:
        """Return to the last state kept."""
        self.film.restore_state(self.kept.film)
        self.state = self.history.entries[self.kept.entries - 1].motion


def march(run: Run, steps: StepPlan) -> RunEnd:
    """All steps until ``steps.until``; Ctrl-C ends them early."""
    try:
        if steps.local_error is None:
            return march_fixed(run, round(steps.until / steps.dT), steps.dT)
        return march_controlled(run, steps.until)
    except KeyboardInterrupt:
        return RunEnd(Status.INTERRUPTED)


def march_fixed(run: Run, steps: int, dT: float) -> RunEnd:
    """All steps not yet recorded, of length `dT`; a step that fails is recorded and ends the run."""
    for k in range(run.kept.entries, steps + 1):
        entry = run.advance(k * dT, dT)
        run.keep(entry)
        if not entry.step.status.ok:
            residual, tol = entry.step.residual, run.film.tol
            return RunEnd(entry.step.status, f"step {dT:.3g}, residual {residual:.3g} with tol {tol:g}")
    return RunEnd(Status.CONVERGED)


def march_controlled(run: Run, until: float) -> RunEnd:
    """Steps whose local error stays below ``control.tolerance``; corners, snapshots and the end are met.

    From rest, and from each corner, the past is not smooth: one step is compared with two of half the length,
    of which the first is backward Euler, and those two are kept.
    """
    control = run.control
    assert control is not None
    motion, entries = run.motion, run.history.entries
    turns = () if run.speed is None else run.speed.corners
    corners = [c for c in (*motion.corners, *turns) if 0.0 < c < until]
    stops = sorted({*corners, *run.history.wanted, until})
    shortest, longest = shortest_step(motion), longest_step(motion)
    while run.state.T < until:
        T, dT = next_time(run.state.T, min(control.step, longest), stops, shortest)
        smooth = len(entries) - 1 - control.first >= 2
        if smooth:
            new = [run.advance(T, dT)]
            error = local_error(entries[-3:], new[0], motion) / control.tolerance
        else:
            new, error = _start_pair(run, T, dT)
            error /= control.tolerance
        failed = next((e.step.status for e in new if not e.step.status.ok), None)
        if failed is None and error <= 1.0:
            if smooth:
                control.accepted(dT, error)
            else:
                control.step, control.last_error = dT, 1.0
            if T in corners:
                run.film.forget_past()
                control.first, control.step = len(entries) + len(new) - 1, RESTART_CUT * control.step
            run.keep(*new)
            continue
        if failed in HOPELESS:
            run.keep(*new)
            return RunEnd(failed)
        run.back()
        if failed is None:
            control.refused(dT, error, 3 if smooth else 2)
            fault = f"has {error:.3g} times"
        else:
            control.failed(dT)
            fault = f"ends {failed} under"
        if control.step < shortest:
            return RunEnd(
                Status.STEP_TOO_SMALL, f"a step of {dT:.3g} {fault} the tolerated error {control.tolerance:g}"
            )
    return RunEnd(Status.CONVERGED)


def _start_pair(run: Run, T: float, dT: float) -> tuple[list[Entry], float]:
    """Two steps of dT/2 from where the past is not smooth, and their distance from one of dT."""
    whole = run.advance(T, dT)
    if not whole.step.status.ok:
        return [whole], 0.0
    run.back()
    half = 0.5 * dT
    pair = [run.advance(T - half, half), run.advance(T, half)]
    return pair, difference(whole, pair[1], run.motion)
