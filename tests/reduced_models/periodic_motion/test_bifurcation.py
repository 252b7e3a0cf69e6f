"""Bifurcations between answers of a branch and in sweeps by runs; Poincare sections; mean bearings of steps."""

from dataclasses import replace

import numpy as np
import passage_rotor
import pytest

from ehlcontact import read, save
from ehlcontact.errors import InputError
from ehlcontact.status import Status
from reduced_models import BallBearing, Disc, Shaft, Support, rotor_on_bearings, simulate_rotor
from reduced_models.periodic_motion.bifurcation import bifurcation_diagram, poincare, repeats_after
from reduced_models.periodic_motion.floquet import bifurcations
from reduced_models.periodic_motion.periodic import periodic, periodic_answer
from reduced_models.periodic_motion.shooting import shoot


@pytest.fixture(scope="module")
def rotor():
    return passage_rotor.rotor()


@pytest.fixture(scope="module")
def answer(rotor):
    return shoot(rotor, passage_rotor.speed_rpm(500.0), "passage", steps=64)


def branch_of(answer, values, multipliers):
    """Answers at these values with these multipliers."""
    rows = zip(values, multipliers, strict=True)
    return [replace(answer, value=value, multipliers=np.array(row, complex)) for value, row in rows]


def test_fold(answer):
    values, large = [0.0, 1.0, 1.5, 1.0, 0.0], [0.8, 0.9, 0.99, 1.1, 1.2]
    (found,) = bifurcations(branch_of(answer, values, [[one] for one in large]))
    assert (found.kind, found.after) == ("fold", 2)
    assert found.value == pytest.approx(1.5)


def test_branch_point(answer):
    (found,) = bifurcations(branch_of(answer, [0.0, 1.0, 2.0], [[0.8], [0.9], [1.1]]))
    assert (found.kind, found.after, found.value) == ("branch point", 1, pytest.approx(1.5))


def test_period_doubling_and_neimark_sacker(answer):
    rows = [[-0.9, 0.5], [-1.1, 0.5], [-1.2, 0.5], [0.3, 0.95j, -0.95j], [0.3, 1.05j, -1.05j]]
    found = bifurcations(branch_of(answer, [0.0, 1.0, 2.0, 3.0, 4.0], rows))
    assert [one.kind for one in found] == ["period doubling", "period doubling", "Neimark-Sacker"]
    assert [one.value for one in found][::2] == pytest.approx([0.5, 3.5])


def test_a_pair_that_comes_apart_outside_is_no_bifurcation(answer):
    assert bifurcations(branch_of(answer, [0.0, 1.0], [[1.1 + 0.1j, 1.1 - 0.1j], [1.05, 1.2]])) == ()


def test_bifurcations_need_multipliers(answer):
    with pytest.raises(InputError, match="multipliers"):
        bifurcations([answer, answer])
    with pytest.raises(InputError, match="multipliers"):
        answer.picture()


@pytest.mark.long
def test_branch_through_both_folds(rotor, tmp_path):
    ends = passage_rotor.speed_rpm(490.0), passage_rotor.speed_rpm(513.0)
    branch = periodic(rotor, between=ends, excitation="passage", harmonics=16).with_multipliers(4, steps=128)
    folds = [one.value for one in branch.bifurcations() if one.kind == "fold"]
    assert folds == pytest.approx([passage_rotor.speed_rpm(one) for one in (510.51, 493.80)], rel=1e-4)
    stable = branch.stable
    assert stable[0] == stable[-1] == 1.0
    middle = stable[branch.folds[0] + 4 : branch.folds[1] - 3]
    assert middle.size and (middle == 0.0).all()
    branch.plot(tmp_path / "branch.png")
    branch.answers[0].plot(tmp_path / "multipliers.png")
    assert all((tmp_path / name).stat().st_size for name in ("branch.png", "multipliers.png"))


@pytest.mark.long
@pytest.mark.parametrize(
    ("start", "values", "fold"),
    [
        (passage_rotor.SMALL, (500.0, 505.0, 508.0, 509.5, 510.2, 510.45, 510.56), 510.51),
        (passage_rotor.LARGE, (500.0, 497.0, 495.0, 494.2, 493.85, 493.75), 493.80),
    ],
    ids=["rising", "falling"],
)
def test_sweeps_jump_at_folds(rotor, start, values, fold):
    """By runs, each from the end of the one before it."""
    speeds = [passage_rotor.speed_rpm(value) for value in values]
    found = bifurcation_diagram(rotor, speeds, start=start, settle=250, periods=4, steps=512)
    ((before, after),) = found.jumps(0.15)
    assert sorted([before, after])[0] < passage_rotor.speed_rpm(fold) < sorted([before, after])[1]


@pytest.mark.long
def test_period_doubling_in_a_sweep(rotor, tmp_path):
    speeds = [passage_rotor.speed_rpm(value) for value in (394.0, 402.0, 405.0, 412.0)]
    found = bifurcation_diagram(rotor, speeds, settle=200, periods=8, steps=128)
    assert found.periods.tolist() == [1, 2, 2, 1]
    size = found.peak_to_peak.max(axis=1)
    assert (np.abs(np.diff(size)) > 0.1 * size[1:]).any() and found.jumps() == ()  # steep, and no jump
    twice = shoot(rotor, speeds[1], "passage", periods=2, settle=75, steps=128)
    sampled = np.ptp(twice.run.displacement, axis=0)
    assert found.peak_to_peak[1] == pytest.approx(sampled, rel=1e-3, abs=0.0)
    found.plot(tmp_path / "diagram.png")
    save(found, tmp_path / "diagram.h5")
    assert (read(tmp_path / "diagram.h5").samples == found.samples).all()


def test_a_diagram_is_kept_after_ctrl_c(rotor):
    def stop(made, values):
        if made == 2:
            raise KeyboardInterrupt

    speeds = [passage_rotor.speed_rpm(value) for value in (500.0, 501.0, 502.0)]
    found = bifurcation_diagram(rotor, speeds, settle=2, periods=2, steps=32, callback=stop)
    assert (found.status, found.value.tolist()) == (Status.INTERRUPTED, speeds[:2])


def test_samples_repeat_after_their_period():
    once, twice = np.ones((8, 1)), np.array([[0.0], [1.0]] * 4)
    assert (repeats_after(once, 1.0), repeats_after(twice, 1.0)) == (1, 2)
    assert repeats_after(np.random.default_rng(0).standard_normal((16, 1)), 1.0) == 0


def test_section_of_a_run(rotor, tmp_path):
    """Between steps too: of a run whose steps do not divide the period."""
    speed = passage_rotor.speed_rpm(500.0)
    period = 1.0 / rotor.ball_bearings[0].ball_bearing.frequencies(speed).bpfo
    run = simulate_rotor(rotor, speed_rpm=speed, dt=period / 100.3, until=150.0 * period)
    section = poincare(run, period, first=140.0 * period)
    assert section.t == pytest.approx(period * np.arange(140, 151), rel=1e-9)
    size = np.ptp(run.displacement[-1000:], axis=0).max()
    assert np.abs(np.diff(section.displacement, axis=0)).max() < 1e-3 * size
    slope = np.gradient(run.displacement[:, 1], run.t)
    expected = np.interp(section.t, run.t, slope)[:-1]  # a gradient has one side at the end of the run
    assert section.velocity[:-1, 1] == pytest.approx(expected, rel=0.01, abs=0.0)
    section.plot(tmp_path / "section.png")
    with pytest.raises(InputError, match="period"):
        poincare(run, 1e3)


@pytest.mark.long
def test_mean_bearing_of_steps_is_that_of_harmonic_balance(oil):
    bearing = BallBearing.catalogue("6305", oil=oil, clearance=1e-5)
    motor = rotor_on_bearings(
        Shaft(length=0.2, diameter=0.025, elements=2),
        supports=[Support(position=0.0, bearing=bearing), Support(position=0.2, bearing=bearing)],
        discs=[Disc(position=0.1, mass=6.0, unbalance=5e-6)],
    )
    balance = periodic_answer(motor, 3000.0)
    steps = shoot(motor, 3000.0, steps=512)
    disc = list(motor.nodes["disc"].values())[:2]
    assert steps.peak_to_peak[disc] == pytest.approx(balance.peak_to_peak[disc], rel=2e-3, abs=0.0)
    assert steps.run.columns == balance.run.columns
    assert steps.run.force.mean(axis=0)[1] == pytest.approx(balance.run.force.mean(axis=0)[1], rel=1e-3)
    assert steps.run.largest_load == pytest.approx(balance.run.largest_load, rel=1e-2)
