"""Parameters of a rotor's FMU: factors of constant matrices, whose sums are mass, damping, stiffness and load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from reduced_models import JeffcottRotor
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]

SUMS = "M", "C", "K", "L"  # mass, damping, stiffness, load: order of the sums in the cache


@dataclass(frozen=True, eq=False)
class Parameter:
    """One parameter.

    Attributes
    ----------
    name, unit, text : str
        Of its variable.
    start : float
    parts : mapping of str to ndarray
        What it is multiplied with, by the sum that it belongs to; empty for the factors of `scales`.
    positive, signed : bool
        Whether it must be > 0, or may be < 0.
    reason : str
        What is said where it is not.
    """

    name: str
    unit: str
    text: str
    start: float
    parts: Mapping[str, _Floats] = field(default_factory=dict)
    positive: bool = False
    signed: bool = False
    reason: str = ""


_MATRICES = "stiffness_scale, damping_scale and load_scale must be finite, the first two >= 0"


def scales(rotor: Rotor) -> tuple[Parameter, ...]:
    """Factors of the matrices of any rotor."""
    return (
        Parameter(
            "mass_scale", "1", "Factor of masses and moments of inertia, of the gyroscopic ones too", 1.0,
            positive=True, reason="mass_scale must be finite and > 0",
        ),
        Parameter(
            "stiffness_scale", "1", "Factor of the stiffness of the shaft, and of linear bearings", 1.0,
            reason=_MATRICES,
        ),
        Parameter(
            "damping_scale", "1", "Factor of the damping of the shaft, and of linear bearings", 1.0,
            reason=_MATRICES,
        ),
        Parameter(
            "load_scale", "1", "Factor of the constant load, weight for one", 1.0, signed=True, reason=_MATRICES,
        ),
    )  # fmt: skip


def jeffcott_parameters(rotor: JeffcottRotor) -> tuple[Parameter, ...]:
    """Masses, stiffness and dampers of a Jeffcott rotor."""
    size = len(rotor.axes)
    gravity = np.array(rotor.gravity)[list(rotor.axes)]
    disc, journal = np.diag([1.0, 0.0]), np.diag([0.0, 1.0])
    between = np.array([[1.0, -1.0], [-1.0, 1.0]])

    def both(part: _Floats) -> _Floats:
        return np.asarray(np.kron(part, np.eye(size)), np.float64)

    def of_mass(body: _Floats) -> dict[str, _Floats]:
        return {"M": both(body), "L": np.kron(np.diag(body), gravity)}

    rows: tuple[tuple[str, str, str, dict[str, _Floats], bool], ...] = (
        ("disc_mass", "kg", "Mass of the disc", of_mass(disc), True),
        ("journal_mass", "kg", "Mass of both journals", of_mass(journal), True),
        ("shaft_stiffness", "N/m", "Stiffness between disc and journal", {"K": both(between)}, True),
        ("shaft_damping", "N.s/m", "Damping between disc and journal", {"C": both(between)}, False),
        ("disc_damping", "N.s/m", "Damping from the disc to the ground", {"C": both(disc)}, False),
    )
    return tuple(
        Parameter(
            name,
            unit,
            text,
            float(getattr(rotor, name)),
            parts,
            positive,
            reason=f"{name} must be finite and {'>' if positive else '>='} 0",
        )
        for name, unit, text, parts, positive in rows
    )


def constant_load(rotor: Rotor, parameters: tuple[Parameter, ...]) -> _Floats:
    """The part of the load that no parameter has."""
    load = rotor.load.copy()
    for parameter in parameters:
        if "L" in parameter.parts:
            load -= parameter.start * parameter.parts["L"]
    return load
