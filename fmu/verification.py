"""`Verification`: counts of compared states, and the largest differences between an FMU and its Python model."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from textwrap import shorten
from typing import Any

from ehlcontact.summary import WIDTH, Summary

TOLERANCE = 1e-12  # of forces, tangents and derivatives: rounding
ORBIT = 1e-6  # of a rotor's motion: both balance their contacts to a billionth of the load in every step
BALLS = 1e-8  # of the forces of a bearing: the search for the places of balls ends 1e-8 of them away, in C 1e-7
# Of rates of a bearing's states: tables of FMU and Python are within 1e-8 where surfaces have parted,
# and the rate of a ball there is a small difference of what they say
RATES = 1e-6


@dataclass(frozen=True, slots=True)
class Verification(Summary):
    """Result of `verify`: counts and largest relative differences.

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
    bearing : float
        Of a bearing's run, largest difference of forces and moments over the largest of each, in
        model exchange too.
    rates : float
        Of a bearing in model exchange, largest difference of rates over the largest of their kind.
    """

    findings: tuple[str, ...] = ()
    states: int = 0
    outside: int = 0
    parted: int = 0
    force: float = 0.0
    tangents: float = 0.0
    derivatives: float = 0.0
    flags: int = 0
    exchange: float = 0.0
    motion: float = 0.0
    bearing: float = 0.0
    rates: float = 0.0

    @classmethod
    def from_fields(cls, fields: dict[str, Any]) -> Verification:
        """Make it of its fields, lists in place of tuples."""
        return cls(**fields | {"findings": tuple(fields["findings"])})

    @property
    def passes(self) -> bool:
        """No finding, and all differences within rounding."""
        differences = max(self.force, self.tangents, self.derivatives, self.exchange)
        runs = self.motion <= ORBIT and self.bearing <= BALLS and self.rates <= RATES
        return not self.findings and self.flags == 0 and differences <= TOLERANCE and runs

    def _summary_lines(self) -> list[str]:
        largest = f"force {self.force:.2g}, tangents {self.tangents:.2g}, derivatives {self.derivatives:.2g}"
        lines = [
            f"{'passes' if self.passes else 'fails'}: {self.states} states compared, {self.outside} of them "
            f"outside the validity interval, {self.parted} without force",
            f"largest differences: {largest}, model exchange {self.exchange:.2g}; {TOLERANCE:g} is allowed",
        ]
        if self.motion:
            lines.append(f"motion of the rotor {self.motion:.2g}, over its largest; {ORBIT:g} is allowed")
        if self.bearing:
            lines.append(f"forces of the bearing {self.bearing:.2g}, over their largest; {BALLS:g} is allowed")
        if self.rates:
            lines.append(
                f"rates of its states {self.rates:.2g}, over the largest of their kind; {RATES:g} is allowed"
            )
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
