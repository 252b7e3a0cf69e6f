"""Warnings of a lead that does not fit the master: all loops of `examples/studies/wrong_leads.py`, and others."""

import sys
from pathlib import Path
from runpy import run_path

import fmpy
import numpy as np
import pytest

STUDIES = Path(__file__).parents[2] / "examples" / "studies"
DEFAULT = 1.5


@pytest.fixture(scope="module")
def study():
    sys.path.insert(0, str(STUDIES))  # it imports another study
    try:
        return run_path(str(STUDIES / "wrong_leads.py"))
    finally:
        sys.path.remove(str(STUDIES))


@pytest.fixture(scope="module")
def benches(study, tmp_path_factory):
    return {kind: study["Bench"](kind, tmp_path_factory.mktemp(kind)) for kind in ("contact", "6205")}


MASTERS = [
    ("parallel", "exact", "1.5"),
    ("parallel", "symplectic Euler", "1"),
    ("serial", "exact", "0.5"),
    ("serial", "symplectic Euler", "0"),
    ("rollback", "RK4", "0"),
]


def check_loop(study, bench, master, h, forced):
    """The default lead is named where it is wrong, and the lead that fits never."""
    *how, right = master
    for lead in {float(right), DEFAULT}:
        _, log = bench.run(*how, h, lead, forced, study["WATCHED"])
        assert study["named"](log) == (None if lead == float(right) else right), (lead, log)
        assert len(log) == (0 if lead == float(right) else 1)  # once


@pytest.mark.parametrize("forced", [False, True])
@pytest.mark.parametrize("master", MASTERS)
def test_a_wrong_lead_is_named(study, benches, master, forced):
    check_loop(study, benches["contact"], master, 1e-5, forced)


@pytest.mark.long
@pytest.mark.parametrize("forced", [False, True])
@pytest.mark.parametrize("h", [1e-6, 1e-5, 3e-5])
@pytest.mark.parametrize("kind", ["contact", "6205"])
@pytest.mark.parametrize("master", MASTERS)
def test_all_loops(study, benches, master, kind, h, forced):
    check_loop(study, benches[kind], master, h, forced)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["contact", "6205"])
def test_the_lead_that_is_named_keeps_the_damping(study, benches, kind):
    bench = benches[kind]
    wanted = bench.decrement("rollback", "RK4", 1e-5, 0.0, False)
    for *how, right in MASTERS:
        assert bench.decrement(*how, 1e-5, float(right), False) == pytest.approx(wanted, rel=0.005)
        if float(right) != DEFAULT:
            assert bench.decrement(*how, 1e-5, DEFAULT, False) > 5.0 * wanted


def wrong(log):
    """What is logged of leads."""
    return [line for line in log if "lead must be" in line]


def loop(bench, step, lead, steps=2000, h=1e-5):
    """Log of a loop: ``step(t, u, v, held)`` returns the motion, and what the FMU is given of it."""
    log = []
    unit = bench.started(lead, 3e-5, log)
    u, v = bench.rest, 3e-5
    for k in range(steps):
        u, v, given = step(k * h, u, v, bench._held(unit))
        unit.setReal(bench._motion, given)
        unit.doStep(k * h, h)
    unit.freeInstance()
    return log


@pytest.fixture
def bench(benches):
    return benches["contact"]


@pytest.mark.parametrize("others", ["noise", "damper", "spring", "two"])
def test_other_forces_on_the_mass_are_no_wrong_lead(bench, others):
    """Of a parallel master and a mass that holds the force; a damper of stiffness times step is a step of lead."""
    rng, h, m = np.random.default_rng(1), 1e-5, 5.0
    K, w = m * bench.omega**2, bench.omega

    def pull(t, u, v):
        other = {
            "noise": 20.0 * rng.standard_normal(),
            "damper": -0.9 * K * h * v,
            "spring": -0.5 * K * (u - bench.rest) - 30.0 * v,
            "two": 20.0 * np.sin(0.4 * w * t) + 30.0 * np.sin(1.3 * w * t + 1.0),
        }
        return bench.load + other[others]

    def step(t, u, v, held):
        a = (pull(t, u, v) + held) / m
        return u + h * (v + 0.5 * h * a), v + h * a, (u, v)

    assert wrong(loop(bench, step, DEFAULT)) == []


@pytest.mark.parametrize("motion", ["still", "sine", "two", "noisy", "rounded"])
@pytest.mark.parametrize("lead", [1.0, DEFAULT])
def test_a_motion_that_is_played_has_no_master(bench, motion, lead):
    rng, w = np.random.default_rng(2), 2.0 * np.pi * 700.0

    def step(t, u, v, held):
        size = {"still": 0.0, "noisy": 1e-7, "rounded": 1e-7}.get(motion, 1e-7)
        u, v = size * np.sin(w * t), size * w * np.cos(w * t)
        if motion == "two":
            u, v = u + 1e-8 * np.cos(2.3 * w * t), v - 2.3e-8 * w * np.sin(2.3 * w * t)
        if motion == "noisy":
            v += 0.02 * size * w * rng.standard_normal()
        if motion == "rounded":
            u, v = round(u, 11), round(v, 8)
        return u, v, (bench.rest + u, v)

    assert wrong(loop(bench, step, lead)) == []


@pytest.mark.parametrize("others", ["ramp", "pulse"])
@pytest.mark.parametrize("h", [1e-6, 1e-5])
def test_a_load_that_grows_or_jumps_hides_no_wrong_lead(bench, others, h):
    """In a serial master whose mass holds the force."""

    def step(t, u, v, held):
        other = {"ramp": 50.0 * t / (1000.0 * h), "pulse": 50.0 * (t > 1000.0 * h)}
        a = (bench.load + other[others] + held) / 5.0
        u, v = u + h * (v + 0.5 * h * a), v + h * a
        return u, v, (u, v)

    (line,) = wrong(loop(bench, step, DEFAULT, h=h))
    assert "lead must be 0.5, with 1.5" in line


@pytest.mark.parametrize("rate", ["predicted", "of before", "of the middle"])
@pytest.mark.parametrize("h", [1e-5, 3e-5])
def test_velocity_verlet_needs_no_lead(bench, rate, h):
    """Whichever rate it gives with the new place."""
    for lead in (0.0, 0.5, DEFAULT):
        log = []
        unit = bench.started(lead, 3e-5, log)
        u, v = bench.rest, 3e-5
        a = (bench.load + bench._held(unit)) / 5.0
        for k in range(300):
            u += h * (v + 0.5 * h * a)
            given = v + {"predicted": 1.0, "of before": 0.0, "of the middle": 0.5}[rate] * h * a
            unit.setReal(bench._motion, [u, given])
            unit.doStep(k * h, h)
            before, a = a, (bench.load + bench._held(unit)) / 5.0
            v += 0.5 * h * (before + a)
        unit.freeInstance()
        assert len(wrong(log)) == (lead != 0.0) and all("lead must be 0," in line for line in wrong(log))


def test_a_force_that_is_read_before_the_step_has_no_lead(bench):
    """`set`, `get`, `doStep`: any lead is right, and none is named."""
    h, log = 1e-5, []
    unit = bench.started(DEFAULT, 3e-5, log)
    u, v = bench.rest, 3e-5
    for k in range(1000):
        unit.setReal(bench._motion, [u, v])
        v += h * (bench.load + bench._held(unit)) / 5.0
        unit.doStep(k * h, h)
        u += h * v
    unit.freeInstance()
    assert log == []


def test_steps_of_any_length_are_no_wrong_lead(bench):
    rng, t, log = np.random.default_rng(3), 0.0, []
    unit = bench.started(DEFAULT, 3e-5, log)
    u, v = bench.rest, 3e-5
    for _ in range(2000):
        h = float(rng.choice([5e-6, 1e-5]))
        a = (bench.load + bench._held(unit)) / 5.0
        unit.setReal(bench._motion, [u, v])
        unit.doStep(t, h)
        u, v, t = u + h * (v + 0.5 * h * a), v + h * a, t + h
    unit.freeInstance()
    assert wrong(log) == []


def test_a_run_that_is_made_again_is_no_iteration(bench):
    """From a state that was saved, with another force: a master that looks for a setting."""
    h, log = 1e-5, []
    unit = bench.started(DEFAULT, 3e-5, log)
    state = unit.getFMUState()
    for part in range(20):
        unit.setFMUState(state)
        u, v = bench.rest, 3e-5
        for k in range(40):
            a = ((1.0 + 1e-3 * part) * bench.load + bench._held(unit)) / 5.0
            unit.setReal(bench._motion, [u, v])
            unit.doStep(k * h, h)
            u, v = u + h * (v + 0.5 * h * a), v + h * a
    unit.freeFMUState(state)
    unit.freeInstance()
    assert log == []


@pytest.mark.parametrize("h", [1e-4, 1.2e-4])
def test_a_free_decay_in_long_steps_is_told(study, bench, h):
    """w h = 0.54 and 0.65: the vibration is gone, or does not end, before three blocks of 64 steps have."""
    _, log = bench.run("parallel", "exact", h, DEFAULT, False, 200)
    assert sum("steps are too long" in line for line in log) == 1


@pytest.mark.parametrize("kind", ["contact", "6205"])
@pytest.mark.parametrize("rates", [True, False])
def test_a_record_that_fmpy_plays(benches, kind, rates, tmp_path):
    """A displacement whose rate is not set is told of; with its rate nothing is."""
    bench, h, w = benches[kind], 5e-6, 2e3 * np.pi
    place, rate = ("approach", "rate") if kind == "contact" else ("y", "velocity_y")
    t = h * np.arange(600)
    size = 0.02 * abs(bench.rest)
    columns = [(place, bench.rest + size * np.sin(w * t)), (rate, size * w * np.cos(w * t))][: 1 + rates]
    record = np.zeros(t.size, dtype=[("time", float), *((name, float) for name, _ in columns)])
    record["time"] = t
    for name, values in columns:
        record[name] = values
    log = []
    fmpy.simulate_fmu(
        bench._folder, stop_time=t[-1], output_interval=h, input=record, fmi_type="CoSimulation",
        start_values={place: bench.rest, "lead": 1.0, **bench.more},
        debug_logging=True, logger=lambda *said: log.append(str(said[-1])),
    )  # fmt: skip
    told = [line for line in log if f"{place} does not change as {rate} says: set both" in line]
    assert len(log) == len(told) == (0 if rates else 1)
