"""Tables 1 and 4: a straight line through the origin, and a damper."""

from __future__ import annotations

from ehlcontact.cli.numerals import between
from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES
from ehlcontact.cli.paper.table import ACCELERATION, EQUATION_13, SIGNED, TABLE_CASES, Cell, Table
from reduced_models import FitResult

WINDOWS = {True: "whole record", False: "last two thirds"}
RMS = "rms / std of force"


def linear_table(number: int, fits: Fits) -> Table:
    """The paper's row of each case, and ours of both windows."""
    second = (ACCELERATION,) if number == 1 else ()
    columns = ("case", "motion", "source", "K1", "C1", SIGNED, EQUATION_13, *second, RMS)
    rows: list[tuple[Cell, ...]] = []
    for case in TABLE_CASES[number]:
        paper = paper_fits()[number, case]
        seconds = (paper.e_second,) if second else ()
        rows.append((case, CASES[case].title, "paper", paper.K1, paper.C1, paper.e_f, None, *seconds, None))
        for whole, source in WINDOWS.items():
            found = fits.fit(case, "linear", whole=whole)
            if found is None:
                missing: list[Cell] = [None] * (len(columns) - 3)
                rows.append((case, "", f"ours, {source}: {fits.refusal(case, 'linear', whole)}", *missing))
                continue
            p = found.parameters
            seconds = (_negative(found.e_acc),) if second else ()
            errors = (-found.e_f, found.e_f, *seconds, found.rms)
            rows.append((case, "", f"ours, {source}", p["K1"], p["C1"], *errors))
    title = f"Linear spring and damper, {'free vibration' if number == 1 else 'harmonic load'}"
    notes = (*_judged(number, fits), *_signs(number, fits))
    if second:
        notes += ("The paper does not explain its second error; ours is that of eq. 13 for the acceleration.",)
    return Table(number, title, columns, tuple(rows), notes)


def _negative(error: float | None) -> float | None:
    return None if error is None else -error


def _found(number: int, fits: Fits, whole: bool) -> dict[str, FitResult]:
    made = {case: fits.fit(case, "linear", whole=whole) for case in TABLE_CASES[number]}
    return {case: found for case, found in made.items() if found is not None}


def _judged(number: int, fits: Fits) -> list[str]:
    """What a straight line through the origin makes of these records, in numbers."""
    whole, late = (_found(number, fits, window) for window in WINDOWS)
    if not whole and not late:
        return []
    every = [(case, found) for made in (whole, late) for case, found in made.items()]
    missed = between((100.0 * found.rms for _, found in every), 2, "%")
    at_rest = {case: fits.runs.cases[case, fits.runs.n].static_approach for case, _ in every}
    secant = between((100.0 * (found.parameters["K1"] * at_rest[case] - 1.0) for case, found in every), 2, "%")
    notes = [
        f"The straight line through the origin misses the force by {missed} of its standard deviation (rms); its "
        f"K1 differs from the secant 1/u of the approach at rest by {secant} of the secant."
    ]
    both = [(whole[case].parameters["C1"], late[case].parameters["C1"]) for case in whole if case in late]
    if both:
        moved = between((100.0 * (second / first - 1.0) for first, second in both), 2, "%")
        cubics = {case: fits.fit(case) for case in late}
        ratios = [late[case].parameters["C1"] / c.parameters["C1"] for case, c in cubics.items() if c is not None]
        notes.append(
            f"What the line misses goes partly into C1: from the whole record to its last two thirds it changes "
            f"by {moved} of the former, and there it is {between(ratios, 3)} times that of the cubic element."
        )
    return notes


def _signs(number: int, fits: Fits) -> list[str]:
    """Which sign of e_f the paper's printed values have."""
    pairs = [(paper_fits()[number, case].e_f, found.e_f) for case, found in _found(number, fits, True).items()]
    known = [(theirs, ours) for theirs, ours in pairs if theirs is not None]
    alike = sum(theirs * ours > 0.0 for theirs, ours in known)
    if not known:
        return []
    return [
        f"Eq. 13 as printed is simulated less fitted: with whole records that gives the sign of the paper's e_f "
        f"in {alike} of {len(known)} cases; fitted less simulated gives it in {len(known) - alike}."
    ]
