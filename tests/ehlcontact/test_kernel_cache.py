"""Compiled kernels on disk: what is damaged is compiled anew, and where nothing can be kept all works without."""

import importlib
import os
import random
import subprocess
import sys
import warnings
from pathlib import Path

import numba
import numpy as np
import pytest
from programs import environment

from ehlcontact import kernel_cache

pytestmark = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
KERNEL = "from ehlcontact.jit import jit\n\n@jit\ndef twice(x):\n    return x + x\n"


@pytest.fixture
def twice(tmp_path, monkeypatch):
    """A kernel as a process finds it that begins: compiled or read from disk."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "twice.py").write_text(KERNEL)

    def begin():
        monkeypatch.delitem(sys.modules, "twice", raising=False)
        importlib.invalidate_caches()
        monkeypatch.setattr(kernel_cache, "_given", set())
        return importlib.import_module("twice").twice

    yield begin
    sys.modules.pop("twice", None)


def files_of(kernel):
    """Index and data of a kernel with one signature."""
    folder = Path(kernel.stats.cache_path)
    (index,) = folder.glob("twice.twice-*.nbi")
    (data,) = folder.glob("twice.twice-*.nbc")
    return index, data


def changed(content):
    return content[:-1] + bytes([content[-1] ^ 1])


@pytest.mark.filterwarnings("always")
@pytest.mark.parametrize("member", [0, 1], ids=["index", "code"])
@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: content[:40],
        lambda content: content[: len(content) // 2],
        lambda content: bytes(len(content)),
        lambda content: random.Random(1).randbytes(len(content)),
        changed,
    ],
    ids=["empty", "beginning", "half", "zeros", "random", "bit"],
)
def test_damaged_files_are_compiled_anew(twice, member, damage):
    first = twice()
    assert first(2.0) == 4.0
    file = files_of(first)[member]
    file.write_bytes(damage(file.read_bytes()))
    with pytest.warns(RuntimeWarning, match="compiled code was damaged") as given:
        second = twice()
        assert second(2.0) == 4.0
    assert len(given) == 1 and str(file.parent) in str(given[0].message)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        third = twice()
        assert third(2.0) == 4.0
    assert [sum(kernel.stats.cache_hits.values()) for kernel in (first, second, third)] == [0, 0, 1]


@pytest.mark.filterwarnings("always")
def test_content_that_cannot_be_rebuilt_is_compiled_anew(twice):
    """Its checksum agrees: what numba stands on was of another version, say."""
    first = twice()
    assert first(2.0) == 4.0
    kept = first._cache._cache_file
    kept._save_data(files_of(first)[1].name, "no kernel")
    with pytest.warns(RuntimeWarning, match="compiled code was damaged"):
        assert twice()(2.0) == 4.0
    assert sum(twice().stats.cache_hits.values()) == 0


def test_what_a_killed_process_left_is_removed(twice):
    first = twice()
    assert first(2.0) == 4.0
    index, data = files_of(first)
    ended = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True
    )
    name = kernel_cache.temporary_for(data).name
    left = data.with_name(f"{name[:17]}{int(ended.stdout):08x}{name[25:]}")
    left.write_bytes(b"some")
    data.unlink()
    assert twice()(2.0) == 4.0
    assert sorted(index.parent.glob("*twice*.nb?")) == sorted((index, data)) and not left.exists()


@pytest.fixture
def no_place(monkeypatch, tmp_path):
    """No folder of compiled code can be written to."""
    monkeypatch.setattr(kernel_cache, "_is_writable", lambda folder: False)
    monkeypatch.setattr(kernel_cache.InTreeCacheLocator, "ensure_cache_path", refuse)
    kernel_cache._folder.cache_clear()
    yield
    kernel_cache._folder.cache_clear()


def refuse(*_):
    raise OSError(30, "Read-only file system")


@pytest.mark.filterwarnings("always")
def test_without_a_place_kernels_are_compiled_in_memory(twice, no_place, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kernel = twice()
    assert not kernel_cache.is_keeping()
    with pytest.warns(RuntimeWarning, match="compiled code is not kept") as given:
        assert kernel(2.0) == 4.0 and kernel(3) == 6
    assert len(given) == 1 and "Read-only file system" in str(given[0].message)
    assert not list(tmp_path.rglob("*.nbi"))


@pytest.mark.filterwarnings("always")
def test_what_a_read_only_place_holds_is_used(twice, request):
    assert twice()(2.0) == 4.0 and kernel_cache.is_keeping()
    request.getfixturevalue("no_place")
    if numba.config.CACHE_DIR:
        pytest.skip("NUMBA_CACHE_DIR is the first place")
    kernel = twice()
    assert kernel(2.0) == 4.0 and sum(kernel.stats.cache_hits.values()) == 1


READ_ONLY = """
mount --bind {source} {source} && mount -o remount,ro,bind {source} || exit 99
cd {work} && exec "$@"
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root may mount")
def test_a_read_only_library_without_a_home(tmp_path):
    """Version and help say nothing of it; an answer has one line of warning."""
    root = Path(__file__).parents[2]
    script = READ_ONLY.format(source=root, work=tmp_path)
    own = environment(HOME="/proc/nohome", EHLCONTACT_CACHE="/proc/none", OPENBLAS_NUM_THREADS="1")
    own = {name: value for name, value in own.items() if name not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    bearing = ("bearing", "6204", "--load", "500", "--speed-rpm", "1500", "--json", "-")
    for arguments, lines in ((("--version",), 0), (("--help",), 0), (bearing, 1)):
        command = [sys.executable, "-m", "ehlcontact.cli", *arguments]
        namespace = ["unshare", "-m", "sh", "-c", script, "sh"]
        done = subprocess.run([*namespace, *command], env=own, capture_output=True, text=True, check=False)
        if done.returncode in (1, 99) and "ehlcontact" not in done.stderr:
            pytest.skip(f"nothing can be mounted here: {done.stderr.strip()}")
        said = [line for line in done.stderr.splitlines() if line.startswith("ehlcontact: ")]  # beside progress
        assert done.returncode == 0 and "Traceback" not in done.stderr and len(said) == lines, done.stderr
        assert all("compiled code is not kept" in line for line in said)


ALL_READ_ONLY = """
mount --make-rprivate / || exit 99
for place in $(awk '$5 !~ "^/(proc|sys|dev)" {print $5}' /proc/self/mountinfo | sort -u); do
    mount -o remount,ro,bind "$place" 2> /dev/null
done
if touch "$1" 2> /dev/null; then exit 99; fi
shift; cd / && exec "$@"
"""


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux" or os.geteuid() != 0, reason="only root may mount")
def test_a_container_whose_folders_are_all_read_only(tmp_path):
    """What an earlier run kept is used, with no folder for temporary files: the answer is that of any disk."""
    bearing = ("bearing", "6204", "--load", "500", "--speed-rpm", "1500", "--json", "-")
    command = [sys.executable, "-m", "ehlcontact.cli", *bearing]
    own = environment(OPENBLAS_NUM_THREADS="1")
    kept = subprocess.run(command, env=own, capture_output=True, text=True, check=True)
    script = ["unshare", "-m", "sh", "-c", ALL_READ_ONLY, "sh", str(tmp_path / "touched")]
    done = subprocess.run(
        [*script, *command], env=own | {"HOME": "/none"}, capture_output=True, text=True, check=False
    )
    if done.returncode in (1, 99) and "ehlcontact" not in done.stderr:
        pytest.skip(f"nothing can be mounted here: {done.stderr.strip()}")
    assert (done.returncode, done.stderr, done.stdout) == (0, "", kept.stdout)


def test_a_kernel_is_compiled_by_one_process_at_a_time(twice, monkeypatch):
    """The other one waits for what it keeps; a claim of a process that has ended, or of this one, is none."""
    kernel = twice()
    cache = kernel._cache
    assert not cache.is_kept and cache._claimed() and cache._claim.is_file()
    own = cache._claim.read_text("utf-8")
    assert cache._claimed()  # its own, of a compilation that was interrupted
    other = f"{own.partition(' ')[0]} {os.getppid()}"
    cache._claim.write_text(other, "utf-8")
    assert not cache._claimed()
    looks = []

    def kept_meanwhile(seconds):
        looks.append(seconds)
        cache._claim.unlink()  # as that process does when it has kept its kernel

    monkeypatch.setattr(kernel_cache.time, "sleep", kept_meanwhile)
    assert kernel(2.0) == 4.0 and looks == [kernel_cache.TICK]
    assert cache.is_kept and not cache._claim.exists()
    again = twice()
    assert again._cache.is_kept and again(2.0) == 4.0 and sum(again.stats.cache_hits.values()) == 1
    ended = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, text=True)
    cache._claim.write_text(f"{own.partition(' ')[0]} {ended.stdout.strip()}", "utf-8")
    assert cache._claimed()
    cache._claim.write_text("elsewhere 1", "utf-8")
    assert not cache._claimed()  # of another machine: awaited, for `PATIENCE` seconds
    os.utime(cache._claim, (0.0, 0.0))
    assert cache._claimed()
    cache._claim.unlink()


def test_no_part_of_kernels_is_called_by_the_library(monkeypatch):
    """Each process would compile an entry of it, which is never kept: every run would say that it compiles."""
    from ehlcontact import Grid, MoesPoint, impedance, jit

    def refuse(kernel, *_):
        raise AssertionError(f"{kernel.py_func} is called from Python")

    monkeypatch.setattr(jit._Inner, "__call__", refuse)
    found = impedance(MoesPoint(20, 10, 1), Omega=[0.5], grid=Grid(32))
    assert np.isfinite(found.value).all()
