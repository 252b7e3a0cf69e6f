"""Figures of the paper, dimensionless: the full contact, the paper's elements and ours. Each takes the fits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, HARMONIC, STATIC_LOADS, STATIC_OILS
from ehlcontact.cli.plots.film import brightness, noted
from ehlcontact.cli.plots.maps import HIGHEST, map_axes, refined, scale_note
from ehlcontact.cli.plots.motion import add_films
from ehlcontact.cli.plots.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PALE_BLUE,
    RED,
    grid,
    label_axes,
    shaded,
    vertical,
)
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film import film_of
from ehlcontact.film.plane import Interferogram
from ehlcontact.film_formulas import wijnant_approach
from ehlcontact.point import moes_point
from reduced_models.fitting.result import FitResult

COLOURS = (BLUE, ORANGE, GREEN)  # of the cases
FARTHEST = 3.0  # approach up to which springs are drawn
THEIRS: Any = {"color": INK, "width": 1.4, "dash": "dash"}  # the paper's line
DOTS = 50  # markers of a reduced model, on top of the line of the full one
FRINGES_AT_REST = 3  # to the central film, where there is no unit of length
FADING = 2.5  # central films over which these fade
POINTS = (67, 101)  # of a map of fringes

_NAMES = units_of(None)
TIME, APPROACH, FORCE = "time T", _NAMES.approach.label, _NAMES.force.label

Draw = Callable[[Fits], go.Figure]
Panel = Callable[[Fits, go.Figure, int], None]  # draws into a column


def row(*panels: Panel, titles: Sequence[str] = ()) -> Draw:
    """Panels side by side."""

    def draw(fits: Fits) -> go.Figure:
        figure = grid(1, len(panels), heights=[270], titles=titles)
        for col, panel in enumerate(panels, start=1):
            panel(fits, figure, col)
        return figure

    return draw


def static(fits: Fits) -> go.Figure:
    """Approach at rest over the loads M, for each oil L, for a circle: solves, and Wijnant's formula."""
    figure, smooth = grid(heights=[320]), np.geomspace(STATIC_LOADS[0], STATIC_LOADS[-1], 200)
    for L, colour in zip(STATIC_OILS, (BLUE, GREEN, RED), strict=True):
        formula = [wijnant_approach(M, L, 1.0) for M in smooth]
        figure.add_scatter(x=smooth, y=formula, line_color=colour, name=f"L = {L:g}")
        solved = [(M, fits.runs.static[M, L].approach) for M in STATIC_LOADS if (M, L) in fits.runs.static]
        if solved:
            x, y = zip(*solved, strict=True)
            look: Any = {"mode": "markers", "marker": {"color": colour, "size": 7}}
            figure.add_scatter(x=x, y=y, **look, name=f"L = {L:g}")
    label_axes(figure, "load parameter M", "approach u at rest", range=[-0.1, 1.05])
    return figure.update_xaxes(type="log")


def fringes(case: str) -> Draw:
    """Fringes of a case at its snapshots, which has no unit of length: three to the central film at rest."""

    def draw(fits: Fits) -> go.Figure:
        run = fits.runs.cases[case]
        kappa, growth = moes_point(run.point).kappa, max(1.0, float(run.load.max())) ** (1.0 / 3.0)
        films = [refined(film_of(run, float(T)), POINTS, growth) for T in run.snapshot_T]
        columns = min(len(films), 4)
        titles = [f"T = {numeral(T)}" for T in run.snapshot_T]
        figure = grid(
            -(-len(films) // columns), columns, heights=[HIGHEST] * -(-len(films) // columns), titles=titles
        )
        for k, film in enumerate(films):
            at: Any = {"row": k // columns + 1, "col": k % columns + 1}
            x, y = map_axes(figure, film, kappa, **at, upwards=False)
            depth = film.H / run.h_central[0]
            order = FRINGES_AT_REST * depth
            bright = Interferogram(0.5 * (1.0 + np.cos(2.0 * np.pi * order)), order, film.X, film.Y, (1.0, 1.0))
            figure.add_heatmap(x=x, y=y, z=brightness(bright, depth / FADING).T, coloraxis="coloraxis", **at)
        figure.update_layout(coloraxis={"colorscale": "Gray", "cmin": 0.0, "cmax": 1.0, "showscale": False})
        figure.update_xaxes(title_text="X = x/a").update_yaxes(title_text="Y = y/b")
        return noted(figure, f"The surfaces move to the right. {scale_note(films[0], kappa, upwards=False)}")

    return draw


def approaches(table: int, *cases: str) -> Draw:
    """Approach of the full contact in some cases, and where the paper's cubics carry the load."""

    def panel(fits: Fits, figure: go.Figure, col: int) -> None:
        for case, colour in zip(cases, COLOURS, strict=False):
            run, root = fits.runs.cases[case], paper_fits()[table, case].root
            figure.add_scatter(x=run.T, y=run.approach, line_color=colour, name=CASES[case].title, row=1, col=col)
            look = {"name": f"root of the paper's cubic, case {case}", "line": {"color": colour, "dash": "dot"}}
            figure.add_scatter(x=run.T[[0, -1]], y=[root] * 2, **look, row=1, col=col)
        label_axes(figure, TIME, APPROACH, 1, col)

    return row(panel)


def film(case: str) -> Draw:
    """Central and minimum film, and when the first film made by the motion reaches the centre."""

    def panel(fits: Fits, figure: go.Figure, col: int) -> None:
        add_films(figure, fits.runs.cases[case])
        vertical(figure, 1.0, "inlet edge to centre at dX/dT = 1")
        label_axes(figure, TIME, _NAMES.film.label)

    return row(panel)


def force(table: int, case: str, *, acceleration: bool = False) -> Panel:
    """Force of a record, of our and the paper's element, or the acceleration of each; grey: not fitted."""

    def panel(fits: Fits, figure: go.Figure, col: int) -> None:
        record, theirs = fits.record(case), fits.theirs(table, case)
        found = fits.fit(case, theirs.kind)

        def of(element: Any) -> Any:
            fitted = np.asarray(element.force(record.approach, record.rate))
            if not acceleration:
                return fitted
            assert record.Omega_n is not None and record.load is not None
            return record.Omega_n**2 * (record.load - fitted)

        own, at = record.acceleration if acceleration else record.force, {"row": 1, "col": col}
        figure.add_scatter(x=record.T, y=own, line_color=BLUE, name="full film", **at)
        figure.add_scatter(x=record.T, y=of(theirs), line=THEIRS, name=f"paper's {theirs.kind}", **at)
        if found is not None:
            if found.window[0][0] > record.T[0]:
                shaded(figure, (float(record.T[0]), found.window[0][0]), "", 1, col)
            _dots(figure, col, record.T, of(found.element), f"our {found.model}")
        label_axes(figure, TIME, "acceleration d²u/dT²" if acceleration else FORCE, 1, col)

    return panel


def reduced(table: int, case: str) -> Panel:
    """Approach of a case and of our and the paper's cubic element, integrated."""

    def panel(fits: Fits, figure: go.Figure, col: int) -> None:
        record, found = fits.record(case), fits.fit(case)
        theirs, at = fits.integrated(fits.theirs(table, case), case), {"row": 1, "col": col}
        figure.add_scatter(x=record.T, y=record.approach, line_color=BLUE, name="full film", **at)
        figure.add_scatter(x=theirs.T, y=theirs.approach, line=THEIRS, name="paper's cubic", **at)
        if found is not None:
            ours = fits.integrated(found.element, case)
            _dots(figure, col, ours.T, ours.approach, "our cubic")
        label_axes(figure, TIME, APPROACH, 1, col)

    return panel


def of_cases(panel: Callable[[int, str], Panel], table: int, *cases: str) -> Draw:
    """The same panel for some cases."""
    return row(*(panel(table, case) for case in cases), titles=[CASES[case].title for case in cases])


def force_and_acceleration(table: int, case: str) -> Draw:
    """Force, and the acceleration that follows."""
    return row(force(table, case), force(table, case, acceleration=True), titles=[CASES[case].title] * 2)


def force_and_approach(table: int, case: str) -> Draw:
    """Force, and approach of the elements, integrated."""
    return row(force(table, case), reduced(table, case), titles=[CASES[case].title] * 2)


def elements_of(
    fits: Fits, cases: Sequence[str], table: int, motion: str | None = None
) -> dict[str, dict[str, Any]]:
    """The paper's and our elements of the cases, under the motion of one of them or each under its own."""
    ours = {case: found.element for case, found in cubics_of(fits, cases).items()}
    return {"the paper's": {case: fits.theirs(table, case, motion) for case in cases}, "our": ours}


def cubics_of(fits: Fits, cases: Sequence[str]) -> dict[str, FitResult]:
    """Our cubic fits of the cases, as far as there are any."""
    return {case: found for case in cases if (found := fits.fit(case)) is not None}


def swapped(motion: str, cases: Sequence[str], table: int) -> Draw:
    """Elements of several cases under the motion of one of them."""

    def draw(fits: Fits) -> go.Figure:
        record, every = fits.record(motion), elements_of(fits, cases, table, motion)
        titles = [f"{whose} elements: {CASES[motion].title}" for whose in every]
        figure = grid(1, len(every), heights=[290], titles=titles)
        for col, elements in enumerate(every.values(), start=1):
            full: Any = {"line": {"color": GREY, "width": 5.0}, "name": "full film", "row": 1, "col": col}
            figure.add_scatter(x=record.T, y=record.approach, **full)
            for (case, element), colour in zip(elements.items(), COLOURS, strict=False):
                run, line = fits.integrated(element, motion), {"color": colour, "width": 1.5}
                name = f"element of case {case}"
                figure.add_scatter(x=run.T, y=run.approach, line=line, name=name, row=1, col=col)
            label_axes(figure, TIME, APPROACH, 1, col)
        return figure.update_yaxes(matches="y", row=1, col=2)

    return draw


def springs(fits: Fits) -> go.Figure:
    """Stiffness polynomials of cases 4 to 6, the paper's and ours, our elements, and the dry contact."""
    figure = grid(1, 2, heights=[330], titles=["paper", "ours; shaded: fitted"])
    u = np.linspace(0.0, FARTHEST, 400)
    for case, colour in zip(HARMONIC, COLOURS, strict=True):
        theirs = polynomial(paper_fits()[5, case].cubic.parameters, u)
        figure.add_scatter(x=u, y=theirs, line_color=colour, name=f"case {case}, polynomial", row=1, col=1)
    for (case, found), colour in zip(cubics_of(fits, HARMONIC).items(), COLOURS, strict=False):
        at: Any = {"row": 1, "col": 2}
        ours = polynomial(found.parameters, u)
        figure.add_scatter(x=u, y=ours, line_color=colour, name=f"case {case}, polynomial", **at)
        element, dash = np.asarray(found.element.spring(u)), {"color": colour, "dash": "dash"}
        figure.add_scatter(x=u, y=element, line=dash, name=f"case {case}, element", **at)
        shaded(figure, (found.valid["low"], found.valid["high"]), "", 1, 2, PALE_BLUE)
    for col in (1, 2):
        dry: Any = {"line": {"color": GREY, "dash": "dot"}, "name": "dry Hertz"}
        figure.add_scatter(x=u, y=u**1.5, **dry, row=1, col=col)
        label_axes(figure, APPROACH, "spring force f/f0", 1, col, range=[-0.5, 6.0])
    return figure.update_xaxes(range=[0.0, FARTHEST])


def polynomial(coefficients: Any, u: Any) -> Any:
    """``u (K1 + u (K2 + u K3))``."""
    K1, K2, K3 = (coefficients[name] for name in ("K1", "K2", "K3"))
    return u * (K1 + u * (K2 + u * K3))


def _dots(figure: go.Figure, col: int, T: Any, values: Any, name: str) -> None:
    step = max(1, round(T.size / DOTS))
    marker = {"symbol": "circle-open", "size": 5, "color": RED}
    figure.add_scatter(x=T[::step], y=values[::step], mode="markers", marker=marker, name=name, row=1, col=col)
