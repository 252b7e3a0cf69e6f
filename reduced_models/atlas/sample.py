"""Sample points of the atlas: quasi-random sequences in its box with a margin.

Three sets of scrambled Sobol points: over the whole box; over its light loads, where answers change more; and over
those among them where the film turns from one that lifts rigid bodies to one between flattened ones, where they
change most. The first two are denser at small L.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.film_formulas import load_number
from ehlcontact.point import MoesPoint
from reduced_models.atlas.table import Box

_Floats = NDArray[np.float64]

OVERSHOOT = 0.08  # share of the cube by which draws reach beyond it, to be moved onto its faces
PRESSURE_OVERSHOOT = 1.15  # likewise beyond the largest Hertz pressure
SAMPLED = Box(M=(0.95, 33000.0), L=(0.002, 31.0), kappa=(0.0432, 1.06), p_hertz=4.25e9)
WARP_L = 1.5  # power of the draw, even in L at 1: denser at small L
INLET_SPARSE = 0.05  # inlet width below which every second point is left out: dear to solve, and changing slowly
LIGHT = 15.0  # load number up to which the second set reaches
TURN = (0.8, 10.0)  # and from where to where the third


class _Set(NamedTuple):
    """One sequence of draws."""

    name: str
    draws: int
    load_numbers: tuple[float, float] | None  # between which M is drawn; by default over the box
    warp: float


def sample_points(draws: int, light_draws: int, seed: int) -> dict[str, MoesPoint]:
    """Points to solve by name; more draws add to the fewer, a few of which fall away.

    What is drawn a little outside is moved onto the faces, so that the edges are interpolated too; a Hertz
    pressure a little too high is brought down by M, one far too high leaves the draw out.

    Parameters
    ----------
    draws, light_draws : int
        Over the whole box, and over the light loads, with half as many again where the film turns.
    seed : int
        Of the scrambling.
    """
    sets = (
        _Set("all", draws, None, WARP_L),
        _Set("light", light_draws, (0.0, LIGHT), WARP_L),
        _Set("turn", light_draws // 2, TURN, 1.0),
    )
    points: dict[str, MoesPoint] = {}
    for k, which in enumerate(sets):
        thin = 0
        for i, point in enumerate(_drawn(which, seed + k)):
            excess = point.p_hertz / SAMPLED.p_hertz
            if excess > PRESSURE_OVERSHOOT:
                continue
            if point.inlet_width < INLET_SPARSE:  # not by i: its parity tells in which half of the cube a draw is
                thin += 1
                if thin % 2 == 0:
                    continue
            # pressure grows like M^(1/3)
            points[f"{which.name}-{i}"] = replace(point, M=point.M * max(excess, 1.0) ** -3.0)
    return points


def _drawn(which: _Set, seed: int) -> Iterator[MoesPoint]:
    """All draws of a set."""
    for u, v, w in overshot(sobol(3, which.draws, seed), OVERSHOOT).tolist():
        kappa, ends = between(SAMPLED.kappa, w), SAMPLED.M
        if which.load_numbers is not None:
            low, high = (N / load_number(1.0, kappa) for N in which.load_numbers)
            ends = max(SAMPLED.M[0], low), high
        yield MoesPoint(between(ends, u), SAMPLED.L[0] + (SAMPLED.L[1] - SAMPLED.L[0]) * v**which.warp, kappa)


def sobol(axes: int, draws: int, seed: int) -> _Floats:
    """Scrambled Sobol points of the unit cube, shape (draws, axes); more draws add to the fewer."""
    from scipy.stats import qmc  # of all that is imported here it takes longest

    # Sobol sequences are balanced by powers of 2, but any beginning will do here.
    found = qmc.Sobol(axes, seed=seed).random_base2(math.ceil(math.log2(max(draws, 1))))
    return np.asarray(found[:draws])


def overshot(found: _Floats, by: float) -> _Floats:
    """Draws stretched beyond the cube by a share of it and moved onto its faces, so that edges are sampled too."""
    return np.clip(found * (1.0 + 2.0 * by) - by, 0.0, 1.0)


def between(ends: tuple[float, float], share: float) -> float:
    """Geometric mean of two ends, weighted by a share."""
    return ends[0] * (ends[1] / ends[0]) ** share
