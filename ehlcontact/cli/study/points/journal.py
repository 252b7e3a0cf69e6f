"""``run.log``: when what was begun, kept, solved and complained of, with the versions that did it."""

from __future__ import annotations

import platform
import sys
from collections.abc import Mapping
from contextlib import suppress
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from ehlcontact.cli.output import complain, one_line
from ehlcontact.version import __version__

LOG = "run.log"
LIBRARIES = ("numpy", "scipy", "numba", "h5py", "fmpy")


class Journal:
    """Lines at the end of a file, each on the disk before the next; a disk that is full costs the line alone.

    Parameters
    ----------
    path : Path or None
        None keeps no journal.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.warnings: list[str] = []

    def line(self, kind: str, text: str) -> None:
        """One line: when, what kind of news, and what."""
        if self.path is not None:
            now = datetime.now().astimezone().isoformat(timespec="seconds")
            with suppress(OSError), self.path.open("a", encoding="utf-8") as stream:
                stream.write(f"{now}  {kind:<9} {one_line(text)}\n")

    def warn(self, text: str) -> None:
        """Say it on stderr too."""
        self.warnings.append(one_line(text))
        self.line("warning", text)
        complain(text)


def versions() -> dict[str, str]:
    """Software that the numbers come from."""
    found: Mapping[str, str] = {name: version(name) for name in LIBRARIES}
    return {"ehlcontact": __version__, "python": platform.python_version(), **found, "platform": sys.platform}
