"""A layer of oil that passes a linearised starved film: what its changes do to the film, and what is left behind.

Notation and balances are those of `kernels.supply` and `linear_fronts`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.film_heat import divergence
from ehlcontact.solver.level import Level
from ehlcontact.solver.linear_fronts import LinearFronts
from ehlcontact.solver.linear_heat import flow_changes, padded

Array = NDArray[Any]
Complex = NDArray[np.complex128]


def arriving(level: Level, rate: complex) -> Complex:
    """Change of the Reynolds operator by a unit of the layer ahead, flat: at the first front of each line."""
    fronts, half = level.fronts(), 0.5 * rate * level.hx / level.speed
    lines, columns = np.divmod(fronts.nodes, level.nx + 1)
    first = columns == (level.P > 0.0).argmax(axis=1)[lines]
    arrives = 1.0 - half * (1.0 - fronts.passed + 2.0 * fronts.stored * fronts.passed)
    lag = ((1.0 - half) / (1.0 + half)) ** (columns - 1)
    source = np.zeros(level.P.size, complex)
    source[fronts.nodes[first]] = (lag * arrives)[first] * level.speed / level.hx
    return source


def layer_behind(
    level: Level, rate: complex, dP: Array, dH: Array, log_eps: Any = 0.0, ratio: Any = 0.0, layer: float = 0.0
) -> Complex:
    """Change of the layer behind on each line, shape (ny + 1,), by those of the film and of the layer ahead.

    `log_eps` is the change of ln(eps) beside that by pressure and film, `ratio` that of ln of the viscosity along
    over that across.
    """
    flow, s, P = level.fields.flow, level.stencil, level.P
    log_eps = flow.eps_slope * dP + flow.film_slope * dH + log_eps
    (along, across), tilt = flow_changes(level, log_eps), np.broadcast_to(ratio, P.shape)
    across = across + 0.5 * flow.across[:-1] * (tilt[:-1] + tilt[1:])
    pressed_x = s.cx * (along * np.diff(P, axis=1) + flow.along[:, :-1] * np.diff(dP, axis=1))
    pressed_y = s.cy * (across * np.diff(P, axis=0) + flow.across[:-1] * np.diff(dP, axis=0))
    full = level.full_flow(flow.mass_slope * dP + flow.rho * dH)
    fronts = LinearFronts(level, rate)
    pressed = divergence(padded(pressed_x, 1), padded(pressed_y, 0))
    through = fronts.through(full, pressed, fronts.back(dP, log_eps), layer)
    behind = np.asarray(through[:, -2]).copy()
    behind[-1] = behind[-2]
    return behind


def on_track(layer: Array, Y: Array) -> Array:
    """Mean over the half width of the contact, of lines (..., ny + 1)."""
    inside = Y <= 1.0
    return np.asarray(np.trapezoid(layer[..., inside], Y[inside]) / Y[inside][-1])
