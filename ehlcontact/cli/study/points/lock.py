"""Lock of a folder: one run at a time."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ehlcontact.errors import InputError

try:
    import fcntl
except ImportError:  # Windows opens no folders: there nothing is locked
    fcntl = None  # type: ignore[assignment]


# Errors of file systems that have no locks: a study on one runs unlocked.
NO_LOCKS = (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Lock a folder for the block; the end of the process, however it comes, releases it.

    Raises
    ------
    InputError
        Another process has locked it.
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
        except OSError as error:
            if error.errno not in NO_LOCKS:
                raise
        yield
    finally:
        os.close(held)
