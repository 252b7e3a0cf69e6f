"""Solutions on grids of half and a quarter of the intervals, for the error estimate of a film.

Each starts from the restricted film of the grid above and differs from its own solution by that film's error only,
so two cycles are enough.
"""

from __future__ import annotations

import numpy as np
import scipy

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.kernels import transfer
from ehlcontact.solver.level import Level
from ehlcontact.solver.multigrid import Multigrid

CYCLES = 2  # on each of both grids: what is left is a hundredth of the difference


def estimate_error(solved: Multigrid, balance: Balance) -> ErrorEstimate | None:
    """Error of the film solved; the levels below the finest are written. None where there is none.

    Where the level below has the same lines, or as many nodes on them (`level.build_hierarchy`), it says nothing
    about theirs: the grid with half of both is made.
    """
    multigrid, k, u = solved, len(solved.levels) - 1, solved.u
    found = [_numbers(solved.finest, u)]
    for _ in range(2):
        fine, coarsest = multigrid.levels[k], multigrid.levels[0]
        if fine.nx == coarsest.nx:
            break
        k -= 1
        if multigrid.levels[k].ny == fine.ny or multigrid.levels[k].nx == fine.nx:
            multigrid = multigrid.halved()
            k = len(multigrid.levels) - 1
        transfer.restrict_pressure(fine.P, multigrid.levels[k].P, 2, 2)
        # a feature at rest on the surfaces is part of the film, and of those that tell its error
        shift = fine.film_shift if isinstance(fine.film_shift, float) else fine.film_shift[::2, ::2]
        u = multigrid.settle(k, u, balance, CYCLES, shift)
        found.append(_numbers(multigrid.levels[k], u))
    return ErrorEstimate.of(found) if len(found) > 1 else None


def settled_on_half(solved: Multigrid, balance: Balance) -> Multigrid:
    """The film on half the intervals, from that of `solved`; its `finest` may be negative somewhere."""
    half = solved.halved()
    fine, coarse = solved.finest, half.finest
    between = scipy.interpolate.RectBivariateSpline(fine.Y, fine.X, fine.P, kx=1, ky=1, s=0)
    coarse.P[...] = np.maximum(between(coarse.Y, coarse.X), 0.0)
    coarse.P[:, [0, -1]] = 0.0
    coarse.P[-1] = 0.0
    half.u = solved.u
    coarse.update(half.u)
    with np.errstate(over="ignore", invalid="ignore"):  # of a film that runs away
        for _ in range(CYCLES):
            half.cycle(balance)
    return half


def _numbers(level: Level, u: float) -> tuple[float, float, float]:
    return u, level.central_film(), level.lowest_film()
