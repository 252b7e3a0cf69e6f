"""Static equilibrium of a rotor on contacts that know their statics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.rotor.contact import has_tangents

if TYPE_CHECKING:
    from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState

_Floats = NDArray[np.float64]

TOLERANCE = 1e-12
ROUNDING = 1e-9  # imbalance that is accepted where steps no longer help
REGULAR = 1e-6
MAX_ITERATIONS = 100
FIRST_REACH = 1e-9  # [m]
REACH = 1.0  # no journal travels this far [m]; beyond it the contacts do not stand in the way


def static_equilibrium(rotor: JeffcottRotor, contacts: Sequence[Any]) -> RotorState:
    """Find the journal position at which the contacts carry the static load.

    Newton's method with the analytic tangents. Springs that only stiffen have a convex potential, so a step
    that does not bring the balance closer is replaced by the minimum along it.

    Parameters
    ----------
    rotor : JeffcottRotor
    contacts : sequence
        One per mount, in SI, with `TangentContact`'s ``spring`` and ``spring_tangent``; their states stay.

    Raises
    ------
    InputError
        Wrong number of contacts, a contact without static law, or no static load.
    ConvergenceError
        The contacts do not stand against the load; ``result`` is the last state.
    """
    if len(contacts) != len(rotor.mounts):
        raise InputError("contacts", len(contacts), f"one per mount, {len(rotor.mounts)}")
    if not all(has_tangents(contact) for contact in contacts):
        raise InputError(
            "contacts", "without static law", "reduced elements, or start from rotor.state_at(approaches)"
        )
    load, normals, offsets = rotor.static_load, rotor.normals, rotor.offsets
    size = float(np.linalg.norm(load))
    if size == 0.0:
        raise InputError("static load", 0.0, "different from zero to press the contacts")

    def balance(q: _Floats) -> _Floats:
        forces = [c.spring(float(u)) for c, u in zip(contacts, normals @ q + offsets, strict=True)]
        return rotor.bearings * normals.T @ np.array(forces) - load

    def tangent(q: _Floats) -> _Floats:
        stiffness = [c.spring_tangent(float(u)) for c, u in zip(contacts, normals @ q + offsets, strict=True)]
        return rotor.bearings * (normals.T * np.array(stiffness)) @ normals

    q = np.zeros(load.size)
    residual = balance(q)
    # Where all contacts are open there is no tangent to follow: first go along the load until they carry it.
    q = _line_search(balance, q, -math.copysign(FIRST_REACH / size, float(load @ residual)) * load, rotor)
    for _ in range(MAX_ITERATIONS):
        residual = balance(q)
        error = float(np.linalg.norm(residual))
        if error <= TOLERANCE * size:
            return rotor.rest_state(q)
        stiffness = tangent(q)
        # Contacts on one side only leave a direction without stiffness.
        stiffness += REGULAR * max(float(np.trace(stiffness)), size) * np.eye(load.size)
        step = -np.asarray(np.linalg.solve(stiffness, residual), dtype=np.float64)
        if np.linalg.norm(balance(q + step)) < 0.5 * error:
            q = q + step
        elif error <= ROUNDING * size:
            return rotor.rest_state(q)
        else:
            q = _line_search(balance, q, step, rotor)
    raise ConvergenceError("static equilibrium not found: the iteration stalled", rotor.rest_state(q))


def _line_search(balance: Any, q: _Floats, step: _Floats, rotor: JeffcottRotor) -> _Floats:
    """Point on the line at which the forces balance along it; springs that only stiffen have just one."""

    def along(t: float) -> float:
        return float(step @ balance(q + t * step))

    far = 1.0
    while along(far) < 0.0:
        far *= 2.0
        if far * float(np.linalg.norm(step)) > REACH:
            raise ConvergenceError(
                "static equilibrium not found: the contacts do not hold the load", rotor.rest_state(q)
            )
    return q + float(brentq(along, 0.0, far, xtol=1e-300, rtol=1e-12)) * step
