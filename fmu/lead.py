"""Lead of forces in co-simulation: `lead` of a contact's FMU and `force_lead` of a rotor's, in steps.

A master hands forces on at communication points, and most masses hold them over their step: the force that does
the right work is then the one of the middle of that step. A contact's force is therefore given `lead` steps after
the time of its inputs, and a rotor takes its forces as those of the time `force_lead` steps after the start of its
step.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ehlcontact.errors import InputError


@dataclass(frozen=True, slots=True)
class Lead:
    """The parameter of one kind of FMU.

    Attributes
    ----------
    name : str
        Of the parameter.
    most : float
        Largest value; the smallest is 0.
    at_end : float
        Value for inputs of the end of a step, where the outputs are wanted: of masters that iterate.
    text : str
        Description.
    macros : mapping of str to str
        For config.h.
    """

    name: str
    most: float
    at_end: float
    text: str
    macros: Mapping[str, str]

    def check(self, value: float) -> float:
        """The value as a float; raises `InputError` outside [0, most]."""
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not 0.0 <= value <= self.most:
            raise InputError("lead", value, f"0 to {self.most:g} communication steps")
        return float(value)


def _macros(name: str, most: float, extrapolates: str) -> dict[str, str]:
    return {
        "VR_LEAD": f"VR_{name}",
        "MOST_LEAD": f"{most:.1f}",
        "LEAD_NAME": f'"{name}"',
        "LEAD_MOST": f'"{most:g}"',
        "LEAD_EXTRAPOLATES": f'"{extrapolates}"',
    }


CONTACT = Lead(
    "lead",
    2.0,
    0.0,
    "Time from the inputs of a communication step to that for which the force is given, in steps: 1.5 = inputs of"
    " its start, a mass that holds the force (parallel masters), 1 = the same, symplectic Euler, 0.5 and 0 ="
    " inputs of its end, or from just before (serial masters)",
    _macros("lead", 2.0, "is above 0"),
)
ROTOR = Lead(
    "force_lead",
    1.0,
    1.0,
    "Time from the start of a communication step to that of the forces given, in steps: 0 = its start, 0.5 = its"
    " middle (they are held), 1 = its end",
    _macros("force_lead", 1.0, "is below 1") | {"LEAD_OF_INPUTS": "1"},
)
HELD_PARALLEL = 1.5  # lead of a contact beside a mass that holds its force over the step, both stepped at once


def force_lead_for(lead: float) -> float:
    """`force_lead` of a rotor whose contacts have this `lead`."""
    return lead - 1.0 if lead >= 1.0 else lead


def inputs_at_end(parameters: Mapping[str, float]) -> bool:
    """Whether inputs are set that belong to the end of a step."""
    return any(parameters.get(kind.name) == kind.at_end for kind in (CONTACT, ROTOR))
