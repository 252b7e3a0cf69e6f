"""Semismooth Newton with dense elasticity: the coarse-grid solver of the multigrid cycle.

Unknowns are the pressures of the active nodes and the approach u, closed by the load or motion equation, so
force balance is exact on the coarsest grid and needs no relaxation factor. Complementarity P >= 0 by the
primal-dual active set: a node is active if P > 0 or if its residual is negative.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.kernels.linearise import dense_jacobian, linearise
from ehlcontact.solver.level import Array, Level

Nodes = NDArray[np.intp]

LARGEST_STEP = 0.3  # of any pressure, or of u over its size where that is above 1, in one iteration
SMALLEST_DAMPING = 2.0**-6
CORRECTION_STEPS = 4  # of the coarsest grid in one cycle
LARGEST_RENEWALS = 2  # of the factors in one cycle
WORN_OUT = 0.3  # drop of the merit in one step above which factors are renewed
CORRECTION_DROP = 0.1  # of its residual, enough for one cycle,
LONG_CORRECTION_DROP = 0.01  # and in a contact long along rolling, whose side lobes the coarsest grid hardly sees
BALANCE_WEIGHT = 3.0  # of the balance beside the rms residual of the nodes


@dataclass(frozen=True, slots=True, eq=False)
class Factors:
    """LU factors of a bordered Jacobian, and what it was made for."""

    lu: tuple[Array, NDArray[np.int32]]  # of LAPACK
    free: Nodes
    equation: tuple[float, float, float, float]  # time coefficient, speed, balance stiffness and weight


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
    linearise(f.P, f.flow, level.stencil, c_t, 1.0, f.p_coef, f.h_coef)
    return f.p_coef, f.h_coef


def bordered_lu(
    level: Level, free: Nodes, derivatives: tuple[Array, Array], balance: Balance
) -> tuple[Array, NDArray[np.int32]]:
    """LU factors of the dense Jacobian of `level` over the nodes `free`, (m,), bordered by u and its balance.

    `derivatives` are those to pressure and to film, (6, ny + 1, nx + 1) each, real or complex.
    """
    feeding, fed = level.feeds(derivatives)
    rows = np.union1d(free, feeding)
    J = np.empty((rows.size + 1, rows.size + 1), dtype=derivatives[0].dtype)
    number = np.empty(level.P.size, dtype=np.int64)
    dense_jacobian(rows, *derivatives, level.deflection.kernel, number, J)
    if feeding.size:
        later = 1.0 / (1.0 + 0.5 * level.c_t * (level.hx / level.speed)) ** (fed - feeding)  # of a step in time
        np.add.at(J, number[fed], later[:, None] * J[number[feeding]])
        kept = np.append(number[free], rows.size)
        J = J[np.ix_(kept, kept)]
    m = free.size
    J[m, :m] = balance.weight * level.force_weights.ravel()[free]
    J[m, m] = balance.stiffness
    with warnings.catch_warnings():  # a singular matrix gives infinities, which the driver reports
        warnings.simplefilter("ignore", scipy.linalg.LinAlgWarning)
        return scipy.linalg.lu_factor(J, overwrite_a=True, check_finite=False)


class CoarseNewton:
    """Newton iterations on one level; keeps its work arrays and, between corrections, its last factors."""

    def __init__(self, level: Level, long: bool = False) -> None:
        self.level = level
        self._drop = LONG_CORRECTION_DROP if long else CORRECTION_DROP
        self.factors: Factors | None = None

    def solve(self, u: float, balance: Balance, max_steps: int, tol: float) -> float:
        """Damped iterations from any start to ``merit <= tol`` or `max_steps`; P, H written, returns u."""
        level = self.level
        merit, free = self._evaluate(u, balance)
        for _ in range(max_steps):
            if not merit > tol:  # also stops on NaN, for the driver to judge
                break
            self.factors = self._factorise(free, balance)
            dP, du, damping = self._direction(self.factors, free, balance, u)
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

        Old factors serve as long as they reduce the merit well. No line search here: nodes that come under
        pressure add their residuals to the merit in the very step that brings the balance about, so it would
        refuse good steps.
        """
        level = self.level
        merit, free = self._evaluate(u, balance)
        target = max(self._drop * merit, 1e-14)
        equation = _equation(level, balance)
        renewals = 0
        for _ in range(CORRECTION_STEPS):
            if not merit > target:
                break
            if self.factors is None or self.factors.equation != equation:
                if renewals == LARGEST_RENEWALS:
                    break
                self.factors = self._factorise(free, balance)
                renewals += 1
            dP, du, damping = self._direction(self.factors, free, balance, u)
            level.P[...] = np.maximum(level.P + damping * dP, 0.0)
            u += damping * du
            before = merit
            merit, free = self._evaluate(u, balance)
            if not merit < WORN_OUT * before:
                self.factors = None
        return u

    def _evaluate(self, u: float, balance: Balance) -> tuple[float, Nodes]:
        """Merit (rms residual over free nodes and balance residual) and the flat numbers of free nodes."""
        level = self.level
        r = level.update(u)
        free = np.flatnonzero((level.P > 0.0) | (r < 0.0))
        rms = float(np.sqrt(np.mean(r.ravel()[free] ** 2))) if free.size else 0.0
        return rms + BALANCE_WEIGHT * abs(balance.residual(u, level.force())), free

    def _factorise(self, free: Nodes, balance: Balance) -> Factors:
        """LU factors of the Jacobian over the free nodes, bordered by u and its balance."""
        level = self.level
        lu = bordered_lu(level, free, coefficients(level, level.c_t), balance)
        return Factors(lu, free, _equation(level, balance))

    def _direction(self, factors: Factors, free: Nodes, balance: Balance, u: float) -> tuple[Array, float, float]:
        """Newton direction in P and u, and the step length that keeps it within LARGEST_STEP.

        Nodes that came under pressure after the factors were made are left to relaxation.
        """
        level = self.level
        wanted = np.zeros(level.P.size, dtype=bool)
        wanted[free] = True
        rhs = np.append(
            np.where(wanted[factors.free], level.r.ravel()[factors.free], 0.0), balance.residual(u, level.force())
        )
        solution = scipy.linalg.lu_solve(factors.lu, rhs, overwrite_b=True, check_finite=False)
        dP = np.zeros_like(level.P)
        dP.ravel()[factors.free] = solution[:-1]
        if level.inflow.size:
            dP *= wanted.reshape(dP.shape)  # a node that is partly filled jumps, were it taken for full
        return dP, float(solution[-1]), step_length(dP, float(solution[-1]), u)


def _equation(level: Level, balance: Balance) -> tuple[float, float, float, float]:
    """What factors are made for."""
    return level.c_t, level.speed, balance.stiffness, balance.weight


def step_length(dP: Array, du: float, u: float) -> float:
    """Share of a Newton direction that keeps it within LARGEST_STEP."""
    return LARGEST_STEP / max(float(np.abs(dP).max()), abs(du) / max(1.0, abs(u)), LARGEST_STEP)
