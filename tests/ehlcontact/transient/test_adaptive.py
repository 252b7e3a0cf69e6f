"""Controlled time steps: error against tolerance, corners, several-fold loads, and steps that cannot be met."""

from math import pi

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Domain,
    FreeVibration,
    Grid,
    HarmonicLoad,
    KeepSettings,
    MoesPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    RunSettings,
    TimeSteps,
    simulate,
)
from ehlcontact.status import Status
from ehlcontact.transient.bodies import MotionState
from ehlcontact.transient.record import Entry
from ehlcontact.transient.time_step import LARGEST_GROWTH, StepControl, local_error, next_time
from ehlcontact.transient.transient_film import Step

POINT = MoesPoint(200, 10, 0.5)
N = 32
T = np.linspace(0.0, 2.0, 41)
PULSE = PrescribedLoad([0.0, 0.5, 0.7, 1.2, 1.4, 6.0], [1.0, 1.0, 1.3, 1.3, 1.0, 1.0])


def several_fold(low, high, Omega_n=None):
    """Load from `low` to `high` and back, all within one transit each."""
    return PrescribedLoad([0.0, 0.5, 1.5, 2.5, 3.5, 6.0], [low, low, high, high, low, low], Omega_n=Omega_n)


def largest_error(record, reference):
    """Largest error of the approach, by dense output of the reference."""
    inside = record.t <= reference.t[-1]
    return np.abs(record.approach - reference.at(record.t[inside]).approach).max()


@pytest.fixture(scope="module")
def pulse_reference():
    return simulate(POINT, PULSE, grid=Grid(n=N), time=TimeSteps(until=3.0, local_error=1e-5))


@pytest.fixture(scope="module")
def pulse():
    return {
        error: simulate(POINT, PULSE, grid=Grid(n=N), time=TimeSteps(until=3.0, local_error=error))
        for error in (1e-3, 1e-4)
    }


def test_corners_and_end_are_met(pulse):
    for record in pulse.values():
        assert record.status is Status.CONVERGED
        assert {0.5, 0.7, 1.2, 1.4} <= set(record.t)
        assert record.t[-1] == 3.0
        assert (np.diff(record.t) > 0.0).all()


def test_error_falls_with_the_tolerance(pulse, pulse_reference):
    """Local errors of third order under a tolerance tau add up to about tau^(2/3): 4.6 for a tenth."""
    errors = {error: largest_error(record, pulse_reference) for error, record in pulse.items()}
    assert errors[1e-3] < 2e-3
    assert errors[1e-4] < 2e-4
    assert errors[1e-3] / errors[1e-4] > 3.0


@pytest.mark.parametrize(
    "motion",
    [pytest.param(FreeVibration(Omega_n=5.13), marks=pytest.mark.long), HarmonicLoad(Omega=pi, Omega_n=5.13)],
)
def test_errors_of_a_run_are_what_is_said(motion):
    """About error^(2/3) in force and two thirds of it in approach, of bodies with inertia: within a factor 3."""
    reference = simulate(POINT, motion, grid=Grid(n=N), time=TimeSteps(until=2.5, local_error=2e-6))
    for error in (1e-3, 1e-4):
        record = simulate(POINT, motion, grid=Grid(n=N), time=TimeSteps(until=2.5, local_error=error))
        there = reference.at(record.t)
        for name, share in (("approach", 2.0 / 3.0), ("force", 1.0)):
            ratio = np.abs(getattr(record, name) - getattr(there, name)).max() / (share * error ** (2.0 / 3.0))
            assert 1.0 / 3.0 < ratio < 3.0, (name, error, ratio)


def test_fewer_steps_than_fixed_ones_of_the_same_accuracy(pulse, pulse_reference):
    controlled = pulse[1e-4]
    fixed = simulate(
        POINT, PULSE, grid=Grid(n=N), time=TimeSteps(until=3.0, dt=3.0 / (2 * controlled.steps), tol=3e-4)
    )
    assert fixed.steps == 2 * controlled.steps
    assert largest_error(fixed, pulse_reference) > largest_error(controlled, pulse_reference)


def test_steps_grow_where_nothing_happens():
    """Two transits after the pulse the film is at rest again."""
    record = simulate(POINT, PULSE, grid=Grid(n=N), time=TimeSteps(until=6.0, local_error=1e-3))
    steps, middles = np.diff(record.t), 0.5 * (record.t[1:] + record.t[:-1])
    ramp = (middles > 0.5) & (middles < 0.7)
    assert steps[middles > 4.5].min() > 3.0 * np.median(steps[ramp])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "until"),
    [
        (PULSE, 3.0),
        (RampLoad(1.3, 0.5, Omega_n=5.13), 4.0),
        (FreeVibration(Omega_n=5.13), 2.5),
        (HarmonicLoad(Omega=2.0 * pi), 3.0),
        (PrescribedApproach(T, 0.88 + 0.03 * (1.0 - np.cos(pi * T))), 2.0),
    ],
    ids=lambda m: getattr(m, "kind", ""),
)
def test_second_order_in_the_number_of_steps(motion, until):
    """Error over number of steps from tolerances 3e-3 to 1e-4, with the steps as the controller varies them."""
    reference = simulate(POINT, motion, grid=Grid(n=N), time=TimeSteps(until=until, local_error=1e-5))
    name = "force" if isinstance(motion, PrescribedApproach) else "approach"
    steps, errors = [], []
    for error in (3e-3, 1e-4):
        record = simulate(POINT, motion, grid=Grid(n=N), time=TimeSteps(until=until, local_error=error))
        steps.append(record.steps)
        errors.append(np.abs(getattr(record, name) - getattr(reference.at(record.t), name)).max())
    assert np.log(errors[0] / errors[1]) / np.log(steps[1] / steps[0]) >= 1.8
    assert 0.4 < np.log(errors[0] / errors[1]) / np.log(3e-3 / 1e-4) < 1.2


def test_snapshots_are_taken_at_their_times():
    wanted = (0.0, 0.123, 0.4567)
    record = simulate(
        POINT,
        HarmonicLoad(Omega=pi),
        grid=Grid(n=N),
        time=TimeSteps(until=0.8, local_error=1e-3),
        keep=KeepSettings(snapshots=wanted),
    )
    assert tuple(record.snapshot_t) == wanted


def test_controlled_motion_with_inertia_obeys_its_equation():
    record = simulate(
        POINT, FreeVibration(Omega_n=5.13), grid=Grid(n=N), time=TimeSteps(until=1.0, local_error=3e-4)
    )
    residual = record.acceleration / 5.13**2 + record.force - record.load
    assert np.abs(residual).max() < 1e-4
    dT = np.diff(record.t)
    moved = 0.5 * dT * (record.rate[1:] + record.rate[:-1])
    np.testing.assert_allclose(np.diff(record.approach), moved, atol=1e-12)


@pytest.mark.long
def test_load_that_rises_forty_fold():
    """From 5 % to twice the static load: the domain is widened beforehand."""
    record = simulate(POINT, several_fold(0.05, 2.0), grid=Grid(n=64), time=TimeSteps(local_error=1e-3))
    assert record.status is Status.CONVERGED
    assert record.domain == Domain.for_load(2.0)
    assert record.force.min() == pytest.approx(0.05, abs=1e-4)
    assert record.force.max() == pytest.approx(2.0, abs=1e-3)
    assert record.approach[-1] == pytest.approx(record.approach[0], abs=0.02)
    assert (record.h_min > 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize("Omega_n", [None, 5.13])
def test_load_that_rises_sixty_fold(Omega_n):
    record = simulate(POINT, several_fold(0.05, 3.0, Omega_n), grid=Grid(n=128), time=TimeSteps(local_error=1e-3))
    assert record.status is Status.CONVERGED
    assert record.force.max() >= 3.0 - 1e-3
    assert (record.h_min > 0.0).all()


def test_overload_of_a_given_domain_is_said_with_advice():
    motion = PrescribedApproach([0.0, 0.5, 1.0, 2.0], [0.87, 1.5, 2.5, 4.0])
    with pytest.raises(
        ConvergenceError, match=r"out_of_domain .*force so far 2\.[23].*domain=Domain\.for_load\("
    ) as caught:
        simulate(POINT, motion, grid=Grid(n=N, domain=Domain()), time=TimeSteps(local_error=1e-3))
    result = caught.value.result
    assert result.status is Status.OUT_OF_DOMAIN
    assert result.t[-1] < 1.0
    assert (
        simulate(POINT, motion, grid=Grid(n=64), time=TimeSteps(local_error=1e-3)).force[-1] > 8.0
    )  # the default domain is wide enough


def test_vibration_that_separates_and_comes_back():
    """Let go two dry approaches below: the bodies part (no film force), fall back and are caught by the film."""
    motion = FreeVibration(Omega_n=5.13, offset=2.0)
    record = simulate(POINT, motion, grid=Grid(n=64), time=TimeSteps(local_error=1e-3, until=1.5))
    assert record.status is Status.CONVERGED
    away = record.force < 1e-6
    assert away.sum() >= 3
    assert record.approach[away].max() < 0.0
    np.testing.assert_allclose(record.acceleration[away], 5.13**2, rtol=1e-4)  # free flight under the load
    assert record.force[record.t > record.t[away].max()].max() > 2.0
    assert record.force.max() == record.force[0]  # bounced back lower than it came


def test_step_that_cannot_meet_its_tolerance():
    """A jump three times as deep as the film; one below it is a change of film, which a short step takes."""

    def jump(X, Y, T):
        return (0.4 if T > 0.3 else 0.0) + 0.0 * X * Y

    def run(throw):
        return simulate(
            POINT,
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=N),
            time=TimeSteps(until=1.0, local_error=1e-3),
            surface=jump,
            run=RunSettings(throw=throw),
        )

    message = r"step_too_small at T = 0\.2999\d+ \(a step of \d.*e-0\d .* the tolerated error 0\.001\): However"
    with pytest.raises(ConvergenceError, match=message) as caught:
        run(throw=True)
    result = caught.value.result
    assert result.status is Status.STEP_TOO_SMALL
    assert result.steps > 5
    assert result.t[-1] == pytest.approx(0.3, abs=1e-4)
    assert np.isfinite(result.approach).all()
    assert run(throw=False).status is Status.STEP_TOO_SMALL


def test_corners():
    assert PULSE.corners == (0.5, 0.7, 1.2, 1.4)
    assert RampLoad(3.0, 1.69, Omega_n=2.4).corners == (1.69,)
    assert FreeVibration(Omega_n=5.0).corners == HarmonicLoad(Omega=1.0).corners == ()
    assert PrescribedLoad.from_function(lambda T: 1.0 + 0.3 * np.sin(T), 2.0 * pi, 40).corners == ()
    assert PrescribedLoad([0.0, 1.0, 2.0, 3.0], np.ones(4)).corners == ()


def test_next_time_leaves_no_sliver():
    stops = [1.0, 2.0]
    assert next_time(0.0, 0.3, stops, 1e-6) == (0.3, 0.3)
    assert next_time(0.5, 0.3, stops, 1e-6) == (0.75, 0.25)
    assert next_time(0.75, 0.3, stops, 1e-6) == (1.0, 0.25)
    assert next_time(1.0, 5.0, stops, 1e-6) == (2.0, 1.0)


def test_step_control():
    control = StepControl(1e-3, 0.1)
    control.accepted(0.1, 1e-9)
    assert control.step == LARGEST_GROWTH * 0.1
    control.accepted(0.1, 0.6)
    assert control.step < 0.1
    control = StepControl(1e-3, 0.1, last_error=0.6)
    control.accepted(0.1, 0.5)
    assert control.step == 0.1  # as good as it can be: factors of the coarsest grid stay valid
    control.refused(0.1, 8.0, 3)
    assert 0.03 < control.step < 0.05
    control.refused(0.1, 1e9, 3)
    assert control.step == pytest.approx(0.02)


@pytest.mark.parametrize("times", [(0.0, 1.0, 2.0, 3.0), (0.0, 1.0, 1.3, 2.1), (0.0, 0.2, 1.1, 1.4)])
def test_local_error_of_uneven_steps(times):
    """What BDF2 misses of u = T^3, on which Milne's estimate is exact."""
    t0, t1, t2, end = times
    h, ratio = end - t2, (end - t2) / (t2 - t1)
    leading, now, before = (1.0 + 2.0 * ratio) / (1.0 + ratio), 1.0 + ratio, ratio**2 / (1.0 + ratio)
    made = (3.0 * end**2 * h + now * t2**3 - before * t1**3) / leading
    film, solved = np.zeros(3), Step(0.0, 0.0, 1, Status.CONVERGED)
    entries = [
        Entry(MotionState(t, u, 0.0, 0.0), solved, {"force": 0.0, "h_midplane": film, "p_midplane": film})
        for t, u in ((t0, t0**3), (t1, t1**3), (t2, t2**3), (end, made))
    ]
    error = local_error(entries[:3], entries[3], HarmonicLoad(Omega=1.0))
    assert error == pytest.approx(abs(made - end**3), rel=1e-12) and error > 0.05
