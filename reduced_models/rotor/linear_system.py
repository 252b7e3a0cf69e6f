"""A rotor on linear supports as one system of first order, the memory of the supports among its states.

Its eigenvalues are the modes of a rotor on elements; with bearings of other kinds: `modes`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from reduced_models.elements.film_response import StateSpace
from reduced_models.rotor.rotor import Matrices

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


def rotor_system(matrices: Matrices, rows: _Floats, supports: Sequence[StateSpace]) -> tuple[_Floats, _Floats]:
    """A, and B of forces on all degrees of freedom, for the states q, q' and those of the supports.

    Parameters
    ----------
    matrices : tuple of ndarray, shape (N, N)
        Mass, damping, stiffness.
    rows : ndarray, shape (m, N)
        Motions of all supports from the displacements.
    supports : sequence of StateSpace
        Of every support, from its motions and their rates to its forces.
    """
    M, damping, K = matrices
    size = len(M)
    total = 2 * size + sum(len(support.A) for support in supports)
    A, driven = np.zeros((total, total)), np.zeros((total, size))
    A[:size, size : 2 * size] = np.eye(size)
    pull = np.zeros((size, total))  # forces that act on the masses
    pull[:, :size], pull[:, size : 2 * size] = -K, -damping
    first_state, first = 2 * size, 0
    for support in supports:
        count = len(support.C)
        own, here = rows[first : first + count], slice(first_state, first_state + len(support.A))
        both = np.zeros((2 * count, total))
        both[:count, :size], both[count:, size : 2 * size] = own, own
        A[here] += support.B @ both
        A[here, here] += support.A
        pull -= own.T @ support.D @ both
        pull[:, here] -= own.T @ support.C
        first_state, first = here.stop, first + count
    A[size : 2 * size] = np.linalg.solve(M, pull)
    driven[size : 2 * size] = np.linalg.inv(M)
    return A, driven


def eigenmodes(matrices: Matrices, rows: _Floats, supports: Sequence[StateSpace]) -> tuple[_Complex, _Complex]:
    """Eigenvalues with an imaginary part > 0 of `rotor_system`, and displacements of their vectors as columns."""
    values, vectors = scipy.linalg.eig(rotor_system(matrices, rows, supports)[0])
    vibrates = values.imag > 0.0
    return values[vibrates], vectors[: len(matrices[0]), vibrates]
