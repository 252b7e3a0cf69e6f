"""Contacts of a rotor, full or reduced: their protocol."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


@runtime_checkable
class Contact(Protocol):
    """A contact in SI: the full film or an element reduced from it."""

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step `dt`, at the approach and rate of that end; moves the state there."""

    def save_state(self) -> object:
        """Copy of the internal state, opaque and cheap."""

    def restore_state(self, state: object) -> None:
        """Go back to a saved state."""


@runtime_checkable
class TangentContact(Contact, Protocol):
    """A contact with a static law and the exact tangents of a step; every reduced element is one."""

    def rest(self, approach: float) -> float:
        """Put the contact at rest at this approach; returns the static force."""

    def spring(self, approach: float) -> float:
        """Static force; the state stays."""

    def spring_tangent(self, approach: float) -> float:
        """Slope of the static force."""

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force that `advance` would return, and its derivatives dF/du and dF/du'; the state stays."""


def has_tangents(contact: object) -> bool:
    """Whether the contact gives analytic tangents."""
    return isinstance(contact, TangentContact)
