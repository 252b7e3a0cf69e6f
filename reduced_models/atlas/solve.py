"""One point of the atlas solved: steady film and impedance, on the mesh its film needs."""

from __future__ import annotations

import time
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Mesh, MoesPoint, Purpose, __version__, mesh_for, solve_steady
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.impedance import NEAR_ZERO, TOLERANCE
from ehlcontact.solver.linearised_contact import LinearisedContact
from ehlcontact.status import Status

_Floats = NDArray[np.float64]

OMEGAS = (
    0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 2.5, np.pi, 4.0, 5.0, 2.0 * np.pi, 8.0, 10.0,
    4.0 * np.pi, 16.0, 20.0, 8.0 * np.pi, 32.0, 45.0, 60.0,
)  # fmt: skip


def solve_point(point: MoesPoint) -> dict[str, Any]:
    """Everything that the atlas keeps of a point, ready for JSON; ``status`` says whether it converged."""
    started = time.perf_counter()
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa, "alpha": point.alpha}
    entry |= {"eta0": point.eta0, "version": __version__, "status": str(Status.UNRESOLVED)}
    try:
        mesh, of_film, near = (mesh_for(point, p) for p in (Purpose.TABLE, Purpose.TABLE_FILM, Purpose.TABLE_NEAR))
    except InputError:  # too thin a film for any mesh that is affordable
        return entry
    try:
        entry |= respond(point, mesh)
        if of_film != mesh:
            entry["film"] = film(point, of_film)[0]
        entry["status"] = str(Status.CONVERGED)
    except ConvergenceError as error:
        entry["status"] = "unknown" if error.result is None else str(error.result.status)
    if near != mesh:
        with suppress(ConvergenceError):
            entry["close"] = respond(point, near)
    return entry | {"seconds": time.perf_counter() - started}


def film(point: MoesPoint, mesh: Mesh) -> tuple[dict[str, Any], _Floats]:
    """Steady film, and its pressure."""
    steady = solve_steady(point, n=mesh.n, domain=mesh.domain)
    found = {name: getattr(steady, name) for name in ("approach", "h_central", "h_min", "n")}
    return found | {"domain": list(mesh.domain.as_tuple())}, steady.P


def respond(point: MoesPoint, mesh: Mesh) -> dict[str, Any]:
    """Steady film and impedance at `OMEGAS`."""
    found, P = film(point, mesh)
    contact = LinearisedContact(point, mesh.domain, mesh.n, P, found["approach"])
    omega = np.maximum(OMEGAS, NEAR_ZERO)
    Z, _residual = contact.respond(omega, TOLERANCE)
    return found | {"stiffness": Z.real.tolist(), "damping": (Z.imag / omega).tolist()}
