"""The numba decorators of the library.

Not ``fastmath=True``: it would fold away the tests for NaN and infinity that the drivers rely on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from numba import njit
from numba.core import event

# Elements: no fused multiply-adds, for the same force must come out whatever a kernel was inlined into (and in C).
jit_exact: Any = partial(njit, cache=True, error_model="numpy")
jit: Any = partial(jit_exact, fastmath={"contract", "nsz"}, nogil=True)  # threads share the lines of a grid
# Without numba's counting of references, five times the work of a kernel that is handed a dozen arrays in tuples:
# such a kernel must not make arrays.
jit_loop: Any = partial(jit, _nrt=False)
jit_node: Any = partial(jit_loop, forceinline=True)  # for one node: such a call, too, costs more than the work
jit_exact_node: Any = partial(jit_exact, forceinline=True, _nrt=False)  # likewise, with the bits of jit_exact
jit_exact_loop: Any = partial(jit_exact, _nrt=False)  # the same for a loop over such


def plain(kernel: Any) -> Any:
    """The Python function of a kernel; the kernel itself where NUMBA_DISABLE_JIT is set."""
    return getattr(kernel, "py_func", kernel)


class _Compilation(event.Listener):
    def __init__(self, tell: Callable[[], None]) -> None:
        self._tell = tell

    def on_start(self, event: Any) -> None:
        self._tell()

    def on_end(self, event: Any) -> None:
        pass


@contextmanager
def compilation_told(tell: Callable[[], None]) -> Iterator[None]:
    """Call `tell` whenever a kernel begins to be compiled: one that is found compiled on disk is not told."""
    with event.install_listener("numba:compile", _Compilation(tell)):
        yield
