"""Two hundred bad inputs and more: each is one line that names the input and what it may be, and nothing is lost.

The tables beside this file hold command lines, study files and Python calls; damaged files of every kind are in
``tests/cli/test_bad_files.py`` and counted here.
"""

import os
import shlex
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from bad_input.calls import CALLS, full_contact
from bad_input.commands import COMMANDS, ELEMENT, FILM, OTHER, RECORD, STUDY, at, bearing, steady
from bad_input.studies import SMALL, STUDIES
from cli.test_bad_files import CASES

from ehlcontact import HarmonicLoad, InputError, Lubricant, MoesPoint, save, simulate, solve_steady
from ehlcontact.cli import main
from reduced_models import BallBearing, CubicContact

ROOT = Path(__file__).parents[2]
SECONDS = 2.0  # of the processor
KINDS = {"study": "TOML", "element": "element JSON", "work": "atlas", "result": "HDF5", "checkpoint": "HDF5"}
SAMPLE = [
    ("init", STUDY),
    steady(M="1e9"),
    steady(alpha="20"),
    steady("--save", RECORD, "--json", RECORD),
    at("simulate", "--free", "314000"),
    at("impedance", "--omega", "x"),
    ("fit", RECORD, RECORD),
    at("element", eta0="3"),
    ("export", RECORD, "-o", "new.fmu"),
    ("verify", ELEMENT),
    ("validate", STUDY, "--json", STUDY),
    ("explore", "-o", "k.json"),
    ("run", STUDY, "--jobs", "0"),
    ("reproduce", "--table", "7"),
    ("atlas", "build", "-o", "new.npz", "--scheduler", "nowhere"),
    bearing("6205", load="0"),
]


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """A folder with sound files of every kind that commands read, and with some that they could replace."""
    folder = tmp_path_factory.mktemp("good")
    for name, M in ((RECORD, 20.0), (OTHER, 30.0)):
        save(
            simulate(MoesPoint(M, 5, 0.5), HarmonicLoad(Omega=3.0), n=16, until=0.5, dT=0.05, throw=False),
            folder / name,
        )
    save(solve_steady(MoesPoint(20, 5, 0.5), n=16, throw=False), folder / FILM)
    CubicContact(K1=1.0, K2=0.1, K3=0.1, C1=0.01, low=0.7, high=1.0).save(folder / ELEMENT)
    (folder / STUDY).write_text(SMALL)
    for name in ("x.fmu", "new.npz", "k.json", "slip.toml"):
        (folder / name).write_text("kept")
    return folder


@pytest.fixture(scope="module")
def compiled():
    """Kernels of bearings: what is told soon is not told while they are compiled."""
    oil = Lubricant.iso_vg(68, temperature=50.0)
    BallBearing.catalogue("6205", oil=oil).equilibrium((0.0, -500.0), speed_rpm=1000.0)


@pytest.fixture
def refused(good, compiled, capsys, monkeypatch):
    """``refused(arguments, words)``: exit 2, one line that holds the words, soon, and not a byte is changed."""
    monkeypatch.chdir(good)

    def run(arguments, words):
        before, started = contents(good), time.process_time()
        with pytest.raises(SystemExit) as stop:
            main(list(arguments))
        spent, said = time.process_time() - started, capsys.readouterr()
        assert stop.value.code == 2 and said.out == "", said
        (line,) = said.err.splitlines()
        assert line.startswith("ehlcontact: ") and [word for word in words if word not in line] == [], line
        assert spent < SECONDS and contents(good) == before

    return run


def contents(folder):
    """What is in the files of a folder."""
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_there_are_two_hundred():
    count = Counter({"command line": len(COMMANDS), "TOML": len(STUDIES), "Python": len(CALLS)})
    assert count.total() >= 200
    assert len({arguments for arguments, _ in COMMANDS}) == len(COMMANDS)
    assert len({slip[:2] for slip in STUDIES}) == len(STUDIES)
    count += Counter(KINDS.get(kind, kind) for kind, _ in CASES)
    for kind in ("command line", "TOML", "element JSON", "HDF5", "atlas", "Python"):
        assert count[kind] >= 20, kind


def test_every_subcommand_is_among_them():
    from ehlcontact.cli.app import app

    known = {command.name or command.callback.__name__ for command in app.registered_commands} | {"atlas"}
    assert known <= {arguments[0] for arguments, _ in COMMANDS}
    assert known <= {arguments[0] for arguments in SAMPLE}


@pytest.mark.parametrize(("arguments", "words"), COMMANDS, ids=lambda part: shlex.join(part)[:60])
def test_command_lines(refused, monkeypatch, arguments, words):
    monkeypatch.setattr(subprocess, "Popen", None)  # no worker is started
    refused(arguments, words)


@pytest.mark.parametrize("k", range(len(STUDIES)), ids=lambda k: STUDIES[k][1][:40])
def test_studies(refused, good, k):
    old, new, words = STUDIES[k]
    assert old in SMALL
    (good / "slip.toml").write_text(SMALL.replace(old, new, 1))
    refused(("run", "slip.toml", "-o", "results"), ("slip.toml", *words))
    refused(("validate", "slip.toml"), ("slip.toml", *words))


@pytest.mark.parametrize("name", CALLS)
def test_calls(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, words = CALLS[name]
    full_contact()
    started = time.process_time()
    with pytest.raises(InputError) as caught:
        call()
    assert time.process_time() - started < SECONDS
    line = str(caught.value)
    assert "\n" not in line and [word for word in words if word not in line] == [], line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("arguments", SAMPLE, ids=lambda part: shlex.join(part)[:60])
def test_as_a_user_runs_them(good, arguments):
    """In a process of its own: its imports, too, are a part of the two seconds."""
    before, used = contents(good), os.times().children_user + os.times().children_system
    command = [sys.executable, "-m", "ehlcontact.cli", *arguments]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=good, env=environment)
    spent = os.times().children_user + os.times().children_system - used
    assert (done.returncode, done.stdout) == (2, "") and len(done.stderr.splitlines()) == 1, done
    assert "must be" in done.stderr and contents(good) == before
    assert spent < SECONDS
