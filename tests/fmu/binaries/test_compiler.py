"""Which compiler is taken, and what is said where there is none."""

import sys

import pytest

from ehlcontact import InputError
from fmu.binaries import PLATFORMS, BuildError, this_machine
from fmu.binaries.compiler import compilers

OWN = this_machine()
OTHER = PLATFORMS["x86_64-windows" if OWN.system != "windows" else "x86_64-linux"]


@pytest.fixture(autouse=True)
def undecided(monkeypatch):
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)


def put(folder, name, text="exit 0"):
    """A program for PATH."""
    program = folder / name
    program.write_text(f"#!/bin/sh\n{text}\n")
    program.chmod(0o755)
    return program


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
    monkeypatch.setattr("fmu.binaries.compiler.find_spec", lambda name: None)
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
