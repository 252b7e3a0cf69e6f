"""Summary of an object for the prompt and notebooks: a few lines without arrays."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from textwrap import shorten
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ehlcontact.point import MoesPoint, Point

LINES, WIDTH = 5, 90  # most lines of a summary, and characters of a line
NOTE = 116  # characters of a line of words


class Summary:
    """Base of classes with a summary: `_summary_lines` returns its lines, the first stands beside the name."""

    __slots__ = ()

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.__repr__ = Summary.__repr__  # type: ignore[method-assign]  # in the class itself: a dataclass leaves it

    def _summary_lines(self) -> Sequence[str]:
        """Lines of the summary, five at most."""
        raise NotImplementedError

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


def contact_text(point: Point) -> str:
    """Contact in words: of an `OperatingPoint` load, speed and Hertz pressure; then its Moes numbers and kappa."""
    moes = point.moes
    text = f"M {moes.M:.4g}, L {moes.L:.4g}, kappa {moes.kappa:.4g}"
    if isinstance(point, MoesPoint):
        return text
    return f"{point.load:.4g} N, u_sum {point.u_sum:.4g} m/s, {point.scales.pressure * 1e-9:.3g} GPa; {text}"


def counted(number: int, one: str, many: str = "") -> str:
    """A number of things in words: "1 frequency", "2 frequencies"; by default the plural ends in s."""
    return f"{number} {one if number == 1 else many or f'{one}s'}"


def film_unit(point: Point) -> tuple[float, str]:
    """Factor of films at a point for summaries, and its unit: micrometres, or dry approaches without a unit."""
    return (1.0, "of the dry approach") if isinstance(point, MoesPoint) else (1e6, "µm")


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
