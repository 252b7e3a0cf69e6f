"""The two ways a call can fail: bad input, and a solve that did not converge."""

from __future__ import annotations

import math
from numbers import Integral, Real
from types import UnionType
from typing import Any


class InputError(ValueError):
    """An input outside its allowed range.

    The message is one line: the field, its value and the allowed range.
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        self.field, self.value, self.allowed = field, value, allowed
        super().__init__(f"{field} = {value!r}: must be {allowed}")


class ConvergenceError(RuntimeError):
    """A solve ended without converging; ``result`` holds what was reached, with its status."""

    def __init__(self, message: str, result: Any) -> None:
        self.result = result
        super().__init__(message)


def require_positive(field: str, value: object) -> float:
    """Return `value` as a float, or raise `InputError` unless it is finite and > 0."""
    number = _as_float(field, value, "a finite number > 0")
    if not (math.isfinite(number) and number > 0.0):
        raise InputError(field, number, "a finite number > 0")
    return number


def require_nonnegative(field: str, value: object) -> float:
    """Return `value` as a float, or raise `InputError` unless it is finite and >= 0."""
    number = _as_float(field, value, "a finite number >= 0")
    if not (math.isfinite(number) and number >= 0.0):
        raise InputError(field, number, "a finite number >= 0")
    return number


def require_finite(field: str, value: object) -> float:
    """Return `value` as a float, or raise `InputError` unless it is finite."""
    number = _as_float(field, value, "a finite number")
    if not math.isfinite(number):
        raise InputError(field, number, "a finite number")
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


def _as_float(field: str, value: object, allowed: str) -> float:
    # numbers.Real holds Python's and numpy's numbers, and bool, which is no number to a user
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(field, value, allowed)
    return float(value)


def require_instance(field: str, value: object, kinds: type | UnionType, allowed: str) -> None:
    """Raise `InputError` unless `value` is an instance of `kinds`; `allowed` names them."""
    if not isinstance(value, kinds):
        raise InputError(field, type(value).__name__, allowed)
