"""Flexible Krylov solution of the linearised film."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gcrotmk

from ehlcontact.solver.linear_film import LinearFilm
from ehlcontact.solver.preconditioner import Preconditioner

KRYLOV_VECTORS = 20
KRYLOV_RESTARTS = 3


@dataclass(frozen=True, slots=True, eq=False)
class LinearSolution:
    """Solution of a linear system, and what it took."""

    x: NDArray[Any]  # (nodes + 1,): dP and du, of the type of the right-hand side
    iterations: int
    converged: bool


def solve_linear(
    system: LinearFilm, preconditioner: Preconditioner, b: NDArray[Any], rtol: float
) -> LinearSolution:
    """Solve ``system(x) = b`` to ``|b - system(x)| <= rtol |b|`` by GCROT(m,k) (Hicken and Zingg 2010).

    Each iteration takes two deflections, one of them in the preconditioner.
    """
    iterations = 0

    def precondition(v: NDArray[Any]) -> NDArray[Any]:
        nonlocal iterations
        iterations += 1
        return preconditioner(system, v)

    shape = (b.size, b.size)
    x, info = gcrotmk(
        LinearOperator(shape, matvec=system, dtype=b.dtype),
        b,
        rtol=rtol,
        maxiter=KRYLOV_RESTARTS,
        M=LinearOperator(shape, matvec=precondition, dtype=b.dtype),
        m=KRYLOV_VECTORS,
    )
    return LinearSolution(x, iterations, info == 0)
