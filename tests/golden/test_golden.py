"""The library's own numbers must not move unnoticed.

Tighter than any discretisation error, looser than rounding across machines. If a change is meant:
``python tests/golden/regenerate.py``, and a line under "Numerics" in CHANGELOG.md.
"""

import importlib.util
import json
from pathlib import Path

import pytest


def script(name):
    """The script beside this file that makes what is recorded."""
    spec = importlib.util.spec_from_file_location(f"golden_{name}", Path(__file__).with_name(f"{name}.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


golden, meshes = script("regenerate"), script("meshes")
EXPECTED = json.loads(golden.FILE.read_text())


MESHES = json.loads(meshes.FILE.read_text())


def test_every_case_is_recorded():
    assert set(EXPECTED["steady"]) == set(golden.STEADY)
    assert set(EXPECTED["transient"]) == set(golden.TRANSIENT)
    assert set(EXPECTED["fit"]) == set(golden.MODELS)
    assert set(EXPECTED["atlas"]) == set(golden.ATLAS)


@pytest.mark.parametrize("name", golden.STEADY)
def test_steady(name):
    assert golden.steady(name) == pytest.approx(EXPECTED["steady"][name], rel=1e-6)


@pytest.mark.parametrize("name", golden.TRANSIENT)
def test_transient(name):
    got, expected = golden.transient(name), EXPECTED["transient"][name]
    assert got == pytest.approx(expected, rel=2e-5, abs=1e-5)


def test_impedance():
    got = golden.response()
    assert got["stiffness"] == pytest.approx(EXPECTED["impedance"]["stiffness"], rel=1e-4)
    assert got["damping"] == pytest.approx(EXPECTED["impedance"]["damping"], rel=1e-3)


def alike(got, expected, rel):
    """The same keys, and numbers or lists of numbers within `rel`."""
    assert set(got) == set(expected)
    for name in expected:
        assert got[name] == pytest.approx(expected[name], rel=rel, abs=1e-9), name


@pytest.mark.parametrize("model", golden.MODELS)
def test_fit(model):
    # the seven terms are hardly identifiable: rounding of the record is seen through their condition
    alike(golden.fitted(model), EXPECTED["fit"][model], rel=1e-2 if model in ("polynomial", "memory") else 1e-3)


@pytest.mark.parametrize("name", golden.ATLAS)
def test_atlas(name):
    alike(golden.answered(name), EXPECTED["atlas"][name], rel=1e-6)


def test_meshes_are_recorded_for_all_points():
    assert [row["point"] for row in MESHES] == meshes.points()


def flat(value):
    """The numbers and words in nested lists, in order."""
    return [leaf for part in value for leaf in flat(part)] if isinstance(value, list) else [value]


@pytest.mark.parametrize("row", MESHES, ids=lambda row: "M {} L {} kappa {}".format(*row["point"]))
def test_mesh(row):
    """`python tests/golden/meshes.py` where a rule was meant to change."""
    got = meshes.decisions(*row["point"])
    assert {"point", *got} == set(row)
    for name, value in got.items():
        found, expected = flat(value), flat(row[name])
        assert [type(leaf) for leaf in found] == [type(leaf) for leaf in expected], name
        for leaf, recorded in zip(found, expected, strict=True):
            same = pytest.approx(recorded, rel=1e-9) if isinstance(recorded, float) else recorded
            assert leaf == same, name
