"""Sample points of the contact filter of waves, and the solution of one of them.

The points are scrambled Sobol points over M, L and kappa of the contacts of ball bearings. Where the film is so
thin that a table cannot afford its mesh, there is no point; the filter changes slowly there.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np

from ehlcontact import Grid, MoesPoint, __version__, excitation, impedance
from ehlcontact.errors import ConvergenceError
from ehlcontact.status import Status
from reduced_models.atlas.mesh import TableGrid
from reduced_models.atlas.sample import overshot, sobol
from reduced_models.atlas.solve import status_of
from reduced_models.atlas.table import Box

# Wave numbers per semi-axis: wavelengths from 63 a down to 1 a.
WAVE_NUMBERS = (
    0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.3, 3.7, 4.1, 4.6, 5.1, 5.7,
    2.0 * np.pi,
)  # fmt: skip
FILTERED = Box(M=(20.0, 20000.0), L=(2.0, 30.0), kappa=(0.06, 0.5), p_hertz=4e9)
OVERSHOOT = 0.04  # share of the box by which draws reach beyond it, to be moved onto its faces
# A shortest wave of 16 nodes on the default region, and of 8 where the film is thick.
GRIDS = (
    TableGrid(0.2, 96, False),
    TableGrid(0.09, 128, False),
    TableGrid(0.05, 128, True),
    TableGrid(0.03, 192, True),
)


def filter_points(draws: int, seed: int) -> dict[str, MoesPoint]:
    """Points to solve by name, in the order of their draws; more draws add to the fewer.

    What is drawn a little outside the box is moved onto its faces; a Hertz pressure above that of the box is
    brought down by M.
    """
    low, high = np.transpose([np.log(FILTERED.M), FILTERED.L, np.log(FILTERED.kappa)])
    shares = overshot(sobol(3, draws, seed), OVERSHOOT)
    points = {}
    for i, (M, L, kappa) in enumerate((low + shares * (high - low)).tolist()):
        point = MoesPoint(float(np.exp(M)), L, float(np.exp(kappa)))
        excess = max(point.p_hertz / FILTERED.p_hertz, 1.0)
        point = replace(point, M=point.M * excess**-3.0)  # pressure grows like M^(1/3)
        if point.inlet_width >= GRIDS[-1].least_inlet:
            points[f"waves-{i}"] = point
    return points


def filter_grid(point: MoesPoint) -> Grid:
    """Grid of a point: the first that serves an inlet as narrow as its."""
    return next(grid for grid in GRIDS if point.inlet_width >= grid.least_inlet).on(point)


def solve_filter(point: MoesPoint) -> dict[str, Any]:
    """G/Z of waves of all `WAVE_NUMBERS`, in JSON types; ``status`` is that of the solve."""
    started = time.perf_counter()
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa, "version": __version__}
    try:
        entry |= respond(point, filter_grid(point))
        entry["status"] = str(Status.CONVERGED)
    except ConvergenceError as error:
        entry["status"] = status_of(error)
    return entry | {"seconds": time.perf_counter() - started}


def respond(point: MoesPoint, grid: Grid) -> dict[str, Any]:
    """G/Z, real and imaginary, with the error that the mesh leaves, of waves on one surface in pure rolling."""
    k = np.array(WAVE_NUMBERS)
    waves, approach = excitation(point, Omega=k, grid=grid), impedance(point, Omega=k, grid=grid)
    ratio = waves.G / (approach.stiffness + 1j * k * approach.damping)
    found = {"real": ratio.real.tolist(), "imag": ratio.imag.tolist()}
    found["error"] = np.asarray(waves.error_bars["contact_filter"]).tolist()
    return found | {"n": waves.n, "domain": list(waves.domain.as_tuple())}
