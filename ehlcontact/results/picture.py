"""Plain figures of results. Matplotlib is imported where one is drawn."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from textwrap import fill
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes

Array = NDArray[Any]
Axis = tuple[Any, "str | tuple[str, str]"]  # values; words, or words and their unit

COLOURS = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9"  # Okabe and Ito, for colour-blind eyes
WIDTH, HEIGHT, DPI = 4.6, 3.4, 130  # inches of a panel; of files
DECADE = 10.0  # largest over smallest value, beyond which an axis that may be is logarithmic
MOST_NAMED = 8  # lines that a legend names
# Units of figures: what contacts have in a unit of the SI is far from 1
SHOWN = {"m": ("µm", 1e6), "Pa": ("GPa", 1e-9), "N/m": ("N/µm", 1e-6)}
GRID: dict[str, Any] = {"color": "#dddddd", "linewidth": 0.6}


@dataclass(frozen=True)
class Panel:
    """Lines over one axis, or bars where its values are words.

    Parameters
    ----------
    x : (values, label)
    lines : sequence of (name, values, half widths of error bars or None)
    y : label
    logs : str
        "x", "y" or both: logarithmic axes, where their values are `far_apart`.
    marks : str
        Marker of each line, one after another; none by default.
    bottom : float, optional
        Where the y axis begins.
    """

    x: Axis
    lines: Sequence[tuple[str, Array, Array | None]]
    y: str | tuple[str, str]
    logs: str = ""
    marks: str = ""
    bottom: float | None = None

    def draw(self, axes: Any) -> None:
        """Into matplotlib axes."""
        at, x_label, _ = _scaled(*self.x)
        words = at.dtype.kind in "US"
        for k, (name, values, bars) in enumerate(self.lines):
            y, y_label, size = _scaled(values, self.y)
            colour, style = COLOURS[k % len(COLOURS)], ("-", "--", ":")[k // len(COLOURS) % 3]
            if words:
                axes.bar(at, y, color=colour, label=name or None, yerr=None if bars is None else bars * size)
                continue
            mark = self.marks[k % len(self.marks)] if self.marks else "o" if len(at) < 2 else ""
            axes.plot(at, y, style, marker=mark, color=colour, linewidth=1.2, label=name or None)
            if bars is not None:
                axes.fill_between(at, y - bars * size, y + bars * size, color=colour, alpha=0.2, linewidth=0.0)
        if "x" in self.logs and not words and far_apart(at):
            axes.set_xscale("log")
        elif "x" in self.logs and not words and at.min() == 0.0 and far_apart(at[at > 0.0]):
            axes.set_xscale("symlog", linthresh=at[at > 0.0].min())  # from rest on
        if "y" in self.logs and far_apart(np.concatenate([np.ravel(values) for _, values, _ in self.lines])):
            axes.set_yscale("log")
        if words:
            axes.tick_params(axis="x", labelrotation=45)
        axes.set(xlabel=x_label, ylabel=y_label)
        if self.bottom is not None:
            axes.set_ylim(self.bottom, self.bottom + 1.05 * (axes.get_ylim()[1] - self.bottom))
        axes.grid(**GRID)
        axes.set_axisbelow(True)
        if 1 <= sum(bool(name) for name, *_ in self.lines) <= MOST_NAMED:
            axes.legend(frameon=False, fontsize=8)


@dataclass(frozen=True)
class Map:
    """A field over two axes."""

    x: Axis
    y: Axis
    values: Axis

    def draw(self, axes: Any) -> None:
        """Into matplotlib axes."""
        (x, x_label, _), (y, y_label, _), (field, label, _) = (
            _scaled(*one) for one in (self.x, self.y, self.values)
        )
        look: dict[str, Any] = {"cmap": "viridis", "norm": "log" if far_apart(field) else None}
        if field.min() < 0.0 < field.max():  # white is no change
            most = float(np.percentile(np.abs(field), 99.0))
            look = {"cmap": "RdBu_r", "vmin": -most, "vmax": most}
        # a film grows a hundredfold towards the inlet
        mesh = axes.pcolormesh(x, y, field.T, shading=smooth(field), rasterized=True, **look)
        axes.figure.colorbar(mesh, ax=axes, label=label)
        axes.set(xlabel=x_label, ylabel=y_label)


def draw(title: str, panels: Sequence[Panel | Map], path: str | os.PathLike[str] | None = None) -> Any:
    """Matplotlib figure of panels, two in a row; into a file too where a path is given."""
    from matplotlib.figure import Figure

    wide = min(len(panels), 2)
    high = -(-len(panels) // 2)
    figure = Figure(
        figsize=(max(WIDTH * wide, 1.3 * WIDTH), HEIGHT * high + 0.6), layout="compressed"
    )  # room for maps that are to scale
    for k, panel in enumerate(panels):
        panel.draw(figure.add_subplot(high, wide, k + 1))
    figure.suptitle(fill(title, 50 * wide), fontsize=10)
    return written(figure, path)


def smooth(field: Array) -> Literal["gouraud", "nearest"]:
    """Shading of a map: colours mixed between its nodes, where it has a value at each."""
    return "gouraud" if np.isfinite(field).all() else "nearest"


def far_apart(values: Array) -> bool:
    """Whether values are all > 0, and the largest of them is more than a decade above the smallest."""
    return bool(values.size and values.min() > 0.0 and values.max() > DECADE * values.min())


def written(figure: Any, path: str | os.PathLike[str] | None) -> Any:
    """The figure, in a file too where a path is given, whose ending gives the format.

    Raises
    ------
    InputError
        An ending that is no format of pictures, or a file that cannot be written.
    """
    if path is not None:
        kind, known = Path(path).suffix[1:].lower() or "png", sorted(figure.canvas.get_supported_filetypes())
        if kind not in known:
            raise InputError("path", str(path), f"a file name ending in one of {', '.join(known)}")
        buffer = BytesIO()
        figure.savefig(buffer, format=kind, dpi=DPI)
        write_bytes(path, buffer.getvalue())
    return figure


def _scaled(values: Any, label: str | tuple[str, str]) -> tuple[Array, str, float]:
    """Values, label and factor in the unit of figures."""
    array = np.asarray(values)
    if isinstance(label, str):
        return array, label, 1.0
    words, unit = label
    shown, factor = SHOWN.get(unit, (unit, 1.0))
    text = f"{words} [{shown}]".strip() if shown else words
    return (array if factor == 1.0 else array * factor), text, factor
