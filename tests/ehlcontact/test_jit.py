"""What compiling leaves behind."""

import gc
import importlib
import sys

import numba
import pytest
from numba import njit
from numba.core.errors import TypingError

from ehlcontact import jit

CALLEE = """
from typing import NamedTuple
from ehlcontact.jit import jit_exact_node

class {kind}(NamedTuple):
    value: float

@jit_exact_node
def changed(given):
    return given.value + {by}
"""
CALLER = """
from kernel_callee import changed
from ehlcontact.jit import jit_exact

@jit_exact
def caller(given):
    return changed(given)
"""


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
def test_kernels_of_other_sources_are_not_read(tmp_path, monkeypatch):
    """Another file has changed, whose kernel was called and whose class is no longer there."""
    monkeypatch.setattr(jit, "_PACKAGES", ("kernel_callee", "ehlcontact"))
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "kernel_caller.py").write_text(CALLER)
    found, read = [], []
    for kind, by in (("Kind", 1.0), ("Kind", 1.0), ("Renamed", 100.0)):
        (tmp_path / "kernel_callee.py").write_text(CALLEE.format(kind=kind, by=by))
        for name in ("kernel_callee", "kernel_caller"):
            monkeypatch.delitem(sys.modules, name, raising=False)
        importlib.invalidate_caches()
        jit.sources.cache_clear()
        jit._source.cache_clear()
        caller = importlib.import_module("kernel_caller").caller
        found.append(caller(getattr(sys.modules["kernel_callee"], kind)(1.0)))
        read.append(sum(caller.stats.cache_hits.values()))
    assert found == [2.0, 2.0, 101.0]
    assert read == [0, 1, 0]


def test_collection_of_garbage_is_as_before_once_kernels_are_compiled():
    """Also after one that calls another, and after one that cannot be compiled."""
    inner = njit(lambda x: x + 1)
    outer = njit(lambda x: inner(x))
    failing = njit(lambda x: inner(x).nothing)
    before = gc.get_threshold()
    gc.set_threshold(701, 11, 12)
    try:
        assert outer(1) == 2
        assert gc.get_threshold() == (701, 11, 12)
        with pytest.raises(TypingError):
            failing(1.0)
        assert gc.get_threshold() == (701, 11, 12)
    finally:
        gc.set_threshold(*before)
