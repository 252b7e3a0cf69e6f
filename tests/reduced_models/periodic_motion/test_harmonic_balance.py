"""Harmonic balance and its branches: against independent solutions and time steps; what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from ehlcontact import Lubricant
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models import (
    BallBearing,
    BearingMount,
    LinearBearing,
    Rotor,
    Unbalance,
    linearise,
    shoot,
    simulate_rotor,
)
from reduced_models.periodic_motion.excitation import PeriodicForce
from reduced_models.periodic_motion.floquet import with_multipliers
from reduced_models.periodic_motion.periodic import TooFewHarmonicsWarning, periodic, periodic_answer
from tests import duffing_rotor, passage_rotor

MICRO = 1e6


def speed_to_passage(rpm):
    """Passages of balls [rad/s] at a speed of the shaft."""
    return rpm / passage_rotor.speed_rpm(1.0)


@pytest.fixture(scope="module")
def branch():
    """Of the rotor of machine.md section 3, from 520 rad/s down through both folds."""
    ends = tuple(passage_rotor.speed_rpm(w) for w in (520.0, 488.0))
    return periodic(passage_rotor.rotor(), between=ends, excitation="passage", harmonics=20, samples=256)


@pytest.mark.long
def test_folds_of_ball_passage(branch):
    """Literature: RK4 sweeps of an independent program, machine.md section 3, within .05 rad/s."""
    assert branch.status is Status.CONVERGED
    assert speed_to_passage(branch.fold_values) == pytest.approx([493.80, 510.51], abs=0.05)
    assert speed_to_passage(np.array(branch.multiple())) == pytest.approx(np.array([[493.80, 510.51]]), abs=0.05)
    assert "several answers between" in repr(branch)


@pytest.mark.long
def test_three_answers_at_one_speed(branch):
    """Literature: that program: the stable answers at 500 rad/s, and the unstable one between them."""
    answers = branch.at(passage_rotor.speed_rpm(500.0))
    sizes = MICRO * np.array([answer.peak_to_peak for answer in answers])
    assert sizes[[0, 2]] == pytest.approx(np.array([[0.874, 4.081], [0.496, 4.493]]), rel=1e-3)
    assert sizes[1] == pytest.approx([1.59, 6.06], abs=0.005)  # to the digits that there are
    assert len(answers) == 3


@pytest.mark.long
@pytest.mark.parametrize("between", [(3000.0, 24000.0), (24000.0, 3000.0)])
def test_folds_are_those_of_either_direction(between):
    """From a large orbit and from a small one; an independent program has four orbits' folds there."""
    rotor = replace(
        passage_rotor.rotor(clearance=-4e-6), mass=15.0 * np.eye(2), load=np.array([147.0, 0.0]),
        unbalances=(Unbalance(x=0, y=1, amount=4e-5),),
    )  # fmt: skip
    branch = periodic(rotor, "speed", between=between)
    assert branch.value[[0, -1]] == pytest.approx(between, rel=1e-12)
    assert len(branch.folds) == 4


def test_answer_to_ball_passage_is_that_of_time_steps():
    """From the answer on, steps of second order stay on it, but for their error."""
    rotor = passage_rotor.rotor()
    speed = passage_rotor.speed_rpm(560.0)
    answer = periodic_answer(rotor, speed, excitation="passage", harmonics=20)
    start = answer.run.displacement[0], answer.run.velocity[0]
    steps = 512
    run = simulate_rotor(
        rotor, speed_rpm=speed, dt=answer.period / steps, until=2.0 * answer.period, start=start, rho_inf=1.0
    )
    last = np.ptp(run.displacement[-steps - 1 :], axis=0)
    assert last == pytest.approx(answer.peak_to_peak, rel=5e-4, abs=0.0)


@pytest.mark.long
@pytest.mark.parametrize("five", [False, True])
def test_films_in_place_of_damping_against_long_runs(five):
    """Film memory damps: a run settles on the answer, or stays on it where the tilts settle slowly."""
    oiled = replace(passage_rotor.bearing(), oil=Lubricant(eta0=0.03, alpha=2e-8))
    speed = passage_rotor.speed_rpm(560.0)
    if five:
        places = {"z": 2, "tilt_x": 3, "tilt_y": 4}
        mass, load = np.diag([20.0, 20.0, 20.0, 0.02, 0.02]), [196.0, 0.0, 5.0, 0.0, 0.0]
    else:
        places, mass, load = {}, 20.0 * np.eye(2), [196.0, 0.0]
    mount = BearingMount(bearing=oiled, x=0, y=1, cage_angle=0.0, **places)
    rotor = Rotor(mass=mass, stiffness=np.zeros_like(mass), load=load, mounts=(mount,))
    answer = periodic_answer(rotor, speed, excitation="passage", harmonics=16)
    steps, periods = 256, 10 if five else 200
    start = (answer.run.displacement[0], answer.run.velocity[0]) if five else "static"
    until = periods * answer.period
    run = simulate_rotor(rotor, speed_rpm=speed, dt=answer.period / steps, until=until, start=start, rho_inf=1.0)
    assert np.ptp(run.displacement[-steps - 1 :], axis=0) == pytest.approx(answer.peak_to_peak, rel=5e-3, abs=0.0)


@pytest.mark.long
def test_period_doubling_by_both_ways():
    """Between 397 and 408 rad/s answers of one passage are unstable; those of two end where they shrink to one."""
    rotor, speed = passage_rotor.rotor(), passage_rotor.speed_rpm(402.0)
    once = with_multipliers(rotor, periodic_answer(rotor, speed, excitation="passage", harmonics=20), count=2)
    assert once.multipliers[0].real < -1.05 and not once.stable
    steps = 512
    run = simulate_rotor(rotor, speed_rpm=speed, dt=once.period / steps, until=200.0 * once.period)
    start = run.displacement[-1], run.velocity[-1]  # after whole passages
    shot = shoot(rotor, speed, excitation="passage", periods=2, start=start, steps=steps)
    twice = periodic_answer(rotor, speed, excitation="passage", periods=2, start=shot, harmonics=40)
    assert twice.peak_to_peak == pytest.approx(shot.peak_to_peak, rel=5e-3, abs=0.0)
    assert np.abs(twice.harmonics[1]).max() > 0.1e-6  # half of the frequency of the passage
    ends = speed, passage_rotor.speed_rpm(412.0)
    branch = periodic(
        rotor, between=ends, excitation="passage", periods=2, start=twice, harmonics=40, samples=256, most=60
    )
    assert speed_to_passage(branch.value[-1]) == pytest.approx(407.76, abs=0.05)
    assert np.abs(branch.answers[-1].harmonics[1]).max() < 0.02e-6
    assert not branch.folds and "at a period doubling" in branch.reservation


def gyroscopic_rotor():
    """Two directions and two tilts of a disc on a linear bearing that is not symmetric."""
    stiffness = np.diag([2e7, 3e7, 1e3, 2e3]).astype(float)
    stiffness[0, 3] = stiffness[3, 0] = 1e4
    gyroscopic = np.zeros((4, 4))
    gyroscopic[2, 3], gyroscopic[3, 2] = 0.02, -0.02
    held = LinearBearing([[4e7, 1e6], [-2e6, 5e7]], [[900.0, 0.0], [0.0, 700.0]])
    return Rotor(
        mass=np.diag([10.0, 10.0, 0.05, 0.05]), stiffness=stiffness, damping=2e-5 * stiffness,
        gyroscopic=gyroscopic, mounts=(BearingMount(bearing=held, x=0, y=1),), load=[0.0, -98.1, 0.0, 0.0],
        unbalances=(Unbalance(x=0, y=1, amount=2e-5, phase=0.4),),
    )  # fmt: skip


def test_linear_rotor_answers_as_its_unbalance_response():
    rotor, rpm = gyroscopic_rotor(), 21_000.0
    answer = periodic_answer(rotor, rpm, harmonics=3, samples=64)
    linear = linearise(rotor, rpm).unbalance_response(rpm=[rpm]).amplitude[0]
    assert answer.harmonics[1] == pytest.approx(linear, rel=1e-10, abs=1e-10 * abs(linear).max())
    assert np.abs(answer.harmonics[2:]).max() < 1e-12 * np.abs(linear).max()


@pytest.mark.parametrize(("w", "force"), [(0.9, 8.0), (1.1, 4.0), (1.03, 0.4)])
def test_duffing_against_an_independent_solution(w, force):
    rotor, omega = duffing_rotor.rotor(), w * duffing_rotor.NATURAL
    pull = PeriodicForce(amplitudes={0: force}, hz=omega / (2.0 * np.pi))
    answer = periodic_answer(rotor, 3000.0, excitation=pull, harmonics=15, samples=128)
    state = answer.run.displacement[0, 0], answer.run.velocity[0, 0]
    expected, _, x = duffing_rotor.answer(omega, force, state)
    assert state == pytest.approx(expected, rel=1e-6)
    assert answer.peak_to_peak[0] == pytest.approx(np.ptp(x), rel=2e-3)


@pytest.mark.long
def test_folds_of_duffing_have_a_multiplier_of_one():
    """The multiplier is that of an independent monodromy matrix."""
    force, hz = 0.4, duffing_rotor.NATURAL / (2.0 * np.pi)
    pull = PeriodicForce(amplitudes={0: force}, hz=hz)
    found = periodic(
        duffing_rotor.rotor(), over="frequency", between=(1.1 * hz, 0.95 * hz), excitation=pull, speed_rpm=3000.0,
        harmonics=15, samples=128,
    )  # fmt: skip
    assert len(found.folds) == 2
    for place in found.folds:
        answer = found.answers[place]
        state = answer.run.displacement[0, 0], answer.run.velocity[0, 0]
        _, monodromy, _ = duffing_rotor.answer(answer.omega, force, state)
        multipliers = np.linalg.eigvals(monodromy)
        assert np.abs(multipliers - 1.0).min() < 1e-4


def test_unbalance_of_a_mean_bearing_is_linear_where_it_is_small():
    """Of bearings over a ball passage, as in linear answers."""
    held = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    rotor = Rotor(
        mass=20.0 * np.eye(2), stiffness=np.zeros((2, 2)), load=[0.0, -500.0],
        mounts=(BearingMount(bearing=held, x=0, y=1),), unbalances=(Unbalance(x=0, y=1, amount=1e-7),),
    )  # fmt: skip
    answer = periodic_answer(rotor, 6000.0, harmonics=3, samples=128, positions=12)
    linear = linearise(rotor, 6000.0).unbalance_response(rpm=[6000.0]).amplitude[0]
    assert np.abs(answer.harmonics[1]) == pytest.approx(np.abs(linear), rel=5e-3)
    assert "mean" in answer.reservation


def test_a_branch_over_clearance_ends_at_its_range():
    rotor, speed = passage_rotor.rotor(), passage_rotor.speed_rpm(700.0)
    options = {"excitation": "passage", "harmonics": 8, "samples": 64}
    found = periodic(rotor, over="clearance", between=(12e-6, 10e-6), speed_rpm=speed, **options)
    assert found.value[[0, -1]] == pytest.approx([12e-6, 10e-6], rel=1e-3)
    there = periodic_answer(passage_rotor.rotor(clearance=float(found.value[-1])), speed, **options)
    assert found.peak_to_peak[-1] == pytest.approx(there.peak_to_peak, rel=1e-6)


def test_a_branch_that_is_stopped_keeps_its_answers():
    def stop(share, answers):
        if answers == 4:
            raise KeyboardInterrupt

    ends = tuple(passage_rotor.speed_rpm(w) for w in (700.0, 600.0))
    options = {"excitation": "passage", "harmonics": 6, "samples": 64}
    found = periodic(passage_rotor.rotor(), between=ends, callback=stop, **options)
    assert found.status is Status.INTERRUPTED and len(found.answers) == 4
    rest = periodic(passage_rotor.rotor(), between=(found.value[-1], ends[1]), start=found.answers[-1], **options)
    assert rest.peak_to_peak[0] == pytest.approx(found.peak_to_peak[-1], rel=1e-6)


def test_too_few_harmonics_are_told():
    with pytest.warns(TooFewHarmonicsWarning, match="take more harmonics"):
        answer = periodic_answer(
            passage_rotor.rotor(), passage_rotor.speed_rpm(180.0), excitation="passage", harmonics=2, samples=64
        )
    assert answer.residual > 1e-2


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"excitation": "unbalance"}, "excitation"),
        ({"excitation": "balls"}, "one of unbalance, passage"),
        ({"between": (1000.0, 1000.0)}, "between"),
        ({"between": 1000.0}, "between"),
        ({"between": (0.0, 1000.0)}, "between"),
        ({"over": "torque"}, "over"),
        ({"over": "preload", "speed_rpm": 1000.0}, "five degrees of freedom"),
        ({"over": "amplitude", "speed_rpm": 1000.0}, "over"),
        ({"over": "frequency", "speed_rpm": 1000.0}, "PeriodicForce"),
        ({"over": "clearance", "between": (1e-5, 2e-5)}, "speed_rpm"),
        ({"over": "clearance", "between": (1.0, 10.0), "speed_rpm": 1000.0}, "given in um"),
        ({"harmonics": 0}, "harmonics"),
        ({"harmonics": 20, "samples": 64}, "at least 80"),
        ({"bearing": 1}, "bearing"),
        ({"start": 3}, "start"),
    ],
)
def test_what_has_no_periodic_answer(changes, words):
    given = {"over": "speed", "between": (1000.0, 2000.0), "excitation": "passage", **changes}
    with pytest.raises(InputError, match=words):
        periodic(passage_rotor.rotor(), **given)


def test_a_rotor_that_nothing_holds_has_no_answer():
    rotor = replace(passage_rotor.rotor(), load=np.zeros(2))
    with pytest.raises(ConvergenceError):
        periodic_answer(rotor, 1000.0, excitation="passage", harmonics=4, samples=64)
