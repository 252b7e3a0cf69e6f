"""Loss factor of rings and fits: what the filters are, and that time and frequency have the same ones."""

from math import pi

import numpy as np
import pytest
from beam_rotor import block

from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingMotion, linearise, simulate_rotor
from reduced_models.bearing.loss import BAND, loss_of, response
from reduced_models.rotor.decay import log_decrement

RPM = 3000.0


@pytest.mark.parametrize("factor", [1e-3, 0.02, 0.1, 0.2])
def test_one_loss_factor_in_the_band(factor):
    loss = loss_of(factor)
    assert np.all(loss.gains > 0.0) and response(loss, 0.0) == 1.0
    s = 2j * pi * np.geomspace(*BAND, 200)
    found = np.array([response(loss, one) for one in s])
    np.testing.assert_allclose(found.imag / found.real, factor, rtol=3e-3 if factor <= 0.1 else 0.01)
    if factor == 1e-3:  # the stiffening that belongs to it, as the docstring has it
        rise = [abs(response(loss, 2j * pi * hz)) - 1.0 for hz in (5.0, 200.0, 5000.0)]
        np.testing.assert_allclose(rise, [1.4e-3, 3.8e-3, 5.9e-3], atol=0.06e-3)


def test_a_step_is_the_filters_over_a_straight_force():
    """Against a fine Euler walk of y' = p (F - y), F the force of the same motion without losses."""
    loss, dt, fine = loss_of(0.2), 3e-4, 20000
    q, still = np.array([[0.0, -9e-6], [2e-6, -12e-6], [1e-6, -10e-6]]), np.zeros((2, 2))
    bare, lossy = (BearingMotion(BallBearing.catalogue("6205", loss_factor=one), 0.0, dt) for one in (0.0, 0.2))
    start = bare.rest(q[0])
    np.testing.assert_allclose(lossy.rest(q[0]), start, rtol=1e-12)
    tangents = [it.forces(q[1], still[0])[1] for it in (bare, lossy)]
    mu = loss.rates * dt
    np.testing.assert_allclose(tangents[1], (1.0 + loss.gains @ (-np.expm1(-mu) / mu)) * tangents[0], rtol=1e-9)
    forces = np.vstack([start, bare.drive(q[1:], still)[0]])
    y, found = np.tile(start, (loss.rates.size, 1)), lossy.drive(q[1:], still)[0]
    for before, after, force in zip(forces, forces[1:], found, strict=False):
        for share in (np.arange(fine) + 0.5) / fine:
            y += dt / fine * loss.rates[:, None] * (before + share * (after - before) - y)
        np.testing.assert_allclose(force, after + loss.gains @ (after - y), rtol=1e-4)


def test_loss_factor_of_the_coefficients(dry, oil):
    """C = eta K/omega beside that of the films; statics and the balls' loads stay."""
    lossy = BallBearing.catalogue("6205", loss_factor=0.03)
    hz = np.array([10.0, 50.0, 1000.0])
    found = lossy.coefficients((0.0, -800.0), hz=hz)
    for k, one in enumerate(found.omega):
        np.testing.assert_allclose(one * np.diag(found.damping[k]), 0.03 * np.diag(found.stiffness[k]), rtol=0.01)
    bare, same = dry.equilibrium((0.0, -800.0)), lossy.equilibrium((0.0, -800.0))
    np.testing.assert_array_equal(same.stiffness, bare.stiffness)
    films, both = (
        BallBearing.catalogue("6205", oil=oil, **more).coefficients((0.0, -800.0), speed_rpm=RPM, hz=50.0)
        for more in ({}, {"loss_factor": 0.03})
    )
    added = both.damping[0, 1, 1] - films.damping[0, 1, 1]
    assert added == pytest.approx(0.03 * both.stiffness[0, 1, 1] / films.omega[0], rel=0.015)


@pytest.mark.parametrize("factor", [0.01, 0.05])
def test_a_block_dies_away_with_pi_times_the_loss_factor(factor):
    """Dry, balls standing still: in time as in the modes, and as K s^a with the same loss factor has it."""
    bearing = BallBearing.catalogue("6205", loss_factor=factor)
    rotor = block(bearing)
    mode = linearise(rotor, 0.0, passage=False).modes()[1]
    power = 2.0 / pi * np.arctan(factor)  # m s^2 + K s^a = 0: the angle of s is pi/(2 - a)
    expected = 2.0 * pi * np.tan(pi / (2.0 - power) - 0.5 * pi)
    assert mode.decrement == pytest.approx(expected, rel=5e-3) == pytest.approx(pi * factor, rel=0.02)
    rest = rotor.equilibrium(0.0)
    run = simulate_rotor(
        rotor, speed_rpm=0.0, dt=1e-5, until=0.03, start=(rest + np.array([0.0, 1e-9]), np.zeros(2)), rho_inf=1.0
    )
    seen = log_decrement(run.t, run.displacement[:, 1] - rest[1], omega=mode.omega)
    assert seen.hz == pytest.approx(mode.hz, rel=1e-3)
    assert seen.decrement == pytest.approx(mode.decrement, rel=0.02)


def test_large_motions_lose_energy_too():
    """Round trips of a ring through contact and lift-off: a dry bearing gives back all, a lossy one never all."""
    t = np.arange(1, 4001) * 1e-5
    q = 1e-6 * np.column_stack([8.0 * np.sin(2.0 * pi * 300.0 * t), -6.0 + 10.0 * np.cos(2.0 * pi * 100.0 * t)])
    v = np.gradient(q, 1e-5, axis=0)
    work = []
    for factor in (0.0, 0.05):
        it = BearingMotion(BallBearing.catalogue("6205", clearance=4e-6, loss_factor=factor), 0.0, 1e-5)
        it.rest(q[0])
        force, _ = it.drive(q, v)
        mean, step = 0.5 * (force[1:] + force[:-1]), np.diff(q, axis=0)
        work.append(np.einsum("ij,ij->i", mean, step))
    trips = slice(1000, 1000 + 3 * 1000)  # three periods of the whole motion
    put_in = np.abs(work[0][trips]).sum()
    assert abs(work[0][trips].sum()) < 1e-3 * put_in
    assert 0.02 * put_in < work[1][trips].sum() < 0.2 * put_in


@pytest.mark.parametrize("factor", [-0.01, 0.3, float("nan")])
def test_what_is_no_loss_factor(factor):
    with pytest.raises(InputError, match=r"loss_factor = "):
        BallBearing.catalogue("6205", loss_factor=factor)
