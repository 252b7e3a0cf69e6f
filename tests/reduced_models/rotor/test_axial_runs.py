"""Runs of rotors with axial motion and tilts: against scipy, linear answers, energy, and shorter steps."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from axial_rotors import LIGHT, MASS, SPINDLE, motor, pair_force, rigid, ring_force
from scipy.integrate import solve_ivp

from ehlcontact import ConvergenceError, Lubricant
from reduced_models import (
    BallBearing,
    BearingMotion,
    ContactMount,
    Disc,
    Shaft,
    SpeedProfile,
    SpringContact,
    Support,
    Unbalance,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.rotor.decay import log_decrement

OIL = Lubricant.iso_vg(46, temperature=70.0)
RPM = 12000.0


@pytest.fixture(scope="module")
def spindle():
    return BallBearing(**SPINDLE, oil=OIL)


@pytest.fixture(scope="module")
def pair(spindle):
    return rigid(spindle, spindle, offset=6e-6, load=np.array([0.0, -9.81 * MASS, 0.0, 0.0, 0.0]))


@pytest.mark.parametrize("control", ["outer", "inner", "shared"])
def test_a_ring_at_rest_stays_there(spindle, control):
    """The time step's balance is that of statics, films and inertia of the balls included."""
    bearing = replace(spindle, race_control=control)
    load = np.array([50.0, -100.0, 300.0, 0.5, -0.3])
    state = bearing.equilibrium(load, speed_rpm=RPM, cage_angle=0.3)
    motion = motion_of(bearing, [RPM], FIVE)
    q, still = np.array(state.displacement), np.zeros(5)
    np.testing.assert_allclose(motion.rest(RPM * RPM_TO_RAD_S, 0.3, q), load, atol=1e-9)
    np.testing.assert_allclose(motion.loads, state.force, rtol=1e-9)
    motion.core.head(motion.state)["cage"] = 0.0  # the cage held
    for _ in range(20):
        motion.begin(RPM * RPM_TO_RAD_S, 1e-5)
        force = motion.forces(q, still)[0]
        motion.accept()
        motion.core.head(motion.state)["cage"] = 0.0
        np.testing.assert_allclose(force, load, atol=1e-9)


@pytest.mark.parametrize(
    ("oil", "density", "close"), [(None, 1e-9, 1e-6), (OIL, 1e-9, 1e-6), (OIL, 7800.0, 1e-4)],
    ids=["dry", "oil", "heavy balls"],
)  # fmt: skip
def test_tangents_against_differences(oil, density, close):
    """Light balls lift off in the motion."""
    bearing = BallBearing(**SPINDLE, oil=oil, density=density)
    motion = motion_of(bearing, [RPM], FIVE)
    q = np.array([4e-6, -6e-6, 9e-6, 4e-5, -2e-5])
    v = np.array([2e-3, 1e-3, -3e-3, 0.02, 0.03])
    motion.rest(RPM * RPM_TO_RAD_S, 0.0, q)
    for i in range(33):
        motion.begin(RPM * RPM_TO_RAD_S, 5e-6)
        at = q + 5e-6 * (i + 1) * v
        _, stiffness, damping = motion.forces(at, v)
        if i == 32:
            break
        motion.accept()
    assert motion.loads[:, 0].max() > 100.0
    assert density > 1.0 or motion.loads[:, 0].min() < 1.0
    for index, steps, tangent in (
        (0, (1e-10, 1e-10, 1e-10, 1e-8, 1e-8), stiffness),
        (1, (1e-5, 1e-5, 1e-5, 1e-3, 1e-3), damping),
    ):
        if not tangent.any():  # dry contacts do not damp
            continue
        differences = np.zeros((5, 5))
        for j, h in enumerate(steps):
            moved = np.zeros((2, 5))
            moved[index, j] = h
            there, back = (motion.forces(at + s * moved[0], v + s * moved[1])[0] for s in (1.0, -1.0))
            differences[:, j] = (there - back) / (2.0 * h)
        scale = np.sqrt(np.abs(np.outer(np.diag(tangent), np.diag(tangent)))) + 1e-3
        assert np.abs((differences - tangent) / scale).max() < close


def axial_decay(rotor, dt, until=0.02):
    start = rotor.equilibrium(RPM), np.array([0.0, 0.0, 2e-4, 0.0, 0.0])
    return simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=until, start=start, rho_inf=1.0)


@pytest.mark.long
def test_decay_is_that_of_the_linear_answer(pair):
    mode = next(m for m in linearise(pair, RPM).modes(None) if abs(m.shape[2]) > 0.9)
    run = axial_decay(pair, 1e-6)
    z = run.displacement[:, 2] - pair.equilibrium(RPM)[2]
    found = log_decrement(run.t, z, omega=mode.omega)
    assert found.omega == pytest.approx(mode.omega, rel=1e-4)
    assert found.decrement == pytest.approx(mode.decrement, rel=5e-3)


def test_order_in_time(pair):
    """Three steps: differences fall by four."""
    ends = [axial_decay(pair, dt, 4e-3).displacement[-1] for dt in (8e-6, 4e-6, 2e-6)]
    coarse, fine = (np.abs(np.subtract(*two))[1:3] for two in (ends[:2], ends[1:]))
    assert np.all(np.log2(coarse / fine) > 1.8)


def dry_pair(offset=4e-6, **others):
    gyroscopic = {"load": np.array([0.0, -9.81 * MASS, 0.0, 0.0, 0.0])} | others
    return rigid(LIGHT, LIGHT, offset=offset, **gyroscopic)


@pytest.mark.long
def test_energy_of_a_dry_rotor_is_kept():
    rotor = dry_pair(load=np.zeros(5))
    start = np.array([1e-6, 0.0, 2e-6, 1e-5, 0.0]), np.array([3e-3, 4e-3, 5e-3, 0.02, 0.03])
    run = simulate_rotor(rotor, speed_rpm=0.0, dt=2e-6, until=5e-3, start=start, rho_inf=1.0)
    kinetic = 0.5 * np.einsum("ki,ij,kj->k", run.velocity, rotor.mass, run.velocity)
    forces = np.array([pair_force(rotor, q) for q in run.displacement])
    power = (forces * run.velocity).sum(axis=1)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * 2e-6)])
    assert np.ptp(kinetic) > 0.5 * kinetic.max()
    assert np.ptp(kinetic + work) < 1e-3 * kinetic.max()


@pytest.mark.long
def test_through_lift_off_against_scipy():
    """The light balls of a pair leave their races; the cage turns by the angles of the others."""
    rotor = dry_pair(offset=1e-6, unbalances=(Unbalance(x=0, y=1, amount=4e-4),))
    rpm = 9000.0
    omega = rpm * RPM_TO_RAD_S
    start = rotor.equilibrium(rpm), np.array([0.02, 0.0, 0.05, 1.0, 0.0])
    run = simulate_rotor(rotor, speed_rpm=rpm, dt=1e-6, until=2.4e-3, start=start)
    lightest = run.ring_force[:, :, 2].min(axis=0)
    assert lightest.min() < 1e-6 and run.ring_force[:, :, 2].max() > 20.0  # a bearing without load, and one with

    def rates(t, z):
        q, v = z[:5], z[5:]
        cage = LIGHT.orders.ftf_order * omega * t
        pressed = sum(turned_force(m, q, cage) for m in rotor.mounts)
        swing = 4e-4 * omega**2 * np.array([np.cos(omega * t), np.sin(omega * t), 0.0, 0.0, 0.0])
        net = rotor.load + swing - pressed - omega * rotor.gyroscopic @ v
        return np.concatenate([v, net / np.diag(rotor.mass)])

    exact = solve_ivp(
        rates, (0.0, 2.4e-3), np.concatenate(start), rtol=1e-8, atol=1e-13, t_eval=run.t[::400], method="DOP853"
    )
    moved = np.abs(exact.y[:5] - exact.y[:5, :1]).max(axis=1)
    np.testing.assert_array_less(np.abs(run.displacement[::400].T - exact.y[:5]).max(axis=1), 4e-3 * moved)


def turned_force(mount, q, cage):
    """As `ring_force`, the balls turned by an angle: a turn of the frame."""
    c, s = np.cos(cage), np.sin(cage)
    turn = np.eye(5)
    turn[:2, :2] = turn[3:, 3:] = [[c, s], [-s, c]]
    return turn.T @ ring_force(mount.bearing, mount.facing, mount.arm, mount.offset, turn @ q)


def test_balls_pass_at_the_order_of_their_contact_angle(spindle):
    load = np.array([0.0, 0.0, 400.0, 0.0, 0.0])
    state = spindle.equilibrium(load, speed_rpm=RPM)
    motion = motion_of(spindle, [RPM], FIVE)
    motion.rest(RPM * RPM_TO_RAD_S, 0.0, np.array(state.displacement))
    for _ in range(100):
        motion.begin(RPM * RPM_TO_RAD_S, 1e-5)
        motion.forces(np.array(state.displacement), np.zeros(5))
        motion.accept()
    passes = spindle.balls * motion.angle / (RPM * RPM_TO_RAD_S * 1e-3)
    assert passes == pytest.approx(state.orders.bpfo_order, abs=1e-4)
    assert abs(spindle.orders.bpfo_order - state.orders.bpfo_order) > 1e-3


def test_run_up_of_a_motor():
    rotor = motor(BallBearing.catalogue("6305", clearance="CN", oil=OIL), preload=200.0)
    run = simulate_rotor(rotor, speed_rpm=SpeedProfile.ramp(3000.0, 9000.0, 0.05), dt=2e-5, until=0.05)
    assert run.ring.shape == (2501, 2, 5)
    np.testing.assert_allclose(run.ring_force[:, :, 2], 200.0, rtol=0.05)
    held = linearise(rotor, 9000.0)
    np.testing.assert_allclose(run.ring_force[-500:, :, 1].mean(axis=0), held.loads[:, 1], rtol=0.1)
    assert "bearing 1 tilt_y" in run.columns


def test_a_ring_that_is_pushed_out_ends_the_run():
    rotor = replace(dry_pair(), mounts=dry_pair().mounts[:1])
    start = np.zeros(5), np.array([0.0, 0.0, -3.0, 0.0, 0.0])
    with pytest.raises(ConvergenceError, match=r"ring of bearing 0 has left it") as caught:
        simulate_rotor(rotor, speed_rpm=0.0, dt=1e-5, until=0.01, start=start)
    assert caught.value.result.t.size > 1


@pytest.mark.parametrize(
    "beside", [(), (ContactMount(0.0, contact=SpringContact.linear(1e3, 1.0, 1e-9, 1e-3, units="SI"), x=0),)]
)
@pytest.mark.parametrize("speed", [-0.3, 0.3])
def test_a_shaft_that_unloads_a_bearing_on_a_spring_ends_the_run(speed, beside):
    """0.3 m/s along the shaft: the balls of one bearing would be pressed on the side without a shoulder."""
    rotor = motor(LIGHT, preload=50.0)
    start = rotor.equilibrium(0.0), np.zeros(rotor.size)
    start[1][rotor.nodes["shaft"]["z"]] = speed
    rotor = replace(rotor, mounts=(*beside, *rotor.mounts))
    with pytest.raises(
        ConvergenceError, match=r"ring of bearing [01] has left its balls, .* mm against"
    ) as caught:
        simulate_rotor(rotor, speed_rpm=0.0, dt=1e-5, until=0.01, start=start)
    run = caught.value.result
    reach = 0.04 * LIGHT.ball_diameter * np.sin(LIGHT.contact_angle)  # both groove centres in one plane
    lowest = run.ring[..., 2].min(axis=1)
    assert lowest[-1] < -reach and (lowest[:-1] >= -reach).all()


def test_a_driven_bearing(spindle):
    motion = BearingMotion(spindle, RPM, 1e-5)
    q = np.array([0.0, -2e-6, 8e-6, 0.0, 0.0])
    rest = motion.rest(q)
    np.testing.assert_allclose(rest[2], spindle.equilibrium(rest, speed_rpm=RPM, cage_angle=-pi / 2.0).load[2])
    places = q + 1e-6 * np.sin(np.linspace(0.0, 2.0 * pi, 50))[:, None] * np.eye(5)[2]
    rates = np.gradient(places, 1e-5, axis=0)
    force, balls = motion.drive(places, rates)
    assert force.shape == (50, 5) and balls.shape == (50, spindle.balls, 2)
    again = BearingMotion(spindle, RPM, 1e-5)
    again.rest(q)
    for place, rate, expected in zip(places, rates, force, strict=True):
        np.testing.assert_allclose(again.forces(place, rate)[0], expected, rtol=1e-12)
        again.accept()


@pytest.mark.parametrize("seed", range(6))
def test_random_rotors_run(seed):
    """Any preload, load, unbalance and speed; light balls lift off in some."""
    rng = np.random.default_rng(seed)
    oil = OIL if seed % 2 else None
    held = BallBearing.catalogue("6205", oil=oil, clearance=str(rng.choice(["C2", "CN", "C3"])))
    pressed = (
        {"preload": float(rng.choice([0.0, 20.0, 300.0]))} if seed % 3 else {"offset": rng.uniform(0.0, 8e-6)}
    )
    rotor = rotor_on_bearings(
        Shaft(length=0.25, diameter=0.025, elements=2),
        discs=[Disc.cylinder(position=rng.uniform(0.08, 0.25), diameter=0.12, width=0.03, bore=0.025,
                             unbalance=10.0 ** rng.uniform(-7.0, -4.5), load=(0.0, 0.0, rng.choice([0.0, 50.0])))],
        supports=[Support(position=0.02, bearing=held, facing="+z"),
                  Support(position=0.2, bearing=held, facing="-z", **pressed)],
    )  # fmt: skip
    run = simulate_rotor(rotor, speed_rpm=rng.choice([1000.0, 6000.0, 15000.0]), dt=1e-5, until=0.02)
    assert np.isfinite(run.ring_force).all() and run.iterations.mean() < 5.0
