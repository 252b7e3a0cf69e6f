"""``run.log``: tasks that were begun, kept and solved, warnings, and versions, each with its time."""

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
