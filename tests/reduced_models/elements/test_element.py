"""The law of the linear and the cubic element against a slow twin, and its ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehlcontact.errors import InputError
from reduced_models import CubicContact

U = np.concatenate([np.linspace(-2.0, 4.0, 241), [0.75, 1.0]])
V = np.linspace(-60.0, 60.0, 7)


def twin(e, u, v):
    """The contract in the most obvious words."""
    K = [e.K1, getattr(e, "K2", 0.0), getattr(e, "K3", 0.0)]

    def g(x):
        return sum(k * x**i for i, k in enumerate(K, start=1))

    def dg(x):
        return sum(i * k * x ** (i - 1) for i, k in enumerate(K, start=1))

    o_low, o_high = (end - 1.5 * g(end) / dg(end) for end in (e.low, e.high))
    if u > e.high:
        spring = g(e.high) * ((u - o_high) / (e.high - o_high)) ** 1.5
    elif u < e.low:
        spring = g(e.low) * (max(u - o_low, 0.0) / (e.low - o_low)) ** 1.5
    else:
        spring = g(u)
    s = min(max((u - o_low) / (e.low - o_low), 0.0), 1.0)
    return max(0.0, spring + e.C1 * (3 * s**2 - 2 * s**3) * v)


@pytest.fixture(params=["cubic", "linear"])
def element(request):
    return request.getfixturevalue(request.param)


def test_force_is_the_slow_twin_inside_and_outside(element):
    u, v = np.meshgrid(U, V)
    expected = np.array(
        [[twin(element, a, b) for a, b in zip(x, y, strict=True)] for x, y in zip(u, v, strict=True)]
    )
    np.testing.assert_allclose(element.force(u, v), expected, rtol=1e-13, atol=1e-14)
    assert np.any(expected == 0.0) and np.any(u > element.high)
    assert element.damper(0.9) == element.C1


SPRING = st.tuples(st.floats(0.3, 1.2), st.floats(0.0, 1.0), st.floats(-0.05, 0.5))


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@given(spring=SPRING, C1=st.floats(0.0, 0.2), low=st.floats(0.2, 0.9), width=st.floats(0.05, 0.5))
def test_law_is_c1_monotone_and_never_pulls(spring, C1, low, width):
    e = CubicContact(*spring, C1, low, low + width)
    for end in (e.low, e.high, e.law.o_low):
        left, right = end - 1e-9, end + 1e-9
        for v in (0.0, 0.3):
            assert e.force(left, v) == pytest.approx(e.force(right, v), abs=1e-7)
            # The tangent of a 3/2 power grows as a square root from its root.
            assert e.stiffness(left, v) == pytest.approx(e.stiffness(right, v), abs=3e-4)
    force = e.force(np.linspace(-1.0, 5.0, 200), 0.0)
    assert np.all(force >= 0.0) and np.all(np.diff(force) >= 0.0)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_extension_above_grows_like_hertz(cubic):
    assert cubic.force(4e6, 0.0) / cubic.force(1e6, 0.0) == pytest.approx(8.0, rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"K1": np.nan}, "K1"),
        ({"K2": np.inf}, "K2"),
        ({"C1": -0.1}, "C1"),
        ({"C1": "x"}, "C1"),
        ({"low": 1.0, "high": 1.0}, "low"),
        ({"low": -0.1}, "spring force at low"),
        ({"K1": 3.0, "K2": 0.0, "K3": -1.2}, "spring tangent at high"),
        ({"K1": 0.7556, "K2": -0.875, "K3": 1 / 3}, "spring tangent at approach 0.875"),
        ({"K1": 1.7e308, "K2": 0.0, "K3": 0.0}, "spring at low"),
        ({"high": 1e300, "K3": 0.0}, "spring at high"),
        ({"low": 1e-300, "K1": 1.0}, "spring at low"),
        ({"units": "mm"}, "units"),
        ({"rate": -1.0}, "rate"),
    ],
)
def test_bad_parameters_are_named(changes, field):
    values = {"K1": 0.8, "K2": 0.3, "K3": 0.05, "C1": 0.01, "low": 0.75, "high": 1.0} | changes
    with pytest.raises(InputError) as caught:
        CubicContact(**values)
    assert caught.value.field == field


@pytest.mark.parametrize("lowest", [0.76, 0.875, 0.99])
@pytest.mark.parametrize("slope", [1e-6, -1e-6])
def test_a_spring_rises_all_the_way(lowest, slope):
    """K1 + 2 K2 u + 3 K3 u^2 has its least value `slope` at `lowest`; at both ends it is positive."""
    K3 = 0.5
    K2 = -3.0 * K3 * lowest
    values = {"K1": slope + 3.0 * K3 * lowest**2, "K2": K2, "K3": K3, "C1": 0.01, "low": 0.75, "high": 1.0}
    if slope > 0.0:
        element = CubicContact(**values)
        assert np.all(np.diff(element.spring(np.linspace(0.75, 1.0, 500))) > 0.0)
    else:
        with pytest.raises(InputError, match="must be > 0") as caught:
            CubicContact(**values)
        assert caught.value.field == f"spring tangent at approach {lowest:g}"
        assert caught.value.value == pytest.approx(slope, rel=1e-6)
    outside = {**values, "low": 1.0, "high": 1.2}  # where it falls does not matter beyond the interval
    assert CubicContact(**outside).stiffness(1.1, 0.0) > 0.0


def test_negative_tangent_advises_a_way_out():
    with pytest.raises(InputError, match="wider range"):
        CubicContact(3.0, 0.0, -1.2, 0.01, 0.75, 1.0)
