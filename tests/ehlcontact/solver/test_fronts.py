"""The passes along the fronts of full film."""

import numpy as np
import pytest

from ehlcontact import Grid, MoesPoint, OilLayer, solve_steady
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.kernels import fronts
from ehlcontact.solver.kernels.cavitation import DOMINANCE, total_flow
from ehlcontact.solver.kernels.reynolds import residual
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid

LINE = 2
KERNELS = [fronts.settle_line, fronts.settle_line.py_func]


def starved():
    """The finest level of a film that has nearly settled."""
    mesh = Mesh(48, Domain(), kappa=1.0)
    film = Multigrid(MoesPoint(20, 10, 1), mesh, supply=lambda Y: np.full(Y.shape, 0.5))
    film.full_multigrid(Balance.of_load())
    for _ in range(3):
        film.cycle(Balance.of_load())
    return film.finest


def settle(level, kernel):
    f, work = level.fields, np.zeros((2, *level.P.shape))
    least = DOMINANCE * level.stencil.crowding * 1.5 * level.stencil.inv_hx * level.near[0, 0]
    kernel(LINE, f.P, f.flow, level.supply_arrays, level.stencil, level.c_t, least, *work)
    return least


def front(level):
    return int(np.flatnonzero(level.P[LINE] > 0.0)[0])


def balances(level):
    """Faces, and residuals at frozen film and flow, which is all that these passes see."""
    level._carry_supply()
    r = np.zeros_like(level.P)
    residual(level.P, level.fields.flow, level.stencil, level.c_t, level.given, r)
    return level.fields.flow.open[LINE], r[LINE]


@pytest.mark.parametrize("kernel", KERNELS, ids=["jit", "python"])
@pytest.mark.parametrize("moved", [-4, 3])
def test_a_front_finds_its_place(kernel, moved):
    """From nodes away on either side: balanced where flow dominates, with one front."""
    level = starved()
    settled = front(level)
    if moved > 0:
        level.P[LINE, settled : settled + moved] = 0.0
    else:
        level.P[LINE, settled + moved : settled] = 0.3 * level.P[LINE, settled]
    before = np.abs(balances(level)[1]).max()
    assert front(level) == settled + moved
    least = settle(level, kernel)
    place = front(level)
    assert abs(place - settled) <= 1
    flow = np.array([total_flow(LINE, i, level.fields.flow, level.stencil) for i in range(place, place + 9)])
    dominated = int(np.argmax(flow <= least * np.arange(1, 10)))
    assert dominated >= 2
    opened, r = balances(level)
    assert np.abs(r[place : place + dominated - 1]).max() < 1e-9 * before
    assert opened[place - 1] <= 0.0 and (opened[: place - 1] == 1.0).all()


def test_settled_fronts_stay():
    level = starved()
    settle(level, fronts.settle_line)
    P = level.P.copy()
    settle(level, fronts.settle_line)
    np.testing.assert_allclose(level.P, P, rtol=0.0, atol=1e-12)


def test_a_front_that_has_far_to_go_takes_few_cycles():
    """13 without these passes."""
    film = solve_steady(MoesPoint(197.6, 4.1, 0.1232), grid=Grid(64), supply=OilLayer(over_flooded=1.56))
    assert film.cycles <= 9
