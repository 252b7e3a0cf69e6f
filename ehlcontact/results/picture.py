"""Pictures as data: panels of lines and bars, maps, load zones.

A result describes its picture once. Two renderers draw it: `ehlcontact.results.drawing` with matplotlib, for files
and notebooks, and `ehlcontact.cli.plots.render` with plotly, for pages. Values are in the unit that their label
names; the renderers show them in the units of `SHOWN`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Label = str | tuple[str, str]  # words, or words and their unit
Ends = tuple[float, float]  # of an axis

# Okabe and Ito's colours, which stay apart for colour-blind eyes
BLUE, ORANGE, GREEN, RED, PURPLE, SKY = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9"
GREY, INK = "#7f7f7f", "#1d2126"
ROW, ROW_ENDS = 0.22, (-0.75, 0.35)  # of rows: of words over their row, ends of the axis beyond first and last row
BLACK, WHITE = "#000000", "#ffffff"  # over maps, whose colours a dark page leaves
PALE, PALE_BLUE = "#f2f2f2", "#eaf3fa"  # of stretches behind the lines
COLOURS = BLUE, ORANGE, GREEN, RED, PURPLE, SKY
PASTELS = "#99c7e0", "#f5d899", "#99d8c7", "#eebf99", "#ebc9dc", "#bbddf6"  # of the same, beside them
DASHES = "-", "--", ":"  # after the last colour
DECADE = 10.0  # largest over smallest value, beyond which an axis that may be is logarithmic
# Units of pictures: what contacts have in a unit of the SI is far from 1
SHOWN = {
    "m": ("µm", 1e6),
    "s": ("ms", 1e3),
    "m/s": ("mm/s", 1e3),
    "Pa": ("GPa", 1e-9),
    "N/m": ("N/µm", 1e-6),
    "N m/rad": ("N m/mrad", 1e-3),
    "rad": ("degrees", 180.0 / pi),
    "delta_H": ("dry approach", 1.0),
    "f0": ("load", 1.0),
    "p_h": ("Hertz pressure", 1.0),
    "f0/delta_H": ("load/dry approach", 1.0),
    "f0/delta_H 2a/u_sum": ("load/dry approach 2a/u_sum", 1.0),
}


@dataclass(frozen=True)
class Line:
    """A line, markers, or bars where its places are words.

    Parameters
    ----------
    x, y : array_like, shape (k,)
        In the units of the panel's labels; lines over words are bars.
    name : str
        In the legend; lines of one name have one entry.
    colour : str
        By default the next of `COLOURS`.
    dash : str
        "-", "--", ":", "-."; "" for markers alone; by default a solid line, another one after the last colour.
    mark : str
        Marker: "o", "s", "^", "D", "x"; with " " after it hollow.
    width : float
    bars : array_like, shape (k,), optional
        Half widths of error bars.
    base : array_like, shape (k,), optional
        Where bars over words begin: those of a stack on the ones below.
    second : bool
        Whether it belongs to the second y axis.
    faint : bool
    """

    x: Any
    y: Any
    name: str = ""
    colour: str = ""
    dash: str | None = None
    mark: str = ""
    width: float = 1.4
    bars: Any = None
    base: Any = None
    second: bool = False
    faint: bool = False

    @property
    def words(self) -> bool:
        """Whether its places are words."""
        return np.asarray(self.x).dtype.kind in "US"


@dataclass(frozen=True)
class Mark:
    """A dotted line across a panel at a place on its x axis, with a word at its top."""

    at: float
    text: str = ""
    colour: str = GREY


@dataclass(frozen=True)
class Band:
    """A stretch of the x axis of a panel, shaded behind the lines, with a word at its foot."""

    low: float
    high: float
    text: str = ""
    colour: str = PALE


@dataclass(frozen=True)
class Panel:
    """Lines over one axis.

    Parameters
    ----------
    lines : sequence of Line
    x, y : label
    title : str
    logs : str
        "x", "y" or both: logarithmic axes, where their values are `far_apart`; "X", "Y" in any case.
    x_ends, y_ends : (float, float), optional
        Of the axes, in the units of the labels.
    bottom : float, optional
        Where the y axis begins.
    second : label
        Of a second y axis, at the right.
    second_ends : (float, float), optional
    marks : sequence of Mark
    bands : sequence of Band
    equal : bool
        Whether both axes have one scale.
    tick, y_tick : float, optional
        Steps of the ticks of x and y, as they are shown.
    named_at_ends : bool
        Names of lines stand at their ends where the renderer can, else in the legend.
    rows : sequence of str
        Words of rows that lie at y = 0, 1, 2 and so on, downwards; they stand in the panel, above their rows.
    """

    lines: Sequence[Line]
    x: Label
    y: Label
    title: str = ""
    logs: str = ""
    x_ends: Ends | None = None
    y_ends: Ends | None = None
    bottom: float | None = None
    second: Label = ""
    second_ends: Ends | None = None
    marks: Sequence[Mark] = ()
    bands: Sequence[Band] = ()
    equal: bool = False
    tick: float | None = None
    y_tick: float | None = None
    named_at_ends: bool = False
    rows: Sequence[str] = ()

    def shown(self) -> Panel:
        """The panel in the units of pictures, colours and dashes given to every line, labels plain."""
        (x, fx), (y, fy), (second, fs) = (in_unit(label) for label in (self.x, self.y, self.second))
        lines, styles = [], dict[str, int]()
        for k, line in enumerate(self.lines):
            factor = fs if line.second else fy
            at = styles.setdefault(line.name or str(k), len(styles))
            lines.append(
                replace(
                    line,
                    x=np.asarray(line.x) if line.words else fx * np.asarray(line.x, dtype=float),
                    y=factor * np.asarray(line.y, dtype=float),
                    bars=None if line.bars is None else factor * np.asarray(line.bars, dtype=float),
                    base=None if line.base is None else factor * np.asarray(line.base, dtype=float),
                    colour=line.colour or COLOURS[at % len(COLOURS)],
                    dash=DASHES[at // len(COLOURS) % len(DASHES)] if line.dash is None else line.dash,
                )
            )
        return replace(
            self,
            lines=lines,
            x=x,
            y=y,
            second=second,
            x_ends=_times(self.x_ends, fx),
            y_ends=_times(self.y_ends, fy),
            second_ends=_times(self.second_ends, fs),
            bottom=None if self.bottom is None else fy * self.bottom,
            marks=[replace(mark, at=fx * mark.at) for mark in self.marks],
            bands=[replace(band, low=fx * band.low, high=fx * band.high) for band in self.bands],
        )

    def logarithmic(self, axis: str) -> bool:
        """Whether the axis "x" or "y" is."""
        if axis.upper() in self.logs:
            return True
        lines = [line for line in self.lines if not line.second]
        if axis not in self.logs or any(line.words for line in lines):
            return False
        return far_apart(np.concatenate([np.ravel(getattr(line, axis)) for line in lines]))


@dataclass(frozen=True)
class Map:
    """A field over two axes, or an image.

    Parameters
    ----------
    x, y : (array, label)
        Places along the horizontal axis and the vertical one, rising.
    values : (array, label)
        Shape (x.size, y.size); (x.size, y.size, 3) of an image in red, green and blue, each from 0 to 1.
    title : str
    colours : str
        Of matplotlib; by default blue over white to red where values have both signs.
    limits : (float, float), optional
        Of the colours, in the unit of the values; beyond them a value has the last colour.
    axes : (float, float), optional
        Half axes of an ellipse that is drawn about the origin, in the units of x and y.
    view : (Ends, Ends), optional
        Part of the plane that is shown.
    aspect : float, optional
        Length on paper of a unit of y over that of x; free where none is given.
    levels : sequence of float
        Of the field, where white lines are drawn.
    lines : sequence of Line
        Over the field.
    """

    x: tuple[Any, Label]
    y: tuple[Any, Label]
    values: tuple[Any, Label]
    title: str = ""
    colours: str = ""
    limits: Ends | None = None
    axes: Ends | None = None
    view: tuple[Ends, Ends] | None = None
    aspect: float | None = None
    levels: Sequence[float] = ()
    lines: Sequence[Line] = ()

    def shown(self) -> Map:
        """The map in the units of pictures, colours and their limits given, labels plain."""
        (x, fx), (y, fy), (label, size) = (in_unit(one[1]) for one in (self.x, self.y, self.values))
        field = np.asarray(self.values[0], dtype=float)
        colours, limits = self.colours or "viridis", _times(self.limits, size)
        if (
            not self.colours and field.ndim == 2 and np.nanmin(field) < 0.0 < np.nanmax(field)
        ):  # white is no change
            most = size * float(np.percentile(np.abs(field), 99.0))
            colours, limits = "RdBu_r", limits or (-most, most)
        places, across = np.asarray(self.x[0], dtype=float), np.asarray(self.y[0], dtype=float)
        return replace(
            self,
            x=(fx * places, x),
            y=(fy * across, y),
            values=(field if field.ndim == 3 else size * field, label),
            colours=colours,
            limits=limits,
            axes=None if self.axes is None else (fx * self.axes[0], fy * self.axes[1]),
            view=None if self.view is None else (_scaled(self.view[0], fx), _scaled(self.view[1], fy)),
            aspect=None if self.aspect is None else self.aspect * fx / fy,
            levels=[size * level for level in self.levels],
            lines=Panel(self.lines, self.x[1], self.y[1]).shown().lines,
        )


@dataclass(frozen=True)
class LoadZone:
    """Forces of balls, outward from the centre at their angles, and the direction of a load.

    Parameters
    ----------
    angles : array, shape (balls,)
        Counter-clockwise from x [rad].
    forces : sequence of (str, array, str, float)
        Name, values [N], colour, and width over half the angle from ball to ball, in the order of drawing.
    load : float or None
        Angle of the load [rad]; None where there is none.
    title : str
    most : float, optional
        Force [N] that the circle has room for; by default the largest one.
    """

    angles: Array
    forces: Sequence[tuple[str, Array, str, float]]
    load: float | None = None
    title: str = ""
    most: float | None = None

    ROOM = 1.25  # radius over the longest bar
    BAR = 0.5  # width of a bar over the angle between two balls

    @property
    def largest(self) -> float:
        """Force that the circle has room for [N]."""
        return max(float(values.max()) for _, values, *_ in self.forces) if self.most is None else self.most

    @property
    def free_angle(self) -> float:
        """Direction [degrees] for numbers, away from the load and between two balls."""
        away = -np.exp(1j * (0.5 * pi if self.load is None else self.load))
        gaps = np.exp(1j * (self.angles + pi / self.angles.size))
        return float(np.degrees(np.angle(gaps[np.argmax((gaps * np.conj(away)).real)])))

    @property
    def longest_beside(self) -> float:
        """Largest force of both balls beside `free_angle` [N]."""
        apart = np.abs(np.angle(np.exp(1j * (self.angles - np.radians(self.free_angle)))))
        beside = np.argsort(apart)[:2]
        return max(float(values[beside].max()) for _, values, *_ in self.forces)


AnyPanel = Panel | Map | LoadZone


@dataclass(frozen=True)
class Picture:
    """Panels in rows.

    Parameters
    ----------
    panels : sequence of Panel, Map or LoadZone
        Row by row.
    title : str
        Pages have a heading of their own, and leave it out.
    columns : int
        At most so many panels in a row.
    heights : sequence of float
        Of the rows, in px of a page; the last one holds for the rows after it.
    shared : bool
        Whether the panels of a column have one x axis, labelled under the last.
    note : str
        A sentence beside the picture.
    """

    panels: Sequence[AnyPanel]
    title: str = ""
    columns: int = 2
    heights: Sequence[float] = (270.0,)
    shared: bool = False
    note: str = ""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        columns = max(1, min(len(self.panels), self.columns))
        return max(1, -(-len(self.panels) // columns)), columns

    @property
    def row_heights(self) -> list[float]:
        """Height of every row."""
        return [self.heights[min(row, len(self.heights) - 1)] for row in range(self.shape[0])]


@dataclass(frozen=True)
class Slides:
    """Pictures that differ in their numbers only, with a slider through them; a file has the first one shown.

    Parameters
    ----------
    pictures : sequence of Picture
    label : (str, str)
        What the slider runs through, and its unit.
    values : sequence of float
    start : int
        Number of the picture that is shown first.
    runs : bool
        Whether a button runs through them.
    """

    pictures: Sequence[Picture]
    label: Label
    values: Sequence[float]
    start: int = 0
    runs: bool = False


def stiffness_and_damping(
    curves: Callable[[str], Iterable[Line]],
    frequency: Label,
    units: tuple[str, str] = ("N/m", "N s/m"),
    *,
    of: str = "",
    marks: Sequence[Mark] = (),
    logs: str = "xy",
    bottom: float | None = None,
) -> list[Panel]:
    """Panels of K and C over frequency, or over another axis.

    Parameters
    ----------
    curves : callable
        Lines for the name "stiffness" or "damping".
    frequency : label
    units : (str, str)
        Of stiffness and damping.
    of : str
        Word ahead of both, as "tilt".
    marks, logs, bottom
        As of `Panel`.
    """
    return [
        Panel(
            list(curves(name)),
            frequency,
            (f"{of} {name}".strip(), unit),
            logs=logs if name == "damping" else logs.replace("y", "").replace("Y", ""),
            marks=marks,
            bottom=bottom,
        )
        for name, unit in zip(("stiffness", "damping"), units, strict=True)
    ]


def far_apart(values: Array) -> bool:
    """Whether values are all > 0, and the largest of them is more than a decade above the smallest."""
    values = np.asarray(values)
    values = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    return bool(values.size and values.min() > 0.0 and values.max() > DECADE * values.min())


def in_unit(label: Label) -> tuple[str, float]:
    """Label with the unit of pictures, and what values have to be multiplied by for it."""
    if isinstance(label, str):
        return label, 1.0
    words, unit = label
    shown, factor = SHOWN.get(unit, (unit, 1.0))
    return (f"{words} [{shown}]".strip() if shown else words), factor


def _scaled(ends: Ends, factor: float) -> Ends:
    return ends[0] * factor, ends[1] * factor


def _times(ends: Ends | None, factor: float) -> Ends | None:
    return None if ends is None else _scaled(ends, factor)
