"""Choice of a mesh: region and fineness that a film needs, and the mesh to try after a failure.

The expected film decides. Beside a dry contact the gap opens like x^(3/2), so the pressure of the inlet rises to
the dry one over about (Hc)^(2/3) semi-axes (`MoesPoint.inlet_width`), which the mesh has to resolve. The
conditions on kappa, inlet width and load are those of `solver.grid_rules`. Mesh sizes are in the longer semi-axis.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from enum import StrEnum
from math import inf
from typing import NamedTuple

from ehlcontact.point import MoesPoint
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.grid import AUTOMATIC, Grid
from ehlcontact.solver.grid_rules import (
    has_side_lobes,
    has_spike,
    has_thin_inlet,
    has_thin_sides,
    has_very_thin_inlet,
    is_long,
)
from ehlcontact.solver.mesh import Mesh, Solve
from ehlcontact.status import Status


class Purpose(StrEnum):
    """Purpose of a mesh."""

    FILM = "film"  # a steady film: `solve_steady`
    DAMPING = "damping"  # the film linearised: `impedance`
    RUN = "run"  # a film through time: `simulate`
    CONTACT = "contact"  # one inside a rotor: `TransientContact`


# Which region? --------------------------------------------------------------------------------------------------
NEAR_DOMAIN = Domain.near()
NEAREST_DOMAIN = Domain(-1.5, 1.2, 1.25)  # around such a film where it is very thin: its mesh can be afforded

# How fine? ------------------------------------------------------------------------------------------------------
LARGEST_MESH = 0.12  # semi-axes: what the pressure itself asks for, however thick the film
WAVE_NODES = 16.0  # nodes to a wave on a surface whose force is asked for
SPIKE_MESH = 0.05  # for the pressure spike of stiff oil, where the film moves
# The side lobes of long contacts: mesh over inlet width that keeps their film positive where it is very thin; and
# those for which it is within some ten per cent, taken as long as the grid has no more nodes than AFFORDABLE_GRID.
MESH_OF_THIN_SIDES = 0.4
FINE_SIDES, FINE_THIN_SIDES, AFFORDABLE_GRID = 0.3, 0.17, 500_000
# The thinnest of them change across rolling within a tenth of the inlet width: where no mesh as fine along as
# across shows them, lines lie so many times closer together than nodes, in metres. A power of two.
CLOSE_LINES = 4
# Where the finest of those grids leaves the film negative or unsettled: nodes of one more, minutes of a core.
LAST_GRID = 4_000_000
DOUBLED = (128, 256, 512, 1024, 2048)  # intervals, for multigrid from the coarsest to each
STEPPED = (80, 96, 128, 160, 192, 256, 320, 384, 512, 640, 768, 1024)  # closer, and all of many halvings


class Fineness(NamedTuple):
    """Requirements of a purpose."""

    share: float  # largest mesh over the width of the inlet
    counts: tuple[int, ...]  # intervals to choose from
    largest: int  # nodes


# Measured against finer grids, damping is off by 12 to 16 % where the mesh is 0.6 of the inlet width, enough for a
# steady film, and by 1 to 4 % where it is a third. Sparse factors, as the linearised film needs them, take 0.6 GB
# at 74 000 nodes and 2.3 GB at 205 000; seven frequencies take half a minute and two minutes of one core.
FINENESS = {
    Purpose.FILM: Fineness(0.6, DOUBLED, 1_000_000),
    Purpose.DAMPING: Fineness(1.0 / 3.0, STEPPED, 210_000),
    Purpose.RUN: Fineness(1.0 / 3.0, STEPPED[2:], 70_000),
    Purpose.CONTACT: Fineness(1.0 / 3.0, STEPPED, 70_000),
}

# What is tried after a failure, or a film that is not yet exact? ------------------------------------------------
FAILED = (Status.STAGNATED, Status.DIVERGED, Status.MAX_CYCLES, Status.NONFINITE)
REFINED = (*FAILED, Status.UNRESOLVED, Status.STARVED)  # what a finer mesh may cure
DOMAIN_GROWTH = 1.5  # of a region that pressure fills
# Errors of a steady film (by their estimates) below which no finer mesh is tried where it is left open.
ACCURACY = ErrorEstimate(approach=0.002, h_central_relative=0.01, h_min_relative=0.03)
LARGEST_ATTEMPTS = 4  # meshes for one film, the first one included
LARGEST_NEWTON = 300_000  # nodes for Newton as a last resort: sparse factors take minutes and gigabytes beyond


def mesh_for(
    point: MoesPoint,
    purpose: Purpose,
    grid: Grid = AUTOMATIC,
    *,
    largest_load: float = 1.0,
    reverses: bool = False,
) -> Mesh:
    """Return the mesh that the expected film needs, with the intervals and the region that the caller gave.

    Parameters
    ----------
    point : MoesPoint
    purpose : Purpose
    grid : Grid
        Intervals and region given by the caller.
    largest_load : float
        That the contact will have to carry; the static load is 1.
    reverses : bool
        Whether its surfaces roll back: the region is then as long behind the contact as ahead of it.
    """
    n, domain = grid.n, grid.domain
    if domain is None:
        closes_in = purpose is Purpose.DAMPING or (purpose is Purpose.FILM and n is None and largest_load <= 1.0)
        domain = (closes_in and _thin_film_domain(point)) or Domain.for_point(point, largest_load)
        if reverses:
            domain = Domain(domain.x_in, -domain.x_in, domain.y_max)
    if n is None:
        n = _intervals(point, domain, purpose)
    return Mesh(n, domain, point.kappa)


def grid_for_waves(point: MoesPoint, grid: Grid, shortest: float) -> Grid:
    """`grid`, with the intervals that waves of this length, in semi-axes a, need where the film needs fewer."""
    if grid.n is not None:
        return grid
    mesh, (_, counts, largest) = mesh_for(point, Purpose.DAMPING, grid), FINENESS[Purpose.DAMPING]
    n = _first(point, mesh.domain, shortest / WAVE_NODES, counts, largest)
    return grid if n <= mesh.n else replace(grid, n=n)


def damping_mesh(point: MoesPoint) -> float:
    """Largest mesh size, in the longer semi-axis, that shows how the film moves."""
    spike = SPIKE_MESH if has_spike(point) else LARGEST_MESH
    return min(FINENESS[Purpose.DAMPING].share * point.inlet_width, spike)


def remedy(
    mesh: Mesh,
    status: Status,
    point: MoesPoint,
    purpose: Purpose = Purpose.FILM,
    grid: Grid = AUTOMATIC,
    *,
    error: ErrorEstimate | None = None,
) -> Mesh | None:
    """Return the mesh to try after a solve on `mesh` ended with `status`: wider, nearer or finer; None to end.

    `grid` is what the caller of `mesh_for` gave; given intervals and a given region are not changed. A steady film
    with given intervals is solved on that mesh only. `error` is the estimate for a converged film, which is solved
    on a finer mesh until the estimate is within `ACCURACY`; None accepts the film as it is.
    """
    if purpose is Purpose.FILM and grid.n is not None:
        return None
    if status in (Status.OUT_OF_DOMAIN, Status.BEYOND_REGION):
        if grid.domain is not None:
            return None
        x_in, x_out, y_max = mesh.domain.as_tuple()
        if status is Status.BEYOND_REGION:
            longer = Domain(DOMAIN_GROWTH * x_in, x_out, y_max)
            return replace(mesh_for(point, purpose, replace(grid, domain=longer)), y_refinement=mesh.y_refinement)
        wider = Domain(DOMAIN_GROWTH * x_in, DOMAIN_GROWTH * x_out, DOMAIN_GROWTH * y_max)
        if purpose is Purpose.FILM:
            return replace(mesh, domain=wider, y_refinement=1)
        return mesh_for(point, purpose, replace(grid, domain=wider))
    inexact = status.ok and error is not None and not error.within(ACCURACY)
    if purpose is not Purpose.FILM or not (inexact or status in REFINED):
        return None
    far = grid.domain is None and mesh.domain not in {NEAR_DOMAIN, NEAREST_DOMAIN}
    if far and not inexact and has_thin_inlet(point):
        return replace(mesh, domain=NEAR_DOMAIN, y_refinement=1)
    finer = replace(mesh, n=2 * mesh.n)
    if is_long(point) and mesh.y_refinement == 1 and (status in REFINED or not _affordable(finer)):
        finer = _with_close_lines(mesh.domain, point)
    elif mesh.y_refinement > 1 and status in REFINED:
        finer = _last(mesh)
        return finer if finer.nodes <= LAST_GRID and finer.fits() else None
    return finer if _affordable(finer) else None


def wider_meshes(
    point: MoesPoint,
    purpose: Purpose,
    grid: Grid = AUTOMATIC,
    *,
    largest_load: float = 1.0,
    reverses: bool = False,
    solve: Solve = Solve.CYCLES,
) -> Iterator[Mesh]:
    """Yield the mesh of `mesh_for`, then meshes on wider regions, for a film that leaves the region before.

    The iteration ends before a wider mesh that would not fit into memory.

    Parameters
    ----------
    point, purpose, grid, largest_load, reverses
        As in `mesh_for`.
    solve : Solve
        What the mesh is solved with.

    Raises
    ------
    InputError
        The first mesh would not fit into memory.
    """
    mesh = mesh_for(point, purpose, grid, largest_load=largest_load, reverses=reverses)
    mesh.require_memory(solve)
    yield mesh
    for _ in range(1, LARGEST_ATTEMPTS):
        wider = remedy(mesh, Status.OUT_OF_DOMAIN, point, purpose, grid)
        if wider is None or not wider.fits(solve):
            return
        yield wider
        mesh = wider


def allows_newton(mesh: Mesh) -> bool:
    """Whether the factors of Newton steps on this mesh are affordable."""
    return mesh.nodes <= LARGEST_NEWTON and mesh.fits(Solve.NEWTON)


def is_last(mesh: Mesh) -> bool:
    """Whether it is so large that a film is tried on it only after all others."""
    return mesh.nodes > FINENESS[Purpose.FILM].largest


def newton_mesh(mesh: Mesh, most: float = inf) -> Mesh | None:
    """Return a coarser mesh of at most `most` nodes on which Newton steps are affordable; None without one.

    Where they are affordable on `mesh` there is none either.
    """
    coarser = mesh
    while not (allows_newton(coarser) and coarser.nodes <= most) and coarser.n > DOUBLED[0]:
        coarser = replace(coarser, n=coarser.n // 2)
    allowed = allows_newton(coarser) and coarser.nodes <= most
    return coarser if coarser != mesh and allowed else None


def _thin_film_domain(point: MoesPoint) -> Domain | None:
    """Region around a film so thin that it is chosen at once."""
    if has_thin_sides(point):
        return NEAREST_DOMAIN
    return NEAR_DOMAIN if has_very_thin_inlet(point) else None


def _intervals(point: MoesPoint, domain: Domain, purpose: Purpose) -> int:
    """Intervals along X that `domain` needs."""
    width, (share, counts, largest) = point.inlet_width, FINENESS[purpose]
    if purpose is not Purpose.FILM:
        return _first(point, domain, damping_mesh(point), counts, largest)
    sides = has_thin_sides(point)
    needed = (MESH_OF_THIN_SIDES if sides else share) * width
    if has_side_lobes(point):  # the smallest film, in the side lobes, needs more than to be positive
        n = _first(point, domain, (FINE_THIN_SIDES if sides else FINE_SIDES) * width, counts, AFFORDABLE_GRID)
        if Mesh(n, domain, point.kappa).size <= needed:
            return n
    return _first(point, domain, needed, counts, largest)


def _affordable(mesh: Mesh) -> bool:
    """Whether a steady film may be tried on it."""
    return mesh.nodes <= FINENESS[Purpose.FILM].largest and mesh.fits()


def _with_close_lines(domain: Domain, point: MoesPoint) -> Mesh:
    """Mesh whose lines show the side lobes of thin films, and its nodes the inlet; as fine as is affordable."""
    _, counts, largest = FINENESS[Purpose.FILM]
    wanted = FINE_SIDES * point.inlet_width
    n = _first(point, domain, wanted, counts, largest, CLOSE_LINES)
    mesh = Mesh(n, domain, point.kappa, CLOSE_LINES)
    finer = replace(mesh, n=2 * mesh.n, y_refinement=CLOSE_LINES // 2)  # no fewer lines
    return finer if mesh.size > wanted and _affordable(finer) else mesh


def _last(mesh: Mesh) -> Mesh:
    """The mesh after the finest one with close lines that a film is tried on at first."""
    return (
        replace(mesh, n=2 * mesh.n)
        if mesh.y_refinement == CLOSE_LINES
        else replace(mesh, y_refinement=CLOSE_LINES)
    )


def _first(
    point: MoesPoint, domain: Domain, wanted: float, counts: Sequence[int], largest: int, y_refinement: int = 1
) -> int:
    """First of `counts` that meshes as finely as `wanted` and as pressure needs; the last of `largest` nodes."""
    meshes = [Mesh(n, domain, point.kappa, y_refinement) for n in counts]
    affordable = [mesh for mesh in meshes if mesh.nodes <= largest] or meshes[:1]
    return next((mesh.n for mesh in affordable if mesh.size <= min(wanted, LARGEST_MESH)), affordable[-1].n)
