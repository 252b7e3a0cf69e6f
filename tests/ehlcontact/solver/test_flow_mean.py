"""Mean flow factor between two nodes."""

from math import exp, log

import numpy as np
import oracles
import pytest

from ehlcontact.solver.kernels import reynolds as mean

PAIRS = [(1.0, 1.0), (2.0, 3.0), (1e-12, 40.0), (1e-200, 1e-3), (5.0, 1e-300)]


@pytest.mark.parametrize(("a", "b"), PAIRS)
@pytest.mark.parametrize("kernel", [mean.flow_mean, mean.flow_mean.py_func], ids=["jit", "python"])
def test_against_the_log_ratio(kernel, a, b):
    value, skew = kernel(a, b)
    assert value == pytest.approx(oracles.flow_mean(a, b), rel=1e-10)
    assert kernel(b, a) == (value, -skew)


def test_underflow_gives_nothing():
    value, skew = mean.flow_mean.py_func(0.0, 0.0)
    assert value < 1e-200
    assert skew == 0.0


@pytest.mark.parametrize(("a", "b"), PAIRS[:3])
def test_slopes_against_differences(a, b):
    h = 1e-5

    def f(a, b):
        return mean.flow_mean(a, b)[0]

    expected = (
        (f(a * exp(h), b) - f(a * exp(-h), b)) / (2.0 * h),
        (f(a, b * exp(h)) - f(a, b * exp(-h))) / (2.0 * h),
    )
    for kernel in (mean.flow_mean, mean.flow_mean.py_func):
        value, skew = kernel(a, b)
        assert (0.5 * value + skew, 0.5 * value - skew) == pytest.approx(expected, rel=1e-7, abs=1e-9 * value)


def test_flow_follows_both_pressures():
    """Down a slope of any steepness, eps = exp(-alpha P): more flow for more pressure upstream."""
    alpha = 20.0
    drop = np.linspace(0.01, 3.0, 400)
    flow = np.array([mean.flow_mean(exp(-alpha * d), 1.0)[0] * d for d in drop])
    assert (np.diff(flow) > 0.0).all()
    geometric = np.exp(-0.5 * alpha * drop) * drop
    assert (np.diff(geometric) < 0.0).any()  # what the geometric mean would do


def test_nearly_geometric_for_neighbours_alike():
    x = 0.5 * log(2.0)
    assert mean.flow_mean(1.0, 2.0)[0] / 2.0**0.5 - 1.0 == pytest.approx(x**4 / 8.0, rel=0.1)
