"""Solution of one sample point: steady film and impedance on a mesh that resolves the film."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from ehlcontact import Grid, MoesPoint, __version__, impedance, solve_steady
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models.atlas.mesh import film_grid, impedance_grid, near_grid

# Dense enough for the cubic between them (`reduced_models.atlas.frequency_curve`), where lags make K and C wave.
OMEGAS = (
    0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, np.pi, 3.5, 4.0, 4.5, 5.0,
    5.5, 2.0 * np.pi, 7.0, 8.0, 9.0, 10.0, 11.0, 4.0 * np.pi, 13.5, 15.0, 16.5, 18.0, 20.0, 22.5, 8.0 * np.pi,
    28.0, 32.0, 37.0, 43.0, 51.0, 60.0,
)  # fmt: skip
FILM = ("approach", "h_central", "h_min", "moment")  # of the steady state


def solve_point(point: MoesPoint) -> dict[str, Any]:
    """Entry of a point in the work file, in JSON types; ``status`` is that of the solve.

    ``film`` is the steady film on a finer mesh and ``close`` the answers on the near region, where there are such.
    """
    started = time.perf_counter()
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa, "alpha": point.alpha}
    entry |= {"eta0": point.eta0, "version": __version__, "status": str(Status.UNRESOLVED)}
    try:
        grid, of_film, near = (choose(point) for choose in (impedance_grid, film_grid, near_grid))
    except InputError:  # too thin a film for any mesh that is affordable
        return entry
    try:
        entry |= respond(point, grid)
        entry |= fine_film(point, of_film, grid)
        entry["status"] = str(Status.CONVERGED)
    except ConvergenceError as error:
        entry["status"] = status_of(error)
    if near != grid:
        with suppress(ConvergenceError):
            entry["close"] = respond(point, near)
    return entry | {"seconds": time.perf_counter() - started}


def status_of(error: ConvergenceError) -> str:
    """Status of a solve that failed, for its entry."""
    return "unknown" if error.result is None else str(error.result.status)


def fine_film(point: MoesPoint, wanted: Grid, coarse: Grid) -> dict[str, Any]:
    """The film on the grid wanted, or on half its intervals where that fails; nothing if `coarse` is as fine."""
    assert wanted.n is not None and coarse.n is not None
    for n in (wanted.n, wanted.n // 2):
        if wanted.domain == coarse.domain and n <= coarse.n:
            break
        with suppress(ConvergenceError):
            return {"film": _film(solve_steady(point, grid=replace(wanted, n=n)))}
    return {}


def respond(point: MoesPoint, grid: Grid) -> dict[str, Any]:
    """Steady film and impedance at `OMEGAS`."""
    found = impedance(point, Omega=OMEGAS, grid=grid)
    return _film(found) | {"stiffness": found.stiffness.tolist(), "damping": found.damping.tolist()}


def _film(found: Any) -> dict[str, Any]:
    """Approach and films of a result, and where it was solved."""
    numbers = {name: getattr(found, name) for name in FILM}
    return numbers | {"n": found.n, "domain": list(found.domain.as_tuple())}
