"""Semismooth Newton on the finest grid: the equations of the multigrid cycle, linearised all at once.

Unknowns are the pressures of the free nodes and the approach u. Complementarity P >= 0 by the primal-dual
active set of `newton`; the linear systems by `linear_solve`, with factors that are kept over steps and solves
while they serve. One relaxation sweep follows every Newton step: it settles the cavitation boundary, where a
frozen active set would swing to and fro, and the steep flanks of the pressure, where the flow factor is far
from linear.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse import step_length
from ehlcontact.solver.grid import Array
from ehlcontact.solver.linear_film import LinearFilm
from ehlcontact.solver.linear_solve import solve_linear
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.preconditioner import Preconditioner
from ehlcontact.status import Status, classify

FORCING = 0.02  # to which a Newton step reduces its linear residual
WORN_OUT = 12  # Krylov iterations of one step after which the factors are renewed; fresh ones take 3 to 6
LARGEST_CHANGE = 2.0  # of the time coefficient, beyond which they are renewed


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """A preconditioner and what it was made for."""

    preconditioner: Preconditioner
    c_t: float


@dataclass(frozen=True, slots=True, eq=False)
class NewtonOutcome:
    """End of a Newton solve; P and H are on the finest level."""

    u: float
    residuals: Array  # (steps + 1,) mean |residual| over P > 0
    load_residual: float
    krylov_iterations: int
    factorisations: int
    status: Status

    @property
    def steps(self) -> int:
        """Newton steps taken."""
        return self.residuals.size - 1


class NewtonKrylov:
    """Newton steps on the state of a `Multigrid`; `step` stands where `Multigrid.cycle` does.

    The levels below the finest lend their arrays to the preconditioner, so steps and cycles may alternate.
    """

    def __init__(self, multigrid: Multigrid) -> None:
        self.multigrid = multigrid
        self.prepared: Prepared | None = None
        self.krylov_iterations = 0
        self.factorisations = 0

    def step(self, balance: Balance) -> None:
        """One Newton step and one relaxation sweep; state of the multigrid written, as by `Multigrid.cycle`."""
        mg, level = self.multigrid, self.multigrid.finest
        r = level.r
        free = (level.P > 0.0) | (r < 0.0)
        system = LinearFilm(level, free, balance)
        b = system.right_hand_side(r, balance.residual(mg.u, level.force()))
        if not np.isfinite(b).all():
            return  # the driver finds the same residual, and reports it
        prepared = self.prepared
        if prepared is None or not _alike(prepared.c_t, level.c_t):
            prepared = self.prepared = Prepared(Preconditioner(mg.levels, system), level.c_t)
            self.factorisations += 1
        solution = solve_linear(system, prepared.preconditioner, b, FORCING)
        self.krylov_iterations += solution.iterations
        if solution.iterations > WORN_OUT:
            self.prepared = None
        dP = solution.x[:-1].reshape(level.P.shape)
        damping = step_length(dP, float(solution.x[-1]), mg.u)
        level.P[...] = np.maximum(level.P + damping * dP, 0.0)
        mg.u += damping * float(solution.x[-1])
        level.update(mg.u)
        level.relax()
        level.update(mg.u)

    def solve(
        self,
        balance: Balance,
        scale: float,
        tol: float,
        max_steps: int = 20,
        settle: float = 1e-7,
        callback: Callable[[int, float], None] | None = None,
    ) -> NewtonOutcome:
        """Steps until the mean |residual| is below ``tol scale``, and balance and last change of u below `settle`.

        Parameters
        ----------
        balance : Balance
        scale : float
            Residual to measure by, as in `status.classify`.
        tol : float
            Relative to `scale`.
        max_steps : int
        settle : float
            Absolute, in dry approaches and loads.
        callback : callable, optional
            Called with the step number and the relative residual before it.

        Returns
        -------
        NewtonOutcome
            `status` tells whether it converged; nothing is raised.
        """
        mg, level = self.multigrid, self.multigrid.finest
        krylov, factorisations = self.krylov_iterations, self.factorisations
        residuals: list[float] = []
        change, status = np.inf, None
        level.update(mg.u)
        while status is None:
            residuals.append(level.residual_norm())
            load_residual = balance.residual(mg.u, level.force())
            settled = change < settle and abs(load_residual) < settle
            status = classify(residuals, scale, tol, settled, max_steps)
            if status is None:
                previous = mg.u
                self.step(balance)
                change = abs(mg.u - previous)
                if callback is not None:
                    callback(len(residuals), residuals[-1] / scale)
        return NewtonOutcome(
            mg.u,
            np.array(residuals),
            load_residual,
            self.krylov_iterations - krylov,
            self.factorisations - factorisations,
            status,
        )


def solve_newton(multigrid: Multigrid, balance: Balance, scale: float, tol: float) -> NewtonOutcome:
    """Full multigrid with one cycle on every level, then Newton; P, H and u of `multigrid` written.

    Raises nothing; parameters as for `NewtonKrylov.solve`.
    """
    multigrid.full_multigrid(balance)
    multigrid.cycle(balance)
    return NewtonKrylov(multigrid).solve(balance, scale, tol)


def _alike(a: float, b: float) -> bool:
    return max(a, b) <= LARGEST_CHANGE * min(a, b)
