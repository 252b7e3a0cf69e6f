"""The study that `init` writes: it runs as it is, and has every entry of the schema with its default."""

import json
import re
import tomllib

import pytest

from ehlcontact.cli.entries import keys_of, meaning_of, section_of
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.machine import bearing_of
from ehlcontact.cli.study.schema import Study, load_study, study_of
from ehlcontact.cli.study.sections import FullFilms
from ehlcontact.lubricant.oil import GRADES
from reduced_models import BallBearing
from reduced_models.bearing.catalogue import DEEP_GROOVE

SHOWN = re.compile(r"^# (\w+ = (?!\?))", flags=re.M)  # a default


def sections(model=Study, above=""):
    """Sections of the schema, and those in them, by their names in the file."""
    for name, field in model.model_fields.items():
        if (section := section_of(field.annotation)) is not None:
            yield f"{above}{name}", section
            yield from sections(section, f"{above}{name}.")


@pytest.fixture
def study(call, tmp_path):
    """The file that `init` writes with some options."""

    def made(*options):
        file = tmp_path / "study.toml"
        assert call("init", file, "--force", *options).code == 0
        return file

    return made


def test_every_entry_of_the_schema_is_explained():
    assert len(dict(sections())) > 10
    for name, model in sections():
        assert model.__doc__, name
        entries = [key for key, field in keys_of(model).items() if section_of(field.annotation) is None]
        assert [key for key in entries if not meaning_of(model.model_fields[key])] == [], name


def test_options_are_entries_of_the_study(study):
    file = study("--bearing", "6206", "--oil", "vg46", "--temp", "65", "--speed-rpm", "1500", "--load", "250")
    found, bearing = load_study(file), BallBearing.catalogue("6206")
    assert (found.oil.iso_vg, found.oil.temperature, found.oil.label) == (46, 65.0, "ISO VG 46 at 65 °C")
    assert (found.speed_rpm, found.radial_load, found.carrier.label) == (1500.0, 250.0, "6206")
    assert bearing_of(found, 0).pitch_diameter == bearing.pitch_diameter
    assert found.shaft is None and found.contact is not None and found.full_films is None


def test_commented_lines_are_the_defaults(study):
    """With every # before a default taken away the study is the same; and every entry has its line."""
    file = study()
    text = file.read_text()
    document = tomllib.loads(SHOWN.sub(r"\1", text))
    shown, own = study_of(document).model_dump(), load_study(file).model_dump()
    (support,), (bare,) = shown.pop("support"), own.pop("support")
    assert shown == own and {key: support[key] for key in bare if bare[key] is not None or key == "spring"} == {
        key: value for key, value in bare.items() if value is not None or key == "spring"
    }
    assert support["balls"] == 9 and bare["balls"] is None  # its dimensions are those of its name
    for section, model in sections():
        several = section.partition(".")[0] in ("disc", "support", "damper", "defect")
        head = f"[[{section}]]" if several else f"[{section}]"
        part = text.partition(f"{head}\n")[2].partition("\n[")[0].partition("\n#[")[0]
        for key, entry in model.model_fields.items():
            if section_of(entry.annotation) is None:
                lines = re.findall(rf"^#? ?(?:# )?{key} = ", part, flags=re.M)
                assert len(lines) == 1, (section, key)
            if (
                isinstance(document.get(section), dict)
                and not entry.is_required()
                and isinstance(entry.default, float | int)
            ):
                assert document[section].get(key, entry.default) == entry.default, (section, key)
    assert max(map(len, text.splitlines())) <= 115


def test_a_section_that_is_left_out_comes_with_its_lines(study):
    """Taking away the # before its lines is all: with [full_films] the rotor on full films is run too."""
    file = study()
    before, _, rest = file.read_text().partition("#[full_films]\n")
    part, mark, after = rest.partition("\n#[")
    lines = "\n".join(line.removeprefix("#") if line.startswith("##") else line for line in part.splitlines())
    file.write_text(f"{before}[full_films]\n{lines}\n{mark}{after}")
    assert load_study(file).full_films == FullFilms()


def test_lines_end_in_what_the_schema_allows(study):
    text = study().read_text().partition("#[full_films]")[0]
    lines = {line.split(" = ")[0].strip("# "): line for line in text.splitlines() if " = " in line}
    for key, words in {
        "race": '"inner" or "outer"',
        "n": "a multiple of 16 between 16 and 2048",
        "amplitude": "above 0 and below 1",
        "temperature": "between 20 and 120 C",
        "speed_rpm": "between 0.001 and 1e+06 rev/min",
    }.items():
        assert lines[key].endswith(words), lines[key]
    assert ", ".join(map(str, GRADES)) in text


MOTOR = ("--bearing", "6306", "--bearing", "6206", "--span", "300", "--shaft-diameter", "35", "--disc-diameter")
MOTOR += ("110", "--disc-width", "120", "--unbalance", "1e-5", "--preload", "200", "--clearance", "CN", "--rq")
MOTOR += ("0.1", "--oil", "32", "--temp", "80", "--speed-rpm", "15000")


def test_a_motor(study):
    """Two unequal bearings under a shaft with a disc, a spring on the second one."""
    found = load_study(study(*MOTOR))
    assert found.names == ("left", "right") and found.contact is None and found.shaft.length_mm == 360.0
    assert [(one.bearing, one.position_mm, one.clearance) for one in found.support] == [
        ("6306", 30.0, "CN"),
        ("6206", 330.0, "CN"),
    ]
    assert (found.support[1].spring, found.disc[0].position_mm, found.roughness) == (200.0, 180.0, (0.0, 1e-7))
    other = load_study(study(*MOTOR, "--shaft-length", "400", "--contact"))
    assert other.contact is not None and [one.position_mm for one in other.support] == [50.0, 350.0]


def test_an_oil_by_its_data_sheet(study, refused, tmp_path):
    found = load_study(study("--nu40", "67", "--nu100", "9.1", "--temp", "60"))
    assert (found.oil.nu40, found.oil.nu100, found.oil.iso_vg) == (67.0, 9.1, None)
    refused(("--nu100 = None", "given"), "init", tmp_path / "s.toml", "--nu40", "67")


def test_a_spindle(study):
    """A pair, preloaded, and a bearing that floats."""
    options = ("--bearing", "7205", "--bearing", "6204", "--positions", "40", "240", "--shaft-length", "300")
    file = study(*options, "--pair", "back-to-back", "--preload", "150", "--disc-mass", "2")
    found = load_study(file)
    assert (found.support[0].pair, found.support[0].preload, found.support[1].spring) == ("back-to-back", 150, 0)
    assert found.shaft.diameter_mm == 25.0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (MOTOR[:4], ("--span = None", "given, with two bearings")),
        ((*MOTOR[:4], "--span", "300"), ("--disc-mass = None", "given, with two bearings")),
        ((*MOTOR, "--positions", "30", "330"), ("--span = 300", "left out where --positions")),
        ((*MOTOR, "--bearing", "6205"), ("--bearing = 3", "once or twice")),
        ((*MOTOR, "--load", "5", "--load", "6"), ("--load", "once")),
        (("--span", "300"), ("--span = 300", "with two bearings")),
        (("--preload", "200"), ("--preload = 200", "without --pair")),
        ((*MOTOR[:4], "--positions", "30", "30"), ("--positions = (30.0, 30.0)", "two places", "--pair")),
        (
            (*MOTOR, "--shaft-diameter", "120", "--disc-diameter", "110", "--disc-width", "20"),
            ("--disc-diameter = 110", "above 120 mm, the diameter of the shaft"),
        ),
        (
            (*MOTOR, "--shaft-diameter", "0.035"),
            ("--shaft-diameter = 0.035", "in m? then 35 mm"),
        ),
        ((*MOTOR, "--preload", "2e5"), ("--preload = 200000", "a ball carries at most")),
        (("--oil", "VG 30"), ("--oil = 'VG 30'", "--nu40 and --nu100")),
        (("--clearance", "C9"), ("--clearance = 'C9'", "C2")),
    ],
)
def test_what_is_no_machine(refused, tmp_path, options, words):
    refused(words, "init", tmp_path / "s.toml", *options)
    assert not (tmp_path / "s.toml").exists()


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
    assert entry in tomllib.loads(file.read_text())["contact"]
    said = " ".join(file.read_text().replace("\n# ", " ").split())
    assert "too small for this film" in said
    assert all("the library chooses none finer" in caution for caution in cautions(load_study(file)))


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
    assert load_study(tmp_path / "study.toml").carrier.bearing == "6205"
    assert json.loads(call("init", "other.toml", "--json", "-").out)["study"] == "other.toml"


def test_a_study_by_its_bearings_name(refused, tmp_path, study):
    """Entries beside the name replace those of the catalogue; a name that is none is told."""
    file = study()
    text = file.read_text()
    lines = [line for line in text.splitlines() if line.startswith("# conformity = ")]
    file.write_text(text.replace(lines[0], "conformity = 0.515"))
    assert bearing_of(load_study(file), 0).conformity_outer == 0.515 and bearing_of(load_study(file), 0).balls == 9
    file.write_text(text.replace('bearing = "6205"', 'bearing = "6025"'))
    refused(("support.bearing = '6025'", "6205", "nearest", "by its dimensions"), "validate", file)
    file.write_text(text.replace('bearing = "6205"', 'name = "mine"', 1))
    refused(("support.balls", "given", 'bearing = "6205"'), "validate", file)
    file.write_text(text.replace('bearing = "6205"', "bearing = 6205", 1))
    refused(("support.bearing", "must be"), "validate", file)
