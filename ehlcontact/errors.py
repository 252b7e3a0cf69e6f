"""Exceptions: `InputError` for bad input, `ConvergenceError` for a solve that did not converge."""

from __future__ import annotations

from typing import Any

import numpy as np

LONGEST_VALUE = 300  # characters of a value in a message: a whole file given as one is no help


def printable(text: str) -> str:
    """`text` with escapes for what a terminal would obey in place of showing it, such as ESC."""
    return "".join(one if one.isprintable() else repr(one)[1:-1] for one in text)


class InputError(ValueError):
    """An input outside its allowed range.

    The message is one line: the field, its value and the allowed range.
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        self.field, self.value, self.allowed = field, value, allowed
        try:
            shown = repr(value.item() if isinstance(value, np.generic) else value)
        except ValueError:  # Python writes no whole number of more than 4300 digits
            shown = "a whole number of thousands of digits"
        if len(shown) > LONGEST_VALUE:
            shown = f"{shown[: LONGEST_VALUE // 2]} ... {shown[-LONGEST_VALUE // 2 :]}"
        super().__init__(printable(" ".join(f"{field} = {shown}: must be {allowed}".split())))

    def __reduce__(self) -> tuple[Any, ...]:
        """For processes, which pass errors on: Python's own way is to call the class with the message."""
        return type(self), (self.field, self.value, self.allowed)


class ConvergenceError(RuntimeError):
    """A solve ended without converging; ``result`` holds what was reached, with its status."""

    def __init__(self, message: str, result: Any) -> None:
        self.result = result
        super().__init__(message)
