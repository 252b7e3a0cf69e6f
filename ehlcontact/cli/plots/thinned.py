"""Decimation of curves and digits for the report page, which stays a file of a few megabytes."""

from __future__ import annotations

from math import ceil, floor, log10
from typing import Any

import numpy as np

LINE = 1200  # points of a line: about one to a pixel of the widest page
FINENESS = 2e4  # steps of a number over the span of its axis, so that zooming in shows no stairs at once
DIGITS = 5  # significant, where the axis is logarithmic


def rounded(values: Any, *, logarithmic: bool = False, fineness: float = FINENESS) -> list[Any]:
    """Numbers for JSON, as short as the axis allows; what is not finite is None.

    Parameters
    ----------
    values : array, of one or two dimensions
    logarithmic : bool
        Keep significant digits, instead of a share of the span.
    fineness : float
        Steps over the span.
    """
    array = np.asarray(values, dtype=float)
    if array.ndim > 1:
        span = decimals_of(array, fineness)
        return [_texts(row, logarithmic, span) for row in array]
    return _texts(array, logarithmic, decimals_of(array, fineness))


def decimals_of(array: np.ndarray, fineness: float) -> int:
    """Decimals that resolve the span of an array so finely."""
    finite = array[np.isfinite(array)]
    span = float(np.ptp(finite)) if finite.size else 0.0
    span = span or float(np.abs(finite).max(initial=0.0))
    return ceil(log10(fineness / span)) if span > 0.0 else 0


def _texts(row: np.ndarray, logarithmic: bool, decimals: int) -> list[Any]:
    if logarithmic:
        return [float(f"{v:.{DIGITS}g}") if np.isfinite(v) else None for v in row.tolist()]
    found = [round(v, decimals) if np.isfinite(v) else None for v in row.tolist()]
    return [int(v) if v is not None and v == floor(v) and abs(v) < 1e15 else v for v in found]


def thin_line(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, str]:
    """A line of at most about `LINE` points, and what was left out, in words.

    Where x rises, the lowest and the highest of every stretch are kept, so that no peak is lost; a path in the
    plane keeps every so many-th point, and its last.
    """
    every = ceil(x.size / LINE)
    if every <= 1:
        return x, y, ""
    if not np.all(np.diff(x) >= 0.0):
        kept = np.unique(np.append(np.arange(0, x.size, every), x.size - 1))
        return x[kept], y[kept], f"paths: 1 in {every} points"
    stretch = 2 * every
    starts = range(0, x.size, stretch)
    ends = [start + pick(y[start : start + stretch]) for start in starts for pick in (np.argmin, np.argmax)]
    kept = np.unique([0, *ends, x.size - 1])
    return x[kept], y[kept], f"lines: of every {stretch} samples the lowest and the highest"
