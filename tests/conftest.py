"""What several test folders share: every steady film is solved once per session."""

from functools import cache

import pytest

from ehlcontact import MoesPoint, solve_steady


@cache
def _steady(M, L, kappa, n, laws):
    return solve_steady(MoesPoint(M, L, kappa, **dict(laws)), n=n)


@pytest.fixture(scope="session")
def steady():
    """``steady(M, L, kappa, n, viscosity=..., density=...)``: a solve on the default domain, cached."""
    return lambda M, L, kappa, n, **laws: _steady(M, L, kappa, n, tuple(sorted(laws.items())))
