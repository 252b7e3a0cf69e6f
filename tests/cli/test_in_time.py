"""The machine of a study in time on models of its bearings: what may stand in the file, and what becomes of it."""

from types import SimpleNamespace

import numpy as np
import pytest
from tiny_study import CONTACT, FULL_FILMS, IN_TIME, MACHINE, STUDY

from ehlcontact.cli.study.answer import run_models
from ehlcontact.cli.study.forecast import MODEL_STEP, MODELS, forecast
from ehlcontact.cli.study.headline import whole as sentence
from ehlcontact.cli.study.machine import bearing_of, rotor_of
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.stages import STAGES
from reduced_models.rotor.picture import amplitudes

PLAIN = MACHINE + CONTACT + FULL_FILMS


def study(folder, *, text=STUDY, **changes):
    """A study with other entries: old text by new text."""
    for old, new in changes.items():
        assert old in text, old
        text = text.replace(old, new)
    path = folder / "study.toml"
    path.write_text(text)
    return path


def test_a_study_without_them_is_as_it_was(tmp_path):
    plain, asked = (load_study(study(tmp_path, text=text)) for text in (PLAIN, STUDY))
    assert run_models(plain, tmp_path) is None and not list(tmp_path.glob("on_bearings*"))
    for stage in STAGES:  # what is finished stays finished
        assert plain.fingerprint(*stage.parts) == asked.fingerprint(*stage.parts)
    less, more = (found.seconds / found.conv for found in (forecast(one, tmp_path, 1) for one in (plain, asked)))
    assert more == pytest.approx(less + MODELS + MODEL_STEP * 10 * 200)


def test_both_races_clearance_and_load(tmp_path):
    text = STUDY.replace("clearance = -1.0", "clearance = 5.0\nconformity_outer = 0.53")
    found = load_study(study(tmp_path, text=text.replace("conformity = 0.52", "conformity_inner = 0.52")))
    bearing = bearing_of(found, 0)
    assert (bearing.conformity_inner, bearing.conformity_outer) == (0.52, 0.53)
    assert bearing.clearance == pytest.approx(5e-6, rel=1e-12, abs=0.0)
    assert bearing.roughness == pytest.approx(np.hypot(2e-8, 1.5e-7), rel=1e-12, abs=0.0)
    rotor = rotor_of(found)
    assert rotor.load[1::2].sum() == pytest.approx(-2.0 * 20.0, rel=1e-12)
    assert not rotor.load[0::2].any()


CLEARANCE, BALLS = "clearance = -1.0", "balls = 9\nball_diameter_mm = 7.94"


@pytest.mark.parametrize(
    ("words", "old", "new"),
    [
        (("support.left.clearance = 500.0", "between -397 and 397 um"), CLEARANCE, "clearance = 500.0"),
        (("in_time.revolutions = 5", "between 10 and 1000"), "revolutions = 10", "revolutions = 5"),
        (("clearance?",), CLEARANCE, "clearence = -1.0"),
        (("support.left.conformity = 0.502", "atlas"), "conformity = 0.52", "conformity = 0.502"),
        (("balls = 16", "at most 15"), "balls = 9", "balls = 16"),
        (("steps_per_revolution = 200", "while a ball passes"), BALLS, "balls = 35\nball_diameter_mm = 2.0"),
        (("support.left = '7005 N'", "on the inner race"), "radial_load = 29.209", "radial_load = 14000.0"),
        (("disc.unbalance", "given, of one disc"), "unbalance = 8e-6", ""),
        (("in_time", "alike"), f"journal_mass = 0.05\n{CLEARANCE}\n{BALLS}\n", f"journal_mass = 0.05\n{BALLS}\n"),
    ],
)
def test_what_cannot_be_run(refused, tmp_path, words, old, new):
    """Told before anything is computed."""
    folder, text = tmp_path / "out", MACHINE + IN_TIME
    assert old in text
    count = 1 if words[0] == "in_time" else -1
    (tmp_path / "study.toml").write_text(text.replace(old, new, count))
    refused(words, "run", tmp_path / "study.toml", "-o", folder)
    assert not folder.exists()


def test_a_rotor_that_no_bearing_holds_costs_no_study(tmp_path, monkeypatch):
    """The ring is thrown out of its bearing: the others are there, and it is told why."""
    from reduced_models.rotor import compare_bearing_models

    original = compare_bearing_models.simulate_rotor

    def wild(rotor, *, start, **others):
        return original(rotor, start=(start[0], start[1] + 50.0), **others)

    monkeypatch.setattr(compare_bearing_models, "simulate_rotor", wild)
    found = run_models(load_study(study(tmp_path)), tmp_path)
    assert set(found.failed) == {"memory", "dry"} and set(found.ran) == {"constant", "usual"}
    assert "has left it" in found.failed["dry"]

    holds = SimpleNamespace(oil_and_heat={}, whole=found)
    assert "could not be run on its bearings with: film memory under every ball (rotor at t" in sentence(holds)


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
