"""Histories, approaches and springs as the paper shows them, dimensionless: full contact and reduced models."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ehlcontact.cli.plots.motion import draw_film
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.cli.plots.units import units_of
from ehlcontact.formulas import wijnant_approach
from ehlcontact.transient.result import SimulationResult
from reduced_models import ContactRecord, CubicContact, FitResult, LinearContact, OscillatorResult

COLOURS = (BLUE, ORANGE, GREEN)  # of the cases
FARTHEST = 3.0  # approach up to which springs are drawn
THEIRS: Any = {"color": "black", "linewidth": 1.1, "linestyle": (0, (5, 4)), "zorder": 3}  # the paper's line
DOTS = 50  # markers of a reduced model, on top of the line of the full one

_NAMES = units_of(None)
TIME, APPROACH, FORCE = "time T", _NAMES.approach.label, _NAMES.force.label

Panel = Callable[[Axes], None]
Floats = NDArray[np.float64]


def row(*panels: Panel) -> Figure:
    """Panels side by side."""
    figure = new_figure(3.6)
    for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False).ravel(), panels, strict=True):
        panel(axes)
    return figure


def static_approach(
    solved: Mapping[tuple[float, float], float], loads: Sequence[float], oils: Sequence[float]
) -> Figure:
    """Approach at rest over the loads M, for each oil L: solves by (M, L), and Wijnant's formula, for a circle."""
    figure = new_figure(4.2, 7.0)
    axes = figure.subplots()
    smooth = np.geomspace(loads[0], loads[-1], 200)
    for L, colour in zip(oils, (BLUE, GREEN, RED), strict=True):
        axes.semilogx(smooth, [wijnant_approach(M, L, 1.0) for M in smooth], color=colour, label=f"L = {L:g}")
        found = [(M, solved[M, L]) for M in loads if (M, L) in solved]
        if found:
            axes.semilogx(*zip(*found, strict=True), "o", color=colour, markersize=5)
    axes.set(xlabel="load parameter M", ylabel="approach u at rest", ylim=(-0.1, 1.05))
    legend_above(axes)
    return figure


def approaches(runs: Mapping[str, SimulationResult], roots: Mapping[str, float]) -> Figure:
    """Approach of the full contact in several motions, by title, and where the paper's cubics carry the load."""

    def panel(axes: Axes) -> None:
        for (title, run), colour in zip(runs.items(), COLOURS, strict=False):
            axes.plot(run.T, run.approach, color=colour, label=title)
        for k, (title, colour) in enumerate(zip(runs, COLOURS, strict=False)):
            label = "roots of the paper's cubics" if k == 0 else None
            axes.axhline(roots[title], color=colour, linestyle=":", linewidth=1.2, label=label)
        axes.set(xlabel=TIME, ylabel=APPROACH, xlim=(0.0, None))
        legend_above(axes)

    return row(panel)


def film(run: SimulationResult) -> Figure:
    """Central and minimum film, and when the first film made by the motion reaches the centre."""

    def panel(axes: Axes) -> None:
        draw_film(axes, run)
        axes.axvline(1.0, color=GREY, linestyle=":", label="inlet edge to centre at dX/dT = 1")
        legend_above(axes)

    return row(panel)


def force(
    title: str,
    record: ContactRecord,
    found: FitResult | None,
    theirs: LinearContact | CubicContact,
    *,
    acceleration: bool = False,
) -> Panel:
    """Force of a record, of our and the paper's element, or the acceleration of each; grey: not fitted."""

    def of(element: Any) -> Floats:
        fitted: Floats = np.asarray(element.force(record.approach, record.rate))
        if not acceleration:
            return fitted
        assert record.Omega_n is not None and record.load is not None
        return record.Omega_n**2 * (record.load - fitted)

    def panel(axes: Axes) -> None:
        name = "acceleration" if acceleration else "force"
        axes.set(xlabel=TIME, ylabel="acceleration d²u/dT²" if acceleration else FORCE)
        axes.plot(record.T, getattr(record, name), color=BLUE, label="full film")
        axes.plot(record.T, of(theirs), **THEIRS, label=f"paper's {theirs.kind}")
        if found is not None:
            if found.window[0][0] > record.T[0]:
                axes.axvspan(record.T[0], found.window[0][0], color="#f2f2f2", zorder=0)
            _dots(axes, record.T, of(found.element), f"our {found.model}")
        legend_above(axes)
        axes.set_title(title, pad=24.0)

    return panel


def approach(
    title: str, record: ContactRecord, reduced: OscillatorResult | None, theirs: OscillatorResult
) -> Panel:
    """Approach of a record and of our and the paper's cubic element, integrated."""

    def panel(axes: Axes) -> None:
        axes.set(xlabel=TIME, ylabel=APPROACH)
        axes.plot(record.T, record.approach, color=BLUE, label="full film")
        axes.plot(theirs.T, theirs.approach, **THEIRS, label="paper's cubic")
        if reduced is not None:
            _dots(axes, reduced.T, reduced.approach, "our cubic")
        legend_above(axes)
        axes.set_title(title, pad=24.0)

    return panel


def swapped(title: str, record: ContactRecord, reduced: Mapping[str, Mapping[str, OscillatorResult]]) -> Figure:
    """Elements of several cases under the motion of one of them: whose elements, case, and its run."""
    figure = new_figure(4.0)
    panels = figure.subplots(1, len(reduced), sharey=True)
    for axes, (whose, runs) in zip(panels, reduced.items(), strict=True):
        axes.set(title=f"{whose} elements: {title}", xlabel=TIME, ylabel=APPROACH)
        axes.plot(record.T, record.approach, color=GREY, linewidth=4.0, alpha=0.4, label="full film")
        for (case, run), colour in zip(runs.items(), COLOURS, strict=False):
            axes.plot(run.T, run.approach, color=colour, linewidth=1.2, label=f"element of case {case}")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def springs(paper: Mapping[str, Mapping[str, float]], ours: Mapping[str, FitResult]) -> Figure:
    """Stiffness polynomials by case, of the paper's coefficients and ours, our elements, and the dry contact."""
    figure = new_figure(4.4)
    u = np.linspace(0.0, FARTHEST, 400)
    left, right = figure.subplots(1, 2, sharey=True)
    for (case, coefficients), colour in zip(paper.items(), COLOURS, strict=False):
        left.plot(u, polynomial(coefficients, u), color=colour, label=f"case {case}")
        found = ours.get(case)
        if found is None:
            continue
        right.plot(u, polynomial(found.parameters, u), color=colour, label=f"case {case}, polynomial")
        right.plot(u, np.asarray(found.element.spring(u)), "--", color=colour, label=f"case {case}, element")
        right.axvspan(found.valid["low"], found.valid["high"], color="#eaf3fa", zorder=0)
    for axes, title in ((left, "paper"), (right, "ours; shaded: fitted")):
        axes.plot(u, u**1.5, ":", color=GREY, label="dry Hertz")
        axes.set(title=title, xlabel=APPROACH, ylabel="spring force f/f0", ylim=(-0.5, 6.0), xlim=(0.0, FARTHEST))
        axes.legend(loc="upper left")
    return figure


def polynomial(coefficients: Mapping[str, float], u: Any) -> Any:
    """``u (K1 + u (K2 + u K3))``."""
    K1, K2, K3 = (coefficients[name] for name in ("K1", "K2", "K3"))
    return u * (K1 + u * (K2 + u * K3))


def _dots(axes: Axes, T: Floats, values: Floats, label: str) -> None:
    step = max(1, round(T.size / DOTS))
    axes.plot(T[::step], values[::step], color=RED, label=label, linestyle="none", marker="o", ms=3.5, mfc="none")
