"""Studies of angular contact bearings by their names in the catalogue: the contact of the heaviest ball."""

from math import cos, pi, radians

import pytest
from tiny_study import STUDY

from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.whole_bearing import whole_bearing
from reduced_models import BallBearing

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
        ("axial_load = 400.0\ncontact_angle_deg = 0.5", ("contact_angle_deg = 0.5", "in rad? then 28.6")),
    ],
)
def test_mistakes(refused, study, tmp_path, whole, words):
    refused(words, "validate", study(whole))


def test_init_of_an_angular_contact_bearing(call, refused, tmp_path):
    path = tmp_path / "s.toml"
    refused(("--axial = None", "7205 A is an angular contact bearing"), "init", path, "--bearing", "7205")
    assert call("init", path, "--bearing", "7205", "--axial", "400").code == 0
    assert "# contact_angle_deg = 30.0" in path.read_text()
    assert load_study(path).ball[1] == pytest.approx(radians(30.0), abs=0.1)
