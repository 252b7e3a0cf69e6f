"""Semismooth Newton with dense elasticity: the coarse-grid solver of the multigrid cycle.

Unknowns are the pressures of the free nodes and the approach u, closed by the load or motion equation, so
force balance is exact on the coarsest grid and needs no relaxation factor. Complementarity P >= 0 by the
primal-dual active set: a node is free if P > 0 or if its residual asks for pressure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from ehlcontact._kernels.linearise import dense_jacobian, linearise
from ehlcontact.grid import Array, Level

Nodes = NDArray[np.intp]

LARGEST_STEP = 0.3  # of any pressure or of u, in one iteration
SMALLEST_DAMPING = 2.0**-6
CORRECTION_STEPS = 2  # of the coarsest grid in one cycle
CORRECTION_DROP = 1e-2  # of its residual, enough for one cycle


@dataclass(frozen=True, slots=True)
class Balance:
    """The equation that closes a solve: ``stiffness * u + weight * force = rhs``.

    Load balance is (0, 1, load), prescribed approach (1, 0, u), and a step of the equation of motion with
    Newmark's rule has stiffness 4/(Omega_n dT)^2 and weight 1.
    """

    stiffness: float
    weight: float
    rhs: float

    def residual(self, u: float, force: float) -> float:
        """``rhs - stiffness u - weight force``."""
        return self.rhs - self.stiffness * u - self.weight * force

    def shifted(self, change: float) -> Balance:
        """Return the same equation with `change` added to its right-hand side."""
        return Balance(self.stiffness, self.weight, self.rhs + change)


class CoarseNewton:
    """Newton iterations on one level; keeps its work arrays."""

    def __init__(self, level: Level) -> None:
        self.level = level
        size = level.nx * (level.ny + 1)
        self._J = np.empty((size + 1, size + 1))
        self._number = np.empty(level.P.size, dtype=np.int64)

    def solve(self, u: float, balance: Balance, max_steps: int, tol: float) -> float:
        """Damped iterations from any start to ``merit <= tol`` or `max_steps`; P, H written, returns u."""
        level = self.level
        merit, free = self._evaluate(u, balance)
        for _ in range(max_steps):
            if not merit > tol:  # also stops on NaN, for the driver to judge
                break
            dP, du, damping = self._direction(free, balance, u)
            start = level.P.copy()
            while True:
                level.P[...] = np.maximum(start + damping * dP, 0.0)
                trial, free = self._evaluate(u + damping * du, balance)
                if trial <= merit * (1.0 - 0.1 * damping) or trial <= tol or damping < SMALLEST_DAMPING:
                    break
                damping *= 0.5
            u, merit = u + damping * du, trial
        return u

    def correct(self, u: float, balance: Balance) -> float:
        """Few undamped steps near a solution; P and H written, returns u.

        No line search here: nodes that come under pressure add their residuals to the merit in the very step
        that brings the balance about, so it would refuse good steps.
        """
        level = self.level
        merit, free = self._evaluate(u, balance)
        target = CORRECTION_DROP * merit
        for _ in range(CORRECTION_STEPS):
            if not merit > max(target, 1e-14):
                break
            dP, du, damping = self._direction(free, balance, u)
            level.P[...] = np.maximum(level.P + damping * dP, 0.0)
            u += damping * du
            merit, free = self._evaluate(u, balance)
        return u

    def _evaluate(self, u: float, balance: Balance) -> tuple[float, Nodes]:
        """Merit (rms residual over free nodes and balance residual) and the flat numbers of free nodes."""
        level = self.level
        level.update_film(u)
        r = level.update_residual()
        free = np.flatnonzero((level.P > 0.0) | (r < 0.0))
        rms = float(np.sqrt(np.mean(r.ravel()[free] ** 2))) if free.size else 0.0
        return rms + 3.0 * abs(balance.residual(u, level.force())), free

    def _direction(self, free: Nodes, balance: Balance, u: float) -> tuple[Array, float, float]:
        """Newton direction in P and u, and the step length that keeps it within LARGEST_STEP."""
        level, f = self.level, self.level.fields
        m = free.size
        J = self._J[: m + 1, : m + 1]
        linearise(f.P, f.H, f.eps, level.law, level.mesh, level.c_t, False, f.p_coef, f.h_coef)
        dense_jacobian(free, f.p_coef, f.h_coef, level.deflection.kernel, self._number, J)
        J[m, :m] = balance.weight * level.force_weights.ravel()[free]
        J[m, m] = balance.stiffness
        rhs = np.append(level.r.ravel()[free], balance.residual(u, level.force()))
        try:
            solution = linalg.solve(J, rhs, overwrite_a=True, overwrite_b=True, check_finite=False)
        except linalg.LinAlgError:
            return np.full_like(f.P, np.nan), np.nan, 1.0
        dP = np.zeros_like(f.P)
        dP.ravel()[free] = solution[:m]
        largest = float(np.abs(solution).max())
        return dP, float(solution[m]), LARGEST_STEP / max(largest, LARGEST_STEP)
