"""Figures 2, 4, 6, 7, 12: the film at rest and in motion."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.cli.paper.cases import STATIC_LOADS, STATIC_OILS
from ehlcontact.cli.paper.runs import Runs
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.formulas import wijnant_approach
from ehlcontact.transient.result import SimulationResult

VIEW = 1.5  # half-width of the maps in semi-axes


def static_approach(runs: Runs) -> Figure:
    """Fig. 2: approach at rest over M, solves and Wijnant's formula."""
    figure = new_figure(4.2, 7.0)
    axes = figure.subplots()
    smooth = np.geomspace(STATIC_LOADS[0], STATIC_LOADS[-1], 200)
    for L, colour in zip(STATIC_OILS, (BLUE, GREEN, RED), strict=True):
        axes.semilogx(smooth, [wijnant_approach(M, L, 1.0) for M in smooth], color=colour, label=f"L = {L:g}")
        found = [(M, runs.static[M, L].approach) for M in STATIC_LOADS if (M, L) in runs.static]
        if found:
            axes.semilogx(*zip(*found, strict=True), "o", color=colour, markersize=5)
    axes.set(xlabel="M", ylabel="approach [dry Hertz approach]", ylim=(-0.1, 1.05))
    legend_above(axes)
    return figure


def minimum_and_central_film(run: SimulationResult) -> Figure:
    """Fig. 6: central and minimum film of the free vibration."""
    figure = new_figure(3.6)
    axes = figure.subplots()
    axes.plot(run.T, run.h_central, color=GREEN, label="centre")
    axes.plot(run.T, run.h_min, color=ORANGE, label="minimum")
    axes.axvline(1.0, color=GREY, linestyle=":", label="inlet edge to centre at dX/dT = 1")
    axes.set(xlabel="T", ylabel="film [dry Hertz approach]", xlim=(0.0, run.T[-1]))
    legend_above(axes)
    return figure


def fringes(run: SimulationResult) -> Figure:
    """Figs. 4, 7, 12: pseudo-interferograms, three fringes to the central film at rest."""
    count = run.snapshot_T.size
    columns = min(count, 4)
    rows = -(-count // columns)
    figure = new_figure(2.5 * rows + 0.3)
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).ravel()
    Y = np.concatenate([-run.Y[:0:-1], run.Y])
    for axes, T, H in zip(panels, run.snapshot_T, run.snapshot_H, strict=False):
        both = np.concatenate([H[:, :0:-1], H], axis=1)
        phase = both / run.h_central[0]
        bright = 0.5 * (1.0 + np.cos(6.0 * np.pi * phase) * np.exp(-((phase / 2.5) ** 2)))
        axes.imshow(
            bright.T,
            origin="lower",
            extent=(run.X[0], run.X[-1], Y[0], Y[-1]),
            cmap="gray",
            aspect="equal",
            interpolation="bicubic",
            vmin=0.0,
            vmax=1.0,
        )
        axes.set(xlim=(-1.8, VIEW), ylim=(-VIEW, VIEW), title=f"T = {T:.2f}")
        axes.grid(False)
    for axes in panels[count:]:
        axes.set_visible(False)
    figure.supxlabel("X = x/a (surfaces move to the right)", fontsize=10)
    figure.supylabel("Y = y/b", fontsize=10)
    return figure
