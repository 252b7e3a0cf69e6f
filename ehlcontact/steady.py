"""Steady film of a contact: full multigrid, then V cycles until both residuals hold."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from ehlcontact.domain import Domain, check_domain, check_intervals
from ehlcontact.errors import ConvergenceError, require_finite, require_integer, require_positive
from ehlcontact.grid import Level
from ehlcontact.multigrid import Multigrid
from ehlcontact.newton import Balance
from ehlcontact.results import SteadyResult
from ehlcontact.scaling import Point, moes_point, scales_of
from ehlcontact.status import Status, classify
from ehlcontact.version import __version__

LOAD_TOLERANCE = 1e-7
APPROACH_TOLERANCE = 1e-7
BORDER_SLOPE = 0.1  # of the maximum per semi-axis, at inlet and sides
BORDER_PRESSURE = 0.02  # of the maximum, beside the outlet; a film that ends outside the grid is not computed


def solve_steady(
    point: Point,
    *,
    n: int = 128,
    domain: Domain | None = None,
    approach: float | None = None,
    tol: float = 3e-5,
    max_cycles: int = 40,
    throw: bool = True,
    callback: Callable[[int, float], None] | None = None,
) -> SteadyResult:
    """Solve Reynolds, film and load balance (eqs. 1, 3, 4) for the steady contact.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    n : int
        Intervals along X, a multiple of 16.
    domain : Domain, optional
        Computed region; by default ``Domain()``, wider at light load.
    approach : float, optional
        Prescribe the approach (dry Hertz value 1) instead of the load.
    tol : float
        Mean |residual| over P > 0 relative to that of the dry Hertz start on the same grid.
    max_cycles : int
        Limit of V(2,1) cycles on the finest grid.
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
    n, domain = check_intervals(n), check_domain(domain, moes)
    require_integer("max_cycles", max_cycles, "a whole number > 0", 1)
    multigrid = Multigrid(moes, domain, n)
    require_positive("tol", tol)
    if approach is None:
        balance = Balance(0.0, 1.0, 1.0)
    else:
        multigrid.u = require_finite("approach", approach)
        balance = Balance(1.0, 0.0, multigrid.u)
    level = multigrid.finest
    scale = dry_residual(level)
    multigrid.full_multigrid(balance)
    residuals: list[float] = []
    load_residuals: list[float] = []
    changes: list[float] = []
    status = None
    while status is None:
        level.update_film(multigrid.u)
        level.update_residual()
        residuals.append(level.residual_norm())
        load_residuals.append(balance.residual(multigrid.u, level.force()))
        settled = bool(changes) and changes[-1] < APPROACH_TOLERANCE and abs(load_residuals[-1]) < LOAD_TOLERANCE
        status = classify(residuals, scale, tol, settled, max_cycles)
        if status is None:
            previous = multigrid.u
            try:
                multigrid.cycle(balance)
                changes.append(abs(multigrid.u - previous))
                if callback is not None:
                    callback(len(changes), residuals[-1] / scale)
            except KeyboardInterrupt:
                status = Status.INTERRUPTED
    status = judge(status, level)
    result = SteadyResult(
        point=moes,
        scales=scales_of(point),
        domain=domain,
        n=n,
        X=level.X.copy(),
        Y=level.Y.copy(),
        P=level.P.T.copy(),
        H=level.H.T.copy(),
        approach=float(multigrid.u),
        force=level.force(),
        h_central=central_film(level),
        h_min=float(level.H.min()),
        residuals=np.array(residuals),
        load_residuals=np.array(load_residuals),
        approach_changes=np.array(changes),
        dry_residual=scale,
        status=status,
        seconds=time.perf_counter() - started,
        version=__version__,
    )
    if throw and not status.ok and status is not Status.INTERRUPTED:
        raise ConvergenceError(f"steady solve {status}: {status.advice}", result)
    return result


def dry_residual(level: Level) -> float:
    """Mean |residual| of the dry Hertz pressure on this grid, the scale of all residuals; P and H written."""
    level.set_dry_hertz()
    level.update_film(1.0)
    level.update_residual()
    return level.residual_norm()


def central_film(level: Level) -> float:
    """Film at X = Y = 0, by quadratic interpolation where no node lies there."""
    i = int(np.clip(np.searchsorted(level.X, 0.0) - 1, 1, level.nx - 2))
    s = -level.X[i] / level.hx
    left, centre, right = level.H[0, i - 1 : i + 2]
    return float(centre + 0.5 * s * (right - left) + 0.5 * s * s * (right - 2.0 * centre + left))


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
