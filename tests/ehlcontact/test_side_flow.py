"""Side flow of thin layers: closed form, and films pass after pass."""

from itertools import islice, pairwise
from math import pi

import numpy as np
import pytest
from scipy.integrate import quad

from ehlcontact import Grid, InputError, Lubricant, MoesPoint, OilLayer, OperatingPoint
from ehlcontact.lubricant import density
from ehlcontact.side_flow import layer_after_passes, oil_passes, side_flow

CIRCLE = MoesPoint(20, 10, 1)
SMALL = Grid(64)
FULL = 0.4955  # layer that the flooded film of the circle lets through
OIL = Lubricant(eta0=0.0255, alpha=1.62e-8, viscosity="barus", density="incompressible")


def ball(**given):
    usual = {
        "ball_diameter": 7.938e-3,
        "pitch_diameter": 33.5e-3,
        "conformity": 0.52,
        "speed_rpm": 1e4,
        "load": 300.0,
    }
    return OperatingPoint.ball_bearing(OIL, **usual | given)


def integral(a):
    """``int exp(-a sin theta)`` over the ellipse's middle line, of Barus' law and an incompressible oil."""
    return 2.0 * quad(lambda theta: np.exp(-a * np.sin(theta)), 0.0, 0.5 * pi, epsabs=0.0, epsrel=1e-10)[0]


@pytest.mark.parametrize("L", [0.0, 2.0, 10.0, 25.0])
def test_integral_over_the_ellipse(L):
    """The formula of the paper is within 4 % of it from alpha p_h = 8 on."""
    point = MoesPoint(200, L, 0.5, viscosity="barus", density="incompressible")
    found = side_flow(point) * point.lam / (2.0 * point.kappa**2)
    assert found == pytest.approx(integral(point.alpha_bar), rel=1e-9)
    if point.alpha_bar > 8.0:
        assert found == pytest.approx(pi * ((0.5 * pi * point.alpha_bar) ** 1.5 + 1.0) ** (-2.0 / 3.0), rel=0.04)


def test_decay_in_time_is_that_of_the_paper():
    """``h^-2 = h0^-2 + F t/6``, F = (2/l) (p_h/b^2) (a/eta0) times the integral, for two tracks of length l/2."""
    point = ball()
    scales = point.scales
    F = 2.0 * scales.pressure * scales.a / (scales.b**2 * OIL.eta0) * integral(point.moes.alpha_bar)  # times l
    passes_each_second = 0.5 * point.u_sum / 0.5  # times l
    assert side_flow(point) * passes_each_second == pytest.approx(F / 6.0, rel=1e-9)
    assert side_flow(ball(speed_rpm=5e3)) == pytest.approx(
        2.0 * side_flow(point), rel=1e-9
    )  # twice as long under it
    assert layer_after_passes(point, 1e-7, [0, 50])[0] == pytest.approx(1e-7)


def test_twelve_passes_follow_the_closed_form():
    """A layer that stays as it is would be 25 % off."""
    start = 0.3 * FULL
    films = list(islice(oil_passes(CIRCLE, OilLayer(H=start), grid=Grid(128)), 12))
    left = [film.layer_behind[0] for film in films]
    np.testing.assert_allclose(left, layer_after_passes(CIRCLE, start, np.arange(1, 13)), rtol=0.015)
    first, last = 1.0 - left[0] / start, start**-2 - left[-1] ** -2
    assert first == pytest.approx(0.0219, rel=0.1)
    assert last == pytest.approx(-12 * side_flow(CIRCLE), rel=0.08)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("point", "n", "full", "within"), [(CIRCLE, 256, FULL, 0.03), (MoesPoint(200, 10, 0.5), 256, 0.1386, 0.03)]
)
def test_a_hundred_passes_follow_the_closed_form(point, n, full, within):
    start = 0.3 * full
    *_, last = islice(oil_passes(point, OilLayer(H=start), grid=Grid(n)), 100)
    expected = float(layer_after_passes(point, start, 100))
    assert expected < 0.8 * start
    assert last.layer_behind[0] == pytest.approx(expected, rel=within)


def test_oil_pressed_aside_lies_beside_the_track():
    films = list(islice(oil_passes(CIRCLE, OilLayer(H=0.3), grid=SMALL, tol=1e-8), 4))
    lines = np.ones(films[0].y.size)
    lines[0], lines[-1] = 0.5, 0.0
    flows = [lines @ films[0].layer, *(lines @ film.layer_behind for film in films)]
    np.testing.assert_allclose(flows, flows[0], rtol=1e-6)
    assert films[-1].layer_behind.max() > 0.4
    assert films[-1].layer_behind[0] < 0.25
    for last, film in pairwise(films):
        np.testing.assert_allclose(film.layer, last.layer_behind, rtol=1e-12)


def test_a_ball_carries_its_half_from_race_to_race():
    inner, outer = ball(), ball(race="outer")
    films = list(islice(oil_passes([inner, outer], OilLayer(0.2e-6), grid=SMALL), 3))
    assert [film.point.scales.b for film in films] == [inner.scales.b, outer.scales.b, inner.scales.b]

    def half(film):
        return film.y, 0.5 * film.layer_behind

    y = films[1].y
    np.testing.assert_allclose(films[1].layer, 0.1e-6 + np.interp(y, *half(films[0])), rtol=2e-3)
    y = films[2].y
    expected = np.interp(y, *half(films[0])) + np.interp(y, *half(films[1]))
    np.testing.assert_allclose(films[2].layer, expected, rtol=1e-9)


def test_refused():
    with pytest.raises(InputError, match="OperatingPoints, where there are several"):
        oil_passes([CIRCLE, CIRCLE], OilLayer(H=0.1))
    with pytest.raises(InputError, match=r"an OilLayer\(h, ...\)"):
        oil_passes(CIRCLE, 1e-7)
    with pytest.raises(InputError, match="one or more"):
        oil_passes([], OilLayer(H=0.1))
    with pytest.raises(InputError, match="layer"):
        layer_after_passes(CIRCLE, 0.0, 3)
    for wrong in (-1, np.nan, [1.0, np.inf]):
        with pytest.raises(InputError, match="passes"):
            layer_after_passes(CIRCLE, 0.1, wrong)


def test_full_layer_of_the_circle():
    assert FULL == pytest.approx(float(density(1.0, CIRCLE.law)[0]) * 0.432, rel=2e-3)
