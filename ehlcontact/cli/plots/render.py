"""Pictures drawn with plotly, for pages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
import scipy
from plotly.subplots import make_subplots

from ehlcontact.cli.plots.style import TEMPLATE
from ehlcontact.results.picture import (
    GREY,
    RED,
    ROW,
    ROW_ENDS,
    WHITE,
    Array,
    Ends,
    Line,
    LoadZone,
    Map,
    Panel,
    Picture,
    Slides,
)

DASHES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
SYMBOLS = {"o": "circle", "s": "square", "^": "triangle-up", "v": "triangle-down", "D": "diamond", "*": "star"}
POINTS, MOVING = (175, 111), (81, 49)  # of a map, horizontally and vertically; of one behind a slider
ABOVE_LABEL = 4.0  # px, of the title of a panel, over the half of a label of its axis that is above its end
QUARTERS, UPWARDS = (0, 90, 180, 270), 90  # degrees round a load zone, and that under its title
REACH = 0.04  # of the span of an axis behind a slider, on either side of its values


def figure_of(picture: Picture | Slides, points: tuple[int, int] = POINTS) -> go.Figure:
    """The plotly figure; its ``layout.meta`` has what `finish` needs to lay it out.

    Parameters
    ----------
    picture : Picture or Slides
    points : (int, int)
        Of a map, to which fields are interpolated.
    """
    if isinstance(picture, Slides):
        return _sliding(picture)
    rows, columns = picture.shape
    cells = [(row, column) for row in range(rows) for column in range(columns)]
    panels = dict(zip(cells, picture.panels, strict=False))
    specs = [[_spec(panels.get((row, column))) for column in range(columns)] for row in range(rows)]
    figure = make_subplots(rows, columns, specs=specs, shared_xaxes="columns" if picture.shared else False)
    titled = any(panel.title for panel in picture.panels if not isinstance(panel, LoadZone))
    meta = {"rows": rows, "columns": columns, "heights": picture.row_heights, "titled": titled}
    figure.update_layout(template=TEMPLATE, meta=meta | ({"note": picture.note} if picture.note else {}))
    for number, ((row, column), panel) in enumerate(panels.items(), start=1):
        at = {"row": row + 1, "col": column + 1}
        if isinstance(panel, Map):
            _map(figure, panel, at, number, points)
        elif isinstance(panel, LoadZone):
            _load_zone(figure, panel, at)
            continue
        else:
            _panel(figure, panel, at)
        if panel.title:
            over: Any = {"x": 0.5, "y": 1.0, "yanchor": "bottom", "showarrow": False, "font": {"size": 13}}
            over["yshift"] = ABOVE_LABEL
            figure.add_annotation(text=panel.title, xref="x domain", yref="y domain", **over, **at)
        if picture.shared and (row + 1, column) in panels:
            figure.update_xaxes(title_text="", **at)
    _move_together(figure, picture.panels)
    return figure


def _spec(panel: Any) -> dict[str, Any] | None:
    if panel is None:
        return None
    polar = isinstance(panel, LoadZone)
    return {"type": "polar" if polar else "xy", "secondary_y": isinstance(panel, Panel) and bool(panel.second)}


def _panel(figure: go.Figure, panel: Panel, at: dict[str, int]) -> None:
    """Lines and bars with their axes."""
    logs = {axis: panel.logarithmic(axis) for axis in "xy"}
    panel = panel.shown()
    for line in panel.lines:
        side = {"secondary_y": line.second} if panel.second else {}
        _line(figure, line, at | side)
    axes = ("x", panel.x, panel.x_ends, panel.tick), ("y", panel.y, panel.y_ends, panel.y_tick)
    first = {"secondary_y": False} if panel.second else {}
    for axis, label, ends, tick in axes:
        options: dict[str, Any] = {"title_text": label, "type": "log" if logs[axis] else None, "dtick": tick}
        if axis == "x" and any(line.words for line in panel.lines):  # words, though they may read as numbers
            options["type"] = "category"
        if "rev/min" in label:
            options["exponentformat"] = "none"
        elif "[Hz]" in label:
            options["exponentformat"] = "SI"  # 10k
        if ends is not None:
            options["range"] = _range(ends, logs[axis])
        elif axis == "y" and panel.bottom is not None:
            options["rangemode"] = "tozero"
        if axis == "x":
            figure.update_xaxes(**options, **at)
        else:
            figure.update_yaxes(**options, **at, **first)
    if panel.second:
        for second, title, ends in ((False, panel.y, panel.y_ends), (True, panel.second, panel.second_ends)):
            options = {"title_text": title, "range": None if ends is None else list(ends)}
            colour = next(
                (line.colour for line in panel.lines if line.second == second and line.colour != GREY), GREY
            )
            look = {"title_font_color": colour, "tickmode": "auto", "showgrid": not second}
            figure.update_yaxes(**options, **look, **at, secondary_y=second)
    if panel.rows:
        under: Any = [len(panel.rows) - 1 + ROW_ENDS[1], ROW_ENDS[0]]
        figure.update_yaxes(
            range=under, showticklabels=False, ticks="", showgrid=False, zeroline=False, **at, **first
        )
        inside: Any = {"x": 0.0, "xref": "x domain", "xanchor": "left", "yanchor": "bottom"}
        for k, words in enumerate(panel.rows):
            figure.add_annotation(text=words, y=k - ROW, showarrow=False, font_size=12, **inside, **at)
    if panel.equal:
        x, y = _axes(figure, at)
        y.update(scaleanchor=x.plotly_name.replace("axis", ""))
    _behind(figure, panel, at, logs["x"])


def _behind(figure: go.Figure, panel: Panel, at: dict[str, int], log: bool) -> None:
    """Shaded stretches and dotted lines with their words."""
    for band in panel.bands:
        look: Any = {"fillcolor": band.colour, "line_width": 0, "layer": "below", "exclude_empty_subplots": False}
        figure.add_vrect(float(band.low), float(band.high), **look, **at)
        middle = np.sqrt(band.low * band.high) if log else 0.5 * (band.low + band.high)
        _word(
            figure,
            band.text,
            middle,
            log,
            at,
            {"y": 0.0, "yanchor": "bottom", "font": {"size": 11, "color": GREY}},
        )
    for mark in panel.marks:
        line = {"color": mark.colour, "dash": "dot", "width": 1.2}
        figure.add_vline(float(mark.at), line=line, exclude_empty_subplots=False, **at)
        font = {"size": 11, "color": mark.colour}
        _word(
            figure,
            f" {mark.text}",
            mark.at,
            log,
            at,
            {"y": 1.0, "yanchor": "top", "xanchor": "left", "font": font},
        )


def _word(figure: go.Figure, text: str, x: float, log: bool, at: dict[str, int], look: dict[str, Any]) -> None:
    if text.strip():
        place = float(np.log10(x)) if log else float(x)
        figure.add_annotation(text=text, x=place, yref="y domain", showarrow=False, **look, **at)


def _line(figure: go.Figure, line: Line, at: dict[str, Any]) -> None:
    if line.words:
        figure.add_bar(x=line.x, y=line.y, base=line.base, name=line.name, marker_color=line.colour, **at)
        if line.base is not None:
            figure.update_layout(barmode="overlay")
        return
    if line.bars is not None:
        x = np.concatenate([line.x, line.x[::-1]])
        y = np.concatenate([line.y - line.bars, (line.y + line.bars)[::-1]])
        area: Any = {"fill": "toself", "fillcolor": line.colour, "opacity": 0.2, "line": {"width": 0}}
        figure.add_scatter(x=x, y=y, mode="lines", hoverinfo="skip", **area, **at)
    mark = line.mark or ("o" if line.x.size < 2 else "")
    modes = [mode for mode, wanted in (("lines", line.dash), ("markers", mark)) if wanted]
    look: dict[str, Any] = {"name": line.name, "opacity": 0.45 if line.faint else None}
    if line.dash:
        look["line"] = {"color": line.colour, "dash": DASHES[line.dash], "width": 1.4 * line.width}
    if mark:
        symbol = SYMBOLS.get(mark.strip(), "x-thin")
        hollow = "-open" if mark.endswith(" ") or symbol == "x-thin" else ""
        look["marker"] = {"color": line.colour, "size": 6 if line.dash else 7, "symbol": symbol + hollow}
    if not line.name:
        look["hoverinfo"] = "skip"
    figure.add_scatter(x=line.x, y=line.y, mode="+".join(modes), **look, **at)


def _map(figure: go.Figure, shown: Map, at: dict[str, int], number: int, points: tuple[int, int]) -> None:
    """A field with the bar of its colours, or an image; its axes to scale where they have one."""
    shown = shown.shown()
    (_, x_label), (_, y_label), (_, label) = shown.x, shown.y, shown.values
    x, y, field = _seen(shown, points)
    if field.ndim == 3:
        places = {"x0": x[0], "dx": x[1] - x[0], "y0": y[0], "dy": y[1] - y[0]}
        colours = np.rint(255.0 * np.clip(field, 0.0, 1.0)).astype(int).transpose(1, 0, 2)
        figure.add_image(z=colours.tolist(), **places, hoverinfo="skip", **at)
    else:
        low, high = shown.limits or (float(np.nanmin(field)), float(np.nanmax(field)))
        values = {"x": x, "y": y, "z": np.clip(field, low, high).T}
        if label:
            coloraxis = f"coloraxis{number if number > 1 else ''}"
            figure.add_heatmap(**values, coloraxis=coloraxis, **at)
            bar = {"title": {"text": label, "side": "right"}, "thickness": 10, "outlinewidth": 0, "nticks": 5}
            scale = {"colorscale": shown.colours, "cmin": low, "cmax": high, "colorbar": bar}
            figure.update_layout({coloraxis: scale})
        else:
            scale = {"colorscale": shown.colours, "zmin": low, "zmax": high, "showscale": False}
            figure.add_heatmap(**values, **scale, hoverinfo="skip", **at)
    if shown.levels:
        _contours(figure, x, y, field, sorted(shown.levels), at)
    if shown.axes is not None:
        half, other = shown.axes
        edge: Any = {"color": WHITE, "dash": "dash", "width": 1.2}
        figure.add_shape(type="circle", x0=-half, x1=half, y0=-other, y1=other, line=edge, **at)
    for line in shown.lines:
        _line(figure, line, at)
    free: dict[str, Any] = {"showgrid": False, **at}
    figure.update_xaxes(title_text=x_label, range=[float(x[0]), float(x[-1])], **free)
    figure.update_yaxes(title_text=y_label, range=[float(y[0]), float(y[-1])], **free)
    if shown.aspect is not None:
        x_axis, y_axis = _axes(figure, at)
        x_axis.update(constrain="domain")
        anchor = x_axis.plotly_name.replace("axis", "")
        y_axis.update(constrain="domain", scaleanchor=anchor, scaleratio=shown.aspect)


def _seen(shown: Map, points: tuple[int, int]) -> tuple[Array, Array, Array]:
    """The part of a field that is shown, interpolated smoothly so that no picture shows its grid.

    Interpolation keeps the shape: a spline would ring beside the constriction. A field with gaps, and an image,
    are shown as they are.
    """
    (x, _), (y, _), (field, _) = shown.x, shown.y, shown.values
    ends = shown.view or ((x[0], x[-1]), (y[0], y[-1]))
    kept = [_inside(place, end) for place, end in zip((x, y), ends, strict=True)]
    if field.ndim == 3 or not np.isfinite(field).all():
        return x[kept[0]], y[kept[1]], field[kept[0]][:, kept[1]]
    fine = [
        np.linspace(max(low, float(place[0])), min(high, float(place[-1])), count)
        for (low, high), place, count in zip(ends, (x, y), points, strict=True)
    ]
    along = scipy.interpolate.PchipInterpolator(x, field, axis=0)(fine[0])
    return fine[0], fine[1], scipy.interpolate.PchipInterpolator(y, along, axis=1)(fine[1])


def _inside(place: Array, ends: Ends) -> slice:
    slack = 1e-9 * (ends[1] - ends[0])
    first, last = np.searchsorted(place, [ends[0] - slack, ends[1] + slack])
    return slice(int(first), int(last))


def _contours(
    figure: go.Figure, x: Array, y: Array, field: Array, levels: Sequence[float], at: dict[str, int]
) -> None:
    """White lines at levels: those of plotly are equally far apart, so the field is bent to them."""
    beyond = levels[0] - abs(levels[0]), levels[-1] + abs(levels[-1])
    level = np.interp(field, (beyond[0], *levels, beyond[1]), np.arange(-1.0, len(levels) + 1.0))
    lines = {"start": 0, "end": len(levels) - 1, "size": 1, "coloring": "none"}
    look = {"showscale": False, "hoverinfo": "skip", "line": {"color": WHITE, "width": 0.8}}
    figure.add_contour(x=x, y=y, z=level.T, contours=lines, **look, **at)


def _load_zone(figure: go.Figure, zone: LoadZone, at: dict[str, int]) -> None:
    """Bars and an arrow."""
    angle, most = np.degrees(zone.angles) % 360.0, zone.largest
    for name, values, colour, share in zone.forces:
        width = [share * LoadZone.BAR * 360.0 / angle.size] * angle.size
        figure.add_barpolar(r=values, theta=angle, width=width, marker_color=colour, name=name, **at)
    if zone.load is not None:
        arrow: Any = {"mode": "lines+markers", "line": {"color": RED, "width": 3}}
        marker = {"symbol": ["circle", "arrow"], "size": [0, 12], "angleref": "previous", "color": RED}
        towards = float(np.degrees(zone.load)) % 360.0
        place = {"theta": [towards] * 2, "r": [1.02 * most, 1.22 * most]}
        figure.add_scatterpolar(**place, **arrow, marker=marker, name="load", **at)
    radius: dict[str, Any] = {"range": [0.0, LoadZone.ROOM * most], "tickmode": "array"}
    radius["tickvals"], covered = _even_numbers(LoadZone.ROOM * most), zone.longest_beside
    # where bars are not in the way
    radius["ticktext"] = [f"{value:g} N" if value > covered else "" for value in radius["tickvals"]]
    # numbers upright, wherever their axis points
    radius |= {"angle": zone.free_angle, "tickangle": zone.free_angle}
    around: dict[str, Any] = {"tickmode": "array", "tickvals": [*QUARTERS]}
    words = zone.title.replace("\n", "<br>")  # above the circle, in place of its degrees
    around["ticktext"] = [words if angle == UPWARDS and words else f"{angle}°" for angle in QUARTERS]
    figure.update_polars(barmode="overlay", radialaxis=radius, angularaxis=around, **at)


def _even_numbers(end: float) -> list[float]:
    """Numbers 1, 2 or 5 times a power of ten apart, about three of them up to `end`, and on to twice that."""
    power = 10.0 ** np.floor(np.log10(end / 3.0))
    step = power * max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= end / 3.0)
    return [float(f"{step * k:.6g}") for k in range(1, int(2.0 * end / step) + 1)]


def _move_together(figure: go.Figure, panels: Sequence[Any]) -> None:
    """Let maps one below another show the part of the plane that the first one shows."""
    if len(panels) < 2 or figure.layout.meta["columns"] > 1:
        return
    first = panels[0]
    for row, panel in enumerate(panels[1:], start=2):
        if isinstance(first, Map) and isinstance(panel, Map) and panel.view == first.view and panel.aspect:
            figure.update_xaxes(matches="x", row=row, col=1)
            figure.update_yaxes(matches="y", scaleanchor=None, row=row, col=1)


def _sliding(slides: Slides) -> go.Figure:
    """One figure with a frame for every picture, whose axes reach over all of them."""
    figures = [figure_of(picture, MOVING) for picture in slides.pictures]
    base, data = figures[slides.start], [[trace.to_plotly_json() for trace in one.data] for one in figures]
    for side, axes in (("x", base.select_xaxes()), ("y", base.select_yaxes())):
        for axis in axes:
            own = axis.plotly_name.replace("axis", "")
            values = [
                np.asarray(trace[side], float)
                for one in data
                for trace in one
                if trace.get(f"{side}axis", side) == own and trace["type"] == "scatter"
            ]
            if axis.range is None and values:
                axis.range = _reach(np.concatenate(values), axis.type == "log")
    reaches = [p.radialaxis.range[1] for one in figures for p in one.select_polars() if p.radialaxis.range]
    if reaches:
        base.update_polars(radialaxis_range=[0.0, max(reaches)])
    names = "x", "y", "z", "r", "theta"
    moving = [k for k in range(len(base.data)) if any(_differs(one[k], data[0][k], names) for one in data)]
    base.frames = [
        go.Frame(
            data=[{name: one[k][name] for name in ("type", *names) if name in one[k]} for k in moving],
            traces=moving,
            name=str(number),
        )
        for number, one in enumerate(data)
    ]
    label, unit = (slides.label, "") if isinstance(slides.label, str) else slides.label
    texts = [f"{value:.4g} {unit}".strip() for value in slides.values]
    slider = {"label": label, "texts": texts, "start": slides.start, "runs": slides.runs}
    return base.update_layout(meta={**base.layout.meta, "slider": slider})


def _differs(one: dict[str, Any], other: dict[str, Any], names: Sequence[str]) -> bool:
    return any(
        not np.array_equal(np.asarray(one[name], float), np.asarray(other[name], float), equal_nan=True)
        for name in names
        if name in one
    )


def _axes(figure: go.Figure, at: dict[str, int]) -> tuple[Any, Any]:
    return next(figure.select_xaxes(**at)), next(figure.select_yaxes(**at))


def _range(ends: Ends, log: bool) -> list[float]:
    return [float(np.log10(end)) if log else float(end) for end in ends]


def _reach(values: Array, log: bool) -> list[float]:
    """Ends of an axis with some room around its values."""
    shown = np.log10(values[values > 0.0]) if log else values[np.isfinite(values)]
    low, high = float(shown.min()), float(shown.max())
    room = REACH * (high - low or 1.0)
    return [low - room, high + room]
