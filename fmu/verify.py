"""Verification of an FMU against fmpy's rules and, state by state, against its Python element."""

from __future__ import annotations

import os
import shutil
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from textwrap import shorten
from typing import Any

from ehlcontact.errors import InputError
from ehlcontact.summary import WIDTH, Summary
from fmu.comparison import Comparison, compare_film, compare_spring
from fmu.contact_variables import Element, Film
from fmu.driver import Exchange, Slave
from fmu.rotor.comparison import compare_rotor
from fmu.rotor.model import RotorModel
from fmu.rotor.variables import spec_of
from fmu.spec import ModelSpec

TOLERANCE = 1e-12
ORBIT = 1e-6  # of a rotor's motion: both balance their contacts to a billionth of the load in every step


@dataclass(frozen=True, slots=True)
class Verification(Summary):
    """Result of `verify`; differences are relative.

    Attributes
    ----------
    findings : tuple of str
        Of fmpy's validation, and start values or units unlike the element's.
    states : int
        Compared.
    outside, parted : int
        Of these, with the approach outside the validity interval, and with no force.
    force : float
        Largest difference of the force.
    tangents : float
        Of stiffness and damping, those of a step too.
    derivatives : float
        Of the directional derivatives of the force.
    flags : int
        States where outside_validity is wrong.
    exchange : float
        Largest difference in model exchange: force, and derivatives of the states.
    motion : float
        Of a rotor's run, largest difference over the largest of its motion.
    """

    findings: tuple[str, ...]
    states: int
    outside: int
    parted: int
    force: float
    tangents: float
    derivatives: float
    flags: int
    exchange: float = 0.0
    motion: float = 0.0

    @property
    def passes(self) -> bool:
        """No finding, and all differences within rounding."""
        differences = max(self.force, self.tangents, self.derivatives, self.exchange)
        return not self.findings and self.flags == 0 and differences <= TOLERANCE and self.motion <= ORBIT

    def _summary_lines(self) -> list[str]:
        largest = f"force {self.force:.2g}, tangents {self.tangents:.2g}, derivatives {self.derivatives:.2g}"
        lines = [
            f"{'passes' if self.passes else 'fails'}: {self.states} states compared, {self.outside} of them "
            f"outside the validity interval, {self.parted} without force",
            f"largest differences: {largest}, model exchange {self.exchange:.2g}; {TOLERANCE:g} is allowed",
        ]
        if self.motion:
            lines.append(f"motion of the rotor {self.motion:.2g}, over its largest; {ORBIT:g} is allowed")
        if self.flags:
            lines.append(f"outside_validity is wrong in {self.flags} states")
        return [*lines, *findings_text(self.findings)]

    def to_dict(self) -> dict[str, Any]:
        """All fields and the verdict, for storage."""
        return asdict(self) | {"passes": self.passes}


def findings_text(findings: tuple[str, ...]) -> list[str]:
    """The first finding in a line, and how many there are; no line where there is none."""
    if not findings:
        return []
    more = f" (and {len(findings) - 1} more)" if len(findings) > 1 else ""
    return [f"finding: {shorten(findings[0], WIDTH - len(more), placeholder=' ...')}{more}"]


def verify(path: str | os.PathLike[str], element: Element | RotorModel) -> Verification:
    """Run the FMU through fmpy and compare it with the element.

    Without memory: one step of co-simulation each for a grid of approaches (inside, below and above the validity
    interval, lift-off included) and rates (both signs, up to where the damper alone cancels the force), and the
    same states in model exchange. With a memory: a motion with lift-off and a pulse of load, in steps from 1e-3 to
    1 of 2a/u_sum, against `drive`, and the film's states along it in model exchange against `state_rates`.
    A rotor: a short run with an unbalance that shows, against `simulate_rotor`, and its accelerations along it.

    A difference is relative to the magnitude of what is compared, with 1e-3 of its value at the upper end of the
    interval (under the reference load) as the floor, for a number that cancels to nearly nothing has no relative
    error to speak of.

    Parameters
    ----------
    path : path-like
        The FMU.
    element : ContactElement or RotorModel
        What it should be; ``RotorModel(rotor, contacts)`` for what `export_rotor` makes of these.

    Raises
    ------
    InputError
        Not an FMU of such an element or rotor for this platform.

    See Also
    --------
    fmu.verify_references : without an element, against the reference results inside the FMU.
    """
    file = Path(path)
    spec_of(element)  # first of all, whether it is one
    with opened(file) as (folder, description):
        return verify_opened(file, folder, description, element)


def verify_opened(file: Path, folder: str, description: Any, element: Element | RotorModel) -> Verification:
    """`verify` of an unpacked FMU."""
    from fmpy.validation import validate_fmu

    spec = spec_of(element)
    known = _known_variables(description, spec, file)
    findings = (*validate_fmu(str(file)), *_declarations(spec, known))
    with running(file, folder, description) as (slave, exchange):
        if isinstance(element, RotorModel):
            found = compare_rotor(slave, exchange, element, spec)
        elif isinstance(element, Film):
            found = compare_film(slave, exchange, element, spec)
        else:
            found = compare_spring(slave, exchange, element, spec)
    return _verdict(findings, found)


def _verdict(findings: tuple[str, ...], found: Comparison) -> Verification:
    return Verification(findings=findings, **asdict(found))


@contextmanager
def running(file: Path, folder: str, description: Any) -> Iterator[tuple[Any, Any]]:
    """Instances for co-simulation and model exchange (None without the interface), freed at the end."""
    made: list[Any] = []
    messages: list[str] = []
    try:
        with chdir(Path.cwd()):  # fmpy leaves the process in another folder when a library does not load
            for kind in (Slave, Exchange):
                there = getattr(description, kind.section) is not None
                made.append(kind(folder, description, messages) if there else None)
    except Exception as error:  # fmpy raises bare Exception among others
        _free(made)
        reason = " ".join([str(error), *messages])
        raise InputError("path", str(file), f"an FMU that can be instantiated ({reason})") from None
    try:
        yield made[0], made[1]
    finally:
        _free(made)


def _free(made: list[Any]) -> None:
    for instance in filter(None, made):
        instance.free()


@contextmanager
def opened(file: Path) -> Iterator[tuple[str, Any]]:
    """Extract an FMU into a temporary folder; yields the folder and the model description.

    Raises
    ------
    InputError
        Not a readable FMU for this platform.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            names = set(archive.namelist())
    except (OSError, ValueError, zipfile.BadZipFile) as error:
        raise InputError("path", str(file), f"a readable FMU ({' '.join(str(error).split())})") from None
    if "modelDescription.xml" not in names:
        system = "SystemStructure.ssd" in names
        reason = "a system archive, with FMUs in its resources/" if system else "no modelDescription.xml in it"
        raise InputError("path", str(file), f"a readable FMU ({reason})")
    import fmpy

    folder = tempfile.mkdtemp(prefix="ehlcontact-verify-")
    try:
        try:
            fmpy.extract(str(file), unzipdir=folder)
            description = fmpy.read_model_description(folder, validate=False)
        except Exception as error:  # fmpy raises bare Exception among others
            reason = " ".join(str(error).split()) or type(error).__name__
            raise InputError("path", str(file), f"a readable FMU ({reason})") from None
        # not fmpy.supported_platforms, which knows no Linux on arm
        there = {path.name for path in Path(folder, "binaries").glob("*")}
        if description.coSimulation is None or not {fmpy.platform, fmpy.platform_tuple} & there:
            raise InputError("path", str(file), f"an FMU for co-simulation on {fmpy.platform}")
        yield folder, description
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _known_variables(description: Any, spec: ModelSpec, file: Path) -> dict[str, Any]:
    """Variables of the FMU by name; raises `InputError` if one of the element's is missing."""
    known = {variable.name: variable for variable in description.modelVariables}
    for variable in spec.variables:
        if variable.name not in known or known[variable.name].valueReference != variable.value_reference:
            raise InputError(
                "path",
                str(file),
                "an FMU of this kind of element or rotor, made by export_contact or export_rotor",
            )
    return known


def _declarations(spec: ModelSpec, known: dict[str, Any]) -> tuple[str, ...]:
    """Findings: variables whose unit or start value differs from the element's."""
    found = []
    for variable in spec.variables:
        declared = known[variable.name]
        start = None if declared.start is None else float(declared.start)
        if (declared.unit, start) != (variable.unit, variable.start):
            found.append(
                f"{variable.name}: start {start} [{declared.unit}] in the FMU, "
                f"{variable.start} [{variable.unit}] in the element"
            )
    return tuple(found)
