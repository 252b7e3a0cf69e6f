"""Results as others take them: xarray with named dimensions, pandas with units in the heads, a figure.

A class says once what its quantities are (`Layout`), and has `to_xarray`, `to_pandas` and `plot`. xarray and
pandas are extras: ``pip install 'ehlcontact[tables]'``.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import prod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.results.picture import Map, Panel, draw
from ehlcontact.summary import Summary

Array = NDArray[Any]

TEXTS = {
    "X": "place along rolling",
    "Y": "place across",
    "x": "place along rolling",
    "y": "place across",
    "P": "pressure",
    "p": "pressure",
    "H": "film",
    "h": "film",
    "T": "time",
    "t": "time",
    "h_central": "film in the centre",
    "h_min": "smallest film",
    "p_max": "largest pressure",
    "approach": "mutual approach",
    "rate": "rate of approach",
    "force": "contact force",
    "load": "applied load",
    "Omega": "angular frequency",
    "omega": "angular frequency",
    "hz": "frequency",
    "film_share": "what the film takes of a dry approach",
    "moment": "rolling resistance",
    "h_midplane": "film along the middle",
    "p_midplane": "pressure along the middle",
    "speed_rpm": "speed",
    "lambda_ratio": "smallest film over roughness",
    "major": "half axis of the orbit",
    "angles": "angle of the ball",
}


@dataclass(frozen=True)
class Layout:
    """What the quantities of a class are.

    Parameters
    ----------
    rows : str
        Dimensions of the rows of `to_pandas`.
    panels : tuple of str
        Of the figure: names that share axes.
    quantities : mapping of str to (str, str)
        Unit and dimensions by name, in the order of tables; one that is called like its only dimension is its
        coordinate, and so is one in `coordinates`.
    labels : mapping of str to tuple of str
        Of dimensions that have no coordinate; by default they count from `first`.
    coordinates : str
        Further quantities over one dimension that tell where one is; figures have the last of them.
    logs : str
        "x", "y" or both: axes of the figure that are logarithmic where their values are far apart.
    first : int
        From which dimensions without labels count.
    """

    rows: str
    panels: tuple[str, ...]
    quantities: Mapping[str, tuple[str, str]]
    labels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    coordinates: str = ""
    logs: str = ""
    first: int = 1

    def unit(self, name: str) -> str:
        """Of a quantity, "" where it has none."""
        return self.quantities[name][0]

    def dims(self, name: str) -> tuple[str, ...]:
        """Dimensions of a quantity."""
        return tuple(self.quantities[name][1].split())

    def is_coordinate(self, name: str) -> bool:
        """Whether a quantity tells where one is."""
        return self.dims(name) == (name,) or name in self.coordinates.split()

    def coordinate(self, dim: str) -> str | None:
        """Quantity that a figure has along a dimension, the last of several."""
        found = [n for n in self.quantities if self.is_coordinate(n) and self.dims(n) == (dim,)]
        return found[-1] if found else None

    def head(self, name: str, of: str = "") -> str:
        """Head of a column: name and unit."""
        unit = self.unit(name)
        return f"{name}{of} [{unit}]" if unit else f"{name}{of}"


class Tabled:
    """Base of results that say what their quantities are in `LAYOUT`."""

    __slots__ = ()
    LAYOUT: ClassVar[Layout]

    def _layout(self) -> Layout:
        return self.LAYOUT

    def _drawn(self) -> Any:
        """What a figure shows: the view in SI, where there is one."""
        return self.si if getattr(self, "scales", None) is not None and hasattr(self, "si") else self

    def to_xarray(self) -> Any:
        """``xarray.Dataset`` of everything: dimensions and coordinates named, ``units`` and ``long_name`` of each.

        Raises
        ------
        InputError
            xarray is not installed.
        """
        try:
            import xarray
        except ImportError as error:
            raise _missing("xarray", error) from None
        layout = self._layout()
        at: dict[str, Any] = {
            dim: ((dim,), np.array(_labels(layout, dim, size)))
            for dim, size in self._sizes().items()
            if dim not in layout.quantities and dim in layout.labels
        }
        values: dict[str, Any] = {}
        for name, base, array in self._quantities():
            where = at if name == base and layout.is_coordinate(name) else values
            where[name] = (layout.dims(base), array, _attributes(layout, base))
        return xarray.Dataset(values, coords=at, attrs=self._about())

    def to_pandas(self) -> Any:
        """``pandas.DataFrame``, a row for each step, frequency or node; units are in the heads of the columns.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        pandas = _pandas()
        layout, sizes = self._layout(), self._sizes()
        rows = layout.rows.split()
        at = [self._along(dim, sizes) for dim in rows]
        names = [layout.head(dim) if dim in layout.quantities else dim for dim in rows]
        index = (
            pandas.Index(at[0], name=names[0])
            if len(rows) == 1
            else pandas.MultiIndex.from_product(at, names=names)
        )
        columns: dict[str, Array] = {}
        for name, base, array in self._quantities():
            if name not in rows:
                columns |= _columns(layout, (name, base, array), rows, sizes)
        frame = pandas.DataFrame(columns, index=index)
        frame.attrs.update(self._about())
        return frame

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure, in SI where the point is; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        shown = self._drawn()
        return draw(self._title(), list(shown._panels()), path)

    def _title(self) -> str:
        """Name of the class, and the first line of its summary where it has one of its own."""
        own = getattr(type(self), "_summary_lines", Summary._summary_lines) is not Summary._summary_lines
        return f"{type(self).__name__}: {self._summary_lines()[0]}" if own else type(self).__name__  # type: ignore[attr-defined]

    def _quantities(self) -> Iterator[tuple[str, str, Array]]:
        """Name, name of the quantity that it is (another for error bars) and values, of all that are there."""
        bars = getattr(self, "error_bars", None)
        for name in self._layout().quantities:
            if getattr(self, name) is None:
                continue
            yield name, name, self._values(name)
            if isinstance(bars, Mapping) and name in bars:
                yield f"{name}_error", name, np.asarray(bars[name])

    def _values(self, name: str) -> Array:
        """A quantity as an array of its dimensions: what has one of them, in a row."""
        array = np.asarray(getattr(self, name))
        return array.ravel() if len(self._layout().dims(name)) == 1 else array

    def _sizes(self) -> dict[str, int]:
        layout, found = self._layout(), dict[str, int]()
        for _, base, array in self._quantities():
            found.update(zip(layout.dims(base), array.shape, strict=True))
        return found

    def _along(self, dim: str, sizes: Mapping[str, int]) -> Array:
        """Values of the rows along a dimension."""
        name = dim if dim in self._layout().quantities else None
        return self._values(name) if name else np.array(_labels(self._layout(), dim, sizes[dim]))

    def _about(self) -> dict[str, Any]:
        """Where it is from, in plain numbers and words."""
        found: dict[str, Any] = {"result": type(self).__name__}
        point = getattr(self, "point", None)
        found |= {} if point is None else point.to_dict()
        for name in ("n", "version", "status", "name", "units"):
            value = getattr(self, name, None)
            if value is not None and value != "":
                found[name] = value if isinstance(value, int) else str(value)
        return found

    def _panels(self) -> Iterator[Panel | Map]:
        """Of the figure; those of quantities that are not there are left out."""
        layout, bars, sizes = self._layout(), getattr(self, "error_bars", None), self._sizes()
        for group in layout.panels:
            names = [name for name in group.split() if getattr(self, name) is not None]
            if not names:
                continue
            dim, *rest = layout.dims(names[0])
            along = layout.coordinate(dim)
            place = self._values(along) if along else layout.first + np.arange(sizes[dim])
            x = (place, _axis(layout, along) if along else dim)
            if len(rest) == 1 and rest[0] not in layout.labels and sizes[rest[0]] > 1:
                across = layout.coordinate(rest[0])
                for name in names:
                    y = (
                        (getattr(self, across), _axis(layout, across))
                        if across
                        else (np.arange(sizes[rest[0]]), rest[0])
                    )
                    yield Map(x, y, (self._values(name), _axis(layout, name)))
                continue
            lines = []
            for name in names:
                bar = bars.get(name) if isinstance(bars, Mapping) else None
                array = self._values(name).reshape(sizes[dim], -1)
                words = _texts(name) if len(names) > 1 else ""
                for k, of in enumerate(_pairs(layout, rest, sizes)):
                    lines.append((f"{words} {of}".strip(), array[:, k], None if bar is None else np.asarray(bar)))
            label = _axis(layout, names[0]) if len(names) == 1 else _shared(layout, names)
            yield Panel(x, lines, label, layout.logs)


def frame_of(rows: list[dict[str, Any]], index: str, about: Mapping[str, Any]) -> Any:
    """``pandas.DataFrame`` of rows, an entry their index; raises `InputError` where pandas is missing."""
    frame = _pandas().DataFrame(rows).set_index(index)
    frame.attrs.update({name: value for name, value in about.items() if value is not None})
    return frame


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise _missing("pandas", error) from None
    return pandas


def _missing(name: str, error: ImportError) -> InputError:
    return InputError(name, None, f"installed: pip install 'ehlcontact[tables]' ({error})")


def _attributes(layout: Layout, name: str) -> dict[str, str]:
    return {"units": layout.unit(name) or "1", "long_name": _texts(name)}


def _texts(name: str) -> str:
    return TEXTS.get(name, name.replace("_", " "))


def _axis(layout: Layout, name: str) -> tuple[str, str]:
    """Words and unit of an axis."""
    return _texts(name), layout.unit(name)


def _shared(layout: Layout, names: list[str]) -> tuple[str, str]:
    """Words and unit of an axis that several quantities share; the legend has their names."""
    units = {layout.unit(name) for name in names}
    return "", units.pop() if len(units) == 1 else ""


def _labels(layout: Layout, dim: str, size: int) -> list[str]:
    return list(layout.labels.get(dim, map(str, range(layout.first, layout.first + size))))


def _pairs(layout: Layout, dims: list[str], sizes: Mapping[str, int]) -> list[str]:
    """Names of what lies in further dimensions, one after another: "xx", "xy", ..."""
    found = [""]
    for dim in dims:
        labels = _labels(layout, dim, sizes[dim])
        separate = " " if max(map(len, labels)) > 1 else ""
        found = [f"{one}{separate}{label}".strip() for one in found for label in labels]
    return found


def _columns(
    layout: Layout, quantity: tuple[str, str, Array], rows: list[str], sizes: Mapping[str, int]
) -> dict[str, Array]:
    """Columns of one quantity over the rows; none of one that does not go along them, or is a field over them."""
    name, base, array = quantity
    dims = layout.dims(base)
    rest = [dim for dim in dims if dim not in rows]
    if not set(dims) & set(rows) or any(layout.coordinate(dim) for dim in rest):
        return {}
    order = [dims.index(dim) for dim in rows if dim in dims] + [dims.index(dim) for dim in rest]
    moved = array.transpose(order)
    ahead = tuple(sizes[dim] if dim in dims else 1 for dim in rows)
    shape = tuple(sizes[dim] for dim in rest)
    full = np.broadcast_to(moved.reshape(*ahead, *shape), (*(sizes[dim] for dim in rows), *shape))
    flat = full.reshape(prod(sizes[dim] for dim in rows), -1)
    unit = layout.unit(base)
    heads = [f"{name}{of and '_' + of.replace(' ', '_')}" for of in _pairs(layout, rest, sizes)]
    return {f"{head} [{unit}]" if unit else head: flat[:, k].copy() for k, head in enumerate(heads)}
