"""A Jeffcott rotor and its contacts as the parts of a system; its default step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from fmu.lead import force_lead_for
from fmu.rotor.model import ALL, jeffcott_elements, jeffcott_rest
from fmu.steps import ADDED_DAMPING, damping_at, round_down
from fmu.system.check import ALLOWED, SystemVerification, verify_system
from fmu.system.part import Part
from fmu.verify import VerificationError
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState

FOREIGN_DAMPING = 0.05  # of that of a contact, at the journal's fastest vibration: what the default step may add
LONGEST = 0.1  # default step times that frequency, or the rate at which dampers stop the journal
REVOLUTIONS = 10.0  # of the default experiment
STANDING = 0.1  # [s] of it, where nothing turns


@dataclass(frozen=True, slots=True)
class RotorOnContacts:
    """A Jeffcott rotor closed with copies of its contacts, in SI, in equilibrium."""

    rotor: JeffcottRotor
    elements: tuple[Any, ...]
    state: RotorState
    name = "rotor on contacts"
    description = "Jeffcott rotor on rolling contacts, in SI units; values are passed on after each step"

    @classmethod
    def of(cls, rotor: JeffcottRotor, contacts: Sequence[Any]) -> Self:
        """Rotor and contacts, checked."""
        elements = jeffcott_elements(rotor, contacts)
        return cls(rotor, tuple(elements), jeffcott_rest(rotor, elements))

    @property
    def stop(self) -> float:
        """End of the default experiment [s]."""
        w = self.rotor.omega
        return float(f"{REVOLUTIONS * 2.0 * pi / w if w > 0.0 else STANDING:.6g}")

    def parts(self, lead: float) -> tuple[Part, ...]:
        """Rotor and contacts, whose FMUs have this lead."""
        rotor = self.rotor
        approaches = rotor.approaches(self.state.journal).tolist()
        pairs = list(enumerate(zip(self.elements, approaches, strict=True), start=1))
        settings = {"outside": ALL, "start": self.state, "lead": force_lead_for(lead)}
        forces = {f"contact[{k}].force": float(element.spring(u)) for k, (element, u) in pairs}
        contacts = [
            Part(
                f"contact_{k}",
                f"contact_{k}",
                element,
                {"lead": lead},
                {"approach": u, "rate": 0.0},
                ((f"contact[{k}].approach", "approach"), (f"contact[{k}].rate", "rate")),
                (("force", f"contact[{k}].force"),),
            )
            for k, (element, u) in pairs
        ]
        return (Part("rotor", "rotor", rotor, settings, forces), *contacts)

    def default_step(self) -> float:
        """A step [s] that leaves the contacts their damping, 1, 2 or 5 times a power of ten.

        Contacts extrapolate the motion of the rotor, which adds about 2.4 K h (w h)^4 to the damping of a
        vibration of w; the fastest is that of the journal on the contacts. Such a loop is stable up to w h = 0.57,
        and as long as h resolves how fast their dampers alone would stop the journal.
        """
        rotor, contacts = self.rotor, self.elements
        approaches = rotor.approaches(self.state.journal).tolist()
        pairs = list(zip(contacts, approaches, strict=True))
        K = np.array([float(element.spring_tangent(u)) for element, u in pairs])
        forces = [float(element.spring(u)) for element, u in pairs]
        C = np.array(
            [
                damping_at(element, force) if force > 0.0 else 0.0
                for element, force in zip(contacts, forces, strict=True)
            ]
        )
        w = sqrt(_fastest(rotor, K, rotor.shaft_stiffness))
        rate = max(w, _fastest(rotor, C, rotor.shaft_damping))
        times = C[C > 0.0] / K[C > 0.0]
        h = (FOREIGN_DAMPING / ADDED_DAMPING * float(times.min(initial=inf)) / w**4) ** 0.2
        return round_down(min(h, LONGEST / rate))

    def require_verified(self, content: bytes, step: float, *, serial: bool) -> SystemVerification:
        """Check of an archive; raises `VerificationError` where it differs from the rotor."""
        verification = verify_system(content, self.rotor, self.elements, self.state, step, serial=serial)
        if not verification.passes:
            gap = verification.deviation
            off = f"the journal is {gap:.2g} of its way after a load step off, allowed {ALLOWED:g}"
            reason = "; ".join(verification.findings) or f"{off}, at steps of {step:g} s"
            raise VerificationError(f"the system is not what it was made from: {reason}")
        return verification


def _fastest(rotor: JeffcottRotor, of_contacts: NDArray[np.float64], of_shaft: float) -> float:
    """Largest eigenvalue of stiffness or damping over the mass of the journal."""
    normals = rotor.normals
    matrix = rotor.bearings * (normals.T * of_contacts) @ normals + of_shaft * np.eye(len(rotor.axes))
    return float(np.linalg.eigvalsh(matrix)[-1]) / rotor.journal_mass
