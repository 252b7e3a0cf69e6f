"""The C core: compiled once, loaded, and named where it cannot be."""

import ctypes

import pytest

from ehlcontact import kernel_cache
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


def test_no_temporary_folder(afresh, monkeypatch):
    """Nothing to load the library from, and nothing to compile it in."""

    def none(*_, **__):
        raise FileNotFoundError(2, "No usable temporary directory found in ['/none']")

    monkeypatch.setattr("tempfile.mkdtemp", none)
    with pytest.raises(BuildError, match=r"^the C core cannot be loaded .*No usable temporary .*TMPDIR names"):
        core.library()
    monkeypatch.setattr("tempfile.gettempdir", none)
    monkeypatch.setattr("ehlcontact.binaries.cache.recall", lambda key: None)
    with pytest.raises(BuildError, match=r"^no room to compile in \S+ \(No usable temporary directory found"):
        core.library()


@pytest.mark.filterwarnings("always")
def test_without_a_cache_there_is_a_warning(afresh, monkeypatch):
    kept = core.build_library({"x.c": b"int x(void) { return 1; }"}, ["x.c"], core.NAME, core.EXPORTED)
    monkeypatch.setattr(core, "build_library", lambda *_: kept)
    monkeypatch.setenv("EHLCONTACT_CACHE", "/dev/null/none")
    monkeypatch.setattr(kernel_cache, "_given", set())
    with pytest.warns(RuntimeWarning, match=r"compiled code is not kept.*EHLCONTACT_CACHE"):
        assert core.library().x() == 1


def test_the_command_line_says_so_in_one_line(monkeypatch, capsys):
    """No compiler for the core is a matter of the machine: exit code 2."""
    from ehlcontact.cli import app

    def refuse(_):
        raise BuildError("no C compiler")

    monkeypatch.setattr(app, "_invoke", refuse)
    assert app.execute(["bearing"]) == 2
    assert capsys.readouterr().err == "ehlcontact: no C compiler\n"
