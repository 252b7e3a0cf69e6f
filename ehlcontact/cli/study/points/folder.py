"""Folder of a run: its lock, one run at a time; ``run.log`` in it, with tasks, warnings and versions."""

from __future__ import annotations

import errno
import os
import platform
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from ehlcontact.cli.output import complain, one_line
from ehlcontact.errors import InputError
from ehlcontact.version import __version__

try:
    import fcntl
except ImportError:  # Windows opens no folders: there nothing is locked
    fcntl = None  # type: ignore[assignment]

LOG = "run.log"
LIBRARIES = ("numpy", "scipy", "numba", "h5py", "fmpy")
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


class Log:
    """Lines appended to a file, each on the disk before the next; a full disk loses the line, not the run.

    Parameters
    ----------
    path : Path or None
        None writes nothing.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.warnings: list[str] = []

    def line(self, kind: str, text: str) -> None:
        """Append a line: time, kind, text."""
        if self.path is not None:
            now = datetime.now().astimezone().isoformat(timespec="seconds")
            with suppress(OSError), self.path.open("a", encoding="utf-8") as stream:
                stream.write(f"{now}  {kind:<9} {one_line(text)}\n")

    def warn(self, text: str) -> None:
        """Append a warning, and write it to stderr too."""
        self.warnings.append(one_line(text))
        self.line("warning", text)
        complain(text)


def versions() -> dict[str, str]:
    """Versions of the software that computes."""
    found: Mapping[str, str] = {name: version(name) for name in LIBRARIES}
    return {"ehlcontact": __version__, "python": platform.python_version(), **found, "platform": sys.platform}
