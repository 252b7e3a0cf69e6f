"""Steady films to linearise: on the finest mesh, and on the coarser ones that tell an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import MoesPoint, Point
from ehlcontact.results import SteadyResult
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.effects import Effect, effects_of
from ehlcontact.solver.error_grids import settled_on_half
from ehlcontact.solver.followed_viscosity import FollowedViscosity
from ehlcontact.solver.grid import Grid
from ehlcontact.solver.linearised_contact import LinearisedContact
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.status import Status
from ehlcontact.steady import solve_steady

COARSE_CYCLES = 3  # of a coarser film, after those at the viscosity of the finer one
LEAST_INTERVALS = 12  # of the coarser grids that tell the error


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
    for effect in effects_on(film, multigrid):
        if isinstance(effect, FollowedViscosity):
            effect.set_viscosity()
    return multigrid


def effects_on(film: SteadyResult, multigrid: Multigrid) -> list[Effect]:
    """Effects of a steady film on levels that hold it, or its coarser image, which has a state of its own.

    Raises
    ------
    InputError
        A film in Moes units with heat or shear thinning, whose data are in SI.
    """
    conditions = film.conditions
    if isinstance(film.point, MoesPoint) and (conditions.heat is not None or conditions.sliding is not None):
        allowed = "as it was solved, in SI: heat and shear thinning have to do with metres, seconds and pascals"
        raise InputError("film", "dimensionless", allowed)
    effects = effects_of(conditions, film.point, multigrid)
    results: dict[str, dict[str, Any]] = {}
    if (warm := film.temperature) is not None:
        results["heat"] = {"mean": warm.mean, "surfaces": warm.surfaces}
    if (rough := film.dimensionless.asperities) is not None:
        results["asperities"] = {"pressure": rough.pressure}
    for effect in effects:
        if multigrid.finest.P.shape == film.p.T.shape:
            effect.hold(results)
        else:
            effect.settle(Balance.of_load(), COARSE_CYCLES)
    return effects


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
            effects = effects_on(film, multigrid)
        if not np.isfinite(multigrid.finest.fields.flow.heat).all():
            return
        yield LinearisedContact(multigrid, effects)


def linearised(film: SteadyResult, multigrid: Multigrid) -> LinearisedContact:
    """Derivatives of a contact at a steady film on levels that hold it, or its coarser image."""
    return LinearisedContact(multigrid, effects_on(film, multigrid))
