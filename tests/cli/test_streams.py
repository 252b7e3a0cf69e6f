"""stdout that is full or closed, Ctrl-C while the program is imported: one line and the right exit code."""

import io
import json
import os
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from programs import environment, program

from ehlcontact.cli.output import StdoutError, watched_stdout

ELEMENT = ("element", "--M", "2900", "--L", "19", "--kappa", "0.11")
FULL = "ehlcontact: stdout = 'No space left on device': must be able to take the output\n"
CLOSED = "ehlcontact: stdout was closed before everything was written to it\n"


def written_to(call, patch, stream, *arguments):
    """How the program ends with this stdout."""
    with stream, patch.context() as this:
        this.setattr(sys, "stdout", stream)
        return call(*arguments)


@pytest.mark.parametrize("arguments", [ELEMENT, (*ELEMENT, "--json", "-"), ("--help",)], ids=len)
def test_full(call, monkeypatch, arguments):
    for unbuffered in (True, False):
        full = io.TextIOWrapper(open("/dev/full", "wb", 0 if unbuffered else -1), write_through=unbuffered)
        found = written_to(call, monkeypatch, full, *arguments)
        assert (found.code, found.err) == (2, FULL)


def test_full_as_a_process():
    with open("/dev/full", "w") as full:
        found = program("--version", stdout=full)
    assert (found.returncode, found.stderr) == (2, FULL)


@pytest.mark.parametrize("arguments", [ELEMENT, (*ELEMENT, "--json", "-"), ("--help",)], ids=len)
def test_closed(call, monkeypatch, arguments, tmp_path):
    reader, writer = os.pipe()
    os.close(reader)
    save = () if arguments == ("--help",) else ("--save", tmp_path / "e.json")
    found = written_to(call, monkeypatch, open(writer, "w"), *arguments, *save)
    assert (found.code, found.err) == (1, CLOSED)
    assert not save or (tmp_path / "e.json").exists()  # what was asked for beside it


@pytest.mark.long
def test_stderr_full_or_closed():
    with open("/dev/full", "w") as full:
        slip = ("steady", "--M", "-1", "--L", "5", "--kappa", "1")
        assert program(*slip, stderr=full, stdout=full).returncode == 2
    shell = f"{sys.executable} -m ehlcontact.cli {' '.join(ELEMENT)}"
    silent = subprocess.run(f"{shell} --json - >&- 2>&-", shell=True, check=False)
    assert silent.returncode == 2  # nobody could have got the result
    told = subprocess.run(f"{shell} --json - >&-", shell=True, check=False, stderr=subprocess.PIPE, text=True)
    assert told.stderr == "ehlcontact: --json = '-': must be used with a stdout that is not closed\n"


def test_closed_before_the_program_started(tmp_path):
    """A table that nobody can get is a failure; a file beside it is written."""
    shell = f"{sys.executable} -m ehlcontact.cli {' '.join(ELEMENT)} --save {tmp_path / 'e.json'} >&-"
    told = subprocess.run(shell, shell=True, check=False, stderr=subprocess.PIPE, text=True)
    assert (told.returncode, told.stderr) == (1, CLOSED) and (tmp_path / "e.json").exists()


class Narrow(io.StringIO):
    encoding = "ascii"

    def write(self, text):
        text.encode(self.encoding)
        return super().write(text)


def test_characters_beyond_the_encoding_of_the_terminal(monkeypatch):
    stream = Narrow()
    monkeypatch.setattr(sys, "stdout", stream)
    with watched_stdout():
        sys.stdout.write("µ \udcff")
    assert stream.getvalue() == r"\xb5 \udcff" and sys.stdout is stream


def test_a_failure_that_a_library_swallows_is_raised_at_the_end(monkeypatch):
    class Full(io.StringIO):
        def write(self, text):
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(sys, "stdout", Full())
    with pytest.raises(StdoutError, match="No space left"), watched_stdout():
        try:
            sys.stdout.write("")
        except Exception:
            pass


@pytest.mark.parametrize("module", ["scipy", "typer"])
def test_ctrl_c_while_it_is_imported(module, tmp_path):
    """A module that is imported on the way is interrupted, and swallows what that raises."""
    interrupting = (
        "import os, signal\ntry:\n    os.kill(os.getpid(), signal.SIGINT)\n    for _ in range(9): pass\n"
    )
    (tmp_path / f"{module}.py").write_text(f"{interrupting}except BaseException:\n    pass\n")
    found = program(*ELEMENT, env=environment(tmp_path))
    assert (found.returncode, found.stdout) == (130, "")
    assert found.stderr == "ehlcontact: interrupted before anything was computed\n"


def test_programs_of_others_keep_their_own_ways_with_ctrl_c():
    code = "import signal, ehlcontact\nprint(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "True"


def test_ctrl_c_in_a_subcommand(call, point, monkeypatch):
    def stop(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(import_module("ehlcontact.response"), "impedance", stop)
    result = call("impedance", *point, "--Omega", "1")
    assert result.code == 130 and result.out == ""
    assert result.err == "ehlcontact: interrupted: nothing was computed that could be kept\n"


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (MemoryError("Unable to allocate 8 TiB"), "out of memory: Unable to allocate 8 TiB"),
        (
            OSError(24, "Too many open files", "/tmp/x"),
            "the system refuses: [Errno 24] Too many open files: '/tmp/x'",
        ),
    ],
    ids=["memory", "files"],
)
def test_what_the_system_refuses_is_one_line(call, point, monkeypatch, error, line):
    def stop(*_, **__):
        raise error

    monkeypatch.setattr(import_module("ehlcontact.response"), "impedance", stop)
    result = call("impedance", *point, "--Omega", "1")
    assert (result.code, result.err) == (1, f"ehlcontact: {line}\n")


DRY = ("bearing", "6205", "--load", "500", "--speed-rpm", "0")


def test_a_pipe_whose_reader_is_gone():
    """As of ``ehlcontact ... | head -0``."""
    line = f"{sys.executable} -m ehlcontact.cli {' '.join(DRY)} | head -0; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", line], env=environment(), capture_output=True, text=True, check=False)
    assert done.stdout == "" and "Traceback" not in done.stderr
    busy = "so far, compiling"
    told = "".join(line for line in done.stderr.splitlines(True) if busy not in line)
    assert (done.returncode, told) in ((1, CLOSED), (0, ""))  # head may end after the table


@pytest.mark.long
def test_the_backend_of_a_notebook_loses_no_figure(tmp_path):
    """Nor does one whose module is not there."""
    figure = tmp_path / "bearing.png"
    found = program(*DRY, "--figure", figure, env=environment(MPLBACKEND="module://no_such_module"))
    assert (found.returncode, found.stderr) == (0, "") and figure.read_bytes().startswith(b"\x89PNG")


@pytest.mark.long
def test_a_bearing_without_compilation_has_the_same_numbers(call):
    wet = ("bearing", "6205", "--oil", "68", "--temp", "60", "--load", "500", "--speed-rpm", "3000", "--json", "-")
    found = program(*wet, env=environment(NUMBA_DISABLE_JIT="1"))
    assert found.returncode == 0
    plain, compiled = (json.loads(out) for out in (found.stdout, call(*wet).out))
    for name in ("stiffness", "damping"):
        one, other = (found["coefficients"][0][name] for found in (plain, compiled))
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * np.abs(other).max())
    np.testing.assert_allclose(plain["states"][0]["h_min"], compiled["states"][0]["h_min"], rtol=1e-9)
