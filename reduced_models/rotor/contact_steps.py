"""Forces of all contacts of a rotor at the end of a time step and their tangent stiffness, exact or by secant."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from reduced_models.rotor.contact_protocol import has_tangents
from reduced_models.rotor.supports import ContactMount

_Floats = NDArray[np.float64]

# The first slope of a contact without tangents is a secant: over this share of its approach, at least so far.
PROBE = 1e-4
SHORTEST_PROBE = 1e-12  # [m]
NO_TIME = 1e-9  # share of a step, over which the force of a contact with memory hardly changes


class ContactSteps:
    """All contacts of a rotor over steps of one length.

    Within a step the rate at its end is affine in the approach, rate = gain approach + constant, so every
    contact is a scalar function of its own approach and one slope dF/du describes it. Contacts with tangents
    stay at the start of the step until it is accepted; those without are advanced and taken back, and keep a
    secant of that function from iteration to iteration and from step to step.

    Motions are approaches without the offsets of the mounts.
    """

    noise = 0.0  # change of force [N] below which a secant would measure the tolerance of a contact's solver

    def __init__(self, mounts: Sequence[ContactMount], dt: float, gain: float) -> None:
        self._contacts = [mount.contact for mount in mounts]
        self._offsets = np.array([mount.offset for mount in mounts])
        self._analytic = [has_tangents(contact) for contact in self._contacts]
        self._dt, self.gain = dt, gain
        self._slopes = np.zeros(len(self._contacts))
        self._saved: list[object] = []
        self._last: tuple[_Floats, _Floats] | None = None

    def start(self, r: _Floats, rate: _Floats) -> _Floats:
        """Forces at the very start of a run, and the first slopes; the contacts stay where they are.

        The force of a contact with memory needs a step: one without motion, and almost without duration where the
        contact has tangents.
        """
        approach = r + self._offsets
        self._begin()
        forces = self._forces(approach, rate)
        for i, contact in enumerate(self._contacts):
            if self._analytic[i]:
                u, v = float(approach[i]), float(rate[i])
                forces[i] = contact.step_tangents(NO_TIME * self._dt, u, v)[0]
        if not all(self._analytic):
            step = np.maximum(PROBE * np.abs(approach), SHORTEST_PROBE)
            self._forces(approach + step, rate + self.gain * step)
        self.rewind()
        self._last = None
        return forces

    def begin(self, omega: float) -> None:
        """Begin a step where the contacts are; they do not depend on the speed of the shaft."""
        self._begin()

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, from the start of the step; and their slopes, a diagonal matrix."""
        force = self._forces(r + self._offsets, rate)
        return force, np.diag(self._slopes)

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there, along the step's line of approach and rate, a diagonal matrix."""
        slopes = self._slopes.copy()
        for i, (contact, u) in enumerate(zip(self._contacts, r + self._offsets, strict=True)):
            if self._analytic[i]:
                _, stiffness, damping = contact.step_tangents(self._dt, float(u), float(rate[i]))
                slopes[i] = stiffness + self.gain * damping
        return np.diag(slopes)

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move the contacts to the end of the step, where `at` was called last."""
        for i, (contact, u) in enumerate(zip(self._contacts, r + self._offsets, strict=True)):
            if self._analytic[i]:
                contact.advance(self._dt, float(u), float(rate[i]))

    def rewind(self) -> None:
        """Put the contacts back to the start of the step."""
        for contact, state in zip(self._contacts, self._saved, strict=True):
            contact.restore_state(state)

    def _begin(self) -> None:
        self._saved = [contact.save_state() for contact in self._contacts]
        self._last = None

    def _forces(self, approach: _Floats, rate: _Floats) -> _Floats:
        """Forces at the end of the step; the slopes are of there from now on."""
        forces, tangents = np.zeros((2, len(self._contacts)))
        for i, contact in enumerate(self._contacts):
            u, v = float(approach[i]), float(rate[i])
            if self._analytic[i]:
                forces[i], stiffness, damping = contact.step_tangents(self._dt, u, v)
                tangents[i] = stiffness + self.gain * damping
            else:
                if self._last is not None:
                    contact.restore_state(self._saved[i])
                forces[i] = contact.advance(self._dt, u, v)
        if self._last is not None:
            self._update_secants(approach - self._last[0], forces - self._last[1])
        self._slopes = np.where(self._analytic, tangents, self._slopes)
        self._last = (approach, forces)
        return forces

    def _update_secants(self, change: _Floats, force_change: _Floats) -> None:
        """Secants, of those contacts whose change of force is more than noise."""
        expected = np.maximum(np.abs(self._slopes * change), np.abs(force_change))
        usable = (change != 0.0) & (expected > self.noise)
        secants = np.divide(force_change, change, out=self._slopes.copy(), where=usable)
        # A contact pushes harder when it is closed further; a negative secant is noise.
        self._slopes = np.where(secants >= 0.0, secants, self._slopes)
