"""Export of a ball bearing as an FMU file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from fmu.bearing.model import BearingModel
from fmu.binaries.libraries import Progress
from fmu.export import export_verified
from reduced_models import BallBearing


def export_bearing(
    bearing: BallBearing,
    path: str | os.PathLike[str],
    *,
    speeds_rpm: Any,
    load: Any = None,
    freedoms: int | None = None,
    fmi: int = 2,
    model_name: str | None = None,
    lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a ball bearing as an FMU, once it is verified against it.

    It is for co-simulation and for model exchange, with exact partial derivatives.

    Inputs are displacement and velocity of the inner ring against the outer one, `x`, `y` and, with five degrees
    of freedom, `z`, `tilt_x`, `tilt_y`; `velocity_x`, ..., `tilt_rate_y`; and the `speed` of the shaft [rad/s].
    Outputs are the forces on the inner ring, `force_x`, ..., `moment_y`, the largest loads of a ball, the
    smallest film and lambda, the rolling torque and the angle of the cage. Loads, films and contact angles of
    every ball are local variables. `clearance`, `offset` (axial preload), `cage_angle_start` and `film` (0: dry)
    can be set before initialization. The FMU starts at rest where its inputs are then. In a step balls move as in
    `BearingMotion`: in equilibrium, with the memory of every film. The states of model exchange, which can be read
    in co-simulation as well, are the angle of the cage, places of balls (`ball[k].w`, with five degrees of
    freedom `ball[k].a` too) and what films and rings remember.

    Parameters
    ----------
    bearing : BallBearing
    path : path-like
        File to write, ending in ``.fmu``.
    speeds_rpm : float or (float, float)
        Speed of the shaft [rev/min], or lowest and highest one. Below the lowest films are those of the lowest,
        down to standstill.
    load, freedoms
        As of `BearingModel`: force under which the FMU starts, and whether the ring has z and tilts.
    lead : float, optional
        Start value of `lead`, as of `export_contact`: 1.5 by default, for masses that hold the force over their
        step.
    fmi, model_name, platforms, overwrite, progress
        As of `export_contact`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Speeds or a load that the bearing does not take; else as `export_contact`.
    BuildError, VerificationError
        As `export_contact`.
    """
    return export_verified(
        BearingModel(bearing, speeds_rpm, load, freedoms),
        path,
        fmi=fmi,
        model_name=model_name,
        lead=lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]
