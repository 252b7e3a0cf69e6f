"""Verification of an FMU against the references inside it, without element or rotor."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.summary import Summary
from fmu.description_rules import findings
from fmu.fmu_file import FmuFile, opened
from fmu.isolated import isolated, require_path
from fmu.references.files import POINTS, STEPS, changed_files, read_references
from fmu.references.series import References, Trial, visit, walk
from fmu.verification import findings_text

_Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Interface:
    """Comparison of one FMI interface of an FMU with its references."""

    name: str  # co-simulation, model exchange
    rows: int  # compared
    variables: tuple[str, ...]  # compared
    difference: (
        float  # largest, over the number, and at least 1e-3 of the largest of its column; inf if not finite
    )
    variable: str  # where that is
    time: float  # row where that is, by its time or number


@dataclass(frozen=True, slots=True)
class ReferenceCheck(Summary):
    """Result of `verify_references`.

    Attributes
    ----------
    fmi : str
        Version.
    findings : tuple of str
        Of fmpy's validation; files that were changed; interfaces that do not run.
    interfaces : tuple of Interface
        Each beside the references.
    tolerance : float
        That the references ask for.
    """

    fmi: str
    findings: tuple[str, ...]
    interfaces: tuple[Interface, ...]
    tolerance: float

    @classmethod
    def from_fields(cls, fields: dict[str, Any]) -> ReferenceCheck:
        """Make it of its fields, lists in place of tuples."""
        interfaces = tuple(
            Interface(**one | {"variables": tuple(one["variables"])}) for one in fields["interfaces"]
        )
        return cls(**fields | {"findings": tuple(fields["findings"]), "interfaces": interfaces})

    @property
    def passes(self) -> bool:
        """No finding, and all differences within the tolerance."""
        return not self.findings and all(one.difference <= self.tolerance for one in self.interfaces)

    def _summary_lines(self) -> list[str]:
        verdict = "passes" if self.passes else "fails"
        return [
            f"{verdict}: FMI {self.fmi}, differences up to {self.tolerance:g} are allowed",
            *(
                f"{one.name}: largest difference {one.difference:.2g}, of {one.variable}; "
                f"{len(one.variables)} variables in {one.rows} rows"
                for one in self.interfaces
            ),
            *findings_text(self.findings),
        ]

    def to_dict(self) -> dict[str, Any]:
        """All fields and the verdict, for storage."""
        return asdict(self) | {"passes": self.passes}


def verify_references(path: str | os.PathLike[str]) -> ReferenceCheck:
    """Run an FMU through fmpy and compare it with the reference results inside it.

    Its native code runs, as for `fmu.verify`.

    Parameters
    ----------
    path : path-like
        An FMU that this library exported, with a binary for this machine.

    Returns
    -------
    ReferenceCheck
        For co-simulation and model exchange the largest difference, and in which variable; and the
        findings of fmpy's validation and of the checksums.

    Raises
    ------
    InputError
        Not an FMU for this platform, or one without reference results; otherwise as `fmu.verify`.

    See Also
    --------
    fmu.verify : the same against the element in Python, at more states, with the directional derivatives.
    """
    return isolated(_checked, require_path(path), ReferenceCheck.from_fields)


def _checked(path: Path) -> ReferenceCheck:
    with opened(path) as file:
        return check_references(file, findings(file.path))


def check_references(file: FmuFile, findings: tuple[str, ...] = ()) -> ReferenceCheck:
    """`verify_references` of an opened FMU; adds to `findings`."""
    references = read_references(file)
    broken, interfaces = _interfaces(file, references)
    found = (*findings, *changed_files(file.folder), *broken)
    return ReferenceCheck(file.description.fmiVersion, found, interfaces, references.tolerance)


def _interfaces(file: FmuFile, references: References) -> tuple[tuple[str, ...], tuple[Interface, ...]]:
    """Findings of interfaces that do not run or have no references; comparison of the others."""
    findings, interfaces = [], []
    with file.running() as (slave, exchange):
        cases: tuple[tuple[str, Trial | None, Any, Callable[[Any, References], _Floats]], ...] = (
            (STEPS, references.steps, slave, walk),
            (POINTS, references.points, exchange, visit),
        )
        for name, trial, instance, run in cases:
            if instance is None:
                continue
            if trial is None:
                findings.append(f"{name}: no reference results")
                continue
            try:
                found = run(instance, references)
            except Exception as error:  # fmpy raises bare Exception among others, also for a call that is refused
                findings.append(f"{name}: does not run ({' '.join(str(error).split())})")
                continue
            interfaces.append(_compared(name, trial, found))
    return tuple(findings), tuple(interfaces)


def _compared(name: str, trial: Trial, found: _Floats) -> Interface:
    gaps = trial.differences(found)
    worst = max(gaps, key=lambda variable: gaps[variable].max())
    at = int(np.argmax(gaps[worst]))
    return Interface(name, trial.time.size, tuple(gaps), float(gaps[worst][at]), worst, float(trial.time[at]))
