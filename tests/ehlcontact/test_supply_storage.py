"""Damping of starved contacts at low frequency, from steady films alone.

A contact that closes slowly passes through its steady films. The oil that these hold more is taken from the layer
on its way to the contact: with S the oil of each cell, the balance of a steady film gets the sink dS/du, and the
force that goes with it is the damping at rest. No part of the linearisation is used.
"""

import pytest

from ehlcontact import Grid, MoesPoint, OilLayer, impedance, solve_steady
from ehlcontact.linearised_film import held
from ehlcontact.solver.balance import Balance

STEP = 1e-4  # of the approach
SINK = 2e-5  # rate of approach


def settle(multigrid, u):
    """Force of the steady film at the approach u."""
    for _ in range(30):
        if multigrid.cycle(Balance.of_approach(u)) < 1e-11:
            break
    multigrid.finest.update(multigrid.u)
    return multigrid.finest.force()


def stored_over_approach(multigrid, u):
    """Change of the oil in each cell with the approach."""
    stored = []
    for sign in (1.0, -1.0):
        settle(multigrid, u + sign * STEP)
        stored.append(multigrid.finest.oil.copy())
    return (stored[0] - stored[1]) / (2.0 * STEP)


def force_of_sink(multigrid, u, sink):
    """Change of the force at the approach u, over the rate at which oil is taken away."""
    level, forces = multigrid.finest, []
    for sign in (1.0, -1.0):
        level.rhs[:-1, 1:-1] = sign * SINK * sink[:-1, 1:-1]
        forces.append(settle(multigrid, u))
    level.rhs[...] = 0.0
    return (forces[0] - forces[1]) / (2.0 * SINK)


@pytest.mark.parametrize(
    ("point", "n"),
    [
        ((20, 10, 1), 64),
        pytest.param((200, 10, 0.5), 96, marks=pytest.mark.slow),
        pytest.param((1000, 12, 0.3), 96, marks=pytest.mark.slow),
    ],
)
def test_the_damping_at_rest_is_the_oil_that_steady_films_store(point, n):
    point, supply = MoesPoint(*point), OilLayer(over_flooded=1.0)
    film = solve_steady(point, grid=Grid(n), supply=supply)
    multigrid = held(film)
    sink = stored_over_approach(multigrid, film.approach)
    settle(multigrid, film.approach)
    damping = force_of_sink(multigrid, film.approach, sink)
    front = (film.p.T <= 0.0) & (multigrid.finest.X < 0.0)
    by_front = force_of_sink(multigrid, film.approach, sink * front)
    slow = impedance(point, Omega=0.002, grid=Grid(film.n, film.domain), supply=supply).damping[0]
    print(f"{point}: {damping:.5f} from steady films, {by_front:.5f} of it by the front, impedance {slow:.5f}")
    assert by_front < -0.05
    assert damping == pytest.approx(slow, abs=0.002 * (damping - by_front))
