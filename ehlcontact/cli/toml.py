"""TOML: files of studies and bearings read, entries written with all their digits."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

from ehlcontact.errors import InputError
from ehlcontact.files import read_text

# Whole part, decimals behind a comma or a point, and exponent
NUMBER = re.compile(r"([+-]?\d+)(?:[.,](\d+))?(e[+-]?\d+)?", re.IGNORECASE)


def read_toml(path: Path | str, field: str) -> dict[str, Any]:
    """Content of a TOML file; `field` is the name of the input that gives the file, for messages.

    Raises
    ------
    InputError
        No such file, or not TOML: with the line that the parser points to.
    """
    text = ""
    try:
        text = read_text(path)
        return tomllib.loads(text)
    except OSError as error:
        raise InputError(field, str(path), f"a readable TOML file ({error.strerror})") from None
    except (ValueError, RecursionError) as error:
        raise InputError(field, str(path), f"complete TOML ({_broken_line(text, error)})") from None


def number_in_text(text: str) -> str:
    """The number that a text with a decimal comma or in quotes probably is, in words; empty if it is none."""
    if (found := NUMBER.fullmatch(text.strip())) is None:
        return ""
    return (
        f"{found[1]}{f'.{found[2]}' if found[2] else ''}{found[3] or ''}? decimals have a point, numbers no quotes"
    )


def _broken_line(text: str, error: Exception) -> str:
    """Why it is no TOML, and the line that the parser points to."""
    if isinstance(error, RecursionError):
        return "nested too deeply"
    if isinstance(error, UnicodeDecodeError):
        return "text in UTF-8, which this is not"
    reason = str(error)
    found = re.search(r"at line (\d+)", reason)
    lines = text.splitlines()
    line = lines[int(found[1]) - 1].strip() if found and int(found[1]) <= len(lines) else ""
    guess = number_in_text(line.partition("=")[2].partition("#")[0])
    return f"{reason}: {shortened(line)}{f' ({guess})' if guess else ''}" if line else reason


def toml_value(value: Any) -> str:
    """A value of an entry in TOML, with all its digits."""
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, float):
        short = f"{value:g}"
        text = short if float(short) == value else repr(value)
        return text if "." in text or "e" in text else f"{text}.0"
    return json.dumps(value, ensure_ascii=False)


def toml_of(entries: Mapping[str, Any]) -> str:
    """A file of entries, of sections with their entries and sections, and of tables that stand several times."""
    return "\n".join(_lines(entries, "")) + "\n"


def _lines(entries: Mapping[str, Any], above: str) -> list[str]:
    tables = {name: value for name, value in entries.items() if isinstance(value, Mapping) or _is_several(value)}
    lines = [f"{key} = {toml_value(value)}" for key, value in entries.items() if key not in tables]
    for name, value in tables.items():
        head = f"{above}{name}"
        several = _is_several(value)
        for one in value if several else (value,):
            lines += ["", f"[[{head}]]" if several else f"[{head}]", *_lines(one, f"{head}.")]
    return lines


def _is_several(value: Any) -> bool:
    return isinstance(value, tuple | list) and any(isinstance(one, Mapping) for one in value)
