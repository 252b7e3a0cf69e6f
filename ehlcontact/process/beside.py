"""A process beside this one that compiles kernels into numba's cache on disk, where this one finds them.

It makes no result: without it, or where it ends early, this process compiles all by itself. It ends with this
process, or before.
"""

from __future__ import annotations

import atexit
import os
import subprocess
import sys
import threading
from contextlib import suppress

from ehlcontact.process.threads import threads_allowed

COMPILE_BESIDE = "EHLCONTACT_COMPILE_BESIDE"  # 0: this process compiles alone
RUN = "from ehlcontact.process.beside import end_with_parent; end_with_parent(); from {0} import {1}; {1}()"


def start_beside(module: str, function: str, folder: str) -> bool:
    """Call ``module.function()`` in a process beside this one; return whether it was started.

    It is not where a solve has one core (`threads_allowed`), as in a pool; where `folder`, that of the cache,
    cannot be written to; and in a program that has Python built in, where there is no interpreter to start.
    """
    if os.environ.get(COMPILE_BESIDE) == "0" or threads_allowed() < 2 or not os.access(folder, os.W_OK):
        return False
    if not os.path.basename(sys.executable or "").lower().startswith("python"):
        return False
    try:
        process = subprocess.Popen(
            [sys.executable, "-c", RUN.format(module, function)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=child_environment() | {"OPENBLAS_NUM_THREADS": "1", COMPILE_BESIDE: "0"},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            start_new_session=True,  # Ctrl-C in the terminal is for the parent
        )
    except OSError:  # no room for another process, or no working folder
        return False
    reaper = threading.Thread(target=_reap, args=(process,), name="ehlcontact-beside", daemon=True)
    reaper.start()
    atexit.register(_end, process, reaper, os.getpid())
    return True


def child_environment() -> dict[str, str]:
    """Environment of a process that imports what this one imports, also from a checkout."""
    path = os.pathsep.join(entry or os.getcwd() for entry in sys.path)
    return os.environ | {"PYTHONPATH": path, "PYTHONSAFEPATH": "1"}


def _reap(process: subprocess.Popen[bytes]) -> None:
    with process:  # closes its stdin, too
        process.wait()


def _end(process: subprocess.Popen[bytes], reaper: threading.Thread, parent: int) -> None:
    if os.getpid() == parent:  # not a fork of it
        process.kill()
        reaper.join()


def end_with_parent() -> None:
    """End this process once its stdin is closed, also by the parent's death."""

    def wait() -> None:
        with suppress(OSError):
            os.read(0, 1)
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
