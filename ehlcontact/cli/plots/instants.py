"""Film and pressure through the last period of a harmonic load, with a slider."""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from ehlcontact.cli.plots.film import noted
from ehlcontact.cli.plots.maps import HIGHEST, VIEW, add_film, add_pressure, move_together, refined, scale_note
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, PURPLE, RED, grid, label_axes, slide
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film import film_of
from ehlcontact.film.plane import Film
from ehlcontact.point import moes_point
from ehlcontact.transient.motion import HarmonicLoad
from ehlcontact.transient.result import SimulationResult

POINTS = (49, 81)  # of a map, along rolling and across
THICKEST = 1.8  # largest central film, that the colours end at

Moving = list[tuple[int, list[dict[str, Any]]]]  # number of a trace, and its numbers in every frame


def steps_of(run: SimulationResult) -> NDArray[np.int_]:
    """Steps of the last period whose whole fields were kept."""
    assert isinstance(run.motion, HarmonicLoad)
    kept = run.snapshot_T[run.snapshot_T >= run.T[-1] - run.motion.period * (1.0 + 1e-9)]
    return np.abs(run.T[:, None] - kept).argmin(axis=0)


def instants(run: SimulationResult) -> go.Figure:
    """Pressure and film, both along the mid-plane, and force and film over time."""
    units, steps = units_of(run.scales), steps_of(run)
    kappa = moes_point(run.point).kappa
    films = [refined(film_of(run, float(run.T[step])), POINTS) for step in steps]
    titles = "pressure; the surfaces move upwards", "film", "along rolling, y = 0; dotted: at rest", "over time"
    figure = grid(4, heights=[HIGHEST, HIGHEST, 200, 200], titles=titles, second=((3, 1), (4, 1)))
    moving = _maps(figure, run, films, kappa, steps) + _midplane(figure, run, steps) + _history(figure, run, steps)
    numbers = [number for number, _ in moving]
    figure.frames = [
        go.Frame(data=[frames[k] for _, frames in moving], traces=numbers, name=str(k)) for k in range(steps.size)
    ]
    label, _, unit = units.time.label.rstrip("]").partition(" [")
    slide(figure, label, unit, units.time(run.T[steps]), 0, runs=True)
    return noted(figure, scale_note(films[0], kappa))


def _maps(
    figure: go.Figure, run: SimulationResult, films: list[Film], kappa: float, steps: NDArray[np.int_]
) -> Moving:
    """Maps with the same colours in every frame."""
    thickest = THICKEST * float(run.h_central[steps].max())
    first, units = films[0], units_of(run.scales)
    add_pressure(figure, first, kappa, 1, float(run.snapshot_P.max()))
    add_film(figure, first, kappa, 2, (float(run.h_min[steps].min()), thickest))
    move_together(figure)
    return [
        (0, [{"type": "heatmap", "z": units.pressure(film.P)} for film in films]),
        (1, [{"type": "heatmap", "z": units.film(np.minimum(film.H, thickest))} for film in films]),
    ]


def _midplane(figure: go.Figure, run: SimulationResult, steps: NDArray[np.int_], row: int = 3) -> Moving:
    """Pressure and film along y = 0."""
    units, inside = units_of(run.scales), (run.X >= VIEW[0]) & (run.X <= VIEW[1])
    x, number, at = units.x(run.X[inside]), len(figure.data), {"row": row, "col": 1}
    pressures, films = units.pressure(run.p_midplane[:, inside]), units.film(run.h_midplane[:, inside])
    for name, values, colour, second in (("pressure", pressures, RED, False), ("film", films, BLUE, True)):
        figure.add_scatter(x=x, y=values[steps[0]], name=name, line_color=colour, **at, secondary_y=second)
    for values, colour, second in ((pressures, RED, False), (films, BLUE, True)):
        rest: Any = {"color": colour, "dash": "dot"}
        figure.add_scatter(x=x, y=values[0], line=rest, hoverinfo="skip", **at, secondary_y=second)
    highest, thickest = 1.08 * float(pressures[steps].max()), units.film(3.0 * float(run.h_central[steps].max()))
    label_axes(figure, units.x.label, units.pressure.label, row, range=[0.0, highest], title_font_color=RED)
    figure.update_xaxes(range=[x[0], x[-1]], **at)
    _second(figure, units.film.label, BLUE, row, range=[0.0, thickest])
    return [(number + k, [{"y": values[step]} for step in steps]) for k, values in enumerate((pressures, films))]


def _history(figure: go.Figure, run: SimulationResult, steps: NDArray[np.int_], row: int = 4) -> Moving:
    """Force and central film over the run, with dots at the time of the frame."""
    units, at = units_of(run.scales), {"row": row, "col": 1}
    t, force, film = units.time(run.T), units.force(run.force), units.film(run.h_central)
    figure.add_scatter(x=t, y=force, name="force of the film", line_color=PURPLE, **at)
    figure.add_scatter(x=t, y=units.force(run.load), name="load", line={"color": GREY, "dash": "dot"}, **at)
    figure.add_scatter(x=t, y=film, name="film in the centre", line_color=GREEN, **at, secondary_y=True)
    number, now = len(figure.data), steps[:1]
    dot: Any = {"mode": "markers", "marker": {"size": 9, "color": RED}}
    figure.add_scatter(x=t[now], y=force[now], name="now", **dot, **at)
    figure.add_scatter(x=t[now], y=film[now], name="now", **dot, **at, secondary_y=True)
    label_axes(figure, units.time.label, units.force.label, row, title_font_color=PURPLE)
    figure.update_xaxes(range=[0.0, float(t[-1])], **at)
    _second(figure, units.film.label, GREEN, row)
    return [
        (number + k, [{"x": [t[step]], "y": [values[step]]} for step in steps])
        for k, values in enumerate((force, film))
    ]


def _second(figure: go.Figure, label: str, colour: str, row: int, **options: Any) -> None:
    figure.update_yaxes(title_text=label, title_font_color=colour, **options, row=row, col=1, secondary_y=True)
