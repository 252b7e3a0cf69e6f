"""Supports beside each other: tables of stiffness and damping, contacts and ball bearings on one rotor."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import InputError
from reduced_models import (
    BearingMount,
    ContactMount,
    LinearBearing,
    SpringContact,
    jeffcott_rotor,
    linearise,
    simulate_rotor,
    unbalance_response,
)

K, C = np.array([[4e7, 5e6], [-3e6, 6e7]]), np.array([[800.0, 20.0], [20.0, 900.0]])
RUN = {"speed_rpm": 3000.0, "dt": 2e-5, "until": 0.01}


def linear_block(block, bearing):
    return block(bearing, damping=np.diag([5.0, 5.0]))


def test_constant_stiffness_and_damping_are_solved_by_hand(block):
    rotor = linear_block(block, LinearBearing(K, C))
    w = 300.0
    at = linearise(rotor, w * 30.0 / pi)
    dynamic = K - 2.0 * w * w * np.eye(2) + 1j * w * (C + 5.0 * np.eye(2))
    expected = np.linalg.solve(dynamic, 1e-4 * w * w * np.array([1.0, -1j]))
    np.testing.assert_allclose(at.unbalance_response(omega=w).amplitude[0], expected, rtol=1e-12)
    np.testing.assert_allclose(at.rest, np.linalg.solve(K, [0.0, -300.0]), rtol=1e-10)
    values = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-K / 2.0, -(C + 5.0 * np.eye(2)) / 2.0]]))
    oscillating = np.sort(values[values.imag > 0.0].imag)
    np.testing.assert_allclose([mode.omega for mode in at.modes()], oscillating, rtol=1e-10)
    assert all(mode.support_share == 0.0 for mode in at.modes())  # linear bearings are in the stiffness


def test_the_settled_motion_of_a_linear_rotor_is_its_orbit(block):
    rotor = linear_block(block, LinearBearing(K, C))
    at = linearise(rotor, 3000.0)
    run = simulate_rotor(rotor, **RUN, start=at.orbit(), rho_inf=1.0)
    swing = np.ptp(at.motion(run.t), axis=0)
    assert run.columns == ("bearing 0 x", "bearing 0 y") and run.largest_load.size == 0
    np.testing.assert_array_equal(run.ring[:, 0], run.displacement)
    np.testing.assert_allclose(run.ring_force[:, 0], run.displacement @ K.T + run.velocity @ C.T, rtol=1e-12)
    assert np.abs(run.displacement - at.motion(run.t)).max() < 1e-3 * swing.max()


def test_a_table_is_straight_between_its_speeds(block):
    table = LinearBearing([K, 3.0 * K], [C, 2.0 * C], speeds_rpm=[1000.0, 3000.0])
    for speed, share in ((500.0, 0.0), (1500.0, 0.25), (3000.0, 1.0), (5000.0, 1.0)):
        stiffness, damping = table.at(speed)
        np.testing.assert_allclose(stiffness, (1.0 + 2.0 * share) * K, rtol=1e-14)
        np.testing.assert_allclose(damping, (1.0 + share) * C, rtol=1e-14)
    over = unbalance_response(linear_block(block, table), [1500.0, 3000.0])
    fixed = linearise(linear_block(block, LinearBearing(3.0 * K, 2.0 * C)), 3000.0)
    np.testing.assert_allclose(over.amplitude[1], fixed.unbalance_response(rpm=3000.0).amplitude[0], rtol=1e-12)
    with pytest.raises(InputError, match=r"stiffness = .*of shape \(2, 2, 2\)"):
        LinearBearing(K, C, speeds_rpm=[1.0, 2.0])


def test_steps_in_python_are_those_of_the_compiled_loop(block, film):
    """A contact that pushes with a millionth of the load turns the run into Python."""
    light = SpringContact.linear(3e-3, 0.0, low=1e-6, high=1.0, units="SI")
    rotor = block(film)
    mixed = replace(rotor, mounts=(*rotor.mounts, ContactMount(-pi / 2.0, offset=0.1, contact=light, x=0, y=1)))
    compiled, python = simulate_rotor(rotor, **RUN), simulate_rotor(mixed, **RUN, tolerance=1e-9)
    swing = np.ptp(compiled.displacement, axis=0).max()
    assert np.abs(python.displacement - compiled.displacement).max() < 1e-5 * swing
    assert python.columns == ("contact 0", "bearing 0 x", "bearing 0 y")
    assert np.abs(python.ring_force - compiled.ring_force).max() < 1e-4 * np.ptp(compiled.force)
    np.testing.assert_allclose(python.largest_load, compiled.largest_load, rtol=1e-4)


def test_a_contact_and_a_bearing_carry_together(block):
    """Under one mass: the linear bearing and a contact in parallel."""
    contact = SpringContact.linear(2e7, 50.0, low=1e-9, high=1e-3, units="SI")
    straight = LinearBearing(np.diag([4e7, 6e7]), np.diag([800.0, 900.0]))
    rotor = linear_block(block, straight)
    below = ContactMount(-pi / 2.0, offset=1e-4, contact=contact, x=0, y=1)
    both = replace(rotor, mounts=(*rotor.mounts, below))
    rest = both.equilibrium()
    assert rest[1] == pytest.approx((-300.0 + 2e7 * 1e-4) / 8e7, rel=1e-9)
    alone = linearise(linear_block(block, LinearBearing(np.diag([4e7, 8e7]), np.diag([800.0, 950.0]))), 3000.0)
    together = linearise(both, 3000.0)
    expected = alone.unbalance_response(hz=[20.0, 700.0]).amplitude
    np.testing.assert_allclose(together.unbalance_response(hz=[20.0, 700.0]).amplitude, expected, rtol=1e-9)
    run = simulate_rotor(both, **RUN, start=together.orbit(), tolerance=1e-10, rho_inf=1.0)
    assert np.abs(run.displacement - together.motion(run.t)).max() < 1e-3 * np.ptp(run.displacement)


def test_refused(block, film):
    contact = SpringContact.linear(2e7, 50.0, low=1e-9, high=1e-3, units="SI")
    rotor = jeffcott_rotor(bearings=1, disc_mass=1.0, journal_mass=0.1, shaft_stiffness=1e7)
    for call, match in (
        (lambda: block(film).on([contact]), "contacts = 1: must be one per mount, 0"),
        (lambda: simulate_rotor(block(film), dt=1e-5, until=1e-3), "speed_rpm = None: must be given"),
        (lambda: rotor.on([]), "contacts = 0: must be one per mount, 1"),
        (lambda: rotor.on(contact), "contacts = 'SpringContact': must be a list of contacts"),
        (lambda: simulate_rotor(rotor, dt=1e-5, until=1e-3), r"contacts\[0\] = None: must be a Contact"),
        (lambda: replace(rotor, stiffness=2.0 * rotor.stiffness), "stiffness = 'another matrix': must be the sum"),
        (lambda: linearise(block(film)), "speed_rpm = None: must be given"),
        (lambda: rotor.on([object()]), r"contacts\[0\] = 'object': must be a contact element, a full film, or"),
        (lambda: BearingMount(bearing=1.0, x=0, y=1), "must be a BallBearing"),
    ):
        with pytest.raises(InputError, match=match):
            call()
