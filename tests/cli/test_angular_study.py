"""Studies of angular contact bearings by their names in the catalogue: the contact of the most loaded ball."""

import json
from dataclasses import replace
from math import cos, pi, radians
from types import SimpleNamespace

import numpy as np
import pytest
from jinja2 import Environment, PackageLoader, StrictUndefined
from tiny_study import STUDY

from ehlcontact import OilLayer
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.headline import at_angles as sentence
from ehlcontact.cli.study.headline import oil_and_heat as conditions_sentence
from ehlcontact.cli.study.oil_and_heat import run_oil_and_heat
from ehlcontact.cli.study.report import pictures_at_angles
from ehlcontact.cli.study.rotor_on_bearings import rotor_between, run_at_angles
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.whole_bearing import whole_bearing
from reduced_models import BallBearing, BearingSet, linearise
from reduced_models.bearing.oil_and_heat import LAYER

CATALOGUE = 'catalogue = "7205"\nradial_load = 200.0\nspeed_rpm = 6000.0\n'


@pytest.fixture
def study(tmp_path):
    def write(whole, bearing=CATALOGUE):
        _, oil, rest = STUDY.partition("[oil]")
        sections, _, _ = rest.partition("[whole_bearing]")
        path = tmp_path / "s.toml"
        path.write_text(f"[bearing]\n{bearing}\n{oil}{sections}[whole_bearing]\n{whole}\n")
        return path

    return write


def test_the_contact_is_that_of_the_heaviest_ball_at_its_angle(study):
    one = load_study(study("axial_load = 400.0"))
    state = BallBearing.catalogue("7205").equilibrium((0.0, -200.0, 400.0), speed_rpm=6000.0)
    load, angle = state.force[:, 0].max(), state.contact_angles[state.force[:, 0].argmax(), 0]
    assert one.ball == (load, angle) and one.ball_load == one.point.load == load
    D, dm = 7.938e-3, 38.5e-3
    gamma = D * cos(angle) / dm
    assert one.point.geometry.radius_x == pytest.approx(0.5 * D * (1.0 - gamma), rel=1e-4)
    # both surfaces roll at omega dm (1 - gamma^2)/4 as seen from the contact
    assert one.point.u_sum == pytest.approx(200.0 * pi * dm * (1.0 - gamma**2) / 2.0, rel=1e-4)
    assert whole_bearing(one, oil=False).contact_angle == pytest.approx(radians(30.0))


def test_what_a_stage_depends_on_has_the_axial_load_in_it(study):
    prints = [load_study(study(f"axial_load = {load}")).fingerprint("solver") for load in (400.0, 500.0)]
    assert prints[0] != prints[1]


def test_other_angle_than_that_of_the_name(study):
    one = load_study(study("axial_load = 400.0\ncontact_angle_deg = 15.0"))
    assert whole_bearing(one, oil=False).contact_angle == pytest.approx(radians(15.0))


@pytest.mark.parametrize(
    ("whole", "words"),
    [
        ("", ("whole_bearing.axial_load = None", "7205 A is an angular contact bearing")),
        ("axial_load = 1e6", ("bearing.radial_load, whole_bearing.axial_load = (200.0, 1000000.0)",)),
        ("axial_load = 400.0\nspan_mm = 0.2", ("span_mm = 0.2", "between 1 and 10000 mm", "in m? then 200 mm")),
        ("axial_load = 400.0\npreload = 100.0", ("whole_bearing.preload = 100.0", "without whole_bearing.pair")),
        ('axial_load = 9.0\npair = "o"', ("whole_bearing.pair = 'o'", "back-to-back")),
        ('axial_load = 9.0\npair = "tandem"\npreload = 9.0', ("whole_bearing.preload = 9", "do not press each")),
        ("axial_load = 400.0\ncontact_angle_deg = 0.5", ("contact_angle_deg = 0.5", "in rad? then 28.6")),
    ],
)
def test_mistakes(refused, study, tmp_path, whole, words):
    refused(words, "validate", study(whole))


@pytest.fixture(scope="module")
def paired(tmp_path_factory):
    _, oil, rest = STUDY.partition("[oil]")
    path = tmp_path_factory.mktemp("pair") / "s.toml"
    whole = 'axial_load = 100.0\npair = "back-to-back"\npreload = 200.0\ndistance_mm = 40.0\nspan_mm = 300.0\n'
    path.write_text(f"[bearing]\n{CATALOGUE}\n{oil}{rest.partition('[whole_bearing]')[0]}[whole_bearing]\n{whole}")
    one = load_study(path)
    return one, run_at_angles(one)


def test_a_pair_carries_the_load(paired):
    one, at = paired
    pair = BearingSet.pair(whole_bearing(one, oil=True), preload=200.0, distance=0.04)
    state = pair.equilibrium((0.0, -200.0, 100.0), speed_rpm=6000.0)
    np.testing.assert_array_equal(at.state.axial_forces, state.axial_forces)
    assert list(at.bearings) == ["bearing 0, facing +z", "bearing 1, facing -z"]
    dry = BearingSet.pair(whole_bearing(one, oil=False), preload=200.0, distance=0.04)
    heaviest = dry.equilibrium((0.0, -200.0, 100.0), speed_rpm=6000.0).bearings[0]
    assert one.ball_load == heaviest.force[:, 0].max()


def test_a_rotor_on_a_pair_and_a_floating_bearing(paired):
    """The spring at the right end loads the pair in +z; loads of bearings are along their facings."""
    one, at = paired
    first, second, right = linearise(rotor_between(one, at.pair, at.span), 6000.0).loads
    assert first[2] - second[2] == pytest.approx(100.0, abs=1e-6)
    assert right[2] == pytest.approx(100.0) and len(at.modes) == 6
    assert first[1] + second[1] + right[1] == pytest.approx(-400.0) and -200.0 < right[1] < -100.0


@pytest.mark.long
def test_a_pair_with_a_layer_of_oil(study):
    """What the study has of it is that of the set; its words are of a pair."""
    whole = 'axial_load = 100.0\npair = "back-to-back"\npreload = 200.0\nlayer_ratio = 0.8'
    one = load_study(study(whole))
    found = run_oil_and_heat(one)
    pair = BearingSet.pair(whole_bearing(one, oil=True), preload=200.0)
    starved = replace(pair, bearings=[replace(k, supply=OilLayer(over_flooded=0.8)) for k in pair.bearings])
    load = (0.0, -200.0, 100.0)
    small = starved.coefficients(load, speed_rpm=6000.0, hz=found.hz)
    state = starved.equilibrium(load, speed_rpm=6000.0).bearings[0]
    layer = found.conditions[LAYER]
    np.testing.assert_array_equal(layer.damping, np.einsum("kii->ki", small.signed_damping)[:, :3])
    np.testing.assert_array_equal(layer.h_central, state.h_central)
    assert "isothermal, the pair has" in conditions_sentence(SimpleNamespace(oil_and_heat=found))


def test_results_report_and_words_of_a_pair(paired):
    one, at = paired
    numbers = json.loads(json.dumps(at.to_dict(), default=lambda array: array.tolist()))
    assert len(numbers["frequencies_hz"]) == len(numbers["state"]["bearings"]) == 2
    text = sentence(SimpleNamespace(at_angles=at, oil_and_heat=None))
    assert "balls of a pair of 7205 A, back to back run" in text and "a floating bearing has" in text
    drawings = pictures_at_angles(at)
    assert set(drawings) == {"angles_balls", "angles_balls1", "angles_coefficients", "angles_campbell"}
    heights = {name: 400 for name in drawings}
    environment = Environment(loader=PackageLoader("ehlcontact.cli"), undefined=StrictUndefined)
    environment.filters["sig"] = numeral
    asked = SimpleNamespace(study=one, at_angles=at)
    page = environment.get_template("at_angles.html.j2").render(
        found=asked, heights=heights, picture=lambda name, text: f"[{name}] {text}"
    )
    assert "[angles_balls1]" in page and "of bearing 1, facing -z." in page and "planes 40 mm apart" in page


def test_init_of_an_angular_contact_bearing(call, refused, tmp_path):
    path = tmp_path / "s.toml"
    refused(("--axial = None", "7205 A is an angular contact bearing"), "init", path, "--bearing", "7205")
    assert call("init", path, "--bearing", "7205", "--axial", "400").code == 0
    assert "# contact_angle_deg = 30.0" in path.read_text()
    assert load_study(path).ball[1] == pytest.approx(radians(30.0), abs=0.1)
