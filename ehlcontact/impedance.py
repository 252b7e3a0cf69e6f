"""`impedance`: stiffness and damping over frequency of the linearised steady contact.

A harmonic approach ``u + du exp(i Omega T)`` makes a pressure ``P + dP exp(i Omega T)`` with

    (J + i Omega B) dP = -(j + i Omega b) du      on the nodes with P > 0,

J and j being the derivatives of the steady Reynolds operator to P and u with full elasticity, B and b those of
the squeeze term. The impedance is ``Z(Omega) = 3/(2 pi) iint dP / du = K + i Omega C``: force over displacement,
the dynamic stiffness, not the mechanical impedance (force over velocity).

Both grids of half and a quarter of the intervals give an error estimate of K and C (`solver.error_grids`).
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks.frequency import by_name, dimensionless
from ehlcontact.checks.machine import require_threads
from ehlcontact.conditions import Conditions
from ehlcontact.heat import Heat
from ehlcontact.linearised_film import coarser_contacts, film_to_linearise, held, linearised
from ehlcontact.point import Point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import ImpedanceResult
from ehlcontact.results.impedance_result import SLOW
from ehlcontact.solver.error_estimate import response_error
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.linearised_contact import TOLERANCE, LinearisedContact
from ehlcontact.solver.mesh import Solve
from ehlcontact.solver.mesh_choice import Purpose, wider_meshes
from ehlcontact.supply import OilLayer

Array = NDArray[np.float64]

LARGEST_OMEGA = 200.0
NEAR_ZERO = 1e-4  # where C(0) is evaluated
SLOW_SHARE = 0.1  # of C at low frequency that is not in C at `SLOW`, from which it is slow oil: else 7 % at most


@by_name(1)
@one_blas_thread()
def impedance(
    point: Point,
    *,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    threads: int | None = None,
) -> ImpedanceResult:
    """Linearise the converged steady contact and return K(Omega) and C(Omega).

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    Omega, omega, hz, rpm : float or sequence of float
        Frequencies, in exactly one of these: dimensionless (time unit 2a/u_sum, from 0 to 200) at every point; at
        an `OperatingPoint` also in rad/s, Hz or rev/min.
    grid : Grid
        Intervals along X, by default as many as the inlet needs, 80 or more; computed region, by default that of
        `solve_steady` (C depends on it by about 1/extent^2); engine of the elastic deflection.
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact, as in `solve_steady`. The front of the full film moves with the
        approach: the oil that it takes up and leaves behind is part of the problem.
    thermal : Heat, or True for ``Heat()``, optional
        Let the film heat up, as in `solve_steady`; its temperatures follow the vibration as fast as oil and
        surfaces can (docs/heat.md).
    threads : int, optional
        As in `solve_steady`.

    Raises
    ------
    InputError
        Frequencies not given in exactly one way, in SI at a dimensionless point, not finite, negative or above
        Omega = 200; a grid that would not fit into memory; more threads than cores.
    ConvergenceError
        The steady state did not converge.
    """
    started = time.perf_counter()
    moes, scales = require_solvable(point), scales_of(point)
    time_unit = None if scales is None else scales.time
    w = dimensionless(time_unit, Omega=Omega, omega=omega, hz=hz, rpm=rpm, most=LARGEST_OMEGA)
    require_grid(grid)
    threads = require_threads("threads", threads)
    meshes = wider_meshes(moes, Purpose.DAMPING, grid, solve=Solve.IMPEDANCE)
    conditions = Conditions.of(supply=supply, thermal=thermal).at(point)
    steady = film_to_linearise(point, meshes, grid.deflection, threads, conditions)
    moving = np.maximum(w, NEAR_ZERO)
    solved = held(steady, grid.deflection, threads)
    contact = linearised(steady, solved)
    Z, residual = contact.respond(moving, TOLERANCE)
    coarser = [other.respond(moving, TOLERANCE)[0] for other in coarser_contacts(steady, solved)]
    bars = response_error(moving, [Z, *coarser])
    # A front of full film is slow by itself
    heated = conditions.heat is not None
    still = LinearisedContact(solved) if heated and supply is not None else None
    by_slow_oil = 0.0 if not heated else slow_part(contact, moving, Z.imag / moving, still)
    return ImpedanceResult(
        point=moes,
        scales=scales,
        domain=steady.domain,
        n=steady.n,
        Omega=w,
        stiffness=Z.real.copy(),
        damping=Z.imag / moving,
        stiffness_error=bars[0],
        damping_error=bars[1] + by_slow_oil,
        residual=residual,
        approach=steady.approach,
        h_central=steady.h_central,
        h_min=steady.h_min,
        moment=steady.moment,
        supply=supply,
        temperature=steady.temperature,
        seconds=time.perf_counter() - started,
    )


def slow_part(
    contact: LinearisedContact, omega: Array, damping: Array, still: LinearisedContact | None = None
) -> Array:
    """What oil that heats and cools slowly may add to C at low frequencies, (k,); 0 where it is not seen.

    It is what C changes below `SLOW`, less what it changes with temperatures that stand `still`, where given.

    Far ahead of the contact hot oil flows back beside colder oil that flows forward. Oil that warms flows back
    more and brings more heat: on few grids a line of nodes between both is near the end of its balance, and its
    temperature has a rate of some thousandths. Another n has none of it.
    """
    low, part = omega < SLOW, np.zeros_like(omega)
    if low.any():
        w = np.append(omega[low], SLOW)
        C = np.append(damping[low], contact.respond(w[-1:], TOLERANCE)[0].imag / SLOW)
        if still is not None:
            C -= still.respond(w, TOLERANCE)[0].imag / w
        part[low] = np.abs(C[:-1] - C[-1])
    return np.where(part > SLOW_SHARE * np.abs(damping), part, 0.0)
