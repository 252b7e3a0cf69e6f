"""Processes that end with their parent, and leave Ctrl-C to it."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress


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
