"""``ehlcontact element``, and ``ehlcontact atlas build`` for films; other recipes are in `test_tables`."""

import json

import atlas_stub
import pytest

from ehlcontact import read
from reduced_models import Atlas

AT = {"wide": (), "memory": (), "cubic": ("--Omega", "6.2832")}
POINT = ("--M", "2900", "--L", "19", "--kappa", "0.11")


@pytest.mark.parametrize("model", ["wide", "memory", "cubic"])
def test_element_is_printed_saved_and_written(call, tmp_path, model):
    path = tmp_path / "e.json"
    result = call("element", *POINT, "--model", model, *AT[model], "--save", path, "--json", "-")
    assert result.code == 0 and result.err == ""
    document = json.loads(result.out)
    assert document["kind"] == model and document["source"]["atlas"]
    assert document.pop("outside_assumptions") == ""
    assert read(path).to_dict() == document
    table = call("element", *POINT, "--model", model, *AT[model])
    assert table.code == 0 and "approach" in table.out and "±" in table.out
    assert ("C1 " in table.out) == (model == "cubic")


def test_build_from_points_that_are_solved(call, tmp_path):
    """Nothing is left to solve, so the atlas comes at once; its own command is inside."""
    work, output = tmp_path / "work", tmp_path / "a.h5"
    atlas_stub.prefill("film", work, 24, 24, 4)
    size = ("--draws", "24", "--light-draws", "24")
    result = call("atlas", "build", "-o", output, "--work", work, *size, "--json", "-")
    assert result.code == 0 and result.err == ""
    document = json.loads(result.out)
    assert document["command"] == "ehlcontact atlas build --recipe film --draws 24 --light-draws 24 --seed 4"
    assert Atlas(output).metadata["points"] == document["points"] > 20
    made = call("element", *POINT, "--atlas", output, "--json", "-")
    assert made.code == 0 and json.loads(made.out)["kind"] == "wide"
