"""Parts of a machine as calls of the library: what makes them, and the Python that makes the same."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from inspect import signature
from textwrap import fill, indent
from typing import Any

import numpy as np

from ehlcontact.cli.toml import toml_value

WIDTH = 110  # characters of a line
DIGITS = 12  # of a number: lengths in mm are not so many exact ones in m
MARGIN = "    "


@dataclass(frozen=True, eq=False)
class Part:
    """A class of the library, or a method that makes one, with its keywords.

    Parameters
    ----------
    kind : type
        The class.
    keywords : mapping
    method : str
        Of the class; the class itself where it is empty.
    first : tuple
        Arguments before the keywords.
    """

    kind: type
    keywords: Mapping[str, Any]
    method: str = ""
    first: tuple[Any, ...] = field(default=())

    def made(self) -> Any:
        """The part; raises what the library raises."""
        make = getattr(self.kind, self.method) if self.method else self.kind
        keywords = {name: one.made() if isinstance(one, Part) else one for name, one in self.keywords.items()}
        return make(*self.first, **keywords)

    def text(self, names: Mapping[int, str] | None = None) -> str:
        """The call in Python without keywords that have their defaults; `names` of objects are by their id."""
        own = signature(getattr(self.kind, self.method)).parameters if self.method else {}
        usual = {**signature(self.kind).parameters, **own}
        keywords = {
            name: value
            for name, value in self.keywords.items()
            if name not in usual or id(value) in (names or {}) or not _is_same(value, usual[name].default)
        }
        arguments = [python_of(value, names) for value in self.first]
        arguments += [f"{name}={python_of(value, names)}" for name, value in keywords.items()]
        return call_text(f"{self.kind.__name__}{f'.{self.method}' if self.method else ''}", arguments)


def call_text(name: str, arguments: list[str]) -> str:
    """A call in one line, or with an argument in each."""
    line = f"{name}({', '.join(arguments)})"
    if len(line) <= WIDTH and "\n" not in line:
        return line
    return "\n".join([f"{name}(", *(f"{indent(one, MARGIN)}," for one in arguments), ")"])


def list_text(values: list[str]) -> str:
    """A list in one line, or with a value in each."""
    line = f"[{', '.join(values)}]"
    if len(line) <= WIDTH and "\n" not in line:
        return line
    return "\n".join(["[", *(f"{indent(one, MARGIN)}," for one in values), "]"])


def numbers_text(values: list[float]) -> str:
    """A list of numbers in as few lines as they need."""
    line = python_of(values)
    if len(line) <= WIDTH:
        return line
    inside = fill(line[1:-1] + ",", WIDTH, initial_indent=MARGIN, subsequent_indent=MARGIN)
    return f"[\n{inside}\n]"


def python_of(value: Any, names: Mapping[int, str] | None = None) -> str:
    """A value in Python: a name, a call, a number with `DIGITS` digits, text in double quotes, or several."""
    if names and id(value) in names:
        return names[id(value)]
    if isinstance(value, Part):
        return value.text(names)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        return toml_value(float(f"{value:.{DIGITS}g}") + 0.0)
    if isinstance(value, np.ndarray):
        return python_of(value.tolist(), names)
    if isinstance(value, list | tuple):
        inside = ", ".join(python_of(one, names) for one in value)
        ends = "[]" if isinstance(value, list) else "()"
        return f"{ends[0]}{inside}{',' if len(value) == 1 and isinstance(value, tuple) else ''}{ends[1]}"
    return repr(value)


def _is_same(value: Any, default: Any) -> bool:
    return type(value) is type(default) and bool(value == default)
