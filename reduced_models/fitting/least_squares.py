"""Linear least squares by QR on scaled columns, with the columns that the data do not determine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import InputError

# Share of a column that must be its own: less is rounding, or the tolerance of the solver that made the record.
OWN_SHARE = 1e-10
# Share of one column in another that makes it a named part of a dependence: far above the rounding of what
# `OWN_SHARE` lets pass.
NAMED_SHARE = 1e-3


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
    basis, R, pivots = scipy.linalg.qr(A / np.where(norms > 0.0, norms, 1.0), mode="economic", pivoting=True)
    rank = int(np.count_nonzero(np.abs(np.diag(R)) >= OWN_SHARE))  # pivoting sorts the diagonal
    if rank < len(names):
        # What the last columns are made of belongs to the dependence as much as they do.
        shares = np.abs(scipy.linalg.solve_triangular(R[:rank, :rank], R[:rank, rank:])).max(axis=1, initial=0.0)
        singular = {*pivots[rank:].tolist(), *pivots[:rank][shares > NAMED_SHARE].tolist()}
        raise InputError(
            "columns " + ", ".join(name for i, name in enumerate(names) if i in singular),
            "zero or dependent",
            "different from zero and independent of each other (the record varies too little)",
        )
    values = np.empty(len(names))
    values[pivots] = scipy.linalg.solve_triangular(R, basis.T @ target)
    inverse = np.empty((len(names), len(names)))
    inverse[pivots] = scipy.linalg.solve_triangular(R, np.eye(len(names)))
    values, inverse = values / norms, inverse / norms[:, None]
    fitted = A @ values
    variance = np.sum((target - fitted) ** 2) / (A.shape[0] - A.shape[1])
    return LinearFit(names, values, variance * inverse @ inverse.T, float(np.linalg.cond(R)), fitted)
