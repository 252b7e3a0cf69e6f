"""A layer of oil at a speed that changes: mass, mirror images, stops, and the oil that comes back after a turn."""

import numpy as np
import pytest
from oil_march import march

from ehlcontact import (
    Domain,
    Grid,
    KeepSettings,
    MoesPoint,
    OilLayer,
    PrescribedLoad,
    SpeedHistory,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.solver.mesh import Mesh
from ehlcontact.transient.carried_oil import CarriedOil
from ehlcontact.transient.transient_film import TransientFilm

CIRCLE = MoesPoint(20, 10, 1)
LAYER = 0.3
BOTH_WAYS = Domain(-3.0, 3.0, 2.25)
NEAR = Domain(-3.0, 1.5, 2.25)
FORWARD = Domain(-4.5, 1.5, 3.0)
HELD = PrescribedLoad([0.0, 1.0, 2.0, 100.0], [1.0, 1.0, 1.0, 1.0])


def at(speed):
    return MoesPoint(CIRCLE.M * speed**-0.75, CIRCLE.L * speed**0.25, CIRCLE.kappa)


def run(T, U, until, grid=Grid(64, BOTH_WAYS), **time):  # noqa: B008
    steps = TimeSteps(until=until, **{"dt": 0.05, "tol": 1e-6} | time)
    return simulate(CIRCLE, HELD, grid=grid, supply=OilLayer(H=LAYER), speed=SpeedHistory(T, U), time=steps)


def marched(U, domain, n=64, dT=0.05):
    """Film after steps at these speeds, and the largest loss of oil in a step."""
    film = TransientFilm(CIRCLE, Mesh(n, domain, 1.0), 1e-8, supply=lambda Y: np.full(Y.shape, LAYER))
    loss, _ = march(film, U, dT, LAYER)
    return film, loss


def test_oil_beyond_the_ends_against_two_tapes():
    """Steps of one piece of tape to and fro at random; a piece that comes in is the one written there last."""
    rng, place = np.random.default_rng(4), 0
    beyond = CarriedOil.at_rest(np.array([-1.0]), np.array([-2.0]), turned=False)
    ahead, behind = {}, {}
    for step in range(300):
        turned, leaving = bool(rng.uniform() < 0.5), np.array([float(step)])
        place += -1 if turned else 1
        entering = beyond.entering(float(place), turned)
        there, other = (behind, ahead) if turned else (ahead, behind)
        assert entering[0] == there.get(place, -2.0 if turned else -1.0)
        beyond = beyond.moved(float(place), turned, leaving)
        there[place], other[place] = entering[0], leaving[0]
        halfway = beyond.entering(place + (0.5 if turned else -0.5), not turned)[0]
        before = other.get(place + (1 if turned else -1), -1.0 if turned else -2.0)
        assert halfway == pytest.approx(0.5 * (leaving[0] + before))
    assert beyond.way == place


def test_a_constant_speed_is_none():
    grid, steps = Grid(64, FORWARD), TimeSteps(until=1.0, dt=0.1)
    load = PrescribedLoad([0.0, 0.3, 0.6, 1.0], [1.0, 1.1, 1.2, 1.2])
    given = {"grid": grid, "supply": OilLayer(H=LAYER), "time": steps}
    plain = simulate(CIRCLE, load, **given)
    same = simulate(CIRCLE, load, speed=SpeedHistory([0.0, 1.0, 2.0, 3.0], [1.0] * 4), **given)
    for name in ("approach", "h_central", "layer_behind"):
        np.testing.assert_array_equal(getattr(same, name), getattr(plain, name))


@pytest.mark.long
def test_no_oil_is_lost_while_the_speed_changes():
    """Within 1e-8 of the flow in every step; settled, the film is the steady one of the new speed."""
    U = np.r_[1.0, np.linspace(1.0, 0.5, 11), np.full(160, 0.5)]
    film, loss = marched(U, NEAR, n=48, dT=0.1)
    assert loss < 1e-8
    steady = solve_steady(at(0.5), grid=Grid(48, NEAR), supply=OilLayer(H=LAYER))
    assert film.level.central_film() == pytest.approx(steady.h_central, rel=1e-4)


def test_turned_round_it_meets_the_oil_that_it_left():
    """It ends in the mirror image of the steady film under the layer that it had left, the second pass."""
    U = np.r_[1.0, np.linspace(1.0, -1.0, 21), np.full(100, -1.0)]
    film, loss = marched(U, BOTH_WAYS, n=48, dT=0.1)
    assert loss < 1e-8
    grid = Grid(48, BOTH_WAYS)
    first = solve_steady(CIRCLE, grid=grid, supply=OilLayer(H=LAYER))
    second = solve_steady(CIRCLE, grid=grid, supply=first.supply_behind)
    assert second.h_central < 0.95 * first.h_central
    np.testing.assert_allclose(film.fields[0][::-1], second.h, atol=1e-5)


def test_backwards_is_the_mirror_image():
    T = [0.0, 0.5, 1.0, 2.0]
    ahead, back = (run(T, sign * np.array([1.0, 1.0, 0.5, 0.5]), 1.5) for sign in (1.0, -1.0))
    np.testing.assert_array_equal(back.h_midplane, ahead.h_midplane[:, ::-1])
    np.testing.assert_array_equal(back.layer_behind, ahead.layer_behind)


@pytest.mark.long
def test_stop_and_go():
    """It stands for T = 2; no oil is lost, and gone on with it ends in its first film."""
    U = np.r_[1.0, np.linspace(1.0, 0.0, 11), np.zeros(20), np.linspace(0.0, 1.0, 11), np.ones(90)]
    film, loss = marched(U, NEAR, n=48, dT=0.1)
    assert loss < 1e-8
    steady = solve_steady(CIRCLE, grid=Grid(48, NEAR), supply=OilLayer(H=LAYER))
    assert film.level.central_film() == pytest.approx(steady.h_central, rel=1e-4)


@pytest.mark.slow
def test_to_and_fro_the_film_thins():
    """Turned again and again within the track, every pass presses oil aside."""
    U = np.r_[1.0, np.cos(np.linspace(0.0, 6.0 * np.pi, 361))]  # three times 1.9 semi-axes to and fro
    film, loss = marched(U, BOTH_WAYS)
    start = solve_steady(CIRCLE, grid=Grid(64, BOTH_WAYS), supply=OilLayer(H=LAYER))
    assert loss < 1e-8 and film.level.central_film() < 0.9 * start.h_central


@pytest.mark.slow
def test_slow_changes_are_steady_starved_films():
    """To first order in the rate."""
    off = []
    steady = solve_steady(at(0.6), grid=Grid(64, FORWARD), supply=OilLayer(H=LAYER)).h_central
    for length in (20.0, 40.0):
        T = [0.0, 1.0, 1.0 + length, 1.1 + length]
        slow = run(T, [1.0, 1.0, 0.6, 0.6], 1.0 + length, grid=Grid(64, FORWARD), dt=0.1)
        off.append(abs(slow.h_central[-1] - steady) / steady)
    assert off[0] < 0.05 and 1.7 < off[0] / off[1] < 2.3


def test_restart_after_it_turned(tmp_path):
    T, U = [0.0, 0.2, 0.8, 3.0], [1.0, 1.0, -1.0, -1.0]
    given = {"grid": Grid(64, BOTH_WAYS), "supply": OilLayer(H=LAYER), "speed": SpeedHistory(T, U)}
    whole = simulate(CIRCLE, HELD, **given, time=TimeSteps(until=1.6, dt=0.1))
    kept = KeepSettings(checkpoint=tmp_path / "half.h5")
    simulate(CIRCLE, HELD, **given, time=TimeSteps(until=0.8, dt=0.1), keep=kept)
    resumed = KeepSettings(restart=tmp_path / "half.h5")
    again = simulate(CIRCLE, HELD, **given, time=TimeSteps(until=1.6, dt=0.1), keep=resumed)
    for name in ("approach", "h_central", "h_midplane", "layer_behind"):
        np.testing.assert_array_equal(getattr(again, name), getattr(whole, name))
