"""`speed_response`: force over small changes of the speed about its mean, at fixed approach, over frequency.

Large changes over time: `ehlcontact.transient.speed`; in elements: `reduced_models.elements.film_speed`.

With u_sum (1 + s), s = exp(i Omega T), the Reynolds equation linearised about the steady film is

    (J + i Omega B) dP = s d(rho H)/dX

on the nodes with P > 0, with the matrices of `impedance`. The force is ``3/(2 pi) iint dP``: at low frequency what
the steady force at this approach gains with ln(u_sum), at high frequency less and later, for the film has to cross
the contact first. Bodies under a constant load without inertia move apart by this force over the impedance.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks.frequency import dimensionless
from ehlcontact.checks.machine import require_threads
from ehlcontact.impedance import LARGEST_OMEGA, NEAR_ZERO
from ehlcontact.linearised_film import coarser_films, film_to_linearise, held
from ehlcontact.point import Point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import SpeedResponseResult
from ehlcontact.solver.error_estimate import wave_error
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.linearised_contact import TOLERANCE, LinearisedContact
from ehlcontact.solver.mesh import Solve
from ehlcontact.solver.mesh_choice import Purpose, wider_meshes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@one_blas_thread()
def speed_response(
    point: Point,
    *,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
    grid: Grid = AUTOMATIC,
    threads: int | None = None,
) -> SpeedResponseResult:
    """Linearise the converged steady contact and return its force over a small change of its speed.

    The inlet is flooded. Large changes: `simulate` with a `SpeedHistory`.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    Omega, omega, hz, rpm : float or sequence of float
        Frequencies, as in `impedance`.
    grid : Grid
        As in `impedance`.
    threads : int, optional
        As in `solve_steady`.

    Raises
    ------
    InputError, ConvergenceError
        As `impedance`.
    """
    started = time.perf_counter()
    moes, scales = require_solvable(point), scales_of(point)
    unit = None if scales is None else scales.time
    w = dimensionless(unit, Omega=Omega, omega=omega, hz=hz, rpm=rpm, most=LARGEST_OMEGA)
    require_grid(grid)
    threads = require_threads("threads", threads)
    meshes = wider_meshes(moes, Purpose.DAMPING, grid, solve=Solve.IMPEDANCE)
    steady = film_to_linearise(point, meshes, grid.deflection, threads)
    solved = held(steady, grid.deflection, threads)
    moving = np.maximum(w, NEAR_ZERO)
    contact = LinearisedContact(solved)
    Z = contact.respond(moving, TOLERANCE)[0]
    R, residual = force_of_speed(contact, moving)
    coarser = [force_of_speed(LinearisedContact(film), moving)[0] for film in coarser_films(solved)]
    return SpeedResponseResult(
        point=moes,
        scales=scales,
        domain=steady.domain,
        n=steady.n,
        Omega=w,
        in_phase=R.real.copy(),
        quadrature=R.imag.copy(),
        lift=np.abs(R / Z),
        amplitude_error=wave_error([R, *coarser], np.abs(R)),
        residual=residual,
        approach=steady.approach,
        h_central=steady.h_central,
        h_min=steady.h_min,
        seconds=time.perf_counter() - started,
    )


def force_of_speed(contact: LinearisedContact, omega: Array) -> tuple[Complex, Array]:
    """Force over relative change of speed, and the relative residual of its linear system, both (m,)."""
    level = contact.level
    carried = level.transport(level.fields.flow.mass, np.zeros_like(level.P)).ravel()
    return contact.force_of(omega, lambda system, m: carried)
