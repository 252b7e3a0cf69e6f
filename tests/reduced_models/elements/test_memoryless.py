"""Elements without memory: linear, cubic, polynomial, power law. Laws against slow twins, ends, bad numbers."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehlcontact.errors import InputError
from reduced_models import ContactRecord, SpringContact, fit
from reduced_models.elements.spring_law import O_LOW

U = np.concatenate([np.linspace(-2.0, 4.0, 241), [0.75, 1.0]])
V = np.linspace(-60.0, 60.0, 7)
TERMS = {"K1": 0.806, "C1": 0.004, "K2": 0.346, "C2": 0.002, "K3": 0.054, "C3": -0.001, "B4": 0.010}
ENDS = {"low": 0.75, "high": 1.0}
LAW = {"K": 0.95, "n": 1.7, "u0": 0.15, "F0": -0.05, "C1": 0.013}


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
    e = SpringContact.cubic(*spring, C1, low, low + width)
    for end in (e.low, e.high, e.law[O_LOW]):
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


BAD = [  # class, good numbers, changes, beginning of the field that is named
    *(
        (
            SpringContact.cubic,
            {"K1": 0.8, "K2": 0.3, "K3": 0.05, "C1": 0.01, "low": 0.75, "high": 1.0},
            changes,
            field,
        )
        for changes, field in (
            ({"C1": -0.1}, "C1"),
            ({"low": -0.1}, "spring force at low"),
            ({"K1": 3.0, "K2": 0.0, "K3": -1.2}, "spring tangent at high"),
            ({"K1": 0.7556, "K2": -0.875, "K3": 1 / 3}, "spring tangent at approach 0.875"),
            ({"K1": 1.7e308, "K2": 0.0, "K3": 0.0}, "spring at low"),
            ({"high": 1e300, "K3": 0.0}, "high"),
            ({"low": 1e-300, "K1": 1.0}, "spring at low"),
        )
    ),
    *(
        (SpringContact.polynomial, TERMS | ENDS | {"rate": 1.2}, changes, field)
        for changes, field in (
            ({"B4": -0.02}, "cycle damping"),
            ({"C3": -0.05}, "cycle damping"),
            ({"K1": -1.0}, "spring force at low"),
            ({"K1": 0.7556, "K2": -0.875, "K3": 1 / 3}, "spring tangent at approach 0.875"),
            ({"rate": 0.0}, "rate"),
        )
    ),
    *(
        (SpringContact.power, LAW | {"low": 0.4, "high": 1.6}, changes, field)
        for changes, field in (
            ({"K": -1.0}, "K"),
            ({"n": 0.0}, "n"),
            ({"C1": -1.0}, "C1"),
            ({"u0": -0.5}, "low + u0"),
            ({"F0": -3.0}, "spring"),
        )
    ),
]


@pytest.mark.parametrize(("kind", "good", "changes", "field"), BAD)
def test_bad_parameters_are_named(kind, good, changes, field):
    with pytest.raises(InputError) as caught:
        kind(**(good | changes))
    assert caught.value.field.startswith(field)


@pytest.mark.parametrize("lowest", [0.76, 0.875, 0.99])
@pytest.mark.parametrize("slope", [1e-6, -1e-6])
def test_a_spring_rises_all_the_way(lowest, slope):
    """K1 + 2 K2 u + 3 K3 u^2 has its least value `slope` at `lowest`; at both ends it is positive."""
    K3 = 0.5
    K2 = -3.0 * K3 * lowest
    values = {"K1": slope + 3.0 * K3 * lowest**2, "K2": K2, "K3": K3, "C1": 0.01, "low": 0.75, "high": 1.0}
    if slope > 0.0:
        element = SpringContact.cubic(**values)
        assert np.all(np.diff(element.spring(np.linspace(0.75, 1.0, 500))) > 0.0)
    else:
        with pytest.raises(InputError, match="must be > 0") as caught:
            SpringContact.cubic(**values)
        assert caught.value.field == f"spring tangent at approach {lowest:g}"
        assert caught.value.value == pytest.approx(slope, rel=1e-6)
    outside = {**values, "low": 1.0, "high": 1.2}  # where it falls does not matter beyond the interval
    assert SpringContact.cubic(**outside).stiffness(1.1, 0.0) > 0.0


def test_negative_tangent_advises_a_way_out():
    with pytest.raises(InputError, match="wider range"):
        SpringContact.cubic(3.0, 0.0, -1.2, 0.01, 0.75, 1.0)


@pytest.fixture
def polynomial():
    return SpringContact.polynomial(**TERMS, low=0.75, high=1.0, rate=1.2)


def test_inside_the_box_it_is_eq_11(polynomial):
    u, v = np.meshgrid(np.linspace(0.75, 1.0, 11), np.linspace(-1.2, 1.2, 13))
    t = TERMS
    powers = t["K1"] * u + t["K2"] * u**2 + t["K3"] * u**3 + t["C1"] * v + t["C2"] * v**2 + t["C3"] * v**3
    np.testing.assert_allclose(polynomial.force(u, v), powers + t["B4"] * u * v, rtol=1e-13)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("u", [0.5, 0.75, 0.9, 1.0, 1.3])
@pytest.mark.parametrize("v", [-1.2, 0.0, 1.2])
def test_tangents_are_continuous_across_the_box(polynomial, u, v):
    e = 1e-9
    for left, right in (((u - e, v), (u + e, v)), ((u, v - e), (u, v + e))):
        for name in ("force", "stiffness", "damping"):
            method = getattr(polynomial, name)
            assert method(*left) == pytest.approx(method(*right), abs=1e-6)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_beyond_the_largest_rate_only_a_viscous_damper_is_left(polynomial):
    assert polynomial.damping(0.9, 60.0) == pytest.approx(TERMS["C1"] + TERMS["B4"] * 0.9, rel=1e-9)
    power = [v * (polynomial.force(0.9, v) - polynomial.force(0.9, 0.0)) for v in (-60.0, 60.0)]
    assert min(power) > 0.0 or polynomial.force(0.9, -60.0) == 0.0


def test_without_a_rate_the_powers_go_on():
    element = SpringContact.polynomial(**(TERMS | {"C3": 0.001}), low=0.75, high=1.0)
    v = 30.0
    expected = TERMS["C1"] * v + TERMS["C2"] * v**2 + 0.001 * v**3 + TERMS["B4"] * 0.9 * v
    assert element.force(0.9, v) - element.force(0.9, 0.0) == pytest.approx(expected, rel=1e-12)


@pytest.fixture
def power():
    return SpringContact.power(**LAW, low=0.4, high=1.6)


@pytest.fixture
def swing():
    """A record of large motion that obeys LAW exactly."""
    T = np.linspace(0.0, 3.0, 301)
    u, v = 1.0 + 0.6 * np.sin(6.0 * T), 3.6 * np.cos(6.0 * T)
    f = LAW["K"] * (u + LAW["u0"]) ** LAW["n"] + LAW["F0"] + LAW["C1"] * v
    return ContactRecord(T, u, v, f)


def test_inside_it_is_the_power_law(power):
    u, v = np.meshgrid(np.linspace(0.4, 1.6, 25), np.linspace(-20.0, 20.0, 9))
    expected = np.maximum(0.0, 0.95 * (u + 0.15) ** 1.7 - 0.05 + 0.013 * v)
    np.testing.assert_allclose(power.force(u, v), expected, rtol=1e-13)


def test_exact_record_gives_its_law_back(swing):
    result = fit(swing, "power", window=(0.0, 3.0))
    assert result.parameters == pytest.approx(LAW, rel=1e-3)
    assert result.rms < 1e-6 and result.root == pytest.approx(result.element.approach_at(1.0))


@pytest.mark.long
def test_jacobian_covariance_is_the_scatter_over_many_records(swing):
    def exponent(seed):
        noise = 3e-3 * np.random.default_rng(seed).standard_normal(len(swing))
        return fit(replace(swing, force=swing.force + noise), "power")

    results = [exponent(seed) for seed in range(40)]
    scatter = np.std([r.parameters["C1"] for r in results])
    assert results[0].std_errors["C1"] == pytest.approx(scatter, rel=0.35)
    covered = [r.intervals["C1"][0] <= LAW["C1"] <= r.intervals["C1"][1] for r in results]
    assert np.mean(covered) >= 0.85


def test_exponent_without_evidence_is_that_of_hertz(record):
    """A cubic record of a tenth of the approach: n = 3/2 fits it as well as any other."""
    noise = 1e-3 * np.random.default_rng(3).standard_normal(len(record))
    result = fit(replace(record, force=record.force + noise), "power")
    assert result.parameters["n"] == 1.5
    low, high = result.intervals["n"]
    assert high - low > 1.0
    cubic = fit(replace(record, force=record.force + noise))
    assert result.rms <= 1.02 * cubic.rms and result.tangent == pytest.approx(cubic.tangent, rel=0.01)


def test_record_without_curvature_names_its_columns(record):
    still = replace(record, approach=np.full(301, 0.87), rate=np.zeros(301))
    with pytest.raises(InputError, match="columns"):
        fit(still, "power")
