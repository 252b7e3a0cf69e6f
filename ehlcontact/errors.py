"""`InputError` for bad input, `ConvergenceError` for a failed solve, `warn_user` for warnings."""

from __future__ import annotations

import sys
import warnings
from typing import Any

import numpy as np

# Root modules that are not the user's: the library, what calls it back, and what its own calls pass through.
LIBRARY = frozenset({"ehlcontact", "reduced_models", "fmu"})
BETWEEN = frozenset(
    {"contextlib", "dataclasses", "functools", "importlib", "numba", "numpy", "pint", "ross", "scipy"}
)

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


def warn_user(message: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the line of the user's code that called the library, through however many calls inside it.

    Decorators and generated methods put calls of their own between, so ``stacklevel`` would have to count them.
    """
    frame = sys._getframe(1)
    while frame.f_back is not None and _root(frame.f_globals) in LIBRARY | BETWEEN:
        frame = frame.f_back
    names = frame.f_globals
    registry = names.setdefault("__warningregistry__", {})
    warnings.warn_explicit(
        message, category, frame.f_code.co_filename, frame.f_lineno, names.get("__name__", "<string>"), registry
    )


def _root(names: dict[str, Any]) -> str:
    """Root of the module with these global names."""
    return str(names.get("__name__", "")).partition(".")[0]
