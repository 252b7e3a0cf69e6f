"""What each figure of the paper needs, shows and says, and the numbers beside it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy

from ehlcontact.cli.paper import pictures as p
from ehlcontact.cli.paper.data import FIRST_VALLEY, paper_films, paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, FREE, HARMONIC, RAMP
from ehlcontact.film_formulas import wijnant_approach
from ehlcontact.results.picture import Picture
from ehlcontact.transient.motion import FreeVibration
from ehlcontact.transient.result import SimulationResult

Numbers = dict[str, dict[str, Any]]  # by the row
OUTSIDE = (0.5, 1.0, 1.5, 2.5)  # approaches at which springs are compared in numbers
TURN = 0.2  # of its range that a film has to turn by


def integrated(fits: Fits, table: int, cases: Sequence[str], motion: str | None = None) -> Numbers:
    """How far cubic elements of the cases are from the full approach, and RK2(3) from Radau.

    All under the motion of one case, or each under its own.
    """
    return {
        _named(whose, case): fits.difference(element, motion or case)
        for whose, elements in p.elements_of(fits, cases, table, motion).items()
        for case, element in elements.items()
    }


def rms(fits: Fits, table: int, cases: Sequence[str]) -> Numbers:
    """How far the forces of the elements are from the full film's."""
    values: Numbers = {}
    for case in cases:
        theirs = fits.theirs(table, case)
        ours = fits.fit(case, theirs.kind)
        values[_named("the paper's", case)] = {"force_rms": fits.rms(theirs, case)}
        values[_named("our", case)] = {"force_rms": None if ours is None else ours.rms}
    return values


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


def films_at_rest(fits: Fits, case: str) -> Numbers:
    """Minimum over central film before the ramp: the paper's two, and ours; it has those of no other case."""
    if case not in RAMP:
        return {}
    run = fits.runs.cases[case]
    theirs = {f"the paper's, {source}": {"h_min/h_c at rest": ratio} for source, ratio in paper_films().items()}
    return theirs | {"ours": {"h_min/h_c at rest": float(run.h_min[0] / run.h_central[0])}}


def periods(fits: Fits, cases: Sequence[str]) -> Numbers:
    """Periods of free vibrations about the approach at rest, beside that of the dry contact."""
    return {
        f"case {case}": {"period of the dry contact": motion.period, "period": period(fits.runs.cases[case])}
        for case in cases
        if isinstance(motion := CASES[case].motion, FreeVibration)
    }


def period(run: SimulationResult) -> float:
    """Mean period of a vibration about the approach at rest."""
    d = run.approach - run.static_approach
    k = np.flatnonzero(d[:-1] * d[1:] < 0.0)
    crossed = run.t[k] - d[k] * (run.t[k + 1] - run.t[k]) / (d[k + 1] - d[k])
    return float(2.0 * (crossed[-1] - crossed[0]) / (crossed.size - 1))


def first_turns(fits: Fits, case: str) -> Numbers:
    """When the central film first turns for good."""
    run = fits.runs.cases[case]
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
PICTURES = "its fringes are pictures only, and not shown."
ELEMENT = "its curves are a picture only; dashed: its element, of Table {}, on our motion."


@dataclass(frozen=True)
class PaperFigure:
    """One figure; drawn only where all its cases converged."""

    number: int
    kinds: str  # of picture, or of panels side by side
    cases: tuple[str, ...]
    table: int  # of the paper, that has its elements; 0 without elements
    caption: str
    theirs: str = ""  # what of the paper's figure is shown, and what is not; its elements where left out
    elements: tuple[str, ...] = ()  # cases whose elements run under the motion of the one shown

    @property
    def paper(self) -> str:
        """What of the paper's figure is shown."""
        return self.theirs or ELEMENT.format(self.table)

    def draw(self, fits: Fits) -> Picture:
        """The picture."""
        case = self.cases[0] if self.cases else ""
        whole = {
            "static": lambda: p.static(fits),
            "fringes": lambda: p.fringes(fits, case),
            "approaches": lambda: p.approaches(fits, self.table, self.cases),
            "film": lambda: p.film(fits, case),
            "springs": lambda: p.springs(fits),
            "swapped": lambda: p.swapped(fits, self.table, case, self.elements),
        }
        if self.kinds in whole:
            return whole[self.kinds]()
        return p.side_by_side(fits, self.table, self.cases, self.kinds.split())

    def numbers(self, fits: Fits) -> Numbers:
        """Numbers beside it, row by row."""
        case, found = self.cases[0] if self.cases else "", Numbers()
        every = {
            "static": lambda: static_numbers(fits),
            "fringes": lambda: films_at_rest(fits, case),
            "approaches": lambda: periods(fits, self.cases),
            "film": lambda: first_turns(fits, case),
            "springs": lambda: spring_numbers(fits),
            "swapped": lambda: integrated(fits, self.table, self.elements, case),
            "force": lambda: rms(fits, self.table, self.cases),
            "approach": lambda: integrated(fits, self.table, self.cases),
        }
        for kind in self.kinds.split():
            for name, values in every.get(kind, Numbers)().items():
                found[name] = found.get(name, {}) | values
        return found


_FREE, _LOADED = CASES["2"].title, CASES["5"].title
EVERY = (
    PaperFigure(
        2,
        "static",
        (),
        0,
        "Approach at rest over M, for a circle, as the paper does not say for which ellipse. Points: our solves; "
        "lines: Wijnant's formula.",
        "its lines are this formula; its points are a picture only, and not shown.",
    ),
    PaperFigure(
        4,
        "fringes",
        RAMP,
        0,
        f"Pseudo-interferograms of the load ramp, {FRINGES}.",
        "its fringes are pictures only, and not shown. Its text gives the film at rest in micrometres, for scales "
        "that it does not state: only ratios compare.",
    ),
    PaperFigure(
        5,
        "approaches",
        ("2", "3"),
        3,
        f"Approach of two free vibrations, which begin by opening. {ROOTS.format(3)}",
        f"{CURVES} Its section 4 gives the period of the dry contact, 5.13/Ω_n.",
    ),
    PaperFigure(
        6,
        "film",
        ("2",),
        0,
        f"Central and minimum film, {_FREE}, which begins by opening.",
        f"{CURVES} Its text sees the first valley of the central film close to T = {FIRST_VALLEY:g}; a turn "
        f"counts here if its height is {100 * TURN:.0f} % of the film's range.",
    ),
    PaperFigure(7, "fringes", ("2",), 0, f"Pseudo-interferograms, {_FREE}, {FRINGES}.", PICTURES),
    PaperFigure(
        8, "force acceleration", ("2",), 1, "Linear element: force, and acceleration that follows from it."
    ),
    PaperFigure(
        9, "force acceleration", ("2",), 3, "Cubic element: force, and acceleration that follows from it."
    ),
    PaperFigure(10, "approach", ("2", "3"), 3, f"Cubic elements: approach, {INTEGRATED}."),
    PaperFigure(11, "approaches", ("4", "5"), 5, f"Approach under two harmonic loads. {ROOTS.format(5)}", CURVES),
    PaperFigure(12, "fringes", ("5",), 0, f"Pseudo-interferograms, {_LOADED}, {FRINGES}.", PICTURES),
    PaperFigure(13, "force", ("5",), 4, "Linear element: force."),
    PaperFigure(14, "force", ("4", "5"), 5, "Cubic elements: force."),
    PaperFigure(15, "approach", ("4", "5"), 5, f"Cubic elements: approach, {INTEGRATED}."),
    PaperFigure(
        16,
        "springs",
        HARMONIC,
        5,
        "Stiffness polynomials of cases 4 to 6, continued outside the fitted interval (shaded), and our elements "
        "(dashed).",
        "left, the coefficients of Table 5.",
    ),
    PaperFigure(
        17,
        "swapped",
        ("4",),
        5,
        f"Elements of cases 4, 5 and 6 under the load of case 4: approach, {INTEGRATED}.",
        "left, the elements of Table 5.",
        HARMONIC,
    ),
    PaperFigure(
        18,
        "swapped",
        ("3",),
        3,
        f"Elements of cases 1, 2 and 3 on the mass of case 3: approach, {INTEGRATED}.",
        "left, the elements of Table 3.",
        FREE,
    ),
    PaperFigure(
        19, "force approach", RAMP, 6, f"Cubic element of the load ramp: force, and approach {INTEGRATED}."
    ),
)
FIGURES = {figure.number: figure for figure in EVERY}
