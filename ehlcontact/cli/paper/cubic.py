"""Tables 3, 5 and 6: a cubic spring and a damper, on three grids."""

from __future__ import annotations

from collections.abc import Sequence

from ehlcontact.cli.numerals import between, numeral
from ehlcontact.cli.paper.data import PaperFit, paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.order import SEEN, Limit, limit
from ehlcontact.cli.paper.runs import CASES
from ehlcontact.cli.paper.table import ACCELERATION, EQUATION_13, SIGNED, TABLE_CASES, Cell, Table
from reduced_models import FitResult

_COMPARED = ("C1", "root", "tangent")
_KEYS = ("K1", "K2", "K3", *_COMPARED)
_REST = ("K1 95 %", "C1 95 %", SIGNED, EQUATION_13, ACCELERATION, "rms / std of force", "condition")
_COLUMNS = ("case", "source", *_KEYS, *_REST)


def cubic_table(number: int, fits: Fits) -> Table:
    """Every case: the paper's row, ours on each grid, the order they show, and the distance from the paper."""
    cases = TABLE_CASES[number]
    limits = {case: _limits([fits.fit(case, "cubic", n) for n in fits.runs.levels]) for case in cases}
    rows = tuple(row for case in cases for row in _rows(number, case, fits, limits[case]))
    notes = [*_printed(number), *_identified(number, fits), _extrapolation(fits, limits)]
    if number == 6:
        notes += _ramp(fits)
    return Table(
        number,
        "Cubic spring and damper, " + {3: "free vibration", 5: "harmonic load", 6: "load ramp"}[number],
        _COLUMNS,
        rows,
        tuple(notes),
    )


def _rows(number: int, case: str, fits: Fits, limits: dict[str, Limit]) -> list[tuple[Cell, ...]]:
    paper, levels = paper_fits()[number, case], fits.runs.levels
    theirs = (paper.K1, paper.K2, paper.K3, paper.C1, paper.root, paper.tangent)
    rows = [_row(CASES[case].title, "paper", theirs, (None, None, paper.e_f, None, paper.e_second))]
    for n in levels:
        found = fits.fit(case, "cubic", n)
        if found is None:
            rows.append(_row("", f"n = {n}: {_why(fits, case, n)}"))
            continue
        errors = (-found.e_f, found.e_f, None if found.e_acc is None else -found.e_acc, found.rms, found.condition)
        rows.append(
            _row("", f"ours, n = {n}", _of(found), (_interval(found, "K1"), _interval(found, "C1"), *errors))
        )
    rows.append(_row("", "order seen", (None, None, None, *(limits[key].verdict for key in _COMPARED))))
    best = {key: limits[key].extrapolated for key in _COMPARED}
    finest = fits.fit(case)
    compared: list[tuple[str, Sequence[float | None]]] = []
    if finest is not None:
        compared.append((f"n = {levels[-1]}", _of(finest)[3:]))
    if any(value is not None for value in best.values()):
        rows.append(_row("", "extrapolated", (None, None, None, *best.values())))
        compared.append(("extrapolated", tuple(best.values())))
    for name, values in compared:
        off = [_off(mine, his) for mine, his in zip(values, theirs[3:], strict=True)]
        rows.append(_row("", f"{name} less paper, in % of the paper's", (None, None, None, *off)))
    return rows


def _row(case: str, source: str, values: Sequence[Cell] = (), rest: Sequence[Cell] = ()) -> tuple[Cell, ...]:
    """A row, blank where nothing is given."""
    blank: tuple[Cell, ...] = (None,)
    known = (*values, *blank * (len(_KEYS) - len(values)))
    return case, source, *known, *rest, *blank * (len(_REST) - len(rest))


def _of(found: FitResult) -> tuple[float | None, ...]:
    p = found.parameters
    return p["K1"], p["K2"], p["K3"], p["C1"], found.root, found.tangent


def _off(mine: float | None, his: float | None) -> str | None:
    return None if mine is None or his is None else f"{100.0 * (mine / his - 1.0):+.2f} %"


def _why(fits: Fits, case: str, n: int) -> str:
    """Why there is no element on this grid."""
    runs = fits.runs
    return runs.without.get((case, n)) or runs.failed.get(f"case {case}, n = {n}") or fits.refusal(case, n=n) or ""


def _interval(found: FitResult, name: str) -> str:
    return " .. ".join(numeral(bound, 3) for bound in found.intervals[name])


def _limits(levels: Sequence[FitResult | None]) -> dict[str, Limit]:
    """Limits of what is compared, from fits on three grids."""
    return {key: limit([None if f is None else _of(f)[_KEYS.index(key)] for f in levels]) for key in _COMPARED}


def _printed(number: int) -> list[str]:
    """How exactly the paper prints what is compared."""
    rows: list[PaperFit] = [paper_fits()[number, case] for case in TABLE_CASES[number]]
    root, tangent = (max(row.rounding[k] for row in rows) for k in (0, 1))
    return [
        "Compared are the root (approach under the static load), the tangent (stiffness there) and C1. The "
        "paper's root and tangent are computed here from its coefficients; half a last digit of each of K1, K2 "
        f"and K3 moves its root by up to {numeral(root, 1)}, its tangent by {numeral(tangent, 1)}.",
    ]


def _identified(number: int, fits: Fits) -> list[str]:
    """How well the records determine the single coefficients, and where the contact rests."""
    found = [f for case in TABLE_CASES[number] if (f := fits.fit(case)) is not None]
    if not found:
        return []
    widths = {
        key: between(
            (100.0 * (f.intervals[key][1] - f.intervals[key][0]) / abs(f.parameters[key]) for f in found), 2
        )
        for key in ("K1", "K2", "K3", "C1")
    }
    at_rest = {
        fits.runs.cases[case, fits.runs.n].static_approach for case in TABLE_CASES[number] if fits.fit(case)
    }
    return [
        f"Width of the 95 % intervals at n = {fits.runs.n}, in % of the coefficient: "
        + ", ".join(f"{key} {width}" for key, width in widths.items())
        + ".",
        f"At rest the approach is {between(at_rest, 5)} at n = {fits.runs.n}. The root of a fit to a motion need "
        "not be that: where the film cannot follow, its mean is another, and a viscous cubic has it in its root.",
    ]


def _extrapolation(fits: Fits, limits: dict[str, dict[str, Limit]]) -> str:
    """What the three grids showed, and what was done about it."""
    grids = ", ".join(map(str, fits.runs.levels))
    made = sum(found.extrapolated is not None for case in limits.values() for found in case.values())
    rule = (
        f"Order seen: log2 of the change from n/4 to n/2 over that from n/2 to n (n = {grids}); a dash where a "
        "grid is missing, 'none' where the changes do not shrink in one direction. Only an order of "
        f"{SEEN[0]:g} to {SEEN[1]:g} is taken for the second order of the scheme, and extrapolated by it, "
        "fine + (fine - middle)/3: "
    )
    if made == 0:
        return rule + "none is, so the finest grid's values stand."
    total = sum(len(case) for case in limits.values())
    return rule + f"{made} of {total} are; of the others the finest grid's values stand."


def _ramp(fits: Fits) -> list[str]:
    case = TABLE_CASES[6][0]
    found = fits.fit(case)
    if found is None:
        return []
    run, (start, end) = fits.runs.cases[case, fits.runs.n], found.window[0]
    d = run.domain
    return [
        f"The record is T = 0 to {numeral(run.T[-1])} on [{d.x_in:g}, {d.x_out:g}] x [-{d.y_max:g}, {d.y_max:g}], "
        f"fitted from {numeral(start)} to {numeral(end)}."
    ]
