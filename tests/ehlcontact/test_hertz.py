"""Hertz contact and film formulas."""

from math import pi

import oracles
import pytest

from ehlcontact import InputError
from ehlcontact.film_formulas import nvm_central_film, wijnant_approach
from ehlcontact.hertz import ellipse_ratio, elliptic_integrals, hertz_contact, radius_ratio, shape_factor

KAPPAS = [0.02, 0.08, 0.107, 0.5, 0.9, 0.9995, 1.0, 1.0004, 1.7, 12.0]


@pytest.mark.parametrize("kappa", KAPPAS)
def test_elliptic_integrals(kappa):
    assert elliptic_integrals(kappa) == pytest.approx(oracles.agm_integrals(kappa), rel=1e-12)


@pytest.mark.parametrize("kappa", KAPPAS)
def test_shape_factor(kappa):
    tolerance = 1e-10 if abs(kappa - 1.0) > 1e-2 else 1e-8  # 0/0 in the oracle
    assert shape_factor(kappa) == pytest.approx(oracles.hertz_gap_share(kappa), rel=tolerance)


def test_circle():
    assert shape_factor(1.0) == 0.5
    assert radius_ratio(1.0) == 1.0
    assert ellipse_ratio(0.02, 0.02) == pytest.approx(1.0, abs=1e-12)
    c = hertz_contact(30.0, 0.02, 0.02, 2e11)
    a = (1.5 * 30.0 * 0.02 / 2e11) ** (1.0 / 3.0)  # Johnson (4.22) with E* = E'/2, R = Rx
    assert c.a == pytest.approx(a, rel=1e-12, abs=0.0)
    assert c.b == pytest.approx(a, rel=1e-12, abs=0.0)
    assert c.approach == pytest.approx(a**2 / 0.02, rel=1e-12, abs=0.0)
    assert c.pressure == pytest.approx(1.5 * 30.0 / (pi * a**2), rel=1e-12, abs=0.0)


@pytest.mark.parametrize("offset", [1e-4, 5.0e-4, 5.1e-4, 1e-3])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_series_at_the_circle_joins_the_formula(offset, sign):
    """S is smooth through kappa = 1: slope dS/dm = -1/16, no step where the series takes over."""
    kappa = 1.0 + sign * offset
    m = 1.0 - kappa**2
    assert shape_factor(kappa) == pytest.approx(0.5 - m / 16.0 - m * m / 32.0, abs=1e-9)


@pytest.mark.parametrize("kappa", [0.05, 0.3, 0.999, 2.5])
def test_swapping_both_axes(kappa):
    assert shape_factor(kappa) + shape_factor(1.0 / kappa) == pytest.approx(1.0, abs=1e-9)
    assert radius_ratio(kappa) * radius_ratio(1.0 / kappa) == pytest.approx(1.0, rel=1e-8, abs=0.0)
    rx, ry = 0.01, 0.01 / radius_ratio(kappa)
    one, other = hertz_contact(100.0, rx, ry, 2e11), hertz_contact(100.0, ry, rx, 2e11)
    assert (one.a, one.b) == pytest.approx((other.b, other.a), rel=1e-9, abs=0.0)
    assert (one.approach, one.pressure) == pytest.approx((other.approach, other.pressure), rel=1e-9, abs=0.0)
    assert one.kappa * other.kappa == pytest.approx(1.0, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("ratio", [0.03, 0.35, 0.8])
def test_against_the_oracle(ratio):
    c = hertz_contact(500.0, 0.004, 0.004 / ratio, 2.26e11)
    a, b, p, approach = oracles.hertz_si(500.0, 0.004, 0.004 / ratio, 2.26e11)
    assert (c.a, c.b, c.pressure, c.approach) == pytest.approx((a, b, p, approach), rel=1e-9, abs=0.0)


@pytest.mark.literature
def test_kappa_half():
    """By tables of elliptic integrals: kappa = 0.5 has K = 2.15652, E = 1.21106, Rx/Ry = 0.35177, S = 0.4155."""
    assert elliptic_integrals(0.5) == pytest.approx((2.15652, 1.21106), abs=6e-6)
    assert radius_ratio(0.5) == pytest.approx(0.35177, abs=6e-6)
    assert shape_factor(0.5) == pytest.approx(0.4155, abs=1e-4)


@pytest.mark.parametrize("kappa", [0.011, 0.2, 1.0, 33.0])
def test_round_trip(kappa):
    assert ellipse_ratio(radius_ratio(kappa), 1.0) == pytest.approx(kappa, rel=1e-9)


def test_extreme_radii_are_refused():
    with pytest.raises(InputError, match="radius_x/radius_y"):
        ellipse_ratio(1e-9, 1.0)


pytestmark = pytest.mark.literature


@pytest.mark.parametrize(
    ("M", "L", "kappa", "expected"),
    [
        (20, 10, 1.0, 4.708),
        (58.07, 4.62, 1.0, 3.012),
        (200, 10, 1.0, 4.380),
        (1000, 10, 1.0, 4.035),
        (20, 0, 1.0, 1.448),
        (200, 10, 0.5, 5.195),
    ],
)
def test_nvm(M, L, kappa, expected):
    assert nvm_central_film(M, L, kappa) == pytest.approx(expected, abs=6e-4)


def test_nvm_is_continuous_at_l_zero():
    assert nvm_central_film(20, 1e-6, 1.0) == pytest.approx(nvm_central_film(20, 0.0, 1.0), rel=1e-4)


@pytest.mark.parametrize(
    ("M", "L", "kappa", "expected"),
    [(58.07, 4.62, 1.0, 0.8535), (200, 10, 1.0, 0.9224), (200, 10, 0.5, 0.8842), (26.159, 8.358, 1.0, 0.6573)],
)
def test_wijnant(M, L, kappa, expected):
    assert wijnant_approach(M, L, kappa) == pytest.approx(expected, abs=6e-5)
