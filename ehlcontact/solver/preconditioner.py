"""Two-grid preconditioner of the linearised film: dense factors far, sparse factors near.

A coarse grid, with all its elasticity and the balance, takes the long waves. What it leaves is written as a
distributed change of pressure, ``dP = D w`` with ``D = 1 - (mean over the four neighbours)``: its deflection
K D decays like 1/r^3 instead of 1/r (Venner and Lubrecht 2000, ch. 6), so the nearest coefficients stand for
all and ``Jp D + Jh (K D)_near`` is a sparse matrix for a direct solver. Unlike relaxation by lines it needs
no switch to plain changes where flow dominates, because the flow terms are solved exactly.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from scipy import linalg, sparse
from scipy.sparse.linalg import splu

from ehlcontact.solver.grid import Array, Level
from ehlcontact.solver.kernels.linearise import dense_jacobian
from ehlcontact.solver.kernels.relax import SHARE
from ehlcontact.solver.linear_film import LinearFilm, coefficients, stencil_matrix

REACH = 1  # of the near coefficients; 2 saves few iterations and doubles the time of the factors
LARGEST_DENSE = 32  # intervals along X of the coarse grid
CROSS = ((0, 0), (0, -1), (0, 1), (-1, 0), (1, 0))
SQUARE = tuple((dj, di) for dj in range(-REACH, REACH + 1) for di in range(-REACH, REACH + 1))
SPARSE_LU = {  # structure symmetric, no small pivots: a third of the time of the default ordering
    "permc_spec": "MMD_AT_PLUS_A",
    "diag_pivot_thresh": 0.01,
    "options": {"SymmetricMode": True},
}


class Preconditioner:
    """Factors made at one state of the finest level, for all states near it.

    Parameters
    ----------
    levels : list of Level
        Coarse to fine. The finest carries the unknowns; the finest of those with at most `LARGEST_DENSE`
        intervals carries the dense factors, and its P and H are overwritten.
    system : LinearFilm
        Linearisation of the finest level at its present state.
    near : NearCorrection, optional
        Sparse factors made for another system that differs in long waves only.
    """

    def __init__(self, levels: list[Level], system: LinearFilm, near: NearCorrection | None = None) -> None:
        coarse = max((k for k in levels[:-1] if k.nx <= LARGEST_DENSE), key=lambda k: k.nx, default=levels[0])
        self._coarse = CoarseCorrection(coarse, levels[-1], system)
        self._near = near or NearCorrection(levels[-1], system)

    def __call__(self, system: LinearFilm, b: Array) -> Array:
        """Approximate solution (dP, du) of ``system(x) = b``, shape (nodes + 1,)."""
        x = self._coarse(system, b)
        x[:-1] += self._near(system, (b - system(x))[:-1])
        return x


class NearCorrection:
    """Sparse factors of the Jacobian in distributed changes of pressure, with near coefficients alone."""

    def __init__(self, fine: Level, system: LinearFilm) -> None:
        self._free = system.free.ravel()
        inside = self._nodes = np.flatnonzero(self._free)
        shape = system.free.shape
        shares = np.array([1.0, *(len(CROSS) - 1) * (-SHARE,)])
        self._distribution = stencil_matrix(CROSS, shares[:, None, None], shape)[inside][:, inside]
        decaying = fine.near - fine.spread
        near = np.array([decaying[abs(dj), abs(di)] for dj, di in SQUARE])
        film = stencil_matrix(SQUARE, near[:, None, None], shape)[:, inside]
        matrix = system.by_pressure[inside][:, inside] @ self._distribution + system.by_film[inside] @ film
        self._lu = splu(matrix.tocsc(), **SPARSE_LU)
        own = system.diagonal()
        self._own = np.where(own.real < 0.0, own, -np.inf)

    def __call__(self, system: LinearFilm, r: Array) -> Array:
        """Change dP of the nodes for the residuals `r`, both (nodes,)."""
        dP = np.zeros_like(r)
        dP[self._nodes] = self._distribution @ self._lu.solve(r[self._nodes])
        free = system.free.ravel()
        new = free & ~self._free  # since the factors were made
        dP[new] = r[new] / self._own[new]
        return dP * free


class CoarseCorrection:
    """Dense bordered Jacobian of a coarse level, with interpolation from it and its weighted transpose."""

    def __init__(self, coarse: Level, fine: Level, system: LinearFilm) -> None:
        every = fine.nx // coarse.nx
        self._nodes = np.flatnonzero(system.free[::every, ::every])
        across, along = (_interpolation(intervals, every) for intervals in (coarse.ny, coarse.nx))
        self._up = sparse.kron(across, along, format="csr")[:, self._nodes]
        weights = coarse.force_weights.ravel()[self._nodes]
        self._down = sparse.diags(1.0 / weights) @ self._up.T @ sparse.diags(fine.force_weights.ravel())
        self._lu = self._factorise(coarse, fine, every, system)

    def _factorise(self, coarse: Level, fine: Level, every: int, system: LinearFilm) -> Any:
        f, balance, m = coarse.fields, system.balance, self._nodes.size
        f.P[...] = fine.P[::every, ::every]
        f.H[...] = fine.H[::every, ::every]
        coarse.update_residual()  # for eps
        p_coef, h_coef = coefficients(coarse, system.c_t)
        J = np.empty((m + 1, m + 1), dtype=p_coef.dtype)
        number = np.empty(f.P.size, dtype=np.int64)
        dense_jacobian(self._nodes, p_coef, h_coef, coarse.deflection.kernel, number, J)
        J[m, :m] = balance.weight * coarse.force_weights.ravel()[self._nodes]
        J[m, m] = balance.stiffness
        with warnings.catch_warnings():  # a singular matrix gives infinities, which the driver reports
            warnings.simplefilter("ignore", linalg.LinAlgWarning)
            return linalg.lu_factor(J, overwrite_a=True, check_finite=False)

    def __call__(self, system: LinearFilm, b: Array) -> Array:
        """Change (dP, du) of the fine nodes from the restricted ``system(x) = b``."""
        rhs = np.append(self._down @ b[:-1], b[-1] / system.scale)
        y = linalg.lu_solve(self._lu, rhs, overwrite_b=True, check_finite=False)
        return np.append((self._up @ y[:-1]) * system.free.ravel(), y[-1])


def _interpolation(intervals: int, every: int) -> Any:
    """Linear interpolation from a line of `intervals` to one `every` times as fine, sparse."""
    distance = np.arange(intervals * every + 1)[:, None] / every - np.arange(intervals + 1)
    return sparse.csr_matrix(np.maximum(1.0 - np.abs(distance), 0.0))
