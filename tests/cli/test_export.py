"""``ehlcontact export``: platforms, files that are kept, compilers that fail; rotors of studies."""

import json
import os
import shutil
import subprocess
import tempfile
import zipfile
from importlib import import_module
from math import pi
from pathlib import Path

import fmpy
import pytest
from programs import ROOT, command, environment, shell_script
from tiny_study import SMALL

from ehlcontact import kernel_cache, save
from ehlcontact.binaries import this_machine
from ehlcontact.cli.study.exports import export_fmu
from ehlcontact.cli.study.rotor import build_rotor
from ehlcontact.cli.study.schema import load_study
from reduced_models import Atlas, SpringContact

STUDY = ROOT / "examples" / "small_study.toml"
CUBIC = {"K1": 0.624, "K2": 0.750, "K3": -0.174, "C1": 0.0130, "low": 0.75, "high": 1.0}


@pytest.fixture
def element(tmp_path):
    """An element file; nothing beside it may stay when a command is refused."""
    return save(SpringContact.cubic(**CUBIC), tmp_path / "e.json")


def beside(element):
    return sorted(path.name for path in element.parent.iterdir() if path != element)


def test_a_file_that_is_there_needs_force(call, refused, element, monkeypatch):
    target = element.with_name("mit Leerzeichen ä.fmu")
    target.write_text("kept")
    with monkeypatch.context() as patch:
        patch.setattr(import_module("fmu.export"), "export_model", None)  # never reached
        refused(("--output", target.name, "a new file, or replaced with --force"), "export", element, "-o", target)
    assert target.read_text() == "kept"
    result = call("export", element, "-o", target, "--force")
    assert result.code == 0 and result.err == "" and zipfile.is_zipfile(target)


def test_platforms(call, element):
    """Named twice, or by the other version's name, it is one; two Macs share a folder of FMI 2."""
    target = element.with_name("x.fmu")
    own = this_machine().name
    options = ("--platform", "aarch64-darwin", "--platform", own, "--platform", own)
    result = call("export", element, "-o", target, *options, "--json", "-")
    assert result.code == 0, result
    document = json.loads(result.out)
    assert document["passes"] is True and document["platforms"] == sorted({own, "aarch64-darwin"}, reverse=True)
    names = {Path(name).parts[1] for name in zipfile.ZipFile(target).namelist() if name.startswith("binaries/")}
    assert names == {this_machine().fmi2, "darwin64"}


def test_coefficients_that_no_fmu_can_have(refused, element, tmp_path):
    good = json.loads(element.read_text())

    def made(**parameters):
        element.write_text(json.dumps(good | {"parameters": good["parameters"] | parameters}))
        return element

    target = ("-o", tmp_path / "x.fmu")
    refused(("e.json: spring at low", "units"), "export", made(K1=1.7e308), *target)
    refused(("e.json", "400 digits"), "export", made(K1=int("9" * 400)), *target)
    text = json.dumps(good)
    for old, new, word in (
        ("0.624", "9" * 5000, "5000 digits"),
        ('"fit": null', '"fit": ' + '{"a": ' * 100_000 + "1" + "}" * 100_000, "nested too deeply"),
        ('"fit": null', '"fit": {"a": "\\ud800"}', "lone surrogate"),
    ):
        assert old in text
        element.write_text(text.replace(old, new))
        refused(("e.json", word), "export", element, *target)
    assert beside(element) == []


@pytest.mark.skipif(os.name != "posix", reason="a shell script as the compiler")
def test_compilers_that_fail(refused, element, tmp_path, monkeypatch, tmp_path_factory):
    folder = tmp_path_factory.mktemp("compiler")
    monkeypatch.setattr("ehlcontact.binaries.process.LONGEST_RUN", 0.3)
    for line, words in {
        "gcc 'x": ("EHLCONTACT_CC = ", "command line (no closing quotation)"),
        "/none/cc": ("no FMU was written", "cannot start the C compiler /none/cc"),
        shell_script(folder / "cc", "exit 0"): ("no FMU was written", "made no library"),
    }.items():
        monkeypatch.setenv("EHLCONTACT_CC", line)
        refused(words, "export", element, "-o", tmp_path / "x.fmu")
    for text, words in {
        "seq 1000; exit 4": ("exit code 4", "; 999; 1000"),
        "kill -9 $$": ("was killed (SIGKILL)",),
        "sleep 60": ("took more than 0.3 s",),
    }.items():
        monkeypatch.setenv("EHLCONTACT_CC", shell_script(folder / "cc", text))
        refused(("no FMU was written", *words), "export", element, "-o", tmp_path / "x.fmu")
    assert beside(element) == []


def test_a_compiler_may_be_named_from_here(call, element, monkeypatch):
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    shell_script(element.parent / "cc", 'exec gcc "$@"')
    monkeypatch.chdir(element.parent)
    monkeypatch.setenv("EHLCONTACT_CC", "./cc -O1")
    assert call("export", element, "-o", "x.fmu").code == 0


@pytest.mark.filterwarnings("always")
def test_a_disk_without_room(call, refused, full_disk, element, tmp_path_factory, monkeypatch):
    """For the FMU itself, for the compiler, or for what is kept of it: the last costs time and a warning."""
    where, fresh = element.with_name("x.fmu"), str(tmp_path_factory.mktemp("cache"))
    refused(("No space left on device",), "export", element, "-o", full_disk / "x.fmu")
    for cache, word in ((os.environ["EHLCONTACT_CACHE"], "no room to verify"), (fresh, "no room to compile")):
        with monkeypatch.context() as patch:
            patch.setattr(tempfile, "tempdir", str(full_disk))
            patch.setenv("EHLCONTACT_CACHE", cache)
            found = call("export", element, "-o", where)
        assert (found.code, found.out) == (2, "")
        (line,) = found.err.splitlines()
        assert line.startswith(f"ehlcontact: no FMU was written: {word} in {full_disk} (No space left")
    assert not where.exists()
    monkeypatch.setenv("EHLCONTACT_CACHE", str(full_disk))
    monkeypatch.setattr(kernel_cache, "_given", set())
    found = call("export", element, "-o", where)
    assert found.code == 0 and zipfile.is_zipfile(where)
    (line,) = found.err.splitlines()
    assert line.startswith("ehlcontact: warning: compiled code is not kept") and "No space left on device" in line


@pytest.mark.long
def test_without_a_home_or_a_network(element, tmp_path):
    """Nothing is looked up, and nothing has to be kept."""
    unshare = [] if shutil.which("unshare") is None else ["unshare", "-n"]
    if unshare and subprocess.run([*unshare, "true"], capture_output=True, check=False).returncode != 0:
        unshare = []
    (tmp_path / "file").write_text("")
    nowhere = str(tmp_path / "file" / "home")
    own = environment(HOME=nowhere, EHLCONTACT_CACHE="", XDG_CACHE_HOME="")
    full = [*unshare, *command("export", element, "-o", tmp_path / "x.fmu")]
    done = subprocess.run(full, capture_output=True, text=True, check=False, env=own, timeout=300)
    assert done.returncode == 0, done.stderr
    assert zipfile.is_zipfile(tmp_path / "x.fmu")


@pytest.mark.parametrize("what", ["EHLCONTACT_CC", "folder", "bug"])
def test_error_of_an_fmu_in_the_results_of_a_study(tmp_path, monkeypatch, what):
    target = tmp_path / "contact.fmu"
    if what == "EHLCONTACT_CC":
        monkeypatch.setenv("EHLCONTACT_CC", "'")
    elif what == "folder":
        target = tmp_path / "none" / "contact.fmu"
    else:
        monkeypatch.setattr(import_module("fmu.export"), "fmu_files", lambda *_: {}[what])
    found = export_fmu(SpringContact.cubic(**CUBIC), target)
    assert found["file"] == "contact.fmu" and found["passes"] is False
    assert what in found["error"] and "\n" not in found["error"]
    json.dumps(found, allow_nan=False)


@pytest.mark.long
def test_a_study_as_a_system(call, refused, element, tmp_path):
    """Rotor and contacts, each its FMU; an element alone is no system."""
    target = tmp_path / "rotor.ssp"
    result = call("export", STUDY, "-o", target, "--json", "-", "--name", "of a study")
    document = json.loads(result.out)
    assert result.code == 0 and document["passes"] is True and document["system"] == str(target)
    assert document["fmi"] == "2.0"
    assert document["step"] > 0.0 and 0.0 < document["deviation"] < 0.01
    with zipfile.ZipFile(target) as archive:
        assert set(archive.namelist()) == {
            "SystemStructure.ssd",
            "resources/rotor.fmu",
            "resources/contact_1.fmu",
        }
        assert b'name="of a study"' in archive.read("SystemStructure.ssd")
    kept = target.read_bytes()
    refused(("--output", "--force"), "export", STUDY, "-o", target)
    assert target.read_bytes() == kept
    table = call("export", STUDY, "-o", target, "--force")
    assert table.code == 0 and "wired" in table.out and f"{document['step']:g} s" in table.out
    assert any(line.split()[:2] == ["FMI", "2.0"] for line in table.out.splitlines())
    refused(("--output", ".fmu", "a study (.toml) with a rotor"), "export", element, "-o", tmp_path / "x.ssp")


@pytest.mark.long
def test_a_study_becomes_its_rotor(call, tmp_path):
    """On the atlas's contacts, at rest under the load of the study."""
    target = tmp_path / "rotor.fmu"
    done = call("export", STUDY, "-o", target, "--json", "-")
    assert done.code == 0, done
    document = json.loads(done.out)
    assert document["passes"] is True and document["units"] == "SI" and document["motion"] < 1e-6
    study = load_study(STUDY)
    rotor = build_rotor(study)
    rest = rotor.on([Atlas().element(study.point)] * len(rotor.mounts)).equilibrium()
    starts = {v.name: v.start for v in fmpy.read_model_description(str(target)).modelVariables}
    assert float(starts["journal.y"]) == pytest.approx(rest[rotor.nodes["journal"]["y"]], rel=1e-12)
    assert float(starts["speed"]) == pytest.approx(study.speed_rpm * pi / 30.0, rel=1e-15)
    assert float(starts["unbalance[1]"]) == study.jeffcott.unbalance


@pytest.mark.long
def test_a_rotor_on_an_element_of_ones_own(call, tmp_path):
    """Dimensionless or in SI it is the same contact."""
    scales = load_study(STUDY).point.scales
    found = []
    for name, element in (
        ("one", SpringContact.cubic(**CUBIC)),
        ("si", SpringContact.cubic(**CUBIC).to_si(scales)),
    ):
        file, target = save(element, tmp_path / f"{name}.json"), tmp_path / f"{name}.fmu"
        done = call("export", STUDY, "-o", target, "--contact", file, "--fmi", "3")
        assert done.code == 0 and "cubic" in done.out and "step" in done.out, done
        found.append(target.read_bytes())
    assert found[0] == found[1]


def test_rotors_that_cannot_be_exported(refused, tmp_path):
    target = tmp_path / "x.fmu"
    text = STUDY.read_text()
    start, end = text.index("[full_films]"), text.index("[in_time]")
    bare = tmp_path / "bare.toml"
    bare.write_text(text[:start] + text[end:])
    refused(("bare.toml", "a study with [full_films]"), "export", bare, "-o", target)
    element = save(SpringContact.cubic(**CUBIC), tmp_path / "e.json")
    refused(("--contact", "left out"), "export", element, "-o", target, "--contact", element)
    refused(("nothing.json",), "export", STUDY, "-o", target, "--contact", tmp_path / "nothing.json")
    broken = tmp_path / "broken.toml"
    broken.write_text(text.replace("mass = 1.5", "mass = -1.5"))
    refused(("broken.toml", "disc.mass"), "export", broken, "-o", target)
    assert not target.exists()


BEARING = ROOT / "examples" / "bearing_6205.toml"


@pytest.mark.long
def test_a_bearing_file_becomes_the_fmu_of_its_bearing(call, refused, tmp_path):
    target = tmp_path / "6205.fmu"
    result = call("export", BEARING, "-o", target, "--json", "-")
    assert result.code == 0, result
    found = json.loads(result.out)
    assert found["passes"] and found["bearing"] < 1e-9 and found["rates"] < 1e-7 and found["units"] == "SI"
    about = fmpy.read_model_description(str(target))
    assert about.modelExchange is not None
    starts = {variable.name: variable.start for variable in about.modelVariables}
    assert {"x", "y", "speed"} <= starts.keys() and "z" not in starts
    assert float(starts["y"]) < -1e-6  # at rest under the load of the file
    refused(("--output", "x.ssp", "a file name ending in .fmu"), "export", BEARING, "-o", tmp_path / "x.ssp")
    refused(
        ("--contact", "e.json", "left out"), "export", BEARING, "-o", tmp_path / "x.fmu", "--contact", "e.json"
    )
    tilted = tmp_path / "tilted.toml"
    text = BEARING.read_text(encoding="utf-8")
    tilted.write_text(text.replace("radial_load", "tilt_x_mrad = 1.0\naxial_load = 100.0\nradial_load"), "utf-8")
    refused(("operation.tilt_x_mrad", "1.0", "left out"), "export", tilted, "-o", tmp_path / "x.fmu")
    paired = tmp_path / "paired.toml"
    text = text.replace('"6205"', '"7205"').replace("clearance = ", 'pair = "back-to-back"\npreload = 100.0\n# ')
    paired.write_text(text, "utf-8")
    refused(("support.pair", "the FMU is that of one bearing"), "export", paired, "-o", tmp_path / "x.fmu")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["6205.fmu", "paired.toml", "tilted.toml"]


@pytest.mark.long
@pytest.mark.filterwarnings("default::reduced_models.elements.validity.OutsideValidityWarning")
def test_heat_and_a_layer_of_oil_in_fmus(call, tmp_path):
    """The FMU of a bearing has its heated films and its layer; what its elements leave out is said on stderr."""
    text = BEARING.read_text(encoding="utf-8").replace("[1000, 3000, 6000]", "[3000]")
    file = tmp_path / "starved.toml"
    file.write_text(text.replace("radial_load", "thermal = true\nlayer_ratio = 1.0\nradial_load"), "utf-8")
    done = call("export", file, "-o", tmp_path / "starved.fmu")
    assert done.code == 0 and "verified" in done.out and "warning: 6205: under this layer" in done.err, done
    with zipfile.ZipFile(tmp_path / "starved.fmu") as archive:
        pages = [archive.read(name).decode() for name in archive.namelist() if name.endswith(".html")]
    words = "a layer of 1 times what the flooded isothermal film lets through, that heat up", "below zero below"
    assert all(any(one in page for page in pages) for one in words)


@pytest.mark.long
@pytest.mark.filterwarnings("default::reduced_models.elements.validity.OutsideValidityWarning")
def test_a_layer_of_oil_in_the_fmu_of_a_rotor(call, tmp_path):
    study = STUDY.read_text(encoding="utf-8").replace("[operation]", "[operation]\nlayer_ratio = 1.0")
    (tmp_path / "s.toml").write_text(study, "utf-8")
    done = call(
        "export", tmp_path / "s.toml", "-o", tmp_path / "r.fmu", "--bearings", "inside", "--inertia", "0.001"
    )
    assert done.code == 0 and "where a ball carries" in done.err, done
    about = fmpy.read_model_description(str(tmp_path / "r.fmu"))
    assert "; bearing 1: where a ball carries" in about.description


@pytest.mark.long
def test_a_study_becomes_a_rotor_with_its_bearings(call, tmp_path):
    fmu = tmp_path / "rotor.fmu"
    done = call("export", STUDY, "--bearings", "inside", "--inertia", "0.001", "-o", fmu, "--json", "-")
    assert done.code == 0, done
    found = json.loads(done.out)
    assert found["passes"] is True and 0.0 < found["motion"] < 1e-9
    about = {v.name for v in fmpy.read_model_description(str(fmu)).modelVariables}
    assert {"torque", "speed", "bearing[2].smallest_film", "disc.force_x"} < about


@pytest.mark.long
def test_a_study_becomes_a_shaft_and_a_system(call, refused, tmp_path):
    """Its rotor between its whole bearings, whose FMUs are outside or wired."""
    drive, shaft = tmp_path / "drive.ssp", tmp_path / "shaft.fmu"
    more = "--bearings", "wired", "--inertia", "0.001", "--top-rpm", "6000"
    done = call("export", STUDY, *more, "-o", drive, "--json", "-")
    assert done.code == 0, done
    found = json.loads(done.out)
    assert found["passes"] is True and 0.0 < found["deviation"] < 0.02
    with zipfile.ZipFile(drive) as archive:
        assert set(archive.namelist()) == {
            "SystemStructure.ssd",
            "resources/rotor.fmu",
            "resources/bearing_1.fmu",
            "resources/bearing_2.fmu",
        }
    done = call("export", STUDY, "--bearings", "outside", "-o", shaft)
    assert done.code == 0 and "model exchange" in done.out and "2 supports outside" in done.out, done
    about = {v.name: v for v in fmpy.read_model_description(str(shaft)).modelVariables}
    study = load_study(STUDY)
    assert float(about["speed"].start) == pytest.approx(study.speed_rpm * pi / 30.0, rel=1e-15)
    assert float(about["bearing[1].force_y"].start) == pytest.approx(study.radial_load, rel=1e-3)


def test_rotors_on_bearings_that_cannot_be_exported(refused, tmp_path):
    fmu, ssp = tmp_path / "x.fmu", tmp_path / "x.ssp"
    bare = tmp_path / "bare.toml"
    inside, outside, wired = (("--bearings", way) for way in ("inside", "outside", "wired"))
    bare.write_text(SMALL, "utf-8")
    for words, arguments in (
        (("--bearings = 'away'", "inside, outside or wired"), (STUDY, "--bearings", "away", "-o", fmu)),
        (("--inertia", "> 0"), (STUDY, *wired, "--inertia", "0", "-o", ssp)),
        (("--inertia", "--bearings"), (STUDY, "--inertia", "1", "-o", fmu)),
        (("--top-rpm", "at least the speed"), (STUDY, *wired, "--inertia", "1", "--top-rpm", "9", "-o", ssp)),
        (("--output", ".fmu"), (STUDY, *outside, "-o", ssp)),
        (("--output", ".ssp"), (STUDY, *wired, "-o", fmu)),
        (("--top-rpm", "at least the speed"), (STUDY, *inside, "--top-rpm", "9", "-o", fmu)),
        (("--output", ".fmu"), (STUDY, *inside, "-o", ssp)),
        (("--top-rpm", "no part of the FMU"), (STUDY, *outside, "--top-rpm", "6000", "-o", fmu)),
        (("--lead", "left out"), (STUDY, *outside, "--lead", "1", "-o", fmu)),
        (("--contact", "left out"), (STUDY, *outside, "--contact", "e.json", "-o", fmu)),
        (("--bearings", "[shaft]"), (BEARING, *outside, "-o", fmu)),
        (("bare.toml", "[shaft]"), (bare, *outside, "-o", fmu)),
    ):
        refused(words, "export", *arguments)
    assert not fmu.exists() and not ssp.exists()
