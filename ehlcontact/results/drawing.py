"""Pictures drawn with matplotlib, which is imported where one is drawn: files, notebooks."""

from __future__ import annotations

import os
from io import BytesIO
from pathlib import Path
from textwrap import fill
from typing import Any, Literal

import numpy as np

from ehlcontact.checks.kinds import FILE
from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from ehlcontact.results.picture import (
    GREY,
    INK,
    RED,
    ROW,
    ROW_ENDS,
    WHITE,
    Array,
    Line,
    LoadZone,
    Map,
    Panel,
    Picture,
    Slides,
    far_apart,
)

WIDTH, PX, DPI = 4.6, 1.0 / 80.0, 130  # inches of a panel, and of a px of a page; dots of files
ALONE, STACKED = 1.3, 1.7  # width of a picture of one column over that of a panel: one panel, several
MAP, LOWEST = 0.65, 1.7  # width of a map over that of its panel; inches that one is high at least
MOST_NAMED = 8  # lines that a legend names
LETTERS = 50  # of a title, over a panel
PLAIN_DECADES, FEW_DECADES = 4.5, 1.6  # of a logarithmic axis with plain numbers; with numbers at 2 and 5 too
GAP = 0.045  # height of a name at the end of a line over that of the panel
GRID: dict[str, Any] = {"color": "#dddddd", "linewidth": 0.6}


def draw(picture: Picture | Slides, path: str | os.PathLike[str] | None = None) -> Any:
    """Matplotlib figure of a picture, in a file too where a path is given, whose ending gives the format.

    Raises
    ------
    InputError
        An ending that is no format of pictures, or a file that cannot be written.
    """
    from matplotlib.figure import Figure

    if path is not None:
        FILE.take("path", path, False)
    if isinstance(picture, Slides):
        picture = picture.pictures[picture.start]
    rows, columns = picture.shape
    lines = [picture.panels[row * columns : (row + 1) * columns] for row in range(rows)]
    heights = [
        max((_tall(panel, PX * height) for panel in line), default=PX * height)
        for line, height in zip(lines, picture.row_heights, strict=True)
    ]
    wide = WIDTH * columns if columns > 1 else WIDTH * (ALONE if rows == 1 else STACKED)
    # room for maps that are to scale
    figure = Figure(figsize=(wide, sum(heights) + 0.25 * rows + 0.4), layout="compressed")
    places = figure.add_gridspec(rows, columns, height_ratios=heights)
    above: list[Any] = [None] * columns
    for k, panel in enumerate(picture.panels):
        row, column = divmod(k, columns)
        polar = {"projection": "polar"} if isinstance(panel, LoadZone) else {}
        shared = above[column] if picture.shared else None
        above[column] = axes = figure.add_subplot(places[row, column], sharex=shared, **polar)
        DRAW[type(panel)](axes, panel)
        if picture.shared and k + columns < len(picture.panels):
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)
    figure.suptitle(fill(picture.title, LETTERS * columns), fontsize=10)
    if picture.note:
        figure.supxlabel(fill(picture.note, 2 * LETTERS * columns), fontsize=8)
    return _written(figure, path)


def _tall(panel: Panel | Map | LoadZone, most: float) -> float:
    """Inches that a panel is high: a flat map that is to scale less than others."""
    if not isinstance(panel, Map) or panel.aspect is None or panel.view is None:
        return most
    (left, right), (low, high) = panel.view
    return min(most, max(LOWEST, MAP * WIDTH * panel.aspect * (high - low) / (right - left)))


def _panel(axes: Any, panel: Panel) -> None:
    """Lines and bars into matplotlib axes."""
    panel = panel.shown()
    second = axes.twinx() if panel.second else None
    for line in panel.lines:
        _line(second if line.second else axes, line, named=not panel.named_at_ends)
    _scales(axes, panel)
    axes.set(xlabel=panel.x, ylabel=panel.y)
    axes.set_title(panel.title, fontsize=10)
    if panel.x_ends is not None:
        axes.set_xlim(panel.x_ends)
    if panel.y_ends is not None:
        axes.set_ylim(panel.y_ends)
    elif panel.bottom is not None:
        top = axes.get_ylim()[1]  # of a flat line at the bottom: any
        axes.set_ylim(panel.bottom, panel.bottom + (1.05 * (top - panel.bottom) or 1.0))
    axes.margins(x=0.02)
    if panel.equal:
        axes.set_aspect("equal", adjustable="datalim")
        axes.ticklabel_format(useOffset=False)
        axes.locator_params(nbins=6)
    if panel.tick is not None:
        axes.xaxis.set_major_locator(_every(panel.tick))
    if panel.y_tick is not None:
        axes.yaxis.set_major_locator(_every(panel.y_tick))
    for band in panel.bands:
        axes.axvspan(band.low, band.high, color=band.colour, zorder=0.5)
        at = {"xy": (0.5 * (band.low + band.high), 0.0), "xycoords": axes.get_xaxis_transform()}
        axes.annotate(band.text, **at, xytext=(0, 2), textcoords="offset points", ha="center", fontsize=8)
    for mark in panel.marks:
        axes.axvline(mark.at, color=mark.colour, linestyle=":", linewidth=1.0)
        at = {"xy": (mark.at, 1.0), "xycoords": axes.get_xaxis_transform(), "textcoords": "offset points"}
        axes.annotate(mark.text, **at, xytext=(2, -2), va="top", fontsize=8, color=mark.colour)
    axes.grid(**GRID)
    axes.set_axisbelow(True)
    if panel.rows:
        axes.set(yticks=[], ylim=(len(panel.rows) - 1 + ROW_ENDS[1], ROW_ENDS[0]))
        for line in axes.lines:
            line.set_solid_capstyle("butt")  # bars begin and end where they say
        for k, words in enumerate(panel.rows):
            at = {"xy": (0.01, k - ROW), "xycoords": axes.get_yaxis_transform(), "va": "bottom"}
            axes.annotate(words, **at, fontsize=8)
    if second is not None:
        second.set(ylabel=panel.second, ylim=panel.second_ends)
        _coloured(axes, second, panel)
    if panel.named_at_ends:
        _names_at_ends(axes, panel)
    _legend(axes, second, panel)


def _line(axes: Any, line: Line, *, named: bool) -> None:
    if line.words:
        label = line.name or None
        axes.bar(line.x, line.y, color=line.colour, label=label, yerr=line.bars, bottom=line.base)
        axes.tick_params(axis="x", labelrotation=45)
        return
    mark = line.mark or ("o" if line.x.size < 2 else "")
    hollow = {"fillstyle": "none"} if mark.endswith(" ") else {}
    alone = not line.dash
    label = line.name if line.name and not line.faint and (named or alone or line.colour == INK) else None
    look = {"linewidth": line.width, "markersize": 4.5, "alpha": 0.45 if line.faint else None, "label": label}
    axes.plot(
        line.x, line.y, linestyle=line.dash or "none", marker=mark.strip(), color=line.colour, **look, **hollow
    )
    if line.bars is not None:
        ends = line.y - line.bars, line.y + line.bars
        axes.fill_between(line.x, *ends, color=line.colour, alpha=0.2, linewidth=0.0)


def _scales(axes: Any, panel: Panel) -> None:
    """Logarithmic axes; from rest on one that is linear up to its first value."""
    if panel.logarithmic("x"):
        axes.set_xscale("log")
        _plain_ticks(axes.xaxis)
    elif "x" in panel.logs and panel.lines and not panel.lines[0].words:
        x = np.concatenate([line.x for line in panel.lines])
        if x.min() == 0.0 and far_apart(x[x > 0.0]):
            axes.set_xscale("symlog", linthresh=x[x > 0.0].min())
    if panel.logarithmic("y"):
        axes.set_yscale("log")
        _plain_ticks(axes.yaxis)


def _plain_ticks(axis: Any) -> None:
    """Numbers as 0.5, 2, 1000 at a logarithmic axis; over few decades at 2 and 5 too."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = np.log10(np.maximum(axis.get_data_interval(), axis.get_minpos()))
    if high - low > PLAIN_DECADES or not np.isfinite(high - low):
        return
    few = high - low < FEW_DECADES
    axis.set_minor_locator(LogLocator(subs=(2.0, 5.0) if few else tuple(range(2, 10))))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}") if few else NullFormatter())


def _every(step: float) -> Any:
    from matplotlib.ticker import MultipleLocator

    return MultipleLocator(step)


def _coloured(axes: Any, second: Any, panel: Panel) -> None:
    """Labels of both y axes in the colours of their first lines."""
    for each, lines in ((axes, False), (second, True)):
        own = [line.colour for line in panel.lines if line.second == lines and line.colour != GREY]
        if own:
            each.yaxis.label.set_color(own[0])


def _names_at_ends(axes: Any, panel: Panel) -> None:
    """Names at the ends of the lines, one above the other where lines end together."""
    last, inside = -1.0, axes.transData - axes.transAxes
    lines = [line for line in panel.lines if line.name and line.dash and line.colour != INK]
    for line in sorted(lines, key=lambda line: float(line.y[-1])):
        last = max(float(inside.transform((line.x[-1], line.y[-1]))[1]), last + GAP)
        at: dict[str, Any] = {"xy": (1.01, last), "xycoords": "axes fraction", "va": "center"}
        axes.annotate(line.name, **at, fontsize=8, color=line.colour)


def _legend(axes: Any, second: Any, panel: Panel) -> None:
    handles, names = axes.get_legend_handles_labels()
    if second is not None:
        more = second.get_legend_handles_labels()
        handles, names = handles + more[0], names + more[1]
    once = dict(zip(reversed(names), reversed(handles), strict=True))
    stacked = any(line.base is not None for line in panel.lines)
    if 1 <= len(once) <= MOST_NAMED or stacked:
        ordered = list(dict.fromkeys(names))
        # above the lines, on a pale ground: a line may run below it
        look: dict[str, Any] = {"framealpha": 0.85, "edgecolor": "none", "fontsize": 8}
        if stacked:  # beside bars that fill the panel, in their order from above
            look |= {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "reverse": True}
        axes.legend([once[name] for name in ordered], ordered, **look).set_zorder(5)


def _map(axes: Any, shown: Map) -> None:
    """A field, or an image, into matplotlib axes."""
    shown = shown.shown()
    (x, x_label), (y, y_label), (field, label) = shown.x, shown.y, shown.values
    if field.ndim == 3:
        axes.pcolormesh(x, y, np.clip(field.transpose(1, 0, 2), 0.0, 1.0), shading="nearest", rasterized=True)
    else:
        look: dict[str, Any] = {"cmap": shown.colours}
        if shown.limits is None:  # a film grows a hundredfold towards the inlet
            look["norm"] = "log" if far_apart(field) else None
        else:
            look["vmin"], look["vmax"] = shown.limits
        mesh = axes.pcolormesh(x, y, field.T, shading=_smooth(field), rasterized=True, **look)
        beyond = "max" if shown.limits and np.nanmax(field) > shown.limits[1] * (1.0 + 1e-9) else "neither"
        if label:
            axes.figure.colorbar(mesh, ax=axes, label=label, extend=beyond)
    if shown.levels:
        axes.contour(x, y, field.T, levels=sorted(shown.levels), colors=WHITE, linewidths=0.6)
    if shown.axes is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, 181)
        half, other = shown.axes
        axes.plot(half * np.cos(turn), other * np.sin(turn), "--", color=WHITE, linewidth=0.8)
    for line in shown.lines:
        _line(axes, line, named=True)
    axes.set(xlabel=x_label, ylabel=y_label)
    axes.set_title(shown.title, fontsize=10)
    if shown.view is not None:
        (left, right), (low, high) = shown.view
        axes.set_xlim(max(x[0], left), min(x[-1], right))
        axes.set_ylim(max(y[0], low), min(y[-1], high))
    if shown.aspect is not None:
        axes.set_aspect(shown.aspect)


def _load_zone(axes: Any, zone: LoadZone) -> None:
    """Bars and an arrow into polar axes of matplotlib."""
    width = LoadZone.BAR * 2.0 * np.pi / zone.angles.size
    for name, values, colour, share in zone.forces:
        axes.bar(zone.angles, values, width=share * width, color=colour, label=name)
    most = zone.largest
    axes.set_rlim(0.0, LoadZone.ROOM * most)
    axes.set_rlabel_position(zone.free_angle)
    axes.grid(**GRID)
    axes.set_axisbelow(True)
    if zone.load is not None:
        arrow = {"arrowstyle": "-|>", "color": RED, "linewidth": 1.6}
        axes.annotate("", xy=(zone.load, 1.22 * most), xytext=(zone.load, 1.02 * most), arrowprops=arrow)
    axes.set_title(zone.title, fontsize=10)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2, frameon=False, fontsize=8)


DRAW: dict[type, Any] = {Panel: _panel, Map: _map, LoadZone: _load_zone}


def _smooth(field: Array) -> Literal["gouraud", "nearest"]:
    """Shading of a map: colours mixed between its nodes, where it has a value at each."""
    return "gouraud" if np.isfinite(field).all() else "nearest"


def _written(figure: Any, path: str | os.PathLike[str] | None) -> Any:
    """The figure, in a file too where a path is given, whose ending gives the format."""
    if path is not None:
        kind, known = Path(path).suffix[1:].lower() or "png", sorted(figure.canvas.get_supported_filetypes())
        if kind not in known:
            raise InputError("path", str(path), f"a file name ending in one of {', '.join(known)}")
        buffer = BytesIO()
        figure.savefig(buffer, format=kind, dpi=DPI)
        write_bytes(path, buffer.getvalue())
    return figure
