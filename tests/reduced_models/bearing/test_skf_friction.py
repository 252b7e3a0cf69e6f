"""SKF's published moment of friction: numbers by hand, limits, trends, and its sum with the films of a bearing."""

from math import exp, pi, radians, sin

import pytest

from ehlcontact import Lubricant
from ehlcontact.errors import InputError
from reduced_models import BallBearing
from reduced_models.bearing.skf_friction import GREASE, boundary_diameters, skf_friction
from reduced_models.life.load_ratings import static_rating

CASE = {"radial": 1000.0, "speed_rpm": 3000.0, "kinematic_viscosity": 40e-6}


def test_a_6205_under_radial_load_step_by_step():
    """dm 38.5 mm, nu n 120000: G_rr = 3.9e-7 x 1280.9 x 41.687, G_sl = 3.23e-3 x .38707 x 1e5; full film."""
    found = skf_friction("6205", **CASE)
    variable = 3.9e-7 * 1280.9 * 41.687
    ish = 1.0 / (1.0 + 1.84e-9 * 115500.0**1.28 * 40.0**0.64)  # 1/(1 + .0590)
    rs = exp(-3e-8 * 120000.0 * 77.0 * (3.1 / 54.0) ** 0.5)  # exp(-.0664)
    assert ish == pytest.approx(0.945, abs=2e-3) and rs == pytest.approx(0.936, abs=1e-3)
    assert found.rolling == pytest.approx(1e-3 * ish * rs * variable * 120000.0**0.6, rel=1e-4)
    assert found.rolling == pytest.approx(20.6e-3, abs=0.1e-3)
    # phi_bl = exp(-2.6e-8 x 120000^1.4 x 38.5) = exp(-12.9)
    assert found.sliding == pytest.approx(1e-3 * 3.23e-3 * 0.38707 * 1e5 * 0.05, rel=1e-4)
    assert found.total == found.rolling + found.sliding


def test_a_6305_under_combined_load():
    """dm 43.5 mm, Fa/C0 = .05: angle 24.6 x .05^.24 = 11.99 degrees."""
    found = skf_friction("6305", axial=-580.0, static_rating=11600.0, **CASE)
    slope = sin(radians(24.6 * 0.05**0.24))
    assert slope == pytest.approx(0.2077, abs=1e-4)
    sliding = 2.84e-3 * 43.5**-0.145 * (1e15 + 92.8 * 43.5**1.5 * 580.0**4 / slope) ** (1 / 3) * 0.05
    assert found.sliding == pytest.approx(1e-3 * sliding, rel=1e-4)
    rolling = skf_friction("6305", **CASE).rolling
    assert found.rolling / rolling == pytest.approx((1.0 + 1.7 * 0.58 / slope) ** 0.54, rel=1e-9)


def test_limits_and_trends():
    still = skf_friction("6205", **CASE | {"speed_rpm": 0.0})
    assert still.rolling == 0.0
    assert still.sliding == pytest.approx(0.12 / 0.05 * skf_friction("6205", **CASE).sliding, rel=1e-4)
    assert skf_friction("6205", **CASE | {"radial": 0.0}).total == 0.0
    thin, thicker = (skf_friction("6205", **CASE | {"kinematic_viscosity": nu}) for nu in (1e-9, 4e-9))
    assert thin.rolling == pytest.approx(0.25**0.6 * thicker.rolling, rel=1e-3)
    assert thin.sliding == pytest.approx(still.sliding, rel=1e-2)
    totals = [skf_friction(f"6{k}05", **CASE).total for k in (0, 2, 3, 4)]
    assert totals == sorted(totals)
    assert skf_friction("6205", replenishment=GREASE, **CASE).rolling < skf_friction("6205", **CASE).rolling
    loads = [
        skf_friction("6205", axial=axial, static_rating=7800.0, **CASE).total
        for axial in (1.0, 100.0, 300.0, 900.0)
    ]
    assert loads == sorted(loads)


def test_static_ratings_are_those_of_catalogues():
    """C0 that SKF prints [N], within 4 %: 6000 1960, 6205 7800, 6305 11600."""
    for name, printed in (("6000", 1960.0), ("6205", 7800.0), ("6305", 11600.0)):
        assert static_rating(BallBearing.catalogue(name).tables.internals) == pytest.approx(printed, rel=0.04)


def test_a_state_has_the_sum_of_films_and_sliding(film, dry, oil):
    state = film.equilibrium((0.0, -1000.0), speed_rpm=3000.0)
    nu = film.oil.kinematic_viscosity
    published = skf_friction("6205", radial=1000.0, speed_rpm=3000.0, kinematic_viscosity=nu)
    assert (state.skf_rolling, state.skf_sliding) == pytest.approx(published)
    assert state.friction_torque == state.rolling_torque + published.sliding
    assert state.friction_loss == pytest.approx(state.friction_torque * 100.0 * pi)
    assert "friction 29.69 N mm, its sliding part by SKF" in str(state)
    assert state.to_dict()["skf_sliding"] == state.skf_sliding
    pushed = film.equilibrium((0.0, -1000.0, 300.0), speed_rpm=3000.0)
    assert pushed.skf_sliding > state.skf_sliding and pushed.skf_rolling > state.skf_rolling
    assert dry.equilibrium((0.0, -1000.0)).friction_torque is None
    own = BallBearing(balls=9, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, oil=oil)
    bare = own.equilibrium((0.0, -1000.0), speed_rpm=3000.0)
    assert bare.rolling_torque > 0.0 and bare.friction_torque is None and bare.friction_loss is None


def test_bad_input():
    for name in ("7205", "209", "6299", "6402", "UER204", ""):
        with pytest.raises(InputError, match="series 60, 62, 63 or 64"):
            boundary_diameters(name)
    with pytest.raises(InputError, match="C0"):
        skf_friction("6205", axial=10.0, **CASE)
    with pytest.raises(InputError, match="carries"):
        skf_friction("6205", axial=1e7, static_rating=7800.0, **CASE)
    with pytest.raises(InputError, match="kinematic_viscosity"):
        skf_friction("6205", **CASE | {"kinematic_viscosity": 0.0})
    nu = Lubricant.iso_vg(68, temperature=50.0).kinematic_viscosity
    assert nu == pytest.approx(CASE["kinematic_viscosity"], rel=0.1)
