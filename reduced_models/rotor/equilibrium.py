"""Contacts with a static law, as springs on a journal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from reduced_models.rotor.contact import has_tangents

_Floats = NDArray[np.float64]


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
