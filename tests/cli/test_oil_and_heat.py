"""``ehlcontact bearing`` with a layer of oil and with heat: table, JSON and CSV; mistakes in one line."""

import csv
import json
from functools import partial
from pathlib import Path

import pytest

from ehlcontact import Grid, impedance
from reduced_models.bearing import oil_and_heat

EXAMPLE = Path(__file__).parents[2] / "examples" / "bearing_6205.toml"
OIL = ("--oil", "68", "--temp", "60")
PAIR = ("--pair", "back-to-back", "--preload", "100")
AT = ("bearing", "6205", "--load", "100", "--speed-rpm", "6000")


@pytest.fixture
def coarse(monkeypatch):
    """Contacts on coarse grids: here it is about what is shown."""
    monkeypatch.setattr(oil_and_heat, "impedance", partial(impedance, grid=Grid(48)))


def test_table_json_and_csv_have_the_same_numbers(call, coarse, tmp_path):
    files = ("--json", tmp_path / "b.json", "--csv", tmp_path / "b.csv")
    result = call(*AT, *OIL, "--rq", "0.1", "--thermal", "--layer-ratio", "0.8", *files)
    assert result.code == 0 and result.err == ""
    document = json.loads((tmp_path / "b.json").read_text())
    found, conditions = document["oil_and_heat"][0], document["oil_and_heat"][0]["conditions"]
    assert list(conditions) == ["flooded, isothermal", "with heat", "with the layer", "with both"]
    assert document["units"]["oil_and_heat"] and found["hz"] == [100.0, 500.0]
    rows = {row["quantity"]: row for row in csv.DictReader((tmp_path / "b.csv").read_text().splitlines())}
    words = " ".join(result.out[result.out.index("oil supply and heat") :].split())
    for key, one in conditions.items():
        for quantity, value in (
            ("central film, inner", 1e6 * one["h_central"][0][0]),
            ("smallest film, outer", 1e6 * one["h_min"][0][1]),
            ("damping, 100 Hz", one["damping"][0][1]),
            ("stiffness, 500 Hz", 1e-6 * one["stiffness"][1][1]),
            ("rolling torque", 1e3 * one["rolling"]),
        ):
            assert float(rows[quantity][key]) == pytest.approx(value, rel=1e-12)
            line = words[words.index(quantity) :]
            assert f"{value:.4g}" in line[: line.index("]", line.index("]") + 1)]  # up to the next one
    assert float(rows["rolling torque"]["SKF"]) == 1e3 * document["states"][0]["skf_rolling"]
    assert "SKF's model: rolling" in words and "With both is a product" in words
    assert float(rows["central film, inner"]["with the layer"]) < float(rows["central film, inner"]["with heat"])


def test_entries_of_a_file_and_options_in_their_place(call, coarse, tmp_path):
    text = EXAMPLE.read_text().replace("[1000, 3000, 6000]", "[6000]\nlayer_um = 0.2")
    path = tmp_path / "b.toml"
    path.write_text(text.replace("radial_load = 1000.0", "radial_load = 100.0"))
    found = json.loads(call("bearing", path, "--json", "-").out)["oil_and_heat"][0]
    assert list(found["conditions"]) == ["flooded, isothermal", "with the layer"]
    thick = json.loads(call("bearing", path, "--layer", "400", "--json", "-").out)["oil_and_heat"][0]["conditions"]
    assert thick["with the layer"]["rolling"] == pytest.approx(thick["flooded, isothermal"]["rolling"], rel=1e-3)


def test_without_them_nothing_of_it_is_there(call):
    found = json.loads(call(*AT, *OIL, "--json", "-").out)
    assert "oil_and_heat" not in found and "oil_and_heat" not in found["units"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((*OIL, "--layer", "0.2", "--layer-ratio", "1"), ("--layer = 0.2", "left out", "layer_ratio")),
        ((*OIL, "--layer", "-0.2"), ("--layer = -0.2", "um")),
        ((*OIL, "--layer", "2e-7"), ("--layer = 2e-07", "in m?")),
        ((*OIL, "--layer", "nan"), ("--layer = nan",)),
        ((*OIL, "--layer-ratio", "0"), ("--layer-ratio = 0", "above 0")),
        ((*OIL, "--layer-ratio", "inf"), ("--layer-ratio = inf", "finite")),
        (("--thermal",), ("--thermal = True", "dry bearing")),
        (("--layer", "0.2"), ("--layer = 0.2", "dry bearing")),
        ((*OIL, "--csv", "b.csv"), ("--csv", "--thermal")),
        ((*OIL, "--thermal", "--csv", "b.txt"), ("--csv", ".csv")),
        ((*OIL, "--thermal", "--contact-angle", "15", *PAIR), ("--thermal", "pair")),
    ],
)
def test_mistakes(refused, given, words):
    refused(words, *AT, *given)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"iso_vg = 68": "eta0 = 0.03\nalpha = 2e-8", "temperature = 50.0": ""}, ("thermal", "by its grade")),
        ({"thermal = true": "thermal = 1"}, ("operation.thermal = 1",)),
        ({"thermal = true": "layer_mm = 1"}, ("operation.layer_mm",)),
    ],
)
def test_mistakes_of_a_file(refused, tmp_path, changes, words):
    text = EXAMPLE.read_text().replace("[1000, 3000, 6000]", "[3000]\nthermal = true")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "b.toml").write_text(text)
    refused(words, "bearing", tmp_path / "b.toml")
