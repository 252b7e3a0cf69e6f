"""What was compiled before is found again, by nothing but what it depends on, and is never half there."""

import os
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from ehlcontact import kernel_cache
from ehlcontact.binaries import build_binaries, cache, libraries, this_machine

OWN = this_machine()


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """A cache of its own, and what was compiled meanwhile."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("EHLCONTACT_CACHE", str(folder))
    return folder


@pytest.fixture
def compiled(monkeypatch):
    """Platforms for which something was compiled; the library itself is a stand-in."""
    calls = []

    def compile_(work, target, compiler):
        calls.append(target.name)
        return b"library"

    monkeypatch.setattr(libraries, "_compile", compile_)
    monkeypatch.setattr(libraries, "_checked", lambda library, *_: libraries.Library(OWN.name))
    return calls


def build(sources=None, units=("a.c",), identifier="x"):
    sources = {"a.c": b"int a;", "a.h": b""} if sources is None else sources
    (library,) = build_binaries(sources, units, identifier, [OWN], fmi=3)[0].values()
    return library


def test_the_second_time_nothing_is_compiled(kept, compiled):
    assert build() == build() == b"library" and len(compiled) == 1
    assert [path.suffix for path in kept.iterdir()] == [".library"]


@pytest.mark.parametrize(
    "change",
    [
        {"sources": {"a.c": b"int b;", "a.h": b""}},
        {"sources": {"a.c": b"int a;", "a.h": b" "}},
        {"sources": {"a.c": b"int a", "a.h": b";"}},  # the same bytes, cut elsewhere
        {"sources": {"a.c": b"int a;", "a.h": b"", "b.c": b""}, "units": ("a.c", "b.c")},
        {"identifier": "y"},
    ],
)
def test_other_sources_are_compiled_anew(kept, compiled, change):
    build()
    build(**change)
    assert len(compiled) == 2


def test_so_are_the_same_with_other_flags_or_by_another_compiler(kept, compiled, monkeypatch):
    build()
    monkeypatch.setattr("ehlcontact.binaries.platforms.COMMON", ("-O3",))
    build()
    monkeypatch.setenv("EHLCONTACT_CC", f"{sys.executable} -m cc")
    build()
    assert len(compiled) == 3


def test_a_damaged_entry_is_not_believed(kept, compiled):
    build()
    (entry,) = kept.iterdir()
    whole = entry.read_bytes()
    damaged = (
        b"",
        whole[:-1],
        whole[:20],
        whole[:-1] + b"X",
        b"X" + whole[1:],
        bytes(len(whole)),
        bytes(range(256)),
    )
    for content in damaged:
        entry.write_bytes(content)
        assert build() == b"library"
        assert entry.read_bytes() == whole
    assert len(compiled) == 1 + len(damaged)


@pytest.mark.filterwarnings("always")
@pytest.mark.parametrize("where", ["a file", "below a file", "nowhere", "/proc/ehlcontact", "/" + "x" * 300])
def test_without_a_cache_everything_works(compiled, monkeypatch, tmp_path, where):
    (tmp_path / "file").write_text("kept")
    if where == "nowhere":
        monkeypatch.delenv("EHLCONTACT_CACHE")
        for name in ("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA", "USERPROFILE"):
            monkeypatch.delenv(name, raising=False)
        monkeypatch.setattr(Path, "home", no_home)
    else:
        path = {"a file": tmp_path / "file", "below a file": tmp_path / "file" / "x"}.get(where, where)
        monkeypatch.setenv("EHLCONTACT_CACHE", str(path))
    assert cache.cache_folder() is None
    monkeypatch.setattr(kernel_cache, "_given", set())
    with pytest.warns(RuntimeWarning, match=r"compiled code is not kept.*no folder of caches.*EHLC") as given:
        assert build() == build() == b"library" and len(compiled) == 2
    assert len(given) == 1
    assert (tmp_path / "file").read_text() == "kept"


@pytest.mark.filterwarnings("always")
def test_a_cache_that_became_read_only_is_read(kept, compiled, monkeypatch):
    """As in an image that was filled when it was made; what is not in it is compiled anew, with one warning."""
    build()
    monkeypatch.setattr(os, "access", lambda path, mode: not mode & os.W_OK)
    monkeypatch.setattr(kernel_cache, "_given", set())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert build() == b"library" and len(compiled) == 1
    with pytest.warns(RuntimeWarning, match="compiled code is not kept") as given:
        assert build(identifier="y") == build(identifier="y") == b"library"
    assert len(given) == 1 and len(compiled) == 3 and len(list(kept.iterdir())) == 1


def no_home():
    raise RuntimeError("Could not determine home directory.")


def test_zig_without_a_home_keeps_its_things_in_the_folder_it_works_in(monkeypatch, tmp_path):
    monkeypatch.delenv("ZIG_GLOBAL_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file" / "below"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "file" / "below"))
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "file")
    assert cache.zig_folder() is None
    assert libraries._environment(tmp_path)["ZIG_GLOBAL_CACHE_DIR"] == str(tmp_path / "zig")
    monkeypatch.setenv("ZIG_GLOBAL_CACHE_DIR", str(tmp_path / "mine"))
    assert libraries._environment(tmp_path)["ZIG_GLOBAL_CACHE_DIR"] == str(tmp_path / "mine")


def test_what_was_not_used_for_longest_goes_first(kept, monkeypatch):
    monkeypatch.setattr(cache, "LARGEST", 3 * 1100)  # an entry has a line with its checksum too
    for k in range(3):
        cache.remember(f"key{k}", bytes([k]) * 1000)
        os.utime(kept / f"key{k}.library", (1e9 + k, 1e9 + k))
    assert cache.recall("key0") is not None  # used now
    cache.remember("key3", bytes(1000))
    assert sorted(path.stem for path in kept.iterdir()) == ["key0", "key2", "key3"]


def test_many_at_once(kept):
    """Writers and readers of one entry: it is there whole, or not at all."""
    content = {n: bytes([n]) * 50_000 for n in range(8)}

    def work(n):
        for _ in range(20):
            cache.remember("key", content[n])
            assert cache.recall("key") in content.values()

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(work, content))
    assert [path.name for path in kept.iterdir()] == ["key.library"]


@pytest.mark.long
def test_several_processes_export_at_once(kept, tmp_path):
    code = (
        "import sys; from fmu import export; from reduced_models import SpringContact;"
        "export(SpringContact.cubic(K1=.624, K2=.75, K3=-.174, C1=.013, low=.75, high=1.), sys.argv[1])"
    )
    paths = [tmp_path / f"{n}.fmu" for n in range(2)]
    running = [subprocess.Popen([sys.executable, "-c", code, str(path)]) for path in paths]
    assert [process.wait(300) for process in running] == [0, 0]
    assert len({path.read_bytes() for path in paths}) == 1
    assert {path.suffix for path in kept.iterdir()} == {".library"}


@pytest.mark.filterwarnings("always")
def test_a_full_disk_costs_time_and_a_warning(kept, compiled, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    monkeypatch.setattr(kernel_cache, "_given", set())
    with pytest.warns(RuntimeWarning, match="compiled code is not kept.*No space left on device") as given:
        assert build() == build() == b"library" and list(kept.iterdir()) == []
    assert len(given) == 1
