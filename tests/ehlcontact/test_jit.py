"""What compiling leaves behind."""

import gc

import pytest
from numba import njit
from numba.core.errors import TypingError

import ehlcontact.jit  # noqa: F401 - from here on compiling collects less often


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
