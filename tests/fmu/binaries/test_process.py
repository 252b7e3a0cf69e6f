"""Compilers that fail, hang or are killed: one line, and nothing is left running."""

import os
import subprocess
import sys
import time
from threading import Event, Timer

import pytest
from programs import shell_script

from ehlcontact.binaries import process
from ehlcontact.binaries.process import BuildError

posix = pytest.mark.skipif(os.name != "posix", reason="a shell script as the compiler")


@pytest.fixture
def script(tmp_path):
    """``script(text)`` is the command of a shell script."""

    return lambda text: (shell_script(tmp_path / "cc", text), "-shared")


def fails(line, folder):
    with pytest.raises(BuildError) as error:
        process.run(line, folder, {})
    assert "\n" not in str(error.value)
    return error.value


def test_it_runs_in_the_folder_with_its_environment(tmp_path):
    code = "import os, pathlib; pathlib.Path('made').write_text(os.environ['X'] + os.getcwd())"
    process.run((sys.executable, "-c", code), tmp_path, {"X": "x"})
    assert (tmp_path / "made").read_text() == f"x{os.path.realpath(tmp_path)}"


def test_one_that_cannot_be_started(tmp_path):
    assert "cannot start the C compiler /none/cc -v (No such file" in str(fails(("/none/cc", "-v"), tmp_path))
    assert "cannot start the C compiler" in str(fails(("a\0b",), tmp_path))


@posix
def test_one_that_fails_says_why(script, tmp_path):
    text = "echo 'In file a.h:' >&2; seq 500; echo 'a.c:3: error: no such thing' >&2; echo ' ^' >&2; exit 3"
    found = fails(script(text), tmp_path)
    assert "failed with exit code 3: " in str(found) and str(found).endswith(
        "-shared: a.c:3: error: no such thing"
    )
    assert found.output.startswith("In file a.h:\n1\n2\n") and len(str(found)) < 400
    assert str(fails(script("echo one; echo two; exit 1"), tmp_path)).endswith(": one; two")
    assert str(fails(script("exit 1"), tmp_path)).endswith("-shared")
    assert "two bytes \ufffd\ufffd" in str(fails(script(r"printf 'two bytes \377\376'; exit 1"), tmp_path))


@posix
def test_one_that_is_killed(script, tmp_path):
    assert "was killed (SIGKILL)" in str(fails(script("kill -9 $$"), tmp_path))
    assert "was killed (SIGSEGV)" in str(fails(script("kill -11 $$"), tmp_path))


@posix
def test_one_that_hangs_is_ended_with_its_children(script, tmp_path, monkeypatch):
    """gcc is a driver: what hangs is its child, which holds its output open."""
    monkeypatch.setattr(process, "LONGEST_RUN", 0.3)
    started = time.monotonic()
    found = fails(script(f"sleep 60 & echo $! > {tmp_path}/child; wait"), tmp_path)
    assert "took more than 0.3 s" in str(found) and time.monotonic() - started < 10.0
    child = (tmp_path / "child").read_text().strip()
    for _ in range(50):  # until init has noticed
        state = subprocess.run(["ps", "-o", "stat=", "-p", child], capture_output=True, text=True, check=False)
        if not state.stdout.strip().strip("Z"):
            break
        time.sleep(0.1)
    assert state.stdout.strip() in ("", "Z", "Zs")


@posix
def test_told_to_stop(script, tmp_path):
    stop = Event()
    Timer(0.2, stop.set).start()
    started = time.monotonic()
    with pytest.raises(BuildError, match="was told to stop"):
        process.run(script("sleep 60"), tmp_path, {}, stop)
    assert time.monotonic() - started < 10.0


@posix
def test_interrupted(script, tmp_path, monkeypatch):
    def wait(self, timeout=None):
        if timeout is not None:
            raise KeyboardInterrupt
        return original(self)

    original = subprocess.Popen.wait
    monkeypatch.setattr(subprocess.Popen, "wait", wait)
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        process.run(script("sleep 60"), tmp_path, {})
    assert time.monotonic() - started < 10.0
