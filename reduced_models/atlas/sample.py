"""Where the atlas is sampled: its box with a margin, and the points in it.

Two sets of scrambled Sobol points: one over the whole box, one over the light loads, where the answers change
most. In both, points are denser at small L.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.stats import qmc

from ehlcontact.formulas import load_number
from ehlcontact.point import MoesPoint
from reduced_models.atlas.table import Box

OVERSHOOT = 0.08  # share of the cube by which draws reach beyond it, to be moved onto its faces
PRESSURE_OVERSHOOT = 1.15  # likewise beyond the largest Hertz pressure
SAMPLED = Box(M=(0.95, 33000.0), L=(0.002, 31.0), kappa=(0.0432, 1.06), p_hertz=4.25e9)
WARP_M, WARP_L = 1.0, 1.5  # powers of the draw, even in ln M and in L at 1: denser at small L
INLET_SPARSE = 0.05  # inlet width below which every second point is left out: dear to solve, and changing slowly
LIGHT = 15.0  # load number up to which the second set reaches


def sample_points(draws: int, light_draws: int, seed: int, box: Box = SAMPLED) -> dict[str, MoesPoint]:
    """Points to solve by name; more draws add to the fewer, a few of which fall away.

    What is drawn a little outside is moved onto the faces, so that the edges are interpolated too; a Hertz
    pressure a little too high is brought down by M, one far too high leaves the draw out.

    Parameters
    ----------
    draws, light_draws : int
        Over the whole box, and over the light loads.
    seed : int
        Of the scrambling.
    """
    points: dict[str, MoesPoint] = {}
    for name, count, light in (("all", draws, False), ("light", light_draws, True)):
        # Sobol sequences are balanced by powers of 2, but any beginning will do here.
        engine = qmc.Sobol(3, seed=seed + light)
        drawn = engine.random_base2(math.ceil(math.log2(max(count, 1))))[:count]
        cube = np.clip(drawn * (1.0 + 2.0 * OVERSHOOT) - OVERSHOOT, 0.0, 1.0)
        thin = 0
        for i, (u, v, w) in enumerate(cube.tolist()):
            kappa = _between(box.kappa, w)
            highest = LIGHT / load_number(1.0, kappa) if light else box.M[1]
            M = _between((box.M[0], highest), u if light else u**WARP_M)
            point = MoesPoint(M, box.L[0] + (box.L[1] - box.L[0]) * v**WARP_L, kappa)
            excess = point.p_hertz / box.p_hertz
            if excess > PRESSURE_OVERSHOOT:
                continue
            if point.inlet_width < INLET_SPARSE:  # not by i: its parity tells in which half of the cube a draw is
                thin += 1
                if thin % 2 == 0:
                    continue
            if excess > 1.0:  # pressure grows like M^(1/3)
                point = replace(point, M=point.M * excess**-3.0)
            points[f"{name}-{i}"] = point
    return points


def _between(ends: tuple[float, float], share: float) -> float:
    return ends[0] * (ends[1] / ends[0]) ** share
