"""JSON files of bearings and of their states: a header, and what is wrong with a file in one line."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import Lubricant
from ehlcontact.checks import require_instance
from ehlcontact.errors import InputError
from ehlcontact.files import parse_json, read_text, write_text

VERSION = 1  # of the files


def plain(value: Any) -> Any:
    """`value` as JSON has it."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value) if f.init}
    return value


def write(path: str | os.PathLike[str], schema: str, entries: Mapping[str, Any]) -> Path:
    """Write `entries` under a header; a reader sees the old file or the new one, never half of it.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    document = {"schema": schema, "version": VERSION, **entries}
    return write_text(path, json.dumps(document, indent=2, allow_nan=False) + "\n")


def read(path: str | os.PathLike[str], schema: str, cls: Any) -> dict[str, Any]:
    """Entries of a file that `write` wrote: those of the dataclass `cls`, all that it needs among them.

    Raises
    ------
    InputError
        No readable file of this schema, or of a newer version; an entry that is missing or unknown.
    """
    name = str(path)
    try:
        document = parse_json(read_text(path))
    except (OSError, TypeError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError("file", name, f"a readable JSON file of schema {schema!r} ({reason})") from None
    if not isinstance(document, dict) or document.get("schema") != schema:
        found = document.get("schema") if isinstance(document, dict) else type(document).__name__
        raise InputError(f"{name}: schema", found, repr(schema))
    if document.get("version") != VERSION:
        raise InputError(f"{name}: version", document.get("version"), f"{VERSION} (a newer library wrote it?)")
    entries = {key: value for key, value in document.items() if key not in ("schema", "version")}
    known = [f.name for f in fields(cls) if f.init]
    for key, value in entries.items():
        if key not in known:
            raise InputError(f"{name}: {key}", value, "left out: nothing here is called so")
    for key in known:
        if key not in entries:
            raise InputError(f"{name}: {key}", None, "there")
    return entries


def oil_of(entry: Any, name: str) -> Lubricant | None:
    """The oil of an entry of file `name`, None where it has none; raises `InputError` for anything else."""
    if entry is None:
        return None
    require_instance("oil", entry, dict, "an object, or null")
    known = [f.name for f in fields(Lubricant)]
    for key, value in entry.items():
        if key not in known:
            raise InputError(f"{name}: oil.{key}", value, f"one of {', '.join(known)}")
    return Lubricant(**entry)
