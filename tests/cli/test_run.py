"""``ehlcontact run`` from study to report on the coarsest settings, resume, Ctrl-C and failure."""

import html
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from programs import begin, shell_script
from tiny_study import STUDY

from ehlcontact import assumptions, read
from ehlcontact.cli.study import reduction, runner
from ehlcontact.cli.study.points.folder import Log
from ehlcontact.cli.study.points.kept import Kept, stage_key
from ehlcontact.cli.study.points.lists import load_points
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.stages import STAGES, stage_named
from ehlcontact.status import Status
from fmu import verify_references
from reduced_models.rotor.result import RotorResult

FREE, HARMONIC = (f"[contact.{name}]\nsteps_per_period = " for name in ("free", "harmonic"))


def run_stages(folder, jobs=1):
    """The stages of the study in a folder, and how they ended; nothing is made of them."""
    points = load_points(folder / "study.toml", folder)
    done = runner.run_points(points, folder, runner.Share(jobs), Log(None), final=False)
    return done.ended[points[0].name]


def test_everything_is_there(finished, results):
    _, folder = finished
    for name, file, kind in (("fmu", "contact.fmu", "cubic"), ("film_fmu", "contact_film.fmu", "memory")):
        entry = results[name]
        assert entry["passes"] and entry["findings"] == [] and (entry["file"], entry["kind"]) == (file, kind)
        assert verify_references(folder / file).passes and "largest step, with the right lead" in entry["steps"]
    assert results["fmu"]["element_states"] == 0 < results["film_fmu"]["element_states"]
    assert results["rotor"]["whole"]["rotor_band"]["force"] < 0.03
    assert results["rotor"]["whole"]["rotor_band"]["displacement"] < 0.03
    assert results["steady"]["status"] == "converged" and results["versions"]["ehlcontact"]
    for name in ("steady", "free", "harmonic", "rotor_band"):
        assert read(folder / f"{name}.h5").status.ok
    assert results["rotor"]["whole"]["memory"]["force"] < 0.03
    assert max(results["memory"]["record_rms"]) < 0.05 and len(results["memory"]["impedance"]["omega"]) > 20
    si, memory = (read(folder / "elements" / f"{name}.json") for name in ("rotor_band_cubic", "memory"))
    row = next(row for row in results["fits"] if (row["record"], row["model"]) == ("rotor_band", "cubic"))
    assert memory.units == "SI" and memory.parameters == results["memory"]["parameters"]
    assert si.units == "SI" and si.parameters == row["parameters"] and si.fit["root"] == row["root"]


def test_assumptions_in_every_output(finished, results):
    """In the results from the stored film and rotor run, in the element files, and in the page."""
    study_file, folder = finished
    study, film = load_study(study_file), read(folder / "steady.h5")
    runs = [read(folder / f"{name}.h5", RotorResult) for name in ("rotor_full", "decay")]
    found = results["assumptions"]
    rows = {row["name"]: row for row in found["table"]}
    shaken = max(np.hypot(*run.journal_velocity.T).max() for run in runs)
    assert rows["constant speed"]["value"] == pytest.approx(2.0 * shaken / study.point.u_sum)
    ratio = film.h_min / np.hypot(0.02e-6, 0.15e-6)
    assert rows["smooth"]["value"] == pytest.approx(ratio) and ratio < 3.0
    assert found["out_of_range"] == ["smooth"] and "smooth" in found["headline"] and found["not_judged"] == []
    expected = assumptions(study.point, film=film, roughness=study.roughness).short()
    for name in ("rotor_band_cubic", "memory"):
        assert read(folder / "elements" / f"{name}.json").source["assumptions"] == expected
    said = reduction.contact_text(study)
    assert study.carrier.label in said and study.oil.label in said and "3000 rpm" in said
    assert read(folder / "elements" / "memory.json").source["contact"] == said
    for name in ("contact", "contact_film"):
        with zipfile.ZipFile(folder / f"{name}.fmu") as archive:
            description = ElementTree.fromstring(archive.read("modelDescription.xml")).attrib["description"]
        assert description.endswith(f"; SI units; {said}")
    page = re.sub(r"\s*(?:<[^>]*>\s*)+", " ", html.unescape((folder / "report.html").read_text()))  # its words
    answer = results["answer"]
    assert "does not hold: smooth" in answer and results["verdict"] in page
    assert all(row["verdict"] in page for row in found["table"])


def test_second_run_keeps_what_is_finished(finished, call):
    study, folder = finished
    again = {"run.log", "summary.json", "summary.csv", "study.toml"}  # written every time

    def files():
        found = (path for path in folder.rglob("*") if path.is_file() and path.name not in again)
        return {path: path.stat().st_mtime_ns for path in found}

    before = files()
    result = call("run", study, "-o", folder, "--json", "-")
    assert result.code == 0 and result.err == ""
    assert json.loads(result.out)["status"] == "converged"
    assert files() == before and len(before) > 20
    assert json.loads((folder / "summary.json").read_text())["run"]["solved"] == []


@pytest.mark.parametrize("damage", ["cut", pytest.param("byte", marks=pytest.mark.long)])
def test_what_is_kept_and_damaged_is_made_again(finished, tmp_path, capsys, monkeypatch, damage):
    """One line says so; the rest is kept, and the file of the stage is the same."""
    folder = shutil.copytree(finished[1], tmp_path / "out")
    monkeypatch.setattr(runner, "STAGES", tuple(stage for stage in STAGES if stage.name in ("steady", "free")))
    film = read(folder / "steady.h5").approach
    file = folder / "store" / stage_key(stage_named("steady"), load_study(finished[0]))
    before = file.read_bytes()
    if damage == "cut":
        file.write_bytes(before[: len(before) // 2])
    else:
        file.write_bytes(before[:-100] + bytes([before[-100] ^ 1]) + before[-99:])
    kept = (folder / "free.h5").stat().st_mtime_ns
    ended = run_stages(folder)
    told = capsys.readouterr().err.splitlines()
    assert told[0] == "ehlcontact: steady film: what was kept is damaged: it is made again" and len(told) == 2
    assert ended["steady"]["status"] == "converged" and (folder / "free.h5").stat().st_mtime_ns == kept
    assert read(folder / "steady.h5").approach == film
    assert run_stages(folder) == ended


def test_a_damaged_file_of_a_stage_is_written_again(finished, tmp_path, capsys, monkeypatch):
    """From the store, bit for bit: nothing is solved."""
    folder = shutil.copytree(finished[1], tmp_path / "out")
    monkeypatch.setattr(runner, "STAGES", (stage_named("steady"),))
    before = (folder / "steady.h5").read_bytes()
    shutil.copy(folder / "free.h5", folder / "steady.h5")
    run_stages(folder)
    assert capsys.readouterr().err == "" and (folder / "steady.h5").read_bytes() == before


def test_no_worker_outlives_a_run_that_is_killed(tmp_path):
    """Killed so that it can tell nobody, with a worker at a long computation."""
    study = tmp_path / "long.toml"
    study.write_text(STUDY.replace("revolutions = 2", "revolutions = 100"))
    process = begin("run", study, "-o", tmp_path / "out", "--jobs", "1", stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 50.0
    while not (workers := children(process.pid)):
        assert time.monotonic() < deadline and process.poll() is None
        time.sleep(0.05)
    time.sleep(1.0)
    process.kill()
    process.wait()
    while any(is_running(worker) for worker in workers):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_only_what_changed_is_computed_again(finished, tmp_path):
    _, folder = finished
    changed = tmp_path / "changed.toml"
    changed.write_text(STUDY.replace("unbalance = 8e-6", "unbalance = 9e-6"))
    study, store = load_study(changed), Kept(folder)
    kept = [stage.name for stage in STAGES if store.get(stage_key(stage, study)) is not None]
    assert kept == ["steady", "free", "harmonic", "rotor_band"]


@pytest.mark.long
def test_ctrl_c_and_resume(finished, tmp_path):
    """The harmonic load of the contact is done again beside a long free vibration: when it is, that has begun."""
    study, folder = tmp_path / "long.toml", shutil.copytree(finished[1], tmp_path / "out")
    longer = STUDY.replace(f"{FREE}20", f"{FREE}200\nperiods = 100")
    study.write_text(longer.replace(f"{HARMONIC}20", f"{HARMONIC}60"))
    process = begin("run", study, "-o", folder, "--force", stdout=subprocess.PIPE)
    kept = folder / "store" / stage_key(stage_named("harmonic"), load_study(study))
    deadline = time.monotonic() + 50.0
    while time.monotonic() < deadline and not kept.exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.2)
    time.sleep(2.0)  # on a busy machine it has begun, and has no steps yet
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert process.returncode == 130 and out == "" and "Traceback" not in err
    assert "resumes" in err.splitlines()[-1]
    assert "free vibration: interrupted" in (folder / "run.log").read_text()
    assert read(folder / "free.partial.h5").steps > 10


def children(pid):
    """Processes that a process has started and that still run."""
    found = subprocess.run(
        ["ps", "-o", "pid=,stat=", "--ppid", str(pid)], capture_output=True, text=True, check=False
    )
    rows = (line.split() for line in found.stdout.splitlines())
    return [int(child) for child, state in rows if not state.startswith("Z")]


def is_running(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.long
def test_a_terminated_run_leaves_no_workers(tmp_path):
    """`kill`, or `timeout`: as after Ctrl-C, although the workers have sessions of their own."""
    study = tmp_path / "long.toml"
    study.write_text(STUDY.replace(f"{FREE}20", f"{FREE}2000\nperiods = 100"))
    process = begin("run", study, "-o", tmp_path / "out", stdout=subprocess.PIPE)
    deadline = time.monotonic() + 50.0
    while len(workers := children(process.pid)) < 2 and time.monotonic() < deadline:
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.05)
    process.terminate()
    _, err = process.communicate(timeout=40)
    assert process.returncode == 130 and "resumes" in err.splitlines()[-1] and "Traceback" not in err
    deadline = time.monotonic() + 5.0  # they end by themselves, a moment after it
    while any(is_running(worker) for worker in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert workers and not any(is_running(worker) for worker in workers)


@pytest.mark.long
def test_a_second_ctrl_c_waits_for_no_worker(monkeypatch, tmp_path):
    """One that does not listen is killed then, and after an error of ours all are."""
    file = tmp_path / "study.toml"
    file.write_text(STUDY)
    monkeypatch.setattr(runner, "STAGES", (stage_named("steady"), stage_named("free")))
    deaf = shell_script(tmp_path / "python", f"trap '' INT\necho $$ >> {tmp_path}/pids\nexec sleep 100")
    monkeypatch.setattr(sys, "executable", deaf)

    def press_twice():
        while not (tmp_path / "pids").exists() or len((tmp_path / "pids").read_text().split()) < 2:
            time.sleep(0.05)
        for _ in range(2):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.5)

    # a shell's background job passes on that it ignores Ctrl-C
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    started = time.monotonic()
    fingers = threading.Thread(target=press_twice)
    fingers.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            run_stages(tmp_path, 2)
        fingers.join()
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - started < runner.PATIENCE / 2.0
    assert not any(is_running(int(pid)) for pid in (tmp_path / "pids").read_text().split())
    assert not any((tmp_path / "store").iterdir())

    def broken(*_, **__):
        raise ValueError("ours")

    monkeypatch.setattr(runner, "wait", broken)
    monkeypatch.setattr(runner, "PATIENCE", 0.5)  # nobody presses again: they are killed when it ends
    (tmp_path / "pids").unlink()
    with pytest.raises(ValueError, match="ours"):
        run_stages(tmp_path, 2)
    time.sleep(0.2)
    pids = (tmp_path / "pids").read_text().split() if (tmp_path / "pids").exists() else []
    assert not any(is_running(int(pid)) for pid in pids)


@pytest.mark.long
def test_a_stage_that_fails(call, tmp_path, monkeypatch):
    """A region that the pressure outgrows: the others are kept, exit 1, the reason on one line per stage."""
    few = tuple(stage_named(name) for name in ("decay", "steady", "free"))
    monkeypatch.setattr(runner, "STAGES", few)  # the others end like these
    study = tmp_path / "narrow.toml"
    narrow = STUDY.replace("n = 32\n", "n = 32\ndomain = [-4.5, 1.2, 1.2]\n")
    study.write_text(narrow.replace("29.209", "3989.209"))
    result = call("run", study, "-o", tmp_path / "out")
    assert result.code == 1 and "Traceback" not in result.err
    (point,) = json.loads((tmp_path / "out" / "summary.json").read_text())["points"]
    failed = [name for name, status in point["stages"].items() if status != "converged"]
    assert set(point["stages"].values()) <= set(Status)
    assert failed and all(
        any(f"ehlcontact: {name}: " in line for line in result.err.splitlines()) for name in failed
    )


def test_a_stage_whose_process_dies(monkeypatch, tmp_path):
    """What it said last is its message."""
    file = tmp_path / "study.toml"
    file.write_text(STUDY)
    monkeypatch.setattr(runner, "STAGES", (stage_named("steady"),))
    dying = shell_script(tmp_path / "python", "echo first >&2; echo out of memory >&2; exit 3")
    monkeypatch.setattr(sys, "executable", dying)
    note = run_stages(tmp_path)["steady"]
    assert note["status"] == Status.FAILED and note["seconds"] == 0.0
    assert note["message"] == "its process died: out of memory"
