"""What a bearing is made of, what it refuses, its states and files."""

import json
from math import pi

import numpy as np
import pytest
from refusals import refused

from ehlcontact import Lubricant, read, save
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingMotion, BearingSet
from reduced_models.bearing.catalogue import ROWS
from reduced_models.bearing.equilibrium_result import BearingState

DOWN = (0.0, -1000.0)
SIZES = {"balls": 9, "ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3}


def test_every_row_has_a_source():
    for name, row in ROWS.items():
        assert row.source
        assert row.sourced == ("derived" not in row.source)
        assert BallBearing.catalogue(name).name == name


def test_catalogue_and_dimensions_are_the_same():
    named, row = BallBearing.catalogue(" 6205 ", clearance=1e-5), ROWS["6205"]
    by_hand = BallBearing(
        balls=row.balls, ball_diameter=row.ball_diameter, pitch_diameter=row.pitch_diameter, clearance=1e-5
    )
    assert named.equilibrium(DOWN).displacement[1] == by_hand.equilibrium(DOWN).displacement[1]
    assert BallBearing.catalogue("6205", balls=8).balls == 8


@pytest.mark.parametrize(
    ("match", "changes"),
    [
        ("balls = 2: must be a whole number >= 3", {"balls": 2}),
        ("balls = 16: must be at most 15 on this pitch circle: they overlap", {"balls": 16}),
        ("conformity_outer = 0.5: must be above 0.5", {"conformity_outer": 0.5}),
        ("conformity_inner = 52.0: .*0.52", {"conformity_inner": 52.0}),
        ("ball_diameter = 7.94: .*mm", {"ball_diameter": 7.94}),
        ("pitch_diameter = 0.005: must be above ball_diameter", {"pitch_diameter": 5e-3}),
        ("clearance = 0.01: must be between -0.000397 and 0.000397 m", {"clearance": 0.01}),
        ("clearance = nan: must be a finite number", {"clearance": float("nan")}),
        ("oil = 68: must be a Lubricant", {"oil": 68}),
        ("rq_ball = -1.0: must be a finite number >= 0", {"rq_ball": -1.0}),
        ("cutoff_gap = 0.0: must be between 1e-09 and 0.01 m", {"cutoff_gap": 0.0}),
        ("youngs_modulus = 206.0: .*GPa", {"youngs_modulus": 206.0}),
        ("poisson_ratio = 0.6: must be between 0 and 0.5", {"poisson_ratio": 0.6}),
    ],
)
def test_what_is_no_bearing(match, changes):
    refused(match, lambda: BallBearing(**{**SIZES, **changes}))


def test_limits_of_the_conformity_on_the_atlas(oil):
    assert BallBearing(**SIZES, oil=oil, conformity_inner=0.505).highest_speed > 0.0
    said = refused("conformity_inner = 0.503", lambda: BallBearing(**SIZES, oil=oil, conformity_inner=0.503))
    limit = float(said.split("at least ")[1].split(":")[0].split()[0])
    assert 0.503 < limit < 0.505
    assert BallBearing(**SIZES, oil=oil, conformity_inner=limit + 1e-3).highest_speed > 0.0
    assert BallBearing(**SIZES, conformity_inner=0.503).equilibrium(DOWN).displacement[1] < 0.0  # dry
    assert BallBearing(**SIZES, oil=oil, conformity_outer=0.7).highest_speed > 0.0


def test_an_oil_that_is_none_of_the_atlas():
    refused("viscosity", lambda: BallBearing(**SIZES, oil=Lubricant(0.04, viscosity="barus")))


def test_unknown_names_with_the_nearest_ones():
    refused(
        "name = '6250': must be one of 6205, .* .nearest. or of 6000 to 6010",
        lambda: BallBearing.catalogue("6250"),
    )
    # no name of the catalogue begins with its first digit
    said = refused("name = '90206': must be one of", lambda: BallBearing.catalogue("90206"))
    assert "nearest" not in said and "6000 to 6010, 6200" in said and "218; any other bearing" in said


def test_speeds(film, dry):
    refused("speed_rpm = 0.0: must be > 0 for a bearing with oil", lambda: film.equilibrium(DOWN))
    said = refused("speed_rpm = 30000.0: must be at most", lambda: film.equilibrium(DOWN, speed_rpm=30000.0))
    highest = float(said.split("at most ")[1].split(",")[0])
    assert film.equilibrium(DOWN, speed_rpm=0.999 * highest).displacement[1] < 0.0
    refused("speed_rpm = -1.0", lambda: dry.equilibrium(DOWN, speed_rpm=-1.0))
    assert dry.equilibrium(DOWN, speed_rpm=30000.0).displacement[1] < 0.0
    refused("speed_rpm = 30000.0: must be at most", lambda: BearingMotion(film, 30000.0, 1e-5))


def test_steps_that_are_too_long_for_the_balls_are_refused(dry):
    passage = 1.0 / dry.frequencies(3000.0).bpfo
    for dt in (1e-2, passage / 15.9):
        refused(
            "dt = .*: must be at most .* s, a 16th of the ball passage",
            lambda dt=dt: BearingMotion(dry, 3000.0, dt),
        )
    assert BearingMotion(dry, 3000.0, passage / 16.1).dt == passage / 16.1
    assert BearingMotion(dry, 0.0, 1e-2).dt == 1e-2  # of a shaft that stands


def test_motions_that_are_no_numbers(dry):
    motion = BearingMotion(dry, 3000.0, 1e-5)
    refused(r"q\[0\] = nan", lambda: motion.forces((float("nan"), 0.0), (0.0, 0.0)))
    refused(r"v\[1\] = inf", lambda: motion.forces((0.0, 0.0), (0.0, float("inf"))))


@pytest.mark.parametrize("load", [(-1000.0,), (0.0, -1000.0, 50.0, 1.0), 1000.0, "down", None])
def test_loads_of_two_three_or_five_components(film, load):
    refused("load = .*must be .Fx, Fy., .Fx, Fy, Fz. or .Fx, Fy, Fz, Mx, My.", lambda: film.equilibrium(load))


def test_loads_that_are_no_numbers(film):
    refused(r"load\[1\] = nan", lambda: film.equilibrium((0.0, float("nan")), speed_rpm=3000.0))


def test_loads_and_preloads_beyond_the_atlas(film, oil):
    said = refused(r"load = \[0.0, -20000.0\]", lambda: film.equilibrium((0.0, -2e4), speed_rpm=3000.0))
    assert "a ball carries at most" in said and "here 9" in said
    tight = BallBearing.catalogue("6205", oil=oil, clearance=-1.5e-4)
    refused("clearance = -0.00015: must be such that a ball", lambda: tight.equilibrium((0, 0), speed_rpm=3000.0))
    assert BallBearing.catalogue("6205").equilibrium((0.0, -1.4e4)).force.max() > 6000.0  # dry


def test_loads_that_seat_no_bearing():
    loose = BallBearing.catalogue("6205", clearance=1e-5)
    refused(r"load = \[0.0, 0.0\]: must be", lambda: loose.equilibrium((0.0, 0.0)))
    # two balls carry it, one on each side; a single ball would leave the ring free to roll off
    three = BallBearing(balls=3, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, clearance=1e-5)
    refused("load = .*on both sides", lambda: three.equilibrium((0.0, -10.0)))
    assert three.equilibrium((0.0, -10.0), cage_angle=-pi / 6.0).loaded == 2
    preloaded = BallBearing.catalogue("6205", clearance=-1e-5)
    assert preloaded.equilibrium((0.0, 0.0)).loaded == 9


def test_angles_are_in_radians(film):
    refused("cage_angle = 90.0: .*radians", lambda: film.equilibrium(DOWN, speed_rpm=3000.0, cage_angle=90.0))


def test_other_questions(film, dry):
    refused("race = 'middle'", lambda: film.element("middle", 3000.0))
    refused("oil = None", lambda: dry.element("inner", 3000.0))
    assert film.roughness is None
    assert BallBearing.catalogue("6205", rq_ball=3e-8, rq_race=4e-8).roughness == pytest.approx(5e-8)


def test_lambda_ratio_is_film_over_roughness(oil):
    state = BallBearing.catalogue("6205", oil=oil, rq_race=1e-7).equilibrium(DOWN, speed_rpm=3000.0)
    np.testing.assert_allclose(state.lambda_ratio, state.h_min / 1e-7)
    assert np.all(state.h_min[0] < state.h_central[0])


def test_files(tmp_path, oil):
    bearing = BallBearing.catalogue("6203", oil=oil, clearance=5e-6, rq_race=1e-7, cutoff_gap=1e-5)
    again = read(save(bearing, tmp_path / "bearing.json"), BallBearing)
    assert again == bearing
    state = bearing.equilibrium(DOWN, speed_rpm=2000.0)
    back = read(save(state, tmp_path / "state.json"), BearingState)
    assert back.to_dict() == state.to_dict()
    assert again.equilibrium(DOWN, speed_rpm=2000.0).to_dict() == state.to_dict()
    dry = BallBearing.catalogue("209").equilibrium(DOWN)
    assert read(save(dry, tmp_path / "dry.json"), BearingState).to_dict() == dry.to_dict()


def test_files_that_are_none(tmp_path, oil):
    path = tmp_path / "bearing.json"
    refused("file = .*readable", lambda: read(path, BallBearing))
    path.write_text("{")
    refused("file = .*complete", lambda: read(path, BallBearing))
    document = json.loads(save(BallBearing.catalogue("6203", oil=oil), path).read_text())
    for changes, match in (
        ({"header": {"class": "BearingState", "format": 1}}, "class 'BearingState'"),
        ({"header": {"class": "BallBearing", "format": 2}}, "of format 1, not 2"),
        ({"blls": 9}, "blls = 'an unknown name': must be left out"),
        ({"balls": 90}, "balls = 90"),
        ({"oil": {"eta0": 0.04, "colour": 1}}, "oil.colour = .*: must be left out; known are eta0"),
        ({"oil": 5}, "oil = 5"),
    ):
        path.write_text(json.dumps(document | changes))
        refused(match, lambda: read(path, BallBearing))
    path.write_text(json.dumps({key: value for key, value in document.items() if key != "balls"}))
    refused("balls = None", lambda: read(path, BallBearing))


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_pictures(tmp_path, film, dry, ending):
    wet = film.equilibrium((700.0, -700.0), speed_rpm=3000.0)
    figure = wet.plot(tmp_path / f"state.{ending}")
    assert (tmp_path / f"state.{ending}").stat().st_size > 5000
    zone, films = figure.axes
    longest = max(bar.get_height() for bar in zone.patches)
    assert longest == wet.force.max()
    assert len(films.lines) == 2
    assert films.get_ylabel() == "smallest film [µm]" and "989.9 N, 3000 rev/min" in figure.get_suptitle()
    assert "below 0 a gap" in dry.equilibrium(DOWN).plot().axes[1].get_ylabel()
    refused("path", lambda: wet.plot(tmp_path / "nowhere" / "state.png"))


@pytest.mark.parametrize(
    "load", [(0.0, -1e30), (0.0, -1e30, 10.0), (0.0, 0.0, 1e300), (0.0, 0.0, 100.0, 1e30, 0.0)]
)
def test_a_load_beyond_any_bearing_says_what_a_ball_carries(load):
    with pytest.raises(InputError, match=r"a ball carries at most .* in the mean of all balls"):
        BallBearing.catalogue("6205").equilibrium(load, speed_rpm=3000.0)


def test_loads_and_frequencies_beyond_the_atlas_are_named():
    """A 6205 with clearance that carries nothing: its balls are where the atlas has no films, 0.13 N each."""
    floating = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), clearance="CN")
    light = floating.coefficients((0.0, 0.0), speed_rpm=3000.0, hz=50.0)
    words = "no ball carries more than 0.134 N on the inner race, the atlas begins at 0.163 N"
    assert light.reservation == words and words in str(light)
    assert floating.equilibrium((0.0, 0.0), speed_rpm=3000.0).reservation == words
    loaded = [floating.coefficients((0.0, -1000.0), speed_rpm=3000.0, hz=hz) for hz in (1e4, [50.0, 1e6], 1e12)]
    assert [bool(found.reservation) for found in loaded] == [False, True, True]
    assert "the atlas ends at 1.96e+05 Hz" in loaded[1].reservation
    assert floating.dry.coefficients((0.0, -1000.0), hz=1e12).reservation == ""
    angular = BallBearing.catalogue("7205", oil=floating.oil)
    pair = BearingSet.pair(angular, "back to back", preload=300.0, distance=0.05)
    found = pair.coefficients((0.0, -500.0), speed_rpm=3000.0, hz=1e7)
    assert (
        found.reservation.startswith("bearing 0: the atlas ends at ") and "; bearing 1: the" in found.reservation
    )
