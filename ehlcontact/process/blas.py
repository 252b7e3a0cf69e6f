"""Limit of BLAS to one thread during a solve.

The matrices have some thousand unknowns at most. A second thread of BLAS gains nothing there, and one without work
spins: steps in time took twice as much processor time as they lasted, answers of an atlas three times.

The rule: a function that solves dense systems, or multiplies matrices, of tens to thousands of rows again and
again has this decorator (solves, runs and impedances, answers of an atlas, fits and checks of a film memory).
Systems of a few rows, as a rotor's, do not wake a second thread.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import scipy
from threadpoolctl import ThreadpoolController


@dataclass
class _Hold:
    """How many blocks hold BLAS down at present, in whatever threads, and what the first of them found.

    The limit is one of the whole process: of two blocks that overlap in two threads, each putting back what it
    found, the second would leave it at one thread for good.
    """

    lock: threading.Lock = field(default_factory=threading.Lock)
    blocks: int = 0
    found: int | None = None
    limit: Any = None
    owner: threading.Thread | None = None


_hold = _Hold()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Keep BLAS on one thread within the block, or the decorated function; blocks may nest and overlap."""
    with _hold.lock:
        if _hold.blocks == 0:
            _hold.found = _present()
            _hold.limit, _hold.owner = _controller().limit(limits=1), threading.current_thread()
        _hold.blocks += 1
    try:
        yield
    finally:
        with _hold.lock:
            _hold.blocks -= 1
            if _hold.blocks == 0:
                _let_go(force=_hold.owner is not threading.current_thread())
                _hold.limit.restore_original_limits()
                _let_go()


def blas_threads() -> int | None:
    """Threads of BLAS, of the one that has the fewest, outside our own blocks; None where none is known."""
    with _hold.lock:
        return _hold.found if _hold.blocks else _present()


@cache
def _controller() -> ThreadpoolController:
    """The BLAS libraries: to look for them takes milliseconds, to limit them ten microseconds."""
    _ = np, scipy.linalg  # each brings its own, which has to be loaded before it can be found
    return ThreadpoolController().select(user_api="blas")


def _let_go(force: bool = False) -> None:
    """Let any thread change limits: threadpoolctl 3.8 leaves it to the one that was first."""
    for library in _controller().lib_controllers:
        if hasattr(library, "clear_controlling_thread"):
            library.clear_controlling_thread(force=force)


def _present() -> int | None:
    return min((library.num_threads for library in _controller().lib_controllers), default=None)
