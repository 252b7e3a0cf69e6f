"""Lists of structures in kernels: the same values as in Python, and one compilation for all lengths."""

from typing import NamedTuple

import numba
import numpy as np
import pytest

from ehlcontact.jit import jit_exact_loop
from reduced_models.bearing.compiled_list import CompiledList


class Inner(NamedTuple):
    cube: np.ndarray
    pair: tuple[float, int]


class Outer(NamedTuple):
    first: float
    inner: Inner
    steps: np.ndarray


def structure(k):
    cube = np.arange(24.0 * (k + 1)).reshape(k + 1, 2, 3, 4) + k
    return Outer(0.1 + k, Inner(cube, (-1.5 * k, 7 - k)), np.zeros(k + 2, np.int64))


@jit_exact_loop
def read(items, found):
    """Numbers of all structures; their arrays are written into."""
    for b in range(len(items)):
        one = items[b]
        found[b, 0], found[b, 1], found[b, 2] = one.first, one.inner.pair[0], one.inner.pair[1]
        found[b, 3], found[b, 4] = one.inner.cube[b, 1, 2, 3], one.inner.cube.shape[0]
        one.steps[b + 1] += 5


def test_kernels_read_and_write_what_python_has():
    for length in (1, 2, 5):
        items = CompiledList(structure(k) for k in range(length))
        found = np.zeros((length, 5))
        read(items, found)
        for k, one in enumerate(items):
            expected = one.first, *one.inner.pair, one.inner.cube[k, 1, 2, 3], k + 1.0
            assert found[k].tolist() == list(expected)
            assert one.steps.tolist() == [0] * (k + 1) + [5]
    if not numba.config.DISABLE_JIT:
        assert len(read.signatures) == 1


@pytest.mark.parametrize(
    ("items", "message"),
    [
        ([], "not of 0"),
        ([(1.0, 2), (1.0, 2.0)], "not of 2"),
        ([(np.zeros(2),), (np.zeros((2, 2)).T[0],)], "not of 2"),
        ([(1.0, True)], "array or a number"),
        ([(1.0, None)], "array or a number"),
    ],
)
def test_structures_of_other_types(items, message):
    with pytest.raises(TypeError, match=message):
        CompiledList(items)
