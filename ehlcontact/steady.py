"""Steady film of a contact: full multigrid, then V cycles until both residuals hold."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from math import isfinite
from typing import NamedTuple

import numpy as np

from ehlcontact.checks import require_choice, require_finite, require_integer, require_positive
from ehlcontact.errors import ConvergenceError
from ehlcontact.point import MoesPoint, Point, Scales, moes_point, scales_of
from ehlcontact.results import SteadyResult
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.domain import Domain, check_domain, check_intervals, default_domain
from ehlcontact.solver.grid import Level
from ehlcontact.solver.lowest_film import lowest_film
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.newton import NewtonKrylov
from ehlcontact.solver.resolution import automatic_mesh, nodes, refined_mesh
from ehlcontact.status import Status, classify

LOAD_TOLERANCE = 1e-7
APPROACH_TOLERANCE = 1e-7
LARGEST_ATTEMPTS = 4  # of an automatic mesh
LARGEST_NEWTON = 300_000  # nodes: sparse factors take minutes and gigabytes beyond
FAILED = (Status.STAGNATED, Status.DIVERGED, Status.MAX_CYCLES, Status.NONFINITE)
REFINED = (*FAILED, Status.UNRESOLVED)
ROOM = 1.5  # growth of a domain that pressure fills
BORDER_SLOPE = 0.1  # of the maximum per semi-axis, at inlet and sides
BORDER_PRESSURE = 0.02  # of the maximum, beside the outlet; a film that ends outside the grid is not computed


class Way(NamedTuple):
    """How one mesh is solved."""

    newton: bool
    cautious: bool  # relaxation: slower, and does not swing from line to line where others do


LAST_RESORT = Way(True, True)
WAYS = {
    "automatic": (Way(False, False), Way(False, True), LAST_RESORT),
    "multigrid": (Way(False, False),),
    "newton": (Way(True, False),),
}


def solve_steady(
    point: Point,
    *,
    n: int | None = None,
    domain: Domain | None = None,
    approach: float | None = None,
    tol: float = 3e-5,
    max_cycles: int = 80,
    method: str = "automatic",
    throw: bool = True,
    callback: Callable[[int, float], None] | None = None,
) -> SteadyResult:
    """Solve Reynolds, film and load balance (eqs. 1, 3, 4) for the steady contact.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    n : int
        Intervals along X, a multiple of 16; by default as many as the film needs, 128 or more.
    domain : Domain, optional
        Computed region; by default ``Domain()``, wider at light load, and with `n` left out narrower where the
        film is too thin for a grid of that extent.
    approach : float, optional
        Prescribe the approach (dry Hertz value 1) instead of the load; above 1 the default domain widens for the
        force it takes.
    tol : float
        Mean |residual| over P > 0 relative to that of the dry Hertz start on the same grid.
    max_cycles : int
        Limit of V(2,1) cycles, or of Newton steps, on the finest grid.
    method : {"automatic", "multigrid", "newton"}
        V cycles, or Newton steps from the same full-multigrid start; both solve the same equations.
        ``"automatic"`` cycles; where that fails it cycles with cautious relaxation, and at last, on grids that
        allow it, turns to Newton.
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
        An argument outside its range.
    ConvergenceError
        Not converged; ``error.result`` holds the partial result.
    """
    started = time.perf_counter()
    moes = moes_point(point)
    require_integer("max_cycles", max_cycles, "a whole number > 0", 1)
    require_positive("tol", tol)
    require_choice("method", method, tuple(WAYS))
    if approach is None:
        balance = Balance.of_load()
    else:
        balance = Balance.of_approach(require_finite("approach", approach))
        if approach > 1.0 and domain is None:
            domain = default_domain(moes, approach**1.5)
    attempts = _meshes(moes, n, domain)
    mesh = next(attempts)
    while mesh is not None:
        for way in WAYS[method]:
            if way is LAST_RESORT and nodes(*mesh, moes.kappa) > LARGEST_NEWTON:
                break
            solved = _Solve(moes, *mesh, balance, tol, max_cycles, callback, way.cautious)
            status = solved.run(way.newton)
            if status not in FAILED:
                break
        mesh = attempts.send(status)
    result = solved.result(status, scales_of(point), time.perf_counter() - started)
    if throw and not status.ok and status is not Status.INTERRUPTED:
        raise ConvergenceError(f"steady solve {status}: {status.advice}", result)
    return result


class _Solve:
    """One solve on one mesh, from full multigrid to a judged status."""

    def __init__(
        self,
        point: MoesPoint,
        n: int,
        domain: Domain,
        balance: Balance,
        tol: float,
        max_cycles: int,
        callback: Callable[[int, float], None] | None,
        cautious: bool,
    ) -> None:
        self.n, self.domain, self.balance = n, domain, balance
        self.tol, self.max_cycles, self.callback = tol, max_cycles, callback
        self.multigrid = Multigrid(point, domain, n, cautious=cautious)
        if balance.weight == 0.0:
            self.multigrid.u = balance.rhs
        self.scale = dry_residual(self.multigrid.finest)
        self.residuals: list[float] = []
        self.load_residuals: list[float] = []
        self.changes: list[float] = []

    def run(self, newton: bool) -> Status:
        """Cycle, or take Newton steps, until the residuals say how it ended."""
        advance = NewtonKrylov(self.multigrid).step if newton else self.multigrid.cycle
        try:
            self.multigrid.full_multigrid(self.balance)
            if newton:
                self.multigrid.cycle(self.balance)
            status = self._measure()
            while status is None:
                previous = self.multigrid.u
                advance(self.balance)
                self.changes.append(abs(self.multigrid.u - previous))
                if self.callback is not None:
                    self.callback(len(self.changes), self.residuals[-1] / self.scale)
                status = self._measure()
        except KeyboardInterrupt:
            return Status.INTERRUPTED
        return judge(status, self.multigrid.finest)

    def _measure(self) -> Status | None:
        mg, level = self.multigrid, self.multigrid.finest
        self.residuals.append(level.residual_norm())
        self.load_residuals.append(self.balance.residual(mg.u, level.force()))
        settled = bool(self.changes) and self.changes[-1] < APPROACH_TOLERANCE
        settled = settled and abs(self.load_residuals[-1]) < LOAD_TOLERANCE
        if not isfinite(self.load_residuals[-1]):  # a pressure of NaN has no residual
            return Status.NONFINITE
        return classify(self.residuals, self.scale, self.tol, settled, self.max_cycles)

    def result(self, status: Status, scales: Scales | None, seconds: float) -> SteadyResult:
        """Everything that is kept."""
        mg, level = self.multigrid, self.multigrid.finest
        return SteadyResult(
            point=mg.point,
            scales=scales,
            domain=self.domain,
            n=self.n,
            X=level.X.copy(),
            Y=level.Y.copy(),
            P=level.P.T.copy(),
            H=level.H.T.copy(),
            approach=float(mg.u),
            force=level.force(),
            h_central=central_film(level),
            h_min=minimum_film(level),
            residuals=np.array(self.residuals),
            load_residuals=np.array(self.load_residuals),
            approach_changes=np.array(self.changes),
            dry_residual=self.scale,
            status=status,
            seconds=seconds,
        )


def _meshes(
    point: MoesPoint, n: int | None, domain: Domain | None
) -> Generator[tuple[int, Domain] | None, Status, None]:
    """Meshes to try one after the other: yields (n, domain), takes the status it led to, ends with None.

    With `n` given there is one. Otherwise a film that the mesh does not resolve gets a finer one, and with the
    domain left open a pressure that reaches its border gets more room.
    """
    if n is not None:
        yield check_intervals(n), check_domain(domain, point)
        yield None
        return
    mesh, region = automatic_mesh(point, check_domain(domain, point) if domain is not None else None)
    for _ in range(LARGEST_ATTEMPTS):
        status = yield mesh, region
        if status is Status.OUT_OF_DOMAIN and domain is None:
            region = region.scaled(ROOM)
        elif status in REFINED and (finer := refined_mesh(point, mesh, region, domain is None)) is not None:
            mesh, region = finer
        else:
            break
    yield None


def dry_residual(level: Level) -> float:
    """Mean |residual| of the dry Hertz pressure on this grid, the scale of all residuals; P and H written."""
    level.set_dry_hertz()
    level.update(1.0)
    return level.residual_norm()


def central_film(level: Level) -> float:
    """Film at X = Y = 0, by quadratic interpolation where no node lies there."""
    i = int(np.clip(np.searchsorted(level.X, 0.0) - 1, 1, level.nx - 2))
    s = -level.X[i] / level.hx
    left, centre, right = level.H[0, i - 1 : i + 2]
    return float(centre + 0.5 * s * (right - left) + 0.5 * s * s * (right - 2.0 * centre + left))


def minimum_film(level: Level) -> float:
    """Smallest film, between the nodes too; not above that of the lowest node."""
    return lowest_film(level.H)[0]


def judge(status: Status, level: Level) -> Status:
    """Status of a solve whose residuals say `status`: converged only with a film, and within the domain."""
    if status is Status.CONVERGED and not level.H.min() > 0.0:
        return Status.UNRESOLVED
    if status is Status.CONVERGED and touches_border(level):
        return Status.OUT_OF_DOMAIN
    return status


def touches_border(level: Level) -> bool:
    """Whether pressure reaches the border of the domain: at the outlet, or steeply at inlet or sides."""
    P = level.P
    steepness = max(P[:, 1].max() / level.hx, P[-2].max() / level.hy)
    return bool(P[:, -2].max() > BORDER_PRESSURE * P.max() or steepness > BORDER_SLOPE * P.max())
