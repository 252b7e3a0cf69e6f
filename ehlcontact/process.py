"""Processes that end as they should: with their parent, and in one line on Ctrl-C during their imports."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

PROGRAM = "ehlcontact"
TOO_EARLY = f"{PROGRAM}: interrupted before anything was computed\n"


def end_when(ended: Callable[[], object]) -> None:
    """End this process, without further ado, when `ended` returns: it waits for the end of the parent.

    A thread waits, not a signal of the kernel (``PR_SET_PDEATHSIG``): that comes when the parent's *thread* ends,
    on Linux only, and not at all if the parent was gone before it was asked for.
    """

    def watch() -> None:
        ended()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def stdin_closed() -> None:
    """Wait until whoever holds the other end of our stdin is gone."""
    with suppress(OSError):
        while os.read(0, 1):  # not sys.stdin: its lock, held by a thread, would break the interpreter's end
            pass


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Keep Ctrl-C from processes started within the block: it is for their parent, who ends them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def guard_imports() -> None:
    """Until `end_guard`, Ctrl-C is one line and exit code 1, if this process is the command line.

    Its imports take a second, most of it before any code of the command line runs, and some packages swallow what
    is raised while they are imported. Programs of others that import the library keep their own ways.
    """
    main_thread = threading.current_thread() is threading.main_thread()
    if main_thread and _is_program() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)


def end_guard() -> None:
    """Ctrl-C raises `KeyboardInterrupt` again."""
    if signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _is_program() -> bool:
    """Whether this process was started as ``ehlcontact`` or ``python -m ehlcontact.cli``."""
    return Path(sys.argv[0]).stem == PROGRAM or ("-m", f"{PROGRAM}.cli") in pairwise(sys.orig_argv)


def _leave(*_: Any) -> None:
    with suppress(OSError):
        os.write(2, TOO_EARLY.encode())
    os._exit(1)


guard_imports()  # here and not in the package, whose imports are what takes so long
