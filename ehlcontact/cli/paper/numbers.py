"""Numbers beside the figures of the paper: rows by name, each with its numbers by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy.signal import find_peaks

from ehlcontact.cli.paper.data import FIRST_VALLEY, paper_films, paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.pictures import cubics_of, elements_of, polynomial
from ehlcontact.cli.paper.runs import HARMONIC
from ehlcontact.formulas import wijnant_approach

Numbers = Callable[[Fits], dict[str, Any]]
OUTSIDE = (0.5, 1.0, 1.5, 2.5)  # approaches at which springs are compared in numbers
TURN = 0.2  # of its range that a film has to turn by


def integrated(table: int, *cases: str) -> Numbers:
    """How far the cubic elements of the cases are from the full approach, and RK2(3) from Radau."""
    return lambda fits: {
        _named(whose, case): fits.difference(element, case)
        for whose, elements in elements_of(fits, cases, table).items()
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


def swapped(motion: str, cases: Sequence[str], table: int) -> Numbers:
    """How far elements of several cases are from the full approach under the motion of one of them."""
    return lambda fits: {
        _named(whose, case): fits.difference(element, motion)
        for whose, elements in elements_of(fits, cases, table, motion).items()
        for case, element in elements.items()
    }


def spring_numbers(fits: Fits) -> dict[str, Any]:
    """Spring forces in and outside the fitted interval: polynomials and our elements."""
    values: dict[str, Any] = {}
    for case in HARMONIC:
        theirs = paper_fits()[5, case].cubic.parameters
        values[f"the paper's polynomial, case {case}"] = _at(partial(polynomial, theirs))
    for case, found in cubics_of(fits, HARMONIC).items():
        values[f"our polynomial, case {case}"] = _at(partial(polynomial, found.parameters))
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
