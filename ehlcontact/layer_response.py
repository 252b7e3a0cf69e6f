"""`layer_response`: force of a starved contact and the layer behind it, over changes of the layer ahead."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks.frequency import dimensionless
from ehlcontact.checks.machine import require_threads
from ehlcontact.conditions import Conditions
from ehlcontact.linearised_film import film_to_linearise, held, linearised
from ehlcontact.point import Point, require_solvable
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.linearised_contact import TOLERANCE
from ehlcontact.solver.mesh import Solve
from ehlcontact.solver.mesh_choice import Purpose, wider_meshes
from ehlcontact.solver.passing_layer import passing_layer
from ehlcontact.supply import OilLayer

Complex = NDArray[np.complex128]

SLOWEST = 1e-4  # Omega that stands for 0
LARGEST_OMEGA = 200.0


class LayerResponse(NamedTuple):
    """Force and layer behind by approach and layer ahead, in Moes units at every point, for exp(i Omega T).

    The layer enters at one border of the computed region and leaves at the other: phases have the time between.
    `behind` is the mean over the width of the contact, y from -b to b.
    """

    Omega: NDArray[np.float64]  # (k,)
    force_by_approach: Complex  # (k,), the impedance
    force_by_layer: Complex  # (k,)
    behind_by_approach: Complex  # (k,)
    behind_by_layer: Complex  # (k,)


@one_blas_thread()
def layer_response(
    point: Point, *, Omega: ArrayLike, supply: OilLayer, grid: Grid = AUTOMATIC, threads: int | None = None
) -> LayerResponse:
    """Linearise a starved contact, with its layer ahead as a second input and its layer behind as a second output.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    Omega : float or sequence of float
        Dimensionless frequencies, from 0 to 200.
    supply : OilLayer
        The layer at rest; its changes are uniform.
    grid : Grid
        As in `impedance`.
    threads : int, optional
        As in `solve_steady`.

    Raises
    ------
    InputError
        Frequencies or a grid that `impedance` refuses.
    ConvergenceError
        The steady state did not converge.
    """
    moes = require_solvable(point)
    w = dimensionless(None, Omega=Omega, omega=None, hz=None, rpm=None, most=LARGEST_OMEGA)
    require_grid(grid)
    meshes = wider_meshes(moes, Purpose.DAMPING, grid, solve=Solve.IMPEDANCE)
    conditions = Conditions.of(supply=supply).at(point)
    film = film_to_linearise(point, meshes, grid.deflection, require_threads("threads", threads), conditions)
    multigrid = held(film, grid.deflection)
    contact = linearised(film, multigrid)
    found = [
        passing_layer(contact, max(omega, SLOWEST), TOLERANCE * min(1.0, max(omega, SLOWEST)))
        for omega in w.tolist()
    ]
    force = np.array([one.force for one in found])
    behind = np.array([_on_track(one.behind, multigrid.finest.Y) for one in found])
    return LayerResponse(w, force[:, 0], force[:, 1], behind[:, 0], behind[:, 1])


def _on_track(behind: Complex, Y: NDArray[np.float64]) -> Complex:
    """Mean over the half width of the contact, of lines (..., ny + 1)."""
    inside = Y <= 1.0
    return np.asarray(np.trapezoid(behind[..., inside], Y[inside]) / Y[inside][-1])
