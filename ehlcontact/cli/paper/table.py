"""What a table is, and which simulations each one takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ehlcontact.cli.paper.runs import FREE, HARMONIC, RAMP

Cell = float | str | None
TABLE_CASES: dict[int, tuple[str, ...]] = {1: FREE, 2: FREE, 3: FREE, 4: HARMONIC, 5: HARMONIC, 6: RAMP}
EXTRAPOLATED = (3, 5, 6)  # also computed on coarser grids
EQUATION_13 = "e_f (eq. 13 as printed)"  # simulated less fitted
ACCELERATION = "e_acc (fitted less simulated)"
SIGNED = "e_f (fitted less simulated)"  # as the paper's tables seem to have it


@dataclass(frozen=True)
class Table:
    """One table of the paper; cells are numbers, texts or None."""

    number: int
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """For JSON: rows as objects."""
        return {
            "title": self.title,
            "rows": [dict(zip(self.columns, row, strict=True)) for row in self.rows],
            "notes": list(self.notes),
        }
