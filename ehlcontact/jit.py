"""The numba decorators of the library.

Not ``fastmath=True``: it would fold away the tests for NaN and infinity that the drivers rely on.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property, partial, update_wrapper
from typing import Any

from numba import njit
from numba.core import event

from ehlcontact.kernel_cache import KernelCache


class _Inner:
    """A kernel that kernels call, compiled without the entry for Python, which takes a fifth of the time of all.

    Where Python calls it, as tests do, an entry is compiled in that process.
    """

    def __init__(self, kernel: Any) -> None:
        update_wrapper(self, kernel.py_func)
        self.py_func, self._kernel = kernel.py_func, kernel
        self._numba_type_ = kernel._numba_type_  # other kernels find it by its type

    def __call__(self, *args: Any) -> Any:
        return self._entry(*args)

    @cached_property
    def _entry(self) -> Any:
        kernel = self._kernel

        @njit
        def entry(*args: Any) -> Any:
            return kernel(*args)

        return entry


def inner(kernel: Any) -> Any:
    """Decorate, above one of the decorators below, a kernel that other kernels call, and the library does not."""
    if not hasattr(kernel, "py_func"):
        return kernel  # NUMBA_DISABLE_JIT
    kernel.targetoptions["no_cpython_wrapper"] = True  # numba ends the process where Python calls such a kernel
    return _Inner(kernel)


def jit_exact(kernel: Any = None, **options: Any) -> Any:
    """Decorate a kernel; `options` are numba's.

    For elements: no fused multiply-adds, for the same force must come out whatever a kernel was inlined into (and
    in C).
    """
    if kernel is None:
        return partial(jit_exact, **options)
    compiler: Any = njit
    found = compiler(kernel, error_model="numpy", no_cfunc_wrapper=True, **options)  # no kernel is a C callback
    if hasattr(found, "py_func"):
        found._cache = KernelCache(found.py_func)
    return found


jit: Any = partial(jit_exact, fastmath={"contract", "nsz"}, nogil=True)  # threads share the lines of a grid
# Without numba's counting of references, five times the work of a kernel that is handed a dozen arrays in tuples:
# such a kernel must not make arrays.
jit_loop: Any = partial(jit, _nrt=False)
jit_exact_loop: Any = partial(jit_exact, _nrt=False)
# For one node: such a call, too, costs more than the work. Python may call the first two.
jit_called_node: Any = partial(jit_loop, forceinline=True)
jit_exact_called_node: Any = partial(jit_exact_loop, forceinline=True)


def jit_node(kernel: Any) -> Any:
    """`inner`, for one node."""
    return inner(jit_called_node(kernel))


def jit_exact_node(kernel: Any) -> Any:
    """`inner`, for one node, with the bits of jit_exact."""
    return inner(jit_exact_called_node(kernel))


def compile_for(kernel: Any, arguments: Sequence[Any]) -> None:
    """Compile a kernel, one with `inner` too, for the types of these arguments, or find it in the cache."""
    kernel = getattr(kernel, "_kernel", kernel)
    kernel.compile(tuple(kernel.typeof_pyval(given) for given in arguments))


def is_kept(kernel: Any) -> bool:
    """Whether a kernel, one with `inner` too, is found compiled; always where NUMBA_DISABLE_JIT is set."""
    kernel = getattr(kernel, "_kernel", kernel)
    return not hasattr(kernel, "py_func") or bool(kernel._cache.is_kept)


def plain(kernel: Any) -> Any:
    """The Python function of a kernel; the kernel itself where NUMBA_DISABLE_JIT is set."""
    return getattr(kernel, "py_func", kernel)


class _FewerCollections(event.Listener):
    """While kernels are compiled, Python looks for cyclic garbage less often: that took a twentieth of the time.

    A kernel is compiled within the compilation of the one that calls it, one thread at a time.
    """

    OBJECTS = 30  # times as many new objects until it looks; 0, which stands for never, stays

    def __init__(self) -> None:
        self._depth, self._before = 0, gc.get_threshold()

    def on_start(self, event: Any) -> None:
        if self._depth == 0:
            self._before = gc.get_threshold()
            gc.set_threshold(self.OBJECTS * self._before[0], *self._before[1:])
        self._depth += 1

    def on_end(self, event: Any) -> None:
        self._depth -= 1
        if self._depth == 0:
            gc.set_threshold(*self._before)


event.register("numba:compile", _FewerCollections())


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
