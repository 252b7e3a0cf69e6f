"""Linearised film: operator, preconditioner and Krylov solution.

Around a state P, H of a level, the Newton equations over the free nodes read

    Jp dP + Jh (K dP - du) = r,      stiffness du + weight w.dP = b,

with the sparse derivatives Jp to the pressure and Jh to the film (`kernels.linearise`), the deflection K and the
force weights w. Vectors hold all nodes of the level, flat, and du last; entries of nodes that are not free stay
zero.

The preconditioner has two grids. A coarse one, with all its elasticity and the balance, takes the long waves by
dense factors. What it leaves is written as a distributed change of pressure, ``dP = D w`` with
``D = 1 - (mean over the four neighbours)``: its deflection K D decays like 1/r^3 instead of 1/r (Venner and
Lubrecht 2000, ch. 6), so the nearest coefficients stand for all and ``Jp D + Jh (K D)_near`` is a sparse matrix
for a direct solver. Unlike relaxation by lines it needs no switch to plain changes where flow dominates, because
the flow terms are solved exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.jit import plain
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse_newton import BALANCE_WEIGHT, bordered_lu, coefficients
from ehlcontact.solver.kernels.linearise import NEIGHBOURS, neighbour
from ehlcontact.solver.kernels.relax import SHARE, response
from ehlcontact.solver.level import Array, Level

Mask = NDArray[np.bool_]
Offsets = Sequence[tuple[int, int]]

# In plain Python: a first call of anything compiled takes a third of a second, and this is imported everywhere.
NEIGHBOUR_OFFSETS: Offsets = [(j - 2, i - 2) for j, i in (plain(neighbour)(q, 2, 2) for q in range(NEIGHBOURS))]
KRYLOV_VECTORS = 20
KRYLOV_RESTARTS = 3
REACH = 1  # of the near coefficients; 2 saves few iterations and doubles the time of the factors
LARGEST_DENSE = 32  # intervals along X of the coarse grid
CROSS = ((0, 0), (0, -1), (0, 1), (-1, 0), (1, 0))
SQUARE = tuple((dj, di) for dj in range(-REACH, REACH + 1) for di in range(-REACH, REACH + 1))
SPARSE_LU = {  # structure symmetric, no small pivots: a third of the time of the default ordering
    "permc_spec": "MMD_AT_PLUS_A",
    "diag_pivot_thresh": 0.01,
    "options": {"SymmetricMode": True},
}


def stencil_matrix(offsets: Offsets, coefficients: Array, shape: tuple[int, int]) -> Any:
    """Sparse matrix of a stencil on a half domain; nodes below the symmetry line are their images.

    Parameters
    ----------
    offsets : sequence of (int, int)
        Lines and columns from a node to the neighbours it takes from.
    coefficients : array (k, ny + 1, nx + 1) or (k, 1, 1)
        One field, or one number, per neighbour.
    shape : (int, int)
        Nodes along Y and along X.
    """
    j, i = np.indices(shape)
    node = j * shape[1] + i
    rows, columns, values = [], [], []
    for (dj, di), field in zip(offsets, coefficients, strict=True):
        jq, iq = np.abs(j + dj), i + di
        inside = (jq < shape[0]) & (iq >= 0) & (iq < shape[1]) & (field != 0.0)
        rows.append(node[inside])
        columns.append((jq * shape[1] + iq)[inside])
        values.append(np.broadcast_to(field, shape)[inside])
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return scipy.sparse.csr_matrix(entries, shape=(node.size, node.size))


def _entries(size: int, *entries: tuple[Any, Any, Any]) -> Any:
    """Square sparse matrix of rows, columns and values."""
    rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
    return scipy.sparse.csr_matrix((values, (rows, columns)), shape=(size, size))


class LinearFilm:
    """Linearisation of a level at its present P, H and eps over the free nodes, closed by a balance.

    Parameters
    ----------
    level : Level
        Its film and residual are up to date.
    free : bool array (ny + 1, nx + 1)
        Nodes whose pressure is unknown.
    balance : Balance
    c_t : float or complex, optional
        Time coefficient, by default that of the level; i Omega for an oscillation.
    beside : (sparse, sparse), optional
        Derivatives of the operator to pressure and film beside those of the level.
    """

    def __init__(
        self,
        level: Level,
        free: Mask,
        balance: Balance,
        c_t: complex | None = None,
        beside: tuple[Any, Any] | None = None,
    ) -> None:
        self.free, self.balance = free, balance
        self.c_t = level.c_t if c_t is None else c_t
        p_coef, h_coef = coefficients(level, self.c_t)
        feeding, fed = level.feeds((p_coef, h_coef))
        self.by_pressure = stencil_matrix(NEIGHBOUR_OFFSETS, p_coef, free.shape)
        self.by_film = stencil_matrix(NEIGHBOUR_OFFSETS, h_coef, free.shape)
        self.by_approach = -h_coef.sum(axis=0).ravel()
        if beside is not None:
            self.by_pressure = self.by_pressure + beside[0]
            self.by_film = self.by_film + beside[1]
            self.by_approach = self.by_approach - np.asarray(beside[1].sum(axis=1)).ravel()
        self._passed_on: Any = None  # what reaches the fronts of full film of changes at partly filled nodes
        self._pressed_back: Any = None  # and what the flow pressed back there does, of changes of ln(eps)
        if level.inflow.size:
            self._supply(level, feeding, fed)
        self.deflection = level.deflection
        self.weights = level.force_weights.ravel()
        self.scale = BALANCE_WEIGHT * sqrt(max(1.0, float(np.count_nonzero(free))))  # of the last row

    def _supply(self, level: Level, feeding: NDArray[np.int64], fed: NDArray[np.int64]) -> None:
        """Add what partly filled nodes pass on to the full ones behind them, later, and what moving fronts store.

        `feeding` and `fed` as of `Level.feeds`. The stored oil is that of `kernels.supply`.
        """
        fronts, size, half = level.fronts(), self.free.size, 0.5 * self.c_t * (level.hx / level.speed)
        arrives = np.ones(size, dtype=np.result_type(half, float))  # share of a given flow that is not stored
        arrives[fronts.nodes] -= half * (1.0 - fronts.passed + 2.0 * fronts.stored * fronts.passed)
        if feeding.size:
            lag = ((1.0 - half) / (1.0 + half)) ** (fed - feeding - 1) / (1.0 + half)
            passed_on = scipy.sparse.csr_matrix((lag * arrives[fed], (fed, feeding)), shape=(size, size))
            self.by_pressure = self.by_pressure + passed_on @ self.by_pressure
            self.by_film = self.by_film + passed_on @ self.by_film
            self.by_approach = self.by_approach + passed_on @ self.by_approach
            self._passed_on = passed_on
        if self.c_t == 0.0 or not fronts.nodes.size:
            return
        # The front: what is pressed back moves it, and what it passes is stored
        own = fronts.nodes
        back = -half / (1.0 + half) * arrives[own] - 2.0 * half * fronts.stored
        self.by_pressure = self.by_pressure + _entries(size, (own, own, back * fronts.by_pressure))
        film = _entries(size, (own, own, back * fronts.by_film), (own, own - 1, back * fronts.by_film_before))
        self._pressed_back = film @ scipy.sparse.diags(1.0 / level.fields.flow.film_slope.ravel())
        # By the film: of a full gap at the node, through the face behind it, and through the face before it
        rest, moved = 1.0 - fronts.passed, fronts.stored * fronts.passed
        shares = (-moved, 5.0 * moved + 0.5 * rest, 3.5 * rest + 2.0 * moved, -rest)
        entries = ((own, own + k - 2, self.c_t / 6.0 * share) for k, share in enumerate(shares))
        mass = _entries(size, *entries)
        flow = level.fields.flow
        film = film + mass @ scipy.sparse.diags(flow.rho.ravel())
        self.by_pressure = self.by_pressure + mass @ scipy.sparse.diags(flow.mass_slope.ravel())
        self.by_film = self.by_film + film
        self.by_approach = self.by_approach - np.asarray(film.sum(axis=1)).ravel()

    def with_supply(self, change: Array, log_eps: Array) -> Array:
        """Change of the operator by that of ln(eps), with what a supply passes on of it and stores; all flat.

        `change` is that of a film in which no front moves.
        """
        found = change if self._passed_on is None else change + self._passed_on @ change
        return found if self._pressed_back is None else found + self._pressed_back @ log_eps

    def __call__(self, x: Array) -> Array:
        """Left-hand sides, shape (nodes + 1,), of the change `x` = (dP, du)."""
        dP, du = x[:-1], x[-1]
        flow = self.at_nodes(dP, self.deflect(dP)) + du * self.by_approach
        closing = self.balance.stiffness * du + self.balance.weight * (self.weights @ dP)
        return np.append(flow * self.free.ravel(), self.scale * closing)

    def deflect(self, dP: Array) -> Array:
        """Deflection by the change of pressure `dP`, both flat."""
        dP = dP.reshape(self.free.shape)
        if np.iscomplexobj(dP):
            return (self.deflection(dP.real) + 1j * self.deflection(dP.imag)).ravel()
        return self.deflection(dP).ravel()

    def at_nodes(self, dP: Array, deflection: Array) -> Array:
        """Change of the Reynolds operator at all nodes by changes of pressure and film, all flat."""
        return self.by_pressure @ dP + self.by_film @ deflection

    def right_hand_side(self, r: Array, load_residual: float) -> Array:
        """Vector of the residuals `r` of the nodes and of the balance."""
        return np.append((r * self.free).ravel(), self.scale * load_residual)

    def diagonal(self) -> Array:
        """Diagonal over the nodes, shape (nodes,), with each node's own deflection."""
        return self.by_pressure.diagonal() + self.by_film.diagonal() * self.deflection.kernel[0, 0]


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
        near = np.array([plain(response)(dj, di, (SHARE,) * (len(CROSS) - 1), fine.near) for dj, di in SQUARE])
        film = stencil_matrix(SQUARE, near[:, None, None], shape)[:, inside]
        matrix = system.by_pressure[inside][:, inside] @ self._distribution + system.by_film[inside] @ film
        self._lu = scipy.sparse.linalg.splu(matrix.tocsc(), **SPARSE_LU)
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
        every = fine.ny // coarse.ny, fine.nx // coarse.nx
        self._nodes = np.flatnonzero(system.free[:: every[0], :: every[1]])
        across, along = (_interpolation(n, k) for n, k in zip((coarse.ny, coarse.nx), every, strict=True))
        self._up = scipy.sparse.kron(across, along, format="csr")[:, self._nodes]
        weights = coarse.force_weights.ravel()[self._nodes]
        self._down = (
            scipy.sparse.diags(1.0 / weights) @ self._up.T @ scipy.sparse.diags(fine.force_weights.ravel())
        )
        self._lu = self._factorise(coarse, fine, every, system)

    def _factorise(self, coarse: Level, fine: Level, every: tuple[int, int], system: LinearFilm) -> Any:
        f = coarse.fields
        f.P[...] = fine.P[:: every[0], :: every[1]]
        f.H[...] = fine.H[:: every[0], :: every[1]]
        coarse.update_residual()  # for eps
        return bordered_lu(coarse, self._nodes, coefficients(coarse, system.c_t), system.balance)

    def __call__(self, system: LinearFilm, b: Array) -> Array:
        """Change (dP, du) of the fine nodes from the restricted ``system(x) = b``."""
        rhs = np.append(self._down @ b[:-1], b[-1] / system.scale)
        y = scipy.linalg.lu_solve(self._lu, rhs, overwrite_b=True, check_finite=False)
        return np.append((self._up @ y[:-1]) * system.free.ravel(), y[-1])


def _interpolation(intervals: int, every: int) -> Any:
    """Linear interpolation from a line of `intervals` to one `every` times as fine, sparse."""
    distance = np.arange(intervals * every + 1)[:, None] / every - np.arange(intervals + 1)
    return scipy.sparse.csr_matrix(np.maximum(1.0 - np.abs(distance), 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class LinearSolution:
    """Solution of a linear system, and what it took."""

    x: NDArray[Any]  # (nodes + 1,): dP and du, of the type of the right-hand side
    iterations: int
    converged: bool


def solve_linear(
    system: Callable[[Any], Any], preconditioner: Callable[[Any, Any], Any], b: NDArray[Any], rtol: float
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
    x, info = scipy.sparse.linalg.gcrotmk(
        scipy.sparse.linalg.LinearOperator(shape, matvec=system, dtype=b.dtype),
        b,
        rtol=rtol,
        maxiter=KRYLOV_RESTARTS,
        M=scipy.sparse.linalg.LinearOperator(shape, matvec=precondition, dtype=b.dtype),
        m=KRYLOV_VECTORS,
    )
    return LinearSolution(x, iterations, info == 0)
