"""Results as tables of quantities: SI values, dictionary, xarray, pandas and a figure from the declarations.

A class declares its quantities in annotations (`ehlcontact.quantities`), and in `DISPLAY` what rows and figures
have. xarray and pandas are extras: ``pip install 'ehlcontact[tables]'``.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from enum import Enum
from math import prod
from textwrap import fill
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, OperatingPoint, Point, moes_point
from ehlcontact.quantities import (
    Quantity,
    quantities_of,
    scaled,
    words,
)
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Map, Panel, Picture
from ehlcontact.summary import LINES, WIDTH, Summary, contact_text, quantity_text

Array = NDArray[Any]

ERRORS = "error_estimate", "error_bars", "film_error"  # attributes that hold errors of quantities, in their units


@dataclass(frozen=True)
class Display:
    """Rows of a table and panels of a figure.

    Parameters
    ----------
    rows : str
        Dimensions of the rows of `to_pandas`; without any it has one row.
    panels : tuple of str
        Of the figure: names of quantities that share axes.
    labels : mapping of str to tuple of str
        Of dimensions that have no coordinate; by default they count from `first`.
    coordinates : str
        Quantities over one dimension that are coordinates beside one named like it; figures have the last of them.
    logs : str
        "x", "y" or both: axes of the figure that are logarithmic where their values are far apart.
    first : int
        From which dimensions without labels count.
    """

    rows: str
    panels: tuple[str, ...] = ()
    labels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    coordinates: str = ""
    logs: str = ""
    first: int = 1


class QuantityTable(Summary):
    """Base of results: their quantities as dictionary, xarray, pandas and figure."""

    __slots__ = ()
    DISPLAY: ClassVar[Display]
    UNITS: ClassVar[str] = "SI"  # or "dimensionless": of the values

    def to_dict(self) -> dict[str, Any]:
        """Listed quantities, and the errors of some of them, ready for JSON."""
        declared = self._declared().items()
        found = {name: plain(getattr(self, name)) for name, quantity in declared if quantity.listed}
        return found | {name: plain(getattr(self, name)) for name in ERRORS if hasattr(self, name)}

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
        declared, labels = self._declared(), self._display().labels
        at: dict[str, Any] = {
            dim: ((dim,), np.array(self._labels(dim, size)))
            for dim, size in self._sizes().items()
            if dim not in declared and dim in labels
        }
        values: dict[str, Any] = {}
        for name, base, array in self._columns():
            where = at if name == base and self._is_coordinate(name) else values
            attributes = {"units": self._unit(base) or "1", "long_name": words(base)}
            where[name] = (declared[base].dims, array, attributes)
        return xarray.Dataset(values, coords=at, attrs=self._about())

    def to_pandas(self) -> Any:
        """``pandas.DataFrame``, a row for each step, frequency or node; units are in the heads of the columns.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        pandas, sizes = _pandas(), self._sizes()
        rows = self._display().rows.split()
        at = [self._along(dim, sizes) for dim in rows]
        names = [self._head(dim) if dim in self._declared() else dim for dim in rows]
        if len(rows) > 1:
            index = pandas.MultiIndex.from_product(at, names=names)
        else:
            index = pandas.Index(at[0], name=names[0]) if rows else [0]
        columns: dict[str, Array] = {}
        for name, base, array in self._columns():
            if name not in rows:
                columns |= self._over_rows(name, base, array, sizes)
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
        return draw(self.picture(), path)

    def picture(self) -> Picture:
        """What that figure shows, as data."""
        return Picture(self.panels(), self._title())

    def axis(self, name: str) -> tuple[Array, tuple[str, str]]:
        """Values of a quantity, and words and unit of their axis in figures."""
        return np.asarray(getattr(self, name)), self._axis(name)

    def units_by_name(self) -> dict[str, str]:
        """Unit of every quantity by its name."""
        return {name: self._unit(name) for name in self._declared()}

    def panels(self) -> list[Any]:
        """Panels of that figure, for a `Picture` of several results."""
        return list(self._panels())

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless the arrays of fields fit the dimensions, of given `sizes`, and each other."""
        for name in [f.name for f in fields(self) if f.name in self._quantities()]:  # type: ignore[arg-type]
            dims, shape = self._quantities()[name].dims, np.shape(getattr(self, name))
            if getattr(self, name) is not None and len(shape) != len(dims):
                raise ValueError(f"{name} has the shape {shape}, not {len(dims)} dimensions")
            for dim, size in zip(dims, shape, strict=False):
                if sizes.setdefault(dim, size) != size:
                    raise ValueError(f"{name} has {size} values along {dim}, not {sizes[dim]}")

    def _quantities(self) -> Mapping[str, Quantity]:
        """Declared quantities by name, with those that only SI has."""
        return quantities_of(type(self))

    def _declared(self) -> Mapping[str, Quantity]:
        """Quantities of tables and figures by name."""
        si = self._in_si()
        return {name: one for name, one in self._quantities().items() if si or not one.only_si}

    def _display(self) -> Display:
        return self.DISPLAY

    def _in_si(self) -> bool:
        """Whether values are in SI."""
        return self.UNITS == "SI"

    def _summary_lines(self) -> list[str]:
        """Numbers with their units, and shapes of arrays."""
        numbers, arrays = [], []
        for name, base, array in self._columns():
            if array.ndim:
                arrays.append(f"{name} [{'x'.join(map(str, array.shape))}]")
            else:
                numbers.append(f"{name} {array:.5g} {self._unit(base)}".rstrip())
        text = fill(", ".join([*numbers, *arrays]), WIDTH, max_lines=LINES, placeholder=" ...")
        return text.splitlines() or [""]

    def _amount(self, name: str) -> str:
        """A quantity, or its range, with its unit."""
        return quantity_text(getattr(self, name), self._unit(name))

    def _title(self) -> str:
        """Name of the class, and the first line of its summary where it has one of its own."""
        own = type(self)._summary_lines is not QuantityTable._summary_lines
        return f"{self._summary_name()}: {self._summary_lines()[0]}" if own else self._summary_name()

    def _about(self) -> dict[str, Any]:
        """Origin in plain numbers and words: attributes of tables."""
        found: dict[str, Any] = {"result": type(self).__name__}
        point = getattr(self, "point", None)
        found |= {} if point is None else point.to_dict()
        for name in ("n", "version", "status", "name", "units"):
            value = getattr(self, name, None)
            if value is not None and value != "":
                found[name] = value if isinstance(value, int) else str(value)
        return found

    def _unit(self, name: str) -> str:
        quantity = self._declared()[name]
        return quantity.unit if self._in_si() else quantity.moes

    def _head(self, name: str, of: str = "", base: str = "") -> str:
        """Head of a column: name and unit."""
        unit = self._unit(base or name)
        return f"{name}{of} [{unit}]" if unit else f"{name}{of}"

    def _axis(self, name: str) -> tuple[str, str]:
        """Words and unit of an axis."""
        return words(name), self._unit(name)

    def _is_coordinate(self, name: str) -> bool:
        return self._declared()[name].dims == (name,) or name in self._display().coordinates.split()

    def _coordinate(self, dim: str) -> str | None:
        """Quantity that a figure has along a dimension, the last of several."""
        found = [n for n, one in self._declared().items() if one.dims == (dim,) and self._is_coordinate(n)]
        return found[-1] if found else None

    def _columns(self) -> Iterator[tuple[str, str, Array]]:
        """Name, name of the quantity (another for error bars) and values, of all that are not None."""
        bars = getattr(self, "error_bars", None)
        for name in self._declared():
            if getattr(self, name) is None:
                continue
            yield name, name, self._values(name)
            if isinstance(bars, Mapping) and name in bars:
                yield f"{name}_error", name, np.asarray(bars[name])

    def _values(self, name: str) -> Array:
        """A quantity as an array over its dimensions; what has one of them, in a row."""
        array = np.asarray(getattr(self, name))
        return array.ravel() if len(self._declared()[name].dims) == 1 else array

    def _sizes(self) -> dict[str, int]:
        declared, found = self._declared(), dict[str, int]()
        for _, base, array in self._columns():
            found.update(zip(declared[base].dims, array.shape, strict=True))
        return found

    def _labels(self, dim: str, size: int) -> list[str]:
        display = self._display()
        return list(display.labels.get(dim, map(str, range(display.first, display.first + size))))

    def _along(self, dim: str, sizes: Mapping[str, int]) -> Array:
        """Values of the rows along a dimension."""
        return self._values(dim) if dim in self._declared() else np.array(self._labels(dim, sizes[dim]))

    def _pairs(self, dims: Iterable[str], sizes: Mapping[str, int]) -> list[str]:
        """Names of the entries over further dimensions, one after another: "xx", "xy", ..."""
        found = [""]
        for dim in dims:
            labels = self._labels(dim, sizes[dim])
            separate = " " if max(map(len, labels)) > 1 else ""
            found = [f"{one}{separate}{label}".strip() for one in found for label in labels]
        return found

    def _over_rows(self, name: str, base: str, array: Array, sizes: Mapping[str, int]) -> dict[str, Array]:
        """Columns of one quantity over the rows; none where it is not over them, or is a field over them."""
        rows, dims = self._display().rows.split(), self._declared()[base].dims
        rest = [dim for dim in dims if dim not in rows]
        if bool(rows) != bool(set(dims) & set(rows)) or any(self._coordinate(dim) for dim in rest):
            return {}
        order = [dims.index(dim) for dim in rows if dim in dims] + [dims.index(dim) for dim in rest]
        moved = array.transpose(order)
        ahead = tuple(sizes[dim] if dim in dims else 1 for dim in rows)
        shape = tuple(sizes[dim] for dim in rest)
        full = np.broadcast_to(moved.reshape((*ahead, *shape)), (*(sizes[dim] for dim in rows), *shape))
        flat = full.reshape(prod(sizes[dim] for dim in rows), -1)
        names = [of and f"_{of.replace(' ', '_')}" for of in self._pairs(rest, sizes)]
        return {self._head(name, of, base): flat[:, k].copy() for k, of in enumerate(names)}

    def _panels(self) -> Iterator[Panel | Map]:
        """Of the figure; those of quantities that are None are left out."""
        display, sizes = self._display(), self._sizes()
        for group in display.panels:
            names = [name for name in group.split() if getattr(self, name) is not None]
            if not names:
                continue
            dim, *rest = self._declared()[names[0]].dims
            along = self._coordinate(dim)
            place = self._values(along) if along else display.first + np.arange(sizes[dim])
            label = self._axis(along) if along else dim
            if len(rest) == 1 and rest[0] not in display.labels and sizes[rest[0]] > 1:
                across = self._coordinate(rest[0])
                y = (getattr(self, across), self._axis(across)) if across else (np.arange(sizes[rest[0]]), rest[0])
                yield from (Map((place, label), y, (self._values(name), self._axis(name))) for name in names)
            else:
                lines = list(self._lines(place, names, rest, sizes))
                yield Panel(lines, label, self._shared(names), logs=display.logs)

    def _lines(self, place: Array, names: list[str], rest: list[str], sizes: Mapping[str, int]) -> Iterator[Line]:
        """Lines of a panel over their place, with half widths of error bars."""
        bars = getattr(self, "error_bars", None)
        for name in names:
            bar = bars.get(name) if isinstance(bars, Mapping) else None
            pairs = self._pairs(rest, sizes)
            array = self._values(name).reshape(-1, len(pairs))
            text = words(name) if len(names) > 1 else ""
            for k, of in enumerate(pairs):
                half = None if bar is None else np.asarray(bar)
                yield Line(place, array[:, k], f"{text} {of}".strip(), bars=half)

    def _shared(self, names: list[str]) -> tuple[str, str]:
        """Words and unit of an axis; no words where several quantities share it: the legend has them."""
        units = {self._unit(name) for name in names}
        return words(names[0]) if len(names) == 1 else "", units.pop() if len(units) == 1 else ""


class PointTable(QuantityTable):
    """Base of results at a point, in its units: SI of an `OperatingPoint`, Moes units of a `MoesPoint`."""

    __slots__ = ()
    if TYPE_CHECKING:
        # A dataclass with fields, of which `point` is the one that all have
        __dataclass_fields__: ClassVar[dict[str, Any]]

        @property
        def point(self) -> Point:
            """The contact."""

    def in_units_of(self, point: Point) -> Self:
        """The result in the units of a point: in SI at the `OperatingPoint` that has the Moes numbers of its own.

        Raises
        ------
        InputError
            The point is another one.
        """
        moes = moes_point(point)
        if moes != self.point.moes:
            raise InputError("point", contact_text(moes), f"that of the result, {contact_text(self.point.moes)}")
        if point == self.point:
            return self
        own = self.dimensionless
        if moes is point:
            return own
        inner = {name: one.in_units_of(point) for name, one in own._inner().items()}
        return replace(own, point=point, **scaled(own, point.scales), **inner)

    @property
    def dimensionless(self) -> Self:
        """The result in Moes units, at the `MoesPoint` of its point."""
        if isinstance(self.point, MoesPoint):
            return self
        changes: dict[str, Any] = scaled(self, self.point.scales, back=True)
        changes |= {name: one.dimensionless for name, one in self._inner().items()}
        return replace(self, point=self.point.moes, **changes)

    def _inner(self) -> dict[str, PointTable]:
        """Results at the point that this one holds, by the names of their fields."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return {name: value for name, value in values.items() if isinstance(value, PointTable)}

    def _in_si(self) -> bool:
        return isinstance(self.point, OperatingPoint)

    def _about(self) -> dict[str, Any]:
        return {**super()._about(), "units": "SI" if self._in_si() else "Moes"}


def plain(value: Any) -> Any:
    """`value` as JSON has it: arrays as lists, dataclasses as dictionaries."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Enum):
        return str(value)
    if is_dataclass(value) and not isinstance(value, type):
        return plain(asdict(value))
    if isinstance(value, Mapping):
        return {name: plain(one) for name, one in value.items()}
    return [plain(one) for one in value] if isinstance(value, list | tuple) else value


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
