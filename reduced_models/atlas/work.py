"""Work file of an atlas build: solved points, safe against a kill at any moment."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from ehlcontact.errors import InputError
from ehlcontact.files import parse_json

Entry = dict[str, Any]

SCHEMA = "ehlcontact-atlas-work"


class WorkFile:
    """One JSON line per solved point under a header line; opened again it goes on where it ended.

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
        self.path, self.entries = path, dict[str, Entry]()
        header = {"schema": SCHEMA, **settings}
        with self._refusing():
            self._stream = path.open("a+b", buffering=0)  # nothing is left behind that is written later
        try:
            with self._refusing():
                self._read(header)
        except InputError:
            self._stream.close()
            raise

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            reason = f"a file that can be written ({error.strerror}); what it holds stays"
            raise InputError("work file", str(self.path), reason) from None

    def _read(self, header: dict[str, Any]) -> None:
        self._stream.seek(0)
        *whole, torn = self._stream.readall().split(b"\n")
        try:
            lines = [parse_json(line) for line in whole]
            found = lines[0] if lines else None
            begun = found is not None or _line(header).startswith(torn)  # a file of others ends without a line
            if not begun or (found is not None and (not isinstance(found, dict) or found.get("schema") != SCHEMA)):
                raise ValueError("no header")
            self.entries = {line["point"]: line for line in lines[1:]}
            if not all(isinstance(name, str) for name in self.entries):
                raise ValueError("an entry without a point")
        except (ValueError, KeyError, TypeError) as error:
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
        size = self._stream.seek(0, os.SEEK_END)
        with self._refusing():
            try:
                rest = _line(line)
                while rest:  # a disk that becomes full takes part of it
                    rest = rest[self._stream.write(rest) :]
                os.fsync(self._stream.fileno())
            except OSError:
                self._stream.truncate(size)  # no torn line before the next one
                raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._stream.close()


def _line(entry: Mapping[str, Any]) -> bytes:
    return json.dumps(entry, allow_nan=False).encode() + b"\n"
