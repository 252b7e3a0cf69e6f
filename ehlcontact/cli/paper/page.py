"""What was reproduced: one HTML page with all tables and figures, and its JSON twin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ehlcontact.cli.page import write_page
from ehlcontact.cli.paper.data import CITATION
from ehlcontact.cli.paper.figures import FIGURES, PaperFigure
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import POINT, VALIDATION_POINT, compute
from ehlcontact.cli.paper.tables import TABLE_CASES, Table, make_table
from ehlcontact.version import __version__

LABELS = {
    "force_rms": "rms of force error / std of force",
    "approach_rms": "rms of approach error / std of approach",
    "rk23_against_radau": "rms of RK2(3) less Radau / std of approach",
    "rk23_evaluations": "evaluations of RK2(3)",
    "radau_evaluations": "of Radau",
}


@dataclass(frozen=True)
class Reproduction:
    """Tables and figures that were made."""

    fits: Fits
    tables: Sequence[Table]
    figures: Sequence[PaperFigure]  # those whose simulations are there
    missing: dict[int, str]  # figures that could not be drawn, and why
    numbers: dict[int, dict[str, Any]]  # of the figures

    @property
    def failed(self) -> dict[str, str]:
        """Simulations that did not converge, and why."""
        return self.fits.runs.failed

    def to_dict(self) -> dict[str, Any]:
        """All numbers, ready for JSON."""
        runs = self.fits.runs
        return {
            "status": "not converged" if self.failed else "converged",
            "paper": CITATION,
            "version": __version__,
            "n": runs.n,
            "tables": {str(table.number): table.to_dict() for table in self.tables},
            "figures": {
                str(figure.number): {
                    "caption": figure.caption,
                    "paper": figure.paper,
                    "numbers": self.numbers[figure.number],
                }
                for figure in self.figures
            },
            "missing_figures": {str(number): why for number, why in self.missing.items()},
            "failed": self.failed,
            "seconds": {f"case {case}": run.seconds for case, run in runs.cases.items()},
        }


def reproduce(tables: Sequence[int], figures: Sequence[int], folder: Path, n: int) -> Reproduction:
    """Simulate what these tables and figures need and `folder` does not hold yet, and make them.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C; what was finished is in the folder.
    """
    wanted = {case for number in tables for case in TABLE_CASES[number]}
    wanted |= {case for number in figures for case in (*FIGURES[number].cases, *FIGURES[number].elements)}
    fits = Fits(compute(folder, n, sorted(wanted), 2 in figures))
    missing = {}
    for number in figures:
        absent = [case for case in FIGURES[number].cases if case not in fits.runs.cases]
        if absent:
            missing[number] = "no simulation of case " + ", ".join(absent)
    drawn = [FIGURES[number] for number in figures if number not in missing]
    numbers = {figure.number: figure.numbers(fits) for figure in drawn}
    return Reproduction(fits, [make_table(number, fits) for number in tables], drawn, missing, numbers)


def write_reproduction(found: Reproduction, path: Path) -> Path:
    """Draw the figures and write the page."""
    drawings = {str(figure.number): partial(figure.draw, found.fits) for figure in found.figures}
    return write_page(
        path,
        "reproduction.html.j2",
        drawings,
        found=found,
        citation=CITATION,
        version=__version__,
        runs=found.fits.runs,
        ramp=VALIDATION_POINT,
        point=POINT,
        labels=LABELS,
    )
