"""Exponential and logarithm by polynomials, float by float and eight at a time, against numpy's."""

import numpy as np
import pytest

from ehlcontact.elementary import exponential, logarithm
from ehlcontact.jit import jit
from ehlcontact.lanes import LANES, at, eight, put


@jit
def eightfold_exponential(x, out):
    for i in range(0, x.shape[1], LANES):
        put(out, 0, eight(i), exponential(at(x, 0, eight(i))))


@jit
def eightfold_logarithm(x, out):
    for i in range(0, x.shape[1], LANES):
        put(out, 0, eight(i), logarithm(at(x, 0, eight(i))))


def eightfold(kernel, x):
    out = np.empty((1, x.size))
    kernel(x[None], out)
    return out[0]


ARGUMENTS = np.concatenate([np.linspace(-707.0, 708.0, 4000), np.random.default_rng(0).normal(size=4000)])
NUMBERS = np.concatenate([np.geomspace(1e-300, 1e300, 4000), 1.0 + np.geomspace(1e-15, 1e3, 4000)])


@pytest.mark.parametrize(
    ("alone", "kernel", "exact", "x"),
    [(exponential, eightfold_exponential, np.exp, ARGUMENTS), (logarithm, eightfold_logarithm, np.log, NUMBERS)],
    ids=["exponential", "logarithm"],
)
def test_within_two_units_in_the_last_place(alone, kernel, exact, x):
    expected = exact(x)
    np.testing.assert_array_less(np.abs(eightfold(kernel, x) - expected), 2.01 * np.spacing(np.abs(expected)))
    one_by_one = np.array([alone(value) for value in x[::50]])
    np.testing.assert_array_less(np.abs(one_by_one - expected[::50]), 2.01 * np.spacing(np.abs(expected[::50])))


def test_exact_where_there_is_no_pressure():
    assert logarithm(1.0) == 0.0
    assert exponential(0.0) == 1.0


def test_beyond_its_range_and_nan():
    x = np.array([-np.inf, -800.0, 800.0, np.inf, np.nan, 0.0, 0.0, 0.0])
    with np.errstate(all="ignore"):
        got = eightfold(eightfold_exponential, x)
    assert (got[:2] < 1e-300).all()
    assert (got[2:4] > 1e300).all()
    assert np.isnan(got[4])
