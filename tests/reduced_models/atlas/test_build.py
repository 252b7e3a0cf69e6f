"""The build of the atlas: what is sampled, what survives a kill, processes and a Dask cluster."""

import json
import os
import signal
import subprocess
import sys
import time

import atlas_stub
import numpy as np
import pytest
from programs import ROOT, dask_cluster, environment

from ehlcontact import Domain, InputError, MoesPoint
from ehlcontact.content_store import ContentStore
from ehlcontact.solver.mesh import Mesh
from reduced_models.atlas.build import assemble, build, solve_points
from reduced_models.atlas.film import BOX, OMEGAS, RATES, RECIPE, SAMPLED, solve_point
from reduced_models.atlas.gain_fit import smooth_gains
from reduced_models.atlas.mesh import GRIDS, LIGHT_INTERVALS, impedance_grid
from reduced_models.elements.film_response import DRY

DRAWS, LIGHT = 24, 24
NUMBERS = {"draws": DRAWS, "light_draws": LIGHT}
sample_points = RECIPE.sample
BUILD = f"""
import sys
from pathlib import Path
from atlas_stub import solve_slowly
from reduced_models.atlas.build import build
if __name__ == "__main__":
    folder = Path(sys.argv[1])
    build("film", folder / "a.h5", folder / "work", {NUMBERS}, processes=2, solve=solve_slowly)
"""


@pytest.fixture
def entries():
    return [{"point": name, **atlas_stub.solve(p)} for name, p in sample_points(DRAWS, LIGHT, 1).items()]


def test_samples_fill_a_box_that_holds_the_promised_one():
    points = list(sample_points(256, 128, 4).values())
    for name in ("M", "L", "kappa"):
        values = [getattr(p, name) for p in points]
        (low, high), (least, most) = getattr(BOX, name), getattr(SAMPLED, name)
        assert min(values) == pytest.approx(least) and max(values) == pytest.approx(most)
        assert most > high and (least < low or low == 0.0)
    pressures = [p.p_hertz for p in points]
    assert BOX.p_hertz < max(pressures) <= SAMPLED.p_hertz * (1.0 + 1e-9)


def test_mesh_is_finer_for_thinner_films_and_ends():
    widths, steps = [], []
    for M in np.geomspace(20.0, 3e4, 40).tolist():
        point = MoesPoint(M, 2.0, 0.6)
        try:
            mesh = impedance_grid(point)
        except InputError:
            assert point.inlet_width < GRIDS[-1].least_inlet
        else:
            widths.append(point.inlet_width)
            steps.append(Mesh(mesh.n, mesh.domain, 0.6).size / widths[-1])
    assert len(widths) > 25 and max(steps) < 0.55


def test_a_solved_point_has_everything_that_is_assembled():
    entry = json.loads(json.dumps(solve_point(MoesPoint(5.0, 3.0, 0.5))))
    assert entry["status"] == "converged" and entry["n"] == LIGHT_INTERVALS and entry["moment"] > 0.0
    assert len(entry["stiffness"]) == len(entry["damping"]) == len(OMEGAS)
    assert entry["approach"] < 1.0 and 0.0 < entry["h_min"] < entry["h_central"]


def test_too_thin_a_film_is_left_out_at_once():
    entry = solve_point(MoesPoint(30000.0, 0.5, 1.0))
    assert entry["status"] == "unresolved" and "approach" not in entry


@pytest.mark.long
def test_damaged_entries_are_solved_again(tmp_path):
    """And sound ones are not, whatever else lies in the folder."""
    points = sample_points(DRAWS, LIGHT, 1)
    first = solve_points(points, tmp_path, atlas_stub.solve)
    files = sorted(tmp_path.iterdir())
    before = [path.read_bytes() for path in files]
    files[0].write_bytes(before[0][:-5])
    files[1].write_bytes(b"")
    (tmp_path / "notes.txt").write_text("mine")
    solved = []
    again = solve_points(points, tmp_path, atlas_stub.solve, progress=lambda done, of: solved.append((done, of)))
    assert again == first and [path.read_bytes() for path in files] == before
    assert solved == [(len(points) - 1, len(points)), (len(points), len(points))]
    more = solve_points(sample_points(DRAWS + 8, LIGHT, 1), tmp_path, atlas_stub.solve)
    assert len(more) > len(first)


def test_a_full_disk_keeps_what_was_solved(tmp_path, monkeypatch):
    put, points = ContentStore.put, sample_points(DRAWS, LIGHT, 1)

    def full(self, key, content):
        if len(list(tmp_path.iterdir())) == 3:
            raise InputError("work folder", str(tmp_path), "a file that can be written (No space left on device)")
        put(self, key, content)

    monkeypatch.setattr(ContentStore, "put", full)
    with pytest.raises(InputError, match="No space left"):
        solve_points(points, tmp_path, atlas_stub.solve)
    assert len(list(tmp_path.iterdir())) == 3


def test_effect_of_far_oil_from_points_solved_on_both_domains(entries):
    """With pairs that differ by lambda times a constant, the points solved near alone get just that."""
    shift, close = 0.4, list(Domain(-2.0, 1.35, 1.6).as_tuple())
    points = [MoesPoint(e["M"], e["L"], e["kappa"]) for e in entries]
    changed, plain = [], assemble("film", entries, {})
    for i, (e, p) in enumerate(zip(entries, points, strict=True)):
        near = e | {"domain": close, "damping": [c - shift * p.lam for c in e["damping"]]}
        near |= {"approach": e["approach"] + 2.0 * p.lam, "moment": e["moment"] - 0.3 * p.lam}
        changed.append(near if i % 5 == 0 else e | {"close": near})
    table = assemble("film", changed, {})
    np.testing.assert_allclose(table["damping"], plain["damping"], rtol=1e-9)
    np.testing.assert_allclose(table["approach"], plain["approach"], rtol=1e-9)
    np.testing.assert_allclose(table["moment"], plain["moment"], rtol=1e-9)


def test_gains_reproduce_an_impedance_of_the_filters():
    wanted = np.zeros(3 + RATES.lags)
    wanted[[0, 1, 5]] = 0.05, 0.2, 0.4
    omega = np.array(OMEGAS)
    G = RATES.basis(omega) @ wanted * DRY
    K, C = 1.4 - omega * G.imag, G.real
    gains = smooth_gains(omega, K, C, RATES, C[1]) * C[1]
    found = RATES.basis(omega) @ gains * DRY
    np.testing.assert_allclose(found.real, C, rtol=0.02, atol=0.02 * C[1])


@pytest.mark.slow
def test_killed_build_goes_on_and_ends_the_same(tmp_path):
    """kill -9 twice: byte for byte the atlas of an undisturbed build."""
    script = tmp_path / "build.py"
    script.write_text(BUILD)
    own = environment(ROOT / "tests")
    disturbed, calm = tmp_path / "disturbed", tmp_path / "calm"
    disturbed.mkdir(), calm.mkdir()
    work = disturbed / "work"
    for least in (5, 15):
        process = subprocess.Popen([sys.executable, str(script), str(disturbed)], env=own)
        deadline = time.monotonic() + 60.0
        while not work.exists() or len(list(work.iterdir())) <= least:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.01)
        process.kill()
        process.wait()
        assert not (disturbed / "a.h5").exists()
    kept = {path.name for path in work.iterdir() if path.suffix != ".tmp"}
    for folder in (disturbed, calm):
        subprocess.run([sys.executable, str(script), str(folder)], env=own, check=True)
    assert (disturbed / "a.h5").read_bytes() == (calm / "a.h5").read_bytes()
    files = {path.name: path.read_bytes() for path in work.iterdir() if path.suffix != ".tmp"}
    assert kept < set(files) and files == {path.name: path.read_bytes() for path in (calm / "work").iterdir()}


@pytest.mark.slow
def test_dask_cluster_with_a_worker_killed_in_mid_run(tmp_path):
    """Scheduler and workers as processes of their own; the atlas is that of a local build."""
    pytest.importorskip("distributed")
    with dask_cluster(tmp_path) as (scheduler, processes):
        killed = []

        def kill_one(done, total):
            if done == 5:
                os.kill(processes[1].pid, signal.SIGKILL)
                killed.append((done, total))

        build(
            "film",
            tmp_path / "dask.h5",
            tmp_path / "dask",
            NUMBERS,
            scheduler=scheduler,
            progress=kill_one,
            solve=atlas_stub.solve_slowly,
        )
        assert killed and killed[0][0] < killed[0][1]
        assert processes[1].wait(10) == -signal.SIGKILL and processes[2].poll() is None
    build("film", tmp_path / "here.h5", tmp_path / "here", NUMBERS, solve=atlas_stub.solve)
    assert (tmp_path / "dask.h5").read_bytes() == (tmp_path / "here.h5").read_bytes()
