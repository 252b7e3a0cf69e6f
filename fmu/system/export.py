"""Export of a rotor and its supports as a system archive (SSP)."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ehlcontact.binaries import Platform, choose, this_machine
from ehlcontact.binaries.libraries import Progress
from ehlcontact.checks import require_positive
from ehlcontact.checks.kinds import FILE, PROGRESS
from ehlcontact.checks.quantity import takes
from ehlcontact.files import write_bytes
from fmu.archive import pack
from fmu.contact_spec import checked_name
from fmu.export import export_model, free_target, require_version
from fmu.lead import CONTACT, HELD_PARALLEL
from fmu.models import fmu_model
from fmu.system.check import SystemVerification
from fmu.system.parts import RotorSystem
from fmu.system.structure import Component, Connector, Wire, system_structure
from reduced_models import Rotor

ROTOR = "rotor"  # name of its component


@takes(path=FILE, progress=PROGRESS)
def export_system(
    rotor: Rotor,
    path: str | os.PathLike[str],
    *,
    speeds_rpm: Any = None,
    speed_rpm: float | None = None,
    inertia: float | None = None,
    start: Any = None,
    fmi: int = 2,
    model_name: str | None = None,
    step: float | None = None,
    lead: float = HELD_PARALLEL,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a rotor and its supports as a system archive (SSP 1.0), wired and in equilibrium: ready to run.

    Component ``rotor`` is the FMU of the rotor with all supports outside; ``contact_1``, ... or ``bearing_1``, ...
    are those of the supports: motions go from the rotor to each, its forces back. An importer gives all components
    the same step and passes values on after it, as Ecos and the Open Simulation Platform do. With `inertia` the
    rolling torques of bearings go back too, the speed goes to them, and the input `torque` of the rotor is free.

    Nothing is written that is not verified: each FMU against what it was made from, the description against the
    schema of the standard, and the whole against `simulate_rotor`: in a run at the speed that it has, on
    contacts after a load step.

    Parameters
    ----------
    rotor : Rotor
        On ball bearings, or contacts that are elements, in SI; the same element may be there
        twice, and its state stays. Linear bearings stay inside.
    path : path-like
        File to write, ending in ``.ssp``.
    speeds_rpm, speed_rpm, inertia, start : optional
        As of `export`; `speeds_rpm` for ball bearings.
    fmi : int
        Of the FMUs, 2 or 3; the Open Simulation Platform takes 2.
    model_name : str, optional
        Name of the system.
    step : float, optional
        Of the default experiment [s]; to be set by hand in Ecos. By default 1, 2 or 5 times a power of ten: at
        most a tenth of 1/w for the fastest vibration w on the supports, and one that adds less than 5 % to the
        damping of a contact there.
    lead : float
        Of the FMUs of the supports, as for `export`; that of the rotor, `force_lead`, follows from it.
        1.5 is for importers that step all components at once, 0.5 for those that step the rotor first.
    platforms, overwrite, progress
        As for `export`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        A contact that is no element, no load to start from or one that the supports do not carry, or what `export`
        refuses.
    BuildError
        No C compiler, or one that failed.
    VerificationError
        The system differs from the rotor, or `step` is too long for it; nothing is written.
    """
    keywords = {"speeds_rpm": speeds_rpm, "speed_rpm": speed_rpm, "inertia": inertia, "start": start}
    return export_verified_system(
        RotorSystem.of(rotor, **keywords),
        path,
        fmi=fmi,
        model_name=model_name,
        step=step,
        lead=lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]


@takes(path=FILE, progress=PROGRESS)
def export_verified_system(
    made: RotorSystem,
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    model_name: str | None = None,
    step: float | None = None,
    lead: float = HELD_PARALLEL,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[Path, SystemVerification | None]:
    """As `export_system`; returns the verification too, None where this machine can run no such FMU."""
    require_version(fmi)
    name = checked_name(made.name if model_name is None else model_name)
    wanted = choose(platforms, fmi)
    target = free_target(path, overwrite, ".ssp")
    step = made.default_step() if step is None else require_positive("step", step)
    system = _System(made, name, step, CONTACT.check(lead), fmi)
    content = system.archive(wanted, progress)
    own = this_machine()
    verification = None
    if own is not None and own.folder(fmi) is not None:
        # A system for other machines is verified by this one's binaries of the same sources.
        tried = content if own in wanted else system.archive((own,), None)
        verification = made.require_verified(tried, step, serial=lead < 1.0)
    free_target(path, overwrite, ".ssp")  # still
    return write_bytes(target, content), verification


@dataclass(frozen=True, slots=True)
class _System:
    """What goes into an archive."""

    made: RotorSystem
    name: str
    step: float
    lead: float
    fmi: int

    def archive(self, platforms: Sequence[Platform], progress: Progress | None) -> bytes:
        """All of it, its FMUs verified one by one; equal supports share one."""
        parts = self.made.parts(self.lead)
        sources = {part.source: part for part in reversed(parts)}
        of_each = iter(_shared(progress, len(sources)))
        names = [platform.name for platform in platforms]
        with tempfile.TemporaryDirectory(prefix="ehlcontact-system-", ignore_cleanup_errors=True) as folder:
            files = {}
            for source in dict.fromkeys(part.source for part in parts):
                part = sources[source]
                model = fmu_model(part.model, model_name=source, **part.keywords)
                file = Path(folder, f"{source}.fmu")
                export_model(model, file, fmi=self.fmi, platforms=names, progress=next(of_each))
                files[source] = file
            content = {f"resources/{file.name}": file.read_bytes() for file in files.values()}
            return pack(content | {"SystemStructure.ssd": self._description(files)})

    def _description(self, files: dict[str, Path]) -> bytes:
        ports = {source: connectors(file) for source, file in files.items()}
        components, wires = [], []
        for part in self.made.parts(self.lead):
            components.append(
                Component(part.name, f"resources/{part.source}.fmu", ports[part.source], part.starts)
            )
            there = {port.name for port in ports[part.source]}
            wires += [Wire((ROTOR, given), (part.name, taken)) for given, taken in part.motions]
            wires += [Wire((part.name, given), (ROTOR, taken)) for given, taken in part.forces if given in there]
        return system_structure(
            self.name, components, wires, step=self.step, stop=self.made.stop, description=self.made.description
        )


def connectors(file: Path) -> tuple[Connector, ...]:
    """Real inputs and outputs of an FMU."""
    import fmpy

    return tuple(
        Connector(variable.name, variable.causality, variable.unit or "1")
        for variable in fmpy.read_model_description(str(file), validate=False).modelVariables
        if variable.causality in ("input", "output") and variable.type in ("Real", "Float64")
    )


def _shared(progress: Progress | None, count: int) -> list[Progress | None]:
    """Progress of each of several exports as part of the whole."""
    if progress is None:
        return [None] * count
    whole = progress

    def part(k: int) -> Progress:
        return lambda done, total: whole(k * total + done, count * total)

    return [part(k) for k in range(count)]
