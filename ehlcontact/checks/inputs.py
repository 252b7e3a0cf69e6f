"""Checks of numbers, arrays and choices: each returns the plain value, or raises one line that names the input."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from decimal import Decimal
from numbers import Integral, Real
from types import UnionType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError

Array = NDArray[np.float64]

MASKED, TEXT = type(np.ma.masked), (str, bytes, bytearray)


def shown(value: Any) -> Any:
    """What a message shows of a value of another kind: short ones, of others the class."""
    if value is None or isinstance(value, bool | int | float | str | bytes):
        return value
    if isinstance(value, Sequence | Mapping) and not value:
        return value
    return type(value).__name__


def is_quantity(value: object) -> bool:
    """Whether `value` brings a unit of its own."""
    return hasattr(value, "m_as") or (hasattr(value, "to_base_units") and hasattr(value, "magnitude"))


def has_quantity(value: object) -> bool:
    """Whether `value` is one, or holds one anywhere: a list, an array of objects."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind == "O" and any(map(has_quantity, value.flat))
    if not isinstance(value, list | tuple):
        return is_quantity(value)
    plain = {kind for kind in set(map(type, value)) if kind in (float, int, str)}  # most lists hold nothing else
    return any(has_quantity(one) for one in value if type(one) not in plain)


def require_flag(field: str, value: object) -> bool:
    """Return `value` as a bool, or raise `InputError`: 0 and "no" would be taken for what they are not."""
    if not isinstance(value, bool | np.bool_):
        raise InputError(field, value, "True or False")
    return bool(value)


def require_positive(field: str, value: object) -> float:
    """Return `value` as a float, or raise `InputError` unless it is finite and > 0."""
    number = require_number(field, value, "a finite number > 0")
    if not (math.isfinite(number) and number > 0.0):
        raise InputError(field, number, "a finite number > 0")
    return number


def require_nonnegative(field: str, value: object) -> float:
    """Return `value` as a float, or raise `InputError` unless it is finite and >= 0."""
    number = require_number(field, value, "a finite number >= 0")
    if not (math.isfinite(number) and number >= 0.0):
        raise InputError(field, number, "a finite number >= 0")
    return number


def require_finite(field: str, value: object) -> float:
    """Return `value` as a float, or raise `InputError` unless it is finite."""
    number = require_number(field, value, "a finite number")
    if not math.isfinite(number):
        raise InputError(field, number, "a finite number")
    return number


def as_float(field: str, value: object) -> float:
    """Return `value` as a float, which may be infinite or not a number, or raise `InputError` unless it is one.

    For calls within a time step: a float costs 0.1 us.
    """
    return value if type(value) is float else require_number(field, value, "a number")


def require_between(field: str, value: object, low: float, high: float) -> float:
    """Return `value` as a float, or raise `InputError` unless it is a number from `low` to `high`."""
    number = require_number(field, value, f"a number between {low:g} and {high:g}")
    if not low <= number <= high:
        raise InputError(field, number, f"between {low:g} and {high:g}")
    return number


def require_integer(field: str, value: object, allowed: str, lowest: int) -> int:
    """Return `value` as an int, or raise `InputError` unless it is a whole number of at least `lowest`."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < lowest:
        raise InputError(field, value, allowed)
    return int(value)


def require_choice(field: str, value: object, choices: tuple[str, ...]) -> str:
    """Return `value`, or raise `InputError` unless it is one of `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise InputError(field, value, "one of " + ", ".join(choices))
    return value


def require_no_others(entries: Collection[str], known: Collection[str], before: str = "") -> None:
    """Raise `InputError` for a name of `entries` that is not in `known`; messages have `before` in front."""
    for name in entries:
        if name not in known:
            raise InputError(f"{before}{name}", "an unknown name", f"left out; known are {', '.join(known)}")


def require_names(entries: Collection[str], known: Collection[str], before: str = "") -> None:
    """Raise `InputError` unless the names of `entries` are those in `known`; messages have `before` in front."""
    require_no_others(entries, known, before)
    for name in known:
        if name not in entries:
            raise InputError(f"{before}{name}", None, "there")


def require_instance(field: str, value: object, kinds: type | UnionType, allowed: str) -> None:
    """Raise `InputError` unless `value` is an instance of `kinds`; `allowed` names them."""
    if not isinstance(value, kinds):
        raise InputError(field, shown(value), allowed)


def as_column(
    field: str, values: ArrayLike, *, least: int = 1, size: int | None = None, increasing: bool = False
) -> Array:
    """Return `values` as a new read-only array of finite numbers, shape (k,).

    Parameters
    ----------
    field : str
        Its name in messages.
    values : array_like
    least : int
        Smallest length.
    size : int, optional
        Length it must have.
    increasing : bool
        Whether each value must lie above the one before.

    Raises
    ------
    InputError
        Anything else; where one entry is to blame, the message names it by its number.
    """
    array = as_numbers(field, values, "a one-dimensional array of numbers")
    if array.ndim != 1:
        raise InputError(f"shape of {field}", array.shape, "one-dimensional")
    if array.size < least:
        raise InputError(f"length of {field}", array.size, f"at least {least}")
    if size is not None and array.size != size:
        raise InputError(f"length of {field}", array.size, str(size))
    _require_finite_entries(field, array)
    falls = np.diff(array) <= 0.0
    if increasing and falls.any():
        at = int(np.argmax(falls)) + 1
        raise InputError(f"{field}[{at}]", float(array[at]), f"above {field}[{at - 1}] = {float(array[at - 1])!r}")
    array.setflags(write=False)
    return array


def as_rows(field: str, values: ArrayLike, rows: int, least: int) -> Array:
    """Return `values` as a new read-only array of finite numbers, shape (`rows`, k) with k >= `least`.

    Raises
    ------
    InputError
        Anything else.
    """
    array = as_numbers(field, values, "rows of numbers, all of one length")
    if array.ndim != 2 or array.shape[0] != rows or array.shape[1] < least:
        raise InputError(f"shape of {field}", array.shape, f"({rows}, {least} or more)")
    _require_finite_entries(field, array)
    array.setflags(write=False)
    return array


def as_numbers(field: str, values: ArrayLike, allowed: str = "numbers") -> Array:
    """Return `values` as a new array of any shape, of numbers that may be infinite or not a number.

    Raises
    ------
    InputError
        Text, which numpy would read; True and False; masked entries; quantities with a unit; anything else that is
        no number. The message has `allowed`.
    """
    if values is None:
        raise InputError(field, None, "given")
    if has_quantity(values):  # numpy would drop its unit, whatever it is
        raise InputError(field, type(values).__name__, f"{allowed}, which takes no quantity with a unit here")
    if np.ma.is_masked(values):  # numpy would take what is behind the mask
        raise InputError(field, "a masked array", f"{allowed}, without a masked one")
    try:
        if _all_numbers(values):
            return np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    raise InputError(field, shown(values), allowed)


def as_values(field: str, values: ArrayLike) -> Array:
    """Return `values` as an array of numbers, the same one where it is one of floats; else as `as_numbers`.

    For calls within a solve, whose arrays need no look at every entry.
    """
    if isinstance(values, np.ndarray) and values.dtype == np.float64:
        return values
    return as_numbers(field, values)


def is_single(values: object) -> bool:
    """Whether this is no list, column or array of numbers."""
    return not isinstance(values, list | tuple) and np.ndim(values) == 0  # type: ignore[arg-type]


def as_complex(field: str, values: ArrayLike) -> NDArray[np.complex128]:
    """Return `values` as a new array of any shape, of finite numbers that may be complex.

    Raises
    ------
    InputError
        What `as_numbers` refuses, but for complex numbers; infinite ones.
    """
    allowed = "finite numbers, real or complex"
    try:
        array = np.array(values)
    except ValueError:  # lists of several lengths
        raise InputError(field, shown(values), allowed) from None
    if array.dtype.kind != "c":
        array = as_numbers(field, values, allowed).astype(complex)
    elif any(isinstance(one, bool) for one in np.array(values, object).flat):
        raise InputError(field, shown(values), allowed)
    if not np.isfinite(array).all():
        raise InputError(field, "infinite, or not a number", allowed)
    return np.asarray(array, np.complex128)


def _all_numbers(values: object) -> bool:
    """Whether nested sequences, arrays and columns of tables hold numbers alone.

    numpy would make numbers of True, and of text in lists, objects and buffers.
    """
    if isinstance(values, (*TEXT, bool, MASKED)) or np.ma.is_masked(values):
        return False
    if isinstance(values, np.ndarray):
        if values.dtype.kind != "O":
            return values.dtype.kind in "fiu"
        return all(map(_all_numbers, values.flat))
    if isinstance(values, list | tuple):
        kinds = set(map(type, values)) - {float, int}
        return not kinds or all(_all_numbers(one) for one in values if type(one) in kinds)
    if isinstance(values, memoryview):
        return not isinstance(values.obj, TEXT) and _all_numbers(np.asarray(values))
    if isinstance(values, Real | Decimal):
        return True
    array = np.asarray(values)  # a column of a table, an array of another library
    return (array.ndim > 0 or array.dtype.kind != "O") and _all_numbers(array)


def _require_finite_entries(field: str, array: Array) -> None:
    bad = ~np.isfinite(array)
    if bad.any():
        at = ", ".join(str(k) for k in np.unravel_index(int(np.argmax(bad)), array.shape))
        raise InputError(f"{field}[{at}]", float(array.flat[int(np.argmax(bad))]), "a finite number")


def require_number(field: str, value: object, allowed: str) -> float:
    """Return `value` as a float, which may be infinite or not a number, or raise `InputError` with `allowed`."""
    # numbers.Real holds Python's and numpy's numbers, and bool, which is no number to a user
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(field, value, allowed)
    try:
        return float(value)
    except OverflowError:  # a whole number of more than 308 digits
        raise InputError(field, value, allowed) from None
