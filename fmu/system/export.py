"""Export of a rotor and its contacts as a system archive (SSP)."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import inf, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_positive
from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from fmu.archive import pack
from fmu.binaries import Platform, choose, this_machine
from fmu.binaries.libraries import Progress
from fmu.contact_spec import checked_name
from fmu.export import export_contact, free_target
from fmu.jeffcott.export import export_jeffcott
from fmu.jeffcott.model import JeffcottModel
from fmu.lead import CONTACT, HELD_PARALLEL, force_lead_for
from fmu.sources import FMI_FILES
from fmu.steps import ADDED_DAMPING, damping_at, round_down
from fmu.system.check import ALLOWED, SystemVerification, verify_system
from fmu.system.structure import Component, Connector, Wire, system_structure
from fmu.verify import VerificationError
from reduced_models.rotor.jeffcott import JeffcottRotor

NAME = "rotor on contacts"
FOREIGN_DAMPING = 0.05  # of that of a contact, at the journal's fastest vibration: what the default step may add
LONGEST = 0.1  # default step times that frequency, or the rate at which dampers stop the journal
REVOLUTIONS = 10.0  # of the default experiment
STANDING = 0.1  # [s] of it, where nothing turns


def export_system(
    rotor: JeffcottRotor,
    contacts: Sequence[Any],
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    model_name: str = NAME,
    step: float | None = None,
    lead: float = HELD_PARALLEL,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a rotor and its contacts as a system archive (SSP 1.0), wired and in equilibrium: ready to run.

    Component ``rotor`` is the FMU of `export_jeffcott` without contacts, ``contact_1`` and so on are those of
    `export_contact`, one for each mount: approach and rate go from the rotor to each, its force back. An importer
    gives all components the same step and passes values on after it, as Ecos and the Open Simulation Platform do.

    Nothing is written that is not verified: each FMU against what it was made from, the description against the
    schema of the standard, and the whole, run after a load step, against `simulate_rotor`.

    Parameters
    ----------
    rotor : JeffcottRotor
    contacts : sequence of ContactElement
        One per mount, in SI or as `ScaledContact`; the same element may be there twice. Their states stay.
    path : path-like
        File to write, ending in ``.ssp``.
    fmi : int
        Of the FMUs, 2 or 3; the Open Simulation Platform takes 2.
    model_name : str
        Name of the system.
    step : float, optional
        Of the default experiment [s]; to be set by hand in Ecos. By default one that adds less than 5 % to the
        damping of a contact at the fastest vibration of the journal: 1, 2 or 5 times a power of ten.
    lead : float
        Of the FMUs of the contacts, as for `export_contact`; that of the rotor, `force_lead`, follows from it.
        1.5 is for importers that step all components at once, 0.5 for those that step the rotor first.
    platforms, overwrite, progress
        As for `export_contact`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Not one element in SI per mount, no load to start from or one that the contacts do not carry, or what
        `export_contact` refuses.
    BuildError
        No C compiler, or one that failed.
    VerificationError
        The system differs from the rotor, or `step` is too long for it; nothing is written.
    """
    return export_verified_system(
        JeffcottModel(rotor, contacts),  # with copies of the contacts, in SI
        path,
        fmi=fmi,
        model_name=model_name,
        step=step,
        lead=lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]


def export_verified_system(
    made: JeffcottModel,
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    model_name: str = NAME,
    step: float | None = None,
    lead: float = HELD_PARALLEL,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[Path, SystemVerification | None]:
    """As `export_system`, of a rotor closed with its contacts; returns what was found too.

    None was found where this machine can run no such FMU.
    """
    if isinstance(fmi, bool) or fmi not in FMI_FILES:
        raise InputError("fmi", fmi, "2 or 3")
    if not made.elements:
        raise InputError("contacts", None, f"one per mount, {len(made.rotor.mounts)}")
    checked_name(model_name)
    wanted = choose(platforms, fmi)
    target = free_target(path, overwrite, ".ssp")
    step = default_system_step(made) if step is None else require_positive("step", step)
    system = _System(made, model_name, step, CONTACT.check(lead), fmi)
    content = system.archive(wanted, progress)
    own = this_machine()
    found = None
    if own is not None and own.folder(fmi) is not None:
        # A system for other machines is verified by this one's binaries of the same sources.
        found = _require_verified(content if own in wanted else system.archive((own,), None), system)
    free_target(path, overwrite, ".ssp")  # still
    return write_bytes(target, content), found


def default_system_step(made: JeffcottModel) -> float:
    """A step [s] that leaves the contacts their damping, 1, 2 or 5 times a power of ten.

    Contacts extrapolate the motion of the rotor, which adds about 2.4 K h (w h)^4 to the damping of a vibration of
    w; the fastest is that of the journal on the contacts. Such a loop is stable up to w h = 0.57, and as long as h
    resolves how fast their dampers alone would stop the journal.
    """
    rotor, contacts = made.rotor, made.elements
    approaches = rotor.approaches(made.state.journal).tolist()
    pairs = list(zip(contacts, approaches, strict=True))
    K = np.array([float(element.spring_tangent(u)) for element, u in pairs])
    forces = [float(element.spring(u)) for element, u in pairs]
    C = np.array([damping_at(one, f) if f > 0.0 else 0.0 for one, f in zip(contacts, forces, strict=True)])
    w = sqrt(_fastest(rotor, K, rotor.shaft_stiffness))
    rate = max(w, _fastest(rotor, C, rotor.shaft_damping))
    times = C[C > 0.0] / K[C > 0.0]
    h = (FOREIGN_DAMPING / ADDED_DAMPING * float(times.min(initial=inf)) / w**4) ** 0.2
    return round_down(min(h, LONGEST / rate))


def _fastest(rotor: JeffcottRotor, of_contacts: NDArray[np.float64], of_shaft: float) -> float:
    """Largest eigenvalue of stiffness or damping over the mass of the journal."""
    normals = rotor.normals
    matrix = rotor.bearings * (normals.T * of_contacts) @ normals + of_shaft * np.eye(len(rotor.axes))
    return float(np.linalg.eigvalsh(matrix)[-1]) / rotor.journal_mass


def _require_verified(content: bytes, system: _System) -> SystemVerification:
    found = verify_system(content, system.made, system.step, serial=system.lead < 1.0)
    if not found.passes:
        off = f"the journal is {found.deviation:.2g} of its way after a load step off, allowed {ALLOWED:g}"
        reason = "; ".join(found.findings) or f"{off}, at steps of {system.step:g} s"
        raise VerificationError(f"the system is not what it was made from: {reason}")
    return found


@dataclass(frozen=True, slots=True)
class _System:
    """What goes into an archive."""

    made: JeffcottModel
    name: str
    step: float
    lead: float
    fmi: int

    def archive(self, platforms: Sequence[Platform], progress: Progress | None) -> bytes:
        """All of it, its FMUs verified one by one."""
        fmi, names = self.fmi, [one.name for one in platforms]
        with tempfile.TemporaryDirectory(prefix="ehlcontact-system-", ignore_cleanup_errors=True) as folder:
            files = {part: Path(folder, f"{part}.fmu") for part in self._parts}
            parts = iter(_shared(progress, len(files)))
            export_jeffcott(
                self.made.rotor,
                files["rotor"],
                start=self.made.state,
                force_lead=force_lead_for(self.lead),
                fmi=fmi,
                model_name="rotor",
                platforms=names,
                progress=next(parts),
            )
            for part, element in zip(self._parts[1:], self.made.elements, strict=True):
                export_contact(
                    element,
                    files[part],
                    fmi=fmi,
                    model_name=part,
                    lead=self.lead,
                    platforms=names,
                    progress=next(parts),
                )
            content = {f"resources/{part}.fmu": file.read_bytes() for part, file in files.items()}
            return pack(content | {"SystemStructure.ssd": self._description(files)})

    @property
    def _parts(self) -> tuple[str, ...]:
        return ("rotor", *(f"contact_{k}" for k, _ in enumerate(self.made.elements, start=1)))

    def _description(self, files: dict[str, Path]) -> bytes:
        approaches = self.made.rotor.approaches(self.made.state.journal).tolist()
        forces = [float(element.spring(u)) for element, u in zip(self.made.elements, approaches, strict=True)]
        starts = [{f"force[{k}]": force for k, force in enumerate(forces, start=1)}]
        starts += [{"approach": u, "rate": 0.0} for u in approaches]
        components = [
            Component(part, f"resources/{part}.fmu", connectors(files[part]), values)
            for part, values in zip(self._parts, starts, strict=True)
        ]
        wires = []
        for k, part in enumerate(self._parts[1:], start=1):
            wires += [Wire(("rotor", f"{what}[{k}]"), (part, what)) for what in ("approach", "rate")]
            wires.append(Wire((part, "force"), ("rotor", f"force[{k}]")))
        w = self.made.rotor.omega
        stop = float(f"{REVOLUTIONS * 2.0 * pi / w if w > 0.0 else STANDING:.6g}")
        text = "Jeffcott rotor on rolling contacts, in SI units; values are passed on after each step"
        return system_structure(self.name, components, wires, step=self.step, stop=stop, description=text)


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
