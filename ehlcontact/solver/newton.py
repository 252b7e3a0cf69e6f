"""Semismooth Newton on the finest grid: all equations linearised together.

Unknowns are the pressures of the active nodes and the approach u. Complementarity P >= 0 by the primal-dual
active set of `coarse_newton`; the linear systems by `linear`, with factors that are kept over steps while
they serve. One relaxation sweep follows every Newton step: it settles the cavitation boundary, where a
frozen active set would swing to and fro, and the steep flanks of the pressure, where the Poiseuille coefficient
is far from linear.
"""

from __future__ import annotations

import numpy as np

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse_newton import step_length
from ehlcontact.solver.linear import LinearFilm, Preconditioner, solve_linear
from ehlcontact.solver.multigrid import Multigrid

FORCING = 0.02  # to which a Newton step reduces its linear residual
WORN_OUT = 12  # Krylov iterations of one step after which the factors are renewed; fresh ones take 3 to 6


class NewtonKrylov:
    """Newton steps on the state of a `Multigrid`; `step` stands where `Multigrid.cycle` does.

    The levels below the finest lend their arrays to the preconditioner, so steps and cycles may alternate.
    """

    def __init__(self, multigrid: Multigrid) -> None:
        self.multigrid = multigrid
        self._preconditioner: Preconditioner | None = None

    def step(self, balance: Balance) -> float:
        """One Newton step and one relaxation sweep, as `Multigrid.cycle`; returns the largest change of P."""
        mg, level = self.multigrid, self.multigrid.finest
        r = level.r
        free = (level.P > 0.0) | (r < 0.0)
        system = LinearFilm(level, free, balance)
        b = system.right_hand_side(r, balance.residual(mg.u, level.force()))
        if not np.isfinite(b).all():
            return np.inf  # the driver finds the same residual, and reports it
        if self._preconditioner is None:
            self._preconditioner = Preconditioner(mg.levels, system)
        solution = solve_linear(system, self._preconditioner, b, FORCING)
        if solution.iterations > WORN_OUT:
            self._preconditioner = None
        dP = solution.x[:-1].reshape(level.P.shape)
        damping = step_length(dP, float(solution.x[-1]), mg.u)
        before = level.P.copy()
        level.P[...] = np.maximum(level.P + damping * dP, 0.0)
        mg.u += damping * float(solution.x[-1])
        level.update(mg.u)
        level.relax()
        level.update(mg.u)
        return float(np.abs(level.P - before).max())
