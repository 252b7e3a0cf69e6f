"""Colours, axes and grids of panels of the figures of a page."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

# Okabe and Ito's colours, which stay apart for colour-blind eyes.
BLUE, ORANGE, GREEN, RED, PURPLE, GREY = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#7f7f7f"
PALE, PALE_BLUE = "#f2f2f2", "#eaf3fa"  # of stretches behind the lines
INK, SOFT, FAINT = "#1d2126", "#59616b", "#d5d9de"  # as in page.css

Cell = tuple[int, int]  # row and column, from 1 on as in plotly

_AXIS: dict[str, Any] = {
    "gridcolor": FAINT,
    "linecolor": SOFT,
    "showline": True,
    "zeroline": False,
    "ticks": "outside",
    "ticklen": 3,
    "tickcolor": SOFT,
    "exponentformat": "e",
    "title": {"standoff": 6, "font": {"size": 12}},
}
_CLEAR = "rgba(0,0,0,0)"
TEMPLATE = go.layout.Template(
    layout={
        "paper_bgcolor": _CLEAR,
        "plot_bgcolor": _CLEAR,
        "font": {"size": 12, "color": INK},
        "hovermode": "closest",
        "hoverlabel": {"font": {"size": 13}},
        "xaxis": _AXIS,
        "yaxis": _AXIS,
        "polar": {
            "bgcolor": _CLEAR,
            "radialaxis": {"gridcolor": FAINT, "nticks": 4, "angle": 20, "tickangle": 0},
            "angularaxis": {"gridcolor": FAINT, "linecolor": FAINT, "dtick": 45},
        },
        "legend": {"orientation": "h", "x": 0.0, "xanchor": "left", "yanchor": "bottom"},
        "modebar": {"bgcolor": _CLEAR, "color": SOFT, "activecolor": INK},
    },
    data={"scatter": [{"mode": "lines", "line": {"width": 2.0}}], "heatmap": [{"zsmooth": "best"}]},
)


def grid(
    rows: int = 1,
    columns: int = 1,
    *,
    heights: Sequence[float] = (270,),
    titles: Sequence[str] = (),
    second: Collection[Cell] = (),
    polar: Collection[Cell] = (),
    shared: bool = False,
) -> go.Figure:
    """Empty panels in rows and columns.

    Parameters
    ----------
    rows, columns : int
    heights : sequence of float
        Of the rows [px].
    titles : sequence of str
        Of the panels, row by row.
    second : collection of (int, int)
        Cells with a second y axis.
    polar : collection of (int, int)
        Cells with polar axes.
    shared : bool
        Whether the panels of a column have one x axis, labelled under the last.
    """
    cells = [[(row, column) for column in range(1, columns + 1)] for row in range(1, rows + 1)]
    specs = [
        [{"type": "polar" if at in polar else "xy", "secondary_y": at in second} for at in row] for row in cells
    ]
    figure = make_subplots(rows, columns, specs=specs, shared_xaxes="columns" if shared else False)
    figure.update_layout(
        template=TEMPLATE,
        meta={"rows": rows, "columns": columns, "heights": list(heights), "titled": bool(titles)},
    )
    for row, column in second:
        figure.update_yaxes(tickmode="auto", showgrid=False, row=row, col=column, secondary_y=True)
    for (row, column), title in zip((at for line in cells for at in line), titles, strict=False):
        over: Any = {"x": 0.5, "y": 1.0, "yanchor": "bottom", "showarrow": False, "text": title}
        figure.add_annotation(xref="x domain", yref="y domain", font={"size": 13}, **over, row=row, col=column)
    return figure


def label_axes(figure: go.Figure, x: str, y: str, row: int = 1, col: int = 1, **y_options: Any) -> None:
    """Labels of one panel, and options of its y axis."""
    figure.update_xaxes(title_text=x, row=row, col=col)
    figure.update_yaxes(title_text=y, row=row, col=col, secondary_y=False, **y_options)


def vertical(figure: go.Figure, x: float, text: str, row: int = 1, col: int = 1, colour: str = GREY) -> None:
    """Dotted line across a panel, with a word at its top."""
    figure.add_vline(
        x, line={"color": colour, "dash": "dot", "width": 1.2}, row=row, col=col, exclude_empty_subplots=False
    )
    if text:
        log = next(figure.select_xaxes(row=row, col=col)).type == "log"
        place = {"x": float(np.log10(x)) if log else x, "y": 1.0, "yref": "y domain"}
        look: Any = {
            "showarrow": False,
            "xanchor": "left",
            "yanchor": "top",
            "font": {"size": 11, "color": colour},
        }
        figure.add_annotation(text=f" {text}", **place, **look, row=row, col=col)


def shaded(
    figure: go.Figure, ends: tuple[float, float], text: str, row: int = 1, col: int = 1, colour: str = PALE
) -> None:
    """Stretch of a panel behind its lines, with a word at its foot."""
    figure.add_vrect(
        *map(float, ends),
        fillcolor=colour,
        line_width=0,
        layer="below",
        row=row,
        col=col,
        exclude_empty_subplots=False,
    )
    if text:
        place = {"x": 0.5 * (ends[0] + ends[1]), "y": 0.0, "yref": "y domain", "yanchor": "bottom"}
        look = {"showarrow": False, "font": {"size": 11, "color": GREY}}
        figure.add_annotation(text=text, **place, **look, row=row, col=col)


def running(figures: Sequence[go.Figure], label: str, unit: str, values: Sequence[float], start: int) -> go.Figure:
    """One figure of several that differ in their numbers only, with a slider through them.

    Parameters
    ----------
    figures : sequence of Figure
        With the same panels and traces; axes reach over all of them.
    label, unit : str
        Of what the slider runs through.
    values : sequence of float
    start : int
        The one that is shown first.
    """
    base, data = figures[start], [[trace.to_plotly_json() for trace in one.data] for one in figures]
    for side, axes in (("x", base.select_xaxes()), ("y", base.select_yaxes())):
        for axis in axes:
            own = axis.plotly_name.replace("axis", "")
            found = [trace[side] for one in data for trace in one if trace.get(f"{side}axis") == own]
            axis.range = _reach(np.concatenate(found), axis.type == "log")
    reaches = [p.radialaxis.range[1] for one in figures for p in one.select_polars() if p.radialaxis.range]
    if reaches:
        base.update_polars(radialaxis_range=[0.0, max(reaches)])
    moving = "type", "x", "y", "r", "theta"
    base.frames = [
        go.Frame(data=[{name: trace[name] for name in moving if name in trace} for trace in one], name=str(k))
        for k, one in enumerate(data)
    ]
    slide(base, label, unit, values, start)
    return base


def slide(
    figure: go.Figure, label: str, unit: str, values: Sequence[float], start: int, runs: bool = False
) -> None:
    """What the slider of a figure with frames says; `runs`: whether it has a button to run through them."""
    texts = [f"{value:.4g} {unit}".strip() for value in values]
    figure.update_layout(
        meta={**figure.layout.meta, "slider": {"label": label, "texts": texts, "start": start, "runs": runs}}
    )


def _reach(values: np.ndarray, log: bool) -> list[float]:
    """Ends of an axis with some room around its values."""
    shown = np.log10(values[values > 0.0]) if log else values[np.isfinite(values)]
    low, high = float(shown.min()), float(shown.max())
    room = 0.04 * (high - low or 1.0)
    return [low - room, high + room]
