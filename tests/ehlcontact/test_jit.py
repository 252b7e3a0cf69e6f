"""What compiling leaves behind."""

import gc
import importlib
import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from numba import njit
from numba.core.errors import TypingError

from ehlcontact import kernel_cache

CALLEE = """
from typing import NamedTuple
from ehlcontact.jit import jit_exact_node

class {kind}(NamedTuple):
    value: float

@jit_exact_node
def changed(given):
    return given.value + {by}
"""
CALLER = """
from kernel_callee import changed
from ehlcontact.jit import jit_exact

@jit_exact
def caller(given):
    return changed(given)
"""


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
def test_kernels_of_other_sources_are_not_read(tmp_path, monkeypatch):
    """Another file has changed, whose kernel was called and whose class is no longer there."""
    monkeypatch.setattr(kernel_cache, "_PACKAGES", ("kernel_callee", "ehlcontact"))
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "kernel_caller.py").write_text(CALLER)
    found, read = [], []
    for kind, by in (("Kind", 1.0), ("Kind", 1.0), ("Renamed", 100.0)):
        (tmp_path / "kernel_callee.py").write_text(CALLEE.format(kind=kind, by=by))
        for name in ("kernel_callee", "kernel_caller"):
            monkeypatch.delitem(sys.modules, name, raising=False)
        importlib.invalidate_caches()
        kernel_cache.sources.cache_clear()
        kernel_cache._source.cache_clear()
        caller = importlib.import_module("kernel_caller").caller
        found.append(caller(getattr(sys.modules["kernel_callee"], kind)(1.0)))
        read.append(sum(caller.stats.cache_hits.values()))
    assert found == [2.0, 2.0, 101.0]
    assert read == [0, 1, 0]


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
def test_kernels_saved_under_the_name_of_another_are_not_read(tmp_path, monkeypatch):
    """As two processes leave them that save one kernel for different types at the same time."""
    monkeypatch.setattr(kernel_cache, "_PACKAGES", ("twice", "ehlcontact"))
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "twice.py").write_text("from ehlcontact.jit import jit\n\n@jit\ndef twice(x):\n    return x + x\n")
    read = []
    for _ in range(3):
        monkeypatch.delitem(sys.modules, "twice", raising=False)
        twice = importlib.import_module("twice").twice
        assert (twice(3), twice(0.25)) == (6, 0.5)
        read.append(sum(twice.stats.cache_hits.values()))
        if len(read) == 1:
            first, second = sorted(Path(twice.stats.cache_path).glob("twice.twice-*.nbc"))
            first_code, second_code = first.read_bytes(), second.read_bytes()
            first.write_bytes(second_code)
            second.write_bytes(first_code)
    assert read == [0, 0, 2]


def test_collection_of_garbage_is_as_before_once_kernels_are_compiled():
    """Also after one that calls another, and after one that cannot be compiled."""
    inner = njit(lambda x: x + 1)
    outer = njit(lambda x: inner(x))
    failing = njit(lambda x: inner(x).nothing)
    before = gc.get_threshold()
    gc.set_threshold(701, 11, 12)
    try:
        assert outer(1) == 2
        assert gc.get_threshold() == (701, 11, 12)
        with pytest.raises(TypingError):
            failing(1.0)
        assert gc.get_threshold() == (701, 11, 12)
    finally:
        gc.set_threshold(*before)


ANSWERS = """
import hashlib
import numpy as np
from ehlcontact import *
from reduced_models import BallBearing
point, grid = MoesPoint(20, 10, 1), Grid(32)
def bits(name, *arrays):
    print(name, hashlib.md5(b"".join(np.ascontiguousarray(a).tobytes() for a in arrays)).hexdigest())
bits("steady", solve_steady(point, grid=grid).P, solve_steady(MoesPoint(200, 10, 0.3), grid=grid).P)
bits("starved", solve_steady(point, grid=grid, supply=OilLayer(H=0.3)).P)
for name, film in {"flooded": {}, "starved": {"supply": OilLayer(H=0.3)}}.items():
    response = impedance(point, Omega=[0.05, 1.0], grid=grid, **film)
    bits(f"{name} impedance", response.stiffness, response.damping)
    motion, steps = HarmonicLoad(amplitude=0.3, Omega=2.0), TimeSteps(periods=1, steps_per_period=20)
    bits(f"{name} in time", simulate(point, motion, grid=grid, time=steps, **film).h_central)
oil = Lubricant.iso_vg(68, temperature=50.0)
ball = OperatingPoint.ball_bearing(
    oil, ball_diameter=12.3e-3, pitch_diameter=43.5e-3, conformity=0.52, speed_rpm=10_000, load=800
)
bits("heated", solve_steady(ball, grid=grid, thermal=Heat()).P)
bits("bearing", BallBearing.catalogue("6205", oil=oil).equilibrium((0, -1000), speed_rpm=3000).force)
"""


@pytest.mark.slow
@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
@pytest.mark.parametrize("threads", ["1", "2"])
def test_results_do_not_depend_on_the_cache_of_kernels(threads, tmp_path):
    """The process that compiles has the bits of later ones, whichever copy of an inner kernel is linked.

    With two threads another process compiles beside it (`ehlcontact.solver.compiled_beside`).
    """
    given = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "OPENBLAS_NUM_THREADS": threads}
    runs = [
        subprocess.run([sys.executable, "-c", ANSWERS], env=given, check=True, capture_output=True, text=True)
        for _ in range(2)
    ]
    assert runs[0].stdout == runs[1].stdout
    assert len(runs[0].stdout.splitlines()) == 8
