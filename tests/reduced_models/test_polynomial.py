"""The seven-term element: eq. 11 inside the box, smooth and harmless outside."""

import numpy as np
import pytest

from ehlcontact.errors import InputError
from reduced_models import PolynomialContact

TERMS = {"K1": 0.806, "C1": 0.004, "K2": 0.346, "C2": 0.002, "K3": 0.054, "C3": -0.001, "B4": 0.010}


@pytest.fixture
def element():
    return PolynomialContact(**TERMS, low=0.75, high=1.0, rate=1.2)


def test_inside_the_box_it_is_eq_11(element):
    u, v = np.meshgrid(np.linspace(0.75, 1.0, 11), np.linspace(-1.2, 1.2, 13))
    t = TERMS
    powers = t["K1"] * u + t["K2"] * u**2 + t["K3"] * u**3 + t["C1"] * v + t["C2"] * v**2 + t["C3"] * v**3
    np.testing.assert_allclose(element.force(u, v), powers + t["B4"] * u * v, rtol=1e-13)


def test_tangents_are_differences_of_the_force_everywhere(element):
    h = 1e-6
    u, v = np.meshgrid(np.linspace(-0.49, 2.013, 53), np.linspace(-40.0, 40.0, 17))
    smooth = np.minimum(element.force(u - h, v), element.force(u + h, v)) > 0.0
    smooth &= element.force(u, v) > 1e-3
    du = (element.force(u + h, v) - element.force(u - h, v)) / (2 * h)
    dv = (element.force(u, v + h) - element.force(u, v - h)) / (2 * h)
    assert smooth.sum() > 300
    np.testing.assert_allclose(element.stiffness(u, v)[smooth], du[smooth], rtol=2e-6, atol=1e-6)
    np.testing.assert_allclose(element.damping(u, v)[smooth], dv[smooth], rtol=2e-6, atol=1e-7)


@pytest.mark.parametrize("u", [0.5, 0.75, 0.9, 1.0, 1.3])
@pytest.mark.parametrize("v", [-1.2, 0.0, 1.2])
def test_tangents_are_continuous_across_the_box(element, u, v):
    e = 1e-9
    for left, right in (((u - e, v), (u + e, v)), ((u, v - e), (u, v + e))):
        for name in ("force", "stiffness", "damping"):
            method = getattr(element, name)
            assert method(*left) == pytest.approx(method(*right), abs=1e-6)


def test_beyond_the_largest_rate_only_a_viscous_damper_is_left(element):
    assert element.damping(0.9, 60.0) == pytest.approx(TERMS["C1"] + TERMS["B4"] * 0.9, rel=1e-9)
    power = [v * (element.force(0.9, v) - element.force(0.9, 0.0)) for v in (-60.0, 60.0)]
    assert min(power) > 0.0 or element.force(0.9, -60.0) == 0.0


def test_scalars_and_arrays_agree(element):
    u = np.linspace(-1.0, 2.0, 31)
    for name in ("force", "stiffness", "damping"):
        method = getattr(element, name)
        np.testing.assert_array_equal(method(u, 0.7), [method(float(x), 0.7) for x in u])


def test_rate_at_inverts_the_force(element):
    for u, v in ((0.8, -0.9), (0.95, 1.1), (0.7, 2.0)):
        f = element.force(u, v)
        assert f > 0.0 and element.rate_at(u, f) == pytest.approx(v, rel=1e-9)


def test_si_element_is_the_same_law(element, scales):
    si, s = element.to_si(scales), scales
    u, v = np.meshgrid(np.linspace(0.0, 1.5, 9), np.linspace(-3.0, 3.0, 7))
    np.testing.assert_allclose(si.force(u * s.length, v * s.rate), s.force * element.force(u, v), rtol=1e-11)
    assert si.rate == pytest.approx(1.2 * s.rate)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"B4": -0.02}, "cycle damping"),
        ({"C3": -0.05}, "cycle damping"),
        ({"K1": -1.0}, "spring force at low"),
        ({"C2": np.nan}, "C2"),
        ({"rate": 0.0}, "rate"),
    ],
)
def test_laws_that_make_no_contact_are_refused(changes, field):
    with pytest.raises(InputError) as caught:
        PolynomialContact(**(TERMS | {"low": 0.75, "high": 1.0, "rate": 1.2} | changes))
    assert caught.value.field.startswith(field)


def test_without_a_rate_the_powers_go_on():
    element = PolynomialContact(**(TERMS | {"C3": 0.001}), low=0.75, high=1.0)
    v = 30.0
    expected = TERMS["C1"] * v + TERMS["C2"] * v**2 + 0.001 * v**3 + TERMS["B4"] * 0.9 * v
    assert element.force(0.9, v) - element.force(0.9, 0.0) == pytest.approx(expected, rel=1e-12)
