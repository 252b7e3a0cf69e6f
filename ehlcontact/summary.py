"""Summary of an object for the prompt and notebooks: a few lines without arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from html import escape
from textwrap import fill, shorten
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

# How summaries show quantities in SI: the first unit that is not above the value, the last one below all of them
SHOWN: Mapping[str, tuple[tuple[float, str], ...]] = {
    "m": ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")),
    "s": ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")),
    "1/Pa": ((1e-9, "1/GPa"),),
    "Pa s": ((1.0, "Pa s"), (1e-3, "mPa s")),
    "N/m": ((1e6, "N/µm"), (1.0, "N/m")),
    "kg m": ((1e-3, "kg m"), (1e-6, "g mm")),
    "degrees Celsius": ((1.0, "°C"),),
}

LINES, WIDTH = 5, 90  # most lines of a summary, and characters of a line
NOTE = 116  # characters of a line of words


class Summary:
    """Base of classes with a summary: `_summary_lines` returns its lines, the first stands beside the name."""

    __slots__ = ()
    FIELD_UNITS: ClassVar[Mapping[str, str]] = {}  # of the numbers among the fields; `fields_take` adds its own

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.__repr__ = Summary.__repr__  # type: ignore[method-assign]  # in the class itself: a dataclass leaves it

    def _summary_lines(self) -> Sequence[str]:
        """Lines of the summary, five at most: by default the fields that are given, with their units."""
        return wrapped(entries_of(self))

    def _summary_name(self) -> str:
        """What the summary opens with."""
        return type(self).__name__

    def __repr__(self) -> str:
        first, *others = self._summary_lines()
        return "\n".join([f"{self._summary_name()}: {first}", *(f"  {line}" for line in others)])

    def _repr_html_(self) -> str:
        """The summary as HTML, for a notebook."""
        first, *others = (escape(line) for line in self._summary_lines())
        return "<br>".join([f"<strong>{self._summary_name()}</strong>: {first}", *others])


def entries_of(thing: Any) -> list[str]:
    """Fields of a data class that are given, as "name value unit"."""
    units, texts = thing.FIELD_UNITS, []
    for name in (one.name for one in fields(thing) if one.repr):
        value = getattr(thing, name)
        if value is None or value is False or (isinstance(value, Sequence) and not value):
            continue
        texts.append(f"{name} {entry_text(value, units.get(name, ''))}".rstrip())
    return texts


def entry_text(value: Any, unit: str = "") -> str:
    """A number, a table of numbers by its range, or another object, in words."""
    if isinstance(value, str):
        return value
    if value is True:
        return ""
    try:
        return quantity_text(np.asarray(value, float), unit)
    except (TypeError, ValueError):
        return " ".join(repr(value).split())


def quantity_text(values: ArrayLike, unit: str = "") -> str:
    """A quantity in SI, or the range of a table of it, with a unit in which it is easily read."""
    array = np.asarray(values, float)
    size = float(np.abs(array[np.isfinite(array)]).max(initial=0.0))
    choices = SHOWN.get(unit, ((1.0, unit),)) if size > 0.0 else ((1.0, unit),)
    factor, shown = next((one for one in choices if size >= one[0] * (1.0 - 1e-9)), choices[-1])
    return span(array, 1.0 / factor, shown)


def wrapped(texts: Sequence[str]) -> list[str]:
    """Entries of a summary in lines, separated by commas."""
    text = fill(", ".join(texts), WIDTH, max_lines=LINES, placeholder=" ...", break_long_words=False)
    return text.splitlines() or [""]


def contact_text(point: Any) -> str:
    """Contact in words: of an `OperatingPoint` load, speed and Hertz pressure; then its Moes numbers and kappa."""
    moes = point.moes
    text = f"M {moes.M:.4g}, L {moes.L:.4g}, kappa {moes.kappa:.4g}"
    if not hasattr(point, "u_sum"):
        return text
    return f"{point.load:.4g} N, u_sum {point.u_sum:.4g} m/s, {point.scales.pressure * 1e-9:.3g} GPa; {text}"


def counted(number: int, one: str, many: str = "") -> str:
    """A number of things in words: "1 frequency", "2 frequencies"; by default the plural ends in s."""
    return f"{number} {one if number == 1 else many or f'{one}s'}"


def film_unit(point: Any) -> tuple[float, str]:
    """Factor of films at a point for summaries, and its unit: micrometres, or dry approaches without a unit."""
    return (1e6, "µm") if hasattr(point, "load") else (1.0, "of the dry approach")


def note_line(text: str) -> list[str]:
    """A note as the last line of a summary, its end left out where it is long; no line where it is empty."""
    return [shorten(text, NOTE, placeholder=" ...")] if text else []


def span(values: ArrayLike, factor: float = 1.0, unit: str = "") -> str:
    """Range of values as text: smallest and largest, or one number where they are equal."""
    array = np.asarray(values, float)
    array = array[np.isfinite(array)] * factor
    if not array.size:
        return "none"
    low, high = (f"{value:.4g}" for value in (array.min(), array.max()))
    return f"{low if low == high else f'{low} .. {high}'} {unit}".rstrip()
