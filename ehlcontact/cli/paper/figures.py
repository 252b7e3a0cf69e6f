"""What each figure of the paper needs, shows and says, and the numbers beside it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy

from ehlcontact.cli.paper import pictures as p
from ehlcontact.cli.paper.data import FIRST_VALLEY, paper_films, paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, FREE, HARMONIC
from ehlcontact.film_formulas import wijnant_approach
from ehlcontact.transient.motion import FreeVibration
from ehlcontact.transient.result import SimulationResult

Numbers = Callable[[Fits], dict[str, Any]]
OUTSIDE = (0.5, 1.0, 1.5, 2.5)  # approaches at which springs are compared in numbers
TURN = 0.2  # of its range that a film has to turn by


def integrated(table: int, *cases: str, motion: str | None = None) -> Numbers:
    """How far cubic elements of the cases are from the full approach, and RK2(3) from Radau.

    All under the motion of one case, or each under its own.
    """
    return lambda fits: {
        _named(whose, case): fits.difference(element, motion or case)
        for whose, elements in p.elements_of(fits, cases, table, motion).items()
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


def spring_numbers(fits: Fits) -> dict[str, Any]:
    """Spring forces in and outside the fitted interval: polynomials and our elements."""
    values: dict[str, Any] = {}
    for case in HARMONIC:
        theirs = paper_fits()[5, case].cubic.parameters
        values[f"the paper's polynomial, case {case}"] = _at(partial(p.polynomial, theirs))
    for case, found in p.cubics_of(fits, HARMONIC).items():
        values[f"our polynomial, case {case}"] = _at(partial(p.polynomial, found.parameters))
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
    run = fits.runs.cases["validation"]
    theirs = {f"the paper's, {source}": {"h_min/h_c at rest": ratio} for source, ratio in paper_films().items()}
    return theirs | {"ours": {"h_min/h_c at rest": float(run.h_min[0] / run.h_central[0])}}


def periods(*cases: str) -> Numbers:
    """Periods of free vibrations about the approach at rest, beside that of the dry contact."""

    def numbers(fits: Fits) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for case in cases:
            run, motion = fits.runs.cases[case], CASES[case].motion
            assert isinstance(motion, FreeVibration)
            values[f"case {case}"] = {"period of the dry contact": motion.period, "period": period(run)}
        return values

    return numbers


def period(run: SimulationResult) -> float:
    """Mean period of a vibration about the approach at rest."""
    d = run.approach - run.static_approach
    k = np.flatnonzero(d[:-1] * d[1:] < 0.0)
    crossed = run.t[k] - d[k] * (run.t[k + 1] - run.t[k]) / (d[k + 1] - d[k])
    return float(2.0 * (crossed[-1] - crossed[0]) / (crossed.size - 1))


def first_turns(fits: Fits) -> dict[str, Any]:
    """When the central film first turns for good."""
    run = fits.runs.cases["2"]
    depth = TURN * float(np.ptp(run.h_central))
    turns = {
        name: scipy.signal.find_peaks(sign * run.h_central, prominence=depth)[0]
        for name, sign in (("peak", 1), ("valley", -1))
    }
    ours = {f"first {name}, T": float(run.t[at[0]]) if at.size else None for name, at in turns.items()}
    return {"the paper's text": {"first peak, T": None, "first valley, T": FIRST_VALLEY}, "ours": ours}


# What several captions say.
FRINGES = f"{p.FRINGES_AT_REST} fringes to the central film at rest"
ROOTS = "Dotted: approach at which the paper's cubics (Table {}) carry the static load."
INTEGRATED = "integrated by Bogacki-Shampine RK2(3) from the start of the fitted window"
# What there is of the paper in a figure.
CURVES = "its curves are a picture only, and not shown."
ELEMENT = "its curves are a picture only; dashed: its element, of Table {}, on our motion."


@dataclass(frozen=True)
class PaperFigure:
    """One figure; drawn only where all its cases converged."""

    number: int
    cases: tuple[str, ...]
    caption: str
    theirs: str  # what of the paper's figure is shown, and what is not
    draw: p.Draw
    numbers: Numbers = lambda fits: {}


FIGURES = {
    figure.number: figure
    for figure in (
        PaperFigure(
            2,
            (),
            "Approach at rest over M, for a circle, as the paper does not say for which ellipse. Points: our "
            "solves; lines: Wijnant's formula.",
            "its lines are this formula; its points are a picture only, and not shown.",
            p.static,
            static_numbers,
        ),
        PaperFigure(
            4,
            ("validation",),
            f"Pseudo-interferograms of the load ramp, {FRINGES}.",
            "its fringes are pictures only, and not shown. Its text gives the film at rest in micrometres, for "
            "scales that it does not state: only ratios compare.",
            p.fringes("validation"),
            films_at_rest,
        ),
        PaperFigure(
            5,
            ("2", "3"),
            f"Approach of two free vibrations, which begin by opening. {ROOTS.format(3)}",
            f"{CURVES} Its section 4 gives the period of the dry contact, 5.13/Ω_n.",
            p.approaches(3, "2", "3"),
            periods("2", "3"),
        ),
        PaperFigure(
            6,
            ("2",),
            f"Central and minimum film, {CASES['2'].title}, which begins by opening.",
            f"{CURVES} Its text sees the first valley of the central film close to T = {FIRST_VALLEY:g}; a turn "
            f"counts here if its height is {100 * TURN:.0f} % of the film's range.",
            p.film("2"),
            first_turns,
        ),
        PaperFigure(
            7,
            ("2",),
            f"Pseudo-interferograms, {CASES['2'].title}, {FRINGES}.",
            "its fringes are pictures only, and not shown.",
            p.fringes("2"),
        ),
        PaperFigure(
            8,
            ("2",),
            "Linear element: force, and acceleration that follows from it.",
            ELEMENT.format(1),
            p.force_and_acceleration(1, "2"),
            rms(1, "2"),
        ),
        PaperFigure(
            9,
            ("2",),
            "Cubic element: force, and acceleration that follows from it.",
            ELEMENT.format(3),
            p.force_and_acceleration(3, "2"),
            rms(3, "2"),
        ),
        PaperFigure(
            10,
            ("2", "3"),
            f"Cubic elements: approach, {INTEGRATED}.",
            ELEMENT.format(3),
            p.of_cases(p.reduced, 3, "2", "3"),
            integrated(3, "2", "3"),
        ),
        PaperFigure(
            11,
            ("4", "5"),
            f"Approach under two harmonic loads. {ROOTS.format(5)}",
            CURVES,
            p.approaches(5, "4", "5"),
        ),
        PaperFigure(
            12,
            ("5",),
            f"Pseudo-interferograms, {CASES['5'].title}, {FRINGES}.",
            "its fringes are pictures only, and not shown.",
            p.fringes("5"),
        ),
        PaperFigure(
            13, ("5",), "Linear element: force.", ELEMENT.format(4), p.of_cases(p.force, 4, "5"), rms(4, "5")
        ),
        PaperFigure(
            14,
            ("4", "5"),
            "Cubic elements: force.",
            ELEMENT.format(5),
            p.of_cases(p.force, 5, "4", "5"),
            rms(5, "4", "5"),
        ),
        PaperFigure(
            15,
            ("4", "5"),
            f"Cubic elements: approach, {INTEGRATED}.",
            ELEMENT.format(5),
            p.of_cases(p.reduced, 5, "4", "5"),
            integrated(5, "4", "5"),
        ),
        PaperFigure(
            16,
            HARMONIC,
            "Stiffness polynomials of cases 4 to 6, continued outside the fitted interval (shaded), and our "
            "elements (dashed).",
            "left, the coefficients of Table 5.",
            p.springs,
            spring_numbers,
        ),
        PaperFigure(
            17,
            ("4",),
            f"Elements of cases 4, 5 and 6 under the load of case 4: approach, {INTEGRATED}.",
            "left, the elements of Table 5.",
            p.swapped("4", HARMONIC, 5),
            integrated(5, *HARMONIC, motion="4"),
        ),
        PaperFigure(
            18,
            ("3",),
            f"Elements of cases 1, 2 and 3 on the mass of case 3: approach, {INTEGRATED}.",
            "left, the elements of Table 3.",
            p.swapped("3", FREE, 3),
            integrated(3, *FREE, motion="3"),
        ),
        PaperFigure(
            19,
            ("validation",),
            f"Cubic element of the load ramp: force, and approach {INTEGRATED}.",
            ELEMENT.format(6),
            p.force_and_approach(6, "validation"),
            both(rms(6, "validation"), integrated(6, "validation")),
        ),
    )
}
# Simulations that a figure's elements come from, besides those it shows.
ELEMENTS_OF = {17: HARMONIC, 18: FREE}
