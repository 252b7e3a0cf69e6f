"""Dataclasses of every kind of field, as HDF5 gives them back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

import h5py
import numpy as np
import pytest
from numpy.typing import NDArray

from ehlcontact import InputError
from ehlcontact.files import hdf5

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


def read(path, **options):
    return hdf5.read(path, {"Outer": Outer}, "file", "record", **options)


def assert_same(one, other):
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
        assert one.dtype == other.dtype
        assert one.flags.f_contiguous == other.flags.f_contiguous
    elif isinstance(one, tuple | list):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            assert_same(a, b)
    elif hasattr(one, "__dict__") and not isinstance(one, StrEnum):
        assert vars(one).keys() == vars(other).keys()
        for name, value in vars(one).items():
            assert_same(value, vars(other)[name])
    else:
        assert one == other


def test_everything_comes_back(tmp_path):
    others = outer(either=np.full((2, 2), 3.0), no_inner=outer().inner, past=(), nothing=2.0)
    for record in (outer(), others):
        assert_same(record, read(hdf5.write(record, tmp_path / "record.h5", "save")))


def test_layout(tmp_path):
    with h5py.File(hdf5.write(outer(), tmp_path / "record.h5", "save")) as file:
        assert file.attrs["class"] == b"Outer"
        assert file.attrs["place"] == b'{"x": 0.3333333333333333, "colour": "red"}'
        assert set(file["inner"]) == {"table", "free"}
        assert file["inner"].attrs["place"] == file.attrs["place"]
        assert file["past/11/1"].shape == (11,)
        assert file["pair/0"].compression == "gzip" and file["pair/1"].fletcher32


def test_format_numbers(tmp_path):
    path = hdf5.write(outer(), tmp_path / "record.h5", "save", number=2)
    assert read(path, numbers=(1, 2)).number == 7
    with pytest.raises(InputError, match="must be of format 1 or older; upgrade to read it"):
        read(path)
    with pytest.raises(InputError, match="must be a record of format 3 or newer; make it anew"):
        read(path, numbers=(3, 4))


SPOILT = ["{", "[1]", "5", '"soup"', '{"x": 1.0, "shade": 2}', '{"x": 1.0, "colour": "blue"}']


@pytest.mark.parametrize("value", SPOILT)
def test_spoilt_nested_class(value, tmp_path):
    path = hdf5.write(outer(), tmp_path / "record.h5", "save")
    with h5py.File(path, "a") as file:
        file.attrs["place"] = value
    with pytest.raises(InputError, match=r"^file = .*: must be a complete HDF5 record"):
        read(path)


def test_lost_member(tmp_path):
    path = hdf5.write(outer(), tmp_path / "record.h5", "save")
    with h5py.File(path, "a") as file:
        del file["inner/table"]
    with pytest.raises(InputError, match="a complete HDF5 record"):
        read(path)
