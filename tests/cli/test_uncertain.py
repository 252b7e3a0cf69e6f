"""A study with [uncertain]: entries, draws, batches that are kept and resumed, intervals in report and tables."""

import csv
import json
import signal
import threading
import tomllib

import numpy as np
import pytest
from programs import begin
from stub_tasks import Threads
from tiny_study import ALONE, MOTOR

from ehlcontact import InputError
from ehlcontact.cli.study import uncertain
from ehlcontact.cli.study.answer import answer_of
from ehlcontact.cli.study.forecast import forecast
from ehlcontact.cli.study.headline import limits
from ehlcontact.cli.study.machine import disc_of
from ehlcontact.cli.study.points.folder import Log
from ehlcontact.cli.study.points.kept import BEGUN
from ehlcontact.cli.study.points.lists import Point, points_of
from ehlcontact.cli.study.points.numbers import UNITS
from ehlcontact.cli.study.points.summary import Row, cells, columns_of, table
from ehlcontact.cli.study.results import Findings
from ehlcontact.cli.study.runner import Share, run_points
from ehlcontact.cli.study.schema import study_of
from ehlcontact.cli.study.uncertain import batches_of, entries_of, machine_of, solve_batch, uncertainty_of
from ehlcontact.files import write_bytes

RANGES = """[uncertain]
samples = 24
support.clearance = [2.0, 12.0]
operation.radial_load = {normal = [20.0, 2.0], within = [14.0, 26.0]}
"""


def of(text):
    """The study of a text."""
    return study_of(tomllib.loads(text))


@pytest.fixture(scope="module")
def sampled(tmp_path_factory):
    """A bearing alone with its samples answered, and the folder that has them."""
    folder, study = tmp_path_factory.mktemp("sampled"), of(ALONE + RANGES.replace("24", "16"))
    for batch in batches_of(study):
        answer = solve_batch("key", study, batch)
        assert answer.entry["status"] == "converged"
        batch.file(folder).parent.mkdir(exist_ok=True)
        write_bytes(batch.file(folder), answer.content, "file")
    machine = answer_of(study)
    return study, machine, uncertainty_of(study, machine, folder), folder


def test_entries_are_named_as_in_messages():
    known = entries_of(of(MOTOR))
    assert known["support.clearance"] == [("support", 0, "clearance"), ("support", 1, "clearance")]
    assert known["support.fan end.spring"] == [("support", 1, "spring")]
    assert known["disc.balance_grade"] == [("disc", 0, "balance_grade")]
    assert known["oil.temperature"] == [("oil", None, "temperature")]
    assert "operation.shares" not in known and "support.balls" not in known and "oil.iso_vg" not in known


def test_the_machine_of_a_sample():
    """Entries with or without quotes; by the plain name all supports have one value."""
    text = MOTOR + '[uncertain]\nsupport.clearance = [5.0, 20.0]\n"support.fan end.spring" = [150.0, 250.0]\n'
    study = of(text + "disc.balance_grade = [1.0, 6.3]\n")
    assert list(study.uncertain.spreads) == ["support.clearance", "support.fan end.spring", "disc.balance_grade"]
    values = {"support.clearance": 7.0, "support.fan end.spring": 180.0, "disc.balance_grade": 2.5}
    own = machine_of(study, values)
    assert [one.clearance for one in own.support] == [7.0, 7.0] and own.support[1].spring == 180.0
    assert own.disc[0].unbalance == 0.0 and own.disc[0].balance_grade == 2.5 and own.uncertain is None
    assert machine_of(study, {"electric.voltage": 30.0}).electric.voltage == 30.0  # of a section not in the file
    with pytest.raises(InputError, match=r"support.fan end.spring = -1.0: must be"):
        machine_of(study, {"support.fan end.spring": -1.0})


def test_all_parts_of_the_machine_are_in_its_samples():
    """Its damper too, whose clearance may be uncertain; what is no part of it is left out."""
    damped = MOTOR.replace('name = "fan end"', 'name = "fan end"\nhousing_stiffness = 2e7\nhousing_mass = 1.0')
    damped = damped.replace("spring = 200.0\n", "offset_um = 20.0\n")
    text = damped + '[[damper]]\nsupport = "fan end"\nlength_mm = 20.0\ndiameter_mm = 80.0\nclearance_um = 100.0\n'
    study = of(text + '[uncertain]\n"damper.clearance_um" = [80.0, 120.0]\n')
    own = machine_of(study, {"damper.clearance_um": 90.0})
    assert own.damper[0].clearance_um == 90.0 and own.model_copy(
        update={"damper": study.damper}
    ) == study.model_copy(update={"uncertain": None})


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("support.lefty.clearance", r"of a support: drive end, fan end; or .support.clearance., that of all"),
        ("support.fan end.clearanc", r"support.fan end.clearance\? an entry of"),
        ("periodic.from_rpm", r"an entry of .* that is a number"),
    ],
)
def test_what_is_no_entry_of_the_machine(entry, words):
    text = f'{MOTOR}[periodic]\nfrom_rpm = 1000.0\nto_rpm = 2000.0\n[uncertain]\n"{entry}" = [5.0, 15.0]\n'
    with pytest.raises(InputError, match=words):
        of(text)


def test_unbalance_of_a_grade():
    """U = G m / w, of the mass of the disc."""
    study = of(MOTOR.replace("unbalance = 1e-5", "balance_grade = 2.5"))
    disc = disc_of(study, 0)
    assert disc.unbalance == pytest.approx(2.5e-3 * disc.mass / (15000.0 * np.pi / 30.0), rel=1e-12)
    with pytest.raises(InputError, match=r"disc.unbalance = 1e-05: must be left out where disc.balance_grade"):
        of(MOTOR.replace("unbalance = 1e-5", "unbalance = 1e-5\nbalance_grade = 2.5"))


def test_one_rotor_has_one_unbalance_at_all_speeds_of_a_study(tmp_path):
    """That of the highest speed, of a list or of a range."""
    graded = MOTOR.replace("unbalance = 1e-5", "balance_grade = 2.5")
    several = tomllib.loads(graded.replace("speed_rpm = 15000.0", "speed_rpm = [9000.0, 15000.0, 12000.0]"))
    points = points_of(several, tmp_path)
    assert [point.study.speed_rpm for point in points] == [9000.0, 15000.0, 12000.0]
    (unbalance,) = {disc_of(point.study, 0).unbalance for point in points}
    assert unbalance == disc_of(of(graded), 0).unbalance
    study = of(graded + '[uncertain]\n"operation.speed_rpm" = [12000.0, 20000.0]\n')
    known = {disc_of(machine_of(study, {"operation.speed_rpm": rpm}), 0).unbalance for rpm in (13000.0, 19000.0)}
    assert known == {disc_of(study, 0).unbalance} == {0.75 * unbalance}
    service = of(graded.replace("balance_grade = 2.5", "balance_grade = 2.5\nbalance_speed_rpm = 30000.0"))
    assert disc_of(service, 0).unbalance == 0.5 * unbalance
    with pytest.raises(InputError, match=r"disc.balance_speed_rpm = 9000.0: must be left out without"):
        of(MOTOR.replace("unbalance = 1e-5", "unbalance = 1e-5\nbalance_speed_rpm = 9000.0"))


def test_intervals_of_a_bearing(sampled):
    """Clearance puts the load on fewer balls: what moves what, and the table of all samples."""
    study, machine, found, folder = sampled
    assert found.values.shape == (16, 2)
    (remark,) = found.remarks  # 0 is none of these clearances
    assert remark.startswith("the nominal value lies outside of the range: smallest film, lambda,")
    ball = found.influence("ball_load")
    assert ball.correlation[0] > 0.7 and ball.correlation[1] > 0.2
    assert found.nominal["ball_load"] == machine.numbers["ball_load"]
    interval = found.interval("h_min")
    assert interval.low < interval.median < interval.high
    with (folder / "samples.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 16 and rows[0]["failure"] == ""
    assert float(rows[3]["support.clearance"]) == found.values[3, 0]
    assert float(rows[3]["h_min [m]"]) == found.numbers["h_min"][3]
    some = {"support.clearance": found.values[3, 0], "operation.radial_load": found.values[3, 1]}
    assert answer_of(machine_of(study, some)).numbers["h_min"] == found.numbers["h_min"][3]


def findings(study, machine, found):
    """Findings of a study without contact, exports and runs."""
    return Findings(study, machine, {}, None, {}, (), None, None, {}, {}, found)


def test_intervals_in_tiles_and_tables(sampled, tmp_path):
    study, machine, found, _ = sampled
    everything = findings(study, machine, found)
    tile = next(one for one in everything.tiles if one.name == "smallest film")
    low, high = found.words("h_min", found.interval("h_min")[0:3:2])
    assert tile.note.startswith(f"88 % {low} to {high}; ")  # of 16 samples
    assert next(one for one in machine.tiles() if one.name == "smallest film").value == tile.value
    results = everything.to_dict()
    json.dumps(results["uncertainty"], allow_nan=False)
    own = results["uncertainty"]["numbers"]["h_min"]
    assert (own["low"], own["high"]) == (found.interval("h_min").low, found.interval("h_min").high)
    assert own["rank_correlation"].keys() == set(study.uncertain.spreads)
    ends = {"h_min": (own["low"], own["high"])}
    point = Point(study, "3000rpm_20N", tmp_path)
    numbers = dict.fromkeys(UNITS) | machine.numbers
    row = Row(point, "converged", (), (), (), (), numbers, {}, {}, None, (), ends)
    header, line = table([row]).splitlines()
    assert "h_min interval from [m],h_min interval to [m]" in header and repr(own["low"]) in line
    assert any(f"({low} to {high})" in text for text in cells(row, columns_of([row])))


def test_what_fails_in_samples_is_said(sampled):
    """Machines without an answer are counted, and named among what does not hold."""
    study, machine, _, _ = sampled
    text = ALONE.replace("radial_load = 20.0", "radial_load = 20.0\naxial_load = 1.0") + RANGES.replace(
        "support.clearance = [2.0, 12.0]", "operation.tilt_x_mrad = [0.0, 30.0]"
    )
    study = of(text)
    answered = json.loads(solve_batch("key", study, uncertain.Batch(0, 8)).content)
    samples = [uncertain.Sample(**one) for one in answered]
    found = uncertain.Uncertainty.of(tuple(study.uncertain.spreads), samples, uncertain.sample_of([], dict), 0)
    failed = sum(bool(one.failure) for one in samples)
    assert 0 < failed < 8 and found.to_dict()["failed"] == failed
    own = findings(study, machine, found)
    assert any(line.startswith(f"{failed} of 8 samples have no answer") for line in limits(own))


def test_an_interrupted_batch_goes_on(monkeypatch):
    """Samples that were made are kept, and the answer is that of a batch without interruption."""
    study, calls = of(ALONE + RANGES), []

    def answer(study, values):
        calls.append(values)
        if len(calls) == 4:
            raise KeyboardInterrupt
        return {"h_min": 1e-6 * values["support.clearance"]}

    monkeypatch.setattr(uncertain, "_answer", answer)
    batch = batches_of(study)[0]
    begun = solve_batch("key", study, batch)
    assert begun.entry["status"] == "interrupted" and "3 of 10 samples" in begun.entry["message"]
    rest = solve_batch("key", study, batch, begun.content)
    assert rest.entry["status"] == "converged" and len(calls) == 4 + 7
    assert rest.content == solve_batch("key", study, batch).content


def test_batches_of_a_run_are_kept_by_content(tmp_path, monkeypatch):
    """More samples leave those that are there; another title, or a nominal value, too; another oil does not."""
    calls = []

    def answer(study, values):
        calls.append(values)
        return {"h_min": 1e-6 * values["support.clearance"]}

    monkeypatch.setattr(uncertain, "_answer", answer)
    monkeypatch.setattr("ehlcontact.executors.ProcessExecutor", Threads)

    def run(text):
        calls.clear()
        points = points_of(tomllib.loads(text), tmp_path)
        done = run_points(points, tmp_path, Share(2), Log(None), final=False)
        assert all(entry["status"] == "converged" for entry in done.ended[points[0].name].values())
        return len(calls)

    text = ALONE + RANGES
    assert run(text) == 24 and run(text) == 0
    assert run('title = "other"\n' + text) == 0
    assert run(text.replace("[[support]]", "[[support]]\nclearance = 4.0")) == 0
    assert run(text.replace("samples = 24", "samples = 30")) == 10  # the third batch was of four
    assert run(text.replace("eta0 = 0.02", "eta0 = 0.03")) == 24
    assert run(text.replace("samples = 24", "samples = 24\nseed = 1")) == 24


def test_the_cost_of_samples(tmp_path):
    study = of(ALONE + RANGES)
    found = forecast(study, tmp_path, 2)
    assert found.samples == pytest.approx(24 * uncertain.COST * found.conv, rel=1e-12)
    assert found.to_dict()["samples_seconds"] == found.samples and found.seconds > 0.5 * found.samples


def test_lists_beside_ranges(tmp_path):
    """Other entries may be lists: every point has its own intervals."""
    text = ALONE.replace("3000.0", "[3000.0, 4000.0]") + RANGES
    points = points_of(tomllib.loads(text), tmp_path)
    first, second = (batches_of(point.study)[0].key(point.study) for point in points)
    assert first != second and points[0].study.sample_rows == points[1].study.sample_rows
    with pytest.raises(InputError, match=r"support.clearance = .*: must be one value, beside its range"):
        points_of(tomllib.loads(text.replace("[[support]]", "[[support]]\nclearance = [3.0, 4.0]")), tmp_path)


def ended(process):
    """Exit code of a process that ends."""
    process.communicate(timeout=500)
    return process.returncode


@pytest.mark.long
def test_a_run_of_a_study_interrupted_and_resumed(tmp_path):
    """SIGINT to the command: the samples made are kept, and the same command ends with those of a single run."""
    study = tmp_path / "mine.toml"
    study.write_text(ALONE + RANGES.replace("samples = 24", "samples = 200"))
    run = begin("run", study, "-o", tmp_path / "out", "--jobs", "2")
    store = tmp_path / "out" / "store"
    while run.poll() is None and (not store.is_dir() or len(list(store.iterdir())) < 2):
        threading.Event().wait(0.05)
    run.send_signal(signal.SIGINT)
    assert ended(run) == 130
    kept = {path.name for path in store.iterdir()}
    batches = {batch.key(of(study.read_text())) for batch in batches_of(of(study.read_text()))}
    assert 2 <= len(kept) <= len(batches) and {name.removesuffix(BEGUN) for name in kept} <= batches
    assert ended(begin("run", study, "-o", tmp_path / "out", "--jobs", "2")) == 0
    assert ended(begin("run", study, "-o", tmp_path / "whole", "--jobs", "1")) == 0
    assert (tmp_path / "out" / "samples.csv").read_bytes() == (tmp_path / "whole" / "samples.csv").read_bytes()
    page = (tmp_path / "out" / "report.html").read_text()
    assert 'id="uncertainty"' in page and "95 % " in page
    document = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert document["points"][0]["intervals"]["h_min"][0] > 0.0
