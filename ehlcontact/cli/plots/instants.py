"""Film and pressure at instants of a harmonic load's last period: four of them as a picture."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.maps import VIEW, draw_ellipse, draw_map, refined, scale_note
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.cli.plots.units import units_of
from ehlcontact.cli.study.stages import FRAMES
from ehlcontact.film import film_of
from ehlcontact.point import moes_point
from ehlcontact.transient.motion import HarmonicLoad
from ehlcontact.transient.result import SimulationResult

SHOWN = 4  # instants of the picture
THICKEST = 1.8  # largest central film, that the colours end at

Array = NDArray[np.float64]


def steps_of(run: SimulationResult) -> NDArray[np.int_]:
    """Steps of the last period that are shown: those with whole fields, or some of all where none were kept."""
    motion = run.motion
    period = motion.period if isinstance(motion, HarmonicLoad) else float(run.T[-1])
    if run.snapshot_T.size:
        kept = run.snapshot_T[run.snapshot_T >= run.T[-1] - period * (1.0 + 1e-9)]
        return np.abs(run.T[:, None] - kept).argmin(axis=0)
    last = np.flatnonzero(run.T >= run.T[-1] - period * (1.0 + 1e-9))
    return last[:: -(-last.size // FRAMES)]


def limits_of(run: SimulationResult, steps: NDArray[np.int_]) -> tuple[float, float, float]:
    """Smallest and largest film, and largest pressure, that the colours of all instants have in common."""
    pressure = run.snapshot_P if run.snapshot_T.size else run.p_midplane[steps]
    return float(run.h_min[steps].min()), THICKEST * float(run.h_central[steps].max()), float(pressure.max())


def instants(run: SimulationResult) -> Figure:
    """Maps of pressure and film at `SHOWN` instants; mid-planes of a run that kept no whole fields."""
    steps = steps_of(run)
    chosen = steps[np.linspace(0, steps.size - 1, SHOWN + 1).astype(int)[:-1]]
    return _maps(run, chosen, steps) if run.snapshot_T.size else _midplanes(run, chosen)


def _maps(run: SimulationResult, chosen: NDArray[np.int_], steps: NDArray[np.int_]) -> Figure:
    units, kappa = units_of(run.scales), moes_point(run.point).kappa
    thinnest, thickest, most = limits_of(run, steps)
    figure = new_figure(1.55 * chosen.size + 0.7)
    panels = figure.subplots(chosen.size, 2, squeeze=False, sharex=True, sharey=True)
    shown: list[Any] = []
    for row, step in zip(panels, chosen.tolist(), strict=True):
        film = refined(film_of(run, float(run.T[step])))
        fields = (
            (units.pressure(np.maximum(film.P, 0.0)), "inferno", 0.0, units.pressure(most)),
            (units.film(film.H), "viridis", units.film(thinnest), units.film(thickest)),
        )
        shown = [
            draw_map(axes, film, values, kappa, upwards=True, cmap=cmap, vmin=low, vmax=high)
            for axes, (values, cmap, low, high) in zip(row, fields, strict=True)
        ]
        row[0].set_title(f"{units.time.label.split(' [')[0]} {numeral(units.time(run.T[step]))}", loc="left")
        for axes in row:
            draw_ellipse(axes, film, "white", upwards=True)
            axes.label_outer()
    for column, (image, quantity) in enumerate(zip(shown, (units.pressure, units.film), strict=True)):
        figure.colorbar(image, ax=panels[:, column], label=quantity.label, location="top", aspect=40, pad=0.01)
    figure.suptitle(scale_note(film, kappa, upwards=True), fontsize=10, color=GREY)
    return figure


def _midplanes(run: SimulationResult, chosen: NDArray[np.int_]) -> Figure:
    units = units_of(run.scales)
    figure = new_figure(3.6)
    panels: Any = figure.subplots(1, 2)
    for step, colour in zip(chosen.tolist(), (BLUE, GREEN, ORANGE, RED), strict=True):
        label = numeral(units.time(run.T[step]))
        panels[0].plot(units.x(run.X), units.pressure(run.p_midplane[step]), color=colour, label=label)
        panels[1].plot(units.x(run.X), units.film(run.h_midplane[step]), color=colour, label=label)
    for axes, quantity in zip(panels, (units.pressure, units.film), strict=True):
        axes.set(xlabel=units.x.label, ylabel=quantity.label, xlim=(units.x(VIEW[0]), units.x(VIEW[1])))
    panels[1].set_ylim(0.0, units.film(3.0 * float(run.h_central.max())))
    legend_above(panels[0], title=units.time.label)
    return figure
