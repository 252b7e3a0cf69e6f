"""One declaration of an input: entries of files and options have the same range, unit and messages."""

import pytest
from tiny_study import SMALL

from ehlcontact.cli.commands.simulate import MotionOptions, TimeOptions
from ehlcontact.cli.contact import Contact, Surfaces
from ehlcontact.cli.entries import allowed_of, field_of, meaning_of, quantity_of
from ehlcontact.cli.options import Grid
from ehlcontact.cli.study.schema import Study

SAME = {  # entry: option of a point
    "contact.race": "race",
    "oil.eta0": "eta0",
    "oil.alpha": "alpha",
    "oil.temperature": "temp",
    "oil.viscosity": "viscosity",
    "oil.density": "density",
}


@pytest.mark.parametrize(("entry", "option"), SAME.items())
def test_an_option_is_declared_as_its_entry(entry, option):
    in_file, on_line = field_of(Study, entry), field_of(Contact, option)
    assert allowed_of(in_file) == allowed_of(on_line) != ""
    assert quantity_of(in_file) == quantity_of(on_line)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("contact.n", "a multiple of 16 between 16 and 2048"),
        ("contact.harmonic.amplitude", "above 0 and below 1"),
        ("contact.free.hz", "a finite number > 0"),
        ("full_films.disc_damping", "a finite number >= 0"),
        ("full_films.arrangement", '"vee" or "vertical"'),
        ("oil.density_15", "between 800 and 950 kg/m3"),
        ("surface.rq_ball_um", "between 0.001 and 100 um"),
        ("title", ""),
        ("full_films.nothing", ""),
        ("support.left.ball_diameter_mm", "between 0.1 and 500 mm"),
        ("operation.radial_load", "0, or between 1e-06 and 1e+08 N"),
        ("operation.speed_rpm", "0, or between 0.001 and 1e+06 rev/min"),
    ],
)
def test_range_in_words(entry, words):
    assert allowed_of(field_of(Study, entry)) == words


@pytest.mark.parametrize("group", [Contact, Surfaces, Grid, MotionOptions, TimeOptions])
def test_every_option_has_a_meaning(group):
    for name, field in group.model_fields.items():
        (option,) = (rule for rule in field.metadata if hasattr(rule, "param_decls"))
        assert option.help or meaning_of(field), name


@pytest.mark.parametrize(
    ("entry", "old", "option"),
    [
        ("alpha = 20", "alpha = 2.0e-8", ("--alpha", "20")),
        ("eta0 = 36.7", "eta0 = 0.0367", ("--eta0", "36.7")),
    ],
)
def test_the_same_words_refuse_both(call, tmp_path, entry, old, option):
    assert old in SMALL
    file = tmp_path / "slip.toml"
    file.write_text(SMALL.replace(old, entry))
    given = {"--bearing": "6205", "--speed-rpm": "3000", "--load": "70", "--eta0": "0.04", "--alpha": "2e-8"}
    words = [part for pair in (given | {option[0]: option[1]}).items() for part in pair]
    lines = [call(*command).err for command in (("validate", file), ("steady", *words))]
    assert lines[0].partition(": must be ")[2] == lines[1].partition(": must be ")[2] != ""


def test_help_shows_unit_and_range(call):
    said = " ".join(word for word in call("steady", "--help").out.split() if word != "│")
    for words in (
        "Speed of the shaft; between 0.001 and 1e+06 rev/min.",
        "Viscosity at ambient pressure; between 0.0001 and 5 Pa s.",
        "Race of the contact; inner or outer.",
    ):
        assert words in said
