"""Platforms of an FMU's binaries, the compiler of each, and the recipe to build them elsewhere."""

import platform
import sys
from pathlib import Path
from zipfile import ZipFile

import fmpy
import pytest
from bearing_fmus import bearing
from lxml import etree
from programs import shell_script

from ehlcontact import InputError
from ehlcontact.binaries import PLATFORMS, BuildError, choose, this_machine
from ehlcontact.binaries.compiler import compilers
from fmu import export
from fmu.model_description import build_description


def names(*chosen):
    return [one.name for one in chosen]


def test_this_machine_is_the_default_and_is_fmpys():
    own = this_machine()
    assert own.name == fmpy.platform_tuple and choose(None, 3) == (own,)
    if own.fmi2 is not None:
        assert own.fmi2 == fmpy.platform and choose(None, 2) == (own,)


def test_all_and_each_by_either_name():
    assert names(*choose("all", 3)) == list(PLATFORMS)
    assert names(*choose("all", 2)) == [name for name in PLATFORMS if name != "aarch64-linux"]
    assert names(*choose("win64", 2)) == names(*choose(["x86_64-windows"], 2)) == ["x86_64-windows"]
    assert names(*choose(["darwin64"], 2)) == ["x86_64-darwin", "aarch64-darwin"]
    twice = choose(("aarch64-darwin", "linux64", "x86_64-linux", "aarch64-darwin"), 2)
    assert names(*twice) == ["x86_64-linux", "aarch64-darwin"]


@pytest.mark.parametrize("bad", ["linux", "win32", "LINUX64", "", "x86_64-linux,win64", None, 64])
def test_unknown_ones_are_named_with_those_there_are(bad):
    with pytest.raises(InputError) as error:
        choose([bad], 2)
    line = str(error.value)
    assert line.startswith(f"platforms = {bad!r}: must be x86_64-linux, x86_64-windows, ") and "\n" not in line
    assert line.endswith("or all") and "aarch64-linux" not in line


def test_folders_of_both_versions():
    assert [one.folder(3) for one in PLATFORMS.values()] == list(PLATFORMS)
    assert {name: one.folder(2) for name, one in PLATFORMS.items()} == {
        "x86_64-linux": "linux64",
        "aarch64-linux": None,
        "x86_64-windows": "win64",
        "x86_64-darwin": "darwin64",
        "aarch64-darwin": "darwin64",
    }


def test_none_at_all():
    with pytest.raises(InputError, match="one or more of x86_64-linux"):
        choose([], 3)


def test_linux_on_arm_is_for_fmi_3():
    with pytest.raises(InputError, match="FMI 2 has no folder for it, FMI 3 has"):
        choose("aarch64-linux", 2)
    assert names(*choose("aarch64-linux", 3)) == ["aarch64-linux"]


@pytest.mark.parametrize(
    ("system", "machine", "name"),
    [
        ("Linux", "x86_64", "x86_64-linux"),
        ("Linux", "aarch64", "aarch64-linux"),
        ("Windows", "AMD64", "x86_64-windows"),
        ("Darwin", "arm64", "aarch64-darwin"),
        ("Darwin", "x86_64", "x86_64-darwin"),
        ("Linux", "riscv64", None),
        ("Windows", "ARM64", None),
        ("FreeBSD", "amd64", None),
    ],
)
def test_machines_as_python_calls_them(monkeypatch, system, machine, name):
    monkeypatch.setattr(platform, "system", lambda: system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    own = this_machine()
    assert own is (None if name is None else PLATFORMS[name])
    if name is None:
        with pytest.raises(InputError, match=f"not built for this machine, {system} {machine}"):
            choose(None, 3)
    elif name == "aarch64-linux":
        with pytest.raises(InputError, match=r"this machine is aarch64-linux, and FMI 2 has no folder"):
            choose(None, 2)


OWN = this_machine()
OTHER = PLATFORMS["x86_64-windows" if OWN.system != "windows" else "x86_64-linux"]


@pytest.fixture(autouse=True)
def undecided(monkeypatch):
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)


def put(folder, name, text="exit 0"):
    """A program for PATH."""
    return shell_script(folder / name, text)


@pytest.mark.skipif(sys.platform == "win32", reason="the system's compiler is not looked for on Windows")
def test_the_systems_own_is_first_for_this_machine(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    put(tmp_path, "gcc")
    first, *rest = compilers(OWN)
    assert first.command == ("gcc",) and not first.is_zig and [one.is_zig for one in rest] == [True]
    put(tmp_path, "cc")
    assert compilers(OWN)[0].command == ("cc",)


def test_zig_for_all_others():
    (only,) = compilers(OTHER)
    assert only.is_zig and only.command[-3:] == ("cc", "-target", OTHER.target)
    assert str(only.command[0]) not in only.label and "zig" in only.label and OTHER.target in only.label


def test_the_users_own_and_no_other(monkeypatch):
    monkeypatch.setenv("EHLCONTACT_CC", '/opt/my cc/cc -m64 "-DX=a b"'.replace("/opt/my cc", "'/opt/my cc'"))
    (only,) = compilers(OWN)
    assert only.command == ("/opt/my cc/cc", "-m64", "-DX=a b")
    assert only.label == "cc -m64 -DX=a b"
    assert all(one.is_zig for one in compilers(OTHER))  # it is this machine's compiler


@pytest.mark.parametrize("line", ["gcc 'x", 'cc "', "cc \\"])
def test_a_command_line_that_cannot_be_read(monkeypatch, line):
    monkeypatch.setenv("EHLCONTACT_CC", line)
    with pytest.raises(InputError, match=r"EHLCONTACT_CC = .*: must be a command line \(no ") as error:
        compilers(OWN)
    assert "\n" not in str(error.value)


def test_none(monkeypatch):
    monkeypatch.setattr("ehlcontact.binaries.compiler.find_spec", lambda name: None)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(BuildError, match=r"^no C compiler for .*: pip install ziglang, install gcc or set EHL"):
        compilers(OWN)
    with pytest.raises(BuildError, match=r"^no C compiler for .*: pip install ziglang$"):
        compilers(OTHER)


def test_another_version_is_another_compiler(monkeypatch, tmp_path):
    """What is kept of the old one is not taken for the new one's."""
    program = put(tmp_path, "mycc")
    monkeypatch.setenv("EHLCONTACT_CC", str(program))
    before = compilers(OWN)[0].identity
    assert compilers(OWN)[0].identity == before
    put(tmp_path, "mycc", "exit 1 # newer")
    changed = compilers(OWN)[0].identity
    monkeypatch.setenv("EHLCONTACT_CC", f"{program} -O0")
    assert len({before, changed, compilers(OWN)[0].identity}) == 3


def test_it_is_valid_and_names_every_file(spec):
    schema = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3BuildDescription.xsd"))
    root = etree.fromstring(build_description(spec.identifier, spec.sources))
    schema.assertValid(root)
    (configuration,) = root.findall("BuildConfiguration")
    assert configuration.get("modelIdentifier") == spec.identifier
    assert [file.get("name") for file in configuration.iter("SourceFile")] == list(spec.sources)
    assert configuration.find("SourceFileSet").get("language") == "C99"
    (library,) = configuration.findall("Library")
    assert (library.get("name"), library.get("external")) == ("m", "true")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the first library for Windows")
def test_bearing_with_tables_at_four_speeds_for_all_platforms_takes_less_than_a_megabyte(tmp_path):
    path = tmp_path / "x.fmu"
    export(bearing("7205"), path, speeds_rpm=(1000.0, 12000.0), load=(0.0, -300.0, 200.0), fmi=3, platforms="all")
    with ZipFile(path) as archive:
        assert sum(name.startswith("binaries/") for name in archive.namelist()) == 5
    assert path.stat().st_size < 1e6
