"""The study that `init` writes: it runs as it is, and has every entry of the schema with its default."""

import json
import re
import tomllib

import pytest
from pydantic import BaseModel

from ehlcontact.cli.entries import keys_of, meaning_of
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.schema import Study, load_study, study_of
from ehlcontact.lubricant.oil import GRADES
from reduced_models import BallBearing
from reduced_models.bearing.catalogue import DEEP_GROOVE

SHOWN = re.compile(r"^# (\w+ = (?!\?))", flags=re.M)  # a default


def sections():
    return {name: field.annotation for name, field in Study.model_fields.items() if name != "title"}


@pytest.fixture
def study(call, tmp_path):
    """The file that `init` writes with some options."""

    def made(*options):
        file = tmp_path / "study.toml"
        assert call("init", file, "--force", *options).code == 0
        return file

    return made


def test_every_entry_of_the_schema_is_explained():
    assert all(issubclass(model, BaseModel) for model in sections().values())
    for name, model in sections().items():
        assert model.__doc__, name
        assert [key for key, field in keys_of(model).items() if not meaning_of(field)] == []


def test_options_are_entries_of_the_study(study):
    file = study("--bearing", "6206", "--oil", "vg46", "--temp", "65", "--speed-rpm", "1500", "--load", "250")
    found, bearing = load_study(file), BallBearing.catalogue("6206")
    assert (found.oil.iso_vg, found.oil.temperature, found.oil.label) == (46, 65.0, "ISO VG 46 at 65 °C")
    assert (found.bearing.speed_rpm, found.bearing.radial_load) == (1500.0, 250.0)
    assert (found.bearing.name, found.bearing.balls) == ("6206", bearing.balls)
    assert found.bearing.ball_diameter_mm == pytest.approx(1e3 * bearing.ball_diameter, rel=1e-6)


def test_commented_lines_are_the_defaults(study):
    """With every # before a default taken away the study is the same; and every entry has its line."""
    file = study()
    text = file.read_text()
    uncommented = SHOWN.sub(r"\1", text)
    document = tomllib.loads(uncommented)
    assert study_of(document).model_dump() == load_study(file).model_dump()
    for section, model in sections().items():
        part = text.partition(f"[{section}]")[2].partition("\n[")[0]
        for key, entry in model.model_fields.items():
            assert len(re.findall(rf"^(?:# )?{key} = ", part, flags=re.M)) == 1, (section, key)
            if not entry.is_required() and entry.default is not None and section != "bearing":
                said = document[section][key]
                assert (tuple(said) if isinstance(said, list) else said) == entry.default
    assert max(map(len, text.splitlines())) <= 115


def test_lines_end_in_what_the_schema_allows(study):
    text = study().read_text().replace("[whole_bearing]", "[end]").partition("[end]")[0]
    lines = {line.split(" = ")[0].strip("# "): line for line in text.splitlines() if " = " in line}
    for key, words in {
        "race": '"inner" or "outer"',
        "n": "a multiple of 16 between 16 and 2048",
        "amplitude": "above 0 and below 1",
        "temperature": "between 20 and 120 C",
        "radial_load": "between 1e-06 and 1e+08 N",
    }.items():
        assert lines[key].endswith(words), lines[key]
    assert ", ".join(map(str, GRADES)) in text


@pytest.mark.parametrize(
    "name",
    [name if k % 5 == 0 else pytest.param(name, marks=pytest.mark.slow) for k, name in enumerate(DEEP_GROOVE)],
)
def test_every_bearing_of_the_catalogue_begins_without_cautions(study, name):
    assert cautions(load_study(study("--bearing", name))) == []


@pytest.mark.parametrize(("load", "temp", "entry"), [("2", "50", "domain"), ("3000", "90", "n_transient")])
def test_grids_follow_the_film(study, load, temp, entry):
    """A light load wants a wider region, a heavy one a finer grid: written as entries, with the default beside."""
    file = study("--load", load, "--temp", temp)
    assert entry in tomllib.loads(file.read_text())["solver"]
    said = " ".join(file.read_text().replace("\n# ", " ").split())
    assert "too small for this film" in said
    assert all("the library chooses none finer" in caution for caution in cautions(load_study(file)))


def test_what_the_atlas_does_not_have_is_left_out(study):
    """Whole bearings run on the atlas: beyond it the section is a comment, and says why."""
    file = study("--load", "9000")
    assert "whole_bearing" not in load_study(file).model_fields_set
    assert "whole_bearing" in load_study(study("--load", "900")).model_fields_set
    text = study("--load", "9000").read_text()
    assert "# [whole_bearing]" in text and "the end of the atlas at this speed" in " ".join(text.split())


def test_validate_takes_it_unchanged(call, study):
    file = study()
    found = json.loads(call("validate", file, "--json", "-").out)
    assert found["warnings"] == [] and found["operating_point"]["ball_load"] == pytest.approx(48.72, rel=1e-3)
    text = file.read_text()
    tiny = text.replace("# n = 128 ", "n = 32 ").replace("# n_transient = 128", "n_transient = 32")
    assert tiny != text
    file.write_text(tiny)
    assert json.loads(call("validate", file, "--json", "-").out)["stages"][0]["n"] == 32


def test_it_replaces_nothing_without_force(call, refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text("kept")
    refused(("study.toml", "a new file", "--force"), "init")
    assert (tmp_path / "study.toml").read_text() == "kept"
    said = call("init", "--force")
    assert said.code == 0 and "ehlcontact run study.toml" in said.out and "6205 in ISO VG 68 at 50 °C" in said.out
    assert load_study(tmp_path / "study.toml").bearing.catalogue == "6205"
    assert json.loads(call("init", "other.toml", "--json", "-").out)["study"] == "other.toml"


def test_a_study_by_its_bearings_name(refused, tmp_path, study):
    """Entries beside the name replace those of the catalogue; a name that is none is told."""
    file = study()
    text = file.read_text()
    file.write_text(text.replace("# conformity = 0.52", "conformity = 0.515"))
    assert load_study(file).bearing.conformity == 0.515 and load_study(file).bearing.balls == 9
    file.write_text(text.replace('catalogue = "6205"', 'catalogue = "6025"'))
    refused(("bearing.catalogue = '6025'", "6205", "nearest", "by its dimensions"), "validate", file)
    file.write_text(text.replace('catalogue = "6205"', 'name = "mine"'))
    refused(("bearing.balls", "given", 'catalogue = "6205"'), "validate", file)
    file.write_text(text.replace('catalogue = "6205"', "catalogue = 6205"))
    refused(("bearing.", "must be"), "validate", file)
