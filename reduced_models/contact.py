"""The one face that a contact shows to a rotor, full or reduced."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from ehlcontact.scaling import Scales


@runtime_checkable
class Contact(Protocol):
    """A contact in its own units: the full film or an element reduced from it."""

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step `dt`, at the approach and rate of that end; moves the state there."""

    def save_state(self) -> object:
        """Copy of the internal state, opaque and cheap."""

    def restore_state(self, state: object) -> None:
        """Go back to a saved state."""


@runtime_checkable
class TangentContact(Contact, Protocol):
    """A contact without memory, whose force and tangents follow from approach and rate alone."""

    def force(self, approach: float, rate: float) -> float:
        """Contact force."""

    def stiffness(self, approach: float, rate: float) -> float:
        """Tangent dF/du."""

    def damping(self, approach: float, rate: float) -> float:
        """Tangent dF/du'."""


def has_tangents(contact: object) -> bool:
    """Whether the contact gives analytic tangents; `ScaledContact` does when what it wraps does."""
    inner = contact.contact if isinstance(contact, ScaledContact) else contact
    return isinstance(inner, TangentContact)


@dataclass(frozen=True)
class ScaledContact:
    """A dimensionless contact shown in SI: approach [m], rate [m/s], dt [s], force [N].

    Parameters
    ----------
    contact : Contact
        Dimensionless; its state stays its own, so one contact must not be shared by two wrappers.
    scales : Scales
        Units of force, length and time of its operating point.
    """

    contact: Any
    scales: Scales

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force [N] at the end of the step; moves the contact's state there."""
        s = self.scales
        return float(self.contact.advance(dt / s.time, approach / s.length, rate / s.rate)) * s.force

    def save_state(self) -> object:
        """State of the wrapped contact."""
        return self.contact.save_state()

    def restore_state(self, state: object) -> None:
        """Give the wrapped contact its state back."""
        self.contact.restore_state(state)

    def force(self, approach: float, rate: float) -> float:
        """Force [N], where the contact has no memory."""
        s = self.scales
        return float(self.contact.force(approach / s.length, rate / s.rate)) * s.force

    def stiffness(self, approach: float, rate: float) -> float:
        """Tangent dF/du [N/m], where the contact gives one."""
        s = self.scales
        return float(self.contact.stiffness(approach / s.length, rate / s.rate)) * s.stiffness

    def damping(self, approach: float, rate: float) -> float:
        """Tangent dF/du' [N s/m], where the contact gives one."""
        s = self.scales
        return float(self.contact.damping(approach / s.length, rate / s.rate)) * s.damping
