"""One run at a time in a folder: two would do the same work and write the same files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ehlcontact.errors import InputError

try:
    import fcntl
except ImportError:  # Windows opens no folders: there nothing is held
    fcntl = None  # type: ignore[assignment]


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Hold a folder that is there; a process that ends in whatever way lets it go.

    Raises
    ------
    InputError
        Another process holds it.
    """
    if fcntl is None:
        yield
        return
    held = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError("folder", str(folder), "one that no other run is at work in") from None
        except OSError:  # a file system without locks
            pass
        yield
    finally:
        os.close(held)
