"""The contacts of a rotor as one force with slopes: exact where given, secants where not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduced_models.rotor.contact import has_tangents

_Floats = NDArray[np.float64]
PROBE = 1e-4  # relative change of approach in the probe for the first slope
INSTANT = 1e-9  # share of a step that is no time
PROBE_FLOOR = 1e-12  # [m], where the approach is zero


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
        """Move the contacts to the end of the step, where `at` was asked last."""
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
        """Slopes where `at` was asked last."""
        return self._slopes

    def start(self, approach: _Floats, rate: _Floats) -> _Floats:
        """Forces at the very start, and the first slopes; the contacts stay where they are.

        A contact with memory only tells its force by making a step: one that goes nowhere, in no time where the
        contact can be asked without being moved.
        """
        self.begin()
        forces = self.at(approach, rate)
        for i, contact in enumerate(self._contacts):
            if self._analytic[i]:
                u, v = float(approach[i]), float(rate[i])
                forces[i] = contact.step_tangents(INSTANT * self._dt, u, v)[0]
        if not all(self._analytic):
            step = np.maximum(PROBE * np.abs(approach), PROBE_FLOOR)
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
