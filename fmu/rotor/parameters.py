"""Parameters of a rotor's FMU: those of the rotor, or factors of its matrices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduced_models.rotor.rotor import MATRICES, Parameter, Rotor

_Floats = NDArray[np.float64]

SUMS = (*MATRICES, "load")  # order of the sums in the cache
_REASON = "stiffness_scale, damping_scale and load_scale must be finite, the first two >= 0"


def parameters_of(rotor: Rotor) -> tuple[Parameter, ...]:
    """Those of the rotor, else factors of its matrices."""
    rows = (
        ("mass_scale", "masses and moments of inertia, of the gyroscopic ones too"),
        ("stiffness_scale", "the stiffness of the shaft, and of linear bearings"),
        ("damping_scale", "the damping of the shaft, and of linear bearings"),
        ("load_scale", "the constant load, weight for one"),
    )
    return rotor.parameters or tuple(
        Parameter(
            name=name,
            unit="1",
            text=f"Factor of {what}",
            value=1.0,
            positive=name == "mass_scale",
            signed=name == "load_scale",
            reason="mass_scale must be finite and > 0" if name == "mass_scale" else _REASON,
        )
        for name, what in rows
    )


def constant_load(rotor: Rotor) -> _Floats:
    """The part of the load that no parameter has."""
    load = rotor.load.copy()
    for parameter in rotor.parameters:
        if "load" in parameter.parts:
            load -= parameter.value * parameter.parts["load"]
    return load
