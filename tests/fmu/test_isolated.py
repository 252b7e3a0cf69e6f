"""FMUs whose libraries do what no library should: the process of the caller goes on, and nothing stays behind."""

import importlib
import os
import signal
import subprocess
import tempfile
import time
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest

from ehlcontact import InputError
from fmu import fmu_file, isolated, verify, verify_references


@dataclass
class Verified:
    """What the work of a child returns."""

    findings: list


DEEDS = {
    "exit": ("exit(0);", "ended the process with exit code 0"),
    "crash": ("*(volatile int *)0 = 1;", "crashed: SIGSEGV"),
    "abort": ("abort();", "crashed: SIGABRT"),
    "hang": ("for (;;) sleep(1);", "still running after 1 s"),
    "answer": (
        'glob_t g; char name[999]; glob(getenv("ANSWERS"), 0, 0, &g);'
        ' sprintf(name, "%s/answer.json", g.gl_pathv[0]);'
        ' FILE *f = fopen(name, "w"); fputs("{\\"found\\": {\\"findings\\": []}}", f); fclose(f); _exit(0);',
        "ended the process with exit code 0",
    ),
    "memory": ("for (;;) memset(malloc(1 << 26), 1, 1 << 26);", "crashed: SIGSEGV"),
}
CODE = """#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
__attribute__((constructor)) static void deed(void) { const char *name = getenv("DEED"); CASES }
"""


@pytest.fixture(scope="module")
def rogue(fmus, tmp_path_factory):
    """An FMU whose library does, as it is loaded, what the variable DEED of the environment says."""
    folder = tmp_path_factory.mktemp("rogue")
    cases = " ".join(f'if (!strcmp(name, "{name}")) {{ {code} }}' for name, (code, _) in DEEDS.items())
    (folder / "rogue.c").write_text(CODE.replace("CASES", cases))
    command = ["cc", "-shared", "-fPIC", "-w", "-o", str(folder / "rogue.so"), str(folder / "rogue.c")]
    subprocess.run(command, check=True)
    with zipfile.ZipFile(fmus["cubic"]) as good, zipfile.ZipFile(folder / "rogue.fmu", "w") as bad:
        for name in good.namelist():
            binary = name.startswith("binaries/") and name.endswith(".so")
            bad.writestr(name, (folder / "rogue.so").read_bytes() if binary else good.read(name))
    return folder / "rogue.fmu"


LEFT = """
__attribute__((constructor)) static void leave(void)
{
    const char *own = getenv("LEFT");
    if (own != NULL && fork() == 0) {
        if (!strcmp(own, "session")) setsid();
        FILE *f = fopen(getenv("LEFT_PID"), "w");
        fprintf(f, "%d", (int)getpid());
        fclose(f);
        sleep(600);
        _exit(0);
    }
}
"""


def runs(pid):
    """Whether a process is there, and has not ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc")
@pytest.mark.parametrize("own", ["group", "session"])
def test_a_process_that_is_left_behind(fmus, tmp_path, monkeypatch, own):
    """It holds all files of the child open. Nobody waits for it, and in the group of the child it is ended."""
    (tmp_path / "left.c").write_text(CODE.split("__attribute__")[0] + LEFT)
    command = ["cc", "-shared", "-fPIC", "-w", "-o", str(tmp_path / "left.so"), str(tmp_path / "left.c")]
    subprocess.run(command, check=True)
    pid = tmp_path / "pid"
    monkeypatch.setenv("LEFT", own)
    monkeypatch.setenv("LEFT_PID", str(pid))

    def work(path):
        import ctypes

        ctypes.CDLL(str(tmp_path / "left.so"))
        while not (pid.exists() and pid.read_text()):
            time.sleep(0.01)
        return Verified(findings=[])

    isolated.isolated(work, fmus["cubic"], lambda found: found)
    left = int(pid.read_text())
    if own == "session":  # it sleeps for minutes, and was not waited for
        assert runs(left)
        os.kill(left, signal.SIGKILL)
    for _ in range(1000):
        if runs(left):
            time.sleep(0.01)
    assert not runs(left)


@pytest.fixture(autouse=True)
def nothing_stays(tmp_path, monkeypatch):
    """Temporary folders are in a folder that is empty in the end."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    yield
    assert list(tmp_path.glob("ehlcontact-*")) == []


@pytest.mark.parametrize("deed", DEEDS)
def test_a_library_that_runs_amok(rogue, elements, monkeypatch, tmp_path, deed):
    monkeypatch.setenv("DEED", deed)
    if deed == "hang":
        monkeypatch.setattr(isolated, "LONGEST", 1.0)
    monkeypatch.setattr(isolated, "LARGEST", 2**28)
    monkeypatch.setenv("ANSWERS", str(tmp_path / "ehlcontact-verify-*"))
    calls = [lambda: verify_references(rogue), lambda: verify(rogue, elements["cubic"])]
    for call in calls if deed == "exit" else calls[:1]:
        with pytest.raises(InputError, match="an FMU whose library runs to the end") as caught:
            call()
        assert DEEDS[deed][1] in str(caught.value) and caught.value.field == "path"


def test_an_archive_of_gigabytes(tmp_path, elements):
    """Refused by what its directory says, before a byte is unpacked."""
    file = tmp_path / "large.fmu"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", "<a/>")
        for k in range(3):
            archive.writestr(f"resources/{k}", bytes(2**20))
    data = file.read_bytes()
    said = (2**20).to_bytes(4, "little")
    file.write_bytes(data.replace(said, (2**30).to_bytes(4, "little")))  # sizes of the directory, 3 GiB
    for call in (lambda: verify(file, elements["cubic"]), lambda: verify_references(file)):
        with pytest.raises(InputError, match="unpacks to at most 512 MiB, not 3072 MiB"):
            call()
    assert fmu_file.LARGEST_UNPACKED == 2**29


def described(fmus, file, change):
    """The cubic contact's FMU with another model description."""
    with zipfile.ZipFile(fmus["cubic"]) as good, zipfile.ZipFile(file, "w") as other:
        for name in good.namelist():
            content = good.read(name)
            other.writestr(name, change(content) if name == "modelDescription.xml" else content)
    return file


@pytest.mark.parametrize("name", [b"../../../tmp/x", b"a b", b"1x", b""])
def test_an_identifier_that_is_no_c_name(fmus, elements, tmp_path, name):
    def renamed(content):
        assert b'modelIdentifier="CubicContact"' in content
        return content.replace(b'modelIdentifier="CubicContact"', b'modelIdentifier="' + name + b'"')

    file = described(fmus, tmp_path / "x.fmu", renamed)
    with pytest.raises(InputError, match="an FMU whose modelIdentifier is a C name"):
        verify(file, elements["cubic"])


@pytest.mark.parametrize("content", [b"", b"<a/>", b'<fmiModelDescription fmiVersion="2.0"/>'])
def test_an_empty_description(fmus, elements, tmp_path, content):
    file = described(fmus, tmp_path / "x.fmu", lambda _: content)
    with pytest.raises(InputError) as caught:
        verify(file, elements["cubic"])
    assert caught.value.field == "path" and "NoneType" not in str(caught.value)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no such device here")
def test_a_device(elements):
    with pytest.raises(InputError, match="a device, in place of a file"):
        verify("/dev/zero", elements["cubic"])


def test_errors_of_the_child_are_those_of_the_call(fmus, elements, monkeypatch):
    def wrong(*_):
        raise InputError("path", 3, "another")

    monkeypatch.setattr(importlib.import_module("fmu.verify"), "verify_opened", wrong)
    with pytest.raises(InputError, match="path = 3: must be another") as caught:
        verify(fmus["cubic"], elements["cubic"])
    assert (caught.value.field, caught.value.value, caught.value.allowed) == ("path", 3, "another")


@pytest.mark.parametrize("path", [3, None])
def test_what_is_no_path(path, elements):
    with pytest.raises(InputError, match="the name of a file"):
        verify(path, elements["cubic"])


def test_an_error_whose_context_cannot_be_pickled(fmus):
    """Such is lxml's, once something has imported dask's pickling of tracebacks."""
    pickling = pytest.importorskip("tblib.pickling_support")

    def fails(path):
        try:
            error = ValueError("inner")
            error.log = (line for line in "ab")  # no generator can be pickled
            raise error
        except ValueError:
            raise InputError("path", str(path), "readable") from None

    pickling.install()
    with pytest.raises(InputError, match="readable"):
        isolated.isolated(fails, fmus["cubic"], dict)


def test_an_error_that_pickle_does_not_take_is_told(tmp_path):
    """As one of fmpy, of a call that the FMU refuses."""

    def refused(path):
        error = ValueError("a ball finds no balance")
        error.held = lambda: None
        raise error

    with pytest.raises(RuntimeError, match="a ball finds no balance"):
        isolated.isolated(refused, tmp_path, dict)
