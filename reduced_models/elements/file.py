"""The JSON file of an element: header, and checks on reading. Knows no element class."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ehlcontact.errors import InputError
from ehlcontact.files import parse_json, read_text, write_text

SCHEMA = "ehlcontact-element"
VERSION = 1
UNITS = ("dimensionless", "SI")


def write_document(path: str | os.PathLike[str], document: Mapping[str, Any]) -> Path:
    """Write `document` under the element header; a reader sees the old file or the new one, never half of it.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    text = json.dumps({"schema": SCHEMA, "version": VERSION, **document}, indent=2, allow_nan=False) + "\n"
    return write_text(path, text)


def read_document(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read an element file and check its header and the form of its entries.

    Raises
    ------
    InputError
        The file is missing, truncated, not an element file, of a newer version, or lacks an entry.
    """
    name = str(path)
    try:
        document = parse_json(read_text(path))
    except (OSError, TypeError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError("file", name, f"a readable element file ({reason})") from None
    except UnicodeDecodeError:
        raise InputError("file", name, "an element file, which is text: complete JSON in UTF-8") from None
    except ValueError as error:
        raise InputError("file", name, f"an element file: complete JSON with finite numbers ({error})") from None
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        found = document.get("schema") if isinstance(document, dict) else type(document).__name__
        raise InputError(f"{name}: schema", found, f"the schema {SCHEMA!r} of an element file")
    found = document.get("version")
    if not isinstance(found, int) or isinstance(found, bool) or not 1 <= found <= VERSION:
        raise InputError(f"{name}: version", found, f"between 1 and {VERSION} (a newer library wrote it?)")
    for key in ("kind", "units"):
        if not isinstance(document.get(key), str):
            raise InputError(f"{name}: {key}", document.get(key), "text")
    if document["units"] not in UNITS:
        raise InputError(f"{name}: units", document["units"], " or ".join(UNITS))
    for key in ("parameters", "valid"):
        if not isinstance(document.get(key), dict):
            raise InputError(f"{name}: {key}", document.get(key), "an object of names and values")
    for key in ("fit", "source"):
        if not isinstance(document.get(key, {}), dict | None):
            raise InputError(f"{name}: {key}", document.get(key), "an object, or null")
    return document


@contextmanager
def naming(name: str) -> Iterator[None]:
    """Put the file's name before what an `InputError` of this block complains of."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{name}: {error.field}", error.value, error.allowed) from None


def numbers(section: str, entries: Mapping[str, Any], required: tuple[str, ...]) -> dict[str, float]:
    """Return the `required` entries of a section as floats.

    Raises
    ------
    InputError
        One is absent or not a finite number.
    """
    found: dict[str, float] = {}
    for key in required:
        value = entries.get(key)
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not math.isfinite(value):  # type: ignore[arg-type]
            raise InputError(f"{section}.{key}", value, "a finite number")
        found[key] = float(value)  # type: ignore[arg-type]
    return found
