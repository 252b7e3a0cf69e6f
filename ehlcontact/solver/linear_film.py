"""The linearised film as an operator: sparse flow and transport, elasticity by fast transforms.

Around a state P, H of a level, the Newton equations over the free nodes read

    Jp dP + Jh (K dP - du) = r,      stiffness du + weight w.dP = b,

with the sparse derivatives Jp to the pressure and Jh to the film (`kernels.linearise`), the deflection K and
the force weights w. Vectors hold all nodes of the level, flat, and du last; entries of nodes that are not free
stay zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.grid import Array, Level
from ehlcontact.solver.kernels.linearise import NEIGHBOURS, linearise, neighbour

Mask = NDArray[np.bool_]
Offsets = Sequence[tuple[int, int]]

NEIGHBOUR_OFFSETS: Offsets = [(j - 2, i - 2) for j, i in (neighbour(q, 2, 2) for q in range(NEIGHBOURS))]
BALANCE_WEIGHT = 3.0  # of the balance beside the rms residual of the nodes, as in `newton`


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
    return sparse.csr_matrix(entries, shape=(node.size, node.size))


def coefficients(level: Level, c_t: complex) -> tuple[Any, Any]:
    """Derivatives to pressure and film at the level's P, H and eps, both (6, ny + 1, nx + 1).

    They are linear in the time coefficient `c_t`, so an imaginary one, i times an angular frequency, is as good.
    For a real one they are the level's work arrays.
    """
    if isinstance(c_t, complex):
        steady = [field.copy() for field in coefficients(level, 0.0)]
        unit = coefficients(level, 1.0)
        p_coef, h_coef = (a + c_t * (b - a) for a, b in zip(steady, unit, strict=True))
        return p_coef, h_coef
    f = level.fields
    linearise(f.P, f.flow, level.mesh, c_t, 1.0, f.p_coef, f.h_coef)
    return f.p_coef, f.h_coef


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
    """

    def __init__(self, level: Level, free: Mask, balance: Balance, c_t: complex | None = None) -> None:
        self.free, self.balance = free, balance
        self.c_t = level.c_t if c_t is None else c_t
        p_coef, h_coef = coefficients(level, self.c_t)
        self.by_pressure = stencil_matrix(NEIGHBOUR_OFFSETS, p_coef, free.shape)
        self.by_film = stencil_matrix(NEIGHBOUR_OFFSETS, h_coef, free.shape)
        self.by_approach = -h_coef.sum(axis=0).ravel()
        self.deflection = level.deflection
        self.weights = level.force_weights.ravel()
        self.scale = BALANCE_WEIGHT * sqrt(max(1.0, float(np.count_nonzero(free))))  # of the last row

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
