"""What figures of the paper draw and tell, made of simulations and fits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import find_peaks

from ehlcontact.cli.paper.data import FIRST_VALLEY, paper_films, paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, HARMONIC, STATIC_LOADS, STATIC_OILS
from ehlcontact.cli.plots import paper as plots
from ehlcontact.cli.plots.fringes import snapshots
from ehlcontact.formulas import wijnant_approach
from reduced_models import FitResult

Draw = Callable[[Fits], Figure]
Numbers = Callable[[Fits], dict[str, Any]]  # rows by name, each with its numbers by name
OUTSIDE = (0.5, 1.0, 1.5, 2.5)  # approaches at which Fig. 16 is also told in numbers
TURN = 0.2  # of its range that a film has to turn by


def static(fits: Fits) -> Figure:
    """Fig. 2."""
    found = {point: result.approach for point, result in fits.runs.static.items()}
    return plots.static_approach(found, STATIC_LOADS, STATIC_OILS)


def fringes(case: str) -> Draw:
    """Fringes of a case at its snapshots."""
    return lambda fits: snapshots(fits.runs.cases[case, fits.runs.n])


def approaches(table: int, *cases: str) -> Draw:
    """Approaches of some cases, and the roots of the paper's cubics for them."""

    def draw(fits: Fits) -> Figure:
        runs = {CASES[case].title: fits.runs.cases[case, fits.runs.n] for case in cases}
        return plots.approaches(runs, {CASES[case].title: paper_fits()[table, case].root for case in cases})

    return draw


def force(fits: Fits, table: int, case: str, **what: bool) -> plots.Panel:
    """Force of a case and of both elements, ours and that of the paper's table."""
    theirs = fits.theirs(table, case)
    return plots.force(CASES[case].title, fits.record(case), fits.fit(case, theirs.kind), theirs, **what)


def force_and_acceleration(table: int, case: str) -> Draw:
    """The same, and the acceleration that follows."""
    return lambda fits: plots.row(force(fits, table, case), force(fits, table, case, acceleration=True))


def forces(table: int, *cases: str) -> Draw:
    """Forces of some cases."""
    return lambda fits: plots.row(*(force(fits, table, case) for case in cases))


def reduced(fits: Fits, table: int, case: str) -> plots.Panel:
    """Approach of a case and of both cubic elements, integrated."""
    found = fits.fit(case)
    ours = None if found is None else fits.integrated(found.element, case)
    theirs = fits.integrated(fits.theirs(table, case), case)
    return plots.approach(CASES[case].title, fits.record(case), ours, theirs)


def reduced_approaches(table: int, *cases: str) -> Draw:
    """Approaches of some cases."""
    return lambda fits: plots.row(*(reduced(fits, table, case) for case in cases))


def integrated(table: int, *cases: str) -> Numbers:
    """How far the cubic elements of the cases are from the full approach, and RK2(3) from Radau."""
    return lambda fits: {
        _named(whose, case): fits.difference(element, case)
        for whose, elements in _elements(fits, cases, table).items()
        for case, element in elements.items()
    }


def rms(table: int, *cases: str) -> Numbers:
    """How far the forces of the elements are from the full film's."""

    def numbers(fits: Fits) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for case in cases:
            theirs = fits.theirs(table, case)
            ours = fits.fit(case, theirs.kind)
            values[_named("the paper's", case)] = {"force_rms": fits.rms(theirs, case)}
            values[_named("our", case)] = {"force_rms": None if ours is None else ours.rms}
        return values

    return numbers


def both(first: Numbers, second: Numbers) -> Numbers:
    """Numbers of the same rows, side by side."""

    def numbers(fits: Fits) -> dict[str, Any]:
        left, right = first(fits), second(fits)
        return {name: left.get(name, {}) | right.get(name, {}) for name in (*left, *(set(right) - set(left)))}

    return numbers


def _named(whose: str, case: str) -> str:
    """Whose element of which case."""
    return f"{whose} element, {f'case {case}' if case.isdecimal() else case}"


def _cubics(fits: Fits, cases: Sequence[str]) -> dict[str, FitResult]:
    """Our cubic fits of the cases, as far as there are any."""
    return {case: found for case in cases if (found := fits.fit(case)) is not None}


def _elements(
    fits: Fits, cases: Sequence[str], table: int, motion: str | None = None
) -> dict[str, dict[str, Any]]:
    """The paper's and our elements of the cases, under the motion of one of them or each under its own."""
    ours = {case: found.element for case, found in _cubics(fits, cases).items()}
    paper = {case: fits.theirs(table, case, motion) for case in cases}
    return {"the paper's": paper, "our": ours}


def swapped(motion: str, cases: Sequence[str], table: int) -> tuple[Draw, Numbers]:
    """Elements of three cases under one motion: figure and numbers."""

    def draw(fits: Fits) -> Figure:
        runs = {
            whose: {case: fits.integrated(element, motion) for case, element in elements.items()}
            for whose, elements in _elements(fits, cases, table, motion).items()
        }
        return plots.swapped(CASES[motion].title, fits.record(motion), runs)

    def numbers(fits: Fits) -> dict[str, Any]:
        return {
            _named(whose, case): fits.difference(element, motion)
            for whose, elements in _elements(fits, cases, table, motion).items()
            for case, element in elements.items()
        }

    return draw, numbers


def springs(fits: Fits) -> Figure:
    """Fig. 16."""
    paper = {case: paper_fits()[5, case].cubic.parameters for case in HARMONIC}
    return plots.springs(paper, _cubics(fits, HARMONIC))


def spring_numbers(fits: Fits) -> dict[str, Any]:
    """Spring forces in and outside the fitted interval: polynomials and our elements."""
    values: dict[str, Any] = {}
    for case in HARMONIC:
        theirs = paper_fits()[5, case].cubic.parameters
        values[f"the paper's polynomial, case {case}"] = _at(partial(plots.polynomial, theirs))
    for case, found in _cubics(fits, HARMONIC).items():
        values[f"our polynomial, case {case}"] = _at(partial(plots.polynomial, found.parameters))
        values[f"our element, case {case}"] = _at(found.element.spring)
    return values


def _at(spring: Callable[[float], Any]) -> dict[str, float]:
    return {f"f({u:g})": float(spring(u)) for u in OUTSIDE}


def static_numbers(fits: Fits) -> dict[str, Any]:
    """Approaches at rest and what the formula has for them."""
    return {
        f"M = {M:g}, L = {L:g}": {"our u": found.approach, "Wijnant's u": wijnant_approach(M, L, 1.0)}
        for (M, L), found in fits.runs.static.items()
    }


def films_at_rest(fits: Fits) -> dict[str, Any]:
    """Minimum over central film before the ramp: the paper's two, and ours."""
    run = fits.runs.cases["validation", fits.runs.n]
    theirs = {f"the paper's, {source}": {"h_min/h_c at rest": ratio} for source, ratio in paper_films().items()}
    return theirs | {"ours": {"h_min/h_c at rest": float(run.h_min[0] / run.h_central[0])}}


def first_turns(fits: Fits) -> dict[str, Any]:
    """When the central film first turns for good."""
    run = fits.runs.cases["2", fits.runs.n]
    depth = TURN * float(np.ptp(run.h_central))
    turns = {
        name: find_peaks(sign * run.h_central, prominence=depth)[0] for name, sign in (("peak", 1), ("valley", -1))
    }
    ours = {f"first {name}, T": float(run.T[at[0]]) if at.size else None for name, at in turns.items()}
    return {"the paper's text": {"first peak, T": None, "first valley, T": FIRST_VALLEY}, "ours": ours}
