"""The C core: balls between races, their films, steps of rotors; compiled once and loaded into this process.

Its sources, in `csrc`, are also those of FMUs. The compiled library is kept with those of FMUs
(`ehlcontact.binaries`): a machine compiles it once for every version of the sources.
"""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
from functools import cache
from pathlib import Path
from threading import Lock

from ehlcontact.binaries import BuildError, build_library, this_machine

CSRC = Path(__file__).parent / "csrc"
NAME = "ehlcontact_core"
EXPORTED = ("-fvisibility=default", "-fno-semantic-interposition")  # FMUs hide functions; Python calls every one

_once = Lock()


def library() -> ctypes.CDLL:
    """The library, loaded; its functions keep no state of their own, so that threads may call them at once.

    Raises
    ------
    BuildError
        No C compiler, one that failed, or a library that this system does not load.
    """
    with _once:
        return _loaded()


@cache
def _loaded() -> ctypes.CDLL:
    sources = {path.name: path.read_bytes() for path in sorted(CSRC.glob("*.[ch]"))}
    content = build_library(sources, [name for name in sources if name.endswith(".c")], NAME, EXPORTED)
    target = this_machine()
    assert target is not None  # else nothing was built
    try:
        return _from_file(content, f"{NAME}{target.suffix}")
    except OSError as error:  # no temporary folder, or one whose files are not executed
        reason = f"the C core cannot be loaded from a temporary file: {error}"
    try:
        return _from_memory(content)
    except OSError:
        raise BuildError(f"{reason}; TMPDIR names another folder for it") from None


def _from_file(content: bytes, name: str) -> ctypes.CDLL:
    """Load a library from a file of its own, which systems other than Windows do without afterwards."""
    with tempfile.TemporaryDirectory(prefix="ehlcontact-c-", ignore_cleanup_errors=True) as folder:
        file = Path(folder) / name
        file.write_bytes(content)
        return ctypes.CDLL(str(file))


def _from_memory(content: bytes) -> ctypes.CDLL:
    """Load a library from a file in memory; raises `OSError` on systems other than Linux."""
    if sys.platform != "linux":
        raise OSError("no files in memory")
    with open(os.memfd_create(NAME), "wb") as stream:
        stream.write(content)
        stream.flush()
        return ctypes.CDLL(f"/proc/self/fd/{stream.fileno()}")
