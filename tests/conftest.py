"""What several test folders share: every steady film is solved once per session; and disks that are full.

``pytest`` and ``pytest -m long`` share their tests among the cores, where pytest-xdist is there. Files or tests
that are named, and slow ones, which take all cores themselves, stay in one process; so does all with ``-n 0`` or a
debugger.
"""

import gc
import os
import shlex
import shutil
import signal
import subprocess
import time
from functools import cache, partial

import pytest

from ehlcontact import Grid, MoesPoint, solve_steady
from ehlcontact.process.beside import COMPILE_BESIDE
from ehlcontact.process.threads import cores
from reduced_models.core import NAME

TOGETHER = "tests/fmu/bearing/"
SHARED = "not slow and not long", "long"  # the default suite, and the longer tests of which each takes one core

# A shell starts what runs in the background with Ctrl-C ignored, and that is inherited: the programs under test,
# which are interrupted here, would not notice.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config):
    """Before pytest-xdist looks at its options."""
    option = config.option
    default = config.args_source is pytest.Config.ArgsSource.TESTPATHS and option.markexpr in SHARED
    asked = getattr(option, "numprocesses", 0) is not None or option.usepdb or option.collectonly
    if not default or asked or hasattr(config, "workerinput"):
        return
    if option.dist == "no" and cores() > 1:
        option.numprocesses, option.dist = cores(), "loadfile"  # fixtures of a file are made once
        option.loadscopereorder = False  # long files come first: those of the command line
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # a solve has as many threads, and the cores are taken
        os.environ.setdefault(COMPILE_BESIDE, "0")  # likewise


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """By files; tests of bearing FMUs, which export the same ones and compile the same kernels, stay together."""
    from xdist.scheduler import LoadFileScheduling

    class Files(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return TOGETHER if nodeid.startswith(TOGETHER) else super()._split_scope(nodeid)

    return Files(config, log) if config.option.dist == "loadfile" else None


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """What is collected stays: looking through it for garbage took half of the time of collecting."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_collection_modifyitems(items):
    """Begin with the finished study, which compiles most kernels, beside the tests of FMUs, which need few.

    So kernels are compiled once, and not in every worker; nor does one wait for the study: what needs it is last.
    """
    needing = dict.fromkeys(item.path for item in items if "finished" in getattr(item, "fixturenames", ()))
    first = next(iter(needing), None)

    def order(item):
        if item.path in needing:
            return 0 if item.path == first else 3
        return 1 if "fmu" in item.path.relative_to(item.config.rootpath).parts else 2

    items.sort(key=order)


@cache
def _steady(M, L, kappa, n, laws):
    return solve_steady(MoesPoint(M, L, kappa, **dict(laws)), grid=Grid(n=n))


@pytest.fixture(scope="session")
def steady():
    """``steady(M, L, kappa, n, viscosity=..., density=...)``: a solve on the default domain, cached."""
    return lambda M, L, kappa, n, **laws: _steady(M, L, kappa, n, tuple(sorted(laws.items())))


@pytest.fixture
def full_disk(tmp_path):
    """A folder on a disk of 16 kB, a file of ours already there."""
    folder = tmp_path / "small"
    folder.mkdir()
    if os.name != "posix" or os.geteuid() != 0:
        pytest.skip("only root may mount a disk of 16 kB")
    mount = ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", folder]
    done = subprocess.run(mount, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip(f"no disk of 16 kB can be mounted here: {done.stderr.strip()}")
    (folder / "kept.txt").write_text("kept")
    yield folder
    assert (folder / "kept.txt").read_text() == "kept"
    left = [path.name for path in folder.iterdir() if path.suffix == ".tmp"]
    subprocess.run(["umount", folder], check=True)
    assert left == []


@pytest.fixture
def no_room(monkeypatch):
    """``no_room()`` makes every later write of a file fail as on a full disk."""

    def write(*_):
        raise OSError(28, "No space left on device")

    return lambda: monkeypatch.setattr(os, "fsync", write)


@pytest.fixture(scope="session")
def common_folder(tmp_path_factory):
    """The folder that all workers of pytest-xdist have in common."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def made_once(common_folder):
    """``made_once(name, make)``: a folder that ``make(folder)`` has filled, in the first worker that needs it."""

    def folder(name, make):
        place, done = common_folder / name, common_folder / f"{name}.done"
        try:
            place.mkdir()
        except FileExistsError:
            while not done.exists():
                time.sleep(0.05)
        else:
            try:
                make(place)
            finally:
                done.touch()
        return place

    return folder


@pytest.fixture(scope="session", autouse=True)
def own_cache(common_folder, made_once):
    """Libraries of FMUs are compiled by the tests, not found in the user's cache; programs keep their bytecode."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EHLCONTACT_CACHE", str(common_folder / "compiled"))
        patch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)  # or each of 200 programs compiles 200 modules
        if os.name == "posix" and "EHLCONTACT_CC" not in os.environ and (compiler := shutil.which("cc")):
            patch.setenv("EHLCONTACT_CC", str(made_once("compiler", partial(_quick, compiler)) / "cc"))
        yield


def _quick(compiler, folder):
    """The compiler of this machine, not optimising, whatever glibc its libraries need: less than half of the time.

    Those of `tests/fmu/binaries` are compiled as users have them.
    """
    own = f'case "$*" in *{NAME}*) exec {shlex.quote(compiler)} "$@";; esac'  # the C core, which all tests run
    (folder / "cc").write_text(f'#!/bin/sh\n{own}\nexec {shlex.quote(compiler)} "$@" -O0\n')
    (folder / "cc").chmod(0o755)


@pytest.fixture
def quiet(monkeypatch):
    """No lines of progress: a first compilation brings them about, and a long silence before a test."""
    monkeypatch.setattr("ehlcontact.cli.progress.Lines.write_due", lambda self, now: None)
