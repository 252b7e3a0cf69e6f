"""`excitation`: force of a wavy surface that travels through the contact, at fixed approach, over frequency.

Waves of height ``exp(i (Omega T - k X))``, positive out of the surface, stand on a surface that moves with
``dX/dT = speed = Omega/k``. They take ``g = -exp(-i k X)`` off the gap, and make a pressure dP with

    (J + i Omega B) dP = -(Jg + i Omega Bg + rho (D + i k)) g

on the nodes with P > 0: Jg and Bg are the derivatives of the steady Reynolds operator and of the squeeze term to
the film, of which J and B of `impedance` are made. The last term puts the exact change of g along X in place of
the differenced one, D g, as runs with a surface do (`transient.transient_film`). The force ``3/(2 pi) iint dP`` is
G(Omega), per height at X = 0. Waves much longer than the contact are an approach: G tends to Z there. ``|G/Z|``
is the contact filter; that of a dry contact is ``|sin(k)/k|``, the mean of the wave weighted by the pressure of a
small approach.
"""

from __future__ import annotations

import time
from math import pi
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_numbers, require_positive
from ehlcontact.checks.frequency import Frequency, by_name, dimensionless, is_given
from ehlcontact.checks.machine import require_threads
from ehlcontact.errors import InputError
from ehlcontact.impedance import LARGEST_OMEGA, NEAR_ZERO
from ehlcontact.linearised_film import coarser_films, film_to_linearise, held
from ehlcontact.point import Point, Scales, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import ExcitationResult
from ehlcontact.solver.error_estimate import wave_error
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.level import Level
from ehlcontact.solver.linear import LinearFilm
from ehlcontact.solver.linearised_contact import TOLERANCE, LinearisedContact
from ehlcontact.solver.mesh import Mesh, Solve
from ehlcontact.solver.mesh_choice import Purpose, grid_for_waves, wider_meshes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

FEWEST_NODES = 4.0  # of the mesh to a wave, as of `Roughness`: with fewer the film does not follow it


@by_name(1)
@one_blas_thread()
def excitation(
    point: Point,
    *,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
    wavelength: ArrayLike | None = None,
    speed: float = 1.0,
    grid: Grid = AUTOMATIC,
    threads: int | None = None,
) -> ExcitationResult:
    """Linearise the converged steady contact and return the force of waves on one surface, at fixed approach.

    The waves are straight, with crests across rolling, and stand on one of both surfaces; those of both add. The
    inlet is flooded.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    Omega, omega, hz, rpm : float or sequence of float
        Frequencies at which waves pass, as in `impedance`; or, in their place,
    wavelength : float or sequence of float
        Length of the waves along rolling, in semi-axes a at every point, as of `Waviness`: ``2 pi speed/Omega``.
    speed : float
        dX/dT of the surface with the waves: 1 in pure rolling, ``2 u_i/u_sum`` in general.
    grid : Grid
        As in `impedance`; by default with 16 nodes or more to the shortest wave too, as far as is affordable.
    threads : int, optional
        As in `solve_steady`.

    Raises
    ------
    InputError
        Not exactly one of frequencies and wavelengths; what `impedance` refuses, and Omega = 0; a speed that is
        not positive; waves of fewer than 4 nodes, with the shortest that is resolved.
    ConvergenceError
        The steady state did not converge.
    """
    started = time.perf_counter()
    moes, scales = require_solvable(point), scales_of(point)
    speed = require_positive("speed", speed)
    w = _frequencies(scales, wavelength, speed, Omega=Omega, omega=omega, hz=hz, rpm=rpm)
    require_grid(grid)
    threads = require_threads("threads", threads)
    moving = np.maximum(w, NEAR_ZERO)
    k = moving / speed
    fine = grid_for_waves(moes, grid, 2.0 * pi / k.max())
    wider = wider_meshes(moes, Purpose.DAMPING, fine, solve=Solve.IMPEDANCE)
    meshes = (_resolving(mesh, k.max(), speed, scales) for mesh in wider)
    steady = film_to_linearise(point, meshes, grid.deflection, threads)
    solved = held(steady, grid.deflection, threads)
    contact = LinearisedContact(solved)
    Z = contact.respond(moving, TOLERANCE)[0]
    G, residual = force_of_waves(contact, moving, k)
    coarser = [force_of_waves(LinearisedContact(film), moving, k)[0] for film in coarser_films(solved)]
    return ExcitationResult(
        point=moes,
        scales=scales,
        domain=steady.domain,
        n=steady.n,
        Omega=w,
        wavelength=2.0 * pi * speed / w,
        in_phase=G.real.copy(),
        quadrature=G.imag.copy(),
        contact_filter=np.abs(G / Z),
        amplitude_error=wave_error([G, *coarser], np.abs(Z)),
        residual=residual,
        approach=steady.approach,
        h_central=steady.h_central,
        h_min=steady.h_min,
        speed=speed,
        seconds=time.perf_counter() - started,
    )


def force_of_waves(contact: LinearisedContact, omega: Array, k: Array) -> tuple[Complex, Array]:
    """Force per height of waves of wave numbers k, and the relative residual of its linear system, both (m,)."""
    return contact.force_of(omega, lambda system, m: -_flow_by_waves(contact.level, system, float(k[m])))


def _flow_by_waves(level: Level, system: LinearFilm, k: float) -> Complex:
    """Change of the Reynolds operator at all nodes, flat, by waves of unit height at fixed pressure."""
    film = np.broadcast_to(-np.exp(-1j * k * level.X), level.P.shape)
    still = np.zeros_like(level.P)
    differenced = level.transport(film.real.copy(), still) + 1j * level.transport(film.imag.copy(), still)
    exactly = level.fields.flow.rho * (differenced + 1j * k * film)
    return np.asarray(system.by_film @ film.ravel() + exactly.ravel())


def _frequencies(
    scales: Scales | None, wavelength: ArrayLike | None, speed: float, **given: Unpack[Frequency]
) -> Array:
    """Omega of the frequencies or wavelengths given, shape (k,)."""
    if wavelength is None:
        w = dimensionless(None if scales is None else scales.time, **given, most=LARGEST_OMEGA)
        if not w.all():
            raise InputError(next(name for name, value in given.items() if value is not None), 0.0, "> 0")
        return w
    if is_given(**given):
        raise InputError("wavelength", wavelength, "left out where a frequency is given, which it follows from")
    found = np.atleast_1d(as_numbers("wavelength", wavelength))
    if found.ndim != 1 or found.size == 0:
        raise InputError("wavelength", f"of shape {found.shape}", "a number, or a flat list of at least one")
    least = 2.0 * pi * speed / LARGEST_OMEGA
    bad = found[~((found >= least) & np.isfinite(found))]
    if bad.size:
        allowed = f"finite and at least {least:.3g} semi-axes a, which is Omega = {LARGEST_OMEGA:g}"
        raise InputError("wavelength", float(bad[0]), allowed)
    return 2.0 * pi * speed / found


def _resolving(mesh: Mesh, k: float, speed: float, scales: Scales | None) -> Mesh:
    """`mesh`, or `InputError` where waves of wave number k have too few nodes."""
    x_in, x_out, _ = mesh.domain.as_tuple()
    least = FEWEST_NODES * (x_out - x_in) / mesh.n
    if 2.0 * pi / k < least:
        most = 2.0 * pi * speed / least
        at = f"Omega up to {most:.3g}" if scales is None else f"up to {most / scales.time / (2.0 * pi):.3g} Hz"
        allowed = f"at least {least:.3g} semi-axes a ({at}), {FEWEST_NODES:g} nodes of n = {mesh.n}: raise n"
        raise InputError("wavelength", float(f"{2.0 * pi / k:.3g}"), allowed)
    return mesh
