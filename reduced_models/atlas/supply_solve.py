"""Solution of one sample point of the supply table: the contact flooded, and under several layers of oil.

All on one grid and region, so that what is kept of them, the change, has little of the errors of either.
"""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from ehlcontact import Domain, Grid, MoesPoint, OilLayer, __version__, solve_steady
from ehlcontact.errors import ConvergenceError
from ehlcontact.impedance import NEAR_ZERO, held, linearised
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from ehlcontact.status import Status
from reduced_models.atlas.solve import FILM, status_of

# Layers over what the flooded film lets through: closest where oil begins to pile up ahead of the contact.
RATIOS = (0.25, 0.5, 0.7, 0.85, 1.0, 1.15, 1.35, 1.7, 2.4, 4.0)
# Dense at the low end, where the oil ahead of the contact has time to come and go.
SUPPLY_OMEGAS = (0.0, 0.003, 0.01, 0.025, 0.05, 0.1, 0.2, 0.4, 0.8, 1.4, 2.2, 4.0, 10.0)
# Inlet of the region over the default one, so that the front of the full film lies inside, and for thick layers of
# light contacts; on as many times the intervals.
LONGER, LONGEST, MORE_INTERVALS = 1.5, 2.5, 1.5
# For inlets of at least this width, in semi-axes: the mesh is 0.4 of it at most, half of it in the last.
INTERVALS = ((0.32, 64), (0.215, 96), (0.16, 128), (0.085, 192))
TOLERANCE = 1e-4  # of the linear residuals: C is then within 1e-4 of the flooded C at low frequency, or so


def supply_grids(point: MoesPoint) -> tuple[Grid, Grid]:
    """Grid of a point, whose inlet must be as wide as the last of `INTERVALS`; and of a longer region."""
    n = next(n for width, n in INTERVALS if point.inlet_width >= width)
    region = Domain.for_point(point)
    long, longest = (replace(region, x_in=times * region.x_in) for times in (LONGER, LONGEST))
    return Grid(n, long), Grid(int(MORE_INTERVALS * n), longest)


def solve_supply(point: MoesPoint) -> dict[str, Any]:
    """Entry of a point in the work folder, in JSON types, under all of `RATIOS`."""
    return solve_layers(point, RATIOS, SUPPLY_OMEGAS)


def solve_layers(point: MoesPoint, ratios: tuple[float, ...], Omega: tuple[float, ...]) -> dict[str, Any]:
    """Entry of a point under layers of one's own choice; None for one whose film begins ahead of the region."""
    started = time.perf_counter()
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa, "version": __version__}
    entry |= {"Omega": list(Omega), "ratios": list(ratios), "status": str(Status.UNRESOLVED)}
    grids = supply_grids(point)
    try:
        entry["flooded"] = _respond(point, grids[0], Omega, None)
    except ConvergenceError as error:
        return entry | {"status": status_of(error)}
    full = entry["flooded"]["h_central"] * float(plain(density)(1.0, point.law)[0])
    entry["starved"] = []
    for ratio in ratios:
        entry["starved"].append(_under(point, grids, Omega, OilLayer(H=ratio * full)))
    seconds = time.perf_counter() - started
    return entry | {"status": str(Status.CONVERGED), "n": grids[0].n, "seconds": seconds}


def _under(
    point: MoesPoint, grids: tuple[Grid, Grid], Omega: tuple[float, ...], supply: OilLayer
) -> dict[str, Any] | None:
    for grid in grids:
        with suppress(ConvergenceError):
            return _respond(point, grid, Omega, supply)
    return None


def _respond(point: MoesPoint, grid: Grid, Omega: tuple[float, ...], supply: OilLayer | None) -> dict[str, Any]:
    """Steady film and impedance, without the error estimates of `impedance`."""
    film = solve_steady(point, grid=grid, supply=supply)
    moving = np.maximum(Omega, NEAR_ZERO)
    Z, _ = linearised(film, held(film)).respond(moving, TOLERANCE)
    numbers = {name: float(getattr(film, name)) for name in FILM}
    return numbers | {"stiffness": Z.real.tolist(), "damping": (Z.imag / moving).tolist()}
