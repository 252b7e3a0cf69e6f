"""Export of a Jeffcott rotor as an FMU file."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from fmu.binaries.libraries import Progress
from fmu.export import export_verified
from fmu.jeffcott.model import JeffcottModel
from reduced_models import JeffcottRotor
from reduced_models.rotor.jeffcott import RotorState


def export_jeffcott(
    rotor: JeffcottRotor,
    path: str | os.PathLike[str],
    contacts: Sequence[Any] | None = None,
    *,
    start: RotorState | None = None,
    fmi: int = 2,
    model_name: str | None = None,
    force_lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a Jeffcott rotor as an FMU for co-simulation and model exchange, once it is verified against it.

    Inputs are `unbalance`, `speed` [rad/s], `angular_acceleration`, and further forces on journal and disc,
    `journal_force_x`, ..., `disc_force_y`; outputs positions and velocities of both, `journal_x`,
    `journal_velocity_x`, `disc_x`, ..., and `approach[i]` and `rate[i]` of every mount. `disc_mass`,
    `journal_mass`, `shaft_stiffness`, `shaft_damping` and `disc_damping` can be set before initialization.
    Without contacts their forces are inputs too, `force[i]`, as the FMU of a contact gives them: connect the two
    to close the rotor. With contacts they are inside, steps are balanced by Newton's method, and `force[i]` are
    outputs, of one bearing. In co-simulation a step is cut into inner ones of at most `inner_step`, a fixed
    parameter that resolves shaft and contacts by default: generalised-alpha steps, those of `simulate_rotor`.
    Start values of positions and velocities can be set; where they are not, the rotor starts in equilibrium with
    the parameters that are set.

    Parameters
    ----------
    rotor : JeffcottRotor
    path : path-like
        File to write, ending in ``.fmu``.
    contacts : sequence of ContactElement, optional
        One per mount, in SI or as `ScaledContact`, of any kind; their films start at rest.
    start : RotorState, optional
        Where it starts: by default at its static equilibrium; without contacts, with the journal at the origin and
        the shaft bent by the static load.
    force_lead : float, optional
        Start value of the parameter `force_lead`: the forces given are those of the time `force_lead`
        communication steps after the start of the step, 0 to 1. By default 1/2 without contacts, for the FMUs of
        contacts give those of the middle of the step, and 0 with them.
    fmi, model_name, platforms, overwrite, progress
        As of `export_contact`.

    Returns
    -------
    Path
        The file.

    Elements warn here where the rotor's speed lies outside their band, or they were made for another contact.

    Raises
    ------
    InputError
        Contacts that do not fit the mounts, are no elements, not in SI, or do not carry the static load; else as
        `export_contact`.
    BuildError, VerificationError
        As `export_contact`.
    """
    model = JeffcottModel(rotor, contacts, start)
    rotor.check([element.copy() for element in model.elements], stacklevel=3)
    return export_verified(
        model,
        path,
        fmi=fmi,
        model_name=model_name,
        lead=force_lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]
