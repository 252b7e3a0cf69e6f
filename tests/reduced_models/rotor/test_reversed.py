"""Runs of a shaft that turns backward: mirror images, x for -x, of those of the shaft that turns forward."""

from math import pi

import numpy as np
import pytest
from refusals import refusals

from ehlcontact import Lubricant
from reduced_models import (
    BallBearing,
    BallWaviness,
    BearingMount,
    RaceWaviness,
    Rotor,
    SpeedProfile,
    Unbalance,
    linearise,
    simulate_rotor,
)
from reduced_models.bearing.motion import BearingMotion
from reduced_models.rotor.capacitance_run import capacitance_of_run

OIL = Lubricant.iso_vg(68, temperature=50.0)
MIRROR = np.array([-1.0, 1.0, 1.0, 1.0, -1.0])  # x; tilt about y is that of an axis
FIVE = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
POLAR, RPM = 0.012, 6000.0


def waves(side):
    """One wave pattern on each surface, or their mirror images: theta there is pi less that here."""
    ring = {"waves": 10, "amplitude": 1e-7}
    phase = 0.4 if side > 0.0 else 10.0 * pi % (2.0 * pi) - 0.4
    balls = BallWaviness(ball=2 if side > 0.0 else 9 - 2, waves=4, amplitude=1e-7, phase=side * 0.3)
    return [RaceWaviness(race=race, phase=phase, **ring) for race in ("inner", "outer")] + [balls]


def rotor(side, features=True, oil=OIL):
    """On a deep-groove bearing with five degrees of freedom; gyroscopic moments, an unbalance, waviness."""
    bearing = BallBearing.catalogue("6205", oil=oil, clearance=10e-6, features=waves(side) if features else ())
    gyroscopic = np.zeros((5, 5))
    gyroscopic[3, 4], gyroscopic[4, 3] = POLAR, -POLAR
    return Rotor(
        mass=np.diag([3.0, 3.0, 3.0, 0.01, 0.01]),
        stiffness=np.diag([1e6, 1e6, 0.0, 1e4, 1e4]),
        damping=np.diag([50.0, 50.0, 50.0, 0.5, 0.5]),
        gyroscopic=gyroscopic,
        mounts=(BearingMount(bearing=bearing, **FIVE, arm=0.02, cage_angle=0.5 * pi + side * 0.4),),
        load=MIRROR ** (side < 0.0) * [60.0, -200.0, 150.0, 0.3, -0.2],
        unbalances=(Unbalance(x=0, y=1, amount=2e-5, phase=0.5 * pi + side * 0.7),),
    )


RUN_UP = SpeedProfile(np.array([0.0, 0.005]), np.array([3000.0, RPM]))


@pytest.mark.long
@pytest.mark.parametrize("speed", [RPM, RUN_UP])
def test_a_run_is_the_mirror_image(speed):
    """Of rotor, balls, films, waviness, unbalance and gyroscopic moments."""
    back = -speed if isinstance(speed, float) else SpeedProfile(speed.t, -speed.speed_rpm)
    forward, backward = (
        simulate_rotor(rotor(side), speed_rpm=one, dt=2e-5, until=0.005)
        for side, one in ((1.0, speed), (-1.0, back))
    )
    assert backward.speed_rpm == pytest.approx(-forward.speed_rpm, rel=1e-15)
    scale = np.abs(forward.displacement).max(axis=0)
    assert (np.abs(backward.displacement - forward.displacement * MIRROR) / scale).max() < 1e-12
    assert (np.ptp(forward.displacement[125:], axis=0) > 1e-3 * scale).all()
    hours = [one.life().lives[0].l10rh for one in (forward, backward)]
    assert hours[1] == pytest.approx(hours[0], rel=1e-9)
    mean = [one.ball_bearings[0].mean_loads for one in (forward, backward)]
    assert mean[1][[0, *range(8, 0, -1)]] == pytest.approx(mean[0], rel=1e-9)


def test_stiffness_of_a_step_changes_the_sign_of_xy():
    """Tangents of a bearing that is driven, and its cage."""
    bearing, q = BallBearing.catalogue("6205", oil=OIL), np.array([3e-6, -8e-6])
    ends = []
    for side in (1.0, -1.0):
        motion = BearingMotion(bearing, side * RPM, 1e-5, cage_angle=0.5 * pi + side * 0.4)
        place = q * MIRROR[:2] ** (side < 0.0)
        motion.rest(place)
        steps = 40
        motion.drive(np.tile(place, (steps, 1)), np.zeros((steps, 2)))
        ends.append((*motion.forces(place, np.zeros(2)), motion.cage_angle))
    for forward, backward in zip(ends[0][1:3], ends[1][1:3], strict=True):
        mirrored = forward * np.outer(MIRROR[:2], MIRROR[:2])
        assert backward == pytest.approx(mirrored, rel=1e-9, abs=1e-9 * np.abs(forward).max())
    assert np.abs(ends[0][1][0, 1]) > 1e-3 * np.abs(ends[0][1]).max()
    assert ends[1][3] - 0.5 * pi == pytest.approx(0.5 * pi - ends[0][3], rel=1e-12)


@pytest.mark.long
def test_linear_answers_and_capacitance_of_both_directions():
    runs = [
        simulate_rotor(rotor(side, features=False), speed_rpm=side * RPM, dt=2e-5, until=0.002)
        for side in (1.0, -1.0)
    ]
    forward, backward = (
        capacitance_of_run(rotor(side, features=False), run, every=20).capacitance
        for side, run in zip((1.0, -1.0), runs, strict=True)
    )
    assert backward == pytest.approx(forward, rel=1e-7, abs=0.0)
    hz = [[mode.hz for mode in linearise(rotor(side), side * RPM).modes(5)] for side in (1.0, -1.0)]
    assert hz[1] == pytest.approx(hz[0], rel=1e-9)


test_bad_input_is_one_line = refusals(
    (
        lambda: SpeedProfile.ramp(-100.0, 100.0, 1.0),
        r"speed_rpm = \[-100.0, 100.0\]: must be all >= 0, or all <= 0",
    ),
    (lambda: SpeedProfile.constant(-1e9), "speed_rpm = -1000000000.0"),
    (
        lambda: BearingMotion(BallBearing.catalogue("6205", oil=OIL), -1e5, 1e-6),
        "speed_rpm = 100000.0: must be at most",
    ),
)
