"""Lines and bars of matplotlib's axes as traces of plotly.js."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.lines import Line2D

from ehlcontact.cli.plots.live.thinned import rounded, thin_line

PIXELS = 1.25  # of a line's width, per point
THINNEST = 1.2  # px
DASHES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
MARKERS = {"o": "circle", "s": "square", "^": "triangle-up", "D": "diamond", "v": "triangle-down", "*": "star"} | {
    "x": "x-thin",
    "+": "cross-thin",
}

Trace = dict[str, Any]


def label_of(artist: Any) -> str:
    """The name that a legend shows, empty where it shows none."""
    label = str(artist.get_label())
    return "" if label.startswith("_") else label


def traces_of(axes: Axes) -> tuple[list[Trace], list[str]]:
    """Every line in coordinates of the data, and how they were thinned.

    Lines right across the axes are traces where a legend names them; the others are marks, see `areas`.
    """
    found, told = [], []
    for line in axes.get_lines():
        if not crosses(line):
            trace, thinned = _trace(axes, line)
            told += [thinned] if thinned else []
            found.append(trace)
        elif label_of(line):
            found.append(_across(axes, line))
    return found, told


def crosses(line: Line2D) -> bool:
    """Whether a line is one of `axhline` and `axvline`."""
    return line.get_transform() != line.axes.transData  # type: ignore[union-attr]


def look_of(line: Line2D) -> Trace:
    """Colour, width, dashes and markers."""
    colour, style = to_hex(line.get_color()), str(line.get_linestyle())
    marker = MARKERS.get(str(line.get_marker()))
    look: Trace = {"mode": "markers" if style not in DASHES else "lines" if marker is None else "lines+markers"}
    if style in DASHES:
        width = max(PIXELS * float(line.get_linewidth()), THINNEST)
        look["line"] = {"color": colour, "width": round(width, 2), "dash": DASHES[style]}
    if marker is not None:
        hollow = line.get_fillstyle() == "none" or marker.endswith("thin")
        symbol = marker if marker.endswith("thin") or not hollow else f"{marker}-open"
        size = round(PIXELS * float(line.get_markersize()), 2)
        look["marker"] = {"symbol": symbol, "size": size, "color": colour, "line": {"color": colour, "width": 1.5}}
    if line.get_alpha() is not None:
        look["opacity"] = float(line.get_alpha() or 0.0)
    return look


def _trace(axes: Axes, line: Line2D) -> tuple[Trace, str]:
    x, y, told = thin_line(*(np.asarray(data, dtype=float) for data in line.get_data(orig=False)))
    numbers = {
        "x": rounded(x, logarithmic=axes.get_xscale() == "log"),
        "y": rounded(y, logarithmic=axes.get_yscale() == "log"),
    }
    return {"type": "scatter", "name": label_of(line), **look_of(line), **numbers}, told


def _across(axes: Axes, line: Line2D) -> Trace:
    """A named line from end to end of the axes."""
    x, y = (np.asarray(data, dtype=float) for data in line.get_data(orig=False))
    if y[0] == y[-1]:
        x = np.array(axes.get_xlim())
    else:
        y = np.array(axes.get_ylim())
    return {"type": "scatter", "name": label_of(line), **look_of(line), "x": x.tolist(), "y": y.tolist()}


def polar_traces(axes: Axes) -> list[Trace]:
    """Bars of polar axes, and their arrows as lines along the radius."""
    found: list[Trace] = []
    for bars in axes.containers:
        rows = np.array([(bar.get_x() + 0.5 * bar.get_width(), bar.get_width(), bar.get_height()) for bar in bars])
        degrees = np.degrees(rows[:, :2])
        found.append(
            {
                "type": "barpolar",
                "name": label_of(bars),
                "theta": rounded(degrees[:, 0] % 360.0),
                "width": rounded(degrees[:, 1]),
                "r": rounded(rows[:, 2]),
                "marker": {"color": to_hex(bars[0].get_facecolor())},
            }
        )
    for text in axes.texts:
        arrow = getattr(text, "arrowprops", None)
        if arrow is not None:
            (angle, end), (_, start) = text.xy, text.xyann  # type: ignore[attr-defined]
            look = {"color": to_hex(arrow["color"]), "width": 3}
            at = {"theta": [float(np.degrees(angle)) % 360.0] * 2, "r": [float(start), float(end)]}
            found.append({"type": "scatterpolar", "mode": "lines", "name": "load", "line": look, **at})
    return found
