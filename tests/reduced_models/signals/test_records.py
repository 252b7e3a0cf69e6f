"""Labelled records: lines where the label says, resume, columns of bearing-datasets, bad input."""

import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from ehlcontact import ConvergenceError, InputError, Lubricant, read
from reduced_models import BallBearing, RaceWaviness, Spall, simulate_rotor
from reduced_models.signals import (
    ModalPath,
    RecordCase,
    envelope_spectrum,
    housing_acceleration,
    indicators,
    make_records,
    write_dataset,
)
from reduced_models.signals.records import VibrationRecord, _is_whole, make_record

OIL, PATH = Lubricant.iso_vg(68, temperature=40.0), ModalPath(hz=[2700.0], damping=[0.05], mass=[3.0])
# of every row in version 0.3.0, but for the name of the data set and the three of its files
REQUIRED = {
    "signal_id", "recording_id", "native_label", "channel", "sensor_location", "fs", "n_samples", "fault_type",
    "fault_location", "sensor_at_fault",
}  # fmt: skip


def case(race=None, seconds=0.5, **changes):
    pits = [Spall(race=race, angle=-np.pi / 2.0, length=5e-4, depth=3e-6, edge=1e-4)] if race else []
    bearing = BallBearing.catalogue("6205", clearance=8e-6, oil=OIL, features=pits)
    given = {"load": (0.0, -300.0), "speed_rpm": 1800.0, "path": PATH, "label": race or "healthy", "seed": 7}
    return RecordCase(**{**given, "bearing": bearing, "seconds": seconds, "noise": 0.01, **changes})


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder, seen = tmp_path_factory.mktemp("records"), []
    cases = [case(), case("outer"), case("inner")]
    made = make_records(cases, folder, progress=lambda *numbers: seen.append(numbers))
    return folder, cases, made, seen


@pytest.mark.long
def test_lines_are_where_the_label_says(files):
    healthy, outer, inner = (read(path, VibrationRecord) for path in files[2])
    for record, name in ((outer, "bpfo"), (inner, "bpfi")):
        at = record.columns[f"{name}_order"] * record.columns["speed_rpm"] / 60.0
        found = envelope_spectrum(record.signal, record.rate, (2000.0, 5500.0))
        assert found.line(at, 3.0).amplitude > 20.0 * np.median(found.amplitude)
        assert indicators(record.signal).kurtosis > 4.0
        assert record.columns["fault_type"] == name.replace("bpfo", "outer").replace("bpfi", "inner")
    assert indicators(healthy.signal).kurtosis < 3.5 and healthy.columns["fault_type"] == "normal"
    assert set(healthy.columns) >= REQUIRED and healthy.signal.size == healthy.columns["n_samples"] == 6000


@pytest.mark.long
def test_made_once_and_again_the_same(files):
    """A second call makes what is missing or damaged only; a record depends on its case alone."""
    folder, cases, made, seen = files
    assert seen == [(1, 3), (2, 3), (3, 3)]
    before = [path.stat().st_mtime_ns for path in made[:2]]
    kept = read(made[2]).signal
    made[2].write_bytes(made[2].read_bytes()[:3000])  # cut short
    again = []
    assert make_records(cases, folder, progress=lambda *numbers: again.append(numbers)) == made
    assert again == [(3, 3)] and [path.stat().st_mtime_ns for path in made[:2]] == before
    assert np.array_equal(read(made[2]).signal, kept)
    (folder / "empty.h5").write_bytes(b"")
    assert not _is_whole(folder / "empty.h5") and _is_whole(made[2])
    assert len({one.recording_id for one in (*cases, case(seed=8), case(speed_rpm=1801.0))}) == 5


@pytest.mark.long
def test_a_healthy_record_has_a_bearing_in_it():
    """Ball passage and waviness of new races, of the velocity of new bearings; smooth races are far quieter."""
    wavy, smooth = (make_record(case(noise=0.0, waviness=height, seconds=2.0)) for height in (1e-7, 0.0))
    bpfo = wavy.columns["bpfo_order"] * 30.0
    found = envelope_spectrum(wavy.signal, wavy.rate, (2000.0, 5500.0))
    assert found.line(bpfo, 3.0).amplitude > 5.0 * np.median(found.amplitude[: found.hz.searchsorted(1000.0)])
    loud, quiet = (indicators(one.signal, one.rate) for one in (wavy, smooth))
    assert loud.rms > 30.0 * quiet.rms and 2.5 < loud.kurtosis < 3.5
    assert 0.01 < loud.velocity_rms_mm_s < 0.2
    assert f"velocity {loud.velocity_rms_mm_s:.4g} mm/s rms" in repr(wavy)


def test_waviness_of_a_case():
    """Both races have it up to half of the rate, n waves an n-th as high, and another seed other phases."""
    fine, coarse, other = case(rate=12_000.0), case(rate=6000.0), case(seed=8)
    waves = fine.wavy_bearing.features
    assert {one.race for one in waves} == {"inner", "outer"} and len(waves) == 2 * 331
    assert max(one.waves for one in waves) == int(6000.0 / (30.0 * (1.0 - fine.bearing.orders.ftf_order)))
    assert all(one.amplitude == 1e-7 / one.waves for one in waves)
    assert len(coarse.wavy_bearing.features) == 2 * 165
    assert waves[0].phase != other.wavy_bearing.features[0].phase
    assert case(waviness=0.0).wavy_bearing.features == fine.bearing.features == ()
    assert fine.columns()["fault_type"] == "normal" and fine.columns()["waviness_um"] == pytest.approx(0.1)


def test_dataset_of_parquet(files, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    records = [read(path) for path in files[2]]
    folder = write_dataset(records, tmp_path / "synthetic")
    rows = parquet.read_table(folder / "metadata.parquet").to_pylist()
    for record, row in zip(records, rows, strict=True):
        table = parquet.ParquetFile(folder / "signals" / row["signal_file"]).read_row_group(
            row["signal_row_group"]
        )
        assert table["signal_id"][row["signal_row"]].as_py() == row["signal_id"]
        assert np.array_equal(np.float32(table["signal"][row["signal_row"]].as_py()), record.signal)
        assert row["dataset"] == "synthetic" and None not in row.values()
        assert row["bpfo"] == record.columns["bpfo_order"] and "bpfo_order" not in row  # orders in that layout
    with pytest.raises(InputError, match="new or empty"):
        write_dataset(records, folder)


def test_without_pyarrow_one_line(files, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    with pytest.raises(InputError, match=r"pip install 'ehlcontact\[records\]'"):
        write_dataset([read(files[2][0])], tmp_path / "synthetic")


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"label": "a/b"}, "label"),
        ({"label": 3}, "label = 3: must be text"),
        ({"load": (0.0,)}, "load"),
        ({"load": (0.0, 1.0, 2.0, 3.0)}, "two or three"),
        ({"noise": -1.0}, "noise"),
        ({"waviness": 0.1}, "waviness = 0.1"),
        ({"rate": 1000.0}, "8 samples per ball passage"),
        ({"seconds": np.nan}, "seconds"),
        ({"seconds": 1e-3}, "seconds = 0.001: must be at least 0.0093 s, a ball passage"),
        ({"rate": 5000.0}, "path.hz = 2700.0: must be at most 2500 Hz, half the rate"),
        ({"path": 3.0}, "ModalPath"),
    ],
)
def test_bad_input_is_one_line(changes, word):
    with pytest.raises(InputError, match=word) as caught:
        case(**changes)
    assert "\n" not in str(caught.value)


@pytest.mark.long
def test_steps_of_low_rates_are_as_short_as_those_of_high_ones():
    """A record at 4 kHz is that of steps four times as short; with 4 steps per sample it was a quarter off."""
    path = ModalPath(hz=1500.0, damping=0.05, mass=3.0)
    spall = Spall(race="outer", angle=-np.pi / 2.0, length=1.8e-4, depth=5e-5)
    bearing = BallBearing.catalogue("6205", clearance=8e-6, oil=OIL, features=[spall])
    slow = case(bearing=bearing, path=path, rate=4000.0, noise=0.0, seconds=0.2)
    assert slow.steps_per_sample == 12 and case("outer").steps_per_sample == case().steps_per_sample == 4
    assert case("outer", speed_rpm=6000.0).steps_per_sample > 8
    run = simulate_rotor(slow.rotor(), speed_rpm=slow.speed_rpm, dt=1.0 / 192_000.0, until=0.31)
    finer = housing_acceleration(run, path, 4000.0)[400:1200]
    found = make_record(slow).signal
    assert np.std(found - finer) < 0.03 * np.std(finer)
    assert run.reservation == ""
    coarse = simulate_rotor(slow.rotor(), speed_rpm=slow.speed_rpm, dt=5e-4, until=0.1)
    assert "Spall(length=0.00018) of bearing 0" in coarse.reservation and "dt <= " in repr(coarse)
    wavy = replace(bearing, features=[RaceWaviness(race="inner", waves=500, amplitude=1e-7)])
    coarse = simulate_rotor(replace(slow, bearing=wavy).rotor(), speed_rpm=1800.0, dt=1e-4, until=0.1)
    assert "RaceWaviness(waves=500) of bearing 0" in coarse.reservation


def test_no_cases(tmp_path):
    with pytest.raises(InputError, match="at least one"):
        make_records([], tmp_path)


@pytest.mark.slow  # ten seconds of a bearing, in less than a minute of one core
def test_cost_of_ten_seconds():
    make_record(case("outer"))  # compiles
    for one in (case("outer", seconds=10.0), replace(case("outer", seconds=10.0), load=(0.0, -100.0, 100.0))):
        begun = time.process_time()
        assert make_record(one).signal.size == 120_000
        assert time.process_time() - begun < 60.0


@pytest.mark.slow  # a hundred records
def test_a_hundred_records_on_two_workers(tmp_path):
    cases = [case(race, seconds=0.3, seed=k) for k in range(34) for race in (None, "inner", "outer")][:100]

    def stop(done, _):
        if done == 40:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make_records(cases, tmp_path, processes=2, progress=stop)
    kept = len(list(tmp_path.glob("*.h5")))
    assert kept == 40
    seen = []
    assert len(make_records(cases, tmp_path, processes=2, progress=lambda *n: seen.append(n))) == 100
    assert seen[0] == (41, 100) and seen[-1] == (100, 100)


def test_a_case_without_balance_leaves_the_others(tmp_path, monkeypatch):
    """All others are made first, and the message names it."""

    def make(one):
        if one.label == "outer":
            raise ConvergenceError("a ball finds none", None)
        return VibrationRecord(signal=np.ones(6000, np.float32), rate=one.rate, columns=one.columns())

    @contextmanager
    def threads(*_, **__):
        with ThreadPoolExecutor(1) as executor:
            yield executor

    monkeypatch.setattr("reduced_models.signals.records.make_record", make)
    monkeypatch.setattr("reduced_models.signals.records.executor_for", threads)
    with pytest.raises(ConvergenceError, match=r"1 of 3 records were not made, as outer-.*: a ball finds none"):
        make_records([case("outer"), case(), case("inner")], tmp_path)
    assert sorted(path.name.split("-")[0] for path in tmp_path.iterdir()) == ["healthy", "inner"]
