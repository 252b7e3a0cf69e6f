"""The work file of an atlas build: one JSON line per solved point, safe against a kill at any moment."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from ehlcontact.errors import InputError

SCHEMA = "ehlcontact-atlas-work"


class WorkFile:
    """Append-only file of entries by point under a header line; opened again it goes on where it ended.

    A line that a kill cut short is dropped. Use as a context manager.

    Parameters
    ----------
    path : Path
        Made if it does not exist.
    settings : mapping
        What makes entries comparable; a file with others is refused.

    Raises
    ------
    InputError
        The file cannot be written, is no work file, or was begun with other settings.
    """

    def __init__(self, path: Path, settings: Mapping[str, Any]) -> None:
        self.path, self.entries = path, dict[str, dict[str, Any]]()
        header = {"schema": SCHEMA, **settings}
        try:
            self._stream = path.open("a+b")
        except OSError as error:
            raise InputError("work file", str(path), f"a file that can be written ({error.strerror})") from None
        try:
            self._read(header)
        except InputError:
            self._stream.close()
            raise

    def _read(self, header: dict[str, Any]) -> None:
        self._stream.seek(0)
        *whole, torn = self._stream.read().split(b"\n")
        try:
            lines = [json.loads(line) for line in whole]
            found = lines[0] if lines else None
            if found is not None and (not isinstance(found, dict) or found.get("schema") != SCHEMA):
                raise ValueError("no header")
            self.entries = {str(line["point"]): line for line in lines[1:]}
        except (ValueError, KeyError, TypeError, IndexError) as error:
            raise InputError("work file", str(self.path), f"a work file of an atlas build ({error})") from None
        if found is not None and found != header:
            differing = sorted(k for k in {*found, *header} if found.get(k) != header.get(k))
            allowed = f"begun with the same {', '.join(differing)}: {[header.get(k) for k in differing]}"
            raise InputError("work file", f"{self.path} ({[found.get(k) for k in differing]})", allowed)
        if torn:
            self._stream.truncate(sum(len(line) + 1 for line in whole))
        if found is None:
            self._write(header)

    def add(self, name: str, entry: Mapping[str, Any]) -> None:
        """Keep the entry of a point, on the disk when this returns; one that is there already stays."""
        if name not in self.entries:
            self.entries[name] = {"point": name, **entry}
            self._write(self.entries[name])

    def _write(self, line: Mapping[str, Any]) -> None:
        self._stream.write(json.dumps(line, allow_nan=False).encode() + b"\n")
        self._stream.flush()
        os.fsync(self._stream.fileno())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._stream.close()
