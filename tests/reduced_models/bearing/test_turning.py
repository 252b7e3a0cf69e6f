"""Bearings whose outer ring turns, or both rings: against speeds of points, and against the inner ring turning."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from refusals import refusals

from ehlcontact import Geometry, Grid, Lubricant, OperatingPoint, read, save, solve_steady
from ehlcontact.lubricant import LimitingShear
from reduced_models import (
    BallBearing,
    BallWaviness,
    BearingMount,
    BearingSet,
    RaceWaviness,
    Rotor,
    Spall,
    Unbalance,
)
from reduced_models.bearing.cage_slip import cage_slip
from reduced_models.bearing.kinematics import DefectOrders, RingSpeeds
from reduced_models.bearing.measured_order import angle_from_order
from reduced_models.bearing.motion import BearingMotion
from reduced_models.life.bearing_life import power_mean

OIL = Lubricant.iso_vg(68, temperature=50.0)
INNER = BallBearing.catalogue("6205", oil=OIL, rq_ball=2e-8, rq_race=1e-7)
OUTER, SPOOLS = replace(INNER, turning="outer"), replace(INNER, turning=(12000.0, -9000.0))
RPM = 6000.0
LIGHT = {"density": 1e-15}  # kg/m3: balls without inertia
TURNING = ("inner", "outer", (12000.0, -9000.0), (1.0, 2.5), (-4.0, 1.0))
LAW = LimitingShear(0.07)


def light(bearing, **changes):
    return replace(bearing, **LIGHT, **changes)


@pytest.mark.parametrize("turning", TURNING)
@pytest.mark.parametrize("slip", [0.0, 0.03])
@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_orders_by_surface_speeds(turning, slip, angle):
    """Points of both races pass a ball at its contacts; its surface has the mean of their speeds."""
    balls, D, pitch, rings = 9, 7.94e-3, 39.04e-3, RingSpeeds.of(turning)
    inner, outer = (0.5 * (pitch + side * D * np.cos(angle)) for side in (-1.0, 1.0))
    cage = (rings.inner * inner + rings.outer * outer) / (inner + outer) * (1.0 - slip)
    speeds = (rings.inner - cage) * inner, (cage - rings.outer) * outer
    found = DefectOrders.of(balls, D / pitch, np.cos(angle), rings).with_slip(slip, rings)
    assert found.ftf_order == pytest.approx(cage, rel=1e-12)
    passed = balls * abs(cage - rings.outer), balls * abs(rings.inner - cage)
    assert (found.bpfo_order, found.bpfi_order) == pytest.approx(passed, rel=1e-12)
    assert found.bsf_order == pytest.approx(abs(np.mean(speeds)) / (0.5 * D), rel=1e-12)


def test_orders_of_the_outer_ring_by_relative_kinematics():
    """Seen from the outer ring all goes as with the inner one turning, but for the turns of the cage."""
    inner, outer = INNER.orders, OUTER.orders
    assert outer.ftf_order == pytest.approx(1.0 - inner.ftf_order, rel=1e-12)
    for name in ("bpfo_order", "bpfi_order", "bsf_order"):
        assert getattr(outer, name) == pytest.approx(getattr(inner, name), rel=1e-12)
    assert outer.at(RPM).ftf == pytest.approx(RPM / 60.0 * outer.ftf_order)
    load = (0.0, -200.0, 300.0)
    under = [replace(one, oil=None).orders_under(load) for one in (INNER, OUTER)]  # balls at rest have no inertia
    assert under[1].ftf_order == pytest.approx(1.0 - under[0].ftf_order, rel=1e-9)
    assert under[1].bpfo_order == pytest.approx(under[0].bpfo_order, rel=1e-9)
    measured = angle_from_order(OUTER, bpfi_order=under[1].bpfi_order, error=1e-4, slip=0.0)
    assert tuple(measured) == pytest.approx(
        tuple(angle_from_order(INNER, bpfi_order=under[0].bpfi_order, error=1e-4)), rel=1e-9
    )


@pytest.mark.parametrize("load", [(0.0, -1000.0), (0.0, -600.0, 300.0)])
@pytest.mark.parametrize("turning", ["outer", pytest.param(TURNING[2], marks=pytest.mark.long)])
def test_without_inertia_of_balls_both_rings_are_alike(load, turning):
    """Loads, films, K and C of light balls are those of the inner ring turning at the same relative speed."""
    inner, other = (light(INNER, turning=one).equilibrium(load, speed_rpm=RPM) for one in ("inner", turning))
    for name in ("force", "h_central", "h_min", "rolling_torque", "skf_rolling"):
        assert getattr(other, name) == pytest.approx(getattr(inner, name), rel=1e-12, abs=0.0)
    K, other_K = (
        light(INNER, turning=one).coefficients(load, speed_rpm=RPM, hz=100.0) for one in ("inner", turning)
    )
    assert other_K.stiffness == pytest.approx(K.stiffness, rel=1e-9, abs=1e-9 * K.stiffness.max())
    assert other_K.damping == pytest.approx(K.damping, rel=1e-9, abs=1e-9 * K.damping.max())
    if len(load) == 2:
        slips = [cage_slip(light(INNER, turning=one), load, speed_rpm=RPM, law=LAW) for one in ("inner", turning)]
        lost = [
            slip * light(INNER, turning=one).orders.ftf_order
            for slip, one in zip(slips, ("inner", turning), strict=True)
        ]
        assert lost[1] == pytest.approx(RingSpeeds.of(turning).sense * lost[0], rel=1e-6)


@pytest.mark.parametrize("turning", TURNING)
def test_balls_have_the_centrifugal_force_of_their_orbit(turning):
    """What the outer race carries beside the inner one, in a planar bearing: m omega_cage^2 dm/2, by hand."""
    rings = RingSpeeds.of(turning)
    state = replace(INNER, turning=turning).equilibrium((0.0, -1000.0), speed_rpm=RPM)
    D, pitch = INNER.ball_diameter, INNER.pitch_diameter
    inner, outer = 0.5 * (pitch - D), 0.5 * (pitch + D)
    cage = (rings.inner * inner + rings.outer * outer) / pitch * RPM * pi / 30.0
    force = INNER.density * pi / 6.0 * D**3 * cage**2 * 0.5 * pitch
    assert state.force[:, 1] - state.force[:, 0] == pytest.approx(np.full(9, force), rel=1e-7, abs=1e-9)


def test_a_gyroscopic_moment_of_the_other_direction():
    """The cage goes round as before, balls turn about themselves the other way: friction is the other way too."""
    bearing = BallBearing.catalogue("7205")
    inner, outer = (replace(bearing, turning=one) for one in ("inner", "outer"))
    at = [one.equilibrium((0.0, 0.0, 500.0), speed_rpm=10000.0) for one in (inner, outer)]
    assert at[0].gyroscopic_friction[0, 1] > 0.0 > at[1].gyroscopic_friction[0, 1]
    ratio = -at[1].orbit[0] / at[0].orbit[0]
    turned = [one.gyroscopic_friction[0, 1] * one.force[0, 1] for one in at]
    assert turned[1] / turned[0] == pytest.approx(ratio, rel=0.02)


@pytest.mark.long
def test_films_against_solved_contacts():
    """Of the most loaded ball at both races, with surface speeds by hand: within 2 %."""
    state = OUTER.equilibrium((0.0, -1000.0), speed_rpm=RPM)
    D, pitch, omega = OUTER.ball_diameter, OUTER.pitch_diameter, RPM * pi / 30.0
    cage = omega * 0.5 * (pitch + D) / pitch  # of an outer ring that turns, the inner one still
    for column, (name, side) in enumerate((("inner", -1.0), ("outer", 1.0))):
        track = 0.5 * (pitch + side * D)
        race = abs((0.0 if name == "inner" else omega) - cage) * track  # seen from the cage, as that of the ball
        body = Geometry.ball_bearing(D, pitch, 0.52, name)
        solved = solve_steady(OperatingPoint(body, OIL, float(state.force[0, column]), 2.0 * race), grid=Grid(256))
        assert state.h_central[0, column] == pytest.approx(solved.h_central, rel=0.02, abs=0.0)
        assert state.h_min[0, column] == pytest.approx(solved.h_min, rel=0.02, abs=0.0)


def test_life_has_the_exponents_of_the_rings_that_turn(tmp_path):
    """Against a load that stands still: 10/3 of a ring that does too, 3 of one that turns."""
    for bearing, powers in ((INNER, (3.0, 10.0 / 3.0)), (OUTER, (10.0 / 3.0, 3.0)), (SPOOLS, (3.0, 3.0))):
        state = bearing.equilibrium((0.0, -1000.0), speed_rpm=RPM)
        found = state.life()
        expected = [power_mean(state.force[:, k], power) for k, power in enumerate(powers)]
        assert (found.q_ei, found.q_ee) == pytest.approx(tuple(expected), rel=1e-12)
        save(state, tmp_path / "state.npz")
        again = read(tmp_path / "state.npz")
        assert again.life().l10r == pytest.approx(found.l10r, rel=1e-12)
    shorter = [one.equilibrium((0.0, -1000.0), speed_rpm=RPM).life().l10r for one in (INNER, OUTER)]
    assert shorter[1] < 0.95 * shorter[0]


def test_defects_turn_with_their_ring():
    """A spall of the outer ring that turns goes through the load zone, one of the inner ring stays where it is."""
    pit = {"angle": -pi / 2.0, "length": 1e-3, "depth": 1e-7}
    found = {}
    for race in ("inner", "outer"):
        lines = OUTER.excitation([Spall(race=race, **pit)], (0.0, -1000.0), speed_rpm=RPM)
        strong = lines.order[lines.amplitude.max(axis=1) > 0.05 * lines.amplitude.max()]
        own = getattr(OUTER.orders, "bpfi_order" if race == "inner" else "bpfo_order")
        away = strong[:, None] - own * np.arange(-300.0, 301.0)
        off = away if race == "inner" else away - np.rint(away)  # sidebands at whole turns of the ring
        assert np.abs(off).min(axis=1).max() < 1e-8
        found[race] = np.abs(away).min(axis=1).max()
    assert found["outer"] > 0.1


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_equilibria_over_features_of_a_ring_that_turns(race):
    """The outer ring turned by an angle has its waves there; the inner one stands still."""
    wave, load = RaceWaviness(race=race, waves=7, amplitude=1e-6, phase=0.3), (0.0, -1000.0)
    turned = replace(OUTER, features=[wave]).equilibrium(load, speed_rpm=RPM, shaft_angle=0.1)
    there = replace(wave, phase=0.3 + (0.7 if race == "outer" else 0.0))
    still = replace(OUTER, features=[there]).equilibrium(load, speed_rpm=RPM)
    assert turned.force == pytest.approx(still.force, rel=1e-6)  # tables of waves have places of their own


@pytest.mark.parametrize("feature", [
    RaceWaviness(race="outer", waves=30, amplitude=2e-7, phase=0.5),
    RaceWaviness(race="inner", waves=30, amplitude=2e-7, phase=0.5),
    BallWaviness(ball=0, waves=6, amplitude=2e-7, phase=0.5),
])  # fmt: skip
def test_runs_by_relative_kinematics(feature):
    """A ring held in the middle: light balls have the loads of the mirror image with the inner ring turning."""
    steps, forces, angles = 400, [], []
    for turning, side in (("inner", 1.0), ("outer", -1.0)):
        waves = replace(feature, phase=side * feature.phase)
        bearing = light(INNER, clearance=-4e-6, turning=turning, features=[waves])
        motion = BearingMotion(bearing, RPM, 60.0 / RPM / steps, cage_angle=side * 0.2)
        forces.append(motion.drive(np.zeros((steps, 2)), np.zeros((steps, 2)))[1])
        angles.append(motion.cage_angle - side * 0.2)
    assert sum(angles) == pytest.approx(2.0 * pi, rel=1e-9)
    assert np.ptp(forces[0], axis=0).max() > 1.0
    mirror = [0, *range(8, 0, -1)]
    assert forces[1][:, mirror] == pytest.approx(forces[0], rel=1e-9)


def test_sets_turn_together():
    wheel = BallBearing.catalogue("7205", oil=OIL, turning="outer")
    pair = BearingSet.pair(wheel, "back to back", preload=200.0)
    state = pair.equilibrium((0.0, -500.0, 100.0), speed_rpm=3000.0)
    assert all(one.orders.ftf_order == pytest.approx(0.58, abs=0.01) for one in state.bearings)


def turning_rotor(**more):
    return Rotor(
        mass=np.eye(2), stiffness=np.zeros((2, 2)), mounts=(BearingMount(bearing=OUTER, x=0, y=1),), **more
    )


def test_a_rotor_that_stands_still_is_carried():
    assert turning_rotor(load=np.array([0.0, -100.0])).mounts[0].bearing.turning == "outer"


SPINNING = np.array([[0.0, 1.0], [-1.0, 0.0]])
test_bad_input_is_one_line = refusals(
    (lambda: replace(INNER, turning="both"), "turning = 'both': must be \"inner\", \"outer\", or the speeds"),
    (lambda: replace(INNER, turning=(3.0, 3.0)), "which differ: else nothing rolls"),
    (lambda: replace(INNER, turning=(3.0,)), "turning = "),
    (lambda: replace(INNER, turning=(float("nan"), 1.0)), "turning = "),
    (lambda: replace(INNER, turning=True), "turning = True"),
    (lambda: replace(INNER, turning=None), "turning = None"),
    (lambda: turning_rotor(gyroscopic=SPINNING), r"mounts\[0\].bearing.turning = 'outer': must be \"inner\" in a"),
    (lambda: turning_rotor(unbalances=(Unbalance(x=0, y=1, amount=1e-5),)), "in a rotor with unbalances"),
    (
        lambda: BearingSet(
            bearings=(BallBearing.catalogue("7205"), BallBearing.catalogue("7205", turning="outer")),
            facings=("-z", "+z"), positions=(0.0, 0.02),
        ),
        r"bearings\[1\].turning = 'outer': must be 'inner'",
    ),
)  # fmt: skip
