"""Files replaced in one move, whatever happens; texts of any origin."""

import json
import os
import signal
import stat
import subprocess
import sys

import h5py
import numpy as np
import pytest
from argument_groups import grouped
from programs import environment

from ehlcontact import HarmonicLoad, InputError, MoesPoint, files, save, simulate
from ehlcontact.store import LAYOUT, put, set_text, take, text_of

POINT = MoesPoint(20, 5, 0.5)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_content_is_on_the_disk_before_it_takes_the_place(tmp_path, monkeypatch):
    path, order = tmp_path / "a.txt", []
    real = {"fsync": os.fsync, "replace": os.replace}
    for name, done in real.items():
        monkeypatch.setattr(os, name, lambda *given, name=name, done=done: (order.append(name), done(*given)))
    files.write_text(path, "µ")
    assert order == ["fsync", "replace"] and path.read_bytes() == b"\xc2\xb5"


def test_a_full_disk_keeps_the_old_file(tmp_path, no_room):
    path = files.write_bytes(tmp_path / "a.bin", b"old")
    no_room()
    with pytest.raises(
        InputError, match=r"^save = '.*a\.bin': must be a file that can be written \(No space left"
    ):
        files.write_bytes(path, b"new", "save")
    assert path.read_bytes() == b"old" and names(tmp_path) == ["a.bin"]


def test_a_link_is_followed(tmp_path):
    (tmp_path / "real.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("real.txt")
    files.write_text(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink() and (tmp_path / "real.txt").read_text() == "new"


def test_what_is_no_file_is_written_to_and_stays(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    files.write_text(pipe, "through")
    assert os.read(reader, 100) == b"through" and stat.S_ISFIFO(pipe.stat().st_mode)
    os.close(reader)
    with pytest.raises(InputError, match="No space left"):
        files.write_text("/dev/full", "x")
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode) and names(tmp_path) == ["pipe"]


@pytest.mark.parametrize("path", [None, 5, b"bytes.txt", "zero\0byte", "x" * 300, "none/a.txt", ""])
def test_no_path_for_a_file(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as caught:
        files.write_text(path, "x")
    assert "\n" not in str(caught.value) and names(tmp_path) == []


def test_results_and_checkpoints_on_a_disk_of_16_kb(full_disk):
    options = dict(n=64, until=0.2, dt=0.1)
    with pytest.raises(InputError, match=r"^checkpoint = .*No space left"):
        simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**options, checkpoint=full_disk / "c.h5"))
    result = simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**options))
    with pytest.raises(InputError, match=r"^path = .*No space left"):
        save(result, full_disk / "r.h5")
    assert names(full_disk) == ["kept.txt"]


def test_a_damaged_byte_is_told_or_does_not_matter(tmp_path):
    """Structure and arrays have checksums: HDF5 is never led astray, and no number is read that was not stored."""
    path, x, told = tmp_path / "r.h5", np.arange(200.0), 0
    with h5py.File(path, "w", libver=LAYOUT) as file:
        put(file, "x", x)
        put(file, "y", x.reshape(2, 100))
        set_text(file, "t", "text" * 20)
    whole = path.read_bytes()
    for at in range(0, len(whole), 11):
        content = bytearray(whole)
        content[at] ^= 0x55
        path.write_bytes(content)
        try:
            with h5py.File(path) as file:
                found = take(file["x"]), take(file["y"]).ravel(), text_of(file, "t")
        except Exception:
            told += 1
        else:
            assert np.array_equal(found[0], x) and np.array_equal(found[1], x) and found[2] == "text" * 20
    assert told > 100


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[" * 100_000, "nested too deeply"),
        ('{"a":' * 100_000 + "1" + "}" * 100_000, "nested too deeply"),
        ("[" * 60 + "]" * 60, "nested too deeply"),
        ("9" * 5000, "a whole number of 5000 digits"),
        ("[-" + "9" * 400 + "]", "a whole number of 401 digits"),
        (r'{"a": "\ud800"}', "half a character"),
        (r'{"\udfff": 1}', "half a character"),
        ("NaN", "NaN is not JSON"),
        ("[-Infinity]", "-Infinity is not JSON"),
        ("{", "Expecting"),
        ("", "Expecting"),
        (b"\xff\xfe\x00", "utf"),
    ],
    ids=lambda value: value[:12] if isinstance(value, str) else "bytes",
)
def test_json_that_is_not_meant(text, words):
    with pytest.raises(ValueError, match=words) as caught:
        files.parse_json(text)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 200


def test_json_that_is_meant():
    text = json.dumps({"a": [1, 2.5, None, "\U0001f600 µ"], "b": {"c": [[[]]]}, "n": -(10**298)})
    assert files.parse_json(text) == json.loads(text)
    assert str(files.parse_json("[NaN, Infinity]", nan=True)) == "[nan, inf]"


def test_a_text_without_end(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "LARGEST_TEXT", 2**20)
    with pytest.raises(ValueError, match="more than 1 MiB"):
        files.read_text("/dev/zero")


def test_what_a_killed_process_left_is_removed_and_nothing_else(tmp_path):
    """Of this machine, by its process; of others, by the time of the last write."""
    mine = tmp_path / ".notes.tmp", tmp_path / "0123456789ab.tmp", tmp_path / f".{'0' * 32}.tmp.txt"
    ended = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True
    )
    here = files.temporary_for(tmp_path / "y.txt").name
    gone = tmp_path / f"{here[:17]}{int(ended.stdout):08x}{here[25:]}"
    elsewhere = tmp_path / f".{'0' * 40}.tmp", tmp_path / f".{'1' * 40}.tmp"
    for path in (gone, *elsewhere, *mine):
        path.write_text("some")
        if path not in (gone, elsewhere[0]):
            os.utime(path, (0.0, 0.0))
    with files.replacing(tmp_path / "x.txt") as temporary:  # somebody is at it
        os.utime(temporary, (0.0, 0.0))
        files.remove_leftovers(tmp_path)
        temporary.write_text("new")
    assert names(tmp_path) == sorted(["x.txt", *(path.name for path in (elsewhere[0], *mine))])
    files.remove_leftovers(tmp_path / "nowhere")


@pytest.mark.skipif(sys.platform != "linux", reason="no file has the start of a process")
def test_what_a_killed_process_of_the_same_number_left_is_removed(tmp_path):
    """As after the restart of a container, in which a command has the same number every time."""
    here = files.temporary_for(tmp_path / "x.txt")
    start = int(here.name[25:33], 16)
    earlier = here.with_name(f"{here.name[:25]}{start - 1:08x}{here.name[33:]}")
    for path in (here, earlier):
        path.touch()
    files.remove_leftovers(tmp_path)
    assert names(tmp_path) == [here.name]


KILLED = """
import os, signal, sys
from ehlcontact import FreeVibration, Grid, KeepSettings, MoesPoint, TimeSteps, simulate
replaced = []
def killed(temporary, target, replace=os.replace):
    replaced.append(target)
    if [str(path) for path in replaced].count(sys.argv[1]) == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    replace(temporary, target)
if "--kill" in sys.argv:
    os.replace = killed
restart = sys.argv[1] if os.path.exists(sys.argv[1]) else None
keep = KeepSettings(checkpoint=sys.argv[1], checkpoint_every=0.0, restart=restart)
time = TimeSteps(until=0.3, dt=0.05)
simulate(MoesPoint(20, 5, 0.5), FreeVibration(Omega_n=5.0), grid=Grid(n=16), time=time, keep=keep)
"""


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="kill -9")
def test_the_next_run_of_a_checkpoint_removes_what_a_killed_one_was_writing(tmp_path):
    path = tmp_path / "run.h5"
    other = files.temporary_for(tmp_path / "other.h5")  # of another file, whose next run removes it
    other.touch()
    for options, code in ((["--kill"], -signal.SIGKILL), ([], 0)):
        run = subprocess.run([sys.executable, "-c", KILLED, path, *options], env=environment(), check=False)
        assert run.returncode == code
        assert len(names(tmp_path)) == (3 if options else 2)
    assert names(tmp_path) == sorted([other.name, "run.h5"])
