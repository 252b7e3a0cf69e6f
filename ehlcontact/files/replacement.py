"""Files that are never half written: a reader sees the old content or the new, whatever happens in between."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ehlcontact.errors import InputError


@contextmanager
def replacing(path: str | os.PathLike[str], field: str = "path") -> Iterator[Path]:
    """Give a new, empty file beside `path` to write to; it takes the place of `path` if nothing was raised.

    Parameters
    ----------
    path : path
        The file to make or to replace.
    field : str
        What it is called in messages.

    Raises
    ------
    InputError
        The folder cannot be written to, or the file cannot: an `OSError` within the block is turned into it.
    """
    target = Path(path)
    # not tempfile: it makes files that only their owner may read; the name is short, so that a long one still fits
    temporary = target.with_name(f".{uuid.uuid4().hex[:12]}.tmp")
    try:
        temporary.touch(exist_ok=False)
    except OSError as error:
        raise InputError(field, str(target), f"in a folder that can be written to ({error.strerror})") from None
    try:
        yield temporary
        os.replace(temporary, target)
    except OSError as error:
        raise InputError(field, str(target), f"a file that can be written ({error.strerror or error})") from None
    finally:
        with suppress(OSError):  # the folder itself may be gone; the first error says why
            temporary.unlink(missing_ok=True)


def write_text(path: str | os.PathLike[str], text: str, field: str = "path") -> Path:
    """Write a text file as UTF-8 by `replacing`."""
    with replacing(path, field) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return Path(path)


def write_bytes(path: str | os.PathLike[str], content: bytes, field: str = "path") -> Path:
    """Write a file by `replacing`."""
    with replacing(path, field) as temporary:
        temporary.write_bytes(content)
    return Path(path)
