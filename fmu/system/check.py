"""Verification of a system archive before it is written: schema, and a load step against `simulate_rotor`."""

from __future__ import annotations

import io
import warnings
import zipfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.errors import ConvergenceError
from fmu.system.master import DESCRIPTION, SystemRun
from fmu.verify import VerificationError
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState
from reduced_models.rotor.simulate import simulate_rotor

LOAD_STEP = 0.1  # of the static load on the disc, along it and across
STEPS = 400  # of the check
ALLOWED = 0.01  # deviation of the journal, over how far the load step moves it


@dataclass(frozen=True, slots=True)
class SystemVerification:
    """Result of `verify_system`."""

    findings: tuple[str, ...]  # of the schema of the standard
    deviation: float  # of the journal from `simulate_rotor` after a load step, over how far it moves
    step: float  # of either [s]

    @property
    def passes(self) -> bool:
        """No finding, and the journal where it should be."""
        return not self.findings and self.deviation <= ALLOWED

    def to_dict(self) -> dict[str, Any]:
        """All fields and the verdict, for storage."""
        return asdict(self) | {"passes": self.passes}


def verify_system(
    content: bytes,
    rotor: JeffcottRotor,
    elements: Sequence[Any],
    state: RotorState,
    step: float,
    *,
    serial: bool = False,
) -> SystemVerification:
    """Hold an archive against the schema, and run it beside the Python rotor from equilibrium.

    At the start a force comes on the disc, a tenth of the static load along it and across, where the rotor moves
    that way; compared is the journal over 400 steps. `serial`: the rotor steps first, then its contacts.

    Raises
    ------
    VerificationError
        It does not run.
    """
    findings = schema_findings(content)
    push = _push(rotor)
    names = [f"disc.force_{'xy'[axis]}" for axis in rotor.axes]
    watched = [("rotor", f"journal.{'xy'[axis]}") for axis in rotor.axes]
    try:
        forces = dict(zip(names, push[list(rotor.axes)].tolist(), strict=True))
        with SystemRun(content, {"rotor": forces}, serial=serial) as run:
            ours = run.run(step, STEPS, watched)
    except Exception as error:  # fmpy raises bare Exception among others, also for a call that an FMU refuses
        raise VerificationError(f"the system does not run at steps of {step:g} s: {error}") from None
    pushed = replace(rotor, load=tuple((np.array(rotor.load) + push).tolist()))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of leaving the box, which is no matter of this comparison
        try:
            found = simulate_rotor(
                pushed,
                resting(rotor, elements, state),
                dt=step,
                until=STEPS * step,
                start=state,
                tolerance=1e-9,
            )
        except ConvergenceError as error:
            raise VerificationError(f"the rotor itself does not run at steps of {step:g} s: {error}") from None
    theirs = found.journal[: STEPS + 1, list(rotor.axes)]
    moved = float(np.abs(theirs - theirs[0]).max())
    deviation = float(np.abs(ours - theirs).max()) / moved if moved > 0.0 else float("inf")
    return SystemVerification(findings, deviation if np.isfinite(deviation) else float("inf"), step)


def resting(rotor: JeffcottRotor, elements: Sequence[Any], state: RotorState) -> list[Any]:
    """Copies of the contacts, at rest where the system starts."""
    copies = [element.copy() for element in elements]
    for contact, approach in zip(copies, rotor.approaches(state.journal).tolist(), strict=True):
        contact.rest(approach)
    return copies


def _push(rotor: JeffcottRotor) -> np.ndarray:
    """Force on the disc [N], shape (2,), that moves the journal in every direction it has."""
    load = np.array(rotor.gravity) * (rotor.disc_mass + rotor.journal_mass) + np.array(rotor.load)
    across = np.array([-load[1], load[0]])
    push = LOAD_STEP * (load + across)
    push[[axis for axis in (0, 1) if axis not in rotor.axes]] = 0.0
    return push


def schema_findings(content: bytes) -> tuple[str, ...]:
    """Violations of the schema of SSP 1.0 (shipped with fmpy) in the description of an archive."""
    import fmpy.ssp
    from lxml import etree

    schema = etree.XMLSchema(
        file=str(Path(fmpy.ssp.__file__).parent / "schema" / "SystemStructureDescription.xsd")
    )
    values = etree.XMLSchema(
        file=str(Path(fmpy.ssp.__file__).parent / "schema" / "SystemStructureParameterValues.xsd")
    )
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        root = etree.fromstring(archive.read(DESCRIPTION))
    schema.validate(root)
    findings = [str(entry.message) for entry in schema.error_log]
    for inner in root.iter("{http://ssp-standard.org/SSP1/SystemStructureParameterValues}ParameterSet"):
        values.validate(inner)
        findings += [str(entry.message) for entry in values.error_log]
    return tuple(findings)
