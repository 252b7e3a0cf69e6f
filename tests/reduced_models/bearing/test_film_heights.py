"""Heights in runs of bearings in oil: against the contact filter of films, wave by wave."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import Lubricant
from reduced_models import BallBearing, BallDiameter, BallWaviness, RaceWaviness, Spall
from reduced_models.atlas.waves import contact_filter
from reduced_models.bearing.contact_heights import table_height
from reduced_models.bearing.film_heights import heights_in_runs, mean_film_speed
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.height_tables import track_radius
from reduced_models.bearing.motion import motion_of

DRY = BallBearing.catalogue("6205", clearance=15e-6)
OILED = replace(DRY, oil=Lubricant.iso_vg(68, temperature=50.0))
RPM, AMPLITUDE = 3000.0, 1e-9
PIT = Spall(race="outer", angle=1.0, length=5e-4, depth=2e-6, edge=1e-4)


def wave(track, n):
    name = "inner" if track == "inner" else "outer"
    if track.startswith("ball"):
        return BallWaviness(ball=2, waves=n, amplitude=AMPLITUDE), 0.5 * DRY.ball_diameter
    return RaceWaviness(race=name, waves=n, amplitude=AMPLITUDE), track_radius(DRY, name)


@pytest.mark.parametrize("track", ["inner", "outer", "ball inner", "ball outer"])
@pytest.mark.parametrize("length", [8.0, 4.0])
def test_waves_have_the_filter_of_their_film(track, length):
    """G/Z at three loads and five places, within 0.01 of the height; conjugate on the inner race alone."""
    race = track.split()[-1]
    heaviest = OILED.race(race).point(1000.0, RPM)
    n = round(2.0 * pi * wave(track, 1)[1] / (length * heaviest.scales.a))
    feature, radius = wave(track, n)
    heights = heights_in_runs(replace(OILED, features=[feature]), [RPM])
    table = int(heights[0, 3 if "ball" in track else 0, 1 + (race == "outer")])
    for load in (30.0, 300.0, 1000.0):
        point = OILED.race(race).point(load, RPM)
        ratio = contact_filter(point, wavelength=2.0 * pi * radius / n).ratio[0]
        ratio = ratio.conj() if track == "inner" else ratio
        for angle in np.linspace(0.0, 2.0 * pi / n, 5):
            found = table_height(heights, table, angle, point.scales.length) / AMPLITUDE
            assert found == pytest.approx((ratio * np.exp(1j * n * angle)).real, abs=0.01)


@pytest.mark.long
@pytest.mark.parametrize("race", ["inner", "outer"])
def test_films_keep_the_volume_of_a_spall_and_round_its_edges(race):
    bearing = replace(OILED, features=[replace(PIT, race=race)])
    heights, column = heights_in_runs(bearing, [RPM]), 8
    film, dry = (one[1, :-1, column] for one in (heights, bearing.tables.heights))
    assert film.mean() == pytest.approx(dry.mean(), rel=1e-9, abs=0.0)
    assert np.abs(np.diff(film)).max() < 0.95 * np.abs(np.diff(dry)).max()
    assert dry.min() < film.min() and film.max() < 0.002 * PIT.depth


def test_dry_bearings_smooth_ones_and_equilibria_have_the_tables_as_they_are():
    dry, oiled = replace(DRY, features=[PIT]), replace(OILED, features=[PIT])
    for directions in (PLANAR, FIVE):
        assert motion_of(dry, [RPM], directions).balls.heights is dry.tables.heights
        assert motion_of(OILED, [RPM], directions).balls.heights is OILED.tables.heights
        assert motion_of(oiled, [RPM], directions).balls.heights is heights_in_runs(oiled, [RPM])
    np.testing.assert_array_equal(oiled.tables.balls(RPM).heights, dry.tables.heights)
    assert np.abs(heights_in_runs(oiled, [RPM]) - dry.tables.heights).max() > 0.1 * PIT.depth


def test_balls_of_another_diameter_have_no_filter():
    bearing = replace(OILED, features=[BallDiameter(ball=1, excess=1e-6)])
    np.testing.assert_array_equal(heights_in_runs(bearing, [RPM]), bearing.tables.heights)


@pytest.mark.long
def test_films_of_a_changing_speed():
    """One speed for all, whose central film is the mean of those at both ends within 2 %."""
    ends, race = (600.0, 6000.0), OILED.race("outer")
    speed = mean_film_speed(*ends)
    low, high, mean = (race.answer(300.0, one).h_central for one in (*ends, speed))
    assert mean == pytest.approx(0.5 * (low + high), rel=0.02)
    bearing = replace(OILED, features=[PIT])
    np.testing.assert_array_equal(
        heights_in_runs(bearing, [600.0, 2000.0, 6000.0]), heights_in_runs(bearing, [speed])
    )
    assert mean_film_speed(RPM, RPM) == RPM
