"""Levels filled with fields that have pressure, cavitation and no symmetry but the one in Y."""

import numpy as np
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse_newton import CoarseNewton
from ehlcontact.solver.level import Level


def rough_level(point, nx=16, ny=8, domain=None, seed=1):
    """Level with random P (a fifth of the nodes and the border cavitated) and the film that belongs to it."""
    level = Level(point, domain or Domain(), nx, ny)
    rng = np.random.default_rng(seed)
    P = np.maximum(rng.uniform(-0.25, 1.0, level.P.shape), 0.0)
    P[:, [0, -1]] = 0.0
    P[-1] = 0.0
    level.P[...] = P
    level.update_film(0.3)
    level.H[...] = np.maximum(level.H, 0.01)
    level.c_t = 0.7
    level.rhs[...] = rng.normal(size=P.shape)
    level.update_residual()
    return level


@pytest.fixture(params=[("roelands", "dowson-higginson"), ("barus", "incompressible")], ids="-".join)
def point(request):
    """An elliptic point under both pairs of laws."""
    viscosity, density = request.param
    return MoesPoint(20.0, 5.0, 0.4, viscosity=viscosity, density=density)


@pytest.fixture
def level(point):
    """A rough level."""
    return rough_level(point)


@pytest.fixture
def make_level():
    """`rough_level`."""
    return rough_level


def film_by_newton(point, nx=32, ny=16):
    """A level whose film carries load 1 to rounding, by dense Newton steps alone, and its approach."""
    level = Level(point, Domain(), nx, ny)
    level.set_dry_hertz()
    newton = CoarseNewton(level)
    u = newton.solve(0.5, Balance.of_load(), 60, 1e-9)
    u = newton.solve(u, Balance.of_load(), 20, 1e-13)
    level.update(u)
    return level, u


@pytest.fixture(scope="session")
def solve_by_newton():
    """`film_by_newton`."""
    return film_by_newton
