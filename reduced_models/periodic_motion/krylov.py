"""Krylov spaces of a map's derivative: linear equations and eigenvalues from a few of its products.

Over a period most of the numbers of a rotor forget where they began: the derivative has few directions that
matter, and a Krylov space is exhausted after about as many products as the rotor has places and velocities.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

EXHAUSTED = 1e-10  # length of a product beside the space, over its own, of which differences leave noise
Product = Callable[[_Floats], _Floats]


class KrylovSpace:
    """Orthonormal vectors q of a Krylov space, and the derivative J between them: J q_k = sum over i of q_i h_ik.

    Parameters
    ----------
    product : callable
        The derivative times a vector.
    start : ndarray
        First vector.
    """

    def __init__(self, product: Product, start: _Floats) -> None:
        self._product = product
        self.vectors = [start / np.linalg.norm(start)]
        self._columns: list[_Floats] = []
        self.exhausted = False

    @property
    def size(self) -> int:
        """Number of products."""
        return len(self._columns)

    def grow(self) -> None:
        """Add a product."""
        new = self._product(self.vectors[-1])
        length, basis = float(np.linalg.norm(new)), np.array(self.vectors)
        column = np.zeros(len(basis) + 1)
        for _ in range(2):  # twice is enough (Giraud and Langou)
            shares = basis @ new
            column[:-1] += shares
            new = np.asarray(new - shares @ basis, np.float64)
        column[-1] = left = float(np.linalg.norm(new))
        self._columns.append(column)
        self.exhausted = not left > EXHAUSTED * length
        self.vectors.append(new / left if not self.exhausted else np.zeros_like(new))

    @property
    def matrix(self) -> _Floats:
        """Entries h, shape (size + 1, size)."""
        h = np.zeros((self.size + 1, self.size))
        for k, column in enumerate(self._columns):
            h[: column.size, k] = column
        return h

    def combined(self, shares: _Floats) -> _Floats:
        """Sum of the vectors with these shares."""
        return np.asarray(shares @ np.array(self.vectors[: shares.size]))


def solved(product: Product, right: _Floats, tolerance: float, most: int) -> _Floats:
    """Solution d of (1 - J) d = right to a share `tolerance` of its length, or after `most` products (GMRES)."""
    length, space = float(np.linalg.norm(right)), KrylovSpace(product, right)
    shares: _Floats = np.zeros(0)
    while space.size < most:
        space.grow()
        n = space.size
        system, target = np.eye(n + 1, n) - space.matrix, np.zeros(n + 1)
        target[0] = length
        shares = np.asarray(np.linalg.lstsq(system, target)[0], np.float64)
        if np.linalg.norm(system @ shares - target) <= tolerance * length or space.exhausted:
            break
    return space.combined(shares)


class Largest(NamedTuple):
    """Largest eigenvalues of a derivative."""

    values: _Complex  # the largest first
    left: _Floats  # what their vectors miss, over the largest of them
    products: int


def largest(product: Product, start: _Floats, count: int, tolerance: float, most: int) -> Largest:
    """The `count` largest eigenvalues, until what their vectors miss is below `tolerance` (Arnoldi).

    The first product is not in the space: it takes out of the start what a period forgets.
    """
    space = KrylovSpace(product, product(start / np.linalg.norm(start)))
    values, left = np.zeros(0, complex), np.zeros(0)
    while space.size < most:
        space.grow()
        if space.size < min(count + 1, most) and not space.exhausted:
            continue
        h = space.matrix
        values, vectors = np.linalg.eig(h[:-1])
        order = np.argsort(-np.abs(values), kind="stable")[:count]
        values, left = values[order].astype(complex), h[-1, -1] * np.abs(vectors[-1, order])
        left = left / max(float(np.abs(values).max(initial=0.0)), 1e-300)
        if space.exhausted or (values.size == count and left.max(initial=0.0) <= tolerance):
            break
    return Largest(values, left, space.size + 1)
