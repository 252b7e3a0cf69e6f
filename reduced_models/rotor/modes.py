"""Damped vibrations of a rotor whose bearings remember: roots of T(s) q = 0 with T(s) exact at complex s.

    T(s) = s^2 M + s (C + omega G) + K + B^T Z(s) B

Each is found from the eigenvectors of the matrices that the bearings have at a frequency, first 0 (without their
damping, which may be large there), then its own, and closed by Newton's method on (q, s) together: what memory and
damping make of Z off the imaginary axis is in. What was found already is not taken again: the next best is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot, pi

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from ehlcontact.errors import ConvergenceError
from ehlcontact.summary import Summary

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]
Matrices = tuple[_Floats, _Floats, _Floats]

CLOSED = 1e-8  # relative change of an eigenvalue that ends Newton's method: what it leaves is of its square
MOST_ROUNDS = 50  # of it: five, in a rotor whose bearings damp it little
PROBE = 1e-5  # of |s|: difference quotients of Z, which only steer Newton's method
SAME = 1e-6  # relative difference of eigenvalues that may be one
NEW = 1e-3  # least singular value of the shapes that have one eigenvalue: below, one of them is not its own
CANDIDATES = 6  # that are tried for a mode
CREEPING = 0.01  # imaginary over real part, below which what dies away is no vibration: e^-600 in a period
NO_OSCILLATION = 1e-7  # of the fastest mode: below, a frequency is the rounding of none


@dataclass(frozen=True, eq=False)
class WhirlMode(Summary):
    """One damped vibration of a rotor.

    Attributes
    ----------
    eigenvalue : complex
        s of exp(s t) [1/s], its imaginary part > 0.
    shape : ndarray, shape (N,)
        Complex displacements, the largest 1.
    whirl : float
        1: nodes circle with the shaft (from x to y); -1: against it; 0: they move on straight lines. Mean over
        the nodes of bearings and unbalances, weighed by their squared displacements.
    """

    eigenvalue: complex
    shape: _Complex
    whirl: float

    def _summary_lines(self) -> list[str]:
        return [f"{self.hz:.5g} Hz, logarithmic decrement {self.decrement:.4g}, whirl {self.whirl:.3g}"]

    @property
    def omega(self) -> float:
        """Damped angular frequency [rad/s]."""
        return self.eigenvalue.imag

    @property
    def hz(self) -> float:
        """Damped frequency [Hz]."""
        return self.omega / (2.0 * pi)

    @property
    def decrement(self) -> float:
        """Logarithmic decrement, by which ln(amplitude) falls in a period; below 0 the vibration grows."""
        return -2.0 * pi * self.eigenvalue.real / self.omega

    @property
    def damping_ratio(self) -> float:
        """Share of critical damping."""
        return -self.eigenvalue.real / hypot(self.eigenvalue.real, self.eigenvalue.imag)


def eigenvectors(matrices: Matrices, impedance: _Complex, omega: float) -> tuple[_Complex, _Complex]:
    """Vibrations with K + i w C of the bearings frozen, slowest first: eigenvalues, vectors as columns."""
    M, C, K = matrices
    size = len(M)
    A = np.zeros((2 * size, 2 * size))
    A[:size, size:] = np.eye(size)
    A[size:, :size] = -np.linalg.solve(M, K + impedance.real)
    A[size:, size:] = -np.linalg.solve(M, C + impedance.imag / omega)
    values, vectors = linalg.eig(A)
    order = np.argsort(values.imag)
    order = order[values.imag[order] > NO_OSCILLATION * np.abs(values).max()]
    order = order[values.imag[order] > CREEPING * np.abs(values.real[order])]
    return values[order], vectors[:size, order]


def close(dynamic: Callable[[complex], _Complex], s: complex, q: _Complex) -> tuple[complex, _Complex]:
    """Newton's method for T(s) q = 0 from near a root; `dynamic` gives T."""
    size, fixed = len(q), q.conj() / np.vdot(q, q)
    system, residual = np.zeros((size + 1, size + 1), complex), np.zeros(size + 1, complex)
    for _ in range(MOST_ROUNDS):
        step = PROBE * abs(s)
        T = dynamic(s)
        slope = (dynamic(s + step) - dynamic(s - step)) / (2.0 * step)
        system[:size, :size], system[:size, size], system[size, :size] = T, slope @ q, fixed
        residual[:size] = T @ q
        change = np.linalg.solve(system, -residual)
        q, s = q + change[:size], s + complex(change[size])
        if abs(change[size]) <= CLOSED * abs(s):
            return s, q
    raise ConvergenceError(f"mode near {s.imag / (2.0 * pi):.4g} Hz not found", None)


def unlike(s: complex, q: _Complex, others: _Complex, shapes: _Complex) -> _Floats:
    """What the shape of a mode does not share with others (columns), and by how much frequencies differ in ln."""
    squares = np.vdot(q, q).real * (np.abs(shapes) ** 2).sum(axis=0)
    shared = np.abs(q.conj() @ shapes) ** 2 / squares
    return np.asarray(1.0 - shared + np.abs(np.log(others.imag / s.imag)))


def is_new(s: complex, q: _Complex, found: Sequence[tuple[complex, _Complex]]) -> bool:
    """Whether a root is none of those found: at another place, or a further direction at a multiple one."""
    beside = [shape / np.linalg.norm(shape) for other, shape in found if abs(other - s) <= SAME * abs(s)]
    shapes = np.array([*beside, q / np.linalg.norm(q)])
    return bool(np.linalg.svd(shapes, compute_uv=False)[-1] > NEW) if len(shapes) <= q.size else False


def shaped(s: complex, q: _Complex, pairs: list[tuple[int, int]]) -> WhirlMode:
    """A mode from its eigenvector; `pairs` are the degrees of freedom x, y of nodes."""
    q = q / q[np.argmax(np.abs(q))]
    x, y = (q[[pair[k] for pair in pairs]] for k in range(2))
    squares = float((np.abs(x) ** 2 + np.abs(y) ** 2).sum())
    return WhirlMode(s, q, -2.0 * float((x.conj() * y).imag.sum()) / squares if squares > 0.0 else 0.0)
