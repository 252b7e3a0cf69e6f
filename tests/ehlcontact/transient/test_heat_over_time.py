"""Films that heat up in time: vibrations against the impedance, steady films, order in the step, energy."""

import numpy as np
import pytest
from balls import FAST as POINT

from ehlcontact import (
    Domain,
    FreeVibration,
    Grid,
    Heat,
    InputError,
    KeepSettings,
    MoesPoint,
    PrescribedApproach,
    PrescribedLoad,
    TimeSteps,
    TransientContact,
    impedance,
    read,
    save,
    simulate,
    solve_steady,
)

GRID, UNIT = Grid(48), POINT.scales.time
ROLLING = Heat()
GLASS = Heat(0.3, effusivity=(13_000.0, 1_500.0))


def moved(motion, until, steps, thermal=ROLLING, grid=GRID, tol=1e-5):
    """A run in fixed steps, in Moes units as `until` is."""
    time = TimeSteps(until=until * UNIT, dt=until / steps * UNIT, tol=tol)
    return simulate(POINT, motion, grid=grid, thermal=thermal, time=time).dimensionless


def waved(approach, omega, steps, thermal, amplitude=1e-3):
    """K and C of the second of two periods."""
    period = 2.0 * np.pi / omega
    T = np.linspace(0.0, 2.0 * period, 1001)
    run = moved(PrescribedApproach(T, approach + amplitude * np.sin(omega * T)), 2.0 * period, 2 * steps, thermal)
    wave = omega * run.t[-steps:]
    columns = np.column_stack([np.sin(wave), np.cos(wave), np.ones(steps)])
    sine, cosine, _ = np.linalg.lstsq(columns, run.force[-steps:], rcond=None)[0] / amplitude
    return sine, cosine / omega


@pytest.mark.parametrize(
    ("omega", "steps", "given"),
    [pytest.param(1.0, 40, Heat(), marks=pytest.mark.long)]
    + [
        pytest.param(*one, marks=pytest.mark.slow)
        for one in ((0.1, 80, Heat()), (3.0, 60, Heat()), (1.0, 40, GLASS))
    ],
)
def test_small_vibrations_have_the_heated_impedance(omega, steps, given):
    """Isothermal damping is 14 % and more away."""
    heated = impedance(POINT, Omega=omega, grid=GRID, thermal=given).dimensionless
    K, C = waved(heated.film.approach, omega, steps, given)
    assert K == pytest.approx(heated.stiffness[0], rel=1e-3)
    assert C == pytest.approx(heated.damping[0], rel=0.01)
    assert abs(impedance(POINT, Omega=omega, grid=GRID).dimensionless.damping[0] / C - 1.0) > 0.1


def test_a_steady_film_stays():
    film = solve_steady(POINT, grid=GRID, thermal=Heat(), tol=1e-8).dimensionless
    still = moved(PrescribedApproach([0, 1, 2, 3], [film.approach] * 4), 3.0, 15, tol=1e-6)
    np.testing.assert_allclose(still.force, 1.0, atol=1e-7)
    np.testing.assert_allclose(still.warmest_oil, film.temperature.largest, atol=1e-5)


@pytest.mark.slow
def test_steps_are_of_second_order():
    film = solve_steady(POINT, grid=GRID, thermal=Heat()).dimensionless
    T = np.linspace(0.0, 4.0, 4001)
    motion = PrescribedApproach(T, film.approach + 0.05 * np.sin(T) ** 4)
    runs = [moved(motion, 4.0, steps) for steps in (20, 40, 80)]
    for of in (lambda run: run.force, lambda run: run.warmest_oil):
        coarse, middle, fine = (of(run)[:: len(run.t) // 20] for run in runs)
        assert np.abs(coarse - middle).max() > 3.0 * np.abs(middle - fine).max() > 0.0
    assert np.ptp(runs[-1].warmest_oil) > 1.0
    assert max(run.heat_balance.max() for run in runs) < 1e-9


@pytest.mark.long
def test_film_after_a_load_step_is_the_steady_one():
    """Under half more load, in steps longer than the film takes through the contact at last."""
    grid = Grid(48, Domain(-6.0, 2.0, 3.5))
    run = moved(PrescribedLoad([0, 1, 2, 30], [1, 1.5, 1.5, 1.5]), 12.0, 60, grid=grid)
    at = POINT.scales.length * float(run.approach[-1])
    film = solve_steady(POINT, grid=grid, thermal=Heat(), approach=at).dimensionless
    start = solve_steady(POINT, grid=grid, thermal=Heat()).temperature
    assert run.temperature.film_share == pytest.approx(start.film_share, rel=5e-4)
    assert run.force[-1] == pytest.approx(1.5, rel=1e-5)
    assert film.force == pytest.approx(1.5, rel=1e-4)
    assert run.h_central[-1] == pytest.approx(film.h_central, rel=2e-4)
    assert run.warmest_oil[-1] == pytest.approx(film.temperature.largest, abs=0.02)
    assert run.warmest_surface[-1] == pytest.approx(film.temperature.surfaces.max(), abs=0.02)
    assert run.warmest_oil.max() > run.warmest_oil[-1] + 2.0  # compression heats while the load rises


def test_without_a_slope_the_film_is_the_isothermal_one():
    T = np.linspace(0.0, 3.0, 301)
    motion = PrescribedApproach(T, 0.9 + 0.05 * np.sin(2.0 * T))
    cold, warm = (moved(motion, 3.0, 30, given) for given in (None, Heat(temperature_slope=0.0)))
    np.testing.assert_allclose(warm.force, cold.force, atol=1e-6)
    assert cold.temperature is None is cold.warmest_oil
    assert warm.warmest_oil.min() > 10.0


def test_contact_goes_back_to_a_saved_state():
    contact = TransientContact(POINT, grid=GRID, thermal=Heat())
    saved = contact.save_state()
    path = [contact.static_approach + 0.01 * k * POINT.scales.length for k in (1, 2)]
    forces = [contact.advance(0.1 * UNIT, u) for u in path]
    contact.restore_state(saved)
    assert [contact.advance(0.1 * UNIT, u) for u in path] == forces
    cold = TransientContact(POINT, grid=GRID)
    assert cold.h_central > 1.2 * contact.h_central


def test_run_goes_on_from_a_checkpoint(tmp_path):
    """Bit for bit, with the temperatures and what was given to the surfaces."""
    motion, file = FreeVibration(Omega_n=5.13, rate=0.1), tmp_path / "run.h5"
    given = {"grid": GRID, "thermal": Heat()}
    whole = simulate(POINT, motion, **given, time=TimeSteps(until=0.5 * UNIT, dt=0.05 * UNIT))
    half = TimeSteps(until=0.25 * UNIT, dt=0.05 * UNIT)
    simulate(POINT, motion, **given, time=half, keep=KeepSettings(checkpoint=file))
    on = KeepSettings(restart=file)
    again = simulate(POINT, motion, **given, time=TimeSteps(until=0.5 * UNIT, dt=0.05 * UNIT), keep=on)
    for name in ("force", "warmest_oil", "warmest_surface", "heat_balance"):
        np.testing.assert_array_equal(getattr(again, name), getattr(whole, name))
    assert again.temperature.film_share == whole.temperature.film_share
    with pytest.raises(InputError, match="its thermal is"):
        simulate(POINT, motion, grid=GRID, time=half, keep=on)


def test_kept(tmp_path):
    motion = PrescribedApproach([0, 1, 2, 3], [0.91, 0.92, 0.93, 0.94])
    run = moved(motion, 1.0, 4)
    again = read(save(run, tmp_path / "run.h5"))
    np.testing.assert_array_equal(again.warmest_oil, run.warmest_oil)
    assert again.temperature.inputs == run.temperature.inputs
    assert run.to_dict()["temperature"]["film_share"] < 0.9
    assert f"with heat: oil up to {run.warmest_oil.max():.3g} K above the inlet" in str(run)


def test_what_heat_does_not_go_with():
    motion = FreeVibration(Omega_n=5.0, rate=0.1)
    with pytest.raises(InputError, match="left out at a dimensionless point"):
        simulate(MoesPoint(200, 10, 0.5), motion, thermal=Heat())
    with pytest.raises(InputError, match="thermal = 'hot': must be True or a Heat"):
        TransientContact(POINT, thermal="hot")
