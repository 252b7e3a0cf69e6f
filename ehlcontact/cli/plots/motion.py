"""The transient contact: histories, film waves, and what the elements make of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.point import Scales
from ehlcontact.transient.result import SimulationResult
from reduced_models import FitResult


def histories(run: SimulationResult, fitted: FitResult | None, scales: Scales) -> Figure:
    """Approach, force and minimum film over time, with the fitted force."""
    figure = new_figure(6.0)
    top, middle, bottom = figure.subplots(3, 1, sharex=True)
    t = run.T * scales.time * 1e3
    top.plot(t, run.approach * scales.length * 1e6, color=BLUE)
    top.axhline(run.static_approach * scales.length * 1e6, color=GREY, linestyle=":", label="at rest")
    top.set_ylabel("approach [um]")
    legend_above(top)
    middle.plot(t, run.force * scales.force, color=BLUE, label="film")
    if fitted is not None:
        force = fitted.element.force(run.approach, run.rate)
        middle.plot(t, np.asarray(force) * scales.force, "--", color=RED, label="cubic element")
        start = fitted.window[0][0] * scales.time * 1e3
        for axes in (top, middle, bottom):
            axes.axvspan(t[0], start, color="#f2f2f2", zorder=0)
        middle.annotate(
            "not fitted",
            (0.5 * (t[0] + start), 0.06),
            xycoords=("data", "axes fraction"),
            ha="center",
            color=GREY,
            fontsize=9,
        )
    middle.set_ylabel("force [N]")
    legend_above(middle)
    bottom.plot(t, run.h_central * scales.length * 1e6, color=GREEN, label="centre")
    bottom.plot(t, run.h_min * scales.length * 1e6, color=ORANGE, label="minimum")
    bottom.set(ylabel="film [um]", xlabel="time [ms]", xlim=(t[0], t[-1]))
    legend_above(bottom)
    figure.align_ylabels()
    return figure


def film_wave(run: SimulationResult, scales: Scales) -> Figure:
    """Change of the mid-plane film over place and time: waves that run through at the mean surface speed."""
    figure = new_figure(4.4)
    axes = figure.subplots()
    inside = (run.X >= -1.15) & (run.X <= 1.05)
    X = run.X[inside]
    film = (run.h_midplane[:, inside] - run.h_midplane[0, inside]) * scales.length * 1e6
    contact = np.abs(X) < 0.9
    largest = float(np.percentile(np.abs(film[:, contact]), 99.0)) or 1.0
    mesh = axes.imshow(
        film.T,
        origin="lower",
        extent=(run.T[0], run.T[-1], X[0], X[-1]),
        aspect="auto",
        interpolation="bicubic",
        cmap="RdBu_r",
        vmin=-largest,
        vmax=largest,
    )
    figure.colorbar(mesh, ax=axes, label="change of film [um]", pad=0.02, extend="both")
    for start in np.arange(0.0, run.T[-1], 2.0):
        axes.plot([start, start + 2.0], [-1.0, 1.0], color="black", linewidth=0.8, linestyle="--")
    axes.set(xlim=(0.0, run.T[-1]), ylim=(X[0], X[-1]))
    axes.set(xlabel="time T [2a/u_sum]", ylabel="place X = x/a", title="dashed: carried through at dX/dT = 1")
    axes.grid(False)
    unit = scales.a * 1e3
    place = axes.secondary_yaxis("right", functions=(lambda v: np.multiply(v, unit), lambda v: np.divide(v, unit)))
    place.set_ylabel("x [mm]")
    return figure


def loops(
    runs: Mapping[str, SimulationResult], fits: Mapping[str, FitResult], titles: Mapping[str, str], scales: Scales
) -> Figure:
    """Force against approach of each record with its cubic element; below, the part that is not its spring."""
    figure = new_figure(6.6, 11.0)
    panels = figure.subplots(2, len(runs), squeeze=False, sharex="col", height_ratios=(3, 2))
    unit = scales.length * 1e6
    for (upper, lower), (name, run) in zip(panels.T, runs.items(), strict=True):
        found = fits.get(name)
        upper.set_title(titles[name])
        lower.set_xlabel("approach [um]")
        if found is None:
            upper.plot(run.approach * unit, run.force * scales.force, color=BLUE, label="film")
            continue
        fitted = (run.T >= found.window[0][0]) & (run.T <= found.window[0][1])
        u, rate, force = run.approach[fitted], run.rate[fitted], run.force[fitted]
        model, spring = (np.asarray(f) for f in (found.element.force(u, rate), found.element.spring(u)))
        low, high = found.valid["low"], found.valid["high"]
        wide = np.linspace(low - 0.3 * (high - low), high + 0.3 * (high - low), 200)
        for axes in (upper, lower):
            axes.axvspan(low * unit, high * unit, color="#eaf3fa", zorder=0, label="valid")
        static = np.asarray(found.element.spring(wide)) * scales.force
        upper.plot(wide * unit, static, color=GREY, linewidth=1.0, label="static law of the element")
        upper.plot(u * unit, force * scales.force, color=BLUE, label="film")
        upper.plot(u * unit, model * scales.force, "--", color=RED, label="cubic element")
        lower.plot(u * unit, (force - spring) * scales.force, color=BLUE)
        lower.plot(u * unit, (model - spring) * scales.force, "--", color=RED)
    panels[0, 0].set_ylabel("force [N]")
    panels[1, 0].set_ylabel("force less static law [N]")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    figure.align_ylabels()
    return figure
