"""Export of a contact element or a rotor as an FMU file: model, files, verification, archive."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from ehlcontact.errors import InputError
from ehlcontact.files import require_writable, write_bytes
from fmu.archive import fmu_files, pack
from fmu.binaries import choose, this_machine
from fmu.binaries.libraries import Progress
from fmu.contact_variables import Element
from fmu.fmu_model import Source, fmu_model
from fmu.sources import FMI_FILES
from fmu.verification import Verification
from fmu.verify import require_finite, require_verified


def export_contact(
    element: Element,
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    model_name: str | None = None,
    lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a contact element as an FMU for co-simulation and model exchange, once it is verified against it.

    Inputs `approach` and `rate`, output `force` with its tangents `stiffness` and `damping`, and
    `outside_validity` with the bound that is left. Coefficients of elements without memory, and their interval,
    are tunable parameters that start at the element's values; those of a film memory are constants, for others
    could put energy into a vibration. The fixed parameter `lead` is the time, in communication
    steps, from the inputs of a step to that for which the force is given: see `lead` below. Units are the
    element's: SI, or "1" for a dimensionless element. Reference inputs and results of the element are inside, for
    `verify_references`. The same element, name, library version and compiler give the same bytes.

    Parameters
    ----------
    element : ContactElement
        Of any kind.
    path : path-like
        File to write, ending in ``.fmu``.
    fmi : int
        FMI version, 2 or 3.
    model_name : str, optional
        Name of the model; the kind of the element, as CubicContact, by default.
    lead : float, optional
        Start value of `lead`, 0 to 2 communication steps; 1.5 by default. What is right depends on what the force
        is given to: 1.5 for a mass that holds the force over its step while master and FMU step in parallel, which
        is what most co-simulation tools do, 1 if it advances by symplectic Euler; 0.5 and 0 for the same where the
        FMU is given the motion of the end of the step (serial masters). A wrong value costs the damping C as much
        as stiffness times step times the difference: ``docs/coupling.md``.
    platforms : str or iterable of str, optional
        For which the FMU has binaries: ``x86_64-linux``, ``x86_64-windows``, ``x86_64-darwin``,
        ``aarch64-darwin`` (in FMI 3 ``aarch64-linux`` as well), or ``all``; also by the names of FMI 2,
        ``linux64``, ``win64`` and ``darwin64``, which is both Macs. This machine's by default.
    overwrite : bool
        Whether a file of that name may be replaced.
    progress : callable, optional
        Called with (libraries compiled, libraries in all).

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Another kind of element or FMI version, a name that is not printable, an unknown platform, a file that
        is there already or cannot be written.
    BuildError
        No C compiler, or one that failed.
    VerificationError
        The FMU differs from the element; nothing is written.

    Notes
    -----
    This machine's binary is compiled by the system's ``cc``, or by ``ziglang`` where there is none or the result
    would need a glibc newer than 2.17; all others by ``ziglang``, the first one for Windows in two minutes. As
    many are compiled at a time as there are processors.
    ``EHLCONTACT_CC`` names another compiler for this machine. Libraries are kept in the user's cache folder, or in
    ``EHLCONTACT_CACHE``, by their sources, flags and compiler.
    """
    return export_verified(
        element,
        path,
        fmi=fmi,
        model_name=model_name,
        lead=lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]


def export_verified(
    element: Source,
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    model_name: str | None = None,
    lead: float | None = None,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[Path, Verification | None]:
    """Export an element or rotor; returns file and verification (None if this machine cannot run the FMU)."""
    if isinstance(fmi, bool) or fmi not in FMI_FILES:
        raise InputError("fmi", fmi, "2 or 3")
    model = fmu_model(element, model_name, lead)
    require_finite(model)
    wanted = choose(platforms, fmi)
    target = free_target(path, overwrite)  # before compiling
    references = model.references()
    files = fmu_files(model.spec, wanted, fmi, progress, references)
    found = None
    own = this_machine()
    if own is not None and own.folder(fmi) is not None:
        # An FMU for other machines is verified by this one's binary of the same sources.
        runnable = files if own in wanted else fmu_files(model.spec, (own,), fmi, references=references)
        found = require_verified(pack(runnable), model)
    free_target(path, overwrite)  # still
    return write_bytes(target, pack(files)), found


def free_target(path: str | os.PathLike[str], overwrite: bool, suffix: str = ".fmu") -> Path:
    """Path of a file to write; raises `InputError` if it cannot be written or exists."""
    target = Path(path)
    require_writable("path", target, (suffix,))
    if target.exists() and not overwrite:
        raise InputError("path", str(path), "a new file, or replaced with overwrite=True")
    return target
