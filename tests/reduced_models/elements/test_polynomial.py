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


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("u", [0.5, 0.75, 0.9, 1.0, 1.3])
@pytest.mark.parametrize("v", [-1.2, 0.0, 1.2])
def test_tangents_are_continuous_across_the_box(element, u, v):
    e = 1e-9
    for left, right in (((u - e, v), (u + e, v)), ((u, v - e), (u, v + e))):
        for name in ("force", "stiffness", "damping"):
            method = getattr(element, name)
            assert method(*left) == pytest.approx(method(*right), abs=1e-6)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_beyond_the_largest_rate_only_a_viscous_damper_is_left(element):
    assert element.damping(0.9, 60.0) == pytest.approx(TERMS["C1"] + TERMS["B4"] * 0.9, rel=1e-9)
    power = [v * (element.force(0.9, v) - element.force(0.9, 0.0)) for v in (-60.0, 60.0)]
    assert min(power) > 0.0 or element.force(0.9, -60.0) == 0.0


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"B4": -0.02}, "cycle damping"),
        ({"C3": -0.05}, "cycle damping"),
        ({"K1": -1.0}, "spring force at low"),
        ({"K1": 0.7556, "K2": -0.875, "K3": 1 / 3}, "spring tangent at approach 0.875"),
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
