"""Export of a speed controller as an FMU file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from ehlcontact.checks import require_instance
from fmu.binaries.libraries import Progress
from fmu.controller.model import SpeedController
from fmu.export import export_verified


def export_controller(
    controller: SpeedController,
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    model_name: str | None = None,
    lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a speed controller as an FMU for co-simulation, once it is verified against it.

    Inputs are `speed` and `speed_set_point` [rad/s], output is `torque` [N m], the input of the FMU of
    `export_shaft`. The gains and the limit are tunable; `integral_start` is the integral part at the start.

    Parameters
    ----------
    controller : SpeedController
    path : path-like
        File to write, ending in ``.fmu``.
    lead : float, optional
        Start value of `lead`: 1, the default, holds the inputs of the start of a step in it; 0 takes them as
        those of its end, reached straight.
    fmi, model_name, platforms, overwrite, progress
        As of `export_contact`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        No `SpeedController`; else as `export_contact`.
    BuildError, VerificationError
        As `export_contact`.
    """
    require_instance("controller", controller, SpeedController, "a SpeedController")
    return export_verified(
        controller,
        path,
        fmi=fmi,
        model_name=model_name,
        lead=lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]
