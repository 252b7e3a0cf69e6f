"""Rotors about rest: against the coefficients of their bearings, published figures, the time domain."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from beam_rotor import DISC, still_run

from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingMount, Rotor, linearise
from reduced_models.rotor.decay import log_decrement
from reduced_models.rotor.modes import is_new

RPM = 3000.0


def with_coefficients(rotor, at, w):
    """Dynamic stiffness from `BallBearing.coefficients`, at one frequency."""
    found = rotor.stiffness - w * w * rotor.mass + 1j * w * (rotor.damping + RPM * pi / 30.0 * rotor.gyroscopic)
    for mount, load in zip(rotor.mounts, at.loads, strict=True):
        angle = None if at.passage else mount.cage_angle
        c = mount.bearing.coefficients(load, speed_rpm=RPM, cage_angle=angle, omega=w)
        pair = np.ix_((mount.x, mount.y), (mount.x, mount.y))
        found[pair] += c.stiffness[0] + 1j * w * c.damping[0]
    return found


@pytest.mark.parametrize("passage", [True, False])
def test_frequency_response_is_that_of_the_coefficients(film, beam, passage):
    rotor = beam(film)
    at = linearise(rotor, RPM, passage=passage)
    np.testing.assert_allclose(at.loads, [[0.0, -500.0]] * 2, atol=1e-6)
    omega = np.geomspace(10.0, 1e6, 9)
    for w, found in zip(omega, at.receptance(omega=omega), strict=True):
        expected = with_coefficients(rotor, at, w)
        np.testing.assert_allclose(
            at.dynamic_stiffness(1j * w), expected, rtol=1e-12, atol=1e-12 * abs(expected).max()
        )
        exact = np.linalg.inv(expected)
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-9 * abs(exact).max())


def test_first_mode_of_the_beam(film, beam):
    """224.8 Hz with K and C of an independent prototype in ROSS, and 0.0073, light balls damping as heavy ones."""
    first = linearise(beam(film), RPM).modes(2)[0]
    assert first.hz == pytest.approx(224.8, rel=1e-3)
    assert first.decrement == pytest.approx(0.0068, rel=0.01)
    assert first.damping_ratio == pytest.approx(first.decrement / (2.0 * pi), rel=1e-4)


def test_modes_are_roots_with_the_memory_at_their_own_frequency(film, beam):
    at = linearise(beam(film), RPM)
    modes = at.modes()
    assert len(modes) == 8
    assert np.all(np.diff([mode.omega for mode in modes]) > 0.0)
    for mode in modes:
        T = at.dynamic_stiffness(mode.eigenvalue)
        assert np.linalg.norm(T @ mode.shape) < 1e-9 * np.linalg.norm(T) * np.linalg.norm(mode.shape)
        assert np.abs(mode.shape).max() == pytest.approx(1.0)
        # K + i w C at the mode's frequency on the real axis is not the same: damping moves it
        frozen = with_coefficients(at.rotor, at, mode.omega)
        assert np.linalg.norm(frozen @ mode.shape) > 1e-7 * np.linalg.norm(T) * np.linalg.norm(mode.shape)


def test_all_modes_of_a_dry_rotor_are_those_of_its_matrices(dry, beam):
    """Real bearing matrices: numpy knows all eigenvalues."""
    rotor = beam(dry)
    at = linearise(rotor, RPM)
    stiffness = rotor.stiffness.copy()
    for mount, load in zip(rotor.mounts, at.loads, strict=True):
        pair = np.ix_((mount.x, mount.y), (mount.x, mount.y))
        stiffness[pair] += dry.coefficients(load, speed_rpm=RPM, hz=1.0).stiffness[0]
    size, one = rotor.size, np.eye(rotor.size)
    inverse = np.linalg.inv(rotor.mass)
    system = np.block(
        [[np.zeros((size, size)), one], [-inverse @ stiffness, -inverse @ rotor.gyroscopic * RPM * pi / 30.0]]
    )
    expected = np.sort(np.linalg.eigvals(system).imag)[size:]
    found = at.modes(None)
    np.testing.assert_allclose([mode.omega for mode in found], expected, rtol=1e-6)
    # slopes in the load direction turn a mode into straight lines; a disc that tilts whirls
    straight, whirling = [mode.whirl for mode in found[:2]], [mode.whirl for mode in found[2:4]]
    np.testing.assert_allclose(straight, 0.0, atol=0.01)
    assert whirling[0] < -0.5 < 0.5 < whirling[1]


@pytest.mark.long
def test_free_decay_in_time_is_that_of_the_first_mode(film, beam):
    """Balls standing still, so that nothing is averaged: the run decays as the eigenvalue says."""
    rotor = beam(replace(film, density=1e-6), gyroscopic=None)
    at = linearise(rotor, RPM, passage=False)
    mode = at.modes(1)[0]
    start = at.rest + (mode.shape * 2e-8).real, (mode.eigenvalue * mode.shape * 2e-8).real
    t, swung = still_run(rotor, RPM, 1e-5, 0.2, start, rho_inf=1.0)
    _, free = still_run(rotor, RPM, 1e-5, 0.2, rho_inf=1.0)
    seen = log_decrement(t, (swung - free)[:, DISC], omega=mode.omega)
    assert seen.hz == pytest.approx(mode.hz, rel=1e-4)
    assert seen.decrement == pytest.approx(mode.decrement, rel=5e-3)


def test_unbalance_response_in_time(film, block):
    """Balls standing still: the steady circle of a run."""
    rotor = block(replace(film, density=1e-6), damping=2e3 * np.eye(2))
    at = linearise(rotor, RPM, passage=False)
    t, moved = still_run(rotor, RPM, 1e-5, 0.1)
    t, swing = t[6000:-1], moved[6000:-1]  # two turns
    seen = 2.0 * np.mean((swing - swing.mean(axis=0)) * np.exp(-1j * RPM * pi / 30.0 * t)[:, None], axis=0)
    expected = at.unbalance_response(rpm=RPM).amplitude[0]
    np.testing.assert_allclose(seen, expected, rtol=0.0, atol=2e-3 * np.abs(expected).max())


def test_modes_of_one_frequency_are_all_found(film, beam):
    """A shaft that does not turn on round bearings: all modes come in pairs; films that remember for long."""
    round_ = BallBearing.catalogue("6205", oil=film.oil, clearance=-2e-6)
    at = linearise(beam(round_, load=np.zeros(28), gyroscopic=None), 1.0)
    modes = at.modes(None)
    assert len(modes) == 28
    omega = np.array([mode.omega for mode in modes])
    np.testing.assert_allclose(omega[::2], omega[1::2], rtol=1e-5)
    assert np.all(omega[2::2] > 1.00002 * omega[1:-1:2])


def test_a_root_is_new_at_another_place_or_in_another_direction():
    x, y, z = np.eye(3, dtype=complex)
    found = [(-1.0 + 100.0j, x), (-1.0 + 100.0j, y)]
    assert is_new(-1.0 + 101.0j, x, found)
    assert is_new(-1.0 + 100.0j, x + z, found)
    assert not is_new(-1.0 + 100.0j, 1j * x, found)
    assert not is_new(-1.0 + 100.0j, x - 2.0 * y, found)  # of a double root, both are found
    assert is_new(-1.0 + 100.0j, x, [])


def test_sign_of_whirl(block):
    """A preloaded bearing and a gyroscopic block: of exp(i w t) (1, -i), a circle from x to y, w is known."""
    tight, turning = BallBearing.catalogue("6205", clearance=-2e-5), 20000.0 * pi / 30.0
    at = linearise(block(tight, gyroscopic=np.array([[0.0, 2.0], [-2.0, 0.0]]), load=np.zeros(2)), 20000.0)
    stiff = at.support_impedance(1j).real
    np.testing.assert_allclose(stiff, stiff[0, 0] * np.eye(2), atol=1e-3 * stiff[0, 0])
    # 2 (-w^2 + w turning) + stiff = 0 of M q'' + turning G q' + K q
    forward = 0.5 * turning + np.sqrt(0.25 * turning**2 + 0.5 * stiff[0, 0])
    back, ahead = at.modes()
    assert (back.whirl, ahead.whirl) == pytest.approx((-1.0, 1.0), abs=0.01)
    assert ahead.omega == pytest.approx(forward, rel=1e-3)
    assert back.omega == pytest.approx(forward - turning, rel=1e-3)


def test_stability(dry, film, block):
    assert linearise(block(film), RPM).stable
    assert linearise(block(film), RPM).growth < 0.0
    undamped = linearise(block(dry), RPM)
    assert abs(undamped.growth) < 1e-6
    speed_row = np.array([[0.0, 5e7], [-5e7, 0.0]])  # as internal damping does above a critical speed
    assert not linearise(block(film, stiffness=speed_row), RPM).stable
    assert linearise(block(film, stiffness=speed_row), RPM).growth > 100.0
    at = linearise(block(film), RPM)
    pulled = block(film, stiffness=np.diag([-2.0 * at.support_impedance(1e-3).real[0, 0], 0.0]))
    assert not linearise(pulled, RPM).stable  # no vibration grows, it just falls to the side


def test_a_housing_moves_against_the_ring(film, block):
    """Shaft and housing of equal mass on nothing else: the mode is that of half the mass."""
    mount = (BearingMount(bearing=film, x=0, y=1, housing=(2, 3)),)
    soft = np.diag([0.0, 0.0, 1.0, 1.0])
    load = np.array([0.0, -300.0, 0.0, 300.0])
    both = Rotor(mass=np.eye(4), stiffness=soft, mounts=mount, load=load)
    half = linearise(block(film, mass=0.5), RPM).modes()
    found = [mode for mode in linearise(both, RPM).modes(None) if mode.hz > 10.0]
    np.testing.assert_allclose([mode.omega for mode in found], [mode.omega for mode in half], rtol=1e-4)


@pytest.mark.parametrize(
    ("call", "match"),
    [
        (lambda rotor: linearise("rotor", RPM), r"rotor = 'rotor': must be a Rotor"),
        (lambda rotor: linearise(rotor, np.nan), r"speed_rpm = nan: must be"),
        (lambda rotor: linearise(rotor, 3e4), r"speed_rpm = 30000.0: must be at most"),
        (lambda rotor: linearise(rotor, RPM).modes(0), r"count = 0: must be a whole number >= 1"),
        (lambda rotor: linearise(rotor, RPM).receptance(), "frequency"),
        (lambda rotor: linearise(rotor, RPM).receptance(50.0), "frequency"),
    ],
)
def test_bad_input(film, block, call, match):
    with pytest.raises(InputError, match=match):
        call(block(film))
