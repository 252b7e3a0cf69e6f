"""Race control: no undamaged bearing in flooded films vibrates by itself; friction that balls need."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingMount, Rotor, linearise

OIL = Lubricant.iso_vg(32, temperature=60.0)
LIGHT = (0.0, -68.065, 89.232, -0.7478, 0.0)  # under which friction that follows its ball lets a rotor vibrate
FAST = 16_890.0
HARRIS_218 = {
    "balls": 16, "ball_diameter": 22.23e-3, "pitch_diameter": 125.3e-3, "contact_angle": radians(40.0),
    "conformity_inner": 0.5232, "conformity_outer": 0.5232,
}  # fmt: skip


def spindle(control, **changes):
    dimensions = {"balls": 13, "ball_diameter": 7.938e-3, "pitch_diameter": 38.5e-3}
    return BallBearing(**dimensions, contact_angle=radians(25.0), race_control=control, oil=OIL, **changes)


def modes(bearing, load=LIGHT, speed=FAST, inertia=(1.103, 2.023e-4, 2.728e-5)):
    """Of a rigid rotor with this mass and these moments of inertia, across and about its axis."""
    mass, across, about = inertia
    gyroscopic = np.zeros((5, 5))
    gyroscopic[3, 4], gyroscopic[4, 3] = about, -about
    mount = BearingMount(bearing=bearing, x=0, y=1, z=2, tilt_x=3, tilt_y=4)
    mass = np.diag([mass, mass, mass, across, across])
    rotor = Rotor(
        mass=mass, stiffness=np.zeros((5, 5)), gyroscopic=gyroscopic, load=np.array(load), mounts=(mount,)
    )
    return linearise(rotor, speed_rpm=speed, passage=False).modes(5)


@pytest.mark.long
@pytest.mark.parametrize("control", ["inner", "shared", "outer", "harris"])
def test_no_flooded_bearing_vibrates_by_itself(control):
    """With friction that follows the place of a ball, "inner" grew with 40 1/s and "shared" with 1.2 1/s."""
    for load in (LIGHT, (0.0, -30.0, 60.0, 0.0, 0.0), (0.0, -200.0, 400.0, 1.0, 0.0)):
        assert all(mode.eigenvalue.real < 0.0 for mode in modes(spindle(control), load))


# Three of the 54 of 100 random spindles with outer race control that grow with friction that follows its ball
GROWING = {
    "light": (
        {"balls": 18, "ball_diameter": 10.84e-3, "pitch_diameter": 70.71e-3, "contact_angle": radians(29.4)},
        Lubricant.iso_vg(32, temperature=52.0),
        (15_230.0, (-243.5, 31.0, 277.2, 1.255, 1.498), (2.497, 3.83e-3, 3.04e-3)),
    ),
    "radial": (
        {"balls": 13, "ball_diameter": 9.543e-3, "pitch_diameter": 47.08e-3, "contact_angle": radians(20.6)},
        Lubricant.iso_vg(46, temperature=65.0),
        (15_390.0, (-48.8, 194.4, 208.3, 0.52, -0.176), (0.915, 2.88e-4, 2.36e-4)),
    ),
    "axial": (
        {"balls": 15, "ball_diameter": 9.579e-3, "pitch_diameter": 53.59e-3, "contact_angle": radians(25.7)},
        Lubricant.iso_vg(46, temperature=69.0),
        (17_870.0, (-206.5, 113.9, 623.5, 1.556, 0.842), (10.47, 1.74e-2, 1.32e-2)),
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("control", ["outer", "harris"])
@pytest.mark.parametrize("case", GROWING)
def test_symmetric_part_of_friction_lets_no_spindle_vibrate(request, control, case):
    """Stiffness changes by less than two thousandths; with friction that follows its ball, they grow."""
    dimensions, oil, (speed, load, inertia) = GROWING[case]
    bearing = BallBearing(**dimensions, race_control=control, oil=oil)
    every = modes(bearing, load, speed, inertia)
    assert all(mode.eigenvalue.real < 0.0 for mode in every)
    still = bearing.coefficients(load, speed_rpm=speed, hz=100.0).stiffness[0]
    request.getfixturevalue("friction_follows")
    following = modes(bearing, load, speed, inertia)
    assert max(mode.eigenvalue.real for mode in following) > 0.1
    follows = bearing.coefficients(load, speed_rpm=speed, hz=100.0).stiffness[0]
    np.testing.assert_allclose(np.diag(still), np.diag(follows), rtol=2e-3, atol=0.0)


@pytest.mark.long
@pytest.mark.parametrize("control", ["inner", "shared", "outer", "harris"])
def test_forces_on_a_ball_have_a_potential(control):
    """Stiffness is symmetric at every frequency, where that of the state, which friction follows, is not."""
    bearing = spindle(control)
    still = bearing.coefficients(LIGHT, speed_rpm=FAST, hz=[10.0, 2000.0])
    for matrices in (still.stiffness, still.damping):
        np.testing.assert_allclose(matrices, matrices.swapaxes(1, 2), rtol=0.0, atol=1e-9 * np.abs(matrices).max())
    assert (np.linalg.eigvalsh(still.damping) > 0.0).all()
    state = bearing.equilibrium(LIGHT, speed_rpm=FAST).stiffness
    assert np.abs(state - state.T).max() > 1e-3 * np.abs(state).max()


def test_friction_that_holds_the_gyroscopic_moment():
    """J omega_m omega_R sin(beta) over half a diameter and the force of the race; above 0.05 states say so."""
    fast = BallBearing(**HARRIS_218).equilibrium((0.0, 0.0, 17_800.0, 0.0, 0.0), speed_rpm=15_000.0)
    assert fast.largest_gyroscopic_friction == pytest.approx(0.0853, abs=5e-5)
    assert "outer race" in fast.friction_note and "friction of 0.085" in fast.friction_note
    assert fast.friction_note in repr(fast) and fast.to_dict()["friction_note"] == fast.friction_note
    slow = BallBearing(**HARRIS_218).equilibrium((0.0, 0.0, 17_800.0, 0.0, 0.0), speed_rpm=5000.0)
    assert slow.friction_note == "" and 0.0 < slow.largest_gyroscopic_friction < 0.05
    case = replace(spindle("outer"), oil=None).equilibrium((0.0, 0.0, 300.0, 0.0, 0.0), speed_rpm=20_000.0)
    assert case.largest_gyroscopic_friction == pytest.approx(0.0502, abs=5e-5)
    light = spindle("outer").equilibrium(LIGHT, speed_rpm=FAST)
    assert light.largest_gyroscopic_friction == pytest.approx(0.0466, abs=5e-5)
    shared = spindle("shared").equilibrium(LIGHT, speed_rpm=FAST)
    assert (shared.gyroscopic_friction > 0.0).all()
    ball, pitch, omega = 22.23e-3, 125.3e-3, 15_000.0 * np.pi / 30.0
    angle, mass = fast.contact_angles[0, 1], 7800.0 * np.pi / 6.0 * ball**3
    orbit = omega * fast.orbit[0]
    rolling = orbit * pitch / ball  # about an axis along the outer contact, seen from outside
    by_hand = 0.2 * mass * ball * orbit * rolling * np.sin(angle) / fast.force[0, 1]
    assert fast.gyroscopic_friction[0, 1] == pytest.approx(by_hand, rel=2e-3)
    assert BallBearing.catalogue("6205").equilibrium((0.0, -500.0)).friction_note == ""


@pytest.mark.long
def test_modes_about_the_pressure_centre_say_that_films_do_not_damp_them():
    found = modes(spindle("outer"), (0.0, 0.0, 300.0, 0.0, 0.0), 10_000.0)
    undamped = [mode for mode in found if mode.damping_ratio < 1e-5]
    assert len(undamped) == 2 and all("along the surfaces" in mode.reservation for mode in undamped)
    assert all(mode.reservation == "" for mode in found if mode not in undamped)
    assert undamped[0].reservation in repr(undamped[0])
    assert all(
        mode.reservation == "" for mode in modes(spindle("outer", loss_factor=0.02), (0.0, 0.0, 300.0, 0.0, 0.0))
    )
