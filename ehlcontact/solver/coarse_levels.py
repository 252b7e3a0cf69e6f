"""Coarse levels of full multigrid: the coarsest grid of a hierarchy, and the load that each level carries."""

from __future__ import annotations

from dataclasses import replace
from math import exp, log

from scipy.optimize import brentq

from ehlcontact.point import MoesPoint
from ehlcontact.solver.mesh import thin_sides

NEGATIVE_FILM = 0.8  # mesh over inlet width above which a film comes out negative: a level carries less load then,
LOADING_MESH = 0.4  # as much as it resolves this well
LOBE_SHARE = 0.5  # that a second attempt takes this share of both mesh sizes: stiff oil does better without
LEAST_NESTED = 256  # intervals of the coarsest grid with close lines: below, levels end elsewhere
HIGH_LOAD = 1000.0  # M from which the coarsest grid has to see more of the inlet
NARROW = 2.0  # kappa above which it needs more lines across rolling:
NARROW_COARSEST = 64  # levels of fewer intervals, on larger grids, have one or two and correct nothing


def coarsest_intervals(point: MoesPoint, n: int) -> int:
    """Intervals of the coarsest grid below n: 16; more at high load, to see the inlet, and for narrow ellipses.

    With thin sides too few lines across the contact correct nothing: cycles diverge from 32 intervals. A small
    grid is left some levels.
    """
    if thin_sides(point):
        fewest = 64
    elif point.kappa > NARROW:
        fewest = 32
    else:
        fewest = 16 if point.M < HIGH_LOAD else 24
    return min(fewest, max(32, n // 4))


def level_is_useful(point: MoesPoint, nx: int, n: int, load_continuation: bool = False) -> bool:
    """Whether a level of `nx` intervals below `n` has enough lines to correct errors in a narrow ellipse.

    With six lines across thin side lobes an error is left that grows on every level above; load continuation
    therefore needs twice as many.
    """
    return point.kappa <= NARROW or nx >= min(NARROW_COARSEST * (1 + load_continuation), n // 4)


def resolved_load(point: MoesPoint, mesh: float) -> float:
    """Moes load, at most that of `point`, which a mesh size (in semi-axes) carries with a positive film."""

    def excess(log_load: float) -> float:
        return replace(point, M=exp(log_load)).inlet_width * LOADING_MESH - mesh

    highest = log(point.M)
    lowest = min(0.0, highest)
    if mesh <= NEGATIVE_FILM * point.inlet_width or excess(highest) >= 0.0:
        return point.M
    if excess(lowest) <= 0.0:
        return exp(lowest)
    return exp(float(brentq(excess, lowest, highest, xtol=1e-3)))
