"""One declaration of an input: entries of files and options have the same range, unit and messages."""

import pytest
from tiny_study import SMALL

from ehlcontact.cli.commands.bearing import BearingOptions
from ehlcontact.cli.commands.init import ENTRIES as OF_A_STUDY
from ehlcontact.cli.commands.init import Wish
from ehlcontact.cli.commands.simulate import MotionOptions, TimeOptions
from ehlcontact.cli.contact import Contact, Surfaces
from ehlcontact.cli.entries import allowed_of, field_of, keys_of, meaning_of, options_of, quantity_of
from ehlcontact.cli.options import Grid
from ehlcontact.cli.study.bearing import ENTRIES as OF_A_BEARING
from ehlcontact.cli.study.bearing import NOT_OF_A_BEARING
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


@pytest.mark.parametrize(
    ("entry", "options"),
    [
        ("operation.radial_load", ("--load", "--radial")),
        ("operation.tilt_x_mrad", ("--tilt-x",)),
        ("support.contact_angle_deg", ("--contact-angle",)),
        ("oil.iso_vg", ("--oil",)),
        ("surface.rq_um", ("--rq",)),
        ("disc.width_mm", ("--disc-width",)),
        ("support.a_new_one_um", ("--a-new-one",)),
    ],
)
def test_the_option_of_an_entry_is_its_key_without_the_unit(entry, options):
    assert options_of(entry) == options


@pytest.mark.parametrize(("group", "entries"), [(BearingOptions, OF_A_BEARING), (Wish, OF_A_STUDY)])
def test_every_entry_of_the_schema_is_an_option(group, entries):
    """An entry that is added to [operation], [[support]], [oil] or [surface] is an option at once."""
    assert set(group.ENTRIES.values()) == set(entries)
    for section in ("operation", "support", "oil", "surface"):
        keys = {f"{section}.{key}" for key in keys_of(Study.model_fields[section].annotation)}
        assert keys - set(NOT_OF_A_BEARING) <= set(entries)
    for name, entry in group.ENTRIES.items():
        assert name in group.model_fields and f"--{name.replace('_', '-')}" == options_of(entry)[0]
    assert len(set(group.ENTRIES)) == len(entries)  # no two have one name


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
