"""One point of the atlas solved: steady film and impedance, on the mesh its film needs."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Domain, MoesPoint, __version__, solve_steady
from ehlcontact.errors import ConvergenceError
from ehlcontact.hertz import radius_ratio
from ehlcontact.impedance import NEAR_ZERO, TOLERANCE
from ehlcontact.solver.domain import default_domain
from ehlcontact.solver.linearised_contact import LinearisedContact
from ehlcontact.solver.resolution import CLOSE, inlet_width
from ehlcontact.status import Status

_Floats = NDArray[np.float64]

OMEGAS = (
    0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 2.5, np.pi, 4.0, 5.0, 2.0 * np.pi, 8.0, 10.0,
    4.0 * np.pi, 16.0, 20.0, 8.0 * np.pi, 32.0, 45.0, 60.0,
)  # fmt: skip
# Below this load number of Wijnant films are thick, and few intervals resolve them.
LIGHT, LIGHT_MESH = 4.5, 64
# Width of the inlet from which so many intervals serve, on the default domain and on the one for thin films:
# the mesh is about a third of the width, half of it at most. Thinner films are left out.
DEFAULT_MESHES = ((0.13, 128), (0.09, 192))
CLOSE_MESHES = ((0.05, 192), (0.025, 256))
# Below the first of those, the film by itself is solved once more on a finer mesh; on the default domain but for
# the last.
FILM_MESHES = ((0.09, 256), (0.05, 384), (0.033, 512), (0.0, 512))
PAIRED = (0.1, 0.16)  # widths at which both domains are solved, to learn what the oil further out adds


@dataclass(frozen=True)
class Mesh:
    """Intervals along X on a domain."""

    n: int
    domain: Domain


def mesh_of(point: MoesPoint) -> Mesh | None:
    """Mesh for the impedance; None where the film is too thin for any that is affordable."""
    default = default_domain(point)
    if radius_ratio(point.kappa) ** 0.5 * point.M < LIGHT:
        return Mesh(LIGHT_MESH, default)
    width = inlet_width(point)
    choices = [(least, Mesh(n, default)) for least, n in DEFAULT_MESHES]
    choices += [(least, Mesh(n, CLOSE)) for least, n in CLOSE_MESHES]
    return next((mesh for least, mesh in choices if width >= least), None)


def film_mesh(point: MoesPoint) -> Mesh:
    """Mesh for a thin steady film by itself."""
    least, n = next(choice for choice in FILM_MESHES if inlet_width(point) >= choice[0])
    return Mesh(n, CLOSE if least == 0.0 else default_domain(point))


def solve_point(point: MoesPoint) -> dict[str, Any]:
    """Everything that the atlas keeps of a point, ready for JSON; ``status`` says whether it converged."""
    started = time.perf_counter()
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa, "alpha": point.alpha}
    entry |= {"eta0": point.eta0, "version": __version__, "status": str(Status.UNRESOLVED)}
    mesh, width = mesh_of(point), inlet_width(point)
    if mesh is None:
        return entry
    try:
        entry |= respond(point, mesh)
        if width < DEFAULT_MESHES[0][0]:
            entry["film"] = film(point, film_mesh(point))[0]
        entry["status"] = str(Status.CONVERGED)
    except ConvergenceError as error:
        entry["status"] = "unknown" if error.result is None else str(error.result.status)
    if mesh.domain != CLOSE and PAIRED[0] <= width < PAIRED[1]:
        with suppress(ConvergenceError):
            entry["close"] = respond(point, Mesh(128, CLOSE))
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
