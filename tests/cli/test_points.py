"""A study of several points: lists, what is kept, what is solved, what fails, and the summary of all."""

import csv
import json
import os
import random
import shutil
import signal
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from programs import begin, dask_cluster
from stub_tasks import StubTasks, Threads
from tiny_study import ALONE, CONTACT, MOTOR

from ehlcontact import Grid, InputError, read, solve_steady
from ehlcontact.cli.study import runner
from ehlcontact.cli.study.points.folder import locked
from ehlcontact.cli.study.points.lists import MOST, Chosen, load_points, points_of
from ehlcontact.cli.study.points.numbers import MEANINGS, UNITS
from ehlcontact.cli.study.points.picture import draw_points
from ehlcontact.cli.study.points.summary import life_over, spectrum_words, torque_jump
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.stages import solve_stage, stage_named
from ehlcontact.executors import ProcessExecutor

STUDY = ALONE + CONTACT  # of a bearing alone
NAMES = ["steady", "free", "harmonic"]
TASKS = len(NAMES) + 1


def with_lists(speeds="[3000.0, 4000, 5000]", loads="20.0", **changes):
    """The tiny study at these."""
    text = STUDY.replace("speed_rpm = 3000.0", f"speed_rpm = {speeds}").replace(
        "radial_load = 20.0", f"radial_load = {loads}"
    )
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new)
    return text


@pytest.fixture
def stub(monkeypatch):
    """Tasks that leave files at once; ``stub()`` is what was done since the last call."""
    tasks = StubTasks()
    monkeypatch.setattr(runner, "STAGES", tuple(stage_named(name) for name in NAMES))
    monkeypatch.setattr(runner, "solve_stage", tasks.solve_stage)
    monkeypatch.setattr(runner, "finalise_point", tasks.finalise_point)
    monkeypatch.setattr("ehlcontact.executors.ProcessExecutor", Threads)
    return tasks


@pytest.fixture(autouse=True)
def no_pictures(request, monkeypatch):
    """Drawn in one test: they take longer than all the rest."""
    if request.node.name != "test_all_points_are_solved_and_summed_up":
        empty = Figure((1.0, 1.0))
        monkeypatch.setattr(
            "ehlcontact.cli.study.points.summary.draw_points", lambda numbers, path: empty.savefig(path)
        )


@pytest.fixture
def run(call, tmp_path):
    """``run(text, *options)``: the command on a study file; the folder is ``run.folder``."""

    def go(text, *options):
        file = tmp_path / "mine.toml"
        file.write_text(text)
        return call("run", file, "-o", go.folder, *options)

    go.folder = tmp_path / "out"
    return go


def of(name):
    """All tasks of a point, as the stub tells them."""
    return sorted(f"{name} {task}" for task in [*NAMES, "report"])


def lasting(folder):
    """The summary but for what may differ between two runs of one study."""
    found = json.loads((folder / "summary.json").read_text())
    del found["run"]
    return found, (folder / "summary.csv").read_bytes()


def test_every_speed_with_every_load(tmp_path):
    file = tmp_path / "s.toml"
    file.write_text(with_lists("[3000, 4500.5]", "[20.0, 30.0]"))
    points = load_points(file, tmp_path / "out")
    assert [point.name for point in points] == ["3000rpm_20N", "3000rpm_30N", "4500.5rpm_20N", "4500.5rpm_30N"]
    assert points[3].folder == tmp_path / "out" / "points" / "4500.5rpm_30N"
    one = points[3].study
    assert (one.speed_rpm, one.radial_load) == (4500.5, 30.0) and one.title.endswith("4500.5 rpm, 30 N")
    assert one.contact == points[0].study.contact
    assert one.point.load == pytest.approx(1.5 * points[2].study.point.load)
    # of its own study alone, and of one with lists of one number, it is the same
    file.write_text(with_lists("4500.5", "30.0"))
    alone = load_study(file)
    file.write_text(with_lists("[4500.5]", "[30.0]"))
    (single,) = load_points(file, tmp_path / "out")
    assert single.study == alone and single.folder == tmp_path / "out"
    assert alone.fingerprint() == one.fingerprint()


@pytest.mark.parametrize(
    ("speeds", "loads", "words"),
    [
        ("[]", "20.0", ("operation.speed_rpm = []", "1 to 100")),
        ("[3000, -5]", "20.0", ("operation.speed_rpm = -5", "between 0.001 and")),
        ("[3000, 3000.0]", "20.0", ("operation.speed_rpm = 3000.0", "once")),
        ('["3000"]', "20.0", ("operation.speed_rpm", "a number")),
        ("[[3000]]", "20.0", ("operation.speed_rpm = [3000]", "one value, in a list")),
        ("[3000, nan]", "20.0", ("operation.speed_rpm = nan",)),
        (str(list(range(1000, 1011))), str(list(range(10, 20))), ("11 x 10", f"at most {MOST} points")),
        ("[3000, 4000]", "[20.0, 1e7]", ("M = ", "at 3000 rpm, 10000000 N")),
    ],
)
def test_lists_that_are_none_of_points(refused, tmp_path, speeds, loads, words):
    file = tmp_path / "s.toml"
    file.write_text(with_lists(speeds, loads))
    for command in ("run", "validate"):
        refused(("s.toml: ", *words), command, file, "-o", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_shares_make_the_points_a_load_spectrum(tmp_path):
    """Each point has its share, its own study none; lives add up as of two states by hand."""
    file = tmp_path / "s.toml"
    file.write_text(with_lists("[3000, 4500]", "20.0").replace("[operation]", "[operation]\nshares = [0.3, 0.7]"))
    points = load_points(file, tmp_path / "out")
    assert [point.share for point in points] == [0.3, 0.7]
    assert points[0].study.operation.shares is None
    lives = {"l10rh": (2000.0, 500.0), "lnmrh": (None, 900.0), "lnmrh_film": (1000.0, None)}
    rows = [
        SimpleNamespace(point=point, numbers={name: own[k] for name, own in lives.items()})
        for k, point in enumerate(points)
    ]
    basic = pytest.approx(1.0 / (0.3 / 2e3 + 0.7 / 5e2))
    assert life_over(rows) == {"l10rh": basic, "lnmrh": None, "lnmrh_film": None}
    assert spectrum_words(rows) == "basic reference 645 h"


@pytest.mark.parametrize(
    ("shares", "words"),
    [
        ("[0.3]", ("operation.shares = '1 of them'", "one for each point", "has 2")),
        ("[0,6, 0,4]", ("operation.shares = '4 of them'", "[0.6, 0.4]? decimals have a point")),
        ("0.3", ("operation.shares = 0.3", "has 2")),
        ("[0.3, 0.6]", ("operation.shares = [0.3, 0.6]", "1 in sum, not 0.9")),
        ("[30, 70]", ("operation.shares", "percent")),
        ('["a", 0.7]', ("operation.shares = 'a'", "a finite number >= 0")),
    ],
)
def test_shares_that_are_none(refused, tmp_path, shares, words):
    file = tmp_path / "s.toml"
    file.write_text(with_lists("[3000, 4500]", "20.0").replace("[operation]", f"[operation]\nshares = {shares}"))
    refused(("s.toml: ", *words), "validate", file, "-o", tmp_path / "out")


def test_any_entry_of_one_value_may_be_a_list(tmp_path):
    """Every value with every one of the others; names and titles of points have them, tables their units."""
    file = tmp_path / "s.toml"
    text = MOTOR.replace("spring = 200.0", "spring = [100.0, 200]").replace(
        'bearing = "6206"\nclearance = "CN"', 'bearing = ["6206", "6206/C3"]'
    )
    file.write_text(text.replace("width_mm = 120.0", "width_mm = [100.0, 120.0]"))
    points = load_points(file, tmp_path / "out")
    assert len({point.name for point in points}) == 8 == len({point.study.title for point in points})
    one = points[3]
    assert one.name == "15000rpm_disc_width_100_fan_end_bearing_6206_C3_fan_end_spring_200"
    assert one.study.disc[0].width_mm == 100.0 and one.study.support[1].bearing == "6206/C3"
    assert one.study.support[1].spring == 200.0 and one.study.support[0] == points[0].study.support[0]
    assert [choice.head for choice in one.chosen] == ["disc width [mm]", "fan end bearing", "fan end spring [N]"]
    assert one.study.title.endswith("15000 rpm, disc width 100 mm, fan end bearing 6206/C3, fan end spring 200 N")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("spring = 200.0", "spring = []", ("support.fan end.spring = []", "1 to 100")),
        ("spring = 200.0", "spring = [100.0, 100]", ("support.fan end.spring = 100", "once")),
        ("spring = 200.0", "spring = [100.0, true]", ("support.fan end.spring = True", "a number")),
        ("spring = 200.0", 'spring = [100.0, "200"]', ("support.fan end.spring = '200'", "a number")),
        ("spring = 200.0", "spring = [200.0, 2e5]", ("support.fan end.spring = 200000", "a ball carries at most")),
        ("diameter_mm = 35.0", "diameter_mm = [35.0, 0.035]", ("shaft.diameter_mm = 0.035", "in m? then 35")),
        ("diameter_mm = 35.0", "diameter_mm = [35.0, 120.0]", ("disc.diameter_mm = 110", ", at 15000 rpm")),
        ('bearing = "6206"', 'bearing = ["6206/C3", "6206 C3"]', ("fan end.bearing", "letters and digits")),
        ("[oil]", 'name = ["a", "b"]\n[oil]', ("operation.name", "known here")),
        ("width_mm = 120.0", f"width_mm = {list(range(50, 151))}", ("width_mm = '101'", f"most {MOST} points")),
    ],
)  # fmt: skip
def test_lists_that_contradict(refused, tmp_path, old, new, words):
    file = tmp_path / "s.toml"
    text = MOTOR if "C3" not in new else MOTOR.replace('6206"\nclearance = "CN"', '6206"')
    assert old in text
    file.write_text(text.replace(old, new))
    for command in ("run", "validate"):
        refused(words, command, file, "-o", tmp_path / "out")


def test_what_lists_chose_is_in_summary_table_and_page(run, stub):
    """And what does not hold, once where it is said of all points."""
    text = STUDY.replace("conformity = 0.52", "conformity = [0.52, 0.54]")
    found = run(text)
    assert found.code == 0 and "conformity" in found.out and "does not hold: isothermal" in found.out
    summary = json.loads((run.folder / "summary.json").read_text())
    assert [point["lists"] for point in summary["points"]] == [{"support.conformity": k} for k in (0.52, 0.54)]
    rows = list(csv.DictReader((run.folder / "summary.csv").read_text().splitlines()))
    assert [row["conformity"] for row in rows] == ["0.52", "0.54"] and rows[0]["does not hold"] == "isothermal"
    page = (run.folder / "report.html").read_text()
    assert "<th>conformity</th>" in page and page.count("<li>isothermal</li>") == 1
    assert "Critical" not in page and "FMU" not in page


def test_the_picture_is_over_the_longest_list(tmp_path, monkeypatch):
    """Numbers along it, a line for each choice of the others; texts alone are counted."""
    drawn = []
    monkeypatch.setattr("ehlcontact.cli.study.points.picture.draw", lambda picture, path: drawn.append(picture))

    def row(speed, *chosen):
        numbers = dict.fromkeys(UNITS) | {"speed_rpm": speed, "h_min": 1e-7 * speed}
        return SimpleNamespace(numbers=numbers, point=SimpleNamespace(chosen=chosen))

    masses = [Chosen("disc.mass", "kg", value) for value in (3.0, 1.0, 2.0)]
    draw_points([row(speed, mass) for speed in (1.0, 2.0) for mass in masses], tmp_path / "a.png")
    (panel,) = drawn[-1].panels
    assert panel.x == "disc mass [kg]" and [line.name for line in panel.lines] == ["1 rpm", "2 rpm"]
    assert panel.lines[1].x.tolist() == [1.0, 2.0, 3.0] and panel.lines[1].y[0] == pytest.approx(0.2)
    draw_points([row(1.0, Chosen("support.clearance", "um", name)) for name in ("CN", "C3")], tmp_path / "b.png")
    (panel,) = drawn[-1].panels
    assert [line.name for line in panel.lines] == ["clearance CN", "clearance C3"]


def test_commands_of_one_point_refuse_lists(refused, tmp_path):
    file = tmp_path / "s.toml"
    file.write_text(with_lists())
    refused(
        ("operation.speed_rpm = ", "one value here", "ehlcontact run"), "export", file, "-o", tmp_path / "r.fmu"
    )
    with pytest.raises(InputError, match="one value here"):
        load_study(file)


def test_all_points_are_solved_and_summed_up(run, stub):
    found = run(with_lists("[3000.0, 4000]", "[20.0, 30.0]"), "--jobs", "2")
    assert found.code == 0
    assert stub() == sorted(name for n in (3000, 4000) for f in (20, 30) for name in of(f"{n}rpm_{f}N"))
    summary = json.loads((run.folder / "summary.json").read_text())
    assert summary["status"] == "converged" and summary["converged"] == 4 and summary["units"] == UNITS
    assert set(MEANINGS) < set(UNITS) and summary["versions"]["ehlcontact"]
    point = summary["points"][3]
    assert point["name"] == "4000rpm_30N" and set(UNITS) < set(point)
    assert point["h_central"] == pytest.approx(0.4e-6) and point["h_min"] == pytest.approx(0.2e-6)
    assert point["lambda"] == pytest.approx(0.2e-6 / (0.02e-6**2 + 0.15e-6**2) ** 0.5)
    assert point["stiffness"] == 3e7 and point["damping"] == 25.0 and point["p_hertz"] > 1e8
    for name in [*summary["files"].values(), *point["files"].values()]:
        if "fmu" not in name and "elements" not in name:  # which the stub does not make
            assert (run.folder / name).is_file(), name
    rows = list(csv.DictReader((run.folder / "summary.csv").read_text().splitlines()))
    assert [row["point"] for row in rows] == [one["name"] for one in summary["points"]]
    assert [row["warnings"] for row in rows] == ["; ".join(one["warnings"]) for one in summary["points"]]
    assert rows[0]["status"] == "converged" and rows[0]["warnings"].endswith("a warning")
    assert float(rows[3]["damping [N s/m]"]) == 25.0 and rows[3]["h_min_error [of h_min]"] == ""
    page = (run.folder / "report.html").read_text()
    assert all(f'href="points/{row["point"]}/report.html"' in page for row in rows) and "data:image/png" in page
    assert (
        "3000" in found.out
        and "report: " in found.out
        and "ehlcontact: 3000rpm_20N: warning: a warning" in found.err
    )


def test_json_is_the_summary(run, stub):
    found = run(with_lists("[3000.0, 4000]"), "--json", "-")
    assert found.code == 0 and json.loads(found.out) == json.loads((run.folder / "summary.json").read_text())


def test_one_point_is_what_it_was(run, stub):
    """In the folder itself, with its results as JSON; and a summary of the one."""
    found = run(STUDY, "--json", "-")
    assert found.code == 0 and json.loads(found.out) == json.loads((run.folder / "results.json").read_text())
    assert not (run.folder / "points").exists() and (run.folder / "study.toml").read_text() == STUDY
    summary = json.loads((run.folder / "summary.json").read_text())
    assert [point["name"] for point in summary["points"]] == ["3000rpm_20N"]
    assert (run.folder / summary["files"]["report"]).is_file() and "picture" not in summary["files"]


def test_only_what_changed_is_done_again(run, stub):
    run(with_lists())
    assert len(stub()) == 3 * TASKS
    assert run(with_lists("[3000.0, 4000, 6000]")).code == 0
    assert stub() == of("6000rpm_20N")
    summary = json.loads((run.folder / "summary.json").read_text())
    assert [point["speed_rpm"] for point in summary["points"]] == [3000.0, 4000.0, 6000.0]
    assert sorted(summary["run"]["solved"]) == of("6000rpm_20N") and len(summary["run"]["kept"]) == 2 * TASKS
    run(with_lists())  # as it was: the folder of the third is still there
    assert stub() == []
    run(with_lists(motion=("[contact.harmonic]", "[contact.harmonic]\namplitude = 0.2")))
    assert stub() == sorted(f"{n}rpm_20N {task}" for n in (3000, 4000, 5000) for task in ("harmonic", "report"))


def test_another_study_does_not_replace_results_silently(run, stub, tmp_path, call):
    """A study from another file is refused; what changed of the same one is told."""
    assert run(STUDY).err.count("changed") == 0
    changed = STUDY.replace("3000.0", "4000.0").replace("conformity = 0.52", "conformity = 0.53")
    found = run(changed)
    entries = "operation.speed_rpm, support.conformity"
    assert found.code == 0 and f"changed since the last run in {run.folder}: {entries}\n" in found.err
    assert f"changed   {entries}\n" in (run.folder / "run.log").read_text()
    assert "changed" not in run(changed).err
    other = tmp_path / "b" / "mine.toml"
    other.parent.mkdir()
    other.write_text(changed)
    assert call("run", other, "-o", run.folder).code == 0  # a copy
    (tmp_path / "mine.toml").write_text(STUDY)
    refusal = call("run", tmp_path / "mine.toml", "-o", run.folder)
    assert refusal.code == 2 and f"results of another study, of {other}; or with --force" in refusal.err
    assert (run.folder / "study.toml").read_text() == changed
    assert run(STUDY, "--force").code == 0 and (run.folder / "study.toml").read_text() == STUDY
    other.write_text(changed)
    (tmp_path / "mine.toml").unlink()  # moved
    found = call("run", other, "-o", run.folder)
    assert found.code == 0 and "changed since" in found.err


def test_what_only_the_report_shows_solves_nothing(run, stub):
    run(STUDY)
    stub()
    for old, new in (
        ("[operation]", 'title = "another"\n[operation]'),
        ("[[support]]", '[[support]]\nname = "mine"'),
        ("[oil]", '[oil]\nname = "good oil"'),
        ("rq_race_um = 0.15", "rq_race_um = 0.2"),
    ):
        assert run(STUDY.replace(old, new)).code == 0
        assert stub() == ["3000rpm_20N report"], new


def test_contents_are_found_wherever_they_are(run, stub):
    """From a study of one point to a list and back, a folder gone meanwhile: nothing is solved twice."""
    run(STUDY)
    assert len(stub()) == TASKS
    run(with_lists("[3000.0, 4000]"))
    assert stub() == sorted([*of("4000rpm_20N"), "3000rpm_20N report"])
    shutil.rmtree(run.folder / "points" / "4000rpm_20N")
    run(with_lists("4000.0"))
    assert stub() == ["4000rpm_20N report"]
    run(STUDY)
    assert stub() == ["3000rpm_20N report"]


def test_files_that_are_damaged_or_gone_are_written_again(run, stub):
    """From the store; what is damaged there is solved again."""
    run(with_lists("[3000.0, 4000]"))
    stub()
    files = [run.folder / "points" / "4000rpm_20N" / f"{name}.h5" for name in ("free", "steady")]
    before = [file.read_bytes() for file in files]
    files[0].write_text("else")
    files[1].unlink()
    found = run(with_lists("[3000.0, 4000]"))
    assert stub() == [] and found.err == "" and [file.read_bytes() for file in files] == before
    (kept,) = (file for file in (run.folder / "store").iterdir() if file.read_bytes().endswith(before[0]))
    kept.write_bytes(kept.read_bytes()[:-1])
    found = run(with_lists("[3000.0, 4000]"))
    assert stub() == ["4000rpm_20N free", "4000rpm_20N report"]
    assert "4000rpm_20N: free vibration: what was kept is damaged" in found.err


def test_points_that_fail_do_not_stop_the_others(run, stub):
    stub.orders = ["4000rpm_20N free"]
    found = run(with_lists(), "--json", "-")
    assert found.code == 1
    said = [line for line in found.err.splitlines() if "diverged" in line]
    assert any("ehlcontact: 4000rpm_20N: free: diverged: The residual grows: use a finer grid" in s for s in said)
    assert stub() == sorted([*of("3000rpm_20N"), *of("5000rpm_20N"), *(f"4000rpm_20N {name}" for name in NAMES)])
    summary = json.loads(found.out)
    assert summary["status"] == "not converged" and summary["converged"] == 2
    first, failed, _ = summary["points"]
    assert (first["status"], failed["status"]) == ("converged", "diverged")
    assert failed["messages"] == ["free: diverged: The residual grows: use a finer grid."]
    assert failed["h_central"] is None and failed["M"] > 1.0 and "report" not in failed["files"]
    row = (run.folder / "summary.csv").read_text().splitlines()[2]
    assert ",diverged," in row and ",,," in row
    page = (run.folder / "report.html").read_text()
    assert "2 of 3 points converged" in page and "use a finer grid" in page
    stub.orders = []
    assert run(with_lists()).code == 0 and stub() == ["4000rpm_20N free", "4000rpm_20N report"]


def test_fmus_that_fail_are_tried_again(run, stub):
    stub.orders = ["4000rpm_20N report without FMU"]
    found = run(with_lists())
    assert found.code == 1 and "4000rpm_20N: contact.fmu: differs from its model" in found.err
    stub()
    stub.orders = []
    assert run(with_lists()).code == 0 and stub() == ["4000rpm_20N report"]


def test_a_condition_without_films_at_some_speed_is_a_failure(run, stub):
    """Named with its point, with exit code 1; the rest is there. The same run again only says it."""
    stub.orders = ["4000rpm_20N report without films"]
    for done in (3 * TASKS, 0):
        found = run(with_lists())
        assert found.code == 1 and "4000rpm_20N: no films of the bearing with the layer: thin" in found.err
        assert len(stub()) == done and (run.folder / "report.html").is_file()


def test_entries_of_the_log(run, stub):
    run(with_lists("[3000.0, 4000]"))
    run(with_lists("[3000.0, 5000]"))
    lines = [line.split(maxsplit=2) for line in (run.folder / "run.log").read_text().splitlines()]
    kinds = [kind for _, kind, _ in lines]
    assert kinds.count("run") == kinds.count("versions") == kinds.count("done") == 2
    assert kinds.count("kept") == TASKS and kinds.count("solved") == 3 * TASKS
    assert kinds.count("warning") == 3 and all(time.strptime(when[:19], "%Y-%m-%dT%H:%M:%S") for when, *_ in lines)
    assert any(text == "5000rpm_20N: free vibration: done, 0.0 s" for _, _, text in lines)


# between `open` and the `with` that closes the file, an interrupt leaves it to the garbage collector
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
def test_interrupted_at_random_moments_it_gives_the_same(run, stub):
    """Ctrl-C, seeded; the slow test does so with a real study, and with kill -9."""
    stub.orders = ["slow"]
    started = time.monotonic()
    run(with_lists("[3000.0, 4000]"))
    took, expected = time.monotonic() - started, lasting(run.folder)
    shutil.rmtree(run.folder)
    stub()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    rng, codes = random.Random(21), []
    try:
        for _ in range(5):
            timer = threading.Timer(rng.uniform(0.02, 0.3) * took, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            found = run(with_lists("[3000.0, 4000]"))
            timer.cancel()
            timer.join()
            codes.append(found.code)
            if found.code == 0:
                break
            assert found.code == 130
            assert "interrupted" in found.err.splitlines()[-1] and "Traceback" not in found.err
    finally:
        signal.signal(signal.SIGINT, before)
    assert 130 in codes
    assert run(with_lists("[3000.0, 4000]")).code == 0
    assert lasting(run.folder) == expected
    assert set(stub()) == {*of("3000rpm_20N"), *of("4000rpm_20N")}


def test_a_summary_of_what_the_study_was_does_not_outlive_an_interrupt(run, stub, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    def over_all():
        return {name for name in ("summary.json", "summary.csv", "report.html") if (run.folder / name).exists()}

    two, everything = with_lists("[3000.0, 4000]"), {"summary.json", "summary.csv", "report.html"}
    assert run(two).code == 0 and over_all() == everything
    with monkeypatch.context() as patch:
        patch.setattr(runner, "_run", stop)
        assert run(two).code == 130 and over_all() == everything  # nothing is to be done: it is true as it is
        assert run(with_lists("[3000.0, 5000]")).code == 130 and over_all() == set()
        assert (run.folder / "points" / "4000rpm_20N" / "steady.h5").is_file()
    log = (run.folder / "run.log").read_text()
    assert log.count(" removed ") == 1 and "removed  summary.json, summary.csv" in log.replace("   ", "  ")
    assert run(two).code == 0 and over_all() == everything
    with monkeypatch.context() as patch:
        patch.setattr(runner, "_run", stop)
        assert run(with_lists("[3000.0, 3500]")).code == 130 and over_all() == set()
    assert run(with_lists("[3000.0, 4000]")).code == 0
    with monkeypatch.context() as patch:  # fewer points, all of them done
        patch.setattr(runner, "_run", stop)
        (run.folder / "summary.json").write_text("{}")
        assert run(two).code == 130 and not (run.folder / "summary.csv").exists()


def test_two_runs_do_not_share_a_folder(run, stub):
    with_two = with_lists("[3000.0, 4000]")
    assert run(with_two).code == 0
    with locked(run.folder):
        found = run(with_two)
    assert found.code == 2 and "one that no other run is at work in" in found.err
    assert run(with_two).code == 0


def test_validate_covers_all_points(call, tmp_path):
    file = tmp_path / "s.toml"
    file.write_text(with_lists("[3000.0, 4000]", "[20.0, 30.0]"))
    found = call("validate", file, "-o", tmp_path / "none", "--jobs", "2", "--json", "-")
    document = json.loads(found.out)
    assert [point["name"] for point in document["points"]][::3] == ["3000rpm_20N", "4000rpm_30N"]
    assert document["seconds"] == pytest.approx(sum(point["seconds"] for point in document["points"]) / 2, rel=0.5)
    assert any(text.startswith("3000rpm_30N") for text in document["warnings"])
    shown = call("validate", file, "-o", tmp_path / "none").out
    assert "4000rpm_30N" in shown and "0 of 4" in shown and "whole study" in shown


def test_init_writes_lists(call, tmp_path):
    file = tmp_path / "s.toml"
    options = ("--speed-rpm", "1500", "--speed-rpm", "3000", "--load", "100", "--load", "3000", "--json", "-")
    document = json.loads(call("init", file, *options).out)
    assert document["speed_rpm"] == [1500.0, 3000.0] and document["radial_load"] == [100.0, 3000.0]
    points = load_points(file, tmp_path)
    assert [point.name for point in points] == ["1500rpm_100N", "1500rpm_3000N", "3000rpm_100N", "3000rpm_3000N"]
    # the grid is that of the thinnest film
    alone = tmp_path / "alone.toml"
    call("init", alone, "--speed-rpm", "1500", "--load", "3000")
    assert points[0].study.contact.n == load_study(alone).contact.n


@pytest.fixture
def cluster(stub, monkeypatch):
    """A cluster of one, in this process; gives the tasks that were sent there."""
    sent = []

    class Cluster(Threads):
        def submit(self, fn, /, *args, **kwargs):
            sent.append(args[0])
            return super().submit(fn, *args, **kwargs)

    @contextmanager
    def either(processes, threads=None, scheduler=None, report=None, waiting=None):
        with (Threads if scheduler is None else Cluster)(processes) as executor:
            yield executor

    monkeypatch.setattr(runner, "executor_for", either)
    monkeypatch.setattr("ehlcontact.executors.require_scheduler", lambda scheduler: None)
    return sent


def test_stages_of_a_cluster_are_those_of_this_machine(run, stub, cluster, monkeypatch):
    """Workers get a study and give the content of a file; what is kept is not sent there."""
    monkeypatch.setattr(runner, "solve_stage", solve_stage)
    monkeypatch.setattr(runner, "STAGES", (stage_named("steady"),))
    text = with_lists("[3000.0, 4000]")
    assert run(text, "--scheduler", "tcp://somewhere").code == 0
    assert cluster == ["3000rpm_20N steady", "4000rpm_20N steady"]
    assert stub() == ["3000rpm_20N report", "4000rpm_20N report"]
    (run.folder / "s.toml").write_text(text)
    for point in load_points(run.folder / "s.toml", run.folder):
        ours = solve_steady(point.study.point, grid=Grid(n=32, domain=point.study.domain))
        assert read(point.folder / "steady.h5").h_min == ours.h_min
    assert run(text, "--scheduler", "tcp://somewhere").code == 0 and len(cluster) == 2


def test_a_stage_that_fails_on_a_cluster(run, stub, cluster):
    stub.orders = ["3000rpm_20N free"]
    found = run(STUDY, "--scheduler", "tcp://somewhere")
    assert found.code == 1 and "free: diverged: The residual grows" in found.err
    assert sorted(cluster) == stub() == sorted(f"3000rpm_20N {name}" for name in NAMES)
    point = json.loads((run.folder / "summary.json").read_text())["points"][0]
    assert point["files"]["free vibration, as far as it went"] == "free.partial.h5"
    assert (run.folder / "free.partial.h5").read_bytes() == b"some"


@pytest.mark.slow
def test_a_dask_cluster(run, stub, monkeypatch, tmp_path):
    """Scheduler and two workers as processes of their own."""
    pytest.importorskip("distributed")
    monkeypatch.setattr(runner, "STAGES", (stage_named("steady"), stage_named("free")))
    monkeypatch.setattr(runner, "solve_stage", solve_stage)
    (tmp_path / "one.toml").write_text(STUDY)
    (point,) = load_points(tmp_path / "one.toml", tmp_path)
    for _ in range(2):  # where kernels are compiled, last digits may differ from those of cached ones
        with ProcessExecutor(1, threads=1) as executor:
            content = executor.submit(solve_stage, "", point.study, "free").result().content
            (tmp_path / "free.h5").write_bytes(content)
    ours = read(tmp_path / "free.h5")
    with dask_cluster(tmp_path) as (scheduler, _):
        assert run(with_lists("[3000.0, 4000]"), "--scheduler", scheduler).code == 0
    assert stub() == ["3000rpm_20N report", "4000rpm_20N report"]
    theirs = read(run.folder / "points" / "3000rpm_20N" / "free.h5")
    assert np.array_equal(ours.force, theirs.force)


def test_no_cluster_at_that_address(refused, tmp_path):
    pytest.importorskip("distributed")
    file = tmp_path / "s.toml"
    file.write_text(with_lists())
    words = ("--scheduler = 'tcp://127.0.0.1:1'", "Dask scheduler")
    refused(words, "run", file, "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:1")
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_a_cluster_without_workers(tmp_path):
    """A warning after seconds, and nothing is counted as begun."""
    pytest.importorskip("distributed")
    file, out = tmp_path / "s.toml", tmp_path / "out"
    file.write_text(with_lists())
    with dask_cluster(tmp_path, workers=0) as (scheduler, _):
        process = begin("run", file, "-o", out, "--scheduler", scheduler)
        said = next(line for line in process.stderr if "whole study" not in line)
        process.send_signal(signal.SIGINT)
        _, end = process.communicate(timeout=60)
    assert said == f"ehlcontact: warning: no worker is connected to {scheduler}: nothing begins until one is\n"
    assert process.returncode == 130 and "interrupted" in end and "Traceback" not in end
    assert "  begun " not in (out / "run.log").read_text()


def test_points_of_a_document_without_a_bearing():
    with pytest.raises(InputError, match="bearing"):
        points_of({"bearing": [3000]}, Path())


def test_why_the_torque_jumps_over_speeds():
    rows = [SimpleNamespace(numbers={"speed_rpm": rpm, "torque": 0.03}) for rpm in (3000.0, 5000.0, 5100.0)]
    assert "above 5000 rev/min by SKF's model" in torque_jump(rows)
    assert torque_jump(rows[:2]) == torque_jump(rows[2:]) == ""
    rows[2].numbers["torque"] = None
    assert torque_jump(rows) == ""
