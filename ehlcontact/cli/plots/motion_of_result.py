"""One figure of a simulation: film over time, the film wave, and force against approach."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, legend_above, new_figure
from ehlcontact.film import film_history, film_wave
from ehlcontact.transient.result import SimulationResult

WITHIN = 1.1  # semi-axes of the film wave shown: beyond, the film follows the approach at once


def draw_simulation(run: SimulationResult) -> Figure:
    """Histories beside the T-X map of the film wave and the force-approach loop; in SI where there are scales."""
    figure = new_figure(6.4, 10.5)
    parts: Any = figure.subfigures(1, 2, width_ratios=(1.0, 1.1))
    left, right = parts
    _histories(left.subplots(3, 1, sharex=True), run)
    wave, loop = right.subplots(2, 1, height_ratios=(1.1, 1.0))
    _wave(wave, run)
    _loop(loop, run)
    return figure


def _histories(panels: np.ndarray, run: SimulationResult) -> None:
    history, scales = film_history(run), run.scales
    top, middle, bottom = panels
    time, length, force = (scales.time * 1e3, scales.length * 1e6, scales.force) if scales else (1.0, 1.0, 1.0)
    t = run.T * time
    top.plot(t, run.approach * length, color=BLUE)
    top.axhline(run.static_approach * length, color=GREY, linestyle=":", label="at rest")
    top.set_ylabel("approach [um]" if scales else "approach u")
    middle.plot(t, run.force * force, color=BLUE, label="film")
    middle.plot(t, run.load * force, ":", color=GREY, label="load")
    middle.set_ylabel("force [N]" if scales else "force f/f0")
    bottom.plot(t, history.central * length, color=GREEN, label="centre")
    bottom.plot(t, history.minimum * length, color=ORANGE, label="minimum")
    bottom.set(ylim=(0.0, None), xlim=(t[0], t[-1]))
    bottom.set_ylabel("film [um]" if scales else "film H")
    bottom.set_xlabel("time [ms]" if scales else "time T = u_sum t/(2a)")
    for panel in panels:
        legend_above(panel)


def _wave(axes: Axes, run: SimulationResult) -> None:
    """Change of the film along Y = 0 over time and place; dashed, paths of the surfaces."""
    wave = film_wave(run)
    inside = np.abs(wave.X) <= WITHIN
    change = wave.change[:, inside] * (run.scales.length * 1e6 if run.scales else 1.0)
    carried = np.abs(wave.X[inside]) < 0.9
    largest = float(np.percentile(np.abs(change[:, carried]), 99.0)) or 1.0
    shown = axes.pcolormesh(
        wave.T,
        wave.X[inside],
        change.T,
        cmap="RdBu_r",
        vmin=-largest,
        vmax=largest,
        shading="gouraud",
        rasterized=True,
    )
    axes.figure.colorbar(shown, ax=axes, label="change of film [um]" if run.scales else "change of film H")
    for start in np.arange(0.0, wave.T[-1], 2.0):
        axes.plot([start, start + 2.0], [-1.0, 1.0], "--", color="black", linewidth=0.8)
    axes.set(xlim=(wave.T[0], wave.T[-1]), ylim=(-WITHIN, WITHIN), xlabel="time T", ylabel="place X = x/a")
    axes.set_title("film wave; dashed: carried at dX/dT = 1", loc="left")
    axes.grid(False)


def _loop(axes: Axes, run: SimulationResult) -> None:
    """Force against approach; the start is marked."""
    length, force = (run.scales.length * 1e6, run.scales.force) if run.scales else (1.0, 1.0)
    axes.plot(run.approach * length, run.force * force, color=BLUE)
    axes.plot(run.approach[0] * length, run.force[0] * force, "o", color=ORANGE, label="T = 0")
    axes.set_xlabel("approach [um]" if run.scales else "approach u")
    axes.set_ylabel("force [N]" if run.scales else "force f/f0")
    legend_above(axes)
