"""A matplotlib figure as a scene: panels on a grid, each with its axes, traces and marks.

The browser arranges the panels: side by side where there is room, else one below the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from ehlcontact.cli.plots.live.areas import contours_of, map_of, marks_of, notes_of, picture_of
from ehlcontact.cli.plots.live.lines import polar_traces, traces_of
from ehlcontact.cli.plots.live.thinned import rounded
from ehlcontact.cli.plots.style import WIDTH

MOVING = ("x", "y", "theta", "r")  # of a trace, that frames may differ in
PAGE = 940.0  # px that a figure is wide on a page; a figure's height is to it as in matplotlib

Scene = dict[str, Any]


def scene_of(figure: Figure) -> Scene:
    """Panels of a figure that was drawn, and what of it was thinned."""
    panels: dict[tuple[int, int], Scene] = {}
    owners: list[Axes] = []
    thinned: list[str] = []
    height = figure.get_figheight() / WIDTH * PAGE
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if place is None or axes.get_label() == "<colorbar>":
            continue
        at = (place.rowspan.start, place.colspan.start)
        if at in panels:
            _beside(panels[at], axes)
            continue
        panel, told = _panel(axes, height * _share(axes))
        panels[at] = panel | {"row": at[0], "column": at[1], "matches": _matches(owners, axes)}
        owners.append(axes)
        thinned += told
    _name_rows(list(panels.values()))
    note = figure.get_suptitle()
    return {"panels": list(panels.values()), "note": note, "thinned": "; ".join(dict.fromkeys(thinned))}


def _share(axes: Axes) -> float:
    """Of the figure's height, that of the row of some axes."""
    grid, place = axes.get_gridspec(), axes.get_subplotspec()
    assert grid is not None and place is not None
    ratios: Any = grid.get_height_ratios()
    return float(sum(ratios[row] for row in place.rowspan) / sum(ratios))


def _matches(owners: list[Axes], axes: Axes) -> dict[str, int | None]:
    """The first panel whose scale this one shares, along x and y."""
    groups = {"x": axes.get_shared_x_axes(), "y": axes.get_shared_y_axes()}
    return {
        name: next((k for k, other in enumerate(owners) if group.joined(other, axes)), None)
        for name, group in groups.items()
    }


def _name_rows(panels: list[Scene]) -> None:
    """Labels for panels that have none, for the case that they do not stand beside the one that has."""
    for panel in panels:
        row = [other["y"]["label"] for other in panels if other["row"] == panel["row"] and "y" in other]
        column = [other["x"]["label"] for other in panels if other["column"] == panel["column"] and "x" in other]
        for name, near in (("y", row), ("x", column)):
            if name in panel:
                panel[name]["alone"] = panel[name]["label"] or next(filter(None, near), "")


def _panel(axes: Axes, height: float) -> tuple[Scene, list[str]]:
    base: Scene = {"title": axes.get_title() or axes.get_title(loc="left"), "height": round(height)}
    if axes.name == "polar":
        most = float(axes.get_ylim()[1])
        return base | {"polar": most, "traces": polar_traces(axes), "marks": [], "notes": []}, []
    traces, told = traces_of(axes)
    contours = [contours_of(lines) for lines in axes.collections if isinstance(lines, ContourSet)]
    maps: list[Scene] = []
    pictures: list[Scene] = []
    for image in axes.get_images():
        if np.ndim(np.asarray(image.get_array())) == 2:
            trace, strides = map_of(image)
            maps.append(trace)
            told += [f"maps: 1 in {strides[0]} points down, 1 in {strides[1]} across"] * (max(strides) > 1)
        else:
            pictures.append(picture_of(image))
    equal, box = axes.get_aspect() == 1.0, axes.get_box_aspect()
    panel = base | {
        "x": _axis(axes, "x", equal),
        "y": _axis(axes, "y", equal),
        "equal": equal,
        "box": None if box is None else round(float(box), 4),
        "traces": [*maps, *contours, *traces],
        "pictures": pictures,
        "marks": marks_of(axes),
        "notes": notes_of(axes),
    }
    return panel, told


def _axis(axes: Axes, name: str, free: bool) -> Scene:
    """Label, scale and ends; ends that the aspect sets are left to the browser."""
    axis = getattr(axes, f"{name}axis")
    ends = [float(end) for end in getattr(axes, f"get_{name}lim")()]
    locator = axis.get_major_locator()
    colour = to_hex(axis.label.get_color())
    return {
        "label": axis.get_label_text().replace("\n", " "),
        "log": axis.get_scale() == "log",
        "range": None if free else ends,
        "ticks": [float(at) for at in locator()] if isinstance(locator, FixedLocator) else None,
        "color": None if colour == "#000000" else colour,
    }


def _beside(panel: Scene, axes: Axes) -> None:
    """Lines of a second y axis."""
    traces, _ = traces_of(axes)
    panel["y2"] = _axis(axes, "y", False)
    panel["traces"] += [trace | {"second": True} for trace in traces]


def running(figures: Sequence[Figure], label: str, unit: str, values: Sequence[float], start: int) -> Scene:
    """One scene of figures that differ in their numbers only: a slider runs through them, from `start` on.

    Axes reach over all of them. Of a note the part before a semicolon is kept, for what follows may be a number of
    one figure.
    """
    scenes = [scene_of(figure) for figure in figures]
    base = scenes[start]
    for panels in zip(*(scene["panels"] for scene in scenes), strict=True):
        whole = panels[start]
        if "polar" in whole:
            whole["polar"] = max(panel["polar"] for panel in panels)
        for name in ("x", "y"):
            if whole.get(name, {}).get("range"):
                ends = np.array([panel[name]["range"] for panel in panels])
                whole[name]["range"] = [float(ends.min()), float(ends.max())]
        for note in whole["notes"]:
            note["text"] = note["text"].split(";")[0]
    traces = zip(*([t for panel in scene["panels"] for t in panel["traces"]] for scene in scenes), strict=True)
    moving = [
        {"trace": k}
        | {key: [trace[key] for trace in found] for key in ("x", "y", "theta", "r") if key in found[0]}
        for k, found in enumerate(traces)
    ]
    frames = {"label": label, "unit": unit, "values": rounded(values, fineness=1e3), "start": start, "runs": False}
    return base | {"frames": frames | {"traces": moving}}
