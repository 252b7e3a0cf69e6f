"""Solves from the command line: JSON keys, files, failures, and from a simulation to an FMU."""

import json
import shutil
import zipfile

import numpy as np
import pytest

from ehlcontact import read
from ehlcontact.cli.numerals import numeral
from ehlcontact.results import SteadyResult
from ehlcontact.status import Status
from ehlcontact.transient.result import SimulationResult
from ehlcontact.transient.transient_film import TransientFilm

STEADY_KEYS = (
    "approach, force, h_central, h_min, p_max, moment, pressure_error, residual, load_residual, cycles, seconds, "
    "status, n, domain".split(", ")
)
SIMULATE_KEYS = "status, steps, seconds, t, approach, rate, force, h_central, h_min".split(", ")
FIT_KEYS = "model, parameters, rms, e_f, root, tangent, valid, condition".split(", ")


def test_steady_json_on_stdout_is_alone_there(call, point, tmp_path):
    result = call("steady", *point, "--n", "32", "--json", "-", "--save", tmp_path / "r.h5")
    assert result.code == 0 and result.err == ""
    document = json.loads(result.out)
    assert set(STEADY_KEYS) <= set(document)
    assert (
        document["status"] == "converged"
        and 0.0 < document["pressure_error"] <= 1e-5
        and document["n"] == 32
        and document["domain"] == [-4.5, 1.5, 3.0]
    )
    stored = read(tmp_path / "r.h5")
    assert isinstance(stored, SteadyResult) and stored.approach == document["approach"]
    assert stored.pressure_error == document["pressure_error"]


def test_steady_table_and_json_file(call, point, tmp_path):
    result = call("steady", *point, "--n", "32", "--domain", "-4", "1.5", "2.5", "--json", tmp_path / "r.json")
    assert result.code == 0 and "approach" in result.out and "converged" in result.out
    assert json.loads((tmp_path / "r.json").read_text())["domain"] == [-4.0, 1.5, 2.5]


def test_note_on_a_region_that_ends_near_the_contact(call, point):
    """As one chosen for a very thin film does: the moment of pressure is made of the oil ahead, too."""
    near = call("steady", *point, "--n", "32", "--domain", "-2", "1.35", "1.6")
    assert "low for want of the oil before X = -2 (with it: --domain -4.5 1.5 3)" in " ".join(near.out.split())
    assert "without the oil" not in call("steady", *point, "--n", "32").out


def test_impedance(call, point):
    result = call("impedance", *point, "--n", "32", "--Omega", "0", "--Omega", "3", "--json", "-")
    assert result.code == 0
    document = json.loads(result.out)
    assert document["reservation"] == "the grid is too coarse: nodes are 0.19 semi-axes apart, damping needs 0.12"
    assert " ".join(result.err.split()) == f"ehlcontact: warning: {document['reservation']}"
    assert document["omega"] == [0.0, 3.0]
    assert all(bar > 0.0 for bar in document["error_bars"]["damping"])
    assert all(k > 1.0 for k in document["stiffness"]) and all(c > 0.0 for c in document["damping"])
    table = call("impedance", *point, "--n", "64", "--Omega", "3")
    assert table.code == 0 and "Omega = 3" in table.out and table.out.count("±") == 2 and table.err == ""


def test_from_simulation_to_fmu(call, refused, point, tmp_path):
    record, element, target = tmp_path / "r.h5", tmp_path / "element.json", tmp_path / "x.fmu"
    motion = ("--n", "32", "--harmonic", "3", "--amplitude", "0.2", "--dt", "0.1")
    result = call("simulate", *point, *motion, "--save", record, "--json", "-")
    assert result.code == 0, result.err
    document = json.loads(result.out)
    assert set(SIMULATE_KEYS) <= set(document) and len(document["t"]) == document["steps"] + 1
    assert np.ptp(document["force"]) == pytest.approx(0.4, rel=0.02)

    result = call("fit", record, "--model", "cubic", "--save", element, "--json", "-")
    assert result.code == 0, result.err
    document = json.loads(result.out)
    assert set(FIT_KEYS) <= set(document) and set(document["parameters"]) == {"K1", "K2", "K3", "C1"}
    assert read(element).parameters == document["parameters"]

    result = call("fit", record, "--window", "2", "4")
    assert result.code == 0 and "tangent" in result.out
    copy = shutil.copy(record, tmp_path / "copy.h5")
    refused(("file", "copy.h5", "given once", "record of", "r.h5"), "fit", record, copy)

    result = call("export", element, "-o", target, "--json", "-")
    assert result.code == 0, result.err
    document = json.loads(result.out)
    assert document["passes"] and document["findings"] == [] and document["force"] < 1e-12
    assert "modelDescription.xml" in zipfile.ZipFile(target).namelist()


def test_tolerance_too_coarse_for_the_load_warns(call, point):
    run = ["simulate", *point, "--n", "32", "--harmonic", "3", "--amplitude", "0.01", "--until", "0.1"]
    fitting = call(*run)
    assert fitting.code == 0 and fitting.err == "" and numeral(3e-4) in fitting.out
    coarse = call(*run, "--tol", "3e-3", "--json", "-")
    assert coarse.code == 0 and "warning: tol = 0.003 is coarse" in coarse.err
    assert json.loads(coarse.out)["reservation"] in coarse.err


def test_grid_too_coarse_for_the_start_of_a_run_warns(call, point):
    run = ["--n", "32", "--harmonic", "3", "--until", "0.1"]
    fine = call("simulate", *point, *run)
    assert fine.code == 0 and fine.err == "" and "error of the grid" in fine.out
    coarse = call("simulate", "--M", "200", "--L", "10", "--kappa", "0.5", *run, "--json", "-")
    found = json.loads(coarse.out)
    assert coarse.code == 0 and coarse.err == f"ehlcontact: warning: {found['reservation']}\n"
    assert found["reservation"].startswith("the grid is too coarse: at the start the central film may be off by")
    assert found["film_error"]["h_central_relative"] > 0.1


@pytest.mark.long
def test_film_memory_from_a_simulation_alone(call, point, tmp_path):
    """The impedance is solved on the way, at the record's point, grid and domain."""
    record, element, report = tmp_path / "r.h5", tmp_path / "e.json", tmp_path / "fit.json"
    assert call("simulate", *point, "--n", "32", "--free", "5", "--save", record).code == 0
    result = call("fit", record, "--model", "memory", "--save", element, "--json", report)
    assert result.code == 0 and "C(Ω)" in result.out and "root" in result.out, result
    document = json.loads(report.read_text())
    assert set(FIT_KEYS) <= set(document) and document["rms"] < 0.02 and document["condition"] is None
    loaded = read(element)
    assert loaded.parameters == document["parameters"] and loaded.source["n"] == 32
    assert loaded.approach_at(1.0) == document["root"]


@pytest.mark.parametrize("command", ["steady", "simulate"])
def test_not_converged_is_saved_and_reported(call, point, tmp_path, monkeypatch, command):
    monkeypatch.setattr("ehlcontact.solver.iterate.touches_border", lambda level: True)
    motion = ["--free", "5"] if command == "simulate" else []
    result = call(command, *point, "--n", "16", *motion, "--save", tmp_path / "p.h5", "--json", "-")
    assert result.code == 1
    assert len(result.err.splitlines()) == 1 and "out_of_domain" in result.err and "wider domain" in result.err
    assert json.loads(result.out)["status"] == "out_of_domain"
    assert read(tmp_path / "p.h5").status is Status.OUT_OF_DOMAIN


def interrupt_after(steps, patch):
    """Ctrl-C in the step after so many."""
    advance, calls = TransientFilm.advance, []

    def stopped(self, *arguments):
        calls.append(1)
        if len(calls) > steps:
            raise KeyboardInterrupt
        return advance(self, *arguments)

    patch.setattr(TransientFilm, "advance", stopped)


def test_interrupted_simulation_is_saved(call, point, tmp_path, monkeypatch):
    interrupt_after(5, monkeypatch)
    result = call("simulate", *point, "--n", "16", "--free", "5", "--save", tmp_path / "p.h5")
    assert result.code == 130 and "interrupted" in result.err and len(result.err.splitlines()) == 1
    stored = read(tmp_path / "p.h5")
    assert isinstance(stored, SimulationResult) and stored.steps == 5 and stored.status is Status.INTERRUPTED


def test_interrupted_simulation_goes_on_from_its_checkpoint(call, refused, point, tmp_path, monkeypatch):
    run = [
        "simulate",
        *point,
        "--n",
        "16",
        "--harmonic",
        "3",
        "--until",
        "1",
        "--local-error",
        "1e-3",
        "--json",
        "-",
    ]
    whole = json.loads(call(*run).out)
    checkpoint = tmp_path / "c.h5"
    with monkeypatch.context() as patch:
        interrupt_after(8, patch)
        result = call(*run, "--checkpoint", checkpoint)
    assert result.code == 130 and len(result.err.splitlines()) == 1
    assert "interrupted" in result.err and f"go on with --restart {checkpoint}" in result.err
    assert 0 < json.loads(result.out)["steps"] < whole["steps"]
    again = call(*run, "--restart", checkpoint)
    assert again.code == 0 and again.err == ""
    assert json.loads(again.out) | {"seconds": 0} == whole | {"seconds": 0}
    refused(
        ("restart", "motion.Omega", "3.0", "2.0"), *(o if o != "3" else "2" for o in run), "--restart", checkpoint
    )


def test_a_finished_run_goes_on_to_a_later_end(call, point, tmp_path):
    """The steps that its own defaults would give for that end are others."""
    run = ["simulate", *point, "--n", "32", "--free", "5", "--json", "-", "--checkpoint", tmp_path / "c.h5"]
    first = json.loads(call(*run, "--until", "0.2").out)
    result = call(*run, "--until", "0.33", "--restart", tmp_path / "c.h5")
    assert result.code == 0 and result.err == ""
    longer = json.loads(result.out)
    assert longer["t"][: len(first["t"])] == first["t"] and 0.33 <= longer["t"][-1] < 0.33 + first["t"][1]
    assert np.ptp(np.diff(longer["t"])) < 1e-12


def test_step_that_cannot_meet_its_error(call, point, tmp_path, monkeypatch):
    monkeypatch.setattr("ehlcontact.transient.run.local_error", lambda before, entry, motion: 1.0)
    result = call(
        "simulate", *point, "--n", "16", "--free", "5", "--local-error", "1e-3", "--save", tmp_path / "p.h5"
    )
    assert result.code == 1 and len(result.err.splitlines()) == 1
    for words in ("step_too_small at T = ", "a step of ", "tolerated error 0.001", "partial result in"):
        assert words in result.err
    stored = read(tmp_path / "p.h5")
    assert stored.status is Status.STEP_TOO_SMALL and stored.steps == 2
