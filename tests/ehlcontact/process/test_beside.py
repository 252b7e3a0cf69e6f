"""The process that compiles beside the first solve: what it compiles, when it is started, and its end."""

import os
import signal
import subprocess
import sys
import time

import numba
import pytest

from ehlcontact import Grid, MoesPoint, solve_steady
from ehlcontact.executors import ProcessExecutor
from ehlcontact.jit import compilation_told, compile_for
from ehlcontact.process import beside
from ehlcontact.process.beside import COMPILE_BESIDE, start_beside
from ehlcontact.solver import compiled_beside
from ehlcontact.solver.kernels import fourier, reynolds

needs_jit = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")


@pytest.fixture
def started(monkeypatch):
    """Calls of `start_beside` in place of processes."""
    calls = []
    monkeypatch.setattr(compiled_beside, "start_beside", lambda *given: calls.append(given))
    return calls


@needs_jit
def test_types_are_those_of_a_film():
    """A kernel of another type is compiled in vain; that of a whole film is looked up where the film is solved."""
    solve_steady(MoesPoint(20, 10, 1), grid=Grid(32))
    for kernel, given in compiled_beside.kernels_beside():
        if hasattr(kernel, "overloads"):  # not one that kernels alone call
            assert tuple(kernel.typeof_pyval(one) for one in given) in kernel.overloads, kernel
        compiled = []
        with compilation_told(lambda told=compiled: told.append(1)):
            compile_for(kernel, given)
        assert not compiled, kernel


@needs_jit
def test_it_starts_once_with_the_first_kernel(started):
    class Told:
        def __init__(self, kernel):
            self.data = {"dispatcher": kernel}

    listener = compiled_beside._FirstKernel()
    for kernel in (reynolds.residual_lines, fourier.across_lines, fourier.across_lines):
        listener.on_start(Told(kernel))
    assert started == [
        ("ehlcontact.solver.compiled_beside", "compile_some", fourier.across_lines._cache.cache_path)
    ]


@needs_jit
def test_nothing_starts_where_the_kernels_are_there(started):
    for _ in range(2):
        solve_steady(MoesPoint(20, 10, 1), grid=Grid(32))
        started, before = [], started
    assert not started and len(before) <= 1


@pytest.mark.parametrize(
    "case", ["switched off", "one core", "no folder", "built in", "no interpreter", "no room"]
)
def test_it_is_left_out(case, monkeypatch, tmp_path):
    def popen(*_, **__):
        assert case == "no room"
        raise OSError("no room for another process")

    monkeypatch.setattr(beside, "threads_allowed", lambda: 1 if case == "one core" else 2)
    monkeypatch.setattr(subprocess, "Popen", popen)
    if case == "switched off":
        monkeypatch.setenv(COMPILE_BESIDE, "0")
    if case in ("built in", "no interpreter"):
        monkeypatch.setattr(sys, "executable", "/opt/cad/cad" if case == "built in" else None)
    assert not start_beside("os", "getcwd", str(tmp_path / "none") if case == "no folder" else str(tmp_path))


def test_workers_of_a_pool_compile_alone():
    with ProcessExecutor(2) as pool, ProcessExecutor(1) as alone:
        assert pool._environment[COMPILE_BESIDE] == "0"
        assert alone._environment.get(COMPILE_BESIDE) == os.environ.get(COMPILE_BESIDE)


SLEEPER = """
import os, sys, time
def sleep():
    print("heard by nobody")
    print("nor this", file=sys.stderr)
    open("pid.part", "w").write(str(os.getpid()))
    os.replace("pid.part", "pid")
    time.sleep(60)
"""
PARENT = """
import os, sys, time
from ehlcontact.process import beside
beside.threads_allowed = lambda: 2
assert beside.start_beside("sleeper", "sleep", ".")
while not os.path.exists("pid"):
    time.sleep(0.01)
{end}
"""


@pytest.mark.skipif(sys.platform == "win32", reason="looks for a process by its number")
@pytest.mark.parametrize("end", ["", pytest.param("os.kill(os.getpid(), 9)", marks=pytest.mark.long)])
def test_it_ends_with_its_parent_and_is_silent(end, tmp_path):
    (tmp_path / "sleeper.py").write_text(SLEEPER)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, sys.path)])}
    environment.pop(COMPILE_BESIDE, None)
    begun = time.monotonic()
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", PARENT.format(end=end)],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert run.returncode == (-signal.SIGKILL if "kill" in end else 0)
    assert run.stdout == run.stderr == ""
    pid = int((tmp_path / "pid").read_text())
    while _runs(pid):
        assert time.monotonic() < begun + 30
        time.sleep(0.01)


def _runs(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


COUNTED = """
import hashlib
from ehlcontact import *
from ehlcontact.solver import compiled_beside
from numba.core import event
class Compiled(event.Listener):
    def on_start(self, event):
        names.add(event.data["dispatcher"].py_func.__name__)
    def on_end(self, event):
        pass
names = set()
event.register("numba:compile", Compiled())
{first}
film = solve_steady(MoesPoint(200, 10, 0.5), grid=Grid(64))
print(hashlib.md5(film.p.tobytes()).hexdigest(), *sorted(names))
"""


@pytest.mark.slow
@needs_jit
def test_a_film_finds_what_was_compiled_beside(tmp_path):
    """Same bits, and no kernel of the second process is compiled in the first one, nor by what it calls."""
    found = []
    for first in ("", "compiled_beside.compile_some(); names.clear()"):
        given = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / str(len(found))), COMPILE_BESIDE: "0"}
        code = COUNTED.format(first=first)
        run = subprocess.run([sys.executable, "-c", code], env=given, check=True, capture_output=True, text=True)
        bits, *names = run.stdout.split()
        found.append((bits, set(names)))
    beside_names = {kernel.py_func.__name__ for kernel, _ in compiled_beside.kernels_beside()}
    assert found[0][0] == found[1][0]
    assert beside_names <= found[0][1]
    assert not beside_names & found[1][1]
    assert "relax_flank_blocks" in found[1][1]
