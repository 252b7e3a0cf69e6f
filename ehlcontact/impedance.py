"""Frequency response of the contact: the steady state linearised, one small model for all frequencies.

A harmonic approach ``u + du exp(i Omega T)`` makes a pressure ``P + dP exp(i Omega T)`` with

    (J + i Omega B) dP = -(j + i Omega b) du      on the nodes with P > 0,

J and j being the derivatives of the steady Reynolds operator to P and u with full elasticity, B and b those of
the squeeze term. The impedance is ``Z(Omega) = 3/(2 pi) iint dP / du = K + i Omega C``. The system is solved at
a few real shifts only; their solutions and those of the chained systems span a rational Krylov space, in which
every frequency is a small least-squares problem whose residual is the error measure.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from ehlcontact._kernels.linearise import dense_jacobian, linearise
from ehlcontact.domain import Domain, check_intervals
from ehlcontact.errors import InputError
from ehlcontact.grid import Level
from ehlcontact.multigrid import Multigrid
from ehlcontact.scaling import MoesPoint, Point, Scales, moes_point, scales_of
from ehlcontact.steady import solve_steady
from ehlcontact.version import __version__

Array = NDArray[np.float64]

SHIFTS = (0.0, 4.0, 20.0)  # real, in units of Omega; J + s B is an implicit step of length 1/s
CHAIN = 12  # vectors from each shift; C is then within 1e-3 of the exact solve up to Omega = 30
LARGEST_OMEGA = 200.0
NEAR_ZERO = 1e-4  # where C(0) is evaluated


@dataclass(frozen=True, slots=True, eq=False)
class ImpedanceResult:
    """Stiffness and damping of a contact over frequency; dimensionless, SI scales beside."""

    point: MoesPoint
    scales: Scales | None
    domain: Domain
    n: int
    omega: Array  # (k,)
    stiffness: Array  # (k,) K(Omega) = Re Z
    damping: Array  # (k,) C(Omega) = Im Z/Omega, its limit at Omega = 0
    residual: Array  # (k,) relative residual of the linear system in the reduced space
    approach: float  # of the steady state
    seconds: float
    version: str

    def __post_init__(self) -> None:
        for name in ("omega", "stiffness", "damping", "residual"):
            getattr(self, name).setflags(write=False)

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z(Omega) = K + i Omega C."""
        return self.stiffness + 1j * self.omega * self.damping

    def to_control(self) -> Any:
        """``control.FrequencyResponseData`` from approach to force."""
        import control

        return control.frd(self.impedance, self.omega, inputs="u", outputs="F", name="contact")

    def summary(self) -> dict[str, Any]:
        """The JSON form of the command line."""
        return {
            "omega": self.omega.tolist(),
            "stiffness": self.stiffness.tolist(),
            "damping": self.damping.tolist(),
            "approach": self.approach,
            "residual": self.residual.tolist(),
            "seconds": self.seconds,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "point": self.point.to_dict(),
            "version": self.version,
        }


def impedance(
    point: Point, omegas: Sequence[float] | Array, *, n: int = 64, domain: Domain | None = None
) -> ImpedanceResult:
    """Linearise the converged steady contact and return K(Omega) and C(Omega).

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    omegas : sequence of float
        Dimensionless angular frequencies (time unit 2a/u_sum), 0 allowed.
    n : int
        Intervals along X, a multiple of 16; the linear system is dense, so cost grows like n^6.
    domain : Domain, optional
        Computed region. C depends on it by about 1/extent^2.

    Raises
    ------
    InputError
        `omegas` empty, not finite, negative or above 200; n above 128.
    ConvergenceError
        The steady state did not converge.
    """
    started = time.perf_counter()
    omega = _check_frequencies(omegas)
    if check_intervals(n) > 128:
        raise InputError("n", n, "at most 128 (dense linear system)")
    steady = solve_steady(point, n=n, domain=domain)
    system = LinearisedContact.at(moes_point(point), steady.domain, n, steady.P, steady.approach)
    basis = system.basis()
    Z, residual = system.respond(basis, np.maximum(omega, NEAR_ZERO))
    return ImpedanceResult(
        point=moes_point(point),
        scales=scales_of(point),
        domain=steady.domain,
        n=n,
        omega=omega,
        stiffness=Z.real.copy(),
        damping=Z.imag / np.maximum(omega, NEAR_ZERO),
        residual=residual,
        approach=steady.approach,
        seconds=time.perf_counter() - started,
        version=__version__,
    )


@dataclass(frozen=True, slots=True, eq=False)
class LinearisedContact:
    """Linearised contact ``(J + s B) dP = -(j + s b) du``, force ``weights @ dP``."""

    J: Array  # (m, m)
    B: Array  # (m, m)
    j: Array  # (m,)
    b: Array  # (m,)
    weights: Array  # (m,)

    @classmethod
    def at(cls, point: MoesPoint, domain: Domain, n: int, P: Array, u: float) -> LinearisedContact:
        """Linearise at pressure `P`, shape (nx + 1, ny + 1), and approach `u`."""
        level: Level = Multigrid(point, domain, n).finest
        level.P[...] = P.T
        level.update_film(u)
        level.update_residual()
        free = np.flatnonzero(level.P > 0.0)
        steady = _jacobian(level, free, 0.0)
        squeeze = _jacobian(level, free, 1.0)
        squeeze -= steady
        m = free.size
        return cls(
            steady[:, :m], squeeze[:, :m], steady[:, m], squeeze[:, m], level.force_weights.ravel()[free].copy()
        )

    def basis(self) -> Array:
        """Orthonormal basis (m, k) of the rational Krylov space."""
        columns: list[Array] = []
        for s in SHIFTS:
            factors = linalg.lu_factor(self.J + s * self.B, overwrite_a=True, check_finite=False)
            x = linalg.lu_solve(factors, -(self.j + s * self.b), check_finite=False)
            columns.append(x)
            rhs = -(self.B @ x + self.b)  # first derivative to s, then the chain of B alone
            for _ in range(CHAIN - 1):
                x = linalg.lu_solve(factors, rhs, check_finite=False)
                columns.append(x / linalg.norm(x))
                rhs = -(self.B @ columns[-1])
        return linalg.qr(np.array(columns).T, mode="economic", check_finite=False)[0]

    def respond(self, basis: Array, omega: Array) -> tuple[NDArray[np.complex128], Array]:
        """Impedance at each frequency, and the relative residual of the least-squares solution."""
        JV, BV = self.J @ basis, self.B @ basis
        row_scale = 1.0 / np.abs(np.diag(self.J))
        Z = np.empty(omega.size, dtype=complex)
        residual = np.empty(omega.size)
        for k, w in enumerate(omega):
            matrix = (JV + 1j * w * BV) * row_scale[:, None]
            rhs = -(self.j + 1j * w * self.b) * row_scale
            y = linalg.lstsq(matrix, rhs, check_finite=False, lapack_driver="gelsy")[0]
            Z[k] = self.weights @ (basis @ y)
            residual[k] = linalg.norm(matrix @ y - rhs) / linalg.norm(rhs)
        return Z, residual


def _jacobian(level: Level, free: NDArray[np.intp], c_t: float) -> Array:
    f = level.fields
    linearise(f.P, f.H, f.eps, level.law, level.mesh, c_t, 1.0, f.p_coef, f.h_coef)
    J = np.empty((free.size, free.size + 1))
    number = np.empty(f.P.size, dtype=np.int64)
    dense_jacobian(free, f.p_coef, f.h_coef, level.deflection.kernel, number, J)
    return J


def _check_frequencies(omegas: Sequence[float] | Array) -> Array:
    try:
        omega = np.atleast_1d(np.array(omegas, dtype=float)).copy()
    except (TypeError, ValueError):
        raise InputError("omegas", omegas, "numbers") from None
    if omega.ndim != 1 or omega.size == 0:
        raise InputError("omegas", list(np.shape(omega)), "a list of at least one frequency")
    bad = omega[~(np.isfinite(omega) & (omega >= 0.0) & (omega <= LARGEST_OMEGA))]
    if bad.size:
        raise InputError("omegas", float(bad[0]), f"finite, >= 0 and <= {LARGEST_OMEGA:g}")
    return omega
