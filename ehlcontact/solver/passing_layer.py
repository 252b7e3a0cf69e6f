"""A layer of oil that passes a linearised starved film: what its changes do to the force, and what is left behind.

Notation and balances are those of `kernels.supply` and `linear_fronts`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.film_heat import divergence
from ehlcontact.solver.level import Level
from ehlcontact.solver.linear import LinearFilm
from ehlcontact.solver.linear_fronts import LinearFronts
from ehlcontact.solver.linearised_contact import LinearisedContact

Array = NDArray[Any]
Complex = NDArray[np.complex128]


class PassingLayer(NamedTuple):
    """Force and layer behind at one frequency, by a unit of the approach and by a unit of the layer ahead."""

    force: Complex  # (2,)
    behind: Complex  # (2, ny + 1): the layer behind on each line


class _Isothermal(NamedTuple):
    """A film whose temperatures stand still, as `LinearFronts` needs one."""

    level: Level
    rise: Array


def passing_layer(contact: LinearisedContact, omega: float, tolerance: float) -> PassingLayer:
    """Response of a starved film without heat at a frequency above 0, solved to a relative residual."""
    level, system = contact.level, contact.system(omega)
    source = _arriving(level, 1j * omega)
    b = np.zeros(source.size + 1, complex)
    b[contact.nodes] = -source[contact.nodes]
    by_layer = contact.change(omega, system, b, tolerance)
    by_approach = np.zeros_like(by_layer)
    by_approach[contact.nodes] = contact.solve(omega, np.zeros(contact.nodes.size, complex), tolerance)
    by_approach[-1] = 1.0
    fronts = LinearFronts(_Isothermal(level, np.zeros_like(level.P)), None, 1j * omega)  # type: ignore[arg-type]
    found = [
        (contact.weights @ x[contact.nodes], _left(level, system, fronts, x, layer))
        for x, layer in ((by_approach, 0.0), (by_layer, 1.0))
    ]
    force, behind = zip(*found, strict=True)
    return PassingLayer(np.array(force), np.array(behind))


def _arriving(level: Level, rate: complex) -> Complex:
    """Change of the Reynolds operator by a unit of the layer ahead, flat: at the first front of each line."""
    fronts, half = level.fronts(), 0.5 * rate * level.hx / level.speed
    lines, columns = np.divmod(fronts.nodes, level.nx + 1)
    first = columns == (level.P > 0.0).argmax(axis=1)[lines]
    arrives = 1.0 - half * (1.0 - fronts.passed + 2.0 * fronts.stored * fronts.passed)
    lag = ((1.0 - half) / (1.0 + half)) ** (columns - 1)
    source = np.zeros(level.P.size, complex)
    source[fronts.nodes[first]] = (lag * arrives)[first] * level.speed / level.hx
    return source


def _left(level: Level, system: LinearFilm, fronts: LinearFronts, x: Any, layer: float) -> Complex:
    """Change of the layer behind on each line, shape (ny + 1,), by pressures and approach and the layer ahead."""
    flow, s, P = level.fields.flow, level.stencil, level.P
    dP = x[:-1].reshape(P.shape)
    dH = system.deflect(x[:-1]).reshape(P.shape) - x[-1]
    log_eps = flow.eps_slope * dP + flow.film_slope * dH
    along: Any = s.cx * _pressed(log_eps, flow.along, flow.along_skew, P, dP, 1)
    across: Any = s.cy * _pressed(log_eps, flow.across, flow.across_skew, P, dP, 0)
    full: Any = level.full_flow(flow.mass_slope * dP + flow.rho * dH)
    through = fronts.through(full, divergence(along, across), fronts.back(dP, log_eps), layer)
    behind = np.asarray(through[:, -2]).copy()
    behind[-1] = behind[-2]
    return behind


def _pressed(log_eps: Complex, mean: Array, skew: Array, P: Array, dP: Complex, axis: int) -> Complex:
    """Change of the flow by pressure through the faces along an axis, against it; 0 behind the last node."""

    def ends(values: Any) -> tuple[Any, Any]:
        moved = np.moveaxis(values, axis, 0)
        return moved[:-1], moved[1:]

    (near, far), (p, q), (dp, dq) = ends(log_eps), ends(P), ends(dP)
    own, tilt = ends(mean)[0], ends(skew)[0]
    changed = (0.5 * own + tilt) * near + (0.5 * own - tilt) * far
    found = changed * (q - p) + own * (dq - dp)
    return np.moveaxis(np.concatenate([found, np.zeros_like(found[:1])]), 0, axis)
