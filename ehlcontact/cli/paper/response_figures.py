"""Figures 5, 8 to 11, 13 to 15, 17 to 19: histories of the full contact and of reduced models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ehlcontact.cli.paper.cases import CASES
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import Runs
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from reduced_models.elements.spring import MemorylessContact

COLOURS = (BLUE, ORANGE, GREEN)
Floats = NDArray[np.float64]


def approaches(runs: Runs, cases: Sequence[str]) -> Figure:
    """Figs. 5, 11: mutual approach of the full contact."""
    figure = new_figure(3.6)
    axes = figure.subplots()
    for case, colour in zip(cases, COLOURS, strict=False):
        run = runs.of(case)
        if run is not None:
            axes.plot(run.T, run.approach, color=colour, label=CASES[case].title)
    axes.set(xlabel="T", ylabel="approach", xlim=(0.0, None))
    legend_above(axes)
    return figure


def forces(fits: Fits, cases: Sequence[str], model: str, acceleration: bool = False) -> Figure:
    """Figs. 8, 9, 13, 14: force, and the acceleration that follows from it, full and fitted."""
    names = ("force", "acceleration") if acceleration else ("force",)
    panels = [(case, name) for case in cases for name in names]
    figure = new_figure(3.6)
    for axes, (case, name) in zip(figure.subplots(1, len(panels), squeeze=False).ravel(), panels, strict=True):
        _fitted(axes, fits, case, model, name)
    return figure


def ramp(fits: Fits, case: str) -> Figure:
    """Fig. 19: force and approach of the load ramp."""
    figure = new_figure(3.6)
    left, right = figure.subplots(1, 2)
    _fitted(left, fits, case, "cubic", "force")
    _integrated(right, fits, case)
    return figure


def _fitted(axes: Axes, fits: Fits, case: str, model: str, name: str) -> None:
    """Force, or the acceleration from it, of the record and of its element; grey: not fitted."""
    record, found = fits.record(case), fits.fit(case, model)
    axes.set(xlabel="T", ylabel=name, title=CASES[case].title)
    if record is None:
        return
    axes.plot(record.T, getattr(record, name), color=BLUE, label="full EHL")
    if found is not None:
        axes.axvspan(record.T[0], found.window[0][0], color="#f2f2f2", zorder=0)
        fitted = np.asarray(found.element.force(record.approach, record.rate))
        if name == "acceleration":
            assert record.omega_n is not None and record.load is not None
            fitted = record.omega_n**2 * (record.load - fitted)
        _dots(axes, record.T, fitted, f"{model} element")
    legend_above(axes)
    axes.set_title(CASES[case].title, pad=24.0)


def _integrated(axes: Axes, fits: Fits, case: str) -> None:
    """Approach of the record and of its cubic element, integrated."""
    record, found = fits.record(case), fits.fit(case)
    axes.set(xlabel="T", ylabel="approach")
    axes.set_title(CASES[case].title, pad=24.0)
    if record is None:
        return
    axes.plot(record.T, record.approach, color=BLUE, label="full EHL")
    if found is not None:
        reduced = fits.integrated(found.element, case)
        assert reduced is not None
        _dots(axes, reduced.T, reduced.approach, "cubic element, RK2(3)")
    legend_above(axes)


def _dots(axes: Axes, T: Floats, values: Floats, label: str) -> None:
    step = max(1, round(T.size / 50))
    axes.plot(T[::step], values[::step], color=RED, label=label, linestyle="none", marker="o", ms=3.5, mfc="none")


def reduced_approaches(fits: Fits, cases: Sequence[str]) -> Figure:
    """Figs. 10, 15: approach of the cubic element, integrated, against the full contact."""
    figure = new_figure(3.6)
    for axes, case in zip(figure.subplots(1, len(cases), squeeze=False).ravel(), cases, strict=True):
        _integrated(axes, fits, case)
    return figure


def one_motion(fits: Fits, motion: str, paper: Mapping[str, MemorylessContact]) -> Figure:
    """Figs. 17, 18: elements of three cases under the motion of one of them, the paper's and ours."""
    figure = new_figure(4.0)
    ours = {case: found.element for case in paper if (found := fits.fit(case)) is not None}
    record = fits.record(motion)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, (whose, elements) in zip(panels, (("paper's", paper), ("our", ours)), strict=True):
        axes.set(title=f"{whose} elements: {CASES[motion].title}", xlabel="T", ylabel="approach")
        if record is None:
            continue
        axes.plot(record.T, record.approach, color=GREY, linewidth=4.0, alpha=0.4, label="full EHL")
        for (case, element), colour in zip(elements.items(), COLOURS, strict=False):
            reduced = fits.integrated(element, motion)
            assert reduced is not None
            axes.plot(reduced.T, reduced.approach, color=colour, linewidth=1.2, label=f"element of case {case}")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure
