"""The C core: balls between races, their films, steps of rotors; compiled once and loaded into this process.

Its sources, in `csrc`, are also those of FMUs. The compiled library is kept with those of FMUs
(`ehlcontact.binaries`): a machine compiles it once for every version of the sources.
"""

from __future__ import annotations

import ctypes
import tempfile
from functools import cache
from pathlib import Path
from threading import Lock

from ehlcontact.binaries import BuildError, build_library, this_machine
from ehlcontact.binaries.cache import cache_folder
from ehlcontact.kernel_cache import warn_not_kept

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
    if cache_folder() is None:
        warn_not_kept("no folder of caches can be written to")
    # Loaded from a file of its own, which systems other than Windows do without afterwards.
    try:
        with tempfile.TemporaryDirectory(prefix="ehlcontact-c-", ignore_cleanup_errors=True) as folder:
            file = Path(folder) / f"{NAME}{target.suffix}"
            file.write_bytes(content)
            return ctypes.CDLL(str(file))
    except OSError as error:
        reason = f"the C core cannot be loaded from a temporary file: {error}"
        raise BuildError(f"{reason}; TMPDIR names another folder for it") from None
