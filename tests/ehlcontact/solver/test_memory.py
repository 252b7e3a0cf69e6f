"""The memory of a grid: told before it is tried, and about what is taken then."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from ehlcontact import (
    Domain,
    FreeVibration,
    Grid,
    InputError,
    MoesPoint,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.solver import mesh as memory
from ehlcontact.solver.level import build_hierarchy
from ehlcontact.solver.mesh import Mesh, Solve
from ehlcontact.solver.mesh_choice import Purpose, allows_newton, remedy
from ehlcontact.status import Status

POINT = MoesPoint(200, 10, 0.5)
SCRIPT = r"""
import re
from pathlib import Path
from ehlcontact import FreeVibration, Grid, MoesPoint, RunSettings, TimeSteps, impedance, simulate, solve_steady

def solve(n):
    point, settings = MoesPoint(200, 10, {kappa}), dict(grid=Grid(n))
    if {what!r} == "run":
        steps, run = TimeSteps(until=0.03, dt=0.01), RunSettings(threads=1, throw=False)
        simulate(point, FreeVibration(Omega_n=5.13), time=steps, run=run, **settings)
    elif {what!r} == "impedance":
        impedance(point, Omega=[0.0, 3.0], threads=1, **settings)
    else:
        method = "newton" if {what!r} == "newton" else "multigrid"
        solve_steady(point, max_cycles=2, method=method, threads=1, throw=False, **settings)

def peak():  # not ru_maxrss, which begins with that of the parent
    return 1024 * int(re.search(r"VmHWM:\s*(\d+)", Path("/proc/self/status").read_text())[1])

solve(32)
before = peak()
solve({n})
print(peak() - before)
"""


@pytest.fixture
def free(monkeypatch):
    """Leaves so many bytes free."""
    return lambda count: monkeypatch.setattr(memory, "available_bytes", lambda: count)


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="not told here")
@pytest.mark.parametrize(
    ("what", "n", "kappa"),
    [
        pytest.param("cycles", 512, 0.5, marks=pytest.mark.long),
        pytest.param("cycles", 512, 0.05, marks=pytest.mark.slow),
        pytest.param("newton", 256, 0.5, marks=pytest.mark.slow),
        pytest.param("impedance", 256, 0.5, marks=pytest.mark.slow),
        pytest.param("cycles", 1024, 0.5, marks=pytest.mark.slow),
        pytest.param("cycles", 1024, 0.1, marks=pytest.mark.slow),
        pytest.param("run", 512, 0.5, marks=pytest.mark.slow),
        pytest.param("run", 1024, 0.5, marks=pytest.mark.slow),
        pytest.param("newton", 512, 0.5, marks=pytest.mark.slow),
    ],
)
def test_estimate_is_within_30_percent_of_what_is_taken(what, n, kappa):
    script = SCRIPT.format(what=what, n=n, kappa=kappa)
    for _ in range(2):  # compiling takes memory too: what it did is read the second time
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    solve = Solve.CYCLES if what == "run" else Solve(what)
    assert Mesh(n, Domain(), kappa).needed_bytes(solve) == pytest.approx(float(done.stdout), rel=0.3)


@pytest.mark.parametrize(
    ("kappa", "lines"), [(0.046, 1), (0.11, 1), (0.21, 1), (1.0, 1), (3.0, 1), (3.0, 2), (3.0, 4)]
)
def test_nodes_of_all_levels(kappa, lines):
    """Against the hierarchy itself: levels of wide contacts keep their lines at first, close lines nodes."""
    mesh = Mesh(256, Domain(), kappa, lines)
    sizes = [level.gap.size for level in build_hierarchy(MoesPoint(200, 10, kappa), mesh, 32)]
    assert mesh.levels == pytest.approx(sum(sizes) / sizes[-1], rel=0.05)


def test_in_a_small_memory(free):
    mesh = Mesh(1024, Domain(), 0.5)
    free(mesh.needed_bytes())
    assert mesh.fits() and replace(mesh, n=960).fits()
    assert not replace(mesh, n=1088).fits() and not mesh.fits(Solve.NEWTON)
    mesh.require_memory()
    with pytest.raises(
        InputError, match=r"^n = 1088: must be such that the grid fits into memory: 5\.92e\+05 nodes take"
    ):
        replace(mesh, n=1088).require_memory()


def test_where_the_free_memory_is_not_known(free):
    free(None)
    mesh = Mesh(2048, Domain(-1.2, 1.2, 100.0), 0.5)
    assert mesh.fits(Solve.IMPEDANCE)
    mesh.require_memory()


CALLS = {
    "film": lambda: solve_steady(POINT, grid=Grid(n=256)),
    "newton": lambda: solve_steady(POINT, grid=Grid(n=128), method="newton"),
    "run": lambda: simulate(POINT, FreeVibration(Omega_n=5.13), grid=Grid(n=256)),
    "response": lambda: impedance(POINT, Omega=[0.0], grid=Grid(n=128)),
    "contact": lambda: TransientContact(POINT, grid=Grid(n=256)),
}


@pytest.mark.parametrize("call", CALLS)
def test_refused_before_anything_is_tried(call, free, monkeypatch):
    free(6e6)

    def made(*args, **kwargs):
        raise AssertionError("a level was made")

    monkeypatch.setattr("ehlcontact.solver.multigrid.build_hierarchy", made)
    match = (
        r"^n = (128|256): must be such that the grid fits into memory: .* GB \((cycles|newton|impedance)\), and"
    )
    with pytest.raises(InputError, match=match + r" 0\.006 GB are free"):
        CALLS[call]()


def test_a_grid_beyond_any_memory():
    """Without a stand-in for the machine."""
    with pytest.raises(InputError, match=r"^n = 2048: .* 2\.25e\+15 nodes take about 1\.04e\+09 GB"):
        Mesh(2048, Domain(), 0.5, 2**30).require_memory()


def test_remedies_fit(free):
    """What fails is not tried again on a grid that does not fit: what was reached is kept."""
    mesh = Mesh(256, Domain(), POINT.kappa)
    assert remedy(mesh, Status.STAGNATED, POINT, Purpose.FILM) == Mesh(512, Domain(), POINT.kappa)
    assert allows_newton(mesh)
    free(2e7)
    assert remedy(mesh, Status.STAGNATED, POINT, Purpose.FILM) is None
    assert not allows_newton(mesh)
