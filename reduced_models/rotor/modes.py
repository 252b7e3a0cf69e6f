"""Damped vibrations of a rotor on supports with memory: roots of T(s) q = 0.

    T(s) = s^2 M + s (C + omega G) + K + B^T Z(s) B

`LinearRotor.modes` finds them in one of two ways. On contacts whose elements have states the roots
are eigenvalues of one system of first order (`linear_system.eigenmodes`). Otherwise `eigenvectors` solves the
eigenproblem with K and C of the bearings frozen at frequency 0 (without their damping, which may be large there),
then at the frequency of the mode; `refine_root` applies Newton's method to T(s) q = 0 in (q, s), with the exact
Z(s) at complex s. Where Z is known on the imaginary axis alone, K + s C with K and C at the frequency of the
mode stands for Z(s): exact for small damping, and to first order in the damping otherwise. A root that was found
already is not taken again: the next best is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot, inf, pi

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from ehlcontact.summary import Summary
from reduced_models.rotor.nodes import LENGTHS, ByNode

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]
Matrices = tuple[_Floats, _Floats, _Floats]

CONVERGED = 1e-8  # relative change of an eigenvalue that ends Newton's method: what it leaves is of its square
# Such a change where Z is known on the imaginary axis alone: its change with the frequency is no part of the
# slopes, so what is left falls by a factor only
CONVERGED_BY_STEPS = 1e-12
MOST_ROUNDS = 50  # of it: five, in a rotor whose bearings damp it little
PROBE = 1e-5  # of |s|: difference quotients of Z, which only steer Newton's method
SAME = 1e-6  # relative difference of eigenvalues that may be one
NEW = 1e-3  # least singular value of the shapes that have one eigenvalue: below, one of them is not its own
CANDIDATES = 6  # that are tried for a mode
ALONG = 0.5  # share of the motion of a mode from which it is along the shaft
OVERDAMPED = 0.01  # imaginary over real part, below which what dies away is no vibration: e^-600 in a period
# Least damping ratio of a mode that films damp, and least share of the strain energy of a mode of the supports
UNDAMPED, OF_SUPPORTS = 1e-5, 0.5
NO_OSCILLATION = 1e-7  # of the fastest mode: below, a frequency is the rounding of none


@dataclass(frozen=True, eq=False)
class RotorMode(Summary, ByNode):
    """One damped vibration of a rotor.

    Attributes
    ----------
    eigenvalue : complex
        s of exp(s t) [1/s], its imaginary part > 0.
    shape : ndarray, shape (N,)
        Complex displacements, the largest 1.
    whirl : float
        1: nodes circle with the shaft (from x to y); -1: against it; 0: they move on straight lines. Mean over
        the nodes of supports and unbalances, weighed by their squared displacements.
    support_share : float
        Of the strain energy, in the supports that are not linear.
    names : tuple of str
        Names of degrees of freedom, as "disc x".
    places : ndarray, shape (len(names),)
        Those degrees of freedom.
    housing_share : float
        Of the strain energy, in the springs between housings and the ground, those of dampers among them.
    """

    eigenvalue: complex
    shape: _Complex
    whirl: float
    support_share: float
    names: tuple[str, ...]
    places: NDArray[np.int64]
    housing_share: float = 0.0

    def _summary_lines(self) -> list[str]:
        return [
            f"{self.hz:.5g} Hz, logarithmic decrement {self.decrement:.4g}, whirl {self.whirl:.3g}",
            f"{100.0 * self.support_share:.3g} % of the strain energy in the supports"
            + (
                f", {100.0 * self.axial_share:.3g} % of the motion along the shaft"
                if "shaft z" in self.names
                else ""
            ),
            *filter(None, [self.reservation]),
        ]

    @property
    def reservation(self) -> str:
        """Why a vibration of the supports is hardly damped, in words; empty where it is damped, or grows."""
        if self.support_share < OF_SUPPORTS or not 0.0 <= self.damping_ratio < UNDAMPED:
            return ""
        return (
            f"damping ratio {self.damping_ratio:.1g}, for films do not damp motion along the surfaces of their"
            " contacts and dry contacts damp nothing; loss_factor of the bearing is the damping of rings and fits"
        )

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

    @property
    def vertical_share(self) -> float:
        """Share of the squared displacements of the named nodes across the shaft that is along y; or 0."""
        found = {at[direction]: direction for at in self.nodes.values() for direction in "xy" if direction in at}
        squares = {place: float(np.abs(self.shape[place]) ** 2) for place in found}
        up = sum(square for place, square in squares.items() if found[place] == "y")
        whole = sum(squares.values())
        return up / whole if whole > 0.0 else 0.0

    @property
    def axial_share(self) -> float:
        """Share of the squared displacements of the named nodes that is along the shaft."""
        squares = {
            at[name]: (name, float(np.abs(self.shape[at[name]]) ** 2))
            for at in self.nodes.values()
            for name in LENGTHS
            if name in at
        }
        whole = sum(square for _, square in squares.values())
        return sum(square for name, square in squares.values() if name == "z") / whole if whole > 0.0 else 0.0

    def to_dict(self) -> dict[str, float | str]:
        """Frequency, decrement, shares and reservation, ready for JSON."""
        names = "hz", "decrement", "vertical_share", "support_share", "housing_share", "reservation"
        return {name: getattr(self, name) for name in names}

    def node(self, name: str) -> _Complex:
        """Complex displacements x, y of a node, shape (2,)."""
        return self._node(self.shape, name)

    @property
    def disc(self) -> _Complex:
        """Complex displacements x, y of the node "disc", shape (2,)."""
        return self.node("disc")

    @property
    def journal(self) -> _Complex:
        """Complex displacements x, y of the node "journal", shape (2,)."""
        return self.node("journal")


def eigenvectors(matrices: Matrices, impedance: _Complex, omega: float) -> tuple[_Complex, _Complex]:
    """Vibrations with K + i w C of the bearings frozen, slowest first: eigenvalues, vectors as columns."""
    M, C, K = matrices
    size = len(M)
    A = np.zeros((2 * size, 2 * size))
    A[:size, size:] = np.eye(size)
    A[size:, :size] = -np.linalg.solve(M, K + impedance.real)
    A[size:, size:] = -np.linalg.solve(M, C + impedance.imag / omega)
    values, vectors = scipy.linalg.eig(A)
    order = np.argsort(values.imag)
    order = order[values.imag[order] > NO_OSCILLATION * np.abs(values).max()]
    order = order[values.imag[order] > OVERDAMPED * np.abs(values.real[order])]
    return values[order], vectors[:size, order]


def refine_root(
    dynamic: Callable[[_Complex], _Complex], s: complex, q: _Complex, tolerance: float = CONVERGED
) -> tuple[complex, _Complex]:
    """Newton's method for T(s) q = 0 from near a root; `dynamic` gives T at several s, shape (k,)."""
    size, fixed = len(q), q.conj() / np.vdot(q, q)
    system, residual = np.zeros((size + 1, size + 1), complex), np.zeros(size + 1, complex)
    moved = inf
    for _ in range(MOST_ROUNDS):
        step = PROBE * abs(s)
        T, before, after = dynamic(np.array([s, s - step, s + step]))
        slope = (after - before) / (2.0 * step)
        system[:size, :size], system[:size, size], system[size, :size] = T, slope @ q, fixed
        residual[:size] = T @ q
        change = np.linalg.solve(system, -residual)
        q, s = q + change[:size], s + complex(change[size])
        moved, last = abs(change[size]), moved
        by_rounding = 0.5 * last <= moved <= CONVERGED * abs(s)
        if moved <= tolerance * abs(s) or by_rounding:
            return s, q
    raise ConvergenceError(f"mode near {s.imag / (2.0 * pi):.4g} Hz not found", None)


def mode_distance(s: complex, q: _Complex, others: _Complex, shapes: _Complex) -> _Floats:
    """1 - MAC of the shape of a mode with others (columns), plus the difference of ln(frequency).

    MAC: modal assurance criterion, |q^H q_k|^2 over the product of the squared norms.
    """
    squares = np.vdot(q, q).real * (np.abs(shapes) ** 2).sum(axis=0)
    shared = np.abs(q.conj() @ shapes) ** 2 / squares
    return np.asarray(1.0 - shared + np.abs(np.log(others.imag / s.imag)))


def is_new(s: complex, q: _Complex, roots: Sequence[tuple[complex, _Complex]]) -> bool:
    """Whether a root is none of those found: at another place, or a further direction at a multiple one."""
    beside = [shape / np.linalg.norm(shape) for other, shape in roots if abs(other - s) <= SAME * abs(s)]
    shapes = np.array([*beside, q / np.linalg.norm(q)])
    return bool(np.linalg.svd(shapes, compute_uv=False)[-1] > NEW) if len(shapes) <= q.size else False


def whirl_of(q: _Complex, pairs: Sequence[tuple[int | None, ...]]) -> float:
    """Sense of rotation of a shape, from -1 to 1; `pairs` are the degrees of freedom x, y of nodes."""
    moving = np.append(q, 0.0)  # what does not move that way
    places = np.array([[-1 if place is None else place for place in pair] for pair in pairs])
    x, y = moving[places[:, 0]], moving[places[:, 1]]
    squares = float((np.abs(x) ** 2 + np.abs(y) ** 2).sum())
    return -2.0 * float((x.conj() * y).imag.sum()) / squares if squares > 0.0 else 0.0
