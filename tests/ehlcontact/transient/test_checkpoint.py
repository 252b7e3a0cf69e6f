"""Restart from a checkpoint: bit for bit the uninterrupted run, or one line that says why not."""

import os
import shutil
import subprocess
import sys
from dataclasses import fields, replace

import numpy as np
import pytest
from argument_groups import grouped

from ehlcontact import (
    ConvergenceError,
    Dent,
    Domain,
    FreeVibration,
    Grid,
    HarmonicLoad,
    InputError,
    KeepSettings,
    MoesPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    Roughness,
    TimeSteps,
    Waviness,
    read,
    simulate,
)
from ehlcontact.status import Status
from ehlcontact.transient import checkpoint
from ehlcontact.transient.checkpoint import Checkpoint
from ehlcontact.transient.result import SimulationResult
from ehlcontact.transient.transient_film import TransientFilm

POINT = MoesPoint(200, 10, 0.5)
N = 32
FIXED = dict(n=N, until=0.8, dt=0.05, snapshots=(0.1, 0.52))
CONTROLLED = dict(n=N, until=0.8, local_error=1e-3, snapshots=(0.1, 0.52))
RUNS = {
    "free": (FreeVibration(Omega_n=5.13), FIXED),
    "harmonic over waviness": (HarmonicLoad(Omega=3.0), FIXED | dict(surface=Waviness(0.05, 0.5))),
    "load over roughness": (
        PrescribedLoad([0.0, 0.3, 0.6, 0.8], [1.0, 1.0, 1.0, 1.0]),
        FIXED | dict(surface=Roughness.synthetic(0.01, 2.0, 1.5, kappa=0.5, speed=0.7)),
    ),
    "ramp, controlled": (RampLoad(1.3, 0.3, Omega_n=5.13), CONTROLLED),
    "pulse, controlled": (PrescribedLoad([0.0, 0.3, 0.4, 0.5, 0.8], [1.0, 1.0, 1.3, 1.0, 1.0]), CONTROLLED),
    "approach, controlled": (PrescribedApproach([0.0, 0.3, 0.6, 0.8], [0.88, 0.95, 0.90, 0.88]), CONTROLLED),
}


def assert_same_bits(one, other):
    for f in fields(one):
        a, b = getattr(one, f.name), getattr(other, f.name)
        if isinstance(a, np.ndarray):
            assert a.dtype == b.dtype
            np.testing.assert_array_equal(a, b, err_msg=f.name)
        elif f.name == "motion":
            assert a.to_dict() == b.to_dict()
        elif f.name != "seconds":
            assert a == b, f.name


def stop_after(T_stop):
    def callback(T, until):
        if T > T_stop:
            raise KeyboardInterrupt

    return callback


@pytest.mark.long
@pytest.mark.parametrize("name", RUNS)
def test_restart_equals_the_uninterrupted_run(name, tmp_path):
    motion, settings = RUNS[name]
    path = tmp_path / "c.h5"
    whole = simulate(POINT, motion, **grouped(**settings))
    for T in (0.0, 0.25, 0.55):
        part = simulate(POINT, motion, **grouped(**settings, checkpoint=path, callback=stop_after(T)))
        assert part.status is Status.INTERRUPTED
        assert T < part.t[-1] < 0.8
        assert_same_bits(whole, simulate(POINT, motion, **grouped(**settings, restart=path)))
        path.unlink()


def test_an_existing_file_is_not_overwritten(tmp_path):
    path = tmp_path / "kept.h5"
    path.write_bytes(b"somebody's result")
    with pytest.raises(InputError, match=r"^checkpoint = .*would be lost"):
        simulate(
            POINT,
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=16),
            time=TimeSteps(until=0.1, dt=0.1),
            keep=KeepSettings(checkpoint=path),
        )
    assert path.read_bytes() == b"somebody's result"


@pytest.mark.slow
@pytest.mark.parametrize("point", [MoesPoint(2900, 19, 0.11), MoesPoint(58, 5, 1.5)], ids=str)
@pytest.mark.parametrize("n", [64, 128])
def test_other_points_and_grids(point, n, tmp_path):
    """Other coarsest grids, engines and a ring of restarts, in another process."""
    settings = dict(n=n, until=0.2, dt=0.02)
    whole = simulate(point, HarmonicLoad(Omega=3.0), **grouped(**settings))
    simulate(
        point,
        HarmonicLoad(Omega=3.0),
        **grouped(**settings, checkpoint=tmp_path / "c.h5", callback=stop_after(0.07)),
    )
    simulate(
        point,
        HarmonicLoad(Omega=3.0),
        **grouped(**settings, restart=tmp_path / "c.h5", checkpoint=tmp_path / "c.h5", callback=stop_after(0.13)),
    )
    script = (
        "import sys; from ehlcontact import *\n"
        f"point = MoesPoint({point.M}, {point.L}, {point.kappa})\n"
        f"run = simulate(point, HarmonicLoad(Omega=3.0), "
        f"grid=Grid({n}), time=TimeSteps(until=0.2, dt=0.02), keep=KeepSettings(restart=sys.argv[1]))\n"
        "save(run, sys.argv[2])"
    )
    alone = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", script, tmp_path / "c.h5", tmp_path / "r.h5"], check=True, env=alone)
    assert_same_bits(whole, read(tmp_path / "r.h5"))


def test_ctrl_c_within_a_step_leaves_a_current_checkpoint(tmp_path, monkeypatch):
    motion, settings = RUNS["free"]
    path = tmp_path / "c.h5"
    whole = simulate(POINT, motion, **grouped(**settings))
    advance, calls = TransientFilm.advance, []

    def stopped(self, *arguments):
        calls.append(1)
        if len(calls) == 7:
            self.level.P[...] *= 1.3  # half way through a cycle
            raise KeyboardInterrupt
        return advance(self, *arguments)

    with monkeypatch.context() as patch:
        patch.setattr(TransientFilm, "advance", stopped)
        part = simulate(POINT, motion, **grouped(**settings, checkpoint=path))
    assert part.status is Status.INTERRUPTED
    assert part.steps == 6
    assert_same_bits(whole, simulate(POINT, motion, **grouped(**settings, restart=path)))


def test_a_killed_run_goes_on_from_its_last_checkpoint(tmp_path):
    """The file after any step, as a kill -9 would leave it."""
    motion, settings = RUNS["ramp, controlled"]
    path, kept = tmp_path / "c.h5", tmp_path / "kept.h5"

    def copy(T, until):
        if not kept.exists() and T > 0.4:
            shutil.copy(path, kept)

    whole = simulate(POINT, motion, **grouped(**settings, checkpoint=path, checkpoint_every=0.0, callback=copy))
    assert_same_bits(whole, simulate(POINT, motion, **grouped(**settings, restart=kept)))


def test_checkpoints_are_not_written_more_often_than_asked(tmp_path):
    motion, settings = RUNS["free"]
    path = tmp_path / "c.h5"
    seen = []
    simulate(
        POINT,
        motion,
        **grouped(**settings, checkpoint=path, callback=lambda T, until: seen.append(path.stat().st_mtime_ns)),
    )
    assert len(set(seen)) == 1  # at the start; the next one at the end
    assert path.stat().st_mtime_ns > seen[0]
    assert [p.name for p in tmp_path.iterdir()] == ["c.h5"]


def test_failed_step_leaves_the_last_good_one(tmp_path, monkeypatch):
    motion, settings = RUNS["free"]
    path = tmp_path / "c.h5"
    whole = simulate(POINT, motion, **grouped(**settings))

    def no_more_cycles(T, until):
        if T > 0.3:
            monkeypatch.setattr("ehlcontact.transient.transient_film.STEP_CYCLES", 0)

    with pytest.raises(ConvergenceError, match=r"step 0\.05, residual .* with tol 0\.003"), monkeypatch.context():
        simulate(POINT, motion, **grouped(**settings, checkpoint=path, callback=no_more_cycles))
    monkeypatch.undo()
    assert_same_bits(whole, simulate(POINT, motion, **grouped(**settings, restart=path)))


def test_a_finished_run_can_be_extended(tmp_path):
    motion = HarmonicLoad(Omega=3.0)
    simulate(
        POINT,
        motion,
        grid=Grid(n=N),
        time=TimeSteps(until=0.4, dt=0.05),
        keep=KeepSettings(checkpoint=tmp_path / "c.h5"),
    )
    longer = simulate(
        POINT,
        motion,
        grid=Grid(n=N),
        time=TimeSteps(until=0.8, dt=0.05),
        keep=KeepSettings(restart=tmp_path / "c.h5"),
    )
    assert_same_bits(simulate(POINT, motion, grid=Grid(n=N), time=TimeSteps(until=0.8, dt=0.05)), longer)


@pytest.mark.parametrize("motion", [HarmonicLoad(Omega=3.0), FreeVibration(Omega_n=5.13)], ids=lambda m: m.kind)
@pytest.mark.parametrize("dt", [None, 0.03])
def test_a_later_end_keeps_the_stored_step(motion, dt, tmp_path):
    """Whatever the default, or the shortening, would be for that end; also the second time."""
    options = dict(n=N, dt=dt)
    first = simulate(POINT, motion, **grouped(until=0.2, **options, checkpoint=tmp_path / "c.h5"))
    step = float(first.t[1])
    for until in (0.2, 0.37, 0.4, 0.55):
        longer = simulate(
            POINT,
            motion,
            **grouped(until=until, **options, restart=tmp_path / "c.h5", checkpoint=tmp_path / "c.h5"),
        )
        np.testing.assert_allclose(np.diff(longer.t), step, rtol=1e-9)
        assert until - 1e-12 <= longer.t[-1] < until + step
        assert np.array_equal(longer.force[: first.t.size], first.force)
    whole = simulate(POINT, motion, grid=Grid(n=N), time=TimeSteps(until=longer.t[-1], dt=step))
    assert_same_bits(replace(longer, t=whole.t), whole)
    with pytest.raises(InputError, match=r"its dT is 0\.0"):
        simulate(
            POINT,
            motion,
            time=TimeSteps(until=0.6, dt=0.011),
            grid=Grid(n=N),
            keep=KeepSettings(restart=tmp_path / "c.h5"),
        )


@pytest.mark.parametrize("until", [0.3, 0.7, 1.1])
def test_a_finished_run_can_be_asked_for_again(until, tmp_path):
    """Its end is met but for rounding: three steps of 0.1 are more than 0.3."""
    options = dict(n=N, until=until, dt=0.1)
    whole = simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**options, checkpoint=tmp_path / "c.h5"))
    assert_same_bits(
        whole, simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**options, restart=tmp_path / "c.h5"))
    )


def test_a_controlled_run_can_be_extended(tmp_path):
    options = dict(n=N, local_error=1e-3)
    simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(until=0.4, **options, checkpoint=tmp_path / "c.h5"))
    longer = simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(until=0.8, **options, restart=tmp_path / "c.h5"))
    assert longer.t[-1] == 0.8


def test_a_checkpoint_that_cannot_be_written_later_is_told_and_the_run_goes_on(tmp_path, monkeypatch):
    """Only the first ends a run, before anything is lost; the last one raises with the run."""
    path, write, fails = tmp_path / "c.h5", checkpoint.save, set()

    def counted(record, *given):
        if record.record.T > 0.1 and record.record.T < max(fails):
            raise InputError("checkpoint", str(path), "a file that can be written (No space left on device)")
        return write(record, *given)

    monkeypatch.setattr(checkpoint, "save", counted)
    options = dict(n=N, until=0.4, dt=0.1, checkpoint=path, checkpoint_every=0.0)
    fails.add(0.35)
    with pytest.warns(RuntimeWarning, match="No space left.*the run goes on") as told:
        result = simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**options))
    assert len(told) == 1 and result.status.ok and read(path, Checkpoint).record.T == result.t[-1]
    path.unlink()
    fails.add(9.0)
    with pytest.warns(RuntimeWarning), pytest.raises(InputError, match=r"^checkpoint = .*No space left") as caught:
        simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**options))
    assert np.array_equal(caught.value.result.force, result.force)
    assert read(path, Checkpoint).record.T == 0.1


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """Checkpoint of a free vibration over a dent, at T = 0.2, and the arguments of its run."""
    path = tmp_path_factory.mktemp("checkpoint") / "c.h5"
    arguments = dict(
        point=POINT,
        motion=FreeVibration(Omega_n=5.13),
        n=N,
        until=0.4,
        dt=0.05,
        snapshots=(0.1,),
        surface=Dent(0.05, 0.5, start=-0.5, kappa=0.5),
    )
    simulate(**grouped(**arguments, checkpoint=path, callback=stop_after(0.16)))
    return path, arguments


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (dict(point=MoesPoint(210, 10, 0.5)), ("point", "M=200", "M=210")),
        (dict(point=MoesPoint(200, 10.00001, 0.5)), ("point", "L=10.0,", "L=10.00001")),
        (dict(domain=Domain(-4.0, 1.5, 3.0)), ("domain", "x_in=-4.5", "x_in=-4.0")),
        (dict(n=64), ("n", "32", "64")),
        (dict(motion=FreeVibration(Omega_n=5.2)), ("motion.Omega_n", "5.13", "5.2")),
        (dict(motion=HarmonicLoad(Omega=5.13)), ("motion.kind", "free", "harmonic")),
        (dict(tol=1e-3), ("tol", "0.003", "0.001")),
        (dict(dt=0.04), ("dT", "0.05", "0.04")),
        (dict(local_error=1e-3), ("local_error", "None", "0.001")),
        (dict(snapshots=(0.1, 0.15)), ("snapshots", "[0.1]", "0.15")),
        (dict(surface=Dent(0.06, 0.5, start=-0.5, kappa=0.5)), ("surface", "0.0464", "0.0557")),
        (dict(surface=None), ("surface", "none")),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_checkpoint_of_another_run(stopped, change, words):
    path, arguments = stopped
    with pytest.raises(
        InputError, match=r"^restart = '.*c\.h5': must be a checkpoint of this run: its "
    ) as caught:
        simulate(**grouped(**(arguments | change), restart=path))
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 600
    for word in words:
        assert word in message


def test_end_before_the_checkpoint(stopped):
    path, arguments = stopped
    with pytest.raises(InputError, match=r"^until = 0\.1: must be at least 0\.2"):
        simulate(**grouped(**(arguments | dict(until=0.1)), restart=path))


def test_a_checkpoint_is_no_result(stopped):
    with pytest.raises(InputError, match=r"^file = .*: must be a result of simulate; .*'Checkpoint'"):
        read(stopped[0], SimulationResult)


def test_checkpoint_in_no_folder(tmp_path):
    with pytest.raises(InputError, match=r"^checkpoint = .*: must be in a folder that can be written to"):
        simulate(
            POINT,
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=N),
            time=TimeSteps(until=0.1, dt=0.05),
            keep=KeepSettings(checkpoint=tmp_path / "none" / "c.h5"),
        )
    with pytest.raises(InputError, match=r"^checkpoint_every = -1\.0: must be "):
        simulate(
            POINT,
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=16),
            keep=KeepSettings(checkpoint=tmp_path / "c.h5", checkpoint_every=-1.0),
        )


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
def test_checkpoint_is_readable_by_others(stopped):
    assert stopped[0].stat().st_mode & 0o777 == 0o666 & ~_umask()


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
