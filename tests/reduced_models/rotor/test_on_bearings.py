"""Rotors on ball bearings over time: against scipy, eigenvalues, energy, themselves with other steps."""

import re
from dataclasses import replace
from math import pi

import numpy as np
import pytest
from beam_rotor import NODES, beam, block
from scipy.integrate import solve_ivp

from ehlcontact import Geometry, Grid, Lubricant, OperatingPoint, TransientContact, read, save
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models import (
    BallBearing,
    BearingMount,
    OutsideValidityWarning,
    Rotor,
    SpeedProfile,
    Unbalance,
    jeffcott_rotor,
    linearise,
    simulate_rotor,
)
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.simulate import default_tolerance
from reduced_models.rotor.speed_profile import turning_forces

RPM, DT = 3000.0, 2e-5


def test_at_rest_all_forces_balance(film):
    rotor = beam(film)
    q = rotor.equilibrium(RPM)
    alone = film.equilibrium((0.0, -500.0), speed_rpm=RPM, cage_angle=-pi / 2.0)
    for n in NODES:
        np.testing.assert_allclose(q[4 * n : 4 * n + 2], alone.displacement, atol=1e-14)
    run = simulate_rotor(rotor, speed_rpm=RPM, dt=DT, until=DT)
    np.testing.assert_allclose(run.ring_force[0], [[0.0, -500.0]] * 2, atol=1e-6)
    np.testing.assert_allclose(run.displacement[0], q, atol=1e-15)


def test_against_scipy():
    """A block on a dry bearing with clearance, dropped and turned round by its unbalance; balls without mass."""
    C = 100.0 * np.eye(2)
    still = BallBearing.catalogue("6205", clearance=1e-5, density=1e-6)
    rotor = block(still, damping=C, unbalances=(Unbalance(x=0, y=1, amount=2e-4, phase=0.7),))
    kn = sum(still.race(race).kn ** (-2.0 / 3.0) for race in ("inner", "outer")) ** -1.5
    omega = RPM * pi / 30.0

    def rates(t, z):
        psi = -pi / 2.0 + still.orders.ftf_order * omega * t + 2.0 * pi / 9.0 * np.arange(9)
        n = np.array([np.cos(psi), np.sin(psi)])
        forces = kn * np.maximum(z[:2] @ n - 5e-6, 0.0) ** 1.5
        swing = 2e-4 * omega**2 * np.array([np.cos(omega * t + 0.7), np.sin(omega * t + 0.7)])
        return np.concatenate([z[2:], (np.array([0.0, -300.0]) + swing - C @ z[2:] - n @ forces) / 2.0])

    start = np.array([2e-6, -8e-6]), np.array([0.0, 1e-3])
    exact = solve_ivp(rates, (0.0, 0.02), np.concatenate(start), rtol=1e-9, atol=1e-14, t_eval=[0.01, 0.02])
    errors = []
    for dt in (5e-6, 2.5e-6):
        run = simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=0.02, start=start)
        at = run.displacement[[round(0.01 / dt), round(0.02 / dt)]]
        errors.append(np.abs(at.T - exact.y[:2]).max() / np.ptp(run.displacement, axis=0).max())
    assert errors[0] < 2e-3
    assert errors[1] < 0.3 * errors[0]


def test_second_order_with_films_at_lift_off(oil):
    """A block that unbalance lifts off its film and drops on it: errors fall fourfold with half the step."""
    loose = BallBearing.catalogue("6205", oil=oil, clearance=5e-6)
    rotor = block(loose, unbalances=(Unbalance(x=0, y=1, amount=4e-3),))
    ends = []
    for dt in (2e-5, 1e-5, 5e-6, 6.25e-7):
        run = simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=0.006, rho_inf=0.8)
        ends.append(run.displacement[:: round(2e-5 / dt)])
    assert run.ring_force[:, 0, 1].max() > 400.0  # thrown to the top
    assert run.ring_force[:, 0, 1].min() < -400.0
    errors = [np.sqrt(np.mean((end - ends[-1]) ** 2)) for end in ends[:-1]]
    assert errors[0] < 0.015 * ends[-1].std()
    assert errors[1] < 0.27 * errors[0] and errors[2] < 0.27 * errors[1]


def test_mean_deflection_does_not_depend_on_the_step(film):
    rotor = beam(film, unbalance=1e-4)
    means = []
    for dt in (1e-4, 2e-5, 1e-5):
        run = simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=0.2)
        means.append(run.ring[run.t >= 0.1, :, 1].mean())
    np.testing.assert_allclose(means, means[-1], rtol=1e-3)


def test_frequency_of_the_ball_passage(film):
    """Without unbalance the ring swings at the number of balls times the cage's frequency, 179.2 Hz."""
    run = simulate_rotor(beam(film), speed_rpm=RPM, dt=5e-5, until=0.8)
    y = run.ring[run.t >= 0.3, 0, 1]
    heard = np.abs(np.fft.rfft((y - y.mean()) * np.hanning(y.size)))
    hz = np.fft.rfftfreq(y.size, 5e-5)[np.argmax(heard)]
    assert film.frequencies(RPM).bpfo == pytest.approx(179.24, abs=0.01)
    assert hz == pytest.approx(179.24, abs=1.0)  # lines are 2 Hz apart


def test_files_of_runs(film, tmp_path):
    run = simulate_rotor(block(film), speed_rpm=RPM, dt=DT, until=0.002)
    again = read(save(run, tmp_path / "run.h5"), RotorResult)
    for name in vars(run).keys() - {"ball_bearings"}:
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    (kept,), (bearing,) = again.ball_bearings, run.ball_bearings
    assert (kept.name, kept.internals) == (bearing.name, bearing.internals)
    np.testing.assert_array_equal(kept.mean_loads, bearing.mean_loads)
    (tmp_path / "none.h5").write_text("nothing")
    with pytest.raises(InputError, match="run of a rotor"):
        read(tmp_path / "none.h5", RotorResult)


def test_a_course_of_one_speed_is_that_speed(film):
    rotor = beam(film, unbalance=1e-4)
    one = simulate_rotor(rotor, speed_rpm=RPM, dt=DT, until=0.01)
    course = SpeedProfile(np.array([0.0, 0.002, 0.02]), np.full(3, RPM))
    same = simulate_rotor(rotor, speed_rpm=course, dt=DT, until=0.01)
    np.testing.assert_allclose(same.displacement, one.displacement, rtol=1e-9, atol=1e-15)


def test_speed_and_angle_of_a_course():
    course = SpeedProfile(np.array([0.1, 0.3, 0.4]), np.array([600.0, 1200.0, 1200.0]))
    t = np.linspace(0.0, 0.6, 6001)
    omega, angle, rise = course.at(t)
    np.testing.assert_allclose(omega, np.interp(t, course.t, course.speed_rpm) * pi / 30.0)
    np.testing.assert_allclose(angle[1:], np.cumsum(0.5 * (omega[1:] + omega[:-1])) * 1e-4, atol=1e-5)
    assert angle[0] == 0.0 and rise[2000] == pytest.approx(600.0 * pi / 30.0 / 0.2) and rise[-1] == 0.0


def test_unbalance_of_a_shaft_that_gains_speed():
    """Mass times the acceleration of its circle."""
    rotor = block(BallBearing.catalogue("6205"), unbalances=(Unbalance(x=0, y=1, amount=2e-4, phase=0.3),))
    t = np.linspace(0.0, 0.1, 20001)
    omega, angle, rise = SpeedProfile(np.array([0.0, 0.1]), np.array([1000.0, 9000.0])).at(t)
    forces, at = turning_forces(rotor, omega, angle, rise)
    circle = 2e-4 * np.column_stack([np.cos(angle + 0.3), np.sin(angle + 0.3)])
    thrown = -(circle[2:] - 2.0 * circle[1:-1] + circle[:-2]) / (t[1] - t[0]) ** 2
    np.testing.assert_allclose(forces[1:-1], thrown, atol=1e-4 * np.abs(thrown).max())
    np.testing.assert_array_equal(at, np.eye(2))


def test_a_heavy_housing_is_the_ground(film):
    mass, stiffness = np.diag([2.0, 2.0, 1e6, 1e6]), np.diag([0.0, 0.0, 1e12, 1e12])
    mount = (BearingMount(bearing=film, x=0, y=1, housing=(2, 3)),)
    load = np.array([0.0, -300.0, 0.0, 0.0])
    housed = Rotor(mass=mass, stiffness=stiffness, mounts=mount, load=load)
    runs = [
        simulate_rotor(rotor, speed_rpm=RPM, dt=DT, until=0.01, start=(place, np.zeros(rotor.size)))
        for rotor, place in ((housed, np.array([0.0, -8e-6, 0.0, 0.0])), (block(film), np.array([0.0, -8e-6])))
    ]
    np.testing.assert_allclose(runs[0].ring, runs[1].ring, atol=2e-9)
    soft = Rotor(mass=mass, stiffness=np.diag([0.0, 0.0, 1e7, 1e7]), mounts=mount, load=load)
    q = soft.equilibrium(RPM)
    assert q[3] == pytest.approx(-300.0 / 1e7, rel=1e-6)


def test_two_bearings_of_different_kinds(film, oil):
    other = BallBearing.catalogue("6010", oil=oil, clearance=2e-5)
    mounts = (BearingMount(bearing=film, x=4, y=5), BearingMount(bearing=other, x=20, y=21, cage_angle=0.3))
    run = simulate_rotor(beam(film, mounts=mounts), speed_rpm=RPM, dt=DT, until=0.004)
    assert run.ring_force.shape == (201, 2, 2)
    np.testing.assert_allclose(run.ring_force[0].sum(axis=0), [0.0, -1000.0], atol=1e-6)
    assert abs(run.ring[0, 0, 1] - run.ring[0, 1, 1]) > 1e-6


def test_balls_beyond_the_atlas_warn(film):
    fast = {"speed_rpm": RPM, "dt": DT, "until": 0.001}
    quiet = simulate_rotor(block(film), **fast)
    alone = film.equilibrium((0.0, -300.0), speed_rpm=RPM, cage_angle=-pi / 2.0)
    np.testing.assert_allclose(quiet.largest_load, [alone.force.max(axis=0)], rtol=1e-3)
    with pytest.warns(
        OutsideValidityWarning, match=r"a ball of bearing 0 carried .* N on the inner race \(atlas up"
    ):
        heavy = simulate_rotor(block(film, load=(0.0, -9000.0)), **fast)
    words = r"^a ball of bearing 0 carried \S+ N on the inner race \(atlas up to \S+ N\)"
    assert quiet.reservation == "" and re.match(words, heavy.reservation)
    still = linearise(block(film, load=(0.0, -9000.0)), RPM)
    assert re.match(words, still.reservation) and still.reservation in str(still)
    assert linearise(block(film), RPM).reservation == ""


def test_balls_with_no_load_that_the_atlas_has_are_named(film):
    loose = replace(film, clearance=1e-4)
    run = simulate_rotor(block(loose, load=(0.0, -1e-3)), speed_rpm=RPM, dt=DT, until=2e-4)
    assert re.match(
        r"^no ball of bearing 0 carried more than \S+ N on the inner race \(atlas from ", run.reservation
    )


def test_a_ring_that_leaves_its_bearing(dry):
    rotor = block(dry, unbalances=(Unbalance(x=0, y=1, amount=0.5),))
    with pytest.raises(ConvergenceError, match=r"ring of bearing 0 has left it, .* mm from the middle") as caught:
        simulate_rotor(rotor, speed_rpm=12000.0, dt=DT, until=0.1)
    run = caught.value.result
    assert run.status is Status.FAILED and 1 < len(run.t) < 5000
    assert np.isfinite(run.displacement).all()


@pytest.mark.parametrize(
    ("match", "changes"),
    [
        (r"mounts\[0\] = .*from 0 to 1", {"mounts": lambda b: (BearingMount(bearing=b, x=0, y=2),)}),
        (r"mounts\[0\] = .*two different", {"mounts": lambda b: (BearingMount(bearing=b, x=1, y=1),)}),
        (r"mounts\[1\] = \(0, 1\): .*no other", {"mounts": lambda b: (BearingMount(bearing=b, x=0, y=1),) * 2}),
        ("mounts = .*at least one", {"mounts": lambda b: ()}),
        ("mass = .*not positive definite", {"mass": lambda b: np.diag([1.0, 0.0])}),
        ("shape of stiffness", {"stiffness": lambda b: np.zeros((2, 3))}),
        ("length of load = 3", {"load": lambda b: np.zeros(3)}),
        (r"unbalances\[0\] = .*from 0 to 1", {"unbalances": lambda b: (Unbalance(x=0, y=5, amount=1.0),)}),
    ],
)
def test_what_is_no_rotor(dry, match, changes):
    with pytest.raises(InputError, match=match):
        block(dry, **{name: make(dry) for name, make in changes.items()})


@pytest.mark.parametrize(
    ("match", "changes"),
    [
        ("dt = 0.002: must be at most 0.00034.* s, a 16th of the ball passage", {"dt": 2e-3}),
        ("dt = 0.0: must be", {"dt": 0.0}),
        ("until = -1.0", {"until": -1.0}),
        ("until = 1000000.0: must be at most .* steps of dt", {"until": 1e6}),
        ("rho_inf = 2.0", {"rho_inf": 2.0}),
        ("start = 'rest'", {"start": "rest"}),
        ("start = 5", {"start": 5}),
        ("length of displacements = 3", {"start": (np.zeros(3), np.zeros(2))}),
        ("speed_rpm = 90000.0: must be at most", {"speed_rpm": 9e4, "dt": 1e-6}),
        ("speed_rpm = 0.0: must be > 0 for a bearing with oil", {"speed_rpm": 0.0}),
    ],
)
def test_what_is_no_run(film, match, changes):
    with pytest.raises(InputError, match=match):
        simulate_rotor(block(film), **({"speed_rpm": RPM, "dt": DT, "until": 0.01} | changes))


def test_angles_of_a_mount_are_in_radians(dry):
    with pytest.raises(InputError, match=r"cage_angle = 90.0: .*radians"):
        BearingMount(bearing=dry, x=0, y=1, cage_angle=90.0)
    with pytest.raises(InputError, match=r"phase = 90.0: .*radians"):
        Unbalance(x=0, y=1, amount=1.0, phase=90.0)


OIL = Lubricant.iso_vg(68, temperature=50.0)


def test_a_coast_down_ends_at_standstill():
    """Below a thousandth of the highest speed films stay as they are there; and the rotor stands on."""
    rotor = block(BallBearing.catalogue("6205", oil=OIL))
    course = SpeedProfile.ramp(600.0, 0.0, 0.02)
    with pytest.warns(OutsideValidityWarning, match="atlas up to"):  # so slow, it has no films of such loads
        found = simulate_rotor(rotor, speed_rpm=course, dt=4e-5, until=0.024)
    assert found.status.ok and found.t[-1] >= 0.024
    assert np.abs(found.displacement[-1]).max() < 1e-4


def test_steps_too_short_for_rounding_are_told(dry):
    with pytest.raises(ConvergenceError, match=r"steps of dt = 1e-09 s are so short .* tolerance"):
        simulate_rotor(block(dry), speed_rpm=3000.0, dt=1e-9, until=1e-6)


BALL = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=1e-8), load=5.0, u_sum=2.0)
STILL = np.array([0.0, -0.5 * BALL.scales.length]), np.zeros(2)


def test_films_that_are_solved_coarsely_are_balanced_as_coarsely():
    """Their force is good to their own tolerance; with an explicit one the error says which to change."""
    films = {tol: TransientContact(BALL, grid=Grid(n=16), tol=tol) for tol in (3e-3, 0.3)}
    for tol, film in films.items():
        rotor = jeffcott_rotor(bearings=1, disc_mass=2.0, journal_mass=0.3, shaft_stiffness=1e8).on([film])
        assert default_tolerance(rotor) == pytest.approx(1e-6 * tol / 3e-3)
    with pytest.raises(ConvergenceError, match="a smaller tol of TransientContact, or a larger tolerance"):
        simulate_rotor(rotor, speed_rpm=0.0, dt=1e-5, until=1e-3, start=STILL, tolerance=1e-9, max_iterations=1)
