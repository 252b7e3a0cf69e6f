"""Maps over the contact's plane: a field, the Hertz ellipse, and how far they are from scale."""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film.plane import Film, interpolated

VIEW = (-1.8, 1.5, 1.5)  # along X from, to; across to: in semi-axes
FLATTEST = 0.3  # height over width of a map with the surfaces moving upwards: a flatter one is stretched
HIGHEST = 420.0  # px of a map

Array = NDArray[np.float64]


def refined(film: Film, points: tuple[int, int], growth: float = 1.0) -> Film:
    """The part of a film that maps show, interpolated smoothly, so that no picture shows the grid.

    Parameters
    ----------
    film : Film
    points : (int, int)
        Along rolling and across.
    growth : float
        Semi-axes over those of the film's scales, where the load has risen.
    """
    first, last, across = (growth * edge for edge in VIEW)
    X = np.linspace(max(first, film.X[0]), min(last, film.X[-1]), points[0])
    across = min(across, film.Y[-1])
    return interpolated(film, X, np.linspace(-across, across, points[1]))


def map_axes(
    figure: go.Figure, film: Film, kappa: float, row: int = 1, col: int = 1, *, upwards: bool = True
) -> tuple[Array, Array]:
    """Axes of a map, with the Hertz ellipse dashed; returns the places along its x and y axis.

    Parameters
    ----------
    figure : Figure
    film : Film
        Says where.
    kappa : float
        Ratio a/b of the ellipse.
    row, col : int
        Of the panel.
    upwards : bool
        Let the surfaces move upwards; otherwise they move to the right, and the ellipse is drawn as a circle.
        What is not to scale `scale_note` says.
    """
    units = units_of(film.scales)
    along, across = (units.x, film.X), (units.y, film.Y)
    (x, X), (y, Y) = (across, along) if upwards else (along, across)
    # px of a unit along y over those of one along x
    ratio = units.x.factor / units.y.factor
    if upwards:
        ratio = _stretch(film, kappa) * kappa / ratio
    shared: dict[str, Any] = {"constrain": "domain", "showgrid": False, "row": row, "col": col}
    x_ends, y_ends = ([float(quantity(end)) for end in (at[0], at[-1])] for quantity, at in ((x, X), (y, Y)))
    figure.update_xaxes(title_text=x.label, range=x_ends, **shared)
    anchor = next(figure.select_xaxes(row=row, col=col)).plotly_name.replace("axis", "")
    figure.update_yaxes(title_text=y.label, range=y_ends, scaleanchor=anchor, scaleratio=ratio, **shared)
    edge: Any = {"color": "white", "dash": "dash", "width": 1.2}
    ends = {"x0": -x.factor, "x1": x.factor, "y0": -y.factor, "y1": y.factor}
    figure.add_shape(type="circle", line=edge, **ends, row=row, col=col)
    return x(X), y(Y)


def add_map(
    figure: go.Figure,
    film: Film,
    values: Array,
    kappa: float,
    row: int = 1,
    *,
    label: str,
    colours: str,
    limits: tuple[float, float],
) -> None:
    """Colour a field over the plane of a film, shape (nx, ny), the surfaces moving upwards.

    `limits` are those of the colours, `label` names them; the figure has one column.
    """
    x, y = map_axes(figure, film, kappa, row)
    coloraxis = f"coloraxis{row if row > 1 else ''}"
    figure.add_heatmap(x=x, y=y, z=values, coloraxis=coloraxis, row=row, col=1)
    bar = {"title": {"text": label, "side": "right"}, "thickness": 10, "outlinewidth": 0, "nticks": 5}
    figure.update_layout(
        {coloraxis: {"colorscale": colours, "cmin": float(limits[0]), "cmax": float(limits[1]), "colorbar": bar}}
    )


def add_pressure(figure: go.Figure, film: Film, kappa: float, row: int, most: float) -> None:
    """Map of the pressure; `most`, over Hertz's, is where its colours end."""
    pressure = units_of(film.scales).pressure
    limits = 0.0, pressure(most)
    add_map(figure, film, pressure(film.P), kappa, row, label=pressure.label, colours="Inferno", limits=limits)


def add_film(figure: go.Figure, film: Film, kappa: float, row: int, ends: tuple[float, float]) -> None:
    """Map of the film; `ends`, over the dry approach, are those of its colours."""
    unit = units_of(film.scales).film
    limits = unit(ends[0]), unit(ends[1])
    shown = np.minimum(unit(film.H), limits[1])
    add_map(figure, film, shown, kappa, row, label=unit.label, colours="Viridis", limits=limits)


def move_together(figure: go.Figure) -> None:
    """Let a second map show the part of the plane that the first one shows."""
    figure.update_xaxes(matches="x", row=2, col=1).update_yaxes(matches="y", scaleanchor=None, row=2, col=1)


def scale_note(film: Film, kappa: float, *, upwards: bool = True) -> str:
    """How far a map is from true proportions, in words; empty where it is to scale."""
    stretch = _stretch(film, kappa) if upwards else 1.0 / kappa
    if abs(stretch - 1.0) < 0.01:
        return ""
    longer, shorter, times = ("x", "y", stretch) if stretch > 1.0 else ("y", "x", 1.0 / stretch)
    return f"Not to scale: {longer} stretched {numeral(times, 2)} times against {shorter}."


def _flatness(film: Film, kappa: float) -> float:
    """True length of a map along rolling over that across."""
    return float(kappa * (film.X[-1] - film.X[0]) / (film.Y[-1] - film.Y[0]))


def _stretch(film: Film, kappa: float) -> float:
    """Of the direction of rolling, where a map would be too flat."""
    return max(1.0, FLATTEST / _flatness(film, kappa))
