"""Steady films to linearise: on the finest mesh, and on the coarser ones that tell an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import ConvergenceError
from ehlcontact.point import Point, scales_of
from ehlcontact.results import SteadyResult
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.effects import viscosity_of
from ehlcontact.solver.error_grids import settled_on_half
from ehlcontact.solver.followed_viscosity import FollowedViscosity
from ehlcontact.solver.grid import Grid
from ehlcontact.solver.linearised_contact import LinearisedContact
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.status import Status
from ehlcontact.steady import solve_steady

LEAST_INTERVALS = 12  # of the coarser grids that tell the error
COARSE_CYCLES = 3  # of a coarser film with heat, after those at the viscosity of the finer one


def film_to_linearise(
    point: Point,
    meshes: Iterable[Mesh],
    deflection: str,
    threads: int,
    conditions: Conditions = FLOODED,
) -> SteadyResult:
    """The film to linearise, on the first of the meshes whose region holds it."""
    for mesh in meshes:
        own = Grid(mesh.n, mesh.domain, deflection)
        steady = solve_steady(point, grid=own, threads=threads, throw=False, **conditions.keywords)
        if steady.status not in (Status.OUT_OF_DOMAIN, Status.BEYOND_REGION):
            break
    if steady.status is Status.INTERRUPTED:
        raise KeyboardInterrupt  # there is nothing to keep: no frequency has been looked at
    if not steady.status.ok:
        raise ConvergenceError(f"steady solve {steady.status}: {steady.status.advice}", steady)
    return steady


def held(film: SteadyResult, deflection: str = "fft", threads: int = 1) -> Multigrid:
    """Levels that hold a steady film, `deflection` and `threads` as in `solve_steady`."""
    own, moes = film.dimensionless, film.point.moes
    mesh, layer = Mesh(film.n, film.domain, moes.kappa), own.layer
    supply = None if layer is None else lambda Y: np.interp(Y, own.y, layer)
    multigrid = Multigrid(moes, mesh, deflection=deflection, threads=threads, supply=supply)
    multigrid.finest.P[...] = own.p.T
    multigrid.u = own.approach
    multigrid.finest.update(multigrid.u)
    if (viscosity := viscosity_on(film, multigrid)) is not None:
        viscosity.set_viscosity()
    return multigrid


def viscosity_on(film: SteadyResult, multigrid: Multigrid) -> FollowedViscosity | None:
    """Viscosity of a steady film on levels that hold it, or its coarser image; None where it follows nothing.

    A coarser image is solved with temperatures of its own.
    """
    warm, level = film.temperature, multigrid.finest
    conditions = Conditions(heat=None if warm is None else warm.inputs, sliding=film.sliding)
    viscosity = viscosity_of(conditions, film.point.moes, scales_of(film.point), multigrid)
    if viscosity is None:
        return None
    if level.P.shape != film.p.T.shape:
        viscosity.settle(Balance.of_load(), COARSE_CYCLES)
    elif warm is not None and viscosity.heat is not None:
        viscosity.heat.walls[...] = warm.surfaces.transpose(0, 2, 1)
        viscosity.heat.rise[...] = warm.mean.T - viscosity.heat.walls.mean(axis=0)
    return viscosity


def coarser_films(solved: Multigrid) -> Iterator[Multigrid]:
    """The film on half and a quarter of the intervals, as far as they tell an error.

    A film that is negative somewhere still tells it on half of them, not on a quarter.
    """
    multigrid = solved
    for first in (True, False):
        if multigrid.mesh.n // 2 < LEAST_INTERVALS:
            return
        multigrid = settled_on_half(multigrid, Balance.of_load())
        lowest = multigrid.finest.H.min()
        if not np.isfinite(lowest) or not (first or lowest > 0.0):
            return
        yield multigrid


def coarser_contacts(film: SteadyResult, solved: Multigrid) -> Iterator[LinearisedContact]:
    """Derivatives at the `coarser_films`, as far as they have temperatures."""
    for multigrid in coarser_films(solved):
        with np.errstate(over="ignore", invalid="ignore"):  # of a coarse film that runs away
            viscosity = viscosity_on(film, multigrid)
        if not np.isfinite(multigrid.finest.fields.flow.heat).all():
            return
        yield LinearisedContact(multigrid, viscosity)


def linearised(film: SteadyResult, multigrid: Multigrid) -> LinearisedContact:
    """Derivatives of a contact at a steady film on levels that hold it, or its coarser image."""
    return LinearisedContact(multigrid, viscosity_on(film, multigrid))
