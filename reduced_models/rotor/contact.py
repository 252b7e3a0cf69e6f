"""Contacts of a rotor, full or reduced: protocol, SI units around dimensionless ones, forces in a step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ehlcontact.point import Scales

_Floats = NDArray[np.float64]

# The first slope of a contact without tangents is a secant: over this share of its approach, at least so far.
PROBE = 1e-4
SHORTEST_PROBE = 1e-12  # [m]
NO_TIME = 1e-9  # share of a step, over which the force of a contact with memory hardly changes


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
        """What `advance` would return, and its derivatives dF/du and dF/du'; the state stays."""


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


class ContactForces:
    """All contacts of one bearing over steps of one length.

    Within a step the rate at its end is affine in the approach, rate = gain approach + constant, so every
    contact is a scalar function of its own approach and one slope dF/du describes it. Contacts with tangents
    stay at the start of the step until it is accepted; those without are advanced and taken back, and keep a
    secant of that function from iteration to iteration and from step to step.
    """

    noise = 0.0  # change of force [N] below which a secant would measure the tolerance of a contact's solver

    def __init__(self, contacts: Sequence[Any], dt: float, gain: float):
        self._contacts = list(contacts)
        self._analytic = [has_tangents(contact) for contact in contacts]
        self._dt, self._gain = dt, gain
        self._slopes = np.zeros(len(self._contacts))
        self._saved: list[object] = []
        self._last: tuple[_Floats, _Floats] | None = None

    def begin(self) -> None:
        """Mark the present state of the contacts as the start of a step."""
        self._saved = [contact.save_state() for contact in self._contacts]
        self._last = None

    def rewind(self) -> None:
        """Put the contacts back to the start of the step."""
        for contact, state in zip(self._contacts, self._saved, strict=True):
            contact.restore_state(state)

    def at(self, approach: _Floats, rate: _Floats) -> _Floats:
        """Forces at the end of the step, from the start of the step; `slopes` are of there from now on."""
        forces, tangents = np.zeros((2, len(self._contacts)))
        for i, contact in enumerate(self._contacts):
            u, v = float(approach[i]), float(rate[i])
            if self._analytic[i]:
                forces[i], stiffness, damping = contact.step_tangents(self._dt, u, v)
                tangents[i] = stiffness + self._gain * damping
            else:
                if self._last is not None:
                    contact.restore_state(self._saved[i])
                forces[i] = contact.advance(self._dt, u, v)
        if self._last is not None:
            self._learn(approach - self._last[0], forces - self._last[1])
        self._slopes = np.where(self._analytic, tangents, self._slopes)
        self._last = (approach, forces)
        return forces

    def accept(self, approach: _Floats, rate: _Floats) -> None:
        """Move the contacts to the end of the step, where `at` was called last."""
        for i, contact in enumerate(self._contacts):
            if self._analytic[i]:
                contact.advance(self._dt, float(approach[i]), float(rate[i]))

    def slopes(self, approach: _Floats, rate: _Floats) -> _Floats:
        """Slope dF/du of every contact along the step's line of approach and rate, to be expected there."""
        slopes = self._slopes.copy()
        for i, contact in enumerate(self._contacts):
            if self._analytic[i]:
                _, stiffness, damping = contact.step_tangents(self._dt, float(approach[i]), float(rate[i]))
                slopes[i] = stiffness + self._gain * damping
        return slopes

    @property
    def last_slopes(self) -> _Floats:
        """Slopes where `at` was called last."""
        return self._slopes

    def start(self, approach: _Floats, rate: _Floats) -> _Floats:
        """Forces at the very start, and the first slopes; the contacts stay where they are.

        The force of a contact with memory needs a step: one without motion, and almost without duration where the
        contact has tangents.
        """
        self.begin()
        forces = self.at(approach, rate)
        for i, contact in enumerate(self._contacts):
            if self._analytic[i]:
                u, v = float(approach[i]), float(rate[i])
                forces[i] = contact.step_tangents(NO_TIME * self._dt, u, v)[0]
        if not all(self._analytic):
            step = np.maximum(PROBE * np.abs(approach), SHORTEST_PROBE)
            self.at(approach + step, rate + self._gain * step)
        self.rewind()
        self._last = None
        return forces

    def _learn(self, change: _Floats, force_change: _Floats) -> None:
        expected = np.maximum(np.abs(self._slopes * change), np.abs(force_change))
        usable = (change != 0.0) & (expected > self.noise)
        secants = np.divide(force_change, change, out=self._slopes.copy(), where=usable)
        # A contact pushes harder when it is closed further; a negative secant is noise.
        self._slopes = np.where(secants >= 0.0, secants, self._slopes)
