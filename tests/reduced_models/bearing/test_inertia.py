"""Balls with inertia towards the rings: against scipy, against balls without, in time as in frequency."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from beam_rotor import block, still_motion, with_light_balls
from scipy.integrate import solve_ivp

from ehlcontact.errors import InputError
from reduced_models import (
    BallBearing,
    BearingMotion,
    simulate_rotor,
)
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.bearing.ring import equilibrium_at
from reduced_models.bearing.ring_statics import equilibrium_under, linear_balls, static_ring

RPM = 3000.0


def test_against_scipy():
    """A block dropped on a dry bearing with clearance, its nine balls in flight and in contact."""
    bearing = BallBearing.catalogue("6205", clearance=1e-5, ball_inertia=True)
    damping = 200.0 * np.eye(2)
    ki, ko = (bearing.race(race).kn for race in ("inner", "outer"))
    m, omega = bearing.density * pi / 6.0 * bearing.ball_diameter**3, RPM * pi / 30.0
    cage = bearing.orders.ftf_order * omega
    thrown = m * 0.5 * bearing.pitch_diameter * cage**2
    rotor = block(bearing, damping=damping)

    def rates(t, z):
        psi = -pi / 2.0 + cage * t + 2.0 * pi / 9.0 * np.arange(9)
        n, w = np.array([np.cos(psi), np.sin(psi)]), z[4:13]
        inner = ki * np.maximum(z[:2] @ n - 5e-6 - w, 0.0) ** 1.5
        outer = ko * np.maximum(w, 0.0) ** 1.5
        net = np.array([0.0, -300.0]) - damping @ z[2:4] - n @ inner
        return np.concatenate([z[2:4], net / 2.0, z[13:], (inner + thrown - outer) / m])

    start = np.array([2e-6, -8e-6]), np.array([0.0, 1e-3])
    it = BearingMotion(bearing, RPM, 1e-6)
    it.rest(start[0])
    first = np.concatenate([*start, [it._motion.approach(k, "outer") for k in range(9)], np.zeros(9)])
    exact = solve_ivp(rates, (0.0, 1e-3), first, method="DOP853", rtol=1e-9, atol=1e-15, t_eval=[5e-4, 1e-3])
    errors = []
    for dt in (1e-6, 5e-7):
        run = simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=1e-3, start=start)
        at = run.displacement[[round(5e-4 / dt), round(1e-3 / dt)]]
        errors.append(np.abs(at.T - exact.y[:2]).max() / np.ptp(run.displacement, axis=0).max())
    assert errors[0] < 1e-5
    assert errors[1] < 0.3 * errors[0]


@pytest.mark.parametrize("oiled", [True, False])
def test_small_motions_in_time_have_the_impedance(oil, oiled):
    """At half the frequency of the balls on their contacts, where their inertia counts."""
    bearing = BallBearing.catalogue("6205", oil=oil if oiled else None, ball_inertia=True, loss_factor=0.1)
    still = with_light_balls(bearing)
    at = equilibrium_under(still, np.array([0.0, -1000.0]), RPM, -pi / 2.0)
    hz, size, periods, per_period = 15e3, 1e-11, 40, 400
    omega, dt = 2.0 * pi * hz, 1.0 / (hz * per_period)
    t = dt * np.arange(1, periods * per_period + 1)
    balls = linear_balls(still, RPM, [at])
    Z, massless = (b.impedance(1j * omega) for b in (balls, replace(balls, inertia=0.0)))
    run = still_motion(bearing, RPM, dt)
    start = run.rest(at.displacement)
    rise = np.minimum(1.0, t * hz / 20.0)[:, None]  # free balls would swing on for ever
    swing = size * rise * np.array([[0.0, 1.0]])
    rate = size * (
        rise * omega * np.cos(omega * t)[:, None] + (rise < 1.0) * hz / 20.0 * np.sin(omega * t)[:, None]
    )
    force, _ = run.drive(at.displacement + swing * np.sin(omega * t)[:, None], rate * np.array([[0.0, 1.0]]))
    last = slice(-per_period, None)
    seen = 2.0 * np.mean((force[last] - start) * np.exp(-1j * omega * t[last])[:, None], axis=0) * 1j / size
    assert abs(Z[1, 1]) < 0.97 * massless[1, 1].real or abs(Z[1, 1]) > 1.03 * massless[1, 1].real
    assert seen[1] == pytest.approx(Z[1, 1], rel=0.01)


@pytest.mark.parametrize("oiled", [True, False])
def test_small_motions_at_contact_angles_have_the_impedance(oil, oiled):
    bearing = BallBearing.catalogue("7205", oil=oil if oiled else None, ball_inertia=True, loss_factor=0.1)
    place = bearing.equilibrium((0.0, -300.0, 800.0), speed_rpm=RPM, cage_angle=0.3).displacement
    small = linear_balls(bearing, RPM, [equilibrium_at(static_ring(bearing, RPM, 0.3, 5), place)])
    hz, size, periods, per_period = 15e3, 1e-11, 40, 100
    omega, dt = 2.0 * pi * hz, 1.0 / (hz * per_period)
    Z, massless = (b.impedance(1j * omega) for b in (small, replace(small, inertia=0.0)))
    motion = motion_of(bearing, [RPM], FIVE)
    start, seen = motion.rest(RPM * RPM_TO_RAD_S, 0.3, place), np.zeros(5, complex)
    for i in range(1, periods * per_period + 1):
        phase, rise = i * dt * omega, min(1.0, i / (20.0 * per_period))
        motion.core.head(motion.state)["cage"] = 0.0  # balls do not go round
        motion.begin(RPM * RPM_TO_RAD_S, dt)
        q, v = np.zeros(5), np.zeros(5)
        q[2], v[2] = size * rise * np.sin(phase), size * rise * omega * np.cos(phase)
        v[2] += size * (rise < 1.0) * hz / 20.0 * np.sin(phase)
        force = motion.forces(place + q, v)[0]
        motion.accept()
        if i > (periods - 1) * per_period:
            seen += 2.0j * (force - start) * np.exp(-1j * phase) / (per_period * size)
    assert abs(Z[2, 2] / massless[2, 2] - 1.0) > 0.03
    np.testing.assert_allclose(seen[:3], Z[:3, 2], rtol=0.0, atol=0.01 * abs(Z[2, 2]))


def test_slow_motions_and_rest_are_those_without(film, oil):
    heavy = BallBearing.catalogue("6205", oil=oil, ball_inertia=True)
    load = (0.0, -1000.0)
    one, other = (b.equilibrium(load, speed_rpm=RPM) for b in (film, heavy))
    np.testing.assert_array_equal(one.force, other.force)
    slow, fast = (
        [b.coefficients(load, speed_rpm=RPM, hz=hz).stiffness[0, 1, 1] for b in (film, heavy)]
        for hz in (200.0, 8e3)
    )
    assert slow[1] == pytest.approx(slow[0], rel=1e-4)
    assert abs(fast[1] / fast[0] - 1.0) > 0.005


def test_tangents_are_those_of_differences(oil, shake):
    bearing = BallBearing.catalogue("6205", oil=oil, ball_inertia=True, clearance=3e-6)
    q, v = shake(1e-6, 6)
    it = BearingMotion(bearing, RPM, 1e-6)
    it.rest(np.array([1e-6, -12e-6]))
    it.drive(q[:5], v[:5])
    _, stiffness, damping = it.forces(q[5], v[5])
    for k in range(2):
        for matrix, step, moves in ((stiffness, 1e-10, (1.0, 0.0)), (damping, 1e-6, (0.0, 1.0))):
            move = step * np.eye(2)[k]
            ends = [it.forces(q[5] + s * moves[0] * move, v[5] + s * moves[1] * move)[0] for s in (1, -1)]
            slope = (ends[0] - ends[1]) / (2.0 * step)
            np.testing.assert_allclose(slope, matrix[:, k], rtol=0.0, atol=1e-5 * np.abs(matrix).max())


def test_yes_or_no():
    with pytest.raises(InputError, match=r"ball_inertia = .*True or False"):
        BallBearing.catalogue("6205", ball_inertia=0.002)
