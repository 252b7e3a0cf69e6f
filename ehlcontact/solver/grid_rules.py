"""Limits of ellipse ratio, inlet width, M and L for grid size, coarse levels and the load that they carry.

`kappa` = a/b is the Hertz semi-axis along rolling over that across (not the viscosity ratio of ISO 281). A wide
contact (kappa < 1, ball bearings) has the inlet as its narrowest feature. In a long one (kappa > 1) oil leaks out
over the sides all the way: the film in the side lobes falls to a tenth and less of the central film.

The width of the inlet (`MoesPoint.inlet_width`), in semi-axes, measures how thin the film is: the pressure of the
inlet rises to that of the dry contact over it, and the mesh has to resolve it.
"""

from __future__ import annotations

from dataclasses import replace
from math import exp, floor, log, log2

import scipy

from ehlcontact.point import MoesPoint

# Ellipse ratio -------------------------------------------------------------------------------------------------
SIDE_LOBES = 0.7  # kappa above which the film in the side lobes is thinner than in the outlet
LONG = 1.0  # kappa above which the side lobes of thin films are much thinner than the inlet
VERY_LONG = 2.0  # kappa above which coarse grids need more lines across rolling
LINES_APART = 5.0  # physical distance of lines over that of nodes, from which a level is coarsened along X alone

# Inlet width, in semi-axes -------------------------------------------------------------------------------------
THIN_INLET = 0.06  # below which the near region may be tried after a failure
VERY_THIN_INLET = 0.03  # below which it is chosen at once: cycles on more oil converge slowly
# The pressure spike of stiff oil needs a finer mesh where the film moves; else C at Omega 5 is 40 % off.
STIFF_OIL, SPIKE_INLET = 20.0, 1.0  # L above which, and inlet width below which, there is such a spike

# Coarse levels of full multigrid -------------------------------------------------------------------------------
HIGH_LOAD = 1000.0  # M from which the coarsest grid has to resolve more of the inlet
VERY_LONG_COARSEST = 64  # intervals; coarser levels of very long contacts have one or two lines in a side lobe
NEGATIVE_FILM = 0.8  # mesh over inlet width above which a film comes out negative: a level carries less load then,
LOADING_MESH = 0.4  # as much as it resolves this well
LOBE_SHARE = 0.5  # that a second attempt takes this share of both mesh sizes: stiff oil does better without
LEAST_NESTED = 256  # intervals of the coarsest grid with close lines: below, levels end elsewhere


def has_side_lobes(point: MoesPoint) -> bool:
    """Whether the smallest film lies in the side lobes and not in the outlet."""
    return point.kappa > SIDE_LOBES


def is_long(point: MoesPoint) -> bool:
    """Whether the contact is long along rolling, so that thin side lobes need a treatment of their own."""
    return point.kappa > LONG


def is_very_long(point: MoesPoint) -> bool:
    """Whether so few lines lie across a side lobe that coarse levels need more of them."""
    return point.kappa > VERY_LONG


def longer_axis(kappa: float) -> float:
    """Longer Hertz semi-axis over that along rolling; mesh sizes are measured in the longer one."""
    return max(1.0, kappa)


def x_coarsenings(kappa: float) -> int:
    """Number of finest levels that are coarsened along X alone, because lines of a wide contact lie far apart."""
    return max(floor(log2(max(1.0, 1.0 / kappa) / LINES_APART)) + 1, 0)


def has_thin_inlet(point: MoesPoint) -> bool:
    """Whether the film is so thin that oil further out makes little difference to it."""
    return point.inlet_width < THIN_INLET


def has_very_thin_inlet(point: MoesPoint) -> bool:
    """Whether the film is so thin that only the near region is affordable."""
    return point.inlet_width < VERY_THIN_INLET


def has_thin_sides(point: MoesPoint) -> bool:
    """Whether the side lobes, not the inlet, set the mesh."""
    return has_side_lobes(point) and has_very_thin_inlet(point)


def has_spike(point: MoesPoint) -> bool:
    """Whether stiff oil has a pressure spike that the mesh of a moving film has to resolve."""
    return point.L > STIFF_OIL and point.inlet_width < SPIKE_INLET


def coarsest_intervals(point: MoesPoint, n: int) -> int:
    """Intervals of the coarsest grid below n: 16; more at high load, to resolve the inlet, and for long contacts.

    With thin sides too few lines across the contact correct nothing: cycles diverge from 32 intervals. A small
    grid is left some levels.
    """
    if has_thin_sides(point):
        fewest = 64
    elif is_very_long(point):
        fewest = 32
    else:
        fewest = 16 if point.M < HIGH_LOAD else 24
    return min(fewest, max(32, n // 4))


def level_is_useful(point: MoesPoint, nx: int, n: int, load_continuation: bool = False) -> bool:
    """Whether a level of `nx` intervals below `n` has enough lines to correct errors in a very long contact.

    With six lines across thin side lobes an error is left that grows on every level above; load continuation
    therefore needs twice as many.
    """
    return not is_very_long(point) or nx >= min(VERY_LONG_COARSEST * (1 + load_continuation), n // 4)


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
    return exp(float(scipy.optimize.brentq(excess, lowest, highest, xtol=1e-3)))
