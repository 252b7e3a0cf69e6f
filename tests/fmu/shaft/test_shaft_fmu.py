"""FMUs of shafts beside continuous time, their parameters, faults; shaft and bearings as a system."""

from dataclasses import replace

import numpy as np
import pytest
from bearing_fmus import FIVE, OIL, POLAR, RPM, Exported, assert_speeds_are_reached, pressed_pair
from exported import OfRotor, verified
from fmpy.fmi1 import FMICallException
from other_masters import ecospy, libcosimpy, ours
from scipy.integrate import solve_ivp

from ehlcontact import InputError
from fmu import VerificationError, export, export_system, verify_references
from fmu.rotor.model import RotorModel
from fmu.system.master import SystemRun
from reduced_models import (
    BallBearing,
    BearingMount,
    Disc,
    LinearBearing,
    Shaft,
    Support,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.speed_profile import SpeedProfile

INERTIA = POLAR


def flexible():
    """On two 6205, with a disc out of the middle."""
    bearing = BallBearing.catalogue("6205", oil=OIL, clearance=5e-6)
    disc = Disc(position=0.25, mass=4.0, diametral_inertia=0.01, polar_inertia=0.02, unbalance=1e-4, phase=0.3)
    return rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, damping_time=1e-5, elements=2),
        discs=[disc],
        supports=[Support(position=0.02, bearing=bearing), Support(position=0.38, bearing=bearing)],
    )


def shaft_of(rotor, inertia=None):
    """The rotor, with its bearings outside."""
    return OfRotor(rotor, {"outside": "all", "speed_rpm": RPM, "inertia": inertia})


@pytest.fixture(scope="module")
def rotors():
    return {"rigid": pressed_pair(), "flexible": flexible()}


@pytest.fixture(scope="module")
def made(rotors, tmp_path_factory):
    """``made("rigid", 0.02)``: exported once, with that inertia."""
    known = {}

    def make(name, inertia=None, fmi=2):
        if (name, inertia, fmi) not in known:
            path = tmp_path_factory.mktemp("shaft") / "x.fmu"
            export(rotors[name], path, outside="all", speed_rpm=RPM, inertia=inertia, fmi=fmi)
            known[name, inertia, fmi] = Exported(path)
        return known[name, inertia, fmi]

    return make


@pytest.mark.parametrize(
    ("name", "inertia", "fmi"), [("rigid", INERTIA, 2), ("flexible", None, 2), ("flexible", INERTIA, 3)]
)
def test_verifies(made, rotors, name, inertia, fmi):
    path = made(name, inertia, fmi).path
    found = verified(path, shaft_of(rotors[name], inertia))
    assert found.passes and found.motion < 1e-9
    assert verify_references(path).passes


def in_continuous_time(rotor, inertia, forces, torque, until):
    """Displacements, angle and speed of rotor and motor, with the reaction of the unbalance, all at once.

    In x, y and the turn of the shaft inertia is a matrix: the centre of mass moves with both.
    """
    (unbalance,), size = rotor.unbalances, rotor.size
    model = shaft_of(rotor, inertia).model
    push = rotor.load + sum(s.mount.rows(size).T @ f for s, f in zip(model.out, forces, strict=True))

    def rates(t, state):
        q, v, angle, omega = state[:size], state[size : 2 * size], state[-2], state[-1]
        c, s = np.cos(angle + unbalance.phase), np.sin(angle + unbalance.phase)
        whole = np.zeros((size + 1, size + 1))
        whole[:size, :size], whole[size, size] = rotor.mass, inertia
        for place, turn in ((unbalance.x, -s), (unbalance.y, c)):
            whole[place, size] = whole[size, place] = unbalance.amount * turn
        right = np.append(push - (rotor.damping + omega * rotor.gyroscopic) @ v - rotor.stiffness @ q, torque)
        right[unbalance.x] += unbalance.amount * omega**2 * c
        right[unbalance.y] += unbalance.amount * omega**2 * s
        return np.concatenate([v, (a := np.linalg.solve(whole, right))[:size], [omega, a[size]]])

    start = np.concatenate([*model.motion, [0.0, RPM * RPM_TO_RAD_S]])
    found = solve_ivp(rates, (0.0, until), start, method="DOP853", rtol=1e-11, atol=1e-15)
    return found.y[:, -1]


def test_motion_is_that_of_continuous_time(made, rotors):
    """Under forces that stay: gyroscopic moments, unbalance and its reaction on the speed; of second order."""
    rotor, until, torque = rotors["rigid"], 4e-3, 20.0
    forces = np.array([[30.0, 5.0, 20.0, 0.1, -0.2], [-20.0, 40.0, 10.0, 0.3, 0.1]])
    wanted = in_continuous_time(rotor, INERTIA, forces, torque, until)
    gaps = []
    for steps in (200, 400):
        slave = made("rigid", INERTIA).started(inner_step=until / steps)
        slave.set(torque=torque, **{v.name: 0.0 for v in slave.description.modelVariables if "rolling" in v.name})
        names = [name for name in slave.reference if "force_" in name or "moment_" in name]
        names = [name for name in names if name.startswith("bearing")]
        slave.set(**dict(zip(names, forces.ravel().tolist(), strict=True)))
        for k in range(1, steps + 1):
            slave.step_to(k * until / steps)
        found = slave.get(*(f"rotor.{name}" for name in FIVE), "angle", "speed")
        slave.free()
        ends = np.concatenate([wanted[:5], wanted[-2:]])
        gaps.append(np.abs(np.array(found) - ends) / np.abs(ends))
    assert gaps[0].max() < 1e-4
    assert (gaps[1] < 0.27 * gaps[0] + 1e-9).all()


@pytest.mark.parametrize("lead", [0.0, 0.5, 1.0])
def test_the_speed_that_is_given_is_reached_whatever_the_lead(made, lead):
    slave = made("flexible").started(speed=300.0, force_lead=lead)
    assert_speeds_are_reached(slave, [300.0, 250.0, 250.0, 100.0, 0.0, 0.0])
    slave.free()


def test_scales_are_those_of_the_matrices(made, rotors, tmp_path):
    """An FMU with its parameters set, beside one of another rotor."""
    rotor = rotors["flexible"]
    model = shaft_of(rotor).model
    other = replace(
        rotor,
        mass=1.3 * rotor.mass,
        gyroscopic=1.3 * rotor.gyroscopic,
        stiffness=0.8 * rotor.stiffness,
        damping=2.0 * rotor.damping,
        load=0.9 * rotor.load,
    )
    path = export(other, tmp_path / "other.fmu", outside="all", speed_rpm=RPM, start=model.motion)
    names = [f"bearing[{b}].{k}" for b in (1, 2) for k in ("x", "y", "velocity_x", "velocity_y")]
    found = []
    scales = {"mass_scale": 1.3, "stiffness_scale": 0.8, "damping_scale": 2.0, "load_scale": 0.9}
    held = {f"bearing[{b}].force_{k}": float(f) for b in (1, 2) for k, f in zip("xy", (3.0, 50.0), strict=True)}
    for one, values in ((made("flexible"), scales), (Exported(path), {})):
        slave = one.started(**held, **values, **{"disc.velocity_x": 1e-6})  # where the other starts
        for _ in range(300):
            slave.step(2e-6)
        found.append(slave.get(*names))
        slave.free()
    assert found[0] == pytest.approx(found[1], rel=1e-7)


def test_gyroscopic_moments_add_no_energy(made):
    """Nutation of a free rotor: steps of a 280th of its period take a little from it, and never add."""
    slave = made("rigid", None).started(load_scale=0.0)
    names = [v.name for v in slave.description.modelVariables if v.causality == "input"]
    slave.set(**dict.fromkeys(names, 0.0) | {"speed": 6.0 * RPM * RPM_TO_RAD_S, "bearing[1].moment_x": 5.0})
    slave.step(1e-5)
    slave.set(**{"bearing[1].moment_x": 0.0})
    sizes = []
    for _ in range(200):
        slave.step(1e-4)
        sizes.append(np.hypot(*slave.get("rotor.tilt_rate_x", "rotor.tilt_rate_y")))
    slave.free()
    assert np.all(np.diff(sizes[1:]) <= 1e-12 * sizes[1]) and sizes[-1] > (1.0 - 1e-4) * sizes[1]


def test_rolling_torque_holds_a_shaft_that_stands(made):
    slave = made("rigid", INERTIA).started(speed=0.0)
    slave.set(**{"torque": 0.1, "bearing[1].rolling_torque": 0.06, "bearing[2].rolling_torque": 0.05})
    slave.step(1e-5)
    assert slave.get("speed") == [0.0]
    slave.set(torque=0.2)
    slave.step(1e-5)
    assert slave.get("speed")[0] == pytest.approx(0.09 / INERTIA * 1e-5, rel=1e-3)
    slave.set(torque=0.0)
    slave.step(1e-4)
    assert slave.get("speed") == [0.0]
    slave.free()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"mass_scale": 0.0}, "mass_scale must be"),
        ({"damping_scale": -1.0}, "damping_scale and load_scale must be"),
    ],
)
def test_bad_parameters(made, wrong, words):
    one = made("rigid", INERTIA)
    with pytest.raises(FMICallException):
        one.started(**wrong)
    assert words in one.messages[-1]


def test_a_step_that_fails_leaves_a_usable_instance(made):
    one = made("rigid", None)
    slave = one.started()
    slave.set(**{"bearing[1].moment_x": 1e308})
    with pytest.raises(FMICallException):
        slave.step(1e-3)
    assert "too large for a floating-point number" in one.messages[-1]
    slave.set(**{"speed": RPM * RPM_TO_RAD_S, "bearing[1].moment_x": 0.0})
    slave.step(1e-5)
    assert np.isfinite(slave.get("rotor.x")).all()
    slave.free()


def test_bad_models(rotors, tmp_path):
    K = np.array([[1e7, 1e6], [-1e6, 1e7]])
    crossed = replace(
        rotors["rigid"],
        mounts=(*rotors["rigid"].mounts, BearingMount(bearing=LinearBearing(K, 0.0 * K), x=0, y=1)),
    )
    for wrong, field in (
        ({"rotor": "shaft"}, "rotor"),
        ({"rotor": crossed}, "stiffness"),
        ({"rotor": rotors["rigid"], "speed_rpm": -1.0}, "speed_rpm"),
        ({"rotor": rotors["rigid"], "inertia": 0.0}, "inertia"),
        ({"rotor": rotors["rigid"], "start": 0.0}, "start"),
    ):
        with pytest.raises(InputError) as error:
            RotorModel(**{"outside": "all", **wrong})
        assert error.value.field == field


# ---- with its bearings and the torque of its motor

STEP, STEPS, TORQUE = 1e-5, 600, 3.0


@pytest.fixture(scope="module")
def drive(rotors, tmp_path_factory):
    path = tmp_path_factory.mktemp("drive") / "drive.ssp"
    start = shaft_of(rotors["rigid"]).model.motion[0], np.array([0.0, 2e-3, 1e-3, 0.02, 0.0])
    turning = {"inertia": INERTIA, "speeds_rpm": (2000.0, 4000.0), "speed_rpm": RPM}
    export_system(rotors["rigid"], path, start=start, **turning)
    return path, start


NAMES = [f"bearing[{b}].{k}" for b in (1, 2) for k in FIVE]


@pytest.fixture(scope="module")
def run_of_ours(drive):
    with SystemRun(drive[0].read_bytes(), {"rotor": {"torque": TORQUE}}) as run:
        return run.run(STEP, STEPS, [("rotor", name) for name in (*NAMES, "speed")])


def test_a_drive_runs_as_the_rotor_in_python(drive, rotors, run_of_ours):
    """At the speed of the drive, after a blow along the shaft and across it."""
    speed = run_of_ours[:, -1]
    profile = SpeedProfile(STEP * np.arange(STEPS + 1), speed / RPM_TO_RAD_S)
    wanted = simulate_rotor(rotors["rigid"], speed_rpm=profile, dt=2e-6, until=STEP * STEPS, start=drive[1])
    ring = wanted.ring[::5].reshape(STEPS + 1, -1)
    assert (np.abs(run_of_ours[:, :-1] - ring).max(axis=0) < 0.02 * np.ptp(ring, axis=0)).all()


def test_the_torque_that_turns_the_shaft_is_that_of_motor_and_bearings(drive, run_of_ours):
    with SystemRun(drive[0].read_bytes()) as run:
        drag = run.get("bearing_1", "rolling_torque")[0] + run.get("bearing_2", "rolling_torque")[0]
    gained = run_of_ours[-1, -1] - run_of_ours[0, -1]
    assert 1e-3 < drag < 0.1 * TORQUE
    assert gained == pytest.approx(STEP * STEPS * (TORQUE - drag) / INERTIA, rel=2e-3)
    assert abs(gained / (STEP * STEPS * TORQUE / INERTIA) - 1.0) > 3e-3  # without the bearings it would be so


@pytest.mark.parametrize("master", [ecospy, libcosimpy])
def test_a_drive_in_masters_of_others(drive, run_of_ours, master):
    """Without a torque of the motor."""
    wanted = ours(drive[0], STEP, 300, "rotor", [*NAMES, "speed"])[1:]
    found = master(drive[0], STEP, 300, "rotor", [*NAMES, "speed"])[-300:]
    size = np.ptp(wanted, axis=0)  # ours passes on no rolling torque before the first step
    size[-1] = np.ptp(run_of_ours[:301, -1])  # of the speed under the torque
    assert (np.abs(found - wanted).max(axis=0) < 1e-4 * size).all()


@pytest.mark.long
def test_a_step_that_is_too_long_is_not_written(rotors, tmp_path):
    with pytest.raises(VerificationError, match=r"of (its|their) way off|does not run"):
        export_system(
            rotors["rigid"], tmp_path / "x.ssp", inertia=INERTIA, speeds_rpm=RPM, speed_rpm=RPM, step=4e-5,
            start=(shaft_of(rotors["rigid"]).model.motion[0], np.array([0.0, 2e-3, 1e-3, 0.02, 0.0])),
        )  # fmt: skip
    assert not list(tmp_path.iterdir())
