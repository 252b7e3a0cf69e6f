"""Check of a system archive before it is written: its result, and the schema of the standard."""

from __future__ import annotations

import io
import zipfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ehlcontact.summary import Summary
from fmu.system.master import DESCRIPTION
from fmu.verification import findings_text

STEPS = 400  # of the check


@dataclass(frozen=True, slots=True)
class SystemVerification(Summary):
    """Result of `RotorSystem.verify`."""

    findings: tuple[str, ...]  # of the schema of the standard
    deviation: float  # of the motions at the supports from `simulate_rotor`, over their way
    step: float  # of either [s]
    allowed: float  # deviation that passes

    @property
    def passes(self) -> bool:
        """No finding, and the rotor where it should be."""
        return not self.findings and self.deviation <= self.allowed

    def _summary_lines(self) -> list[str]:
        return [
            f"{'passes' if self.passes else 'fails'}: rotor and supports wired, and each FMU by itself",
            f"motion at the supports {self.deviation:.2g} off, over its way; {self.allowed:.2g} is allowed",
            f"at a step of {self.step:g} s; longer ones damp more, and blow up in the end",
            *findings_text(self.findings),
        ]

    def to_dict(self) -> dict[str, Any]:
        """All fields and the verdict, for storage."""
        return asdict(self) | {"passes": self.passes}


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
