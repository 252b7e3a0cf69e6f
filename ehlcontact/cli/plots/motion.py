"""The transient contact: histories, film waves, force against approach, and what the elements make of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film import film_wave
from ehlcontact.transient.result import SimulationResult
from reduced_models import FitResult

WITHIN = 1.1  # semi-axes of the film wave shown: beyond, the film follows the approach at once
POINTS = (401, 221)  # of its picture over time and place: interpolated smoothly, so that it does not show the grid
CARRIED = 0.9  # semi-axes within which the film is that of the wave alone, which sets the colours


def simulation_figure(run: SimulationResult) -> Figure:
    """Histories beside the film wave and the force loop: the figure of ``simulate --figure``."""
    figure = new_figure(6.4, 10.5)
    parts: Any = figure.subfigures(1, 2, width_ratios=(1.0, 1.1))
    left, right = parts
    _histories(left.subplots(3, 1, sharex=True), run)
    wave, loop = right.subplots(2, 1, height_ratios=(1.1, 1.0))
    _wave(wave, run)
    wave.set_title("film wave; dashed: carried at dX/dT = 1", loc="left")
    units = units_of(run.scales)
    _loop(loop, run, slice(None))
    loop.plot(units.approach(run.approach[0]), units.force(run.force[0]), "o", color=ORANGE, label="T = 0")
    loop.set(xlabel=units.approach.label, ylabel=units.force.label)
    legend_above(loop)
    return figure


def histories(run: SimulationResult, fitted: FitResult | None) -> Figure:
    """Approach, force and film over time, with the fitted force."""
    figure = new_figure(6.0)
    _histories(figure.subplots(3, 1, sharex=True), run, fitted)
    figure.align_ylabels()
    return figure


def wave(run: SimulationResult) -> Figure:
    """Change of the mid-plane film over place and time: waves that run through at the mean surface speed."""
    figure = new_figure(4.4)
    axes = figure.subplots()
    _wave(axes, run)
    axes.set_title("dashed: carried through at dX/dT = 1")
    if run.scales is not None:
        unit = run.scales.a * 1e3
        place = axes.secondary_yaxis(
            "right", functions=(lambda v: np.multiply(v, unit), lambda v: np.divide(v, unit))
        )
        place.set_ylabel("x [mm]")
    return figure


def loops(
    runs: Mapping[str, SimulationResult], fits: Mapping[str, FitResult], titles: Mapping[str, str]
) -> Figure:
    """Force against approach of each record with its cubic element; below, the part that is not its spring."""
    figure = new_figure(6.6, 11.0)
    panels = figure.subplots(2, len(runs), squeeze=False, sharex="col", height_ratios=(3, 2))
    units = units_of(next(iter(runs.values())).scales)
    for (upper, lower), (name, run) in zip(panels.T, runs.items(), strict=True):
        upper.set_title(titles[name])
        lower.set_xlabel(units.approach.label)
        if name in fits:
            _fitted_loop(upper, lower, run, fits[name])
        else:
            _loop(upper, run, slice(None))
    panels[0, 0].set_ylabel(units.force.label)
    panels[1, 0].set_ylabel(units.force.label.replace("force", "force less static law"))
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    figure.align_ylabels()
    return figure


def draw_film(axes: Axes, run: SimulationResult) -> None:
    """Central and minimum film over time."""
    units = units_of(run.scales)
    axes.plot(units.time(run.T), units.film(run.h_central), color=GREEN, label="centre")
    axes.plot(units.time(run.T), units.film(run.h_min), color=ORANGE, label="minimum")
    axes.set(ylabel=units.film.label, xlabel=units.time.label, xlim=(0.0, units.time(run.T[-1])))


def _histories(panels: Sequence[Axes], run: SimulationResult, fitted: FitResult | None = None) -> None:
    """Approach, force with the fitted one or else the load, and film."""
    units = units_of(run.scales)
    top, middle, bottom = panels
    t = units.time(run.T)
    top.plot(t, units.approach(run.approach), color=BLUE)
    top.axhline(units.approach(run.static_approach), color=GREY, linestyle=":", label="at rest")
    top.set_ylabel(units.approach.label)
    middle.plot(t, units.force(run.force), color=BLUE, label="film")
    middle.set_ylabel(units.force.label)
    draw_film(bottom, run)
    if fitted is None:
        middle.plot(t, units.force(run.load), ":", color=GREY, label="load")
    else:
        force = np.asarray(fitted.element.force(run.approach, run.rate))
        middle.plot(t, units.force(force), "--", color=RED, label="cubic element")
        start = units.time(fitted.window[0][0])
        for axes in panels:
            axes.axvspan(t[0], start, color="#f2f2f2", zorder=0)
        centre = (0.5 * (t[0] + start), 0.06)
        style: dict[str, Any] = {"ha": "center", "color": GREY, "fontsize": 9}
        middle.annotate("not fitted", centre, xycoords=("data", "axes fraction"), **style)
    for axes in panels:
        legend_above(axes)


def _wave(axes: Axes, run: SimulationResult) -> None:
    """Change of the film along Y = 0 over time and place, with the paths of the surfaces."""
    unit = units_of(run.scales).film
    wave = film_wave(run)
    T, X = np.linspace(wave.T[0], wave.T[-1], POINTS[0]), np.linspace(-WITHIN, WITHIN, POINTS[1])
    # shape-preserving: a spline would ring beside the constriction
    change = unit(PchipInterpolator(wave.X, PchipInterpolator(wave.T, wave.change)(T), axis=1)(X))
    largest = float(np.percentile(np.abs(change[:, np.abs(X) < CARRIED]), 99.0)) or 1.0
    colours: dict[str, Any] = {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest, "interpolation": "bilinear"}
    extent = (T[0], T[-1], X[0], X[-1])
    shown = axes.imshow(change.T, origin="lower", extent=extent, aspect="auto", **colours)
    axes.figure.colorbar(shown, ax=axes, label=f"change of {unit.label}", pad=0.02, extend="both")
    for start in np.arange(0.0, wave.T[-1], 2.0):
        axes.plot([start, start + 2.0], [-1.0, 1.0], "--", color="black", linewidth=0.8)
    axes.set(xlim=(T[0], T[-1]), ylim=(X[0], X[-1]))
    axes.set(xlabel="time T = u_sum t/(2a)", ylabel="place X = x/a")
    axes.grid(False)


def _loop(axes: Axes, run: SimulationResult, part: Any) -> None:
    units = units_of(run.scales)
    axes.plot(units.approach(run.approach[part]), units.force(run.force[part]), color=BLUE, label="film")


def _fitted_loop(upper: Axes, lower: Axes, run: SimulationResult, found: FitResult) -> None:
    """The part of a loop that was fitted, with the element; below, both without the element's static law."""
    units = units_of(run.scales)
    part = (run.T >= found.window[0][0]) & (run.T <= found.window[0][1])
    u, rate = run.approach[part], run.rate[part]
    model, spring = (np.asarray(f) for f in (found.element.force(u, rate), found.element.spring(u)))
    low, high = found.valid["low"], found.valid["high"]
    wide = np.linspace(low - 0.3 * (high - low), high + 0.3 * (high - low), 200)
    for axes in (upper, lower):
        axes.axvspan(units.approach(low), units.approach(high), color="#eaf3fa", zorder=0, label="valid")
    static = units.force(np.asarray(found.element.spring(wide)))
    upper.plot(units.approach(wide), static, color=GREY, linewidth=1.0, label="static law of the element")
    _loop(upper, run, part)
    upper.plot(units.approach(u), units.force(model), "--", color=RED, label="cubic element")
    lower.plot(units.approach(u), units.force(run.force[part] - spring), color=BLUE)
    lower.plot(units.approach(u), units.force(model - spring), "--", color=RED)
