"""``ehlcontact bearing`` with a layer of oil and with heat: table, JSON and CSV; mistakes in one line."""

import csv
import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from tiny_study import ALONE, MACHINE, MOTOR

import reduced_models.bearing.oil_and_heat as module
from ehlcontact import ConvergenceError, Grid, Lubricant, OilLayer, impedance
from ehlcontact.cli.study.forecast import CONDITION, closing_cost
from ehlcontact.cli.study.headline import damping_below_zero, without_films
from ehlcontact.cli.study.headline import oil_and_heat as sentence
from ehlcontact.cli.study.oil_and_heat import FREQUENCIES, run_oil_and_heat
from ehlcontact.cli.study.points.finalise import faults
from ehlcontact.cli.study.report import conditions
from ehlcontact.cli.study.schema import load_study
from ehlcontact.status import Status
from reduced_models import BallBearing, BearingSet
from reduced_models.atlas.supply import THINNEST
from reduced_models.bearing.oil_and_heat import FLOODED, LAYER, oil_and_heat
from reduced_models.bearing.picture import conditions_coefficients, conditions_films

EXAMPLE = Path(__file__).parents[2] / "examples" / "bearing_6205.toml"
OIL = ("--oil", "68", "--temp", "60")
AT = ("bearing", "6205", "--load", "100", "--speed-rpm", "6000")


@pytest.fixture
def coarse(monkeypatch):
    """Contacts on coarse grids: here it is about what is shown."""
    monkeypatch.setattr(module, "impedance", partial(impedance, grid=Grid(48)))


@pytest.mark.long
def test_table_json_and_csv_have_the_same_numbers(call, coarse, tmp_path):
    files = ("--json", tmp_path / "b.json", "--csv", tmp_path / "b.csv")
    result = call(*AT, *OIL, "--rq", "0.1", "--thermal", "--layer-ratio", "0.8", "--solve", *files)
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


def test_numbers_from_tables_have_error_bars(call, tmp_path):
    files = ("--json", tmp_path / "b.json", "--csv", tmp_path / "b.csv")
    result = call(*AT, *OIL, "--thermal", *files)
    bars = json.loads((tmp_path / "b.json").read_text())["oil_and_heat"][0]["error_bars"]["with heat"]
    rows = {row["quantity"]: row for row in csv.DictReader((tmp_path / "b.csv").read_text().splitlines())}
    for quantity, bar in (
        ("central film, inner", 1e6 * bars["h_central"][0]),
        ("damping, 500 Hz", bars["damping"][1][1]),
    ):
        assert float(rows[quantity]["with heat, error bar"]) == pytest.approx(bar, rel=1e-12)
        assert f"±{bar:.2g}" in result.out
    assert rows["torque"]["with heat, error bar"] == ""


@pytest.mark.long
def test_entries_of_a_file_and_options_in_their_place(call, coarse, tmp_path):
    text = EXAMPLE.read_text().replace("[1000, 3000, 6000]", "[6000]\nlayer_um = 0.2")
    path = tmp_path / "b.toml"
    path.write_text(text.replace("radial_load = 1000.0", "radial_load = 100.0"))
    found = json.loads(call("bearing", path, "--json", "-").out)["oil_and_heat"][0]
    assert list(found["conditions"]) == ["flooded, isothermal", "with the layer"] and not found["solved"]
    thick = json.loads(call("bearing", path, "--layer", "400", "--json", "-").out)["oil_and_heat"][0]["conditions"]
    assert thick["with the layer"]["rolling"] == pytest.approx(thick["flooded, isothermal"]["rolling"], rel=1e-3)


@pytest.mark.long
def test_a_pair_has_the_numbers_of_the_library(call, tmp_path):
    given = ("--pair", "back-to-back", "--preload", "150", "--axial", "100", "--speed-rpm", "6000")
    files = ("--json", tmp_path / "p.json", "--csv", tmp_path / "p.csv")
    result = call("bearing", "7205", *given, *OIL, "--layer-ratio", "1", *files)
    assert result.code == 0 and "The most loaded ball is that of bearing 0, facing +z" in result.out
    found = json.loads((tmp_path / "p.json").read_text())["oil_and_heat"][0]
    bearing = BallBearing.catalogue("7205", oil=Lubricant.iso_vg(68, temperature=60.0))
    under = {"speed_rpm": 6000.0, "supply": OilLayer(over_flooded=1.0)}
    expected = oil_and_heat(BearingSet.pair(bearing, preload=150.0), (0.0, 0.0, 100.0), **under)
    assert found == json.loads(json.dumps(expected.to_dict()))
    assert found["conditions"][LAYER]["damping"][0][2] < 0.0
    assert '"damping, 100 Hz",N s/m' in (tmp_path / "p.csv").read_text()


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
        ((*OIL, "--layer-ratio", "0"), ("--layer-ratio = 0", "between 0.02")),
        ((*OIL, "--layer-ratio", "0.019"), ("--layer-ratio = 0.019", "between 0.02")),
        ((*OIL, "--layer-ratio", "inf"), ("--layer-ratio = inf", "finite")),
        (("--thermal",), ("--thermal = True", "dry bearing")),
        (("--layer", "0.2"), ("--layer = 0.2", "dry bearing")),
        ((*OIL, "--csv", "b.csv"), ("--csv", "--thermal")),
        ((*OIL, "--solve"), ("--solve", "--thermal")),
        ((*OIL, "--thermal", "--csv", "/nonexistent/b.csv"), ("--csv = ", "a folder that exists")),
        ((*OIL, "--thermal", "--csv", "b.txt"), ("--csv", ".csv")),
    ],
)
def test_mistakes(refused, given, words):
    refused(words, *AT, *given)


def test_the_thinnest_layer_is_that_of_the_tables(refused, tmp_path):
    text = EXAMPLE.read_text().replace("[1000, 3000, 6000]", "[3000]\nlayer_ratio = 0.0199")
    (tmp_path / "b.toml").write_text(text)
    refused(("operation.layer_ratio = 0.0199", f"between {THINNEST:g}"), "bearing", tmp_path / "b.toml")


def test_a_condition_without_a_film_ends_with_exit_code_1(call, monkeypatch):
    """After all else is shown, with an advice in options of the command."""

    class Starved:
        status = Status.STARVED

    def solved(point, *, hz, supply=None, thermal=None):
        if supply is None:
            return impedance(point, hz=hz, grid=Grid(48))
        raise ConvergenceError("steady solve starved: raise n", Starved())

    monkeypatch.setattr(module, "impedance", solved)
    found = call(*AT, *OIL, "--layer", "0.0001", "--solve")
    assert found.code == 1 and "stiffness" in found.out and "let more oil in" in found.out
    assert "raise n" not in found.out + found.err and "no films with the layer at 6000 rpm" in found.err
    assert "thicker layer, by --layer or --layer-ratio" in found.err


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


PLAIN, GRADE = "eta0 = 0.02\nalpha = 1e-8", "iso_vg = 68\ntemperature = 60.0"
BY_GRADE = ALONE.replace(PLAIN, GRADE)
ASKED = BY_GRADE.replace("[operation]", "[operation]\nthermal = true\nlayer_ratio = 1.0")


def study(folder, text):
    path = folder / "study.toml"
    path.write_text(text)
    return path


@pytest.mark.long
def test_section_of_a_study(coarse, tmp_path):
    """Table, figures and sentence of the report; its cost in the forecast; nothing where it is not asked for."""
    plain, asked = (load_study(study(tmp_path, text)) for text in (BY_GRADE, ASKED))
    assert run_oil_and_heat(plain) == {}
    less, more = (closing_cost(one) for one in (plain, asked))
    assert more - less == pytest.approx(4 * CONDITION)
    (found,) = run_oil_and_heat(asked).values()
    assert list(found.conditions) == ["flooded, isothermal", "with heat", "with the layer", "with both"]
    assert found.hz.size == 2 + FREQUENCIES

    findings = SimpleNamespace(study=asked, oil_and_heat={"1": found})
    told = conditions(findings)
    (row,) = told["conditions"]
    assert row[0] == "" and row[2][0][1:] == list(found.conditions) and "r = 1 over" in told["supply_words"]
    words = sentence(findings)
    assert words.count("% of the film") == 3 and f"{found.conditions[FLOODED].damping[0, 1]:.3g} N s/m" in words
    C = found.conditions[LAYER].damping[0, 1]
    assert C < 0.0
    assert f"damping below zero: the bearing has with the layer {C:.3g} N s/m" in damping_below_zero(findings)
    findings.oil_and_heat = {"1": replace(found, conditions={FLOODED: found.conditions[FLOODED]})}
    assert damping_below_zero(findings) == "" == without_films(findings)
    findings.oil_and_heat = {"1": replace(found, refused={LAYER: "thin"})}
    assert without_films(findings) == "no films of the bearing with the layer (thin)."
    around, band = (
        [line for panel in describe(found).panels for line in panel.lines]
        for describe in (conditions_films, conditions_coefficients)
    )
    assert [line.name for line in around] == 2 * list(found.conditions)
    np.testing.assert_allclose(around[0].x, -around[0].x[::-1], atol=1e-9)
    assert np.all(np.diff(band[0].x) >= 0.0) and len(band) == 8


def test_a_study_tells_why_there_is_no_answer(tmp_path, monkeypatch):
    def fails(*points, **given):
        raise ConvergenceError("no film", None)

    monkeypatch.setattr("ehlcontact.cli.study.oil_and_heat.oil_and_heat", fails)

    asked = load_study(study(tmp_path, ASKED))
    findings = SimpleNamespace(study=asked, oil_and_heat=run_oil_and_heat(asked))
    assert "not computed" in (said := without_films(findings)) and "no film" in said
    assert sentence(findings) == "" and conditions(findings)["conditions"][0][2] is None
    results = {"fmu": {"passes": True}, "film_fmu": None, "oil_and_heat": findings.oil_and_heat}
    assert faults(results) == [f"oil supply and heat of the bearing: {findings.oil_and_heat['1']}"]


def test_every_bearing_has_a_section(tmp_path, monkeypatch):
    """Under its own load; equal bearings under one load share it."""
    loads = []

    def answer(carrier, load, **given):
        loads.append(load)
        raise ConvergenceError(f"none of {carrier.name}", None)

    monkeypatch.setattr("ehlcontact.cli.study.oil_and_heat.oil_and_heat", answer)
    asked = load_study(study(tmp_path, MOTOR.replace("speed_rpm", "layer_ratio = 1.0\nspeed_rpm")))
    found = run_oil_and_heat(asked)
    assert list(found) == ["drive end", "fan end"] and ["6306" in found["drive end"], "6206" in found["fan end"]]
    assert [load[2] for load in loads] == pytest.approx([200.0, 200.0], rel=1e-6)
    rows = conditions(SimpleNamespace(study=asked, oil_and_heat=found))["conditions"]
    assert [row[0] for row in rows] == ["drive end", "fan end"]
    both = load_study(study(tmp_path, MACHINE.replace("speed_rpm", "layer_ratio = 1.0\nspeed_rpm")))
    shared = run_oil_and_heat(both)
    assert len(loads) == 3 and shared["left"] is shared["right"]
    assert conditions(SimpleNamespace(study=both, oil_and_heat=shared))["conditions"][0][0] == ""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("layer_ratio = 1.0", "layer_ratio = 0.001", ("operation.layer_ratio = 0.001", "between 0.02")),
        ("layer_ratio = 1.0", "layer_um = 2e-7", ("operation.layer_um = 2e-07", "in m?")),
        ("layer_ratio = 1.0", "layer_ratio = 1.0\nlayer_um = 0.2", ("operation.layer_um", "left out")),
        (GRADE, PLAIN, ("operation.thermal", "by its grade")),
        ("thermal = true", "thermal = 2", ("operation.thermal",)),
    ],
)
def test_mistakes_of_a_study(refused, tmp_path, old, new, words):
    assert old in ASKED
    refused(words, "validate", study(tmp_path, ASKED.replace(old, new)))


def test_init_writes_them(call, refused, tmp_path):
    given = ("--layer-ratio", "0.8", "--thermal", "--load", "500")
    assert call("init", tmp_path / "s.toml", *given).code == 0
    asked = load_study(tmp_path / "s.toml").operation
    assert (asked.layer_ratio, asked.layer_um, asked.thermal) == (0.8, None, True)
    refused(("--layer = -1",), "init", tmp_path / "t.toml", "--layer", "-1")
