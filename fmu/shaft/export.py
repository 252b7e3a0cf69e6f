"""Export of a shaft as an FMU file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from fmu.binaries.libraries import Progress
from fmu.export import export_verified
from fmu.shaft.model import ShaftModel
from reduced_models.rotor.rotor import Rotor


def export_shaft(
    rotor: Rotor,
    path: str | os.PathLike[str],
    *,
    speed_rpm: float = 0.0,
    inertia: float | None = None,
    torque: float = 0.0,
    start: Any = None,
    fmi: int = 2,
    model_name: str | None = None,
    force_lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a rotor without its ball bearings as an FMU for co-simulation, once it is verified against it.

    Bearing `b` of the rotor, counted from 1, is a port: outputs `bearing[b].x`, ..., `bearing[b].velocity_x`, ...
    are the motions of its inner ring, inputs `bearing[b].force_x`, ... the forces on it, named and directed as in
    the FMU of `export_bearing`, of either facing. `unbalance[u]` are inputs. With `inertia` the inputs `torque`,
    of the motor, and `bearing[b].rolling_torque` decide on the output `speed` [rad/s]; without it `speed` is an
    input. Further outputs are the `angle` of the shaft and the motions of named nodes, as `disc.x`. `mass_scale`,
    `stiffness_scale`, `damping_scale`, `load_scale`, `inertia` and `speed_start` can be set before initialization.

    Parameters
    ----------
    rotor : Rotor
        On bearings; linear ones stay inside.
    path : path-like
        File to write, ending in ``.fmu``.
    speed_rpm, inertia, torque, start
        As of `ShaftModel`: speed at the start [rev/min], moment of inertia [kg m2], torque [N m], motion.
    force_lead : float, optional
        Start value of `force_lead`, as of `export_jeffcott`; 1/2 by default, for bearings give forces of the
        middle of the step.
    fmi, model_name, platforms, overwrite, progress
        As of `export_contact`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        A rotor that `ShaftModel` refuses; else as `export_contact`.
    ConvergenceError
        The bearings do not hold the load.
    BuildError, VerificationError
        As `export_contact`.
    """
    return export_verified(
        ShaftModel(rotor, speed_rpm, inertia, torque, start),
        path,
        fmi=fmi,
        model_name=model_name,
        lead=force_lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]
