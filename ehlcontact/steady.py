"""`solve_steady`: full multigrid, then V cycles until pressure, load balance and residual have converged."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from math import inf, nan
from typing import Any

import numpy as np

from ehlcontact.asperities import Asperities, AsperityNumbers
from ehlcontact.checks import require_choice, require_finite, require_instance, require_integer, require_positive
from ehlcontact.checks.machine import require_threads
from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import ConvergenceError
from ehlcontact.heat import Heat
from ehlcontact.point import Point, moes_point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import SteadyResult
from ehlcontact.results.asperity_contact import AsperityContact
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.acceleration import AcceleratedCycles
from ehlcontact.solver.attempts import METHODS, Method, attempts
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.error_grids import estimate_error
from ehlcontact.solver.film_heat import FilmHeat, HeatedCycles
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.iterate import IterationHistory, StoppingCriteria, iterate
from ehlcontact.solver.level import Level
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mixed_film import MixedCycles
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.newton import NewtonKrylov
from ehlcontact.status import Status
from ehlcontact.supply import OilLayer

LARGEST_RESIDUAL = 0.1  # relative, of a converged film: what is solved is judged by the pressure
COLD_PRESSURE, COLD_APPROACH = 1e-3, 1e-5  # of an isothermal film that is a start: its centre is within 1e-4
LOAD_TOLERANCE = 1e-7
APPROACH_TOLERANCE = 1e-7
BUDGET = 60.0  # s of one core: all but the thinnest side lobes take far less
MAX_CYCLES = 80  # of V cycles: films of the box take up to 18
LARGEST_APPROACH = 1e9  # beyond all that is solved, and its power still a number


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
    tol: float = 1e-5,
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
        is solved first, under the same supply. By default the film has the temperature of the inlet.
    asperities : Asperities, optional
        Let them carry part of the load where the film is thin, as ``result.asperities`` says. The film between
        smooth surfaces is solved first. By default the surfaces are smooth.
    sliding : ShearThinning, optional
        Shear thinning of the film by sliding (docs/traction.md). The Newtonian film is solved first. By
        default the film is that of pure rolling.
    approach : float, optional
        Prescribe the approach (dry Hertz value 1) instead of the load; above 1 the default domain widens for the
        force it takes.
    tol : float
        Largest change of the pressure that further cycles would still make, over the Hertz pressure, estimated
        from the last change and its factor from cycle to cycle.
    max_cycles : int
        Limit of V(2,1) cycles, or of Newton steps, on the finest grid. Where one below the default is reached,
        nothing else is tried.
    method : {"automatic", "multigrid", "newton"}
        V cycles, or Newton steps from the same full-multigrid start; both solve the same equations.
        ``"automatic"`` cycles; where that fails it begins again with twice the sweeps in every cycle, and at last,
        on grids that allow it, turns to Newton. Where lines lie close (long contacts, kappa above 1) it begins
        again with the load raised in small steps instead, and on a still finer grid where that fails.
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
    require_instance("refine", refine, bool | np.bool_, "True or False")
    require_choice("method", method, tuple(METHODS))
    require_grid(grid)
    conditions = Conditions.of(supply=supply, thermal=thermal, sliding=sliding, asperities=asperities).at(point)
    threads = require_threads("threads", threads)
    if budget != inf:
        require_positive("budget", budget)
    if approach is None:
        balance, load = Balance.of_load(), 1.0
    else:
        balance = Balance.of_approach(require_finite("approach", approach))
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
    result = solved.result(status, time.perf_counter() - started)
    if throw and not status.ok and status is not Status.INTERRUPTED:
        where = f"after {result.cycles} iterations on n = {result.n}"
        more = f" More would be tried with a budget above {budget:g} s." if any(a.cut for a in tried) else ""
        raise ConvergenceError(f"steady solve {status} {where}: {status.advice}{more}", result)
    return result


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
        self.supply, self.thermal, self.sliding = conditions.supply, conditions.heat, conditions.sliding
        given = conditions.asperities
        self.rough = None if given is None else (given, given.numbers(point))
        self.mesh, self.method, self.scales = mesh, method, scales_of(point)
        self.thinned_share = nan
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
        self.temperature: FilmTemperature | None = None
        self.asperities: AsperityContact | None = None
        # whether the viscosity follows what the film does
        heat_changes_it = self.thermal is not None and self.thermal.temperature_slope != 0.0
        self.follows = self.sliding is not None or heat_changes_it

    def run(self, balance: Balance, tol: float, most: int, watch: Callable[[int, float], None] | None) -> Status:
        """Cycle, or take Newton steps, until the residuals say how it ended."""
        if self.rough is not None:
            return self._run_mixed(self.rough, balance, tol, most, watch)
        if self.sliding is not None:
            return self._run_sliding(self.sliding, balance, tol, most, watch)
        if self.thermal is None:
            return self._run_cold(balance, tol, most, watch)
        assert self.scales is not None
        point = self.multigrid.point
        status = self._run_cold(balance, tol, most, watch)
        if not status.ok:
            return status
        mg = self.multigrid
        cold, heat = mg.finest.central_film(), FilmHeat(mg.finest, self.thermal.numbers(point, self.scales))
        if self.follows:
            self.track = IterationHistory()
            status = self._solve(balance, tol, most, watch, heat)
        with np.errstate(over="ignore", invalid="ignore"):  # of a film that ran away: its status says so
            heat.solve()
            balanced = heat.balance()
        self.temperature = FilmTemperature(
            inputs=self.thermal,
            mean=heat.mean.T.copy(),
            surfaces=heat.walls.transpose(0, 2, 1).copy(),
            film_share=mg.finest.central_film() / cold,
            thermal_load=self.thermal.load(point, self.scales),
            balance=balanced,
        )
        return status

    def _run_mixed(
        self,
        rough: tuple[Asperities, AsperityNumbers],
        balance: Balance,
        tol: float,
        most: int,
        watch: Callable[[int, float], None] | None,
    ) -> Status:
        """The film that shares the load with asperities, from that between smooth surfaces."""
        status = self._run_cold(balance, tol, most, watch)
        if not status.ok:
            return status
        mg, self.track = self.multigrid, IterationHistory()
        level, (inputs, numbers) = mg.finest, rough
        smooth, cycles = level.central_film(), MixedCycles(mg, numbers, mg.cycle)
        cycles.start()
        try:
            status = self._settle(self._goal(tol, most), balance, cycles.step, watch)
        except KeyboardInterrupt:
            status = Status.INTERRUPTED
        self.asperities = AsperityContact(
            inputs=inputs,
            pressure=cycles.pressure.T.copy(),
            load_share=level.asperity_load / level.force(),
            film_over_rq=level.central_film() / numbers.rq,
            film_share=level.central_film() / smooth,
        )
        return status

    def _run_sliding(
        self,
        sliding: ShearThinning,
        balance: Balance,
        tol: float,
        most: int,
        watch: Callable[[int, float], None] | None,
    ) -> Status:
        """The film that sliding thins, from the Newtonian one."""
        assert self.scales is not None
        mg = self.multigrid
        status = self._run_cold(balance, tol, most, watch)
        if not status.ok:
            return status
        newtonian, self.track = mg.finest.central_film(), IterationHistory()
        thinning = FilmThinning(mg, sliding.law, sliding.log_newton(mg.point.eta0, self.scales))
        status = self._solve(balance, tol, most, watch, thinning)
        self.thinned_share = mg.finest.central_film() / newtonian
        return status

    def _run_cold(
        self, balance: Balance, tol: float, most: int, watch: Callable[[int, float], None] | None
    ) -> Status:
        """The film at the temperature of the inlet."""
        if self.supply is None:
            return self._solve(balance, tol, most, watch)
        flooded = nan
        if self.supply.needs_flooded:
            status = self._solve(balance, tol, most, None)
            if not status.ok:
                return status
            flooded = self.multigrid.finest.central_film()
            self.track = IterationHistory()
        self.multigrid = self._make(supply=self.supply.lines(self.multigrid.point, self.scales, flooded))
        return self._solve(balance, tol, most, watch)

    def _solve(
        self,
        balance: Balance,
        tol: float,
        most: int,
        watch: Callable[[int, float], None] | None,
        heat: FilmHeat | FilmThinning | None = None,
    ) -> Status:
        """From full multigrid, or with `heat` (or thinning) from the film at the temperature of the inlet."""
        mg = self.multigrid
        if balance.weight == 0.0:
            mg.u = balance.rhs
        goal = self._goal(tol, most)
        if self.follows and heat is None:  # a start, and the film that the heated one is held against
            goal = goal._replace(approach=COLD_APPROACH, pressure=max(tol, COLD_PRESSURE))
        try:
            return self._run(goal, balance, watch, heat)
        except KeyboardInterrupt:
            return Status.INTERRUPTED

    def _goal(self, tol: float, most: int) -> StoppingCriteria:
        return StoppingCriteria(
            self.scale, LARGEST_RESIDUAL, most, LOAD_TOLERANCE, APPROACH_TOLERANCE, pressure=tol
        )

    @np.errstate(over="ignore", invalid="ignore", divide="ignore")  # of a film that runs away: its status says so
    def _settle(
        self,
        goal: StoppingCriteria,
        balance: Balance,
        advance: Callable[[Balance], float],
        watch: Callable[[int, float], None] | None,
    ) -> Status:
        """Advance until the residuals say how it ended; then estimate the error."""
        mg = self.multigrid
        status = iterate(mg, balance, advance, goal, self.track, watch)
        if status.ok:
            oil = balance.shifted(-balance.weight * mg.finest.asperity_load)  # coarser grids carry no asperities
            self.error_estimate = estimate_error(mg, oil)
        return status

    @np.errstate(over="ignore", invalid="ignore", divide="ignore")  # of a film that runs away: its status says so
    def _run(
        self,
        goal: StoppingCriteria,
        balance: Balance,
        watch: Callable[[int, float], None] | None,
        heat: FilmHeat | FilmThinning | None,
    ) -> Status:
        mg = self.multigrid
        # With close lines cycles need the better start, which raises the load by cycles on the grid of half the
        # intervals; where those fail, in stiff oil, Newton steps do with the other one.
        if heat is None:
            mg.full_multigrid(balance, nested=not self.method.newton)
            if self.method.newton:
                mg.cycle(balance)
        if heat is None:
            advance = NewtonKrylov(mg).step if self.method.newton else AcceleratedCycles(mg).step
        else:
            cycles = HeatedCycles(mg, heat, NewtonKrylov(mg).step if self.method.newton else mg.cycle)
            cycles.start(balance)
            advance = cycles.step
        status = iterate(mg, balance, advance, goal, self.track, watch)
        if status.ok and (heat is not None or not self.follows):
            self.error_estimate = estimate_error(mg, balance)
        return status

    def result(self, status: Status, seconds: float) -> SteadyResult:
        """Result of the solve."""
        mg, level, track = self.multigrid, self.multigrid.finest, self.track
        return SteadyResult(
            point=mg.point,
            scales=self.scales,
            domain=self.mesh.domain,
            n=self.mesh.n,
            X=level.X.copy(),
            Y=level.Y.copy(),
            P=level.P.T.copy(),
            H=level.H.T.copy(),
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
            supply=self.supply,
            temperature=self.temperature,
            asperities=self.asperities,
            sliding=self.sliding,
            thinned_share=None if self.sliding is None else self.thinned_share,
            **_content(level),
        )


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
