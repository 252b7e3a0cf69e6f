"""The linearised contact at all frequencies: a few of them solved, the others from the space these span.

    (J + i Omega B) dP = -(j + i Omega b) du      on the nodes with P > 0.

In the space of the real and imaginary parts of solutions at some frequencies, every other frequency is a small
least-squares problem whose residual is the error measure. The frequency with the largest is solved next.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from ehlcontact.point import MoesPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Array
from ehlcontact.solver.linear import LinearFilm, NearCorrection, Preconditioner, solve_linear
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid

Complex = NDArray[np.complex128]

PRESCRIBED = Balance.of_approach(0.0)
KEEP_FACTORS = 5.0  # change of Omega for which the factors of short waves serve
SOLVE_SHARE = 0.3  # of the tolerance, for the solves themselves
SMALLEST_NEW_PART = 1e-10  # of a vector, outside the space so far


class LinearisedContact:
    """Derivatives of the contact at pressure `P` and approach `u`.

    Vectors hold the m nodes with P > 0. Sparse factors, for the short waves, serve a band of frequencies; dense
    ones, for the long waves, are made at each.

    Parameters
    ----------
    point : MoesPoint
    domain : Domain
    n : int
        Intervals along X.
    P : array (nx + 1, ny + 1)
    u : float
    """

    def __init__(self, point: MoesPoint, domain: Domain, n: int, P: Array, u: float) -> None:
        self._multigrid = Multigrid(point, Mesh(n, domain))
        level = self._level = self._multigrid.finest
        level.P[...] = P.T
        level.update(u)
        self._free = level.P > 0.0
        self.nodes = np.flatnonzero(self._free)
        self.weights = level.force_weights.ravel()[self.nodes]
        self._steady, self._unit = (LinearFilm(level, self._free, PRESCRIBED, c_t) for c_t in (0.0, 1.0))
        self.j = self._steady.by_approach[self.nodes]
        self.b = self._unit.by_approach[self.nodes] - self.j
        self._row_scale = 1.0 / np.abs(self._steady.diagonal()[self.nodes])
        self._near: list[tuple[float, NearCorrection]] = []

    def products(self, dP: Array) -> tuple[Array, Array]:
        """J dP and B dP."""
        x = np.zeros(self._free.size)
        x[self.nodes] = dP
        film = self._steady.deflect(x)
        steady, unit = (system.at_nodes(x, film)[self.nodes] for system in (self._steady, self._unit))
        return steady, unit - steady

    def solve(self, omega: float, start: Complex, tolerance: float) -> Complex:
        """Complex solution dP for du = 1 at one frequency, improving on `start`, both (m,)."""
        system = LinearFilm(self._level, self._free, PRESCRIBED, 1j * omega)
        reach = [abs(omega - w) for w, _ in self._near]
        if not reach or min(reach) > KEEP_FACTORS:
            self._near.append((omega, NearCorrection(self._level, system)))
            reach.append(0.0)
        near = self._near[int(np.argmin(reach))][1]
        preconditioner = Preconditioner(self._multigrid.levels, system, near)
        x = np.zeros(self._free.size + 1, dtype=complex)
        x[self.nodes], x[-1] = start, 1.0
        b = -system(x)
        b[-1] = 0.0
        drop = tolerance * linalg.norm(self.j + 1j * omega * self.b) / linalg.norm(b)
        return (x + solve_linear(system, preconditioner, b, drop).x)[self.nodes]

    def respond(self, omega: Array, tolerance: float) -> tuple[Complex, Array]:
        """Impedance at each frequency > 0, and the relative residual of its linear system, both (k,).

        `tolerance` is for the residuals, their imaginary part counted relative to Omega below Omega = 1. Where
        a solve fails to reach it, the residual returned tells.
        """
        basis: list[Array] = []
        products: list[Array] = [self.j, self.b]
        done: set[int] = set()
        while True:
            space = np.array(basis).reshape(len(basis), self.nodes.size)
            # Every residual is a combination of these columns: their triangular factor stands for them.
            columns = np.array(products).T * self._row_scale[:, None]
            R = linalg.qr(columns, mode="r", overwrite_a=True, check_finite=False)[0][: columns.shape[1]]
            solutions = [_least_squares(R, w) for w in omega]
            error = np.array([e for _, _, e in solutions])
            error[list(done)] = 0.0
            worst = int(np.argmax(error))
            if error[worst] < tolerance:
                Z = np.array([(space @ self.weights) @ y for y, _, _ in solutions])
                return Z, np.array([r for _, r, _ in solutions])
            done.add(worst)
            w = float(omega[worst])
            dP = self.solve(w, solutions[worst][0] @ space, SOLVE_SHARE * tolerance * min(1.0, w))
            for part in (dP.real, dP.imag):
                x = part / linalg.norm(part)
                for _ in range(2):  # the second time for rounding
                    x = x - (space @ x) @ space
                size = linalg.norm(x)
                if size > SMALLEST_NEW_PART:
                    basis.append(x / size)
                    space = np.array(basis)
                    products += self.products(basis[-1])


def _least_squares(R: Array, w: float) -> tuple[Complex, float, float]:
    """Coefficients of the best solution at one frequency, its relative residual, and that weighted for C.

    The weight makes the imaginary part count relative to Omega: K comes from the real part, Omega C from the
    other.
    """
    matrix, rhs = R[:, 2::2] + 1j * w * R[:, 3::2], -(R[:, 0] + 1j * w * R[:, 1])
    y = np.zeros(0, dtype=complex)
    if matrix.shape[1]:
        y = linalg.lstsq(matrix, rhs, check_finite=False, lapack_driver="gelsy")[0]
    r = rhs - matrix @ y
    size = linalg.norm(rhs)
    weighted = np.hypot(linalg.norm(r.real), linalg.norm(r.imag) / min(1.0, w))
    return y, float(linalg.norm(r) / size), float(weighted / size)
