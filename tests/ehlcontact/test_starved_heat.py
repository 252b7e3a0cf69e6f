"""Films that are starved and heat up: limits, balances of oil and energy, and products of both factors."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from balls import FAST as POINT

from ehlcontact import Domain, Grid, Heat, OilLayer, solve_steady
from ehlcontact.linearised_film import effects_on, held
from ehlcontact.solver.film_heat import divergence

GRID = Grid(64, Domain(-6.0, 1.5, 3.0))
GIVEN = {"grid": GRID, "tol": 1e-8}


@cache
def flooded():
    return solve_steady(POINT, thermal=Heat(), **GIVEN)


@cache
def starved():
    return solve_steady(POINT, supply=OilLayer(over_flooded=1.0), thermal=Heat(), **GIVEN)


def test_much_oil_floods_the_film_with_heat():
    much = solve_steady(POINT, supply=OilLayer(H=1e5), thermal=Heat(), **GIVEN)
    assert much.approach == pytest.approx(flooded().approach, rel=1e-6)
    np.testing.assert_allclose(much.h, flooded().h, rtol=1e-6)
    full = flooded().p > 0.0
    np.testing.assert_allclose(much.temperature.mean[full], flooded().temperature.mean[full], atol=1e-5)


def test_without_a_slope_the_starved_film_is_the_isothermal_one():
    cold, still = (
        solve_steady(POINT, grid=GRID, supply=OilLayer(over_flooded=0.6), thermal=given)
        for given in (None, Heat(temperature_slope=0.0))
    )
    np.testing.assert_array_equal(still.p, cold.p)
    np.testing.assert_array_equal(still.content, cold.content)
    assert still.temperature.largest > 10.0


@pytest.mark.parametrize("given", [Heat(), Heat(0.3, effusivity=(13_000.0, 1_500.0))])
@pytest.mark.parametrize("r", [0.6, 1.0])
def test_oil_and_energy_are_balanced(r, given):
    """Energy is carried with the flow of the film: what comes into a node less what leaves it is nothing."""
    film = solve_steady(POINT, supply=OilLayer(over_flooded=r), thermal=given, **GIVEN)
    assert film.temperature.balance < 1e-6
    lines = np.append(0.5, np.ones(film.y.size - 1))
    assert lines @ film.layer_behind == pytest.approx(lines @ film.layer, rel=2e-7)
    solved = held(film)
    terms = effects_on(film, solved)[0].heat.terms()
    left = divergence(terms.along, terms.across)[terms.wet]
    assert np.abs(left).max() < 1e-5 * np.abs(terms.along).max()


def test_heat_that_flows_back_turns_round_at_the_front():
    """The oil in the middle carries it there, and beside the surfaces in again: it does not pile up."""
    front = np.argmax(starved().p[:, 0] > 0.0)
    T = starved().temperature.mean[:, 0]
    assert starved().x[front] < -2.0 * POINT.scales.a  # where the middle flows back
    assert 0.0 < T[front] < 1.2 * T[front + 3] < 10.0
    wall = starved().temperature.surfaces[0, :, 0]
    assert wall[front] > 0.0 == wall[front - 3]


@pytest.mark.parametrize("r", [0.3, 1.0])
def test_joint_film_is_the_product_of_its_factors(r):
    """With the layer over the flooded film with heat; a thin layer itself loses nothing by heat."""
    share = flooded().temperature.film_share
    joint = solve_steady(POINT, supply=OilLayer(over_flooded=r), thermal=Heat(), **GIVEN)
    shifted = solve_steady(POINT, supply=OilLayer(over_flooded=r / share), **GIVEN)
    assert share * shifted.h_central == pytest.approx(joint.h_central, rel=0.01)
    assert joint.temperature.film_share > (0.9999 if r < 0.5 else 1.02 * share)


@pytest.mark.slow
def test_starved_films_with_heat_settle():
    """Layers up to a thick one, on a fine grid, with the front of a film of other load, speed and sliding."""
    for rpm, load, r, slide in (
        (15_000.0, 300.0, 0.8, 0.0),
        (4000.0, 1500.0, 1.2, 0.1),
        (10_000.0, 800.0, 1.5, 0.0),
    ):
        point = replace(POINT, load=load, u_sum=POINT.u_sum * rpm / 10_000.0)
        grid = Grid(256, Domain(-7.5, 1.5, 3.0))
        film = solve_steady(point, grid=grid, supply=OilLayer(over_flooded=r), thermal=Heat(slide))
        assert film.temperature.balance < 1e-6
