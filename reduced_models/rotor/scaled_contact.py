"""Contacts of a rotor, full or reduced: their protocol, and `ScaledContact`, a dimensionless one in SI."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from ehlcontact.point import Scales


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

    def rest(self, approach: float) -> float:
        """Put the contact at rest, where it can be; force [N]."""
        return float(self.contact.rest(approach / self.scales.length)) * self.scales.force

    def spring(self, approach: float) -> float:
        """Static force [N], where the contact gives one."""
        return float(self.contact.spring(approach / self.scales.length)) * self.scales.force

    def spring_tangent(self, approach: float) -> float:
        """Slope of the static force [N/m], where the contact gives one."""
        return float(self.contact.spring_tangent(approach / self.scales.length)) * self.scales.stiffness

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force [N], dF/du [N/m] and dF/du' [N s/m] at the end of a step, where the contact gives them."""
        s = self.scales
        force, stiffness, damping = self.contact.step_tangents(dt / s.time, approach / s.length, rate / s.rate)
        return force * s.force, stiffness * s.stiffness, damping * s.damping

    def check(self, point: Any = None, *, stacklevel: int = 2, omega: float | None = None) -> None:
        """Warn where a wrapped element was made for another contact, or for another band than `omega` rad/s."""
        check = getattr(self.contact, "check", None)
        if check is not None:
            Omega = None if omega is None else omega * self.scales.time
            check(point, stacklevel=stacklevel + 1, Omega=Omega)

    def warn_outside(
        self, approach: Any, rate: Any, *, force: Any, omega: float | None, stacklevel: int = 2
    ) -> None:
        """Warn where a motion of `omega` rad/s leaves the box of a wrapped element; a full contact has none."""
        warn = getattr(self.contact, "warn_outside", None)
        if warn is not None:
            s = self.scales
            Omega = None if omega is None else omega * s.time
            u, v, f = approach / s.length, rate / s.rate, force / s.force
            warn(u, v, force=f, Omega=Omega, stacklevel=stacklevel + 1)
