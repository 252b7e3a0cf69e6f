"""The study file: the examples, errors in one line, and the numbers that follow from a bearing."""

from math import log10, pi
from pathlib import Path

import pytest
from rotor_twins import carried

from ehlcontact import Lubricant
from ehlcontact.cli.study.rotor import build_rotor
from ehlcontact.cli.study.schema import load_study

EXAMPLES = Path(__file__).parents[2] / "examples"
GRADE = "iso_vg = 68\ntemperature = 50.0\nviscosity_index = 95"
SMALL = (EXAMPLES / "small_study.toml").read_text()


@pytest.fixture
def study():
    return load_study(EXAMPLES / "deep_groove_6205.toml")


def test_viscosity_of_the_oil(study):
    """Walther's equation through 68 mm2/s at 40 C and 8.7 at 100 C, and the density of the comment."""
    w = [log10(log10(nu + 0.7)) for nu in (68.0, 8.7)]
    slope = (w[0] - w[1]) / log10(373.15 / 313.15)
    nu = 10**10 ** (w[0] - slope * log10(323.15 / 313.15)) - 0.7
    assert nu == pytest.approx(42.9, abs=0.05)
    assert study.oil.eta0 == pytest.approx(nu * 1e-6 * 875.0 * (1.0 - 0.00065 * 35.0), rel=2e-3)


def test_oil_by_its_grade(tmp_path):
    """The grade in place of eta0 and alpha is the library's oil."""
    file = tmp_path / "grade.toml"
    file.write_text(SMALL.replace("eta0 = 0.0367\nalpha = 2.0e-8", GRADE))
    study = load_study(file)
    assert study.lubricant == Lubricant.iso_vg(68, temperature=50.0, viscosity_index=95.0)
    assert study.lubricant.alpha_scatter == 0.2 and study.point.lubricant == study.lubricant
    file.write_text(
        SMALL.replace("eta0 = 0.0367\nalpha = 2.0e-8", "iso_vg = 100\ntemperature = 70\ndensity_15 = 888")
    )
    assert load_study(file).lubricant == Lubricant.iso_vg(100, temperature=70.0, density_15=888.0)


def test_fingerprint_is_of_what_a_stage_depends_on(study):
    """Names change nothing, nor does the way a frequency is given."""
    named = study.model_copy(update={"bearing": study.bearing.model_copy(update={"name": "another"})})
    assert study.fingerprint("solver") == named.fingerprint("solver") != study.fingerprint("solver", "free")


def test_frequencies_of_the_motions_in_hertz(tmp_path, study):
    """hz in place of Omega_n (of small dry vibrations) and of Omega; the stages of both are the same."""
    file, time = tmp_path / "hertz.toml", study.point.scales.time
    free, load = (1.0 / (study.free_motion.period * time), study.harmonic_motion.Omega / (2 * pi * time))
    text = (EXAMPLES / "deep_groove_6205.toml").read_text()
    for old, new in (("Omega_n = 2.56", f"hz = {free!r}"), ("Omega = 3.1416", f"hz = {load!r}")):
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)
    found = load_study(file)
    assert found.free_motion.Omega_n == pytest.approx(2.56, rel=1e-12)
    assert found.harmonic_motion.Omega == pytest.approx(3.1416, rel=1e-12)


def test_roughness_in_micrometres(tmp_path, study):
    assert study.roughness is None
    file = tmp_path / "rough.toml"
    file.write_text(SMALL + "\n[surface]\nrq_ball_um = 0.02\nrq_race_um = 0.1\n")
    assert load_study(file).roughness == (pytest.approx(2e-8), pytest.approx(1e-7))
    assert load_study(file).fingerprint("rotor") == load_study(EXAMPLES / "small_study.toml").fingerprint("rotor")


@pytest.mark.parametrize("arrangement", ["vee", "vertical"])
def test_every_contact_carries_the_load_of_the_operating_point(study, arrangement):
    changed = study.model_copy(update={"rotor": study.rotor.model_copy(update={"arrangement": arrangement})})
    assert carried(build_rotor(changed)) == pytest.approx(study.ball_load)


def test_a_file_of_a_bearing_is_no_study(refused, tmp_path):
    words = ("bearing.conformity_inner = 0.52", "left out", "is this a file for `ehlcontact bearing`?")
    refused(words, "run", EXAMPLES / "bearing_6205.toml", "-o", tmp_path / "results")
    refused(words, "validate", EXAMPLES / "bearing_6205.toml")
