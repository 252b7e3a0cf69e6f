"""Where contacts that know their statics carry a load: a journal position, found from plain numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.rotor.contact import has_tangents

_Floats = NDArray[np.float64]

BALANCED = 1e-12  # imbalance over the load that ends the iteration
BALANCED_BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
# Stiffness given to directions that have none, over that of the others: contacts on one side only leave one.
REGULARISATION = 1e-6
MOST_STEPS = 100
FIRST_STEP = 1e-9  # [m], along the load, from where all contacts may be open; the search doubles it
LONGEST_STEP = 1.0  # no journal travels this far [m]; beyond it the contacts do not stand in the way


@dataclass(frozen=True, eq=False)
class StaticContacts:
    """Contacts of all bearings, as one force on a journal along the directions that move.

    Parameters
    ----------
    contacts : sequence
        In SI, with `TangentContact`'s ``spring`` and ``spring_tangent``; their states stay.
    normals : ndarray, shape (contacts, directions)
        Unit vectors from the journal to the contacts.
    offsets : ndarray, shape (contacts,)
        Approaches with the journal at the origin [m].
    bearings : int
        How many times each contact is there.

    Raises
    ------
    InputError
        Wrong number of contacts, or one without a static law.
    """

    contacts: Sequence[Any]
    normals: _Floats
    offsets: _Floats
    bearings: int

    def __post_init__(self) -> None:
        if len(self.contacts) != self.offsets.size:
            raise InputError("contacts", len(self.contacts), f"one per mount, {self.offsets.size}")
        if not all(has_tangents(contact) for contact in self.contacts):
            raise InputError(
                "contacts", "without static law", "reduced elements, or start from rotor.state_at(approaches)"
            )

    def force(self, q: _Floats) -> _Floats:
        """What they carry with the journal at `q`, shape (directions,) [N]."""
        forces = [c.spring(u) for c, u in zip(self.contacts, self._approaches(q), strict=True)]
        return np.asarray(self.bearings * self.normals.T @ np.array(forces))

    def tangent(self, q: _Floats) -> _Floats:
        """Its derivative, shape (directions, directions) [N/m]."""
        stiffness = [c.spring_tangent(u) for c, u in zip(self.contacts, self._approaches(q), strict=True)]
        return np.asarray(self.bearings * (self.normals.T * np.array(stiffness)) @ self.normals)

    def _approaches(self, q: _Floats) -> list[float]:
        return (self.normals @ q + self.offsets).tolist()


def equilibrium(contacts: StaticContacts, load: _Floats) -> _Floats:
    """Find the journal position, shape (directions,) [m], at which the contacts carry `load` [N].

    Newton's method with the analytic tangents. Springs that only stiffen have a convex potential, so a step
    that does not bring the balance closer is replaced by the minimum along it.

    Raises
    ------
    InputError
        No load.
    ConvergenceError
        The contacts do not stand against the load; ``result`` is the last position.
    """
    size = float(np.linalg.norm(load))
    if size == 0.0:
        raise InputError("static load", 0.0, "different from zero to press the contacts")

    def balance(q: _Floats) -> _Floats:
        return contacts.force(q) - load

    q = np.zeros(load.size)
    residual = balance(q)
    # Where all contacts are open there is no tangent to follow: first go along the load until they carry it.
    q = _line_search(balance, q, -math.copysign(FIRST_STEP / size, float(load @ residual)) * load)
    for _ in range(MOST_STEPS):
        residual = balance(q)
        error = float(np.linalg.norm(residual))
        if error <= BALANCED * size:
            return q
        stiffness = contacts.tangent(q)
        stiffness += REGULARISATION * max(float(np.trace(stiffness)), size) * np.eye(load.size)
        step = -np.asarray(np.linalg.solve(stiffness, residual), dtype=np.float64)
        if np.linalg.norm(balance(q + step)) < 0.5 * error:
            q = q + step
        elif error <= BALANCED_BY_ROUNDING * size:
            return q
        else:
            q = _line_search(balance, q, step)
    raise ConvergenceError("static equilibrium not found: the iteration stalled", q)


def _line_search(balance: Callable[[_Floats], _Floats], q: _Floats, step: _Floats) -> _Floats:
    """Point on the line at which the forces balance along it; springs that only stiffen have just one."""

    def along(t: float) -> float:
        return float(step @ balance(q + t * step))

    far = 1.0
    while along(far) < 0.0:
        far *= 2.0
        if far * float(np.linalg.norm(step)) > LONGEST_STEP:
            raise ConvergenceError("static equilibrium not found: the contacts do not hold the load", q)
    return q + float(brentq(along, 0.0, far, xtol=1e-300, rtol=1e-12)) * step
