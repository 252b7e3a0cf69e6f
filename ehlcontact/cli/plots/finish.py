"""A figure made ready for the page: legend, words under the pointer, places of panels, few points and digits."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ehlcontact.cli.plots.thinned import rounded, thin_line

PAGE, TELEPHONE = 990.0, 370.0  # px that the figures of a wide and of a narrow page are wide
LEFT, RIGHT, FOOT = 74.0, 14.0, 48.0  # px beside and under the axes
BETWEEN, BAR, SECOND = 66.0, 78.0, 70.0  # px from panel to panel, of a bar of colours, of a second axis
BARE, TITLE, TOOLS, KEY, ROUND = (
    18.0,
    22.0,
    30.0,
    28.0,
    30.0,
)  # px: no label, title, buttons, row of a legend, degrees
ROOM = 20.0  # px that a label may be longer than its panel
LETTER, SAMPLE = 6.6, 46.0  # px that a letter takes on average, and the line beside a name in a legend
FEW_DECADES = 0.5, 1.7  # of a logarithmic axis with ticks at 1, 2 and 5: one over fewer has plotly's own
MOST_DECADES = 9.0  # with a tick at each
SMALL = -4.0  # decade below which numbers have exponents
MAP_LEVELS = 500.0  # that a map tells apart; a screen shows 256
COORDINATES = "x", "y", "z", "r", "theta", "base"

Axes = dict[str, Any]


def finished(figure: go.Figure) -> dict[str, Any]:
    """The figure for JSON; its ``layout.meta`` has the layout of a narrow page, and what was thinned."""
    parts = {"data": figure.data, "frames": figure.frames}
    whole: dict[str, Any] = {name: [one.to_plotly_json() for one in part] for name, part in parts.items()}
    layout = whole["layout"] = figure.layout.to_plotly_json()
    meta = layout["meta"]
    _name(whole["data"], layout)
    _ticks(whole["data"], layout)
    found, moving = [], set()
    for frame in whole["frames"]:
        frame["traces"] = list(frame.get("traces") or range(len(frame["data"])))
        moving |= set(frame["traces"])
        for trace, number in zip(frame["data"], frame["traces"], strict=True):
            trace.update(_short(whole["data"][number] | trace, trace, layout))
    for number, trace in enumerate(whole["data"]):
        if number not in moving and trace["type"] == "scatter" and trace.get("mode", "lines") == "lines":
            trace["x"], trace["y"], left_out = thin_line(*(np.asarray(trace[side], float) for side in "xy"))
            found.append(left_out)
        trace.update(_short(trace, trace, layout))
    names = [trace["name"] for trace in whole["data"] if trace.get("showlegend")]
    layout["showlegend"] = len(names) > 1
    _merge(layout, places(figure, meta["columns"], PAGE, names))
    meta["narrow"] = places(figure, 1, TELEPHONE, names)
    meta["thinned"] = "; ".join(dict.fromkeys(filter(None, found)))
    return whole


def _name(traces: list[dict[str, Any]], layout: dict[str, Any]) -> None:
    """Each name once in the legend, for all traces that have it; and the words under the pointer."""
    known: set[str] = set()
    for trace in traces:
        name = trace.get("name", "")
        shown = bool(name) and name not in known and trace.get("opacity", 1.0) == 1.0
        trace |= {"legendgroup": name or "-", "showlegend": shown}
        known |= {name} if shown else set()
        if trace["type"] in ("barpolar", "scatterpolar"):
            trace["hovertemplate"] = f"%{{theta:.0f}}°: %{{r:.4g}}<extra>{name}</extra>"
        elif trace.get("hoverinfo") != "skip":
            x, y = (_axis(layout, trace, side).get("title", {}).get("text", side) for side in "xy")
            number = "" if _are_words(trace.get("x", ())) else ":.5~g"
            words = f"{x}: %{{x{number}}}<br>{y}: %{{y:.5~g}}"
            bar = layout.get(trace.get("coloraxis") or "", {}).get("colorbar", {})
            field = f"<br>{bar['title']['text']}: %{{z:.4~g}}" if bar else ""
            trace["hovertemplate"] = f"{words}{field}<extra>{name}</extra>"


def _are_words(values: Any) -> bool:
    """Whether coordinates are the words that bars stand over."""
    return len(values) > 0 and isinstance(values[0], str)


def _ticks(traces: list[dict[str, Any]], layout: dict[str, Any]) -> None:
    """Whole numbers at the decades of logarithmic axes, over few decades at 2 and 5 too: no bare digits."""
    for key, axis in layout.items():
        side = key[0]
        if not key.startswith(f"{side}axis") or axis.get("type") != "log":
            continue
        ends = axis.get("range")
        if ends is None:
            names = _matched(key, layout)
            own = [
                trace
                for trace in traces
                if (trace.get(f"{side}axis") or side).replace(side, f"{side}axis", 1) in names
            ]
            values = np.concatenate([[0.0], *(np.asarray(trace.get(side, ()), float).ravel() for trace in own)])
            ends = np.log10(values[values > 0.0])
        span = float(np.ptp(ends)) if len(ends) else 0.0
        if FEW_DECADES[0] < span < FEW_DECADES[1]:
            axis |= {"dtick": "D2", "tickformat": "~g" if min(ends) > SMALL else "~e"}
        elif FEW_DECADES[1] <= span < MOST_DECADES:
            axis["dtick"] = 1


def _matched(key: str, layout: dict[str, Any]) -> set[str]:
    """An axis and those that have its ends."""
    side, own = key[0], layout[key].get("matches")
    first = key if own is None else own.replace(side, f"{side}axis", 1)
    short = first.replace("axis", "")
    return {first} | {
        name for name, axis in layout.items() if name.startswith(f"{side}axis") and axis.get("matches") == short
    }


def _axis(layout: dict[str, Any], trace: dict[str, Any], side: str) -> Axes:
    """Axis of a trace; the label is that of the last panel of a column where panels share it."""
    key = (trace.get(f"{side}axis") or side).replace(side, f"{side}axis", 1)
    own: Axes = layout.get(key, {})
    if own.get("title", {}).get("text") or not own.get("matches"):
        return own
    return layout.get(own["matches"].replace(side, f"{side}axis", 1), own)


def _short(trace: dict[str, Any], values: dict[str, Any], layout: dict[str, Any]) -> dict[str, Any]:
    """Coordinates of a trace in as few digits as its axes allow."""
    found = {}
    for name in COORDINATES:
        if values.get(name) is None or trace["type"] == "image":
            continue
        if _are_words(values[name]):
            found[name] = [str(word) for word in values[name]]
        else:
            log = name in "xy" and _axis(layout, trace, name).get("type") == "log"
            fine = {"fineness": MAP_LEVELS} if name == "z" else {}
            found[name] = rounded(values[name], logarithmic=log, **fine)
    return found


def places(figure: go.Figure, columns: int, width: float, names: list[str]) -> dict[str, Any]:
    """Layout that puts the panels in so many columns, or one below the other, on a page so wide."""
    meta = figure.layout.meta
    cells = [(r + 1, c + 1) for c in range(meta["columns"]) for r in range(meta["rows"])]
    lines = [[cell] for cell in cells]
    if columns == meta["columns"]:
        lines = [[(r + 1, c + 1) for c in range(columns)] for r in range(meta["rows"])]
    panels = {cell: _panel(figure, cell) for cell in cells}
    beside = max(panels[line[-1]]["right"] for line in lines)
    inner = width - LEFT - beside
    # degrees stand beside a circle, however narrow the page is
    room = [
        max(panels[line[k]].get("gap", panels[line[k]]["right"]) for line in lines) for k in range(columns - 1)
    ]
    gaps = [BETWEEN + right for right in room]
    wide = (inner - sum(gaps)) / columns
    tall = [min(meta["heights"][line[0][0] - 1], wide * panels[line[0]].get("shape", np.inf)) for line in lines]
    heads = [max(panels[cell]["head"] for cell in line) for line in lines]
    feet = [max(panels[cell]["foot"] for cell in line) for line in lines]
    total = sum(tall) + sum(heads[1:]) + sum(feet[:-1])
    keys = KEY * _rows([*names], width) if len(names) > 1 else 0.0
    margin = {"l": LEFT, "r": beside, "t": TOOLS + keys + heads[0], "b": feet[-1]}
    found: dict[str, Any] = {"margin": margin, "height": round(total + margin["t"] + margin["b"])}
    found["legend"] = {"y": 1.0 + (heads[0] + 4.0) / total}
    top = 0.0
    for k, line in enumerate(lines):
        top += heads[k] if k else 0.0
        left = 0.0
        for column, cell in enumerate(line):
            x = [round(left / inner, 4), round((left + wide) / inner, 4)]
            y = [round(1.0 - (top + tall[k]) / total, 4), round(1.0 - top / total, 4)]
            panels[cell]["words"] = _wrapped(panels[cell].get("label", ""), tall[k] + ROOM)
            _place(found, panels[cell], x, y, inner)
            left += wide + (gaps[column] if column < len(gaps) else 0.0)
        top += tall[k] + feet[k]
    return found


def _panel(figure: go.Figure, cell: tuple[int, int]) -> dict[str, Any]:
    """Names of the axes of a panel, and the room [px] that it takes beside its axes."""
    row, col = cell
    polar = next(figure.select_polars(row=row, col=col), None)
    head = TITLE if figure.layout.meta["titled"] else 8.0
    if polar is not None:
        return {
            "polar": polar.plotly_name,
            "right": ROUND,
            "gap": 2.0 * ROUND,
            "head": max(head, ROUND) + TITLE * str(polar.angularaxis.ticktext).count("<br>"),
            "foot": ROUND,
        }
    x, y = next(figure.select_xaxes(row=row, col=col)), next(figure.select_yaxes(row=row, col=col))
    key = y.plotly_name.replace("axis", "")
    own = [trace for trace in figure.data if getattr(trace, "yaxis", None) in (key, None if key == "y" else key)]
    bar = next((trace.coloraxis for trace in own if getattr(trace, "coloraxis", None)), None)
    second = any(other.overlaying == key for other in figure.select_yaxes())
    right = BAR if bar else SECOND if second else RIGHT
    foot = FOOT if x.title.text else BARE if x.showticklabels is not False else 4.0
    found = {"x": x.plotly_name, "y": y.plotly_name, "bar": bar, "right": right, "head": head, "foot": foot}
    found["label"] = y.title.text or ""
    if x.constrain == "domain":  # a map, whose height follows from its width
        found["shape"] = y.scaleratio * np.ptp(y.range) / np.ptp(x.range)
    return found


def _place(found: dict[str, Any], panel: dict[str, Any], x: list[float], y: list[float], inner: float) -> None:
    if "polar" in panel:
        found[panel["polar"]] = {"domain": {"x": x, "y": y}}
        return
    found |= {panel["x"]: {"domain": x}, panel["y"]: {"domain": y, "title": {"text": panel["words"]}}}
    if panel["bar"]:
        at = {"x": x[1] + 8.0 / inner, "y": 0.5 * (y[0] + y[1]), "len": y[1] - y[0], "xpad": 0, "ypad": 0}
        found[panel["bar"]] = {"colorbar": at}


def _wrapped(label: str, height: float) -> str:
    """A label of a y axis in two lines, where one is longer than its panel is high."""
    if LETTER * len(label) <= height or " " not in label:
        return label
    lines = textwrap.wrap(label, max(len(label) // 2 + 2, *map(len, label.split())))
    return "<br>".join(lines)


def _rows(names: list[str], width: float) -> int:
    """Rows of a legend, whose columns plotly makes as wide as the longest name."""
    across = max(1, int(width / (SAMPLE + LETTER * max(map(len, names)))))
    return -(-len(names) // across)


def _merge(base: dict[str, Any], changes: dict[str, Any]) -> None:
    for name, value in changes.items():
        if isinstance(value, dict) and isinstance(base.get(name), dict):
            _merge(base[name], value)
        else:
            base[name] = value
