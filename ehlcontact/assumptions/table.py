"""`Assumption`: one assumption with its number; `Assumptions`: the table of all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from math import inf
from typing import Any

from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, note_line


@dataclass(frozen=True, slots=True)
class Assumption(Summary):
    """One assumption with its number.

    Attributes
    ----------
    name : str
    number : str
        What is computed.
    value : float or None
        None where an input is missing.
    limit : float
        Up to which, or from which on, the assumption holds.
    at_least : bool
        Whether the value has to be at least the limit, or at most.
    unit : str
        Of value and limit.
    verdict : str
        One line; the headline has it up to the first semicolon.
    scatter : str
        How sure the number is.
    source : str
        Who says so.
    details : mapping of str to float
        What else was computed for it.
    """

    name: str
    number: str
    value: float | None
    limit: float
    at_least: bool
    unit: str
    verdict: str
    scatter: str
    source: str
    details: Mapping[str, float] = field(default_factory=dict)

    def _summary_lines(self) -> list[str]:
        word = {True: "holds", False: "does not hold", None: "is not judged"}[self.holds]
        unit = "" if self.unit == "-" else f" {self.unit}"
        value = "not known" if self.value is None else f"{self.value:.4g}{unit}"
        limit = f"{'at least' if self.at_least else 'at most'} {self.limit:.4g}{unit}"
        return [f"{self.name} {word}", *note_line(f"{self.number}: {value}, {limit}"), *note_line(self.verdict)]

    @property
    def holds(self) -> bool | None:
        """Whether the value is inside its limit; None where there is no value."""
        if self.value is None:
            return None
        return self.value >= self.limit if self.at_least else self.value <= self.limit

    def to_dict(self) -> dict[str, Any]:
        """All of it, ready for JSON."""
        return asdict(self) | {"details": dict(self.details), "holds": self.holds}


@dataclass(frozen=True, slots=True)
class Assumptions(Summary):
    """All assumptions of a contact, by name: ``found["isothermal"].value``.

    Attributes
    ----------
    table : tuple of Assumption
    """

    table: tuple[Assumption, ...]

    def _summary_lines(self) -> list[str]:
        lines = [f"{sum(a.holds is True for a in self.table)} of {len(self.table)} hold"]
        lines += note_line("; ".join(f"{a.name} does not hold: {a.verdict}" for a in self.out_of_range))
        waiting = ", ".join(a.name for a in self.not_judged)
        return lines + note_line(f"not judged, for an input is missing: {waiting}" if waiting else "")

    def __iter__(self) -> Iterator[Assumption]:
        return iter(self.table)

    def __getitem__(self, name: str) -> Assumption:
        for found in self.table:
            if found.name == name:
                return found
        raise InputError("assumption", name, "one of " + ", ".join(a.name for a in self.table))

    @property
    def out_of_range(self) -> tuple[Assumption, ...]:
        """Those that do not hold."""
        return tuple(a for a in self.table if a.holds is False)

    @property
    def not_judged(self) -> tuple[Assumption, ...]:
        """Those for which an input is missing."""
        return tuple(a for a in self.table if a.holds is None)

    @property
    def headline(self) -> str:
        """What does not hold, in one sentence; empty where nothing is out of range."""
        broken = [f"{a.name} ({a.verdict.split(';')[0]})" for a in self.out_of_range]
        return f"Outside what is assumed: {'; '.join(broken)}." if broken else ""

    @classmethod
    def worst_of(cls, contacts: Iterable[Assumptions]) -> Assumptions:
        """Of each assumption that of the contact where it holds least; those not judged there count as holding."""

        def excess(one: Assumption) -> float:
            if one.value is None:
                return -inf
            return (one.limit - one.value if one.at_least else one.value - one.limit) / one.limit

        rows = zip(*contacts, strict=True)
        return cls(tuple(max(row, key=excess) for row in rows))

    def to_dict(self) -> dict[str, Any]:
        """The whole table, ready for JSON."""
        return {
            "headline": self.headline,
            "out_of_range": [a.name for a in self.out_of_range],
            "not_judged": [a.name for a in self.not_judged],
            "table": [a.to_dict() for a in self.table],
        }

    def short(self) -> dict[str, dict[str, float | bool | None]]:
        """Value, limit and whether it holds by name: what an element file keeps."""
        return {a.name: {"value": a.value, "limit": a.limit, "holds": a.holds} for a in self.table}
