"""Tables 1 to 6, the paper's numbers beside ours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ehlcontact.cli.paper.data import PaperFit, paper_fits, paper_sensitivity
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, FREE, HARMONIC, RAMP
from reduced_models import FitResult

Cell = float | str | None


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


TABLE_CASES: dict[int, tuple[str, ...]] = {1: FREE, 2: FREE, 3: FREE, 4: HARMONIC, 5: HARMONIC, 6: RAMP}
EXTRAPOLATED = (3, 5, 6)  # also computed on the coarser grid


def make_table(number: int, fits: Fits) -> Table:
    """The table with this number."""
    if number == 2:
        return _sensitivity_table(fits)
    return _linear_table(number, fits) if number in (1, 4) else _cubic_table(number, fits)


def _linear_table(number: int, fits: Fits) -> Table:
    second = ("e_acc",) if number == 1 else ()
    columns = ("case", "motion", "source", "K1", "C1", "e_f", *second, "rms")
    rows: list[tuple[Cell, ...]] = []
    for case in TABLE_CASES[number]:
        paper = paper_fits()[number, case]
        seconds = (paper.e_second,) if second else ()
        rows.append((case, CASES[case].title, "paper", paper.K1, paper.C1, paper.e_f, *seconds, None))
        for whole, source in ((True, "whole record"), (False, "last two thirds")):
            found = fits.fit(case, "linear", whole=whole)
            if found is None:
                missing: list[Cell] = [None] * (len(columns) - 3)
                rows.append((case, "", f"{source}: {fits.refusal(case, 'linear', whole)}", *missing))
                continue
            p = found.parameters
            seconds = (found.e_acc,) if second else ()
            rows.append((case, "", f"ours, {source}", p["K1"], p["C1"], found.e_f, *seconds, found.rms))
    return Table(
        number,
        f"Linear spring and damper, {'free vibration' if number == 1 else 'harmonic load'}",
        columns,
        tuple(rows),
        (
            "A straight line through the origin misses a quarter of the force (rms); its K1 is the secant 1/u of "
            "the static point, and C1 takes up the misfit, so it changes with the window and means nothing.",
            "The paper does not explain its second error in Table 1; ours is eq. 13 for the acceleration.",
        ),
    )


_KEYS = ("K1", "K2", "K3", "C1", "root", "tangent")


_CUBIC = ("case", "source", *_KEYS, "K1 95 %", "C1 95 %", "e_f", "e_acc", "rms", "condition")


def _cubic_rows(number: int, case: str, fits: Fits) -> list[tuple[Cell, ...]]:
    """The paper's row of a case, ours on both grids, and what they come to."""
    blank: tuple[Cell, ...] = (None,) * (len(_CUBIC) - 2)
    paper = paper_fits()[number, case]
    theirs = _of_paper(paper)
    rows: list[tuple[Cell, ...]] = [
        (CASES[case].title, "paper", *theirs, None, None, paper.e_f, paper.e_second, None, None)
    ]
    levels = [fits.fit(case, "cubic", n) for n in fits.runs.levels]
    for n, found in zip(fits.runs.levels, levels, strict=True):
        if found is None:
            why = fits.runs.failed.get(f"case {case}, n = {n}", "no fit")
            rows.append(("", f"n = {n}: {why}", *blank))
            continue
        quality = (_interval(found, "K1"), _interval(found, "C1"), found.e_f, found.e_acc, found.rms)
        rows.append(("", f"ours, n = {n}", *_of_fit(found), *quality, found.condition))
    best = extrapolated(levels)
    if best is not None:
        values = tuple(best.get(key) for key in _KEYS)
        deviation = tuple(
            None if key.startswith("K") or mine is None or his is None else f"{100 * (mine / his - 1):+.2f} %"
            for key, mine, his in zip(_KEYS, values, theirs, strict=True)
        )
        rest = blank[len(_KEYS) :]
        rows.append(("", "extrapolated", *values, *rest))
        rows.append(("", "extrapolated against paper", *deviation, *rest))
    return rows


def _cubic_table(number: int, fits: Fits) -> Table:
    return Table(
        number,
        "Cubic spring and damper, " + {3: "free vibration", 5: "harmonic load", 6: "load ramp"}[number],
        _CUBIC,
        tuple(row for case in TABLE_CASES[number] for row in _cubic_rows(number, case, fits)),
        (
            "Compare root (approach under the static load), tangent (stiffness there) and C1: the single K are "
            "not identifiable from so small a motion, as their intervals and the condition number say.",
            "The root of a vibration is not the static approach: where the film cannot follow, its mean is "
            "another than at rest, and a viscous cubic puts the difference into its root.",
            "Extrapolated: (4 fine - coarse)/3 of root, tangent and C1, second order in the mesh. The paper "
            "prints C1 with two digits.",
            *(
                ()
                if number != 6
                else (
                    "The record is T = 0 to 5.6 on [-5, 3] x [-4, 4], the fit takes all of it; C1 has the size of "
                    "the misfit of the cubic here, and a wide interval.",
                )
            ),
        ),
    )


def extrapolated(levels: Sequence[FitResult | None]) -> dict[str, float] | None:
    """Root, tangent and C1 in the limit of fine meshes, from n/2 and n intervals; None if one is missing."""
    coarse, fine = levels
    if coarse is None or fine is None or None in (coarse.root, fine.root, coarse.tangent, fine.tangent):
        return None
    pairs = {
        "root": (coarse.root, fine.root),
        "tangent": (coarse.tangent, fine.tangent),
        "C1": (coarse.parameters["C1"], fine.parameters["C1"]),
    }
    return {key: (4.0 * b - a) / 3.0 for key, (a, b) in pairs.items()}  # type: ignore[operator]


def _of_paper(paper: PaperFit) -> tuple[float | None, ...]:
    return paper.K1, paper.K2, paper.K3, paper.C1, paper.root, paper.tangent


def _of_fit(found: FitResult) -> tuple[float | None, ...]:
    p = found.parameters
    return p["K1"], p["K2"], p["K3"], p["C1"], found.root, found.tangent


def _interval(found: FitResult, name: str) -> str:
    low, high = found.intervals[name]
    return f"{low:.3g} .. {high:.3g}"


def _sensitivity_table(fits: Fits) -> Table:
    columns: tuple[str, ...] = ("removed", "paper e_f", "paper e_acc")
    found = {case: fits.sensitivity(case) for case in FREE}
    kept = {case: table for case, table in found.items() if table is not None}
    for case in kept:
        columns += tuple(f"case {case}: {name}" for name in ("rms", "e_f", "e_acc", "BIC", "rms struck out"))
    rows: list[tuple[Cell, ...]] = []
    for k, (removed, errors) in enumerate(paper_sensitivity().items()):
        row: list[Cell] = ["none" if removed is None else removed, *errors]
        for table in kept.values():
            ours = table.rows[k]
            assert ours.removed == removed
            row += [ours.rms, ours.e_f, ours.e_acc, ours.bic, ours.rms_without_refit]
        rows.append(tuple(row))
    notes = [f"Case {case}, most harmful removal first (rms): {', '.join(t.ranking)}." for case, t in kept.items()]
    notes += [f"Case {case}: {t.warning}." for case, t in kept.items() if t.warning]
    notes += [
        "As in the paper the other six are fitted again; BIC is the change from the full model, negative where "
        "the term is not worth keeping; 'struck out' leaves the others as they were. The paper does not name its "
        "case.",
        "The paper's two errors are signed sums (eq. 13), near zero by construction. Removing a damper, whose "
        "column sums to nearly zero over a vibration, hardly changes them: by e_f ours too has K1, then K2 and "
        "K3, far above C1, C2, C3 and B4. By rms the dampers do count: what acts is C1 + B4 u, so either can "
        "stand in for the other, but only B4 lets the damping grow with the approach; and without C2 or B4 the "
        "fit of a fast vibration loses more than without K3, whose place K1 and K2 take.",
    ]
    return Table(
        2,
        "Residuals when one coefficient is left out of the seven-term polynomial",
        columns,
        tuple(rows),
        tuple(notes),
    )
