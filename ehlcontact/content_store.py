"""Store by content: what is computed is found by the hash of the inputs that it was computed from.

Every entry is a file of its own, written in one move, so that an aborted or concurrent write cannot corrupt it.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from ehlcontact.version import __version__


def key_of(inputs: Any) -> str:
    """Hash of inputs, which JSON must be able to hold, and of the version of the library."""
    text = json.dumps([__version__, inputs], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def checksum(path: Path) -> str | None:
    """SHA-256 of a file, None where it cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return None


class ContentStore:
    """Folder of entries, each under its key and after a line with its checksum.

    Parameters
    ----------
    folder : Path
        Made if it does not exist.
    field : str
        What the folder is called in messages.

    Raises
    ------
    InputError
        It is no folder and cannot be made.
    """

    def __init__(self, folder: Path, field: str) -> None:
        self.folder, self.field = folder, field
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise InputError(field, str(folder), f"a folder that can be written to ({error.strerror})") from None

    def get(self, key: str) -> bytes | None:
        """Content of an entry; None where there is none, or a damaged one."""
        try:
            digest, _, content = (self.folder / key).read_bytes().partition(b"\n")
        except OSError:
            return None
        return content if digest.decode("ascii", "replace") == hashlib.sha256(content).hexdigest() else None

    def put(self, key: str, content: bytes) -> None:
        """Write an entry; it is on the disk when this returns.

        Raises
        ------
        InputError
            It cannot be written; other entries stay.
        """
        digest = hashlib.sha256(content).hexdigest().encode("ascii")
        write_bytes(self.folder / key, digest + b"\n" + content, self.field)
