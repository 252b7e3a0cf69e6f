"""Films that heat up over time under a layer of oil, and at a speed that changes."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from balls import FAST as POINT
from oil_march import march

from ehlcontact import (
    Dent,
    Domain,
    Grid,
    Heat,
    KeepSettings,
    OilLayer,
    PrescribedApproach,
    PrescribedLoad,
    SpeedHistory,
    TimeSteps,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.conditions import Conditions
from ehlcontact.solver.mesh import Mesh
from ehlcontact.transient.heat_over_time import passage
from ehlcontact.transient.transient_film import TransientFilm

UNIT = POINT.scales.time
COARSE, WIDER, BOTH_WAYS = Grid(48), Grid(48, Domain(-6.0, 1.5, 3.0)), Grid(48, Domain(-3.0, 3.0, 2.5))
HELD = PrescribedLoad([0.0, 1.0, 2.0, 100.0], [1.0, 1.0, 1.0, 1.0])
GLASS = Heat(0.3, effusivity=(13_000.0, 1_500.0))
ROLLING = Heat()


def moved(until, steps, motion=HELD, grid=COARSE, thermal=ROLLING, tol=1e-5, keep=None, **given):
    """A run in fixed steps; `until` in 2a/u_sum."""
    time = TimeSteps(until=until * UNIT, dt=until / steps * UNIT, tol=tol)
    keep = keep or KeepSettings()
    return simulate(POINT, motion, grid=grid, thermal=thermal, time=time, keep=keep, **given).dimensionless


def columns(run):
    return run.force, run.h_central, run.h_min, run.warmest_oil, run.warmest_surface


@pytest.mark.parametrize(
    ("r", "given"),
    [
        pytest.param(1.0, ROLLING, marks=pytest.mark.long),
        *(pytest.param(r, GLASS, marks=pytest.mark.slow) for r in (1.0, 0.6)),
    ],
)
def test_small_vibrations_under_a_layer_have_the_impedance_of_both(r, given):
    """Isothermal damping under the layer is 15 % and more away."""
    steps, amplitude = 40, 1e-3
    film = solve_steady(POINT, grid=WIDER, supply=OilLayer(over_flooded=r), thermal=given).dimensionless
    layer = OilLayer(H=float(film.layer[0]))
    T = np.linspace(0.0, 4.0 * np.pi, 1001)
    motion = PrescribedApproach(T, film.approach + amplitude * np.sin(T))
    run = moved(T[-1], 2 * steps, motion, WIDER, given, supply=layer)
    wave = np.column_stack([np.sin(run.t[-steps:]), np.cos(run.t[-steps:]), np.ones(steps)])
    K, C, _ = np.linalg.lstsq(wave, run.force[-steps:], rcond=None)[0] / amplitude
    both, cold = (
        impedance(POINT, Omega=1.0, grid=WIDER, supply=layer, thermal=t).dimensionless for t in (given, None)
    )
    assert K == pytest.approx(both.stiffness[0], rel=1e-3)
    assert C == pytest.approx(both.damping[0], rel=0.01)
    assert abs(cold.damping[0] / C - 1.0) > 0.15
    assert run.heat_balance.max() < 1e-8


def marched(U, grid, dT, thermal=ROLLING, layer=None):
    """Film after steps at these speeds; largest losses of oil and of energy in a step."""
    supply = None if layer is None else lambda Y: np.full(Y.shape, layer)
    mesh, heat = Mesh(grid.n, grid.domain, POINT.moes.kappa), Conditions.of(thermal=thermal).at(POINT)
    film = TransientFilm(POINT.moes, mesh, 3e-8, supply=supply, conditions=heat, scales=POINT.scales)
    return film, *march(film, U, dT, layer)


def at(speed):
    return replace(POINT, u_sum=POINT.u_sum * speed)


@pytest.mark.parametrize(
    ("grid", "U"),
    [
        (WIDER, np.r_[1.0, np.linspace(1.0, 0.8, 6), np.full(10, 0.8)]),
        pytest.param(BOTH_WAYS, np.r_[1.0, np.linspace(1.0, -1.0, 17), np.full(20, -1.0)], marks=pytest.mark.slow),
    ],
)
def test_layer_and_speed_lose_neither_oil_nor_energy(grid, U):
    """The front recedes as the speed falls, and the surfaces turn back."""
    layer = 0.9 * solve_steady(POINT, grid=WIDER).dimensionless.h_central
    _, loss, energy = marched(U, grid, 0.25, layer=layer)
    assert loss < 1e-8
    assert energy < 1e-9


@pytest.mark.slow
def test_settled_at_another_speed_it_is_the_joint_film():
    """Oil ahead of a starved contact takes long."""
    layer = OilLayer(h=0.9 * solve_steady(POINT, grid=WIDER).h_central)
    speed = SpeedHistory([0.0, 10.0, 20.0, 30.0], [1.0, 0.8, 0.8, 0.8])
    run = moved(300.0, 150, grid=WIDER, supply=layer, speed=speed, tol=1e-4)
    steady = solve_steady(at(0.8), grid=WIDER, supply=layer, thermal=ROLLING)
    assert run.h_central[-1] * POINT.scales.length == pytest.approx(steady.h_central, rel=1e-3)
    assert run.warmest_oil[-1] == pytest.approx(steady.temperature.largest, rel=0.005)


@pytest.mark.long
def test_without_a_slope_it_is_the_isothermal_run_under_the_layer():
    T = np.linspace(0.0, 3.0, 301)
    motion = PrescribedApproach(T, 0.9 + 0.02 * np.sin(2.0 * T))
    given = {"grid": WIDER, "supply": OilLayer(over_flooded=1.0)}
    cold, warm = (moved(2.0, 12, motion, thermal=t, **given) for t in (None, Heat(temperature_slope=0.0)))
    np.testing.assert_allclose(warm.force, cold.force, atol=1e-6)
    assert warm.warmest_oil.min() > 10.0


@pytest.mark.long
def test_a_constant_speed_is_none():
    given = {"motion": PrescribedApproach([0, 1, 2, 3], [0.91, 0.93, 0.93, 0.92]), "until": 1.0, "steps": 8}
    plain, same = moved(**given), moved(**given, speed=SpeedHistory([0, 1, 2, 3], np.ones(4)))
    for one, other in zip(columns(plain), columns(same), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.long
def test_features_heat_their_film():
    """Energy is balanced; without a slope the film is the isothermal one; far away the feature is none."""
    dent = Dent(0.03, 0.5, start=-1.2, kappa=POINT.moes.kappa)
    given = {"until": 1.5, "steps": 15, "grid": Grid(64), "tol": 1e-4}
    cold, still, warm = (
        moved(**given, thermal=t, surface=dent) for t in (None, Heat(temperature_slope=0.0), ROLLING)
    )
    np.testing.assert_allclose(still.h_midplane, cold.h_midplane, atol=1e-6)
    assert max(still.heat_balance.max(), warm.heat_balance.max()) < 1e-9
    assert np.ptp(warm.warmest_oil) > 2.0
    short = {"until": 0.5, "steps": 5}
    far, none = (moved(**short, surface=s) for s in (replace(dent, start=-30.0), None))
    np.testing.assert_allclose(far.warmest_oil, none.warmest_oil, atol=1e-4)


@pytest.mark.slow
def test_slow_changes_of_speed_pass_steady_films():
    """Of first order in the rate: half of it leaves half of the differences."""
    steady = solve_steady(at(0.7), grid=COARSE, thermal=ROLLING)
    apart = []
    for length in (10.0, 20.0, 40.0):
        T = np.linspace(0.0, length, 51)
        run = moved(length, 40, speed=SpeedHistory(T, 1.0 - 0.3 * T / length))
        assert run.heat_balance.max() < 1e-9
        found = run.h_central[-1], run.warmest_oil[-1], run.warmest_surface[-1]
        apart.append(
            np.subtract(found, (steady.h_central, steady.temperature.largest, steady.temperature.surfaces.max()))
        )
    for slow, slower in pairwise(apart):
        np.testing.assert_allclose(slow / slower, 2.0, rtol=0.1)


@pytest.mark.long
def test_backwards_is_the_mirror_image_and_turned_round_the_film_comes_back():
    """Surfaces bring back what they were given; settled, the film is that of the first speed, turned."""
    T = np.array([0.0, 2.0, 4.0, 12.0])
    ahead, back = (
        moved(9.0, 45, grid=BOTH_WAYS, speed=SpeedHistory(T, sign * np.array([1.0, -1.0, -1.0, -1.0])))
        for sign in (1.0, -1.0)
    )
    for one, other in zip(columns(ahead), columns(back), strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(back.h_midplane, ahead.h_midplane[:, ::-1])
    np.testing.assert_allclose(ahead.h_midplane[-1, ::-1], ahead.h_midplane[0], rtol=0.01)
    assert ahead.warmest_oil[-1] == pytest.approx(ahead.warmest_oil[0], rel=0.01)
    assert ahead.heat_balance.max() < 1e-8
    assert ahead.warmest_oil.min() < 0.4 * ahead.warmest_oil[0]  # it stood still for a moment


def test_at_a_stop_the_film_cools_by_conduction_alone(tmp_path):
    """Nothing is carried: surfaces cool as long as they stand. A run goes on from a checkpoint bit for bit."""
    given = {"grid": COARSE, "speed": SpeedHistory([0.0, 1.0, 2.0, 20.0], [1.0, 0.0, 0.0, 0.0])}
    file = tmp_path / "run.h5"
    run = moved(6.0, 30, **given)
    assert (np.diff(run.warmest_surface[8:]) < 0.0).all()
    assert 0.1 < run.warmest_surface[-1] < 0.5 * run.warmest_surface[0]
    assert run.warmest_oil[-1] < run.warmest_surface[-1] + 2.5
    moved(3.0, 15, **given, keep=KeepSettings(checkpoint=file))
    again = moved(6.0, 30, **given, keep=KeepSettings(restart=file))
    for one, other in zip(columns(run), columns(again), strict=True):
        np.testing.assert_array_equal(one, other)


WAYS = (1.0, 1.0, 1.0, 1.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.2, -0.6, -1.0), (0.3, 2.0, 2.0, 0.5)


@pytest.mark.parametrize("U", WAYS)
def test_surface_against_an_integral_over_its_past(U):
    """Rise at a place by the heat that its material was given, int Q(x(t'), t')/sqrt(t - t') dt'.

    The cells of (7) are of order 1.5 in their size.
    """

    def heat(x, t):
        return np.exp(-(((x - 3.0) / 0.8) ** 2)) * (1.0 + 0.3 * t)

    def places(t):
        return np.interp(t, fine, np.r_[0.0, np.cumsum(0.5 * np.diff(fine) * (speed[1:] + speed[:-1]))])

    fine = np.linspace(0.0, 3.0, 30_001)
    speed = np.interp(fine, range(4), U)
    t = 3.0 - 3.0 * np.linspace(0.0, 1.0, 4001) ** 2  # crowded at the end
    middle, roots = 0.5 * (t[1:] + t[:-1]), np.sqrt(3.0 - t)
    X = np.linspace(1.5, 4.5, 31)
    past = heat(X[:, None] - places(3.0) + places(middle), middle)
    exact = past @ (2.0 * np.diff(roots))
    errors = []
    for nx in (60, 240):
        hx, T = 6.0 / nx, np.linspace(0.0, 3.0, nx + 1)
        weights = passage(3.0 - T, (places(3.0) - places(T)) / hx, 2 * nx)
        assert weights.sum() == pytest.approx(2.0 * np.sqrt(3.0), rel=1e-12)
        shifts = hx * np.arange(-2 * nx, 2 * nx + 1)
        found = np.einsum("jl,xjl->x", weights, heat(X[:, None, None] - shifts, T[:, None]))
        errors.append(np.abs(found - exact).max() / exact.max())
    assert errors[1] < 0.2 * errors[0] < 8e-4
