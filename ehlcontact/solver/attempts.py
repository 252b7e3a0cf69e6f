"""Attempts at a steady film: mesh and method of each, in the order in which they are tried.

What follows an attempt depends on how it ended: another method on the same mesh, a wider, nearer or finer mesh, or
no further attempt.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

from ehlcontact.point import MoesPoint
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.grid import Grid
from ehlcontact.solver.mesh import Mesh, Solve
from ehlcontact.solver.mesh_choice import (
    FAILED,
    LARGEST_ATTEMPTS,
    Purpose,
    allows_newton,
    is_last,
    mesh_for,
    newton_mesh,
    remedy,
)
from ehlcontact.status import Status


class Method(NamedTuple):
    """Solution method on one mesh."""

    newton: bool
    sweep_factor: int  # of the cycles, and of those that lead to the start of Newton steps
    load_continuation: bool = False  # during full multigrid
    from_half: bool = False  # from the film on half the intervals, in place of full multigrid


LAST_RESORT = Method(newton=True, sweep_factor=2)  # as the attempt before, whose start was no worse
# The pressure spike of stiff oil is the narrower and the higher, the finer the grid: the few cycles that full
# multigrid spends on a coarser one leave it where it is not, and the finest grid then settles late or never.
FROM_HALF = Method(newton=False, sweep_factor=1, from_half=True)
LEAST_HALVED = 256  # intervals
# Twice the sweeps settle some films that single ones do not; a second attempt at once costs less than Newton.
METHODS = {
    "automatic": (Method(False, 1), Method(False, 2), FROM_HALF, LAST_RESORT),
    "multigrid": (Method(False, 1),),
    "newton": (Method(True, 1),),
}
# Where lines lie close, twice the sweeps settle nothing that single ones do not; load continuation does, at up to
# three times the cost. Newton steps come last: on grids of this kind they cost more, and fail where it does not.
CONTINUATION = Method(newton=False, sweep_factor=1, load_continuation=True)
CLOSE_LAST_RESORT = Method(newton=True, sweep_factor=1)
CLOSE_METHODS = (Method(False, 1), CONTINUATION, CLOSE_LAST_RESORT)
# Time of one core per node [s], measured with kappa from 1 to 5: cycles that settle a film take 5e-6 to 2e-5,
# those that fail up to 4.4e-5. Expected times make what is tried depend on the grids, not on the machine.
CYCLES_TIME, FAILED_TIME, CONTINUATION_TIME, NEWTON_TIME = 1e-5, 4.4e-5, 4.2e-5, 3.5e-4
RESERVE = 0.25  # of a budget, for Newton steps on a coarser mesh after everything else


@dataclass(slots=True)
class Attempt:
    """One attempt at a film; `status` and `error_estimate` are entered by whoever makes it."""

    mesh: Mesh
    method: Method
    earlier: Attempt | None = None  # whose film stays unless this attempt ends better
    status: Status = Status.FAILED
    error_estimate: ErrorEstimate | None = None
    cut: bool = False  # whether another attempt would have followed within a larger budget

    @property
    def expected_time(self) -> float:
        """Expected time of one core [s], by the status.

        Before the attempt it is that of one that succeeds. Above kappa = 1 a grid finer than that of a converged
        film may fail, and its expected time is that of a failure.
        """
        if self.method.newton:
            return NEWTON_TIME * self.mesh.nodes
        if self.method.load_continuation:
            return CONTINUATION_TIME * self.mesh.nodes
        in_doubt = self.status is Status.FAILED and self.earlier is not None and self.mesh.kappa > 1.0
        fails = self.status in FAILED or in_doubt
        return (FAILED_TIME if fails else CYCLES_TIME) * self.mesh.nodes

    @property
    def is_better(self) -> bool:
        """Whether its film takes the place of the one before."""
        if self.earlier is None or self.status.ok:
            return True
        return self.earlier.status in FAILED and self.status not in FAILED


def attempts(
    point: MoesPoint,
    grid: Grid,
    method: str,
    *,
    largest_load: float = 1.0,
    refine: bool = True,
    cut_short: bool = False,
    budget: float = inf,
) -> Iterator[Attempt]:
    """Yield the attempts at a film; each has to be made before the next one is taken.

    Parameters
    ----------
    point : MoesPoint
    grid : Grid
        Intervals and region given by the caller.
    method : {"automatic", "multigrid", "newton"}
    largest_load : float
        That the contact will have to carry; the static load is 1. Above 1 it sets the default region.
    refine : bool
        Whether a converged film is solved on finer meshes until its error estimate is small.
    cut_short : bool
        Whether a limit of cycles given by the caller ends the solve: then nothing else is tried after it.
    budget : float
        Expected time of one core [s] that all attempts together may take; the first one is always made.

    Raises
    ------
    InputError
        The first mesh would not fit into memory.
    """
    mesh = mesh_for(point, Purpose.FILM, grid, largest_load=largest_load)
    mesh.require_memory(Solve.NEWTON if method == "newton" else Solve.CYCLES)
    if largest_load > 1.0:
        grid = replace(grid, domain=mesh.domain)  # wide enough already, and no narrower one would be
    earlier: Attempt | None = None
    tried: list[Attempt] = []
    spent = 0.0
    for left in reversed(range(LARGEST_ATTEMPTS)):
        ways = METHODS[method]
        if mesh.y_refinement > 1 and method == "automatic":
            ways = (CONTINUATION,) if is_last(mesh) else CLOSE_METHODS
        for way in ways[:1] if earlier else ways:
            if way.newton and method == "automatic" and not allows_newton(mesh):
                break
            if way.from_half and mesh.n < LEAST_HALVED:
                continue
            planned = Attempt(mesh, way, earlier)
            if tried and spent + planned.expected_time > budget:
                tried[-1].cut = True
                break
            tried.append(made := planned)
            yield made
            spent += made.expected_time
            if cut_short and made.status is Status.MAX_CYCLES:
                return
            if made.status not in FAILED:
                break
        made = tried[-1]
        if made.mesh != mesh:  # the budget ended before it
            break
        if earlier and not made.status.ok:
            return
        error = made.error_estimate if refine else None
        following = remedy(mesh, made.status, point, grid=grid, error=error) if left else None
        if following is None:
            break
        mesh, earlier = following, made if made.status.ok else None
    coarser = newton_mesh(made.mesh, max(budget - spent, RESERVE * budget) / NEWTON_TIME)
    if grid.n is None and method == "automatic" and made.status in FAILED and coarser is not None:
        # The smallest film may be far off, which its error estimate shows; better than none.
        yield Attempt(coarser, LAST_RESORT if made.mesh.y_refinement == 1 else CLOSE_LAST_RESORT, earlier=made)
