"""`solve_steady`: full multigrid, then V cycles until pressure, load balance and residual have converged."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import inf, nan
from typing import Any

import numpy as np

from ehlcontact.asperities import Asperities
from ehlcontact.checks import parts, require_choice, require_finite, require_integer, require_positive
from ehlcontact.checks.kinds import Callback, Object
from ehlcontact.checks.machine import require_threads
from ehlcontact.checks.quantity import takes
from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import ConvergenceError
from ehlcontact.heat import Heat
from ehlcontact.point import Point, Scales, moes_point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import SteadyResult
from ehlcontact.results.asperity_contact import AsperityContact
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.acceleration import AcceleratedCycles
from ehlcontact.solver.attempts import METHODS, Method, attempts
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.effects import CyclesWithEffects, Effect, effects_of
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.error_grids import estimate_error
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.iterate import IterationHistory, StoppingCriteria, iterate
from ehlcontact.solver.level import Level
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.newton import NewtonKrylov
from ehlcontact.status import Status
from ehlcontact.supply import OilLayer

TOLERANCE = 1e-5  # of the pressure, over the Hertz pressure
LARGEST_RESIDUAL = 0.1  # relative, of a converged film: what is solved is judged by the pressure
COLD_PRESSURE, COLD_APPROACH = 1e-3, 1e-5  # of an isothermal film that is a start: its centre is within 1e-4
LOAD_TOLERANCE = 1e-7
APPROACH_TOLERANCE = 1e-7
BUDGET = 60.0  # s of one core: all but the thinnest side lobes take far less
MAX_CYCLES = 80  # of V cycles: films of the box take up to 18
LARGEST_APPROACH = 1e9  # beyond all that is solved, and its power still a number


@takes(grid=Object(Grid, "a Grid"), tol=parts.TOLERANCE, callback=Callback("cycles, residual"))
@one_blas_thread()
def solve_steady(
    point: Point,
    *,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    asperities: Asperities | None = None,
    sliding: ShearThinning | None = None,
    approach: float | None = None,
    tol: float = TOLERANCE,
    max_cycles: int = MAX_CYCLES,
    method: str = "automatic",
    refine: bool = True,
    budget: float = BUDGET,
    threads: int | None = None,
    throw: bool = True,
    callback: Callable[[int, float], None] | None = None,
) -> SteadyResult:
    """Solve Reynolds, film and load balance (eqs. 1, 3, 4) for the steady contact.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    grid : Grid
        Intervals along X, computed region, engine of the elastic deflection. The default number of intervals is
        what the film needs, 128 or more. It is doubled until the estimated errors are within 0.2 % of the dry
        approach, 1 % of the central and 3 % of the smallest film, up to a grid of a million nodes, and of four
        million where the side lobes of a long contact come out negative otherwise; ``result.error_estimate`` is
        what was reached. The default region is ``Domain()``, wider at light load, and, with the number of
        intervals left out, narrower where the film is too thin for a grid of that extent.
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact. The full film then begins where that oil fills the gap; ahead
        of it and behind the contact the gap is partly filled. By default the inlet is flooded up to the border of
        the region.
    thermal : Heat, or True for ``Heat()``, optional
        Let the film heat up, and its viscosity follow: ``Heat()`` takes the data of the oil. The isothermal film
        of smooth surfaces is solved first, under the same supply. By default the film has the temperature of the
        inlet.
    asperities : Asperities, optional
        Let them carry part of the load where the film is thin, as ``result.asperities`` says. The film between
        smooth surfaces is solved first. By default the surfaces are smooth. With heat, in pure rolling alone: the
        friction of asperities has no heat here.
    sliding : ShearThinning, optional
        Shear thinning of the film by sliding (docs/traction.md), under a supply and with heat too. The isothermal
        Newtonian film is solved first. By default the film is that of pure rolling.
    approach : float, optional
        Prescribe the approach instead of the load, at an `OperatingPoint` in m, at a `MoesPoint` over that of the
        dry contact; above the latter the default domain widens for the force it takes.
    tol : float
        Largest change of the pressure that further cycles would still make, over the Hertz pressure, estimated
        from the last change and its factor from cycle to cycle.
    max_cycles : int
        Limit of V(2,1) cycles, or of Newton steps, on the finest grid. Where one below the default is reached,
        nothing else is tried.
    method : {"automatic", "multigrid", "newton"}
        V cycles, or Newton steps from the same full-multigrid start; both solve the same equations.
        ``"automatic"`` cycles; where that fails it begins again with twice the sweeps in every cycle, then, on 256
        intervals or more, from the film on half the intervals, and at last, on grids that allow it, turns to
        Newton. Where lines lie close (long contacts, kappa above 1) it begins again with the load raised in small
        steps instead, and on a still finer grid where that fails.
    refine : bool
        False, with the number of intervals left out, accepts the first grid that gives a film, with a quarter of
        the nodes or fewer: the smallest film may be off by a third (``result.error_estimate``).
    budget : float
        Time of one core [s] that all attempts at a film may be expected to take, by the nodes of their grids, with
        the number of intervals left out; ``math.inf`` for no limit. The first attempt is always made. The best
        film so far, with its status and error estimate, is returned or raised.
    threads : int, optional
        Threads that share the work, at most the cores there are; by default all of them, within the present limits
        of BLAS, and one in the processes of a pool. Results are the same, bit for bit, for any number.
    throw : bool
        Raise on failure; otherwise look at ``result.status``.
    callback : callable, optional
        Called with the cycle number and the relative residual after every cycle.

    Returns
    -------
    SteadyResult
        In SI at an `OperatingPoint`, in Moes units at a `MoesPoint`.
        Ctrl-C ends it early with status ``interrupted``.

    Raises
    ------
    InputError
        An argument outside its range; a grid that would not fit into memory; heat without the data that it takes.
    ConvergenceError
        Not converged; ``error.result`` holds the partial result.
    """
    started = time.perf_counter()
    require_integer("max_cycles", max_cycles, "a whole number > 0", 1)
    require_positive("tol", tol)
    require_choice("method", method, tuple(METHODS))
    require_grid(grid)
    conditions = Conditions.of(supply=supply, thermal=thermal, sliding=sliding, asperities=asperities).at(point)
    threads = require_threads("threads", threads)
    if budget != inf:
        require_positive("budget", budget)
    if approach is not None:
        approach = require_finite("approach", approach) / point.scales.length
    result, cut = _solved(
        point, conditions, grid, threads, approach, tol, max_cycles, method, refine, budget, callback
    )
    result = replace(result.in_units_of(point), seconds=time.perf_counter() - started)
    status = result.status
    if throw and not status.ok and status is not Status.INTERRUPTED:
        where = f"after {result.cycles} iterations on n = {result.n}"
        more = f" More would be tried with a budget above {budget:g} s." if cut else ""
        raise ConvergenceError(f"steady solve {status} {where}: {status.advice}{more}", result)
    return result


def _solved(
    point: Point,
    conditions: Conditions,
    grid: Grid,
    threads: int,
    approach: float | None = None,
    tol: float = TOLERANCE,
    max_cycles: int = MAX_CYCLES,
    method: str = "automatic",
    refine: bool = True,
    budget: float = BUDGET,
    callback: Callable[[int, float], None] | None = None,
) -> tuple[SteadyResult, bool]:
    """Film in Moes units, and whether more would be tried with a larger budget; `approach` in dry approaches."""
    started = time.perf_counter()
    if approach is None:
        balance, load = Balance.of_load(), 1.0
    else:
        balance = Balance.of_approach(approach)
        load = min(max(approach, 1.0), LARGEST_APPROACH) ** 1.5  # of a dry contact
    moes = require_solvable(point, load)
    cut_short = max_cycles < MAX_CYCLES  # the caller's own limit: nothing else is what was asked for
    tried = []
    for attempt in attempts(
        moes,
        grid,
        method,
        largest_load=load,
        refine=refine,
        cut_short=cut_short,
        budget=budget if grid.n is None else inf,
    ):
        tried.append(attempt)
        film = _Film(point, attempt.mesh, attempt.method, grid.deflection, threads, conditions)
        attempt.status = film.run(balance=balance, tol=tol, most=max_cycles, watch=callback)
        attempt.error_estimate = film.error_estimate
        if attempt.is_better:
            solved, status = film, attempt.status
        elif attempt.status is Status.INTERRUPTED:
            status = attempt.status
    return solved.result(status, time.perf_counter() - started), any(a.cut for a in tried)


class _Film:
    """Solve of a film on one mesh, from full multigrid to a judged status."""

    def __init__(
        self,
        point: Point,
        mesh: Mesh,
        method: Method,
        deflection: str,
        threads: int,
        conditions: Conditions = FLOODED,
    ) -> None:
        self.point, self.conditions, self.mesh, self.method = point, conditions, mesh, method
        self._make = partial(
            Multigrid,
            moes_point(point),
            mesh,
            deflection=deflection,
            sweep_factor=method.sweep_factor,
            load_continuation=method.load_continuation,
            threads=threads,
        )
        self.multigrid = self._make()
        self.scale = self.multigrid.finest.dry_residual()
        self.track = IterationHistory()
        self.error_estimate: ErrorEstimate | None = None
        self.of_effects: dict[str, dict[str, Any]] = {}  # fields and numbers of what conditions made of the film

    def run(
        self, balance: Balance, tol: float, most: int, watch: Callable[[int, float], None] | None = None
    ) -> Status:
        """Cycle, or take Newton steps, until the residuals say how it ended: without effects, then with them."""
        goal = StoppingCriteria(
            self.scale, LARGEST_RESIDUAL, most, LOAD_TOLERANCE, APPROACH_TOLERANCE, pressure=tol
        )
        start = goal
        if self.conditions.viscosity_follows:  # what follows from the film is then held against it
            start = goal._replace(approach=COLD_APPROACH, pressure=max(tol, COLD_PRESSURE))
        if (supply := self.conditions.supply) is not None:
            flooded = nan
            if supply.needs_flooded:
                status = self._solve(start, balance)
                if not status.ok:
                    return status
                flooded = self.multigrid.finest.central_film()
            lines = supply.lines(self.multigrid.point, scales_of(self.point), flooded)
            self.multigrid = self._make(supply=lines)
        effects = effects_of(self.conditions, self.point, self.multigrid)
        changing = [effect for effect in effects if effect.changes_film]
        status = self._solve(start, balance, watch, judged=not changing)
        if status.ok and effects:
            before = self.multigrid.finest.central_film()
            if changing:
                status = self._solve(goal, balance, watch, changing, judged=True)
            for effect in effects:
                self.of_effects |= effect.result(before)
        return status

    @np.errstate(over="ignore", invalid="ignore", divide="ignore")  # of a film that runs away: its status says so
    def _solve(
        self,
        goal: StoppingCriteria,
        balance: Balance,
        watch: Callable[[int, float], None] | None = None,
        effects: Sequence[Effect] = (),
        judged: bool = False,
    ) -> Status:
        """From full multigrid, or with `effects` from the film without them.

        The error of a film that is `judged` is estimated.
        """
        mg, self.track = self.multigrid, IterationHistory()
        if balance.weight == 0.0:
            mg.u = balance.rhs
        try:
            advance = self._started_with(effects, balance) if effects else self._started(balance, goal)
            status = iterate(mg, balance, advance, goal, self.track, watch)
            if status.ok and judged:
                # coarser grids carry no asperities
                oil = balance.shifted(-balance.weight * mg.finest.asperity_load)
                self.error_estimate = estimate_error(mg, oil)
        except KeyboardInterrupt:
            return Status.INTERRUPTED
        return status

    def _started(self, balance: Balance, goal: StoppingCriteria) -> Callable[[Balance], float]:
        """Full multigrid, or the film on half the intervals, and what is to follow it.

        With close lines cycles need the better start, which raises the load by cycles on the grid of half the
        intervals; where those fail, in stiff oil, Newton steps do with the other one.
        """
        mg = self.multigrid
        if self.method.from_half:
            half = mg.halved()
            half.u, scale = mg.u, half.finest.dry_residual()
            half.full_multigrid(balance)
            iterate(half, balance, AcceleratedCycles(half).step, goal._replace(scale=scale), IterationHistory())
            mg.start_from(half)
            return AcceleratedCycles(mg).step
        mg.full_multigrid(balance, nested=not self.method.newton)
        if not self.method.newton:
            return AcceleratedCycles(mg).step
        mg.cycle(balance)
        return NewtonKrylov(mg).step

    def _started_with(self, effects: Sequence[Effect], balance: Balance) -> Callable[[Balance], float]:
        """Start of effects, and what is to follow it."""
        mg = self.multigrid
        cycles = CyclesWithEffects(mg, effects, NewtonKrylov(mg).step if self.method.newton else mg.cycle)
        cycles.start(balance)
        return cycles.step

    def result(self, status: Status, seconds: float) -> SteadyResult:
        """Result of the solve, in Moes units."""
        mg, level, track = self.multigrid, self.multigrid.finest, self.track
        conditions, scales = self.conditions, scales_of(self.point)
        thinned = self.of_effects.get("sliding", {"film_share": nan})
        return SteadyResult(
            point=mg.point,
            domain=self.mesh.domain,
            n=self.mesh.n,
            x=level.X.copy(),
            y=level.Y.copy(),
            p=level.P.T.copy(),
            h=level.H.T.copy(),
            approach=float(mg.u),
            force=level.force(),
            h_central=level.central_film(),
            h_min=level.lowest_film(),
            residuals=np.array(track.residuals),
            load_residuals=np.array(track.balance_residuals),
            approach_changes=np.array(track.approach_changes),
            # Ctrl-C may have come within a cycle, before its residual was known
            pressure_changes=np.array(track.pressure_changes[: max(track.iterations, 0)]),
            dry_residual=self.scale,
            status=status,
            error_estimate=self.error_estimate,
            seconds=seconds,
            supply=conditions.supply,
            temperature=self._temperature(scales),
            asperities=self._asperities(),
            sliding=conditions.sliding,
            thinned_share=None if conditions.sliding is None else thinned["film_share"],
            **_content(level),
        )

    def _temperature(self, scales: Scales | None) -> FilmTemperature | None:
        """Temperatures of a film with heat."""
        found, heat = self.of_effects.get("heat"), self.conditions.heat
        if found is None or heat is None or scales is None:
            return None
        return FilmTemperature(inputs=heat, thermal_load=heat.load(self.multigrid.point, scales), **found)

    def _asperities(self) -> AsperityContact | None:
        """Asperities beside a film."""
        found, inputs = self.of_effects.get("asperities"), self.conditions.asperities
        return None if found is None or inputs is None else AsperityContact(inputs=inputs, **found)


def _content(level: Level) -> dict[str, Any]:
    """Fields of a result of a solve with an oil supply; none of a flooded one.

    The last line, on the border, takes those of the line before it.
    """
    if not level.inflow.size:
        return {}
    carried, room = level.carried, level.fields.flow.mass
    through = np.empty_like(carried)  # at nodes: the mean of the faces on either side
    through[:, 0], through[:, -1] = carried[:, 0], carried[:, -2]
    through[:, 1:-1] = 0.5 * (carried[:, :-2] + carried[:, 1:-1])
    content = np.where(level.P > 0.0, 1.0, np.minimum(through / room, 1.0))
    content[-1] = content[-2]
    return {"content": content.T.copy(), "layer": level.inflow.copy(), "layer_behind": level.leaving()}
