"""Rings of which some directions are held: against springs in series, against other runs, and in rotors."""

import re
from dataclasses import replace

import numpy as np
import pytest
from refusals import refusals
from scipy.optimize import brentq

from ehlcontact import Lubricant
from reduced_models import (
    BallBearing,
    BearingMotion,
    BearingMount,
    Disc,
    Rotor,
    Shaft,
    SpeedProfile,
    Support,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.bearing.freedoms import FIVE
from reduced_models.rotor.integrate_python import PythonSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.simulate import integrate

RPM = 12000.0


def springs(bearing):
    """Stiffnesses of the dry contacts at both races [N/m^1.5]."""
    return [bearing.race(race).kn for race in ("inner", "outer")]


@pytest.mark.parametrize("clearance", [-3e-6, 0.0, 1.2e-5])
def test_a_planar_ring_rests_on_hertz_springs_and_centrifugal_forces(clearance):
    bearing = BallBearing.catalogue("6305", clearance=clearance)
    place, angle, (inner, outer) = np.array([4e-6, -1.1e-5]), 0.3, springs(bearing)
    cage = 0.5 * (1.0 - bearing.gamma) * RPM * np.pi / 30.0
    thrown = bearing.density * np.pi / 6.0 * bearing.ball_diameter**3 * 0.5 * bearing.pitch_diameter * cage**2
    psi = angle + 2.0 * np.pi / bearing.balls * np.arange(bearing.balls)
    closer = place[0] * np.cos(psi) + place[1] * np.sin(psi) - 0.5 * clearance

    def force(stiffness, approach):
        return stiffness * max(approach, 0.0) ** 1.5

    forces = []
    for delta in closer:
        w = brentq(lambda w, d=delta: force(outer, w) - force(inner, d - w) - thrown, 0.0, 1e-4, xtol=1e-18)
        forces.append((force(inner, delta - w), force(outer, w)))
    motion = BearingMotion(bearing, RPM, 1e-5, cage_angle=angle)
    found, pressed = motion.rest(place), np.array(forces)
    assert pressed[:, 0].min() == 0.0 and pressed[:, 0].max() > 100.0
    assert found == pytest.approx(pressed[:, 0] @ np.column_stack([np.cos(psi), np.sin(psi)]), rel=1e-9)
    np.testing.assert_allclose(motion._motion.loads, pressed, rtol=0.0, atol=1e-9 * pressed.max())


def test_a_ring_that_cannot_tilt_rests_on_springs_between_groove_centres():
    """Balls without mass: both springs of a ball are on the line between the centres, at its contact angle."""
    bearing = BallBearing.catalogue("6305", clearance=1e-5, density=1e-6)
    place, (inner, outer) = np.array([4e-6, -6e-6, 1.2e-4]), springs(bearing)
    grooves, psi = bearing.tables.balls(RPM).grooves, 0.3 + 2.0 * np.pi / bearing.balls * np.arange(bearing.balls)
    directions = np.column_stack([np.cos(psi), np.sin(psi)])
    c = np.column_stack([grooves.radial + directions @ place[:2], np.full(psi.size, place[2])])
    length = np.hypot(*c.T)
    closer = np.maximum(length - grooves.inner - grooves.outer, 0.0)
    force = (closer / (inner ** (-2.0 / 3.0) + outer ** (-2.0 / 3.0))) ** 1.5
    along = (force / length)[:, None] * c
    found = BearingMotion(bearing, RPM, 1e-5, 0.3, directions=FIVE[:3]).rest(place)
    assert force.min() > 0.0
    assert found == pytest.approx([*(along[:, 0] @ directions), along[:, 1].sum()], rel=1e-6)


def swing(directions, size, steps=400, dt=1e-5):
    """Places and rates of a ring that leaves its balls and comes back."""
    t = dt * np.arange(1, steps + 1)[:, None]
    omega = 2.0 * np.pi * np.array([700.0, 900.0, 500.0])
    start, far = np.array([0.0, -6e-6, 6e-5]), size * np.array([1.0, 1.0, 4.0])
    q, v = np.zeros((2, steps, len(directions)))
    q[:, :3], v[:, :3] = start + far * np.sin(omega * t), far * omega * np.cos(omega * t)
    return q, v


@pytest.mark.parametrize("changes", [{}, {"loss_factor": 0.02, "race_control": "shared"}, {"ball_inertia": True}])
def test_directions_that_are_held_are_directions_at_zero(oil, changes):
    bearing = BallBearing.catalogue("6205", oil=oil, clearance=6e-6, **changes)
    found = []
    for directions in (FIVE[:3], FIVE):
        motion = BearingMotion(bearing, 3000.0, 1e-5, directions=directions)
        q, v = swing(directions, 8e-6)
        motion.rest(q[0])
        force, balls = motion.drive(q, v)
        _, stiffness, damping = motion.forces(q[-1], v[-1])
        found.append((force[:, :3], balls, stiffness[:3, :3], damping[:3, :3]))
    assert found[0][0].shape == (400, 3)
    assert (found[0][1][:, :, 0] < 1e-2 * found[0][1].max()).any()
    for held, free in zip(*found, strict=True):
        np.testing.assert_allclose(held, free, rtol=0.0, atol=1e-11 * np.abs(free).max())


@pytest.fixture(scope="module")
def mixed(oil):
    """A rigid body on a radial bearing and, beside it, one that holds it along the shaft and against tilts."""
    places = dict(zip(FIVE, range(5), strict=True))
    return Rotor(
        mass=np.diag([3.0, 3.0, 3.0, 2e-3, 2e-3]),
        stiffness=np.diag([0.0, 0.0, 0.0, 2e4, 2e4]),
        load=[0.0, -400.0, 250.0, 0.0, 0.0],
        mounts=(
            BearingMount(bearing=BallBearing.catalogue("6205", oil=oil), x=0, y=1, name="radial"),
            BearingMount(bearing=BallBearing.catalogue("7205", oil=oil), **places, name="fixed"),
        ),
    )


def test_a_rotor_may_have_bearings_with_and_without_axial_motion(mixed):
    rest = mixed.equilibrium(3000.0)
    start = rest + np.array([2e-6, -1e-6, 1e-6, 0.0, 0.0]), np.zeros(5)
    run = simulate_rotor(mixed, speed_rpm=3000.0, dt=1e-5, until=2e-3, start=start)
    names = [f"radial {axis}" for axis in "xy"] + [f"fixed {axis}" for axis in FIVE]
    assert run.columns == tuple(names) and run.force.shape == (201, 7)
    moved = run.displacement[:, [0, 1, *range(5)]]
    np.testing.assert_allclose(run.approach, moved, rtol=0.0, atol=1e-12 * np.abs(moved).max())
    still = simulate_rotor(mixed, speed_rpm=3000.0, dt=1e-5, until=1e-5).force[0]
    assert still[:2] + still[2:4] == pytest.approx([0.0, -400.0], abs=1e-4) and still[4] == pytest.approx(250.0)
    # Newton's method in Python, through `forces` of each bearing
    prepared = PreparedRun(mixed, 3000.0, 1e-5, 200, start, 0.8)
    other = integrate(prepared, PythonSteps(prepared, 1e-9, 30), None)
    for name in ("displacement", "force", "approach"):
        one, two = getattr(run, name), getattr(other, name)
        np.testing.assert_allclose(one, two, rtol=0.0, atol=1e-8 * np.abs(one).max())


def test_order_of_bearings_with_and_without_axial_motion_is_free(mixed):
    runs = []
    for mounts in (mixed.mounts, mixed.mounts[::-1]):
        run = simulate_rotor(replace(mixed, mounts=mounts), speed_rpm=3000.0, dt=1e-5, until=1e-3)
        runs.append(run.force[:, [run.columns.index(f"fixed {axis}") for axis in FIVE]])
    np.testing.assert_allclose(*runs, rtol=0.0, atol=1e-7 * np.abs(runs[0]).max())


# Of the planar kernels that rotors had up to commit b4b7097c: `run_up`, every 4000th step, forces of bearing 0 [N]
# and the disc [m]. To make them anew, print `run.force[4000::4000, :2]` and `run.disc[4000::4000]`.
FORCE = [
    [-1.9685193087116808, -36.72712280394039],
    [-5.591933777072291, -73.05504370747175],
    [30.592728824711898, -53.24465447862012],
    [33.11993801230332, -7.0423735365008024],
    [-1.9200770775033682, 10.355662016841885],
]
DISC = [
    [-3.1753058815077462e-06, -5.8065891328694108e-05],
    [-9.0505428064314316e-06, -1.1693085901245526e-04],
    [4.9788079472195445e-05, -8.4561625842461560e-05],
    [5.3891130840812553e-05, -9.9481403250202485e-06],
    [-2.7260127348669256e-06, 1.8583495393771210e-05],
]


def run_up(oil):
    """A disc between two bearings, from 3000 to 9000 rev/min; its first critical speed is at 5400."""
    bearing = BallBearing.catalogue("6205", oil=oil)
    rotor = rotor_on_bearings(
        Shaft(length=0.4, diameter=0.02, density=7800.0, elements=2),
        discs=[Disc.cylinder(position=0.2, diameter=0.16, width=0.03, bore=0.02, unbalance=2e-5)],
        supports=[Support(position=0.0, bearing=bearing), Support(position=0.4, bearing=bearing)],
    )
    return simulate_rotor(rotor, speed_rpm=SpeedProfile.ramp(3000.0, 9000.0, 0.4), dt=2e-5, until=0.4)


@pytest.mark.long
def test_a_run_up_through_a_critical_speed_is_what_it_was(oil):
    run = run_up(oil)
    far = np.hypot(*run.disc.T)
    assert run.speed_rpm[far.argmax()] == pytest.approx(5405.0, abs=2.0)
    for now, recorded in ((run.force[4000::4000, :2], FORCE), (run.disc[4000::4000], DISC)):
        np.testing.assert_allclose(now, recorded, rtol=0.0, atol=1e-9 * np.abs(recorded).max())


OILED = BallBearing.catalogue("7205", oil=Lubricant.iso_vg(68, temperature=50.0))
ALLOWED = re.escape('must be ("x", "y"), ("x", "y", "z") or ("x", "y", "z", "tilt_x", "tilt_y")')

test_other_directions_are_refused = refusals(
    *(
        (lambda d=directions: BearingMotion(OILED, 3000.0, 1e-5, directions=d), f"directions = .*{ALLOWED}")
        for directions in (("x",), ("y", "x"), ("x", "z"), "xy", 2, ("x", "y", "z", "tilt_x"))
    )
)
