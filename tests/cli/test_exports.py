"""[export] of a study: scripts that make the same machine, its FMU, and entries that contradict each other."""

import json
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import fake_ross
import numpy as np
import pytest
from tiny_study import ALONE, ANGULAR, MOTOR, PAIR

from ehlcontact.cli.study.answer import answer_of
from ehlcontact.cli.study.exports import write_exports
from ehlcontact.cli.study.machine import rotor_of
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.scripts import python_text, ross_text, variables_of
from reduced_models import linearise

EXAMPLES = Path(__file__).parents[2] / "examples"
BESIDE_A_BEARING = ANGULAR.replace("axial_load", "tilt_x_mrad = 0.1\naxial_load")


@pytest.fixture
def study(tmp_path):
    """``study(text)``: the study of a text, or of an example by its name."""

    def load(text):
        path = EXAMPLES / f"{text}.toml"
        if "\n" in text:
            path = tmp_path / "s.toml"
            path.write_text(text)
        return load_study(path)

    return load


def made_by(text):
    """What a script leaves in its names."""
    names = {"__name__": "machine"}
    exec(compile(text, "machine.py", "exec"), names)
    return names


@pytest.mark.parametrize("name", [pytest.param("motor", marks=pytest.mark.long), "spindle", "small_study"])
def test_the_script_makes_the_rotor_of_the_study(study, name):
    one = study(name)
    text = python_text(one)
    own, same = (linearise(rotor, one.speed_rpm).modes(3) for rotor in (made_by(text)["rotor"], rotor_of(one)))
    assert [mode.hz for mode in own] == pytest.approx([mode.hz for mode in same], rel=1e-9, abs=0.0)
    assert max(map(len, text.splitlines())) < 120


def test_the_script_of_a_motor_is_ten_calls(study):
    """Without entries that are the library's own; names of supports are those of the bearings."""
    text = python_text(study("motor"))
    assert 'drive_end = BallBearing.catalogue("6306", oil=oil, rq_ball=0.0, rq_race=1e-07, clearance="CN")' in text
    assert "Support(position=0.33, bearing=fan_end, preload=200.0)" in text and "youngs" not in text
    assert len(re.findall(r"\b[A-Za-z_.]+\((?=\w)", text.partition("if __name__")[0])) < 11


@pytest.mark.parametrize("text", [ALONE, PAIR, BESIDE_A_BEARING], ids=["planar", "pair", "tilted"])
def test_the_script_of_a_bearing_alone(study, text):
    one = study(text)
    state = made_by(python_text(one))["state"]
    own = answer_of(one).supports[0].state
    np.testing.assert_allclose(state.displacement, own.displacement, rtol=1e-9, atol=1e-18)


def test_names_of_supports_as_variables():
    names = ["Drive end", "fan-end", "6205", "oil", "lambda", "drive end", "Ä"]
    assert variables_of(names) == [
        "drive_end", "fan_end", "bearing_3", "bearing_4", "bearing_5", "bearing_6", "bearing_7",
    ]  # fmt: skip


def _rows(kind):
    return lambda *args, **keywords: SimpleNamespace(kind=kind, args=args, **keywords)


def test_the_machine_in_ross(study, monkeypatch):
    """Nodes, lengths and masses are those of the library's rotor; a ring that slides holds nothing along z."""
    housing = "housing_stiffness = 1e8\nhousing_mass = 2.0\njournal_mass = 0.2\n"
    text = MOTOR.replace('bearing = "6306"\n', f'bearing = "6306"\n{housing}')
    one = study(text)
    stub = SimpleNamespace(
        BearingElement=fake_ross.BearingElement,
        **{name: _rows(name) for name in ("Material", "ShaftElement", "DiskElement", "PointMass", "Rotor")},
    )
    monkeypatch.setitem(sys.modules, "ross", stub)
    made = made_by(re.sub(r"np.linspace\(0.2, 2.0, 10\)", "np.array([0.5, 1.0])", ross_text(one)))
    shaft, discs, elements = made["rotor"].args
    assert sum(element.L for element in shaft) == pytest.approx(0.36, rel=1e-9)
    assert [(disc.n, disc.m) for disc in discs] == [(5, pytest.approx(7.99457, rel=1e-5))]
    ground, left, right = elements
    assert (left.n, left.n_link, ground.n) == (1, 11, 11) and right.n == 9 and right.n_link is None
    assert right.k[4] == right.c[4] == 0.0 and np.all(left.k[4] > 1e7)
    assert {(mass.n, mass.m) for mass in made["masses"]} == {(1, 0.2), (11, 2.0)}
    rows = linearise(rotor_of(one), 15000.0)
    K = rows.balls[1].coefficients(np.array([15000.0 * np.pi / 30.0]))[0][0]
    assert right.K(15000.0 * np.pi / 30.0)[1, 1] == pytest.approx(K[1, 1], rel=2e-3)


@pytest.mark.parametrize(
    ("text", "entries", "words"),
    [
        (MOTOR, "python = true\noutside = ['fan end']", ("export.outside = ['fan end']", "without export.fmu")),
        (MOTOR, "fmu = true\noutside = ['left']", ("export.outside = 'left'", "drive end, fan end")),
        (MOTOR, "fmu = true\ntop_rpm = 9000", ("export.top_rpm = 9000", "at least the speed of the study, 15000")),
        (MOTOR, "fmu = true\nplatforms = ['linux']", ("export.platforms = 'linux'", "x86_64-linux")),
        (MOTOR, "fmu = true\nfmi = 4", ("export.fmi = 4", "2 or 3")),
        (MOTOR, "", ("export.fmu = False", "or export.python, export.ross or export.matrices")),
        (MOTOR, "fmi = 3", ("export.fmu = False", "or export.python, export.ross or export.matrices")),
        (MOTOR, "matrices = ['nastran']", ("export.matrices", "nastran-dmig")),
        (MOTOR, "matrices = ['csv']\nmatrix_units = 'mm'", ("export.matrix_units = 'mm'", "left out")),
        (ALONE, "fmu = true\ninertia = 1.0", ("export.inertia = 1.0", "without [shaft]")),
        (ALONE, "ross = true", ("export.ross = True", "without [shaft]")),
        (PAIR, "fmu = true", ("support.pair = 'back-to-back'", "one bearing")),
        (BESIDE_A_BEARING, "fmu = true", ("operation.tilt_x_mrad = 0.1", "inputs of the FMU")),
    ],
)  # fmt: skip
def test_entries_that_contradict(refused, tmp_path, text, entries, words):
    path = tmp_path / "s.toml"
    path.write_text(f"{text}\n[export]\n{entries}\n")
    for command in ("validate", "run"):
        refused(words, command, path, "-o", tmp_path / "out")


def test_without_matrices_their_units_may_stay(study):
    assert study(f"{MOTOR}\n[export]\npython = true\nmatrices = []\nmatrix_units = 'mm'\n").export.matrices == ()


def test_matrices_of_every_support(study, tmp_path):
    """About each bearing in the axes of the shaft, under the load that it has in the machine."""
    entries = '[export]\nmatrices = ["json", "abaqus"]\nmatrix_units = "mm"\nshaft_along = "x"\n'
    one = study(f"{MOTOR}\n{entries}")
    made = write_exports(one, tmp_path)["matrices"]
    assert [(row["support"], row["program"]) for row in made] == [
        (name, program) for name in ("drive end", "fan end") for program in ("json", "abaqus")
    ]
    rows = linearise(rotor_of(one), one.speed_rpm)
    for k, name in enumerate(("drive_end", "fan_end")):
        read = json.loads((tmp_path / f"{name}_matrices.json").read_text())
        own = rows.balls[k].coefficients(np.array([15000.0 * np.pi / 30.0]))[0][0]
        K = np.array(read["stiffness"])[0, 0]
        assert np.diag(K)[:3] == pytest.approx(np.diag(own)[:3], rel=1e-3)
        lines = (tmp_path / f"{name}_abaqus.inp").read_text().splitlines()
        first = next(line for line in lines if line.startswith(f"{k + 1}, 1, {k + 1}, 1,"))
        assert float(first.split(",")[4]) == pytest.approx(1e-3 * K[2, 2], rel=1e-9)


def test_a_shaft_without_mass_has_no_model_in_ross(refused, tmp_path):
    path = tmp_path / "s.toml"
    path.write_text((EXAMPLES / "small_study.toml").read_text() + "\n[export]\nross = true\n")
    refused(("export.ross = True", "shaft.stiffness"), "validate", path, "-o", tmp_path / "out")


@pytest.mark.long
def test_a_run_leaves_them(call, tmp_path):
    """FMU and script of a bearing alone: in results and report, made once, again where one is gone."""
    path, out = tmp_path / "s.toml", tmp_path / "out"
    path.write_text(f"{ALONE}\n[export]\nfmu = true\npython = true\nfmi = 3\ntop_rpm = 4000\n")
    assert call("run", path, "-o", out).code == 0
    found = json.loads((out / "results.json").read_text())["export"]
    assert found["fmu"]["passes"] and found["fmu"]["fmi"] == 3 and found["fmu"]["speeds_rpm"] == [3000.0, 4000.0]
    assert (out / found["fmu"]["file"]).is_file() and found["python"] == {"file": "machine.py"}
    report = (out / "report.html").read_text()
    assert 'href="machine.py"' in report and "FMI 3.0" in report and 'id="export"' in report
    files = json.loads((out / "summary.json").read_text())["points"][0]["files"]
    assert {"machine.fmu", "machine.py"} <= set(files.values())
    (out / "machine.py").unlink()
    assert call("run", path, "-o", out).code == 0 and (out / "machine.py").is_file()


@pytest.mark.long
def test_the_fmu_of_a_machine(call, tmp_path):
    """One bearing inside, the other one outside by the name of its support."""
    path, out = tmp_path / "s.toml", tmp_path / "out"
    path.write_text(f"{MOTOR}\n[export]\nfmu = true\noutside = ['fan end']\n")
    assert call("run", path, "-o", out, "--json", "-").code == 0
    found = json.loads((out / "results.json").read_text())["export"]["fmu"]
    assert found["passes"] and found["supports_inside"] == ["drive end"] and found["inner_step"] == 1e-5
    assert found["supports_outside"] == ["fan end"] and 0.0 < found["motion"] < 1e-6
