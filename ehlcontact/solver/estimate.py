"""The film solved, on the two levels below: what its `ErrorEstimate` is made of.

Each level starts from the film above it, restricted, and differs from its own solution by that film's error only:
two cycles are enough.
"""

from __future__ import annotations

from ehlcontact.solver.accuracy import ErrorEstimate
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.kernels import transfer
from ehlcontact.solver.level import Level
from ehlcontact.solver.multigrid import Multigrid

CYCLES = 2  # on each of both levels: what is left is a hundredth of the difference


def estimate_error(solved: Multigrid, balance: Balance) -> ErrorEstimate | None:
    """Error of the film solved; the levels below the finest are written. None where there is none."""
    levels, u = solved.levels, solved.u
    found = [_numbers(solved.finest, u)]
    for fine, k in ((k + 1, k) for k in reversed(range(len(levels) - 1)[-2:])):
        transfer.restrict_pressure(levels[fine].P, levels[k].P)
        u = solved.settle(k, u, balance, CYCLES)
        found.append(_numbers(levels[k], u))
    return ErrorEstimate.of(found) if len(found) > 1 else None


def _numbers(level: Level, u: float) -> tuple[float, float, float]:
    return u, level.central_film(), level.lowest_film()
