"""The film of a 6205, VG 68 at 50 C, under 1 kN: against an independent prototype of the same."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from reduced_models import BallBearing
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.race import shared_atlas
from reduced_models.bearing.race_table import tabulate_race
from reduced_models.bearing.ring import StaticRing, ring_equilibrium

DOWN = np.array([0.0, -1000.0])
SPEEDS = (1000.0, 3000.0, 6000.0)
ON = -pi / 2.0


def as_the_prototype(bearing, rpm, load, omega):
    """K + i C, mean over a ball passage, with laws of elements about the most loaded ball alone.

    So had it the prototype: light balls are beyond these laws, which hold their gains there.
    """
    elements = [
        replace(shared_atlas(None).element(bearing.race(race).point(487.0, rpm), "wide"), inlet_saturation=0.0)
        for race in ("inner", "outer")
    ]
    inner, outer = (tabulate_race([element]) for element in elements)
    balls = bearing.tables.balls(rpm)._replace(inner=inner, outer=outer)
    angles = [ON + 2.0 * pi / 9.0 * k / 4.0 for k in range(4)]
    at = [ring_equilibrium(StaticRing(balls, angle, 2, np.zeros(5)), load) for angle in angles]
    K, C = LinearBalls.of(balls, at, balls.loss, 0.0).coefficients(np.array([omega]))
    return K[0] + 1j * C[0]


@pytest.mark.parametrize(("rpm", "expected"), list(zip(SPEEDS, (285.0, 188.0, 140.0), strict=True)))
def test_damping_in_the_direction_of_the_load(film, oil, rpm, expected):
    prototype = as_the_prototype(film, rpm, DOWN, 50.0)[1, 1].imag
    assert prototype == pytest.approx(expected, rel=0.02)
    # Our laws go on to the lightest loads of the atlas, where films damp less than about the most loaded ball: so
    # the unloaded half of the balls, which held a tenth of the prototype's damping, hardly counts.
    ours = film.coefficients(DOWN, speed_rpm=rpm, hz=50.0).damping[0, 1, 1]
    assert 0.9 * prototype < ours < 0.93 * prototype
    loaded = BallBearing.catalogue("6205", oil=oil, cutoff_gap=5e-6)
    assert 0.96 * ours < loaded.coefficients(DOWN, speed_rpm=rpm, hz=50.0).damping[0, 1, 1] < ours


def test_damping_at_five_kilohertz(film):
    prototype = as_the_prototype(film, 3000.0, DOWN, 1e4 * pi)[1, 1].imag
    assert prototype == pytest.approx(94.0, rel=0.02)
    ours = film.coefficients(DOWN, speed_rpm=3000.0, hz=5000.0).damping[0, 1, 1]
    assert 0.84 * prototype < ours < 0.9 * prototype  # without what light balls had of it


@pytest.mark.parametrize(("rpm", "lateral"), list(zip(SPEEDS, (1.029, 1.062, 1.10), strict=True)))
def test_stiffness_beside_dry(film, dry, rpm, lateral):
    wet, without = (b.equilibrium(DOWN, **s).stiffness for b, s in ((film, {"speed_rpm": rpm}), (dry, {})))
    assert wet[0, 0] / without[0, 0] == pytest.approx(lateral, rel=0.02)
    assert 0.004 <= 1.0 - wet[1, 1] / without[1, 1] <= 0.012


def test_static_swing_of_a_ball_passage(film, dry):
    for bearing, speed, expected in ((film, {"speed_rpm": 3000.0}, 68e-9), (dry, {}, 60e-9)):
        on, between = (
            bearing.equilibrium(DOWN, cage_angle=ON + a, **speed).displacement[1] for a in (0.0, pi / 9.0)
        )
        assert between - on == pytest.approx(expected, rel=0.02)
        assert bearing.coefficients(DOWN, hz=0.0, **speed).peak_to_peak[1] == pytest.approx(between - on, rel=1e-3)


def test_means_under_half_a_kilonewton(film):
    prototype = as_the_prototype(film, 3000.0, 0.5 * DOWN, 1256.0)
    np.testing.assert_allclose(prototype.real.diagonal(), (6.50e7, 8.36e7), rtol=0.02)
    found = film.coefficients(0.5 * DOWN, speed_rpm=3000.0, hz=200.0)
    np.testing.assert_allclose(np.diag(found.stiffness[0]), (6.50e7, 8.36e7), rtol=0.02)
    assert prototype[1, 1].imag == pytest.approx(189.0, rel=0.02)
    assert 0.88 < found.damping[0, 1, 1] / prototype[1, 1].imag < 0.92
    assert abs(found.stiffness[0, 0, 1]) < 1e-6 * found.stiffness[0, 0, 0]


def test_damping_over_stiffness(film):
    """ROSS has 1.25e-5 s for any bearing; ours leaves out all that is no film: fits, housing, seals, grease."""
    found = film.coefficients(DOWN, speed_rpm=3000.0, hz=50.0)
    assert 1.55e-6 < found.damping[0, 1, 1] / found.stiffness[0, 1, 1] < 1.65e-6


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_films_are_those_of_the_atlas(film, race):
    state = film.equilibrium(DOWN, speed_rpm=3000.0)
    column = ("inner", "outer").index(race)
    for k in (0, 1, 2):
        answer = shared_atlas(None).at(film.race(race).point(state.force[k, column], 3000.0))
        assert state.h_central[k, column] == pytest.approx(answer.h_central, rel=1e-9)
        assert state.h_min[k, column] == pytest.approx(answer.h_min, rel=1e-9)
    assert np.all(state.h_central[4:6] > state.h_central[0])


def test_outer_race_carries_the_balls_round(film):
    state = film.equilibrium(DOWN, speed_rpm=6000.0)
    cage = 6000.0 * pi / 30.0 * 0.5 * (1.0 - film.gamma)
    ball = 7800.0 * pi / 6.0 * film.ball_diameter**3
    np.testing.assert_allclose(np.diff(state.force)[:, 0], ball * 0.5 * film.pitch_diameter * cage**2, rtol=1e-9)
    carried = state.force[:, 0] @ np.column_stack([np.cos(state.angles), np.sin(state.angles)])
    np.testing.assert_allclose(carried, DOWN, atol=1e-8)


def test_light_balls_do_not_warn(film):
    """They carry less than the atlas goes down to; warnings are errors here."""
    state = film.equilibrium(DOWN, speed_rpm=3000.0)
    assert state.force[:, 0].min() < film.race("inner").loads(3000.0)[0]


def test_unloaded_films_let_go(oil):
    limited = BallBearing.catalogue("6205", oil=oil, cutoff_gap=2e-6).equilibrium(DOWN, speed_rpm=3000.0)
    assert np.count_nonzero(limited.force[:, 0] == 0.0) == 4
    assert np.all(limited.force[:, 1] > 0.6)  # thrown against the outer race


def test_clearance_narrows_and_preload_widens_the_load_zone(oil):
    loaded = [
        BallBearing.catalogue("6205", oil=oil, clearance=c).equilibrium(DOWN, speed_rpm=3000.0).loaded
        for c in (2e-5, 0.0, -3e-5)
    ]
    assert loaded == sorted(loaded)
    assert loaded[0] < loaded[2] == 9
