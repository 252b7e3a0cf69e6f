"""The C core: compiled once, loaded, and named where it cannot be."""

import ctypes
import os
import sys

import pytest

from ehlcontact.binaries import BuildError
from reduced_models import core


def test_loaded_once():
    library = core.library()
    assert library is core.library()
    library.race_cutoff.restype = ctypes.c_double  # a function of the core
    assert library.bearing_press is not None


def no_compiler(monkeypatch):
    monkeypatch.setattr("ehlcontact.binaries.compiler.SYSTEM", ())
    monkeypatch.setattr("ehlcontact.binaries.compiler.find_spec", lambda name: None)


@pytest.fixture
def afresh():
    core._loaded.cache_clear()
    yield
    core._loaded.cache_clear()


def test_a_compiler_that_fails_is_named(afresh, tmp_path, monkeypatch):
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path))
    monkeypatch.setenv("EHLCONTACT_CC", "/none/cc")
    assert core.library() is not None  # by another compiler of this machine
    core._loaded.cache_clear()
    no_compiler(monkeypatch)
    monkeypatch.setenv("EHLCONTACT_CC", "false")
    with pytest.raises(BuildError, match=r"^the C compiler failed with exit code 1: false "):
        core.library()


def test_a_missing_compiler_is_named(afresh, tmp_path, monkeypatch):
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path))
    monkeypatch.delenv("EHLCONTACT_CC")
    no_compiler(monkeypatch)
    with pytest.raises(BuildError, match=r"^no C compiler for \S+: pip install ziglang, install gcc or set EHLC"):
        core.library()


def test_a_library_that_the_system_refuses_is_named(afresh, monkeypatch):
    monkeypatch.setattr(core, "build_library", lambda *_: b"not a library")
    with pytest.raises(BuildError, match=r"^the C core cannot be loaded from "):
        core.library()


@pytest.fixture
def no_temporary_folder(afresh, monkeypatch):
    core.library()  # so that it is kept
    core._loaded.cache_clear()

    def none(*_, **__):
        raise FileNotFoundError(2, "No usable temporary directory found in ['/none']")

    monkeypatch.setattr("tempfile.mkdtemp", none)
    monkeypatch.setattr("tempfile.gettempdir", none)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no files in memory")
def test_without_a_temporary_folder_it_is_loaded_from_memory(no_temporary_folder):
    """A kept library, of a container whose folders are all read-only."""
    open_files = os.listdir("/proc/self/fd")
    assert core.library().bearing_press is not None
    assert len(os.listdir("/proc/self/fd")) == len(open_files)


def test_no_temporary_folder(no_temporary_folder, monkeypatch):
    """Nothing to load the library from, and nothing to compile it in."""
    monkeypatch.setattr(sys, "platform", "another")
    with pytest.raises(BuildError, match=r"^the C core cannot be loaded .*No usable temporary .*TMPDIR names"):
        core.library()
    monkeypatch.setattr("ehlcontact.binaries.cache.recall", lambda key: None)
    with pytest.raises(BuildError, match=r"^no room to compile in \S+ \(No usable temporary directory found"):
        core.library()


def test_the_command_line_says_so_in_one_line(monkeypatch, capsys):
    """No compiler for the core is a matter of the machine: exit code 2."""
    from ehlcontact.cli import app

    def refuse(_):
        raise BuildError("no C compiler")

    monkeypatch.setattr(app, "_invoke", refuse)
    assert app.execute(["bearing"]) == 2
    assert capsys.readouterr().err == "ehlcontact: no C compiler\n"
