"""The rotor of a study on whole bearings: what may stand in the file, and what becomes of it."""

import numpy as np
import pytest
from tiny_study import STUDY

from ehlcontact.cli.study.forecast import WHOLE, WHOLE_STEP, forecast
from ehlcontact.cli.study.headline import whole as sentence
from ehlcontact.cli.study.rotor_on_bearings import run_whole, whole_rotor
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.stages import STAGES
from ehlcontact.cli.study.whole_bearing import whole_bearing
from reduced_models.rotor.picture import amplitudes

PLAIN = STUDY[: STUDY.index("[whole_bearing]")]


def study(folder, *, text=STUDY, **changes):
    """A study with other entries: old text by new text."""
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = folder / "study.toml"
    path.write_text(text)
    return path


def test_a_study_without_them_is_as_it_was(tmp_path):
    plain, asked = (load_study(study(tmp_path, text=text)) for text in (PLAIN, STUDY))
    assert run_whole(plain, tmp_path) is None and not list(tmp_path.glob("on_bearings*"))
    for stage in STAGES:  # what is finished stays finished
        assert plain.fingerprint(*stage.sections) == asked.fingerprint(*stage.sections)
    less, more = (found.seconds / found.conv for found in (forecast(one, tmp_path, 1) for one in (plain, asked)))
    assert more == pytest.approx(less + WHOLE + WHOLE_STEP * 10 * 200)


def test_both_races_clearance_and_load(tmp_path):
    text = STUDY.replace("clearance_um = -1.0", "clearance_um = 5.0\nconformity_other = 0.53")
    found = load_study(study(tmp_path, text=text))
    bearing = whole_bearing(found, oil=True)
    assert (bearing.conformity_inner, bearing.conformity_outer) == (0.52, 0.53)
    assert bearing.clearance == pytest.approx(5e-6) and bearing.roughness == pytest.approx(np.hypot(2e-8, 1.5e-7))
    turned = load_study(study(tmp_path, text=text.replace("[bearing]", '[bearing]\nrace = "outer"')))
    assert whole_bearing(turned, oil=False).conformity_inner == 0.53
    rotor = whole_rotor(found, bearing)
    assert rotor.load[1::2].sum() == pytest.approx(-2.0 * 20.0)
    assert not rotor.load[0::2].any()


CLEARANCE, BALLS = "clearance_um = -1.0", "balls = 9\nball_diameter_mm = 7.94"


@pytest.mark.parametrize(
    ("words", "old", "new"),
    [
        (("whole_bearing.clearance_um = 500.0", "between -397 and 397 um"), CLEARANCE, "clearance_um = 500.0"),
        (("whole_bearing.revolutions = 5", "between 10 and 1000"), "revolutions = 10", "revolutions = 5"),
        (("clearance_um?",), CLEARANCE, "clearence_um = -1.0"),
        (("whole_bearing.conformity_other = 5", "between 0.501 and 0.7"), CLEARANCE, "conformity_other = 5.0"),
        (("whole_bearing.conformity_other = 0.502", "[whole_bearing]"), CLEARANCE, "conformity_other = 0.502"),
        (("bearing.balls = 16", "at most 15"), "balls = 9", "balls = 16"),
        (("steps_per_revolution = 200", "while a ball passes"), BALLS, "balls = 35\nball_diameter_mm = 2.0"),
        (("bearing.radial_load = 7000", "on the inner race"), "radial_load = 20.0", "radial_load = 7000.0"),
    ],
)
def test_what_is_no_whole_bearing(refused, tmp_path, words, old, new):
    """Told before anything is computed."""
    folder = tmp_path / "out"
    refused(words, "run", study(tmp_path, **{old: new}), "-o", folder)
    assert not folder.exists()


def test_a_rotor_that_no_bearing_holds_costs_no_study(tmp_path, monkeypatch):
    """The ring is thrown out of its bearing: the others are there, and it is told why."""
    from reduced_models.rotor import compare_bearing_models

    original = compare_bearing_models.simulate_rotor

    def wild(rotor, *, start, **others):
        return original(rotor, start=(start[0], start[1] + 50.0), **others)

    monkeypatch.setattr(compare_bearing_models, "simulate_rotor", wild)
    found = run_whole(load_study(study(tmp_path)), tmp_path)
    assert set(found.failed) == {"memory", "dry"} and set(found.ran) == {"constant", "usual"}
    assert "has left it" in found.failed["dry"]

    class Holds:
        oil_and_heat = None
        whole = found

    assert "could not be run on whole bearings with: film memory under every ball (rotor at t" in sentence(Holds)


@pytest.mark.parametrize(("amplitude", "hz"), [(3e-6, 179.2), (4e-9, 50.0)])
def test_a_spectrum_shows_the_amplitude_of_a_vibration(amplitude, hz):
    """Beside a larger offset and another vibration; a frequency between two lines costs at most 15 %."""
    t = np.arange(8000) * 1e-4
    y = 1e-5 + amplitude * np.sin(2.0 * np.pi * hz * t + 0.4) + 1e-6 * np.sin(2.0 * np.pi * 500.0 * t)
    frequency, size = amplitudes(y, t[1] - t[0])
    near = np.abs(frequency - hz) < 5.0
    assert 0.85 * amplitude <= size[near].max() <= 1.001 * amplitude
    assert size[np.abs(frequency - 500.0) < 5.0].max() == pytest.approx(1e-6, rel=1e-3)
    assert size[0] < 0.1 * amplitude + 1e-12
