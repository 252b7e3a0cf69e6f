"""``ehlcontact element`` and ``ehlcontact atlas build``."""

import json

import atlas_stub
import pytest

from ehlcontact import load
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
    assert load(path).to_dict() == document
    table = call("element", *POINT, "--model", model, *AT[model])
    assert table.code == 0 and "approach" in table.out and "±" in table.out
    assert ("damper C1" in table.out) == (model == "cubic")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--M", "0.9", "--L", "19", "--kappa", "0.11"), ("M = 0.9", "between 1 and 30000", "kappa 0.045..1")),
        (("--M", "2900", "--L", "19", "--kappa", "0.04"), ("kappa = 0.04", "between 0.045 and 1")),
        (("--M", "20000", "--L", "25", "--kappa", "0.9"), ("Hertz pressure", "4.1")),
        ((*POINT, "--viscosity", "barus"), ("viscosity", "roelands")),
        ((*POINT, "--model", "quartic"), ("--model", "quartic", "wide")),
        ((*POINT, "--save", "e.txt"), ("--save", ".json")),
        ((*POINT, "--atlas", "nowhere.h5"), ("nowhere.h5",)),
        (("--M", "6", "--L", "19", "--kappa", "0.11", "--model", "cubic", "--Omega", "1"), ("cubic", "wide")),
        ((*POINT, "--model", "cubic"), ("--Omega", "must be given")),
        ((*POINT, "--model", "wide", "--Omega", "1"), ("Omega", "left out", "wide")),
    ],
)
def test_element_refuses(refused, arguments, words):
    refused(words, "element", *arguments)


def test_build_from_points_that_are_solved(call, tmp_path):
    """Nothing is left to solve, so the atlas comes at once; its own command is inside."""
    work, output = tmp_path / "work", tmp_path / "a.h5"
    atlas_stub.prefill(work, 24, 24)
    size = ("--draws", "24", "--light-draws", "24")
    result = call("atlas", "build", "-o", output, "--work", work, *size, "--json", "-")
    assert result.code == 0 and result.err == ""
    document = json.loads(result.out)
    assert document["command"] == "ehlcontact atlas build --draws 24 --light-draws 24 --seed 4"
    assert Atlas(output).metadata["points"] == document["points"] > 20
    made = call("element", *POINT, "--atlas", output, "--json", "-")
    assert made.code == 0 and json.loads(made.out)["kind"] == "wide"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--draws", "-1"), ("--draws", "-1")),
        (("--processes", "0"), ("--processes", "0")),
        (("-o", "a.txt"), (".h5",)),
        (("-o", "no/such/folder/a.h5"), ("folder",)),
    ],
)
def test_build_refuses(refused, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    refused(words, "atlas", "build", *arguments)
    assert list(tmp_path.iterdir()) == []


def test_work_in_a_file_is_refused(refused, tmp_path):
    work = tmp_path / "work"
    work.write_text("my notes")
    refused(("work folder", "File exists"), "atlas", "build", "-o", tmp_path / "a.h5", "--work", work)
    assert work.read_text() == "my notes"
