"""`Part`: one component of a system, the FMU it is, and its wires to the rotor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Part:
    """A component.

    Attributes
    ----------
    name : str
        Of the component.
    source : str
        Name of its FMU, which equal components share.
    model : object
        What the FMU is made from.
    keywords : mapping
        Of its `fmu_model`.
    starts : mapping of str to float
        Values of its inputs and parameters at the start.
    motions, forces : sequence of (str, str)
        Wires from the rotor to it, and from it to the rotor: output and input.
    """

    name: str
    source: str
    model: Any
    keywords: Mapping[str, Any]
    starts: Mapping[str, float] = field(default_factory=dict)
    motions: tuple[tuple[str, str], ...] = ()
    forces: tuple[tuple[str, str], ...] = ()
