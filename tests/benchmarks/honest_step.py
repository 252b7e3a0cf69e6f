"""The honest measure of a step in time: what it costs until its end is that of the fully converged step.

A run is taken into its middle as `simulate` does it. From there the same step is done again and again: once until
P changes by rounding only, then with errors taken after each cycle while the clock stands, then with exactly as
many cycles as the honest measure of `honest` needs, against the clock; and as `simulate` does it by default.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from contextlib import contextmanager
from math import pi
from typing import Any
from unittest import mock

from conv import Bracket, Clock, circumstances
from honest import FULL, LARGEST, MOST, Errors, Reference, State, is_full, is_over, settle, unknown, verdict

from ehlcontact import FreeVibration, Grid, HarmonicLoad, MoesPoint
from ehlcontact.solver.mesh import Mesh, Purpose, mesh_for
from ehlcontact.transient import film as film_module
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.film import TransientFilm
from ehlcontact.transient.record import History
from ehlcontact.transient.run import Run, march_fixed
from ehlcontact.transient.surface import Surface

MOTIONS: dict[str, Motion] = {"free": FreeVibration(Omega_n=5.13), "harmonic": HarmonicLoad(Omega=2.0 * pi)}
DEFAULT_TOL = 3e-3  # of `simulate`
STEPS_BEFORE = 50  # 0.6 periods: nothing stands still there
OUT_OF_REACH = 1e-16  # a tolerance that is never met: the number of cycles ends the step


class Middle:
    """A run stopped in its middle, and its next step, to be repeated at will."""

    def __init__(
        self,
        point: MoesPoint,
        motion: Motion,
        mesh: Mesh,
        steps: int,
        *,
        dT: float | None = None,
        surface: Surface | None = None,
    ) -> None:
        self.dT = motion.default_step if dT is None else dT
        self.film = TransientFilm(point, mesh, DEFAULT_TOL)
        self.run = Run(self.film, motion, surface, History(()), None, lambda run: None)
        self.status = self.run.start()
        if self.status.ok:
            self.status = march_fixed(self.run, steps, self.dT).status
        self.T = (steps + 1) * self.dT

    def step(self) -> Any:
        """The next step, from the same state every time; returns its `Step`."""
        self.run.back()
        return self.run.advance(self.T, self.dT).step

    @contextmanager
    def cycles(self, number: int) -> Iterator[None]:
        """Steps take exactly `number` cycles, unless they stagnate before."""
        tol = self.film.tol
        self.film.tol = OUT_OF_REACH
        with mock.patch.object(film_module, "STEP_CYCLES", number):
            yield
        self.film.tol = tol

    def share(self, threads: int) -> None:
        """Let so many threads do the work from here on."""
        for level in self.film.multigrid.levels:
            level.share(threads)

    def converged(self, most: int) -> Reference:
        """The step with cycles until P changes by rounding only."""
        self.run.back()
        balance, _ = self.run.motion.balance(self.run.state, self.T, self.dT)
        with self.cycles(1):
            self.step()
        film = self.film.multigrid
        return settle(film, lambda: film.cycle(balance), most)

    def errors(self, exact: State, most: int) -> list[Errors]:
        """Of the extrapolated start, and after every cycle."""
        film, found = self.film.multigrid, []
        cycle = film.cycle

        def watched(balance: Any) -> float:
            if not found:
                found.append(Errors.between(State.of(film), exact))
            if is_over([e.P for e in found]):
                return 0.0
            change: float = cycle(balance)
            found.append(Errors.between(State.of(film), exact))
            return change

        with mock.patch.object(film, "cycle", watched), self.cycles(most):
            self.step()
        return found


def measure_step(
    point: MoesPoint,
    name: str,
    n: int,
    *,
    steps: int = STEPS_BEFORE,
    repeat: int = 9,
    most: int = MOST,
    threads: int = 1,
) -> dict[str, Any]:
    """One step of the motion `name` in the middle of a run on n intervals; `repeat` timed repetitions.

    With more than one thread a second timing stands beside that of one.
    """
    mesh = mesh_for(point, Purpose.RUN, grid=Grid(n=n), largest_load=MOTIONS[name].largest_load)
    Middle(point, MOTIONS[name], mesh_for(point, Purpose.RUN, grid=Grid(n=64)), 3)  # compiles
    middle = Middle(point, MOTIONS[name], mesh, steps)
    row: dict[str, Any] = {"motion": name, "n": n, "region": list(mesh.domain.as_tuple()), "T": middle.T}
    row |= point.to_dict() | circumstances()
    if not middle.status.ok:
        return row | {"verdict": f"the run before the step: {middle.status}", "honest": None, "full": None}
    exact = middle.converged(most)
    found = middle.errors(exact.state, most)
    row |= {
        "reference": {"iterations": exact.iterations, "uncertainty": exact.uncertainty},
        "errors": [e.P for e in found],
        "start": {"errors": found[0]._asdict()},
        "verdict": verdict([e.P for e in found]) if exact.knows(FULL) else unknown(exact),
    }
    with Bracket() as bracket:
        for key, known in (("honest", exact.knows(LARGEST)), ("full", exact.knows(FULL))):
            holds = is_full if key == "full" else (lambda errors: errors.honest)
            right = [k for k in range(len(found)) if all(holds(errors) for errors in found[k:])]
            row[key] = {"cycles": right[0], **_timed(middle, right[0], repeat)} if right and known else None
            if row[key] and threads > 1:
                middle.share(threads)
                timed = _timed(middle, right[0], repeat)
                row[f"{key}_shared"] = {"cycles": right[0], "threads": threads, **timed}
                middle.share(1)
        row["simulate"] = _as_simulated(middle, exact, repeat)
    return bracket.ratios(row)


def _timed(middle: Middle, cycles: int, repeat: int) -> dict[str, float]:
    """Median seconds of the step with so many cycles."""
    with middle.cycles(cycles):
        return _median(middle, repeat)


def _median(middle: Middle, repeat: int) -> dict[str, float]:
    clocks = []
    middle.step()  # what else was done since the last step has its arrays out of the caches
    for _ in range(repeat):
        middle.run.back()
        with Clock() as clock:
            middle.run.advance(middle.T, middle.dT)
        clocks.append(clock)
    wall, cpu = ([getattr(clock, kind) for clock in clocks] for kind in ("wall", "cpu"))
    return {"seconds": statistics.median(wall), "cpu": statistics.median(cpu)}


def _as_simulated(middle: Middle, exact: Reference, repeat: int) -> dict[str, Any]:
    """The step with the tolerance of `simulate`: its time, and how far it is from the converged one."""
    step = middle.step()
    errors = Errors.between(State.of(middle.film.multigrid), exact.state)
    return {
        "status": str(step.status),
        "cycles": step.cycles,
        "honest": bool(errors.honest) if exact.knows(LARGEST) else None,
        "errors": errors._asdict(),
        **_median(middle, repeat),
    }
