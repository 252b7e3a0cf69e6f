"""The transient contact in a page: histories, film waves, force against approach, and elements beside them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import plotly.graph_objects as go
import scipy

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, PALE_BLUE, RED, grid, label_axes, shaded
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film.over_time import film_wave
from ehlcontact.transient.result import SimulationResult
from reduced_models.fitting.result import FitResult

WITHIN = 1.1  # semi-axes of the film wave shown: beyond, the film follows the approach at once
POINTS = (180, 111)  # of its picture over time and place: interpolated smoothly, so that it does not show the grid
CARRIED = 0.9  # semi-axes within which the film is that of the wave alone, which sets the colours
DASHED = {"color": RED, "dash": "dash"}


def histories(run: SimulationResult, fitted: FitResult | None) -> go.Figure:
    """Approach, force and film over time, with the fitted force."""
    units, figure = units_of(run.scales), grid(3, heights=[150] * 3, shared=True)
    t = units.time(run.T)
    figure.add_scatter(x=t, y=units.approach(run.approach), name="film", line_color=BLUE, row=1, col=1)
    rest: Any = {"x": t[[0, -1]], "y": [units.approach(run.static_approach)] * 2}
    figure.add_scatter(**rest, name="at rest", line={"color": GREY, "dash": "dot"}, row=1, col=1)
    figure.add_scatter(x=t, y=units.force(run.force), name="film", line_color=BLUE, row=2, col=1)
    if fitted is None:
        dots: Any = {"color": GREY, "dash": "dot"}
        figure.add_scatter(x=t, y=units.force(run.load), name="load", line=dots, row=2, col=1)
    else:
        force = units.force(np.asarray(fitted.element.force(run.approach, run.rate)))
        figure.add_scatter(x=t, y=force, name="cubic element", line=DASHED, row=2, col=1)
        for row, text in ((1, ""), (2, "not fitted"), (3, "")):
            shaded(figure, (t[0], units.time(fitted.window[0][0])), text, row)
    add_films(figure, run, 3)
    for row, label in ((1, units.approach.label), (2, units.force.label), (3, units.film.label)):
        label_axes(figure, units.time.label if row == 3 else "", label, row)
    figure.update_xaxes(range=[t[0], t[-1]])
    return figure


def add_films(figure: go.Figure, run: SimulationResult, row: int = 1) -> None:
    """Central and minimum film over time."""
    units = units_of(run.scales)
    t = units.time(run.T)
    figure.add_scatter(x=t, y=units.film(run.h_central), name="centre", line_color=GREEN, row=row, col=1)
    figure.add_scatter(x=t, y=units.film(run.h_min), name="minimum", line_color=ORANGE, row=row, col=1)


def wave(run: SimulationResult) -> go.Figure:
    """Change of the mid-plane film over place and time: waves that run through at the mean surface speed."""
    unit, found = units_of(run.scales).film, film_wave(run)
    T, X = np.linspace(found.T[0], found.T[-1], POINTS[0]), np.linspace(-WITHIN, WITHIN, POINTS[1])
    # shape-preserving: a spline would ring beside the constriction
    change = unit(
        scipy.interpolate.PchipInterpolator(
            found.X, scipy.interpolate.PchipInterpolator(found.T, found.change)(T), axis=1
        )(X)
    )
    largest = float(np.percentile(np.abs(change[:, np.abs(X) < CARRIED]), 99.0)) or 1.0
    figure = grid(heights=[340], titles=["dashed: carried through at dX/dT = 1"])
    figure.add_heatmap(x=T, y=X, z=change.T, coloraxis="coloraxis")
    bar = {"title": {"text": f"change of {unit.label}", "side": "right"}, "thickness": 10, "outlinewidth": 0}
    # bounds of the colours are symmetric, so that white is no change
    figure.update_layout(coloraxis={"colorscale": "RdBu_r", "cmin": -largest, "cmax": largest, "colorbar": bar})
    for start in np.arange(0.0, found.T[-1], 2.0).tolist():
        path: Any = {"color": "black", "dash": "dash", "width": 1.2}
        figure.add_scatter(x=[start, start + 2.0], y=[-1.0, 1.0], line=path, hoverinfo="skip")
    label_axes(figure, "time T = u_sum t/(2a)", "place X = x/a", range=[X[0], X[-1]], showgrid=False)
    figure.update_xaxes(range=[T[0], T[-1]], showgrid=False)
    return figure


def loops(
    runs: Mapping[str, SimulationResult], fits: Mapping[str, FitResult], titles: Mapping[str, str]
) -> go.Figure:
    """Force against approach of each record with its cubic element; below, the part that is not its spring."""
    units = units_of(next(iter(runs.values())).scales)
    figure = grid(2, len(runs), heights=[290, 190], titles=[titles[name] for name in runs], shared=True)
    for col, (name, run) in enumerate(runs.items(), start=1):
        if name in fits:
            _fitted_loop(figure, col, run, fits[name])
        else:
            approach, force = units.approach(run.approach), units.force(run.force)
            figure.add_scatter(x=approach, y=force, name="film", line_color=BLUE, row=1, col=col)
        label_axes(figure, "", units.force.label, 1, col)
        label_axes(figure, units.approach.label, units.force.label.replace("force", "less static law"), 2, col)
    return figure


def _fitted_loop(figure: go.Figure, col: int, run: SimulationResult, found: FitResult) -> None:
    """The part of a loop that was fitted, with the element; below, both without the element's static law."""
    units = units_of(run.scales)
    part = (run.T >= found.window[0][0]) & (run.T <= found.window[0][1])
    u, rate = run.approach[part], run.rate[part]
    model, spring = (np.asarray(f) for f in (found.element.force(u, rate), found.element.spring(u)))
    low, high = found.valid["low"], found.valid["high"]
    wide = np.linspace(low - 0.3 * (high - low), high + 0.3 * (high - low), 200)
    static = units.force(np.asarray(found.element.spring(wide)))
    law: Any = {"name": "static law of the element", "line": {"color": GREY, "width": 1.2}}
    figure.add_scatter(x=units.approach(wide), y=static, **law, row=1, col=col)
    for row, less in ((1, 0.0), (2, spring)):
        x = units.approach(u)
        figure.add_scatter(
            x=x, y=units.force(run.force[part] - less), name="film", line_color=BLUE, row=row, col=col
        )
        figure.add_scatter(x=x, y=units.force(model - less), name="cubic element", line=DASHED, row=row, col=col)
        ends = float(units.approach(low)), float(units.approach(high))
        shaded(figure, ends, "valid" if row == 1 else "", row, col, PALE_BLUE)
