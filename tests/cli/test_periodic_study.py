"""A study with [periodic]: the branch as a task, its words, table and picture, and what is none."""

import csv
import io
import json
from dataclasses import replace

import numpy as np
import pytest
from tiny_study import ALONE

from ehlcontact.cli.study import periodic as of_study
from ehlcontact.cli.study.forecast import forecast
from ehlcontact.cli.study.periodic import StudyBranch, branch_of, branches_of, solve_branch
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.scripts import python_text
from ehlcontact.errors import InputError
from ehlcontact.status import Status
from ehlcontact.store import read, save
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.branch_result import PeriodicBranch
from reduced_models.rotor.result import RotorResult

FAN = """[operation]
speed_rpm = 8000.0
[shaft]
length_mm = 300.0
diameter_mm = 30.0
[[disc]]
position_mm = 150.0
diameter_mm = 100.0
width_mm = 40.0
unbalance = 1.0e-6
[[support]]
position_mm = 30.0
bearing = "6205"
clearance = -3.0
loss_factor = 0.02
[[support]]
position_mm = 270.0
bearing = "6205"
clearance = -3.0
loss_factor = 0.02
"""
PERIODIC = """[periodic]
from_rpm = 9000.0
to_rpm = 9100.0
harmonics = 1
samples_per_period = 16
stability = false
"""


@pytest.fixture
def study(tmp_path):
    def write(text, *changes):
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        path = tmp_path / "s.toml"
        path.write_text(text)
        return path

    return write


def answer(speed, size, multiplier, residual=1e-4):
    t = np.linspace(0.0, 60.0 / speed, 33)
    wave = size * np.sin(2.0 * np.pi * t * speed / 60.0)
    run = RotorResult(
        t=t,
        speed_rpm=np.full(33, speed),
        displacement=np.stack([wave, 0.5 * wave, 0.1 * wave, 0.1 * wave], axis=1),
        velocity=np.zeros((33, 4)),
        approach=np.zeros((33, 0)),
        rate=np.zeros((33, 0)),
        force=np.zeros((33, 0)),
        iterations=np.ones(33, int),
        largest_load=np.zeros((0, 2)),
        columns=(),
        status=Status.CONVERGED,
        names=("disc x", "disc y", "bearing 0 x", "bearing 0 y"),
        places=np.arange(4),
    )
    found = None if multiplier is None else np.array([multiplier], complex)
    return PeriodicAnswer(run=run, excitation="unbalance", value=speed, residual=residual, multipliers=found)


def branch(rows, folds=(), **changes):
    """Of speeds, amplitudes in micrometres and multipliers."""
    answers = tuple(answer(speed, 1e-6 * size, multiplier) for speed, size, multiplier in rows)
    given = {"folds": folds, "over": "speed", "status": Status.CONVERGED} | changes
    made = PeriodicBranch(answers=answers, **given)
    nodes = made.answers[0].run.nodes
    return StudyBranch(made, {"disc": nodes["disc"], "left": nodes["bearing 0"]})


JUMP = [(4000.0, 2.0, 0.5), (5000.0, 6.0, 0.9), (5020.0, 8.0, 1.0), (4900.0, 7.0, 1.5), (4870.0, 3.0, 1.0),
        (4950.0, 2.0, 0.7), (6000.0, 1.0, 0.5)]  # fmt: skip


def test_words_of_a_branch_with_two_folds():
    found = branch(JUMP, (2, 4))
    assert found.answer == "two stable answers and an unstable one between 4870 and 5020 rev/min"
    assert found.tile.value == "2" and found.tile.note.endswith(
        "largest 16 µm peak to peak (disc) at 5020 rev/min"
    )
    assert found.reservations == []
    unknown = branch([(speed, size, None) for speed, size, _ in JUMP], (2, 4))
    assert unknown.answer == "three answers between 4870 and 5020 rev/min" and unknown.tile.value == "3"
    numbers = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert numbers["folds_rpm"] == [5020.0, 4870.0] and numbers["last_rpm"] == 6000.0
    assert numbers["several"] == [{"low": 4870.0, "high": 5020.0, "answers": 3, "stable": 2}]


def test_words_of_one_answer_and_of_a_branch_that_ended_early():
    found = branch([(3000.0, 1.0, 0.5), (7450.0, 6.0, 0.9), (9000.0, 2.0, 0.5)])
    assert found.answer == "one answer at every speed from 3000 to 9000 rev/min"
    assert found.largest_words == "largest 12 µm peak to peak (disc) at 7450 rev/min"
    ended = branch(JUMP[:2], reservation="the branch ends here: beyond the atlas", status=Status.FAILED)
    (text,) = ended.reservations
    assert text == "periodic answers: the branch ends here: beyond the atlas; the last one is at 5000 rev/min"
    few = StudyBranch(PeriodicBranch(answers=(answer(3000.0, 1e-6, None, 0.03),), folds=(), over="speed",
                                     status=Status.CONVERGED), found.nodes)  # fmt: skip
    assert "0.03 of those kept: take more periodic.harmonics" in few.reservations[0]
    still = replace(few.branch, answers=(answer(3000.0, 1e-16, None, 0.03),))
    assert StudyBranch(still, found.nodes).reservations == []  # a motion of rounding has no harmonics


def test_the_table_and_the_picture():
    found = branch(JUMP, (2, 4))
    rows = list(csv.DictReader(io.StringIO(found.table())))
    assert [float(row["speed [rev/min]"]) for row in rows] == [row[0] for row in JUMP]
    assert float(rows[2]["disc x peak to peak [um]"]) == pytest.approx(16.0, rel=1e-12)
    assert [row["fold"] for row in rows] == ["0", "0", "1", "0", "1", "0", "0"]
    assert rows[3]["stable"] == "0" and float(rows[3]["largest multiplier [-]"]) == 1.5
    lines = found.picture().panels[0].lines
    assert {line.name for line in lines} >= {"disc x", "disc x, unstable"}
    assert not any("left" in line.name or "bearing" in line.name for line in lines)


def test_a_branch_is_kept_in_a_file(tmp_path):
    """Without the rotor, of which other answers would be."""
    made = branch(JUMP, (2, 4)).branch
    again = read(save(made, tmp_path / "b.h5"), PeriodicBranch)
    np.testing.assert_array_equal(again.peak_to_peak, made.peak_to_peak)
    assert again.folds == (2, 4) and again.bifurcations()[0].kind == made.bifurcations()[0].kind
    for call in (lambda: again.at(4900.0), again.with_multipliers):
        with pytest.raises(InputError, match="file has no rotor"):
            call()


def test_the_task_of_a_study(study, tmp_path):
    """Every answer of the branch is in the folder, and its cost in the forecast."""
    one = load_study(study(FAN + PERIODIC))
    (task,) = branches_of(one)
    assert branches_of(load_study(study(FAN))) == ()
    ended = solve_branch("key", one)
    assert ended.entry["status"] == "converged"
    task.file(tmp_path).write_bytes(ended.content)
    found = branch_of(one, tmp_path)
    assert found.answer == "one answer at every speed from 9000 to 9100 rev/min"
    assert set(found.nodes) == {"disc", "left", "right"}
    assert (tmp_path / of_study.TABLE).read_text().count("\n") == len(found.branch.answers) + 1
    about = forecast(one, tmp_path / "new", 2)
    assert about.branch == pytest.approx(task.cost(one) * about.conv, rel=1e-12) and about.seconds > about.branch
    text = python_text(one)
    assert "from reduced_models import" in text and ", periodic, " in text
    assert "branch = periodic(rotor, between=(9000.0, 9100.0)" in text
    compile(text, "machine.py", "exec")


def test_a_branch_is_followed_once_for_all_speeds_of_a_study(study):
    """What it depends on is its range; the speed of the study alone where bearings are on fits."""
    fits = 'bearing = "6205"\nshaft_fit = "k5"\nhousing_fit = "H6"\n'
    fitted = [("clearance = -3.0\n", ""), ('bearing = "6205"\n', fits)]
    slower = ("speed_rpm = 8000.0", "speed_rpm = 7000.0")

    def key(*changes):
        one = load_study(study(FAN + PERIODIC, *changes))
        return branches_of(one)[0].key(one)

    assert key() == key(slower)
    assert key(*fitted) != key(*fitted, slower)
    for change in (("to_rpm = 9100.0", "to_rpm = 9200.0"), ("unbalance = 1.0e-6", "unbalance = 2.0e-6")):
        assert key() != key(change)


def test_interrupted_branches_are_kept(study, monkeypatch):
    one = load_study(study(FAN + PERIODIC))
    made = branch(JUMP[:2], status=Status.INTERRUPTED).branch
    monkeypatch.setattr(of_study, "periodic", lambda *_, **__: made)
    ended = solve_branch("key", one)
    assert ended.entry["status"] == "interrupted" and ended.content


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("to_rpm = 9100.0", "to_rpm = 9000.0"), ("periodic.to_rpm = 9000.0", "another speed")),
        (("from_rpm = 9000.0", "from_rpm = 0.0"), ("periodic.from_rpm = 0.0", "between")),
        (("samples_per_period = 16", "harmonic = 2"), ("periodic.harmonic", "harmonics?")),
        (("harmonics = 1\n", "harmonics = 9\n"), ("periodic.samples_per_period = 16", "at least 36")),
        (("unbalance = 1.0e-6\n", ""), ("periodic.excitation = 'unbalance'", "disc.unbalance")),
        (("from_rpm = 9000.0\n", ""), ("periodic.from_rpm", "given")),
        (("[periodic]\n", '[periodic]\nexcitation = "force"\n'), ("periodic.excitation", "passage")),
    ],
)
def test_what_is_no_branch(refused, study, change, words):
    refused(words, "validate", study(FAN + PERIODIC, change))


def test_a_bearing_alone_has_none(refused, study):
    refused(("shaft", "given, with [periodic]"), "validate", study(ALONE + PERIODIC))
