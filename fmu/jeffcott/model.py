"""`JeffcottModel`: checked input of the rotor FMU: Jeffcott rotor, contacts, initial state."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ehlcontact.checks import require_instance
from ehlcontact.errors import ConvergenceError, InputError
from fmu.contact_variables import Element
from fmu.jeffcott.reference_rotor import Run, reference_run
from fmu.steps import default_step, round_down
from reduced_models import JeffcottRotor, OutsideValidityWarning
from reduced_models.rotor.jeffcott import RotorState
from reduced_models.rotor.scaled_contact import ScaledContact

# An FMU counts its contacts, and all inputs that have derivatives, in the bits of one number.
MOST_MOUNTS = 32
STEPS_PER_PERIOD = 60.0  # of the disc on its shaft against the journal, which an inner step resolves


@dataclass(frozen=True)
class JeffcottModel:
    """A rotor alone, or closed with its contacts.

    Parameters
    ----------
    rotor : JeffcottRotor
    contacts : sequence of ContactElement, optional
        One per mount, in SI; or `ScaledContact` around dimensionless ones. Without them the contacts are outside.
    start : RotorState, optional
        By default the static equilibrium; without contacts, with the journal at the origin and the shaft bent by
        the static load.

    Raises
    ------
    InputError
        No rotor, a wrong number of contacts, one that is no element or not in SI; too many mounts; contacts that
        do not carry the load.
    """

    rotor: JeffcottRotor
    contacts: Sequence[Any] | None = None
    start: RotorState | None = None

    def __post_init__(self) -> None:
        require_instance("rotor", self.rotor, JeffcottRotor, "a JeffcottRotor")
        if len(self.rotor.mounts) > MOST_MOUNTS:
            raise InputError("rotor.mounts", len(self.rotor.mounts), f"at most {MOST_MOUNTS} in an FMU")
        if self.start is not None and not isinstance(self.start, RotorState):
            raise InputError("start", self.start, "a RotorState, or left out")
        if self.contacts is not None:
            object.__setattr__(self, "contacts", self._elements(self.contacts))
        _ = self.state

    def _elements(self, contacts: Sequence[Any]) -> tuple[Element, ...]:
        if not isinstance(contacts, list | tuple):
            raise InputError("contacts", type(contacts).__name__, "a list of contact elements, one per mount")
        if len(contacts) != len(self.rotor.mounts):
            raise InputError("contacts", len(contacts), f"one per mount, {len(self.rotor.mounts)}")
        return tuple(_element(f"contacts[{i}]", contact) for i, contact in enumerate(contacts))

    @property
    def elements(self) -> tuple[Element, ...]:
        """Contacts inside; none of a rotor alone."""
        return () if self.contacts is None else tuple(self.contacts)

    @cached_property
    def state(self) -> RotorState:
        """Where the FMU starts."""
        if self.start is not None:
            return self.start
        if not self.elements:
            return self.rotor.rest_state(np.zeros(len(self.rotor.axes)))
        try:
            with warnings.catch_warnings():  # about the speed, on which rest does not depend
                warnings.simplefilter("ignore", OutsideValidityWarning)
                return self.rotor.static_equilibrium([element.copy() for element in self.elements])
        except ConvergenceError as error:
            load = f"{self.rotor.static_load.tolist()} N"
            raise InputError("contacts", str(error), f"ones that carry the static load {load}") from None

    @cached_property
    def run(self) -> Run:
        """Reference run of the FMU."""
        return reference_run(self.rotor, self.elements, self.state, self.inner_step)

    @property
    def inner_step(self) -> float:
        """Longest step that resolves shaft and contacts [s]: 1, 2 or 5 times a power of ten."""
        r = self.rotor
        omega = math.sqrt(r.shaft_stiffness * (1.0 / r.disc_mass + 1.0 / r.journal_mass))
        return min(
            round_down(2.0 * math.pi / omega / STEPS_PER_PERIOD),
            *(default_step(e) for e in self.elements),
            math.inf,
        )


def _element(name: str, contact: Any) -> Element:
    """A contact element in SI that the FMU can hold."""
    found = contact
    if isinstance(contact, ScaledContact) and isinstance(contact.contact, Element):
        found = contact.contact.to_si(contact.scales)
    if not isinstance(found, Element):
        raise InputError(name, type(contact).__name__, "a contact element (linear, cubic, ..., wide)")
    if found.units != "SI":
        raise InputError(f"{name}.units", found.units, "SI; see to_si and ScaledContact")
    return found.copy()
