"""Frequency response of the contact: the steady state linearised, one small model for all frequencies.

A harmonic approach ``u + du exp(i Omega T)`` makes a pressure ``P + dP exp(i Omega T)`` with

    (J + i Omega B) dP = -(j + i Omega b) du      on the nodes with P > 0,

J and j being the derivatives of the steady Reynolds operator to P and u with full elasticity, B and b those of
the squeeze term. The impedance is ``Z(Omega) = 3/(2 pi) iint dP / du = K + i Omega C``; `linearised_contact`
solves for it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import Point, moes_point, scales_of
from ehlcontact.results import ImpedanceResult, SteadyResult
from ehlcontact.solver.domain import Domain, check_domain
from ehlcontact.solver.linearised_contact import LinearisedContact
from ehlcontact.solver.resolution import automatic_mesh, moving_intervals
from ehlcontact.status import Status
from ehlcontact.steady import ROOM, solve_steady

Array = NDArray[np.float64]

TOLERANCE = 1e-5  # of the linear residuals; C is then within 3e-4 of the exact solve up to Omega = 30
LARGEST_OMEGA = 200.0
FEWEST_INTERVALS = 80
NEAR_ZERO = 1e-4  # where C(0) is evaluated


def impedance(
    point: Point, omegas: Sequence[float] | Array, *, n: int | None = None, domain: Domain | None = None
) -> ImpedanceResult:
    """Linearise the converged steady contact and return K(Omega) and C(Omega).

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    omegas : sequence of float
        Dimensionless angular frequencies (time unit 2a/u_sum), from 0 to 200.
    n : int, optional
        Intervals along X, a multiple of 16; by default as many as the inlet needs, 80 or more.
    domain : Domain, optional
        Computed region, by default that of `solve_steady`. C depends on it by about 1/extent^2.

    Raises
    ------
    InputError
        `omegas` empty, not finite, negative or above 200; n not a multiple of 16.
    ConvergenceError
        The steady state did not converge.
    """
    started = time.perf_counter()
    omega = _check_frequencies(omegas)
    moes = moes_point(point)
    region = automatic_mesh(moes)[1] if domain is None else check_domain(domain, moes)
    with threadpool_limits(1, user_api="blas"):  # its threads wait for each other on matrices as small as these
        steady = _steady(point, n, region, free=domain is None)
        contact = LinearisedContact(moes, steady.domain, steady.n, steady.P, steady.approach)
        Z, residual = contact.respond(np.maximum(omega, NEAR_ZERO), TOLERANCE)
    return ImpedanceResult(
        point=moes,
        scales=scales_of(point),
        domain=steady.domain,
        n=steady.n,
        omega=omega,
        stiffness=Z.real.copy(),
        damping=Z.imag / np.maximum(omega, NEAR_ZERO),
        residual=residual,
        approach=steady.approach,
        seconds=time.perf_counter() - started,
    )


def _steady(point: Point, n: int | None, domain: Domain, free: bool) -> SteadyResult:
    """The film to linearise; if `free`, on a wider domain where light load needs it."""
    moes = moes_point(point)
    intervals = moving_intervals(n, moes, domain, FEWEST_INTERVALS)
    steady = solve_steady(point, n=intervals, domain=domain, throw=not free)
    if free and steady.status is Status.OUT_OF_DOMAIN:
        return _steady(point, n, domain.scaled(ROOM), free=False)
    if steady.status is Status.INTERRUPTED:
        raise KeyboardInterrupt  # there is nothing to keep: no frequency has been looked at
    if not steady.status.ok:
        raise ConvergenceError(f"steady solve {steady.status}: {steady.status.advice}", steady)
    return steady


def _check_frequencies(omegas: Sequence[float] | Array) -> Array:
    try:
        omega = np.atleast_1d(np.array(omegas, dtype=float)).copy()
    except (TypeError, ValueError):
        raise InputError("omegas", omegas, "numbers") from None
    if omega.ndim != 1 or omega.size == 0:
        raise InputError("omegas", f"of shape {np.shape(omega)}", "a flat list of at least one frequency")
    bad = omega[~(np.isfinite(omega) & (omega >= 0.0) & (omega <= LARGEST_OMEGA))]
    if bad.size:
        raise InputError("omegas", float(bad[0]), f"finite, >= 0 and <= {LARGEST_OMEGA:g}")
    return omega
