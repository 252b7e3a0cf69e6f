"""The mesh chosen for every purpose at thirty points, and what follows a failure there."""

from math import exp, log

import numpy as np

from ehlcontact import Domain, Grid, InputError, MoesPoint
from ehlcontact.solver.grid_rules import coarsest_intervals, resolved_load
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import Purpose, allows_newton, mesh_for, remedy
from ehlcontact.status import Status
from reduced_models.atlas.mesh import film_grid, impedance_grid, near_grid

PICKED = [
    *((200, 10, 0.5), (20, 10, 1.0), (5, 0, 5.0), (5, 25, 0.08), (2900, 19, 0.11), (1000, 5, 1.0)),
    *((30000, 0, 0.08), (500, 3, 2.0), (30000, 0, 0.3), (7333, 2.6, 3.0), (12834, 3.2, 1.09), (7, 1, 0.08)),
    *((20000, 2, 0.2), (58.07, 4.62, 1.0), (2, 1, 0.5), (0.5, 3, 1.0)),
]
GIVEN = Domain(-3.0, 1.4, 2.0)
FINER = ("unresolved", "diverged", "nonfinite")
WIDER = ("out_of_domain", "stagnated", "out_of_domain")


def points():
    """M and kappa even in their logarithm, L denser where it is small; some beyond the box of the atlas."""
    draw, found = np.random.default_rng(9), list(PICKED)
    for _ in range(14):
        M, L = exp(draw.uniform(0.0, log(4e4))), 25.0 * draw.uniform() ** 1.5
        found.append((round(M, 2), round(L, 2), round(exp(draw.uniform(log(0.05), log(5.0))), 3)))
    return {"{} {} {}".format(*point): tuple(map(float, point)) for point in found}


def plain(mesh):
    """A mesh as JSON; how close its lines lie only where that is closer than its nodes."""
    close = [] if mesh is None or mesh.y_refinement == 1 else [mesh.y_refinement]
    return None if mesh is None else [mesh.n, *mesh.domain.as_tuple(), *close]


def chain(point, purpose, statuses, **given):
    """Meshes tried one after the other when solves end like that."""
    grid = Grid(**given)
    mesh = mesh_for(point, purpose, grid)
    found = [plain(mesh)]
    for status in statuses:
        try:
            mesh = remedy(mesh, Status(status), point, purpose, grid)
        except InputError:
            return [*found, "refused"]
        found.append(plain(mesh))
        if mesh is None:
            break
    return found


def table(point, choose):
    """Mesh of a point of the atlas; None for too thin a film."""
    try:
        grid = choose(point)
        return plain(Mesh(grid.n, grid.domain, point.kappa))
    except InputError:
        return None


def decisions(M, L, kappa):
    """Every rule at one point."""
    point, default = MoesPoint(M, L, kappa), Domain.for_point(MoesPoint(M, L, kappa))
    return {
        "load number": point.load_number,
        "inlet": point.inlet_width,
        "expected film": point.expected_film,
        "film refined": chain(point, Purpose.FILM, FINER),
        "film widened": chain(point, Purpose.FILM, WIDER),
        "film done": chain(point, Purpose.FILM, ["converged"]),
        "film, region given": chain(point, Purpose.FILM, FINER, domain=GIVEN),
        "film, n given": chain(point, Purpose.FILM, ["out_of_domain"], n=64),
        "damping": chain(point, Purpose.DAMPING, ["out_of_domain"]),
        "damping, n given": chain(point, Purpose.DAMPING, ["out_of_domain"], n=48),
        "damping, region given": chain(point, Purpose.DAMPING, [], domain=GIVEN),
        "run": plain(mesh_for(point, Purpose.RUN)),
        "run to load 3": plain(mesh_for(point, Purpose.RUN, largest_load=3.0)),
        "contact": plain(mesh_for(point, Purpose.CONTACT)),
        "table": table(point, impedance_grid),
        "table film": table(point, film_grid),
        "table near": table(point, near_grid),
        "coarsest": [coarsest_intervals(point, n) for n in (32, 128, 512)],
        "resolved load": [resolved_load(point, mesh) for mesh in (0.2, 0.05)],
        "newton": [allows_newton(Mesh(n, default, kappa)) for n in (256, 1024, 2048)],
    }
