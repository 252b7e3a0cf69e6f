"""The coarse-grid solver on its own."""

import numpy as np
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse import CoarseNewton
from ehlcontact.solver.level import Level
from ehlcontact.solver.multigrid import initial_approach


def solve(point, balance, nx=16, ny=8, tol=1e-11):
    level = Level(point, Domain(), nx, ny)
    level.set_dry_hertz()
    u = CoarseNewton(level).solve(initial_approach(point), balance, max_steps=60, tol=tol)
    return level, u


@pytest.mark.parametrize("kappa", [0.12, 1.0])
@pytest.mark.parametrize("viscosity", ["roelands", "barus"])
def test_load_balance(kappa, viscosity):
    point = MoesPoint(50, 6, kappa, viscosity=viscosity)
    level, _ = solve(point, Balance.of_load())
    assert level.residual_norm() < 1e-10
    assert level.force() == pytest.approx(1.0, abs=1e-11)
    # complementarity: pressure, or a residual that asks for none
    assert (level.P >= 0.0).all()
    assert (level.r[level.P == 0.0] >= 0.0).all()


def test_prescribed_approach():
    level, u = solve(MoesPoint(50, 6, 0.5), Balance.of_approach(0.6))
    assert u == pytest.approx(0.6, abs=1e-12)
    assert level.residual_norm() < 1e-10


def test_equation_of_motion():
    """Any linear relation between approach and force closes the system."""
    balance = Balance(2.0, 1.0, 3.0)
    level, u = solve(MoesPoint(50, 6, 0.5), balance)
    assert 2.0 * u + level.force() == pytest.approx(3.0, abs=1e-11)
    assert abs(balance.residual(u, level.force())) < 1e-11


def test_quadratic_convergence():
    point, balance = MoesPoint(50, 6, 0.5), Balance.of_load()
    level = Level(point, Domain(), 16, 8)
    level.set_dry_hertz()
    newton = CoarseNewton(level)
    u = newton.solve(initial_approach(point), balance, max_steps=60, tol=1e-2)
    merits = [newton._evaluate(u, balance)[0]]
    for _ in range(4):
        u = newton.solve(u, balance, max_steps=1, tol=0.0)
        merits.append(newton._evaluate(u, balance)[0])
        if merits[-1] < 1e-10:
            break
    assert merits[-1] < 1e-10


def test_correct_reduces_the_residual_a_hundredfold():
    point, balance = MoesPoint(50, 6, 0.5), Balance.of_load()
    level, u = solve(point, balance)
    level.P[...] *= 1.0 + 1e-3 * np.random.default_rng(1).normal(size=level.P.shape)
    newton = CoarseNewton(level)
    before = newton._evaluate(u, balance)[0]
    u = newton.correct(u, balance)
    assert newton._evaluate(u, balance)[0] < 1e-2 * before


def test_nan_ends_the_iteration():
    level = Level(MoesPoint(50, 6, 0.5), Domain(), 16, 8)
    level.P[3, 3] = np.nan
    u = CoarseNewton(level).solve(0.5, Balance.of_load(), max_steps=60, tol=1e-9)
    assert u == 0.5


def test_balance():
    balance = Balance(2.0, 3.0, 10.0)
    assert balance.residual(1.5, 2.0) == 1.0
    assert balance.shifted(0.5) == Balance(2.0, 3.0, 10.5)
