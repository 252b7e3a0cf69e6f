"""Files of results: round trip, and one line for every file that is not one of ours."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from math import pi
from typing import Any

import h5py
import numpy as np
import pytest
from numpy.typing import NDArray
from programs import environment

from ehlcontact import (
    FreeVibration,
    Geometry,
    Grid,
    HarmonicLoad,
    InputError,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    TimeSteps,
    read,
    save,
    simulate,
    solve_steady,
)
from ehlcontact.results import SteadyResult
from ehlcontact.store import stored, text_of
from ehlcontact.transient.result import SimulationResult

POINT = MoesPoint(20, 5, 0.5)
T = np.linspace(0.0, 0.2, 5)


def edit_header(path, **changes):
    with h5py.File(path, "a") as file:
        file.attrs["header"] = json.dumps(json.loads(text_of(file, "header")) | changes)


@pytest.fixture(scope="module")
def steady_si():
    return solve_steady(OperatingPoint(Geometry(0.004, 0.01), Lubricant(0.08, 1.9e-8), 30.0, 1.3), grid=Grid(n=32))


@pytest.fixture(scope="module")
def record():
    return simulate(
        POINT,
        HarmonicLoad(Omega=pi),
        grid=Grid(n=32),
        time=TimeSteps(until=0.3, dt=0.1),
        keep=KeepSettings(snapshots=(0.1,)),
    )


def assert_same(one, other):
    assert type(one) is type(other)
    for f in fields(one):
        a, b = getattr(one, f.name), getattr(other, f.name)
        if isinstance(a, np.ndarray):
            np.testing.assert_array_equal(a, b)
            assert a.dtype == b.dtype
            assert not b.flags.writeable
        elif f.name == "motion":
            assert type(a) is type(b)
            assert a.to_dict() == b.to_dict()
        else:
            assert a == b
            assert type(a) is type(b)


def test_steady_round_trip(steady_si, tmp_path):
    path = save(steady_si, tmp_path / "steady.h5")
    assert path == tmp_path / "steady.h5"
    again = read(path)
    assert isinstance(again, SteadyResult)
    assert_same(steady_si, again)
    assert again.to_dict() == steady_si.to_dict()


@pytest.mark.parametrize(
    "motion",
    [
        FreeVibration(Omega_n=5.0),
        RampLoad(1.3, 0.1, Omega_n=5.0),
        PrescribedLoad(T, 1.0 + T),
        PrescribedApproach(T, 0.6 + 0.1 * T),
    ],
    ids=lambda m: m.kind,
)
def test_simulation_round_trip(motion, tmp_path):
    result = simulate(POINT, motion, grid=Grid(n=16), time=TimeSteps(until=0.2, dt=0.05))
    again = read(save(result, tmp_path / "record.h5"))
    assert isinstance(again, SimulationResult)
    assert_same(result, again)


def test_snapshots_survive(record, tmp_path):
    again = read(save(record, str(tmp_path / "record.h5")))
    assert again.snapshot_h.shape[0] == 1
    assert_same(record, again)


def test_unconverged_result_is_stored_with_its_status(tmp_path):
    result = solve_steady(POINT, grid=Grid(n=32), max_cycles=1, throw=False)
    assert_same(result, read(save(result, tmp_path / "partial.h5")))


def test_arrays_fit_each_other(steady_si, tmp_path):
    path = save(steady_si, tmp_path / "steady.h5")
    with h5py.File(path, "a") as file:
        del file["pressure_changes"]
        file.create_dataset("pressure_changes", data=np.ones(steady_si.cycles + 1))
    with pytest.raises(InputError, match=r"pressure_changes has \d+ values along change, not"):
        read(path)
    with h5py.File(path, "a") as file:
        del file["pressure_changes"]
    with pytest.raises(InputError, match="a complete file of a result of solve_steady"):
        read(path, SteadyResult)


@pytest.mark.parametrize(("number", "words"), [(99, "newer"), (0, "anew"), ("1", "anew"), (True, "anew")])
def test_another_format(number, words, steady_si, tmp_path):
    path = save(steady_si, tmp_path / "steady.h5")
    edit_header(path, format=number)
    with pytest.raises(InputError, match=rf"^file = .*steady\.h5.* of format 2, not .*{words}"):
        read(path)


def test_another_class_than_wanted(steady_si, record, tmp_path):
    path = save(steady_si, tmp_path / "steady.h5")
    assert_same(read(path, SteadyResult), steady_si)
    with pytest.raises(InputError, match=r"^file = .*: must be a result of simulate; .*'SteadyResult'"):
        read(path, SimulationResult)


def test_missing_folder(steady_si, tmp_path):
    with pytest.raises(InputError, match=r"^path = .*: must be in a folder that can be written to"):
        save(steady_si, tmp_path / "nowhere" / "steady.h5")


def test_file_in_place_of_a_folder(steady_si, tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match=r"^path = "):
        save(steady_si, tmp_path / "file" / "steady.h5")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_unwritable_folder(steady_si, tmp_path):
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(InputError, match=r"^path = .*Permission denied"):
            save(steady_si, tmp_path / "steady.h5")
    finally:
        tmp_path.chmod(0o700)


def test_failed_write_keeps_the_old_file_and_leaves_no_rest(steady_si, tmp_path, monkeypatch):
    path = save(steady_si, tmp_path / "steady.h5")
    before = path.read_bytes()

    def full_disk(*args, **kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(InputError, match="No space left"):
        save(steady_si, path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["steady.h5"]


def test_interrupted_write_keeps_the_old_file(steady_si, tmp_path, monkeypatch):
    path = save(steady_si, tmp_path / "steady.h5")
    before = path.read_bytes()

    def interrupt(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        save(steady_si, path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["steady.h5"]


def test_existing_file_is_replaced(steady_si, record, tmp_path):
    path = save(steady_si, tmp_path / "result.h5")
    save(record, path)
    assert isinstance(read(path), SimulationResult)


def test_target_that_is_a_folder(steady_si, tmp_path):
    (tmp_path / "taken.h5").mkdir()
    with pytest.raises(InputError, match=r"^path = "):
        save(steady_si, tmp_path / "taken.h5")
    assert [p.name for p in tmp_path.iterdir()] == ["taken.h5"]


@pytest.mark.parametrize("value", [5, MoesPoint(20, 5, 0.5)])
def test_what_cannot_be_saved(value, tmp_path):
    with pytest.raises(InputError, match=r"^object to save = .*: must be a? ?result, element or bearing"):
        save(value, tmp_path / "five.h5")
    assert not list(tmp_path.iterdir())


Array = NDArray[np.float64]


class Colour(StrEnum):
    RED = "red"


@dataclass(frozen=True)
class Place:
    x: float
    colour: Colour


class Shape:
    """Rebuilt by name, as motions are."""

    def __init__(self, corners):
        self.corners = corners

    def to_dict(self):
        return {"corners": self.corners}

    @classmethod
    def from_dict(cls, data):
        return cls(**data)


@dataclass
class Inner:
    table: Array
    free: NDArray[np.int32]
    place: Place


@stored("record")
@dataclass
class Outer:
    number: int
    text: str
    nothing: float | None
    place: Place
    no_place: Place | None
    places: tuple[Place, ...]
    shape: Shape
    field: Array
    inner: Inner
    no_inner: Inner | None
    either: Array | float
    past: tuple[tuple[float, Array], ...]
    pair: tuple[Array, NDArray[np.int32]]
    rows: list[Array]
    anything: Any


def outer(**changes):
    place = Place(1.0 / 3.0, Colour.RED)
    record = Outer(
        number=7,
        text="caf\u00e9",
        nothing=None,
        place=place,
        no_place=None,
        places=(Place(1e-300, Colour.RED),) * 11,
        shape=Shape([1, 2.5]),
        field=np.empty((0, 4)),
        inner=Inner(np.asfortranarray(np.arange(6.0).reshape(2, 3)), np.array([3, 1], np.int32), place),
        no_inner=None,
        either=0.0,
        past=tuple((0.1 * k, np.full(k, 1.5)) for k in range(12)),
        pair=(np.eye(3), np.arange(3, dtype=np.int32)),
        rows=[np.zeros(2), np.ones(3)],
        anything={"a": [1, None]},
    )
    return replace(record, **changes)


def assert_equal(one, other):
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
        assert one.dtype == other.dtype
        assert one.flags.f_contiguous == other.flags.f_contiguous
    elif isinstance(one, tuple | list):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            assert_equal(a, b)
    elif hasattr(one, "__dict__") and not isinstance(one, StrEnum):
        assert vars(one).keys() == vars(other).keys()
        for name, value in vars(one).items():
            assert_equal(value, vars(other)[name])
    else:
        assert one == other


def test_everything_comes_back(tmp_path):
    others = outer(either=np.full((2, 2), 3.0), no_inner=outer().inner, past=(), nothing=2.0)
    for record in (outer(), others):
        assert_equal(record, read(save(record, tmp_path / "record.h5"), Outer))


def test_layout(tmp_path):
    with h5py.File(save(outer(), tmp_path / "record.h5")) as file:
        assert json.loads(text_of(file, "header"))["class"] == "Outer"
        assert file.attrs["place"] == b'{"x": 0.3333333333333333, "colour": "red"}'
        assert set(file["inner"]) == {"table", "free"}
        assert file["inner"].attrs["place"] == file.attrs["place"]
        assert file["past/11/1"].shape == (11,)
        assert file["pair/0"].compression == "gzip" and file["pair/1"].fletcher32


NO_PLACE = ["{", "[1]", "5", '"soup"', '{"x": 1.0, "shade": 2}', '{"x": 1.0, "colour": "blue"}']


@pytest.mark.parametrize("value", NO_PLACE)
def test_spoilt_nested_class(value, tmp_path):
    path = save(outer(), tmp_path / "record.h5")
    with h5py.File(path, "a") as file:
        file.attrs["place"] = value
    with pytest.raises(InputError, match="a complete file of a record"):
        read(path, Outer)


def test_lost_member(tmp_path):
    path = save(outer(), tmp_path / "record.h5")
    with h5py.File(path, "a") as file:
        del file["inner/table"]
    with pytest.raises(InputError, match="a complete file of a record"):
        read(path, Outer)


NO_LOCKS = """
#include <errno.h>
int flock(int file, int operation) { (void)file; (void)operation; errno = ENOLCK; return -1; }
"""
READING = """
import sys
from ehlcontact import MoesPoint, read, save
from reduced_models import Atlas
result = read(sys.argv[1])
print(float(result.h_central), Atlas().at(MoesPoint(100, 8, 0.5)).stiffness.min() > 0.0)
save(result, sys.argv[2])
print(float(read(sys.argv[2]).h_central))
"""


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux" or shutil.which("cc") is None, reason="a library is put before libc's")
def test_a_file_system_without_locks(tmp_path, steady):
    """As NFS without its lock service: results and the shipped atlas are read as anywhere else."""
    (tmp_path / "no_locks.c").write_text(NO_LOCKS)
    library = tmp_path / "no_locks.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, tmp_path / "no_locks.c"], check=True)
    film = steady(20, 5, 0.5, 32)
    command = [sys.executable, "-c", READING, save(film, tmp_path / "film.h5"), tmp_path / "again.h5"]
    found = subprocess.run(command, env=environment(LD_PRELOAD=str(library)), capture_output=True, text=True)
    assert found.stderr == ""
    assert found.stdout.splitlines() == [f"{film.h_central} True", f"{film.h_central}"]
    refusal = "import h5py, sys; h5py.File(sys.argv[1], 'r')"
    locked = [sys.executable, "-c", refusal, tmp_path / "film.h5"]
    with_locks = subprocess.run(locked, env=environment(LD_PRELOAD=str(library)), capture_output=True, text=True)
    assert "No locks available" in with_locks.stderr  # or the library was not there
