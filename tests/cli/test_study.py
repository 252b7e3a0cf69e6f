"""The study file: the examples, errors in one line, and the numbers that follow from a bearing."""

import json
from math import log10, pi
from pathlib import Path

import pytest
from programs import script
from rotor_twins import carried
from tiny_study import SMALL

from ehlcontact import Lubricant
from ehlcontact.cli.study.rotor import build_rotor
from ehlcontact.cli.study.schema import load_study

EXAMPLES = Path(__file__).parents[2] / "examples"
GRADE = "iso_vg = 68\ntemperature = 50.0\nviscosity_index = 95"


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
    for name in ('"ISO VG 100"', '"vg100"'):
        file.write_text(file.read_text().replace("iso_vg = 100", f"iso_vg = {name}"))
        assert load_study(file).oil.iso_vg == 100
        file.write_text(file.read_text().replace(f"iso_vg = {name}", "iso_vg = 100"))


def test_fingerprint_is_of_what_a_stage_depends_on(study):
    """Names change nothing, nor does the way a frequency is given."""
    named = study.model_copy(update={"support": (study.support[0].model_copy(update={"name": "another"}),)})
    assert study.fingerprint("grid") == named.fingerprint("grid") != study.fingerprint("grid", "free")
    unchecked = study.model_copy(update={"full_films": study.full_films.model_copy(update={"half_step": False})})
    assert study.fingerprint("full_films") == unchecked.fingerprint("full_films")


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
    rough = load_study(file)
    file.write_text(SMALL)
    assert rough.fingerprint("full_films") == load_study(file).fingerprint("full_films")
    file.write_text(SMALL + "\n[surface]\nrq_um = 0.1\n")
    assert load_study(file).roughness == (0.0, pytest.approx(1e-7))


@pytest.mark.parametrize("arrangement", ["vee", "vertical"])
def test_every_contact_carries_the_load_of_the_operating_point(study, arrangement):
    films = study.full_films.model_copy(update={"arrangement": arrangement})
    changed = study.model_copy(update={"full_films": films})
    assert carried(build_rotor(changed)) == pytest.approx(study.ball_load)


OLD = """[bearing]
catalogue = "6205"
[rotor]
disc_mass = 2.0
[whole_bearing]
clearance_um = 5.0
[solver]
n = 64
[free]
periods = 2.0
[harmonic]
periods = 2.0
[check]
half_step = true
"""


def test_sections_that_are_none_of_a_study(refused, tmp_path):
    """Named, each with what stands in its place."""
    file = tmp_path / "old.toml"
    file.write_text(OLD)
    words = ("old.toml: bearing, rotor, whole_bearing, solver, free, harmonic, check = ...: must be left out",)
    words += ("[contact] for n, n_transient and domain in place of [solver]", "half_step in [full_films]")
    for command in ("run", "validate"):
        refused(words, command, file)


def test_the_machine_of_the_small_study_carries_the_bearing_alone(tmp_path):
    """The same contact, and the same rotor on full films: of its discs and weight, or of a load."""
    file = tmp_path / "alone.toml"
    file.write_text(SMALL)
    alone, machine = load_study(file), load_study(EXAMPLES / "small_study.toml")
    assert machine.radial_load == alone.radial_load == 70.0 and machine.ball == alone.ball
    parts = ("grid", "free", "harmonic", "rotor_band", "full_films")
    assert machine.fingerprint(*parts) == alone.fingerprint(*parts)


def test_the_reference_page_is_made_from_the_schema():
    """`python docs/site/study.py` makes it."""
    page = script("docs/site/study.py")
    assert page.PAGE.read_text(encoding="utf-8") == page.text()


@pytest.mark.parametrize("name", ["deep_groove_6205", "jump", "motor", "small_study", "spindle"])
def test_every_example_is_a_study(call, tmp_path, name):
    found = call("validate", EXAMPLES / f"{name}.toml", "-o", tmp_path / "out", "--json", "-")
    assert found.code == 0 and json.loads(found.out)["warnings"] == []
