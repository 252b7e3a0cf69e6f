"""Cycles that learn from the last ones: on films made of a few errors, and on real ones that fall slowly."""

from types import SimpleNamespace

import numpy as np
import pytest

from ehlcontact import MoesPoint
from ehlcontact.solver.acceleration import REMEMBERED, SLOW_FACTOR, AcceleratedCycles
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid

LOAD = Balance.of_load()
RNG = np.random.default_rng(4)
SHAPES = np.linalg.qr(RNG.normal(size=(12, 3)))[0].T.reshape(3, 3, 4)  # orthogonal, as errors of a film
SOLUTION = 2.0 + RNG.uniform(size=(3, 4))


class Film:
    """Stands for a `Multigrid`: a cycle multiplies each of three errors by its factor; u follows the first."""

    def __init__(self, factors, errors=(0.1, 0.1, 0.1), solution=SOLUTION):
        self.solution = solution.copy()
        self.factors = np.array(factors)
        self.errors = np.array(errors)
        self.u = 0.5 + self.errors[0]
        self.updates = []
        self.finest = SimpleNamespace(P=self._P(), update=self.updates.append, inflow=np.zeros(0))

    def _P(self):
        return self.solution + np.tensordot(self.errors, SHAPES, 1)

    def cycle(self, balance):
        assert balance is LOAD
        self.errors = self.factors * np.tensordot(SHAPES, self.finest.P - self.solution, 2)
        before = self.finest.P.copy()
        self.finest.P[...] = self._P()
        self.u = 0.5 + self.errors[0]
        return float(np.abs(self.finest.P - before).max())

    @property
    def error(self):
        return float(np.abs(self.finest.P - self.solution).max())


def test_two_slow_errors_are_gone_once_they_are_known():
    film = Film((0.6, 0.4, 0.0), (0.1, 0.1, 0.0))
    cycles = AcceleratedCycles(film)
    for _ in range(REMEMBERED + 1):
        cycles.step(LOAD)
    assert film.error < 1e-12
    assert film.u == pytest.approx(0.5, abs=1e-12)
    assert film.updates[-1] == film.u  # film and residual belong to the state


def test_more_errors_than_memory_fall_faster():
    plain, film = Film((0.6, 0.5, 0.4)), Film((0.6, 0.5, 0.4))
    cycles = AcceleratedCycles(film)
    for _ in range(8):
        plain.cycle(LOAD)
        cycles.step(LOAD)
    assert film.error < 0.02 * plain.error


def test_what_falls_fast_is_left_alone():
    plain, film = Film((0.1, 0.05, 0.0)), Film((0.1, 0.05, 0.0))
    assert SLOW_FACTOR > 0.1
    cycles = AcceleratedCycles(film)
    for _ in range(6):
        assert cycles.step(LOAD) == plain.cycle(LOAD)
        np.testing.assert_array_equal(film.finest.P, plain.finest.P)
    assert film.updates == []


def test_a_combination_that_does_harm_ends_the_memory():
    """What follows is what follows for somebody who has seen that cycle only."""
    film = Film((0.6, 0.4, 0.3), (0.1, 0.1, 0.0))
    cycles = AcceleratedCycles(film)
    for _ in range(REMEMBERED + 1):
        cycles.step(LOAD)
    other = Film((0.6, 0.4, 0.3), (0.3, 1.0, 0.7))
    film.finest.P[...] = other.finest.P  # of another film
    combined, fresh = len(film.updates), AcceleratedCycles(other)
    for _ in range(4):
        assert cycles.step(LOAD) == pytest.approx(fresh.step(LOAD), rel=1e-9)
        np.testing.assert_allclose(film.finest.P, other.finest.P, rtol=1e-12)
    assert len(film.updates) == combined + len(other.updates) > combined


def test_no_pressure_is_below_zero():
    where = (1, 1)
    film = Film((0.6, 0.4, 0.0), (0.5 / SHAPES[0][where], 0.0, 0.0))
    film.solution[where] = -0.05  # to which its factor leads, from above zero
    film.finest.P[...] = film._P()
    cycles = AcceleratedCycles(film)
    cycles.step(LOAD)
    assert film.finest.P[where] > 0.0
    cycles.step(LOAD)  # its change alone leaves it there, the combination leads to the end
    assert film.updates
    assert film.finest.P[where] == 0.0


def test_dry_nodes_stay_dry():
    film = Film((-0.6, -0.4, 0.0))  # to and fro: a combination would lead away from zero
    cycles = AcceleratedCycles(film)

    def dries(balance):
        change = Film.cycle(film, balance)
        film.finest.P[0, 0] = 0.0
        return change

    cycles.step(LOAD)
    film.cycle = dries
    cycles.step(LOAD)
    assert film.updates
    assert film.finest.P[0, 0] == 0.0


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_film_that_runs_away_is_told(value):
    film = Film((0.6, 0.4, 0.0))
    cycles = AcceleratedCycles(film)
    cycles.step(LOAD)
    film.cycle = lambda balance: value
    assert not np.isfinite(cycles.step(LOAD))
    assert film.updates == []


def changes_of(M, L, kappa, accelerated, n=128, most=40):
    """Changes of P by each cycle until they are 1e-8, and the pressure."""
    point = MoesPoint(M, L, kappa)
    film = Multigrid(point, Mesh(n, Domain.for_point(point), point.kappa))
    film.full_multigrid(LOAD)
    advance = AcceleratedCycles(film).step if accelerated else film.cycle
    changes = []
    while len(changes) < most and min(changes, default=1.0) > 1e-8:
        changes.append(advance(LOAD))
    return changes, film.finest.P


@pytest.mark.parametrize("point", [(50, 0, 1), (11, 30, 0.43)])
def test_films_that_fall_slowly(point):
    """Thin oil at its outlet, and a pressure spike: the same film, in fewer cycles."""
    plain, P = changes_of(*point, False)
    found, accelerated = changes_of(*point, True)
    assert found[-1] <= 1e-8
    assert len(found) <= 0.85 * len(plain)
    np.testing.assert_allclose(accelerated, P, rtol=0, atol=3e-8)
