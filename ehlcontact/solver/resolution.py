"""What a mesh has to resolve: grid and domain chosen from the film to be expected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import exp, log

from scipy.optimize import brentq

from ehlcontact.formulas import nvm_central_film
from ehlcontact.point import MoesPoint
from ehlcontact.solver.domain import Domain, check_intervals, default_domain

MOST_INTERVALS = 2048
DOUBLED = (128, 256, 512, 1024, 2048)
STEPPED = (80, 96, 128, 160, 192, 256, 320, 384, 512, 640, 768, 1024)  # all of many halvings
LARGEST_MESH = 0.12  # in semi-axes; what the pressure itself asks for
MESH_OF_INLET = 0.6  # largest mesh over the width of the inlet,
MESH_OF_MOVING_INLET = 1.0 / 3.0  # and where damping is wanted
NEGATIVE_FILM = 0.8  # of that width: mesh above which the load has to be approached in steps,
LOADING_MESH = 0.4  # each resolved this well
LARGEST_GRID = 1_000_000  # nodes
LARGEST_MOVING_GRID = 70_000  # nodes; sparse factors take half a minute and 1.5 GB there
THIN = 0.06  # inlet width below which `CLOSE` will do
CLOSE = Domain(-2.0, 1.35, 1.6)  # around a film so thin that oil further out makes no difference
VERY_THIN = 0.03  # below which it is chosen at once
LONG = 0.7  # kappa above which side lobes are thinner than the film in the outlet
MESH_OF_THIN_SIDES = 0.4  # largest mesh over that width where they are very thin,
FINE_SIDES, FINE_THIN_SIDES = 0.3, 0.17  # and meshes for their film to be within some ten per cent,
AFFORDABLE_GRID = 500_000  # as long as that takes no more nodes
TIGHT = Domain(-1.5, 1.2, 1.25)  # around such a film: so that its mesh can be afforded


def inlet_width(point: MoesPoint) -> float:
    """Width of the zone, in semi-axes, where the pressure of the inlet rises to that of the dry contact.

    The gap beside a dry contact opens like x^(3/2), and the film to be carried in is Hc.
    """
    film = nvm_central_film(point.M, point.L, point.kappa) / point.film_to_moes
    return film ** (2.0 / 3.0)


def thin_sides(point: MoesPoint) -> bool:
    """Whether the side lobes, not the inlet, set the mesh.

    Along a contact that is long in the rolling direction, oil leaks out over the sides all the way, and the film
    in the side lobes falls to a tenth and less of the central film. A mesh that sees the inlet well leaves it
    negative there.
    """
    return point.kappa > LONG and inlet_width(point) < VERY_THIN


def resolved_load(point: MoesPoint, mesh: float) -> float:
    """Moes load, at most that of `point`, which `mesh` (in semi-axes) carries with a positive film."""

    def excess(log_load: float) -> float:
        return inlet_width(replace(point, M=exp(log_load))) * LOADING_MESH - mesh

    highest = log(point.M)
    lowest = min(0.0, highest)
    if mesh <= NEGATIVE_FILM * inlet_width(point) or excess(highest) >= 0.0:
        return point.M
    if excess(lowest) <= 0.0:
        return exp(lowest)
    return exp(float(brentq(excess, lowest, highest, xtol=1e-3)))


def automatic_mesh(point: MoesPoint, domain: Domain | None = None) -> tuple[int, Domain]:
    """Intervals along X, and the domain if none is given, that resolve the steady film.

    The default domain, `CLOSE` around a very thin film, where cycles on more oil converge slowly, and `TIGHT` for
    thin sides.
    """
    width, sides = inlet_width(point), thin_sides(point)
    if domain is None:
        domain = TIGHT if sides else CLOSE if width < VERY_THIN else default_domain(point)
    needed = (MESH_OF_THIN_SIDES if sides else MESH_OF_INLET) * width
    if point.kappa > LONG:  # the smallest film, in the side lobes, needs more than to be positive
        n = _intervals(point, domain, (FINE_THIN_SIDES if sides else FINE_SIDES) * width, DOUBLED, AFFORDABLE_GRID)
        if _mesh(point, domain, n) <= needed:
            return n, domain
    return _intervals(point, domain, needed, DOUBLED, LARGEST_GRID), domain


def moving_intervals(n: int | None, point: MoesPoint, domain: Domain, fewest: int) -> int:
    """`n`, checked; without one, intervals along X, `fewest` or more, that give damping within a few per cent.

    Measured against finer grids: C is off by 1 to 4 % where the mesh is a third of the inlet width, by 12 to 16 %
    where it is 0.6 of it.
    """
    if n is not None:
        return check_intervals(n)
    counts = [count for count in STEPPED if count >= fewest]
    return _intervals(point, domain, MESH_OF_MOVING_INLET * inlet_width(point), counts, LARGEST_MOVING_GRID)


def _mesh(point: MoesPoint, domain: Domain, n: int) -> float:
    """Mesh size in the longer semi-axis."""
    return (domain.x_out - domain.x_in) / n * max(1.0, point.kappa)


def _intervals(point: MoesPoint, domain: Domain, wanted: float, counts: Sequence[int], largest: int) -> int:
    """First of `counts` that meshes as finely as `wanted` and as pressure needs; the last of `largest` nodes."""
    wanted = min(wanted, LARGEST_MESH)
    affordable = [n for n in counts if nodes(n, domain, point.kappa) <= largest] or counts[:1]
    return next((n for n in affordable if _mesh(point, domain, n) <= wanted), affordable[-1])


def refined_mesh(point: MoesPoint, n: int, domain: Domain, free: bool) -> tuple[int, Domain] | None:
    """Next mesh to try after n intervals on `domain` failed; if `free`, the domain may close in on a thin film."""
    if free and domain not in {CLOSE, TIGHT} and inlet_width(point) < THIN:
        return n, CLOSE
    return (2 * n, domain) if nodes(2 * n, domain, point.kappa) <= LARGEST_GRID else None


def nodes(n: int, domain: Domain, kappa: float) -> float:
    """Nodes of a grid of n intervals along X, about; infinite beyond `MOST_INTERVALS`."""
    length = domain.x_out - domain.x_in
    return n * n * domain.y_max / (length * max(1.0, kappa)) if n <= MOST_INTERVALS else float("inf")
