"""Tables over time: what a motion may be given by."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError


def as_table(name: str, T: ArrayLike, values: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return copies of both columns.

    Raises
    ------
    InputError
        No numbers, not finite, other lengths, fewer than 4, or times that do not increase from 0.
    """
    try:
        t, v = np.array(T, dtype=float), np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, "no numbers", "tables of numbers") from None
    if t.ndim != 1 or t.size < 4 or t.shape != v.shape:
        raise InputError(name, v.shape, "a 1-D table of at least 4 values, as many as T")
    if not (np.isfinite(t).all() and np.isfinite(v).all()):
        raise InputError(name, "NaN or infinity", "finite numbers")
    if t[0] != 0.0 or not (np.diff(t) > 0.0).all():
        raise InputError("T", t[0], "increasing and starting at 0")
    return t, v


class Tabulated:
    """Time span of a motion given by a table."""

    __slots__ = ()
    _table: tuple[NDArray[np.float64], NDArray[np.float64]]

    @property
    def default_end(self) -> float:
        """End of the table."""
        return float(self._table[0][-1])

    @property
    def default_step(self) -> float:
        """Mean spacing of the table."""
        return self.default_end / (len(self._table[0]) - 1)
