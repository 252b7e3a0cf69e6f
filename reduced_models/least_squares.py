"""Linear least squares by QR on scaled columns, which says what it cannot tell apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr, solve_triangular

from ehlcontact.errors import InputError

# A direction that holds less than this share of its column is rounding, or the solver's own tolerance.
SINGULAR = 1e-10


@dataclass(frozen=True, eq=False)
class LinearFit:
    """Solution of min |A x - f|; entries in the order of the columns."""

    names: tuple[str, ...]
    values: NDArray[np.float64]
    covariance: NDArray[np.float64]
    condition: float  # 2-norm condition number of the column-scaled matrix
    fitted: NDArray[np.float64]


def linear_fit(columns: Mapping[str, NDArray[np.float64]], target: NDArray[np.float64]) -> LinearFit:
    """Fit `target`, shape (N,), by a sum of columns, each of shape (N,).

    The normal equations (eqs. 10 and 12) square a condition number of 1e3 to 1e5; QR does not. The
    covariance supposes independent residuals, which those of a simulation are not: it is a lower bound.

    Raises
    ------
    InputError
        No more samples than columns, or columns that are zero or depend on each other; it names them.
    """
    names = tuple(columns)
    A = np.column_stack([columns[name] for name in names])
    if A.shape[0] <= A.shape[1]:
        raise InputError("samples", A.shape[0], f"more than the {A.shape[1]} parameters")
    norms = np.linalg.norm(A, axis=0)
    zero = [name for name, norm in zip(names, norms, strict=True) if norm == 0.0]
    if zero:
        raise InputError("columns " + ", ".join(zero), 0.0, "somewhere different from zero")
    basis, R, pivots = qr(A / norms, mode="economic", pivoting=True)
    dependent = [names[pivots[i]] for i in range(len(names)) if abs(R[i, i]) < SINGULAR]
    if dependent:
        kept = ", ".join(name for name in names if name not in dependent)
        raise InputError(
            "columns " + ", ".join(dependent),
            "dependent",
            f"independent of {kept} (the record varies too little)",
        )
    values = np.empty(len(names))
    values[pivots] = solve_triangular(R, basis.T @ target)
    inverse = np.empty((len(names), len(names)))
    inverse[pivots] = solve_triangular(R, np.eye(len(names)))
    values, inverse = values / norms, inverse / norms[:, None]
    fitted = A @ values
    variance = np.sum((target - fitted) ** 2) / (A.shape[0] - A.shape[1])
    return LinearFit(names, values, variance * inverse @ inverse.T, float(np.linalg.cond(R)), fitted)
