"""Periodic answers by shooting: the rigid rotor of a benchmark, Duffing's oscillator, motors with films."""

from dataclasses import replace

import duffing_rotor
import numpy as np
import passage_rotor
import pytest

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models import (
    BallBearing,
    BearingMount,
    ContactMount,
    Disc,
    LinearBearing,
    Rotor,
    Shaft,
    Support,
    Unbalance,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
    unbalance_response,
)
from reduced_models.periodic_motion.excitation import PeriodicForce
from reduced_models.periodic_motion.floquet import with_multipliers
from reduced_models.periodic_motion.shooting import shoot
from reduced_models.periodic_motion.step_map import StepMap

SPEED = passage_rotor.speed_rpm(500.0)


@pytest.fixture(scope="module")
def rotor():
    return passage_rotor.rotor()


@pytest.fixture(scope="module")
def motor(oil):
    """Of two 6305 with films, planar."""
    bearing = BallBearing.catalogue("6305", oil=oil, clearance=1e-5)
    return rotor_on_bearings(
        Shaft(length=0.2, diameter=0.025, elements=2),
        supports=[Support(position=0.0, bearing=bearing), Support(position=0.2, bearing=bearing)],
        discs=[Disc(position=0.1, mass=6.0, unbalance=5e-6)],
    )


def test_balls_pass_at_the_frequency_of_the_benchmark(rotor):
    found = rotor.ball_bearings[0].ball_bearing.frequencies(SPEED).bpfo
    assert 2.0 * np.pi * found == pytest.approx(500.0, rel=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(
    ("start", "peak_to_peak", "multiplier"),
    [
        (passage_rotor.SMALL, (0.496, 4.493), 0.939),
        (passage_rotor.LARGE, (0.874, 4.081), 0.939),
        (passage_rotor.UNSTABLE, (1.593, 6.06), 1.288),
    ],
    ids=["small", "large", "unstable"],
)
def test_answers_of_the_benchmark(rotor, start, peak_to_peak, multiplier):
    """The figures there have three digits; of the unstable answer 1.59 and 1.29."""
    answer = shoot(rotor, SPEED, "passage", start=start, steps=2048)
    assert 1e6 * answer.peak_to_peak == pytest.approx(peak_to_peak, rel=1e-3, abs=0.0)
    answer = with_multipliers(rotor, answer, steps=2048)
    assert abs(answer.multipliers[0]) == pytest.approx(multiplier, rel=1e-3)
    assert answer.stable == (multiplier < 1.0)
    if answer.stable:
        decay = np.exp(-passage_rotor.DAMPING * answer.period / (2.0 * passage_rotor.MASS))
        assert abs(answer.multipliers[0]) == pytest.approx(decay, rel=1e-4)


@pytest.mark.long
def test_errors_of_steps_are_of_second_order(rotor):
    sizes = [shoot(rotor, SPEED, "passage", steps=steps).peak_to_peak[1] for steps in (128, 256, 512)]
    assert 3.0 < (sizes[1] - sizes[0]) / (sizes[2] - sizes[1]) < 5.0


def test_a_run_stays_on_the_answer(rotor):
    answer = shoot(rotor, SPEED, "passage", steps=128, start=passage_rotor.LARGE)
    start = answer.run.displacement[0], answer.run.velocity[0]
    run = simulate_rotor(rotor, speed_rpm=SPEED, dt=answer.run.t[1], until=30.0 * answer.period, start=start)
    last = run.displacement[-129:]
    # the first step of a run begins at rest with its bearing, which the damping forgets
    assert np.ptp(last, axis=0) == pytest.approx(answer.peak_to_peak, rel=2e-2, abs=0.0)


def test_balls_take_the_place_of_the_next_one(rotor):
    """The same state at the end of a period as at its start, ball by ball."""
    answer = shoot(rotor, SPEED, "passage", steps=64)
    steps_of = StepMap(rotor, SPEED, "passage", steps=64, start=answer)
    after = steps_of.march(steps_of.numbers, 80)
    assert np.abs((steps_of(after) - after) / steps_of.scale).max() < 1e-3
    assert steps_of.cage_left < 1e-12


@pytest.mark.long
def test_period_doubling(rotor):
    """At 400 rad/s the answer of one period is unstable, and one of two is stable."""
    speed = passage_rotor.speed_rpm(400.0)
    once = with_multipliers(rotor, shoot(rotor, speed, "passage", steps=128), steps=128)
    assert not once.stable
    assert once.multipliers[0].real < -1.0 and once.multipliers[0].imag == 0.0
    twice = shoot(rotor, speed, "passage", periods=2, steps=128, settle=75)
    assert twice.period == pytest.approx(2.0 * once.period)
    assert with_multipliers(rotor, twice, steps=128).stable
    assert twice.peak_to_peak[1] > 1.2 * once.peak_to_peak[1]
    half = twice.run.displacement[128] - twice.run.displacement[0]
    assert np.abs(half).max() > 0.05 * twice.peak_to_peak.max()


@pytest.mark.long
def test_multipliers_of_duffing():
    """Against those of the equations of variation along the same answer, by another integrator."""
    w, rotor = 1.1 * duffing_rotor.NATURAL, duffing_rotor.rotor()
    force = PeriodicForce(amplitudes={0: 1.0}, hz=w / (2.0 * np.pi))
    answer = shoot(rotor, 1000.0, force, start=([0.0], [0.0]), steps=256)
    answer = with_multipliers(rotor, answer, excitation=force, steps=256)
    start = answer.run.displacement[0, 0], answer.run.velocity[0, 0]
    state, monodromy, _ = duffing_rotor.answer(w, 1.0, start)
    assert start == pytest.approx(state, rel=2e-3, abs=0.0)
    expected = np.linalg.eigvals(monodromy)
    found = answer.multipliers[:2]
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(expected), rel=1e-3)


@pytest.mark.long
def test_unbalance_of_a_motor_with_films(motor):
    answer = with_multipliers(motor, shoot(motor, 3000.0, "unbalance", steps=64), steps=64)
    assert answer.residual < 1e-6
    assert answer.period == pytest.approx(0.02)
    assert answer.stable and "bearings are means over positions of the cage" in answer.reservation
    assert shoot(motor, 3000.0, "passage", steps=64).reservation.startswith("unbalances are left out")


@pytest.mark.long
def test_multipliers_of_a_motor_against_decay_in_time(motor):
    """Differences of two runs die away as the largest multiplier says: film memory in both."""
    speed, steps, periods = 3000.0, 64, 400
    answer = shoot(motor, speed, "passage", bearing=None, steps=steps)
    answer = with_multipliers(motor, answer, bearing=None, steps=steps)
    place, velocity = answer.run.displacement[0], answer.run.velocity[0]
    kick = np.zeros(motor.size)
    kick[[at["y"] for at in motor.nodes.values()]] = 1e-6
    smooth = replace(motor, unbalances=())
    runs = [
        simulate_rotor(
            smooth,
            speed_rpm=speed,
            dt=answer.run.t[1],
            until=periods * answer.period,
            start=(place, velocity + sign * kick),
        )
        for sign in (1.0, -1.0)
    ]
    disc = motor.nodes["disc"]["y"]
    apart = np.abs(runs[0].displacement[:, disc] - runs[1].displacement[:, disc])
    sizes = apart[: periods * steps].reshape(-1, 20 * steps).max(axis=1)
    kept = np.arange(5, sizes.size)
    rate = np.polyfit(20.0 * kept, np.log(sizes[kept]), 1)[0]
    assert np.log(np.abs(answer.multipliers)).max() == pytest.approx(rate, rel=0.02)


@pytest.mark.long
def test_multipliers_of_a_small_vibration_are_those_of_modes(oil):
    """Film memory in both: as states of steps, and exact in the modes about equilibrium."""
    film = BallBearing.catalogue("6305", oil=oil).element("inner", 3000.0)
    rotor = Rotor(
        mass=[[5.0]], stiffness=[[0.0]], load=[100.0], mounts=(ContactMount(angle=0.0, contact=film, x=0),)
    )
    force = PeriodicForce(amplitudes={0: 1e-2}, hz=600.0)
    answer = shoot(rotor, 3000.0, force, steps=128)
    found = with_multipliers(rotor, answer, excitation=force, steps=128).multipliers
    (mode,) = linearise(rotor, 3000.0).modes(1)
    assert np.log(abs(found[0])) == pytest.approx(mode.eigenvalue.real / 600.0, rel=2e-3)
    turned = 2.0 * np.pi - mode.eigenvalue.imag / 600.0
    assert abs(np.angle(found[0])) == pytest.approx(turned, rel=5e-3)


def test_a_linear_rotor_has_the_unbalance_response():
    """To the second order of the steps; multipliers are those of its eigenvalues."""
    bearing = LinearBearing(stiffness=np.diag([1e7, 2e7]), damping=np.diag([1e3, 1e3]))
    rotor = Rotor(
        mass=10.0 * np.eye(2),
        stiffness=np.zeros((2, 2)),
        mounts=(BearingMount(bearing=bearing, x=0, y=1),),
        unbalances=(Unbalance(x=0, y=1, amount=1e-5),),
    )
    answer = shoot(rotor, 6000.0, start=([0.0, 0.0], [0.0, 0.0]), steps=128)
    expected = unbalance_response(rotor, [6000.0]).amplitude[0]
    assert np.abs(answer.harmonics[1] - expected).max() < 1e-3 * np.abs(expected).max()
    found = with_multipliers(rotor, answer, steps=128).multipliers
    assert np.log(np.abs(found)) == pytest.approx(-1e3 / 20.0 * 0.01, rel=2e-2)


@pytest.mark.long
def test_passage_at_contact_angles(oil):
    """The period is an unknown: contact angles change the speed of the cage."""
    bearing = BallBearing.catalogue("6305", oil=oil, clearance=1e-5)

    def motor(disc):
        ends = {"bearing": bearing, "facing": "-z"}, {"bearing": bearing, "facing": "+z", "preload": 100.0}
        supports = [Support(position=0.2 * k, **end) for k, end in enumerate(ends)]
        shaft = Shaft(length=0.2, diameter=0.025, elements=2)
        return rotor_on_bearings(shaft, supports=supports, discs=[Disc(position=disc, mass=6.0)])

    answer = shoot(motor(0.1), 3000.0, "passage", steps=64)
    plain = 1.0 / bearing.frequencies(3000.0).bpfo
    assert 0.99 * plain < answer.period < 0.997 * plain  # faster at an angle
    steps_of = StepMap(motor(0.1), 3000.0, "passage", steps=64, start=answer, period=answer.period)
    steps_of.march(steps_of.numbers, 1)
    assert steps_of.cage_left < 1e-8
    with pytest.raises(InputError, match=r"cages = .*: must be equally fast: else the motion is quasi-periodic"):
        shoot(motor(0.13), 3000.0, "passage", bearing=None, steps=64)


def test_no_answer_names_what_a_run_does(rotor):
    words = r"a run from there comes to a motion of .* that repeats itself after 1 period"
    with pytest.raises(ConvergenceError, match=words) as caught:
        shoot(rotor, SPEED, "passage", steps=64, start=passage_rotor.UNSTABLE, most=1)
    assert caught.value.result.status is Status.FAILED
    assert caught.value.result.run.t.size == 65


def test_bearings_with_different_passages_are_refused():
    first, second = (BallBearing.catalogue(name) for name in ("6205", "6305"))
    rotor = rotor_on_bearings(
        Shaft(length=0.2, diameter=0.025, elements=2),
        supports=[Support(position=0.0, bearing=first), Support(position=0.2, bearing=second)],
    )
    with pytest.raises(InputError, match="the same at all bearings whose balls pass: else"):
        shoot(rotor, 3000.0, "passage", bearing=None)


def test_bad_input(rotor):
    with pytest.raises(InputError, match="excitation"):
        shoot(rotor, SPEED, "imbalance")
    with pytest.raises(InputError, match="speed_rpm"):
        shoot(rotor, 0.0, "passage")
    with pytest.raises(InputError, match="bearing = 1"):
        shoot(rotor, SPEED, "passage", bearing=1)
    with pytest.raises(InputError, match="periods"):
        shoot(rotor, SPEED, "passage", periods=3, start=shoot(rotor, SPEED, "passage", periods=2, steps=64))
