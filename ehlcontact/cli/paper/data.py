"""What the paper printed in its tables and gives as numbers in its text, as data.

F. Nonato, K. L. Cavalca: On the non-linear dynamic behavior of elastohydrodynamic lubricated point contact.
Journal of Sound and Vibration 329 (2010) 4656-4671. Numbers only; everything is dimensionless.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from reduced_models import SpringContact

CITATION = (
    "F. Nonato, K. L. Cavalca: On the non-linear dynamic behavior of elastohydrodynamic lubricated point contact. "
    "Journal of Sound and Vibration 329 (2010) 4656-4671."
)
# Around the static approach: what a tenth of force makes of it. Only the root and the tangent are read off.
AROUND_STATIC = (0.78, 0.96)
FIRST_VALLEY = 1.0  # T close to which section 4 sees the first valley of the central film in Fig. 6


@dataclass(frozen=True, slots=True)
class PaperFit:
    """One row of Tables 1 and 3 to 6."""

    table: int
    case: str
    K1: float
    K2: float | None
    K3: float | None
    C1: float
    e_f: float | None
    e_second: float | None
    last_digit: float  # of K1, K2 and K3 as printed

    @property
    def cubic(self) -> SpringContact:
        """The element of a row of Tables 3, 5 and 6, to read off root and tangent."""
        found = self.element(*AROUND_STATIC)
        assert found.kind == "cubic"
        return found

    def element(self, low: float, high: float) -> SpringContact:
        """The element of the row, its polynomial as printed from `low` to `high`."""
        if self.K2 is None or self.K3 is None:
            return SpringContact.linear(self.K1, self.C1, low, high)
        return SpringContact.cubic(self.K1, self.K2, self.K3, self.C1, low, high)

    @property
    def root(self) -> float:
        """Approach at which the spring carries the static load."""
        return self.cubic.approach_at(1.0)

    @property
    def tangent(self) -> float:
        """Stiffness there."""
        return self.cubic.stiffness(self.root, 0.0)

    @property
    def rounding(self) -> tuple[float, float]:
        """What half a last digit of each coefficient can do to the root, and to the tangent at a fixed root."""
        u, half = self.root, 0.5 * self.last_digit
        return half * (u + u**2 + u**3) / self.tangent, half * (1.0 + 2.0 * u + 3.0 * u**2)


def _number(text: str) -> float | None:
    return float(text) if text else None


@cache
def paper_fits() -> dict[tuple[int, str], PaperFit]:
    """Rows of Tables 1 and 3 to 6 by (table, case)."""
    found = {}
    for row in _rows("paper_fits.csv"):
        numbers: dict[str, Any] = {
            name: _number(row[name]) for name in ("K1", "K2", "K3", "C1", "e_f", "e_second")
        }
        printed = max(len(row[name].partition(".")[2]) for name in ("K1", "K2", "K3"))
        fitted = PaperFit(table=int(row["table"]), case=row["case"], last_digit=10.0**-printed, **numbers)
        found[fitted.table, fitted.case] = fitted
    return found


@cache
def paper_sensitivity() -> dict[str | None, tuple[float, float]]:
    """Table 2: (e_f, e_acc) by the coefficient left out; None is the full model."""
    return {
        None if row["removed"] == "none" else row["removed"]: (float(row["e_f"]), float(row["e_acc"]))
        for row in _rows("paper_sensitivity.csv")
    }


@cache
def paper_films() -> dict[str, float]:
    """Minimum over central film at rest at the point of the load ramp (section 3), computed and measured."""
    return {row["source"]: float(row["h_min_um"]) / float(row["h_central_um"]) for row in _rows("paper_films.csv")}


def _rows(name: str) -> list[dict[str, str]]:
    text = (files("ehlcontact.cli.paper") / name).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))
