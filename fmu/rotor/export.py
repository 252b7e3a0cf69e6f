"""Export of a rotor with its ball bearings as an FMU file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from fmu.binaries.libraries import Progress
from fmu.export import export_verified
from fmu.rotor.model import RotorModel
from reduced_models.rotor.rotor import Rotor


def export_rotor(
    rotor: Rotor,
    path: str | os.PathLike[str],
    *,
    speeds_rpm: Any,
    speed_rpm: float | None = None,
    inertia: float | None = None,
    fmi: int = 2,
    model_name: str | None = None,
    force_lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a rotor with its ball bearings as one FMU for co-simulation, after verification against the rotor.

    Shaft, bearings, balls and films are inside and have the time steps of `simulate_rotor`: no force of a film is
    exchanged between tools. Inputs are forces at named nodes beside the load, as `disc.force_x`, `unbalance[u]`,
    and `speed` [rad/s], or with `inertia` the `torque` of the motor; outputs displacements and rates of named
    nodes, `disc.x`, `disc.velocity_x`, ..., those of the inner rings, `bearing[b].x`, the forces on them and what
    the FMU of `export_bearing` has of balls and films, `bearing[b].force_x`, `bearing[b].largest_load_inner`,
    `bearing[b].smallest_film`, ..., the `angle` of the shaft, and `outside_validity`. Bearings count from 1, each
    in the frame of its mount. `mass_scale`, `stiffness_scale`, `damping_scale`, `load_scale`, `inertia`,
    `speed_start`, and of every bearing `clearance`, `offset`, `cage_angle_start` and `film`, as far as it has
    them, can be set before initialization; the rotor then starts in equilibrium under its load. A step is cut into
    inner ones of at most `inner_step`.

    Parameters
    ----------
    rotor : Rotor
        On ball bearings, as of `rotor_on_bearings`; linear ones may be beside them.
    path : path-like
        File to write, ending in ``.fmu``.
    speeds_rpm, speed_rpm, inertia
        As of `RotorModel`: speeds of the tables and at the start [rev/min], moment of inertia [kg m2].
    force_lead : float, optional
        Start value of `force_lead`, as of `export_jeffcott`; 0 by default.
    fmi, model_name, platforms, overwrite, progress
        As of `export_contact`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        A rotor that `RotorModel` refuses; else as `export_contact`.
    ConvergenceError
        The bearings do not hold the load.
    BuildError, VerificationError
        As `export_contact`.
    """
    return export_verified(
        RotorModel(rotor, speeds_rpm, speed_rpm, inertia),
        path,
        fmi=fmi,
        model_name=model_name,
        lead=force_lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]
