"""Kinds of arguments that are no quantities: objects of a class, sequences of them, callbacks, paths, counts.

`takes` and `fields_take` of `ehlcontact.checks.quantity` have them by the names of arguments; a flag needs none.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from inspect import signature
from pathlib import PurePath
from typing import Any

from ehlcontact.checks.inputs import TEXT, as_complex, require_integer, shown
from ehlcontact.errors import InputError

LONGEST_NAME = 255  # bytes of a name in a folder, on every usual file system


@dataclass(frozen=True)
class Object:
    """An object of a class.

    Parameters
    ----------
    kinds : type or tuple of type
    allowed : str
        What messages call it, as "a BallBearing".
    """

    kinds: Any
    allowed: str
    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, or raise `InputError`."""
        if not isinstance(value, self.kinds):
            raise InputError(field, shown(value), self.allowed)
        return value


@dataclass(frozen=True)
class Objects:
    """A sequence of objects of a class.

    Parameters
    ----------
    kinds : type or tuple of type
    allowed : str
        What messages call one of them, as "a BallBearing".
    """

    kinds: Any
    allowed: str
    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """Their tuple, or raise `InputError`."""
        if isinstance(value, (*TEXT, Mapping)) or not isinstance(value, Iterable):
            raise InputError(field, shown(value), f"a list, of which each is {self.allowed}")
        objects = tuple(value)
        for k, one in enumerate(objects):
            if not isinstance(one, self.kinds):
                raise InputError(f"{field}[{k}]", shown(one), self.allowed)
        return objects


@dataclass(frozen=True)
class Callback:
    """What is called, with arguments that messages name."""

    arguments: str
    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, or raise `InputError`."""
        if not callable(value) or not accepts(value, self.arguments.count(",") + 1):
            raise InputError(field, shown(value), f"a function, called as {field}({self.arguments})")
        return value


def accepts(function: Any, count: int) -> bool:
    """Whether a function takes so many arguments without names, as far as its signature is known."""
    try:
        signature(function).bind(*range(count))
    except TypeError:
        return False
    except ValueError:  # of some functions written in C
        pass
    return True


@dataclass(frozen=True)
class PathName:
    """A file or a folder by its name: text or a path."""

    what: str
    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, or raise `InputError`."""
        if not isinstance(value, str | os.PathLike) or not isinstance(os.fspath(value), str):
            raise InputError(field, shown(value), f"the name of {self.what}: text or a path")
        name = os.fspath(value)
        if not name or "\0" in name:
            raise InputError(field, name, f"the name of {self.what}, without a zero character")
        if (
            max((len(part.encode("utf-8", "surrogateescape")) for part in PurePath(name).parts), default=0)
            > LONGEST_NAME
        ):
            raise InputError(
                field, name, f"the name of {self.what} that can be written, at most {LONGEST_NAME} bytes"
            )
        return value


@dataclass(frozen=True)
class Text:
    """Text, as a name."""

    longest: int = 1000
    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, or raise `InputError`."""
        if not isinstance(value, str) or len(value) > self.longest:
            raise InputError(
                field, value if isinstance(value, str) else shown(value), f"text of at most {self.longest} letters"
            )
        return value


@dataclass(frozen=True)
class ComplexNumbers:
    """Complex numbers of any shape, all of them finite."""

    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """Their array, or raise `InputError`."""
        return as_complex(field, value)


@dataclass(frozen=True)
class Count:
    """A whole number of a range, both ends included."""

    low: int
    high: int
    none: bool = False  # None leaves it out, where that is no default
    unit: str = ""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, or raise `InputError`."""
        if self.none and value is None:
            return None
        allowed = f"a whole number >= {self.low} and <= {self.high}"
        if require_integer(field, value, allowed, self.low) > self.high:
            raise InputError(field, value, allowed)
        return value


FILE, FOLDER, NAME = PathName("a file"), PathName("a folder"), Text()
ENTRIES = Object(Mapping, "a mapping of names to values")
COMPLEX = ComplexNumbers()
INDEX = Count(0, 1_000_000)  # of degrees of freedom, balls, bearings
INDEX_OR_NONE = Count(0, 1_000_000, none=True)
PROGRESS = Callback("libraries compiled, libraries in all")
STEPS = Count(3, 10_000_000)  # of a table of a function
DONE = Callback("done, of")  # progress of a task in many parts
