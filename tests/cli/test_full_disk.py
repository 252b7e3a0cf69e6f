"""A disk that is full: one line, exit 2, nothing lost; on a real one of 16 kB where the tests run as root."""

import json
import zipfile
from pathlib import Path

import pytest
from programs import program
from tiny_study import STUDY

from ehlcontact import InputError, read
from ehlcontact.transient import checkpoint
from ehlcontact.transient.checkpoint import Checkpoint

WIDE = ("element", "--M", "2900", "--L", "19", "--kappa", "0.11")


@pytest.mark.parametrize("option", ["--save", "--checkpoint", "--figure"])
def test_results_on_a_disk_of_16_kb(call, full_disk, point, option):
    motion = ["--free", "5", "--until", "0.2", "--dt", "0.1"] if option == "--checkpoint" else []
    name = "f.png" if option == "--figure" else "r.h5"
    command = "simulate" if motion else "steady"
    found = call(command, *point, "--n", "64", *motion, option, full_disk / name)
    assert found.code == 2
    (line,) = found.err.splitlines()
    assert line.startswith(f"ehlcontact: {option} = ")
    assert "No space left on device" in line
    assert ("converged" in found.out) == (option != "--checkpoint")  # the table is there all the same
    assert not (full_disk / name).exists()


@pytest.mark.long
def test_a_study_on_a_disk_of_16_kb(full_disk, tmp_path):
    """The stages run in other processes, and none is left behind."""
    study = tmp_path / "tiny.toml"
    study.write_text(STUDY)
    found = program("run", study, "-o", full_disk / "out", "--jobs", "1")
    assert found.returncode == 2 and found.stdout == ""
    (line,) = [line for line in found.stderr.splitlines() if line.startswith("ehlcontact: ")]  # beside progress
    assert "Traceback" not in found.stderr
    assert line.startswith("ehlcontact: ") and "No space left on device" in line and "resumes" in line


def test_what_else_is_written_does_not_cost_the_rest(call, no_room, tmp_path):
    """A file that cannot be written does not keep the JSON and the table back."""
    path = tmp_path / "e.json"
    path.write_text("old")
    no_room()
    result = call(*WIDE, "--save", path, "--json", "-")
    assert result.code == 2 and json.loads(result.out)["kind"] == "wide"
    assert result.err.startswith(f"ehlcontact: --save = '{path}'") and len(result.err.splitlines()) == 1
    result = call(*WIDE, "--json", tmp_path / "e2.json")
    assert result.code == 2 and "static tangent" in result.out and "--json" in result.err
    assert path.read_text() == "old" and [p.name for p in tmp_path.iterdir()] == ["e.json"]


def test_fmu_atlas_and_report(call, refused, no_room, tmp_path):
    assert call(*WIDE[:1], "--model", "cubic", "--Omega", "1", *WIDE[1:], "--save", tmp_path / "e.json").code == 0
    assert call("export", tmp_path / "e.json", "-o", tmp_path / "x.fmu").code == 0
    before = (tmp_path / "x.fmu").read_bytes()
    no_room()
    refused(("x.fmu", "No space left"), "export", tmp_path / "e.json", "-o", tmp_path / "x.fmu", "--force")
    refused(("y.fmu", "No space left"), "export", tmp_path / "e.json", "-o", tmp_path / "y.fmu")
    assert (tmp_path / "x.fmu").read_bytes() == before and zipfile.is_zipfile(tmp_path / "x.fmu")


def test_a_full_disk_at_a_checkpoint_keeps_the_run(call, point, tmp_path, monkeypatch):
    """The disk fills up during the run: it goes on, and what it found is saved elsewhere."""
    write, saved, path = checkpoint.save, tmp_path / "r.h5", tmp_path / "c.h5"

    def once(record, target, *given):
        if Path(target) == path and path.exists():
            raise InputError("checkpoint", str(path), "a file that can be written (No space left on device)")
        return write(record, target, *given)

    monkeypatch.setattr(checkpoint, "save", once)
    options = ("--n", "16", "--free", "5", "--until", "0.3", "--dt", "0.1", "--save", saved)
    result = call("simulate", *point, *options, "--checkpoint", path)
    assert result.code == 2 and "converged" in result.out
    assert result.err.startswith("ehlcontact: --checkpoint = ") and len(result.err.splitlines()) == 1
    assert read(saved).steps == 3 and read(path, Checkpoint).record.T == 0.0
