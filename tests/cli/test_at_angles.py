"""The whole bearing of a study under axial load: entries, numbers of the library, report."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from tiny_study import STUDY

from ehlcontact.cli.plots.render import figure_of
from ehlcontact.cli.study.forecast import forecast
from ehlcontact.cli.study.headline import at_angles as sentence
from ehlcontact.cli.study.report import pictures_at_angles
from ehlcontact.cli.study.rotor_on_bearings import rotor_between, run_at_angles, run_whole
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.whole_bearing import whole_bearing
from reduced_models import linearise

CLEARANCE = "clearance_um = -1.0"
ANGLE = "axial_load = 50.0\ncontact_angle_deg = 25.0"


def study(folder, entries):
    path = folder / "study.toml"
    path.write_text(STUDY.replace(CLEARANCE, entries))
    return path


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    one = load_study(study(tmp_path_factory.mktemp("study"), ANGLE))
    return one, run_at_angles(one)


def test_statics_and_coefficients_are_those_of_the_library(found, tmp_path):
    one, at = found
    bearing, load = whole_bearing(one, oil=True), (0.0, -20.0, 50.0)
    assert bearing.contact_angle == pytest.approx(np.radians(25.0)) and bearing.race_control == "outer"
    state = bearing.equilibrium(load, speed_rpm=3000.0)
    np.testing.assert_array_equal(at.state.force, state.force)
    np.testing.assert_array_equal(at.state.contact_angles, state.contact_angles)
    small = bearing.coefficients(load, speed_rpm=3000.0, hz=(5.0, 5000.0))
    np.testing.assert_allclose(at.over_frequency.stiffness[[0, -1]], small.stiffness, rtol=1e-12)
    assert at.frequencies[0]["bpfo"] == pytest.approx(50.0 * state.orders.bpfo_order)
    assert run_whole(one, tmp_path) is None  # nothing in time


def test_both_bearings_of_the_rotor_carry_the_radial_and_the_axial_load(found):
    one, at = found
    rotor = rotor_between(one, at.bearing, at.span)
    left, right = linearise(rotor, 3000.0).loads
    for load, facing in ((left, -1.0), (right, 1.0)):
        np.testing.assert_allclose(load[:3], [0.0, -20.0, 50.0 * facing * np.sign(load[2] * facing)], atol=1e-6)
    assert at.span == 0.2 and len(at.modes) == 6


def test_the_axial_mode_of_the_rotor(found):
    """A mass on the axial stiffness of two bearings: the spring on the right ring has no part in it."""
    one, at = found
    axial = max(at.modes[:3], key=lambda mode: mode.axial_share)
    K = at.bearing.coefficients((0.0, -20.0, 50.0), speed_rpm=3000.0, hz=axial.hz).stiffness[0, 2, 2]
    mass = one.rotor.disc_mass + one.rotor.journal_mass
    assert axial.axial_share > 0.9
    assert axial.hz == pytest.approx(np.sqrt(K / mass) / (2.0 * np.pi), rel=0.05)


def test_results_and_report(found):
    _, at = found
    numbers = json.loads(json.dumps(at.to_dict(), default=lambda array: array.tolist()))
    assert np.shape(numbers["over_frequency"]["damping"]) == (31, 5, 5)
    assert numbers["modes"][0]["hz"] == at.modes[0].hz and numbers["no_modes"] is None
    text = sentence(SimpleNamespace(at_angles=at, oil_and_heat=None))
    assert "Under 50 N of axial load" in text and f"{at.modes[0].hz:.4g} Hz" in text
    assert sentence(SimpleNamespace(at_angles=None)) == ""
    figures = {name: describe() for name, describe in pictures_at_angles(at).items()}
    assert set(figures) == {"angles_balls", "angles_coefficients", "angles_campbell"}
    names = {line.name for line in figures["angles_campbell"].panels[0].lines}
    assert sum("axial" in name for name in names) == 1  # of the three that are followed
    _, _, angles, _ = figures["angles_balls"].panels
    shown = next(line for line in angles.shown().lines if line.name == "outer race")
    np.testing.assert_allclose(np.sort(shown.y), np.sort(np.degrees(at.state.contact_angles[:, 1])))
    assert all(figure_of(one).data for one in figures.values())


def test_what_is_planar_is_as_it_was(tmp_path):
    plain = load_study(study(tmp_path, CLEARANCE))
    assert run_at_angles(plain) is None
    under_load = load_study(study(tmp_path, f"{CLEARANCE}\naxial_load = 50.0"))
    assert forecast(under_load, tmp_path, 1).seconds != forecast(plain, tmp_path, 1).seconds
    assert plain.fingerprint("rotor", "solver") == under_load.fingerprint("rotor", "solver")


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ("contact_angle_deg = 25.0", ("whole_bearing.contact_angle_deg = 25", "without whole_bearing.axial_load")),
        ("race_control = 'inner'", ("whole_bearing.race_control", "a planar bearing has no contact angles")),
        ("axial_load = -50.0", ("whole_bearing.axial_load = -50", "between")),
        (f"{ANGLE}\nclearance_um = 30.0", ("whole_bearing.clearance_um = 30", "left out beside a contact angle")),
        ("axial_load = 50.0\ncontact_angle_deg = 50.0", ("contact_angle_deg = 50", "between 1 and 45 degrees")),
        ("axial_load = 50.0\ncontact_angle_deg = 0.44", ("contact_angle_deg = 0.44", "in rad? then 25.2")),
        (f"{ANGLE}\nrace_control = 'both'", ("whole_bearing.race_control", "harris")),
        (f"{ANGLE}\nmoment_x = 1.0\ntilt_y_mrad = 0.1", ("whole_bearing.tilt_y_mrad = 0.1", "beside moments")),
        (f"{ANGLE}\ntilt_x_mrad = 200.0", ("whole_bearing.tilt_x_mrad = 200", "between -100 and 100 mrad")),
        ("axial_load = 1e6", ("bearing.radial_load, whole_bearing.axial_load = (20.0, 1000000.0)", "a ball")),
        (f"{ANGLE}\nclearance = 3", ("whole_bearing.clearance = 3", "clearance_um?")),
    ],
)  # fmt: skip
def test_mistakes(refused, tmp_path, entries, words):
    folder = tmp_path / "out"
    refused(words, "run", study(tmp_path, entries), "-o", folder)
    assert not folder.exists()


@pytest.mark.long
def test_moments_tilts_and_span(tmp_path):
    one = load_study(study(tmp_path, f"{ANGLE}\nmoment_x = 0.2\nspan_mm = 100.0\nrace_control = 'harris'"))
    at = run_at_angles(one)
    np.testing.assert_allclose(at.state.load, [0.0, -20.0, 50.0, 0.2, 0.0], atol=1e-8)
    assert at.span == 0.1 and at.bearing.race_control == "harris"
    held = run_at_angles(load_study(study(tmp_path, f"{ANGLE}\ntilt_x_mrad = 0.1")))
    assert held.state.displacement[3] == pytest.approx(1e-4)


def test_init_shows_the_entries(call, tmp_path):
    call("init", tmp_path / "s.toml")
    text = (tmp_path / "s.toml").read_text()
    assert "axial_load" in text and "race_control" in text and "contact_angle_deg" in text
    assert load_study(tmp_path / "s.toml").whole_bearing.axial_load is None
