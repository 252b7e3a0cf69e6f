"""Figures of the paper, dimensionless: the full contact, the paper's elements and ours. Each takes the fits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, HARMONIC, STATIC_LOADS, STATIC_OILS
from ehlcontact.film import film_of
from ehlcontact.film.pictures import brightness, refined
from ehlcontact.film.plane import Interferogram
from ehlcontact.film_formulas import wijnant_approach
from ehlcontact.quantities import FORCE, LENGTH, TIME
from ehlcontact.results.contact_map import MOVES, TALL, ContactView
from ehlcontact.results.picture import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PALE_BLUE,
    RED,
    Band,
    Line,
    Mark,
    Panel,
    Picture,
)
from reduced_models.fitting.pictures import film_lines
from reduced_models.fitting.result import FitResult

COLOURS = (BLUE, ORANGE, GREEN)  # of the cases
FARTHEST = 3.0  # approach up to which springs are drawn
THEIRS: Any = {"colour": INK, "width": 1.0, "dash": "--"}  # the paper's line
DOTS = 50  # markers of a reduced model, on top of the line of the full one
FRINGES_AT_REST = 3  # to the central film, where there is no unit of length
FADING = 2.5  # central films over which these fade
POINTS = (67, 101)  # of a map of fringes

TIMES, APPROACH, FORCES = ("time", TIME.moes), ("approach", LENGTH.moes), ("force", FORCE.moes)


def static(fits: Fits) -> Picture:
    """Approach at rest over the loads M, for each oil L, for a circle: solves, and Wijnant's formula."""
    smooth, lines = np.geomspace(STATIC_LOADS[0], STATIC_LOADS[-1], 200), []
    for L, colour in zip(STATIC_OILS, (BLUE, GREEN, RED), strict=True):
        formula = [wijnant_approach(M, L, 1.0) for M in smooth]
        lines.append(Line(smooth, formula, f"L = {L:g}", colour))
        solved = [(M, fits.runs.static[M, L].approach) for M in STATIC_LOADS if (M, L) in fits.runs.static]
        if solved:
            x, y = zip(*solved, strict=True)
            lines.append(Line(x, y, f"L = {L:g}", colour, "", "o"))
    panel = Panel(lines, "load parameter M", ("approach at rest", LENGTH.moes), logs="X", y_ends=(-0.1, 1.05))
    return Picture([panel], heights=(320.0,))


def fringes(fits: Fits, case: str) -> Picture:
    """Fringes of a case at its snapshots, which has no unit of length: three to the central film at rest."""
    run = fits.runs.cases[case]
    growth = max(1.0, float(run.load.max())) ** (1.0 / 3.0)
    panels = []
    for T in run.snapshot_t:
        film = refined(film_of(run, float(T)), POINTS, growth)
        view = ContactView.of(film.point, film.x, film.y)
        depth = film.h / run.h_central[0]
        order = FRINGES_AT_REST * depth
        bright = Interferogram(0.5 * (1.0 + np.cos(2.0 * np.pi * order)), order, film.x, film.y, (1.0, 1.0))
        shown = brightness(bright, depth / FADING)
        panels.append(view.map(shown, "", "gray", (0.0, 1.0), title=f"T = {numeral(T)}"))
    note = f"{MOVES[view.upwards].capitalize()}. {view.note}".strip()
    return Picture(panels, columns=min(len(panels), 4), heights=(TALL,), note=note)


def approaches(fits: Fits, table: int, cases: Sequence[str]) -> Picture:
    """Approach of the full contact in some cases, and where the paper's cubics carry the load."""
    lines = []
    for case, colour in zip(cases, COLOURS, strict=False):
        run, root = fits.runs.cases[case], paper_fits()[table, case].root
        lines.append(Line(run.t, run.approach, CASES[case].title, colour))
        lines.append(Line(run.t[[0, -1]], [root] * 2, f"root of the paper's cubic, case {case}", colour, ":"))
    return Picture([Panel(lines, TIMES, APPROACH)])


def film(fits: Fits, case: str) -> Picture:
    """Central and minimum film, and when the first film made by the motion reaches the centre."""
    marks = (Mark(1.0, "inlet edge to centre at the speed of the surfaces"),)
    return Picture([Panel(film_lines(fits.runs.cases[case]), TIMES, ("film", LENGTH.moes), marks=marks)])


def force(fits: Fits, table: int, case: str, *, acceleration: bool = False) -> Panel:
    """Force of a record, of our and the paper's element, or the acceleration of each; grey: not fitted."""
    record, theirs = fits.record(case), fits.theirs(table, case)
    found, bands = fits.fit(case, theirs.kind), list[Band]()

    def of(element: Any) -> Any:
        fitted = np.asarray(element.force(record.approach, record.rate))
        if not acceleration:
            return fitted
        assert record.mass is not None and record.load is not None
        return (record.load - fitted) / record.mass

    own = record.acceleration if acceleration else record.force
    lines = [
        Line(record.t, own, "full film", BLUE),
        Line(record.t, of(theirs), f"paper's {theirs.kind}", **THEIRS),
    ]
    if found is not None:
        if found.window[0][0] > record.t[0]:
            bands.append(Band(float(record.t[0]), found.window[0][0]))
        lines.append(_dots(record.t, of(found.element), f"our {found.model}"))
    return Panel(lines, TIMES, "acceleration d²u/dT²" if acceleration else FORCES, bands=bands)


def reduced(fits: Fits, table: int, case: str) -> Panel:
    """Approach of a case and of our and the paper's cubic element, integrated."""
    record, found = fits.record(case), fits.fit(case)
    theirs = fits.integrated(fits.theirs(table, case), case)
    lines = [
        Line(record.t, record.approach, "full film", BLUE),
        Line(theirs.T, theirs.approach, "paper's cubic", **THEIRS),
    ]
    if found is not None:
        ours = fits.integrated(found.element, case)
        lines.append(_dots(ours.T, ours.approach, "our cubic"))
    return Panel(lines, TIMES, APPROACH)


PANELS: dict[str, Callable[[Fits, int, str], Panel]] = {
    "force": force,
    "acceleration": partial(force, acceleration=True),
    "approach": reduced,
}


def side_by_side(fits: Fits, table: int, cases: Sequence[str], kinds: Sequence[str]) -> Picture:
    """Panels of some kinds for some cases."""
    found = [replace(PANELS[kind](fits, table, case), title=CASES[case].title) for case in cases for kind in kinds]
    return Picture(found, columns=len(found))


def elements_of(
    fits: Fits, cases: Sequence[str], table: int, motion: str | None = None
) -> dict[str, dict[str, Any]]:
    """The paper's and our elements of the cases, under the motion of one of them or each under its own."""
    ours = {case: found.element for case, found in cubics_of(fits, cases).items()}
    return {"the paper's": {case: fits.theirs(table, case, motion) for case in cases}, "our": ours}


def cubics_of(fits: Fits, cases: Sequence[str]) -> dict[str, FitResult]:
    """Our cubic fits of the cases, as far as there are any."""
    return {case: found for case in cases if (found := fits.fit(case)) is not None}


def swapped(fits: Fits, table: int, motion: str, cases: Sequence[str]) -> Picture:
    """Elements of several cases under the motion of one of them."""
    record, panels = fits.record(motion), []
    for whose, elements in elements_of(fits, cases, table, motion).items():
        lines = [Line(record.t, record.approach, "full film", GREY, width=3.5)]
        for (case, element), colour in zip(elements.items(), COLOURS, strict=False):
            run = fits.integrated(element, motion)
            lines.append(Line(run.T, run.approach, f"element of case {case}", colour, width=1.1))
        panels.append(Panel(lines, TIMES, APPROACH, title=f"{whose} elements: {CASES[motion].title}"))
    every = np.concatenate([np.ravel(line.y) for panel in panels for line in panel.lines])
    room = 0.05 * float(np.ptp(every))
    ends = float(every.min()) - room, float(every.max()) + room
    return Picture([replace(panel, y_ends=ends) for panel in panels], heights=(290.0,))


def springs(fits: Fits) -> Picture:
    """Stiffness polynomials of cases 4 to 6, the paper's and ours, our elements, and the dry contact."""
    u, sides = np.linspace(0.0, FARTHEST, 400), (list[Line](), list[Line]())
    bands = []
    for case, colour in zip(HARMONIC, COLOURS, strict=True):
        theirs = polynomial(paper_fits()[5, case].cubic.parameters, u)
        sides[0].append(Line(u, theirs, f"case {case}, polynomial", colour))
    for (case, found), colour in zip(cubics_of(fits, HARMONIC).items(), COLOURS, strict=False):
        sides[1].append(Line(u, polynomial(found.parameters, u), f"case {case}, polynomial", colour))
        sides[1].append(Line(u, np.asarray(found.element.spring(u)), f"case {case}, element", colour, "--"))
        bands.append(Band(found.valid["low"], found.valid["high"], "", PALE_BLUE))
    panels = [
        Panel(
            [*lines, Line(u, u**1.5, "dry Hertz", GREY, ":")],
            APPROACH,
            ("spring force", FORCE.moes),
            title=title,
            x_ends=(0.0, FARTHEST),
            y_ends=(-0.5, 6.0),
            bands=shaded,
        )
        for lines, title, shaded in zip(sides, ("paper", "ours; shaded: fitted"), ((), bands), strict=True)
    ]
    return Picture(panels, heights=(330.0,))


def polynomial(coefficients: Any, u: Any) -> Any:
    """``u (K1 + u (K2 + u K3))``."""
    K1, K2, K3 = (coefficients[name] for name in ("K1", "K2", "K3"))
    return u * (K1 + u * (K2 + u * K3))


def _dots(T: Any, values: Any, name: str) -> Line:
    step = max(1, round(T.size / DOTS))
    return Line(T[::step], values[::step], name, RED, "", "o ")
