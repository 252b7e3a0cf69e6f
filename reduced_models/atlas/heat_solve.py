"""Solution of one heated contact: film and impedance with heat, and isothermal on the same grid."""

from __future__ import annotations

import time
from dataclasses import asdict
from typing import Any

import numpy as np

from ehlcontact import Domain, Grid, Heat, OperatingPoint, __version__, solve_steady
from ehlcontact.errors import ConvergenceError
from ehlcontact.impedance import TOLERANCE, held, linearised
from ehlcontact.status import Status
from reduced_models.atlas.heat_sample import HeatedContact, intervals_of
from reduced_models.atlas.solve import FILM, OMEGAS, status_of

# Of the atlas; what heat changes follows them within 0.01 of the damping at low frequency, and 0.4 % of K.
HEAT_OMEGAS = tuple(OMEGAS[k] for k in (0, 3, 6, 8, 10, 13, 16, 19, 22, 25, 28, 33, 41))
# Stands for 0: on few grids oil far ahead of the contact has a slow temperature of a rate of
# 2e-3, which adds to C at lower frequencies (docs/heat.md).
SLOWEST = 0.02


def solve_heated(contact: HeatedContact) -> dict[str, Any]:
    """Entry of a contact in the work folder, in JSON types; ``status`` is that of the solve."""
    started, point = time.perf_counter(), contact.point
    moes, heat = point.moes, contact.heat.at(point)
    numbers = heat.numbers(moes, point.scales)
    entry: dict[str, Any] = {name: getattr(moes, name) for name in ("M", "L", "kappa", "alpha", "eta0", "p_hertz")}
    entry |= {"thermal_load": heat.load(moes, point.scales), "slope": heat.temperature_slope}
    entry |= {"numbers": numbers._asdict() | {"shear": None}, "temperature": heat.temperature}
    entry |= {"u_sum": point.u_sum, "scales": asdict(point.scales), "version": __version__}
    entry |= {"status": str(Status.UNRESOLVED)}
    n = intervals_of(point)
    if n is None:
        return entry
    grid = Grid(n, Domain.for_point(moes))
    try:
        entry |= {"cold": respond(point, grid, None), "warm": respond(point, grid, contact.heat)}
        entry["status"] = str(Status.CONVERGED)
    except ConvergenceError as error:
        entry["status"] = status_of(error)
    return entry | {"n": n, "seconds": time.perf_counter() - started}


def respond(point: OperatingPoint, grid: Grid, heat: Heat | None) -> dict[str, Any]:
    """Steady film and impedance at `HEAT_OMEGAS`, without the error estimates of `impedance`."""
    film = solve_steady(point, grid=grid, thermal=heat)
    omega = np.maximum(HEAT_OMEGAS, SLOWEST)
    Z, residual = linearised(film, held(film)).respond(omega, TOLERANCE)
    numbers = {name: getattr(film, name) for name in FILM} | {"residual": float(residual.max())}
    return numbers | {"stiffness": Z.real.tolist(), "damping": (Z.imag / omega).tolist()}
