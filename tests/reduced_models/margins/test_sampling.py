"""`uncertainty`: a closed function, machines, what fails, what is kept, on workers, and held-out machines."""

from dataclasses import replace

import numpy as np
import pytest
from held_out import INPUTS, motor

from ehlcontact import ConvergenceError, InputError
from reduced_models import uncertainty
from reduced_models.margins.samples import Sample, matched

CALLS = []


def pendulum(length, mass):
    CALLS.append((length, mass))
    if mass > 1.9:
        raise ConvergenceError(f"no place of rest at {mass:g} kg", None)
    return {
        "hz": (9.81 / length) ** 0.5 / (2.0 * np.pi),
        "weight": 9.81 * mass,
        "heavy": mass if mass > 1.5 else None,
    }


LENGTHS = {"length": (0.5, 1.5), "mass": (1.0, 2.0)}


@pytest.fixture(autouse=True)
def fresh():
    CALLS.clear()


def test_a_closed_function():
    found = uncertainty(pendulum, {"length": (0.5, 1.5), "mass": (1.0, 1.8)}, samples=256)
    hz = found.interval("hz")
    exact = [(9.81 / (1.5 - share)) ** 0.5 / (2.0 * np.pi) for share in (0.025, 0.5, 0.975)]
    assert (hz.low, hz.median, hz.high) == pytest.approx(exact, rel=0.01)
    assert hz.low_ends[0] <= exact[0] <= hz.low_ends[1] and hz.high_ends[0] <= exact[2] <= hz.high_ends[1]
    assert found.influence("hz").correlation[0] == pytest.approx(-1.0, abs=1e-12)
    assert found.moved_by("weight") == "mass +1.00" and not found.remarks
    assert found.nominal["hz"] == pytest.approx((9.81 / 1.0) ** 0.5 / (2.0 * np.pi), rel=1e-12)
    assert str(found).startswith("Uncertainty: 256 samples of 2 inputs, seed 0\n  hz 0.498, 95 % ")
    with pytest.raises(InputError, match="one of hz, weight, heavy"):
        found.interval("kHz")


def test_a_nominal_value_outside_of_the_range():
    found = uncertainty(pendulum, {"length": (0.5, 1.5), "mass": (1.0, 1.8)}, samples=64)
    found = replace(found, nominal=pendulum(2.0, 1.4))
    assert found.remarks == ["the nominal value lies outside of the range: hz"]


def test_failures_are_counted_and_named():
    found = uncertainty(pendulum, LENGTHS, samples=128)
    failed = found.values[:, 1] > 1.9
    assert 8 <= failed.sum() <= 18 and found.to_dict()["failed"] == failed.sum()
    (remark,) = found.remarks
    first = int(np.flatnonzero(failed)[0])
    assert remark.startswith(
        f"{failed.sum()} of 128 samples have no answer, and are in no interval, as number {first + 1}"
    )
    assert f"mass {found.values[first, 1]:.4g}): no place of rest at" in remark
    assert found.interval("hz").known == 128 - failed.sum()
    assert found.interval("heavy").known == ((found.values[:, 1] > 1.5) & ~failed).sum()
    assert np.isnan(found.columns()["hz"][failed]).all()


def test_interrupted_and_resumed(tmp_path):
    """What was made is kept; the same call makes the rest, and the same answer as without interruption."""

    def interrupt(done, of):
        if done == 10:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        uncertainty(pendulum, LENGTHS, samples=32, folder=tmp_path / "kept", progress=interrupt)
    assert len(CALLS) == 10
    CALLS.clear()
    found = uncertainty(pendulum, LENGTHS, samples=32, folder=tmp_path / "kept")
    assert len(CALLS) == 33 - 10  # of these one is with inputs at their medians
    CALLS.clear()
    more = uncertainty(pendulum, LENGTHS, samples=40, folder=tmp_path / "kept")
    assert len(CALLS) == 8
    assert uncertainty(pendulum, LENGTHS, samples=32).to_dict() == found.to_dict()
    np.testing.assert_array_equal(more.values[:32], found.values)


@pytest.mark.long
def test_on_workers(tmp_path, monkeypatch):
    """As in this process; a function that workers cannot find is refused."""
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=":")
    (tmp_path / "swinging.py").write_text("def swing(length):\n    return {'hz': length ** -0.5}\n")
    monkeypatch.syspath_prepend(tmp_path)
    from swinging import swing

    found = uncertainty(swing, {"length": (0.5, 1.5)}, samples=8, processes=2)
    assert found.to_dict() == uncertainty(swing, {"length": (0.5, 1.5)}, samples=8).to_dict()
    with pytest.raises(InputError, match="a function of a module that can be imported, or processes = 1"):
        uncertainty(lambda length: {"hz": length}, {"length": (0.5, 1.5)}, samples=8, processes=2)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"samples": 7}, "samples = 7: must be a whole number >= 8"),
        ({"seed": -1}, "seed = -1"),
        ({"inputs": {}}, "inputs = {}: must be at least one"),
        ({"inputs": {"length": (2.0, 1.0)}}, r"inputs\['length'\] = .*: must be a low end below the high one"),
        ({"build": 5}, "build = 5: must be a function of the inputs"),
        ({"processes": 0}, "processes = 0"),
    ],
)
def test_mistakes(change, words):
    call = {"build": pendulum, "inputs": LENGTHS, "samples": 8} | change
    with pytest.raises(InputError, match=words):
        uncertainty(call.pop("build"), call.pop("inputs"), **call)


def test_critical_speeds_are_told_apart_by_their_modes():
    """By ratio of speeds and whirl; a machine that has one fewer leaves that of the missing mode empty."""
    nominal = Sample([], {"critical_rpm": 3000.0}, [[1000.0, 0.01, 0.0], [3000.0, 0.02, 1.0]])
    moved = Sample([1.0], {}, [[1400.0, 0.01, 0.0], [2600.0, 0.02, 1.0]])
    one = Sample([2.0], {}, [[3300.0, 0.03, 1.0]])
    rows, own = matched([moved, one], nominal)
    assert own["critical_rpm"] == 1000.0 and own["critical_rpm_2"] == 3000.0
    assert rows[0]["critical_rpm"] == 1400.0 and rows[0]["critical_damping_2"] == 0.02
    assert rows[1]["critical_rpm"] is None and rows[1]["critical_rpm_2"] == 3300.0


@pytest.mark.long
def test_a_machine(tmp_path):
    """Clearance, oil and unbalance of a motor: what moves what, by physics; and its picture."""
    found = uncertainty(motor, INPUTS, samples=16)
    assert found.drawn[:4] == ("critical_rpm", "critical_damping", "peak", "response")
    lam, response = found.influence("lambda"), found.influence("response")
    temperature, grade = (list(INPUTS).index(name) for name in ("temperature", "grade"))
    assert lam.correlation[temperature] < -0.9 and response.correlation[grade] > 0.8
    interval = found.interval("critical_rpm")
    assert interval.low < found.nominal["critical_rpm"] < interval.high < 1.1 * interval.low
    assert found.between("critical_rpm").startswith("88 % 15")
    assert not any(found.failures)
    found.plot(tmp_path / "tornado.png")
    assert (tmp_path / "tornado.png").stat().st_size > 20_000


@pytest.mark.long
def test_intervals_contain_held_out_machines():
    """Intervals of 200 samples contain 90 to 99 % of 200 machines drawn at random, for every number."""
    found = uncertainty(motor, INPUTS, samples=200)
    rng = np.random.default_rng(7)
    values = {name: one.rvs(200, random_state=rng) for name, one in INPUTS.items()}
    held = [motor(**{name: column[k] for name, column in values.items()}).numbers for k in range(200)]
    for name, interval, _ in found.rows:
        own = np.array([one[name] for one in held], float)
        inside = np.mean((own >= interval.low) & (own <= interval.high))
        assert 0.90 <= inside <= 0.99, (name, inside)
