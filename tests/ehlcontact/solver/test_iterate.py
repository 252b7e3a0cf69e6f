"""The driver loop: verdicts on a residual history, and what ends it."""

import numpy as np
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.iterate import (
    LARGEST_SWEEP_FACTOR,
    IterationHistory,
    StoppingCriteria,
    classify,
    iterate,
    pressure_error,
)
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.status import Status

NAN, INF = float("nan"), float("inf")
FALLING = [10.0**-k for k in range(20)]
LOAD = Balance.of_load()


def goal(scale=1.0, tol=1e-4, most=9, balance=1e-7, approach=1e-7, **others):
    return StoppingCriteria(scale, tol, most, balance, approach, **others)


@pytest.mark.parametrize(
    ("residuals", "settled", "most", "expected"),
    [
        ([1.0], False, 9, None),
        ([1e-5], True, 9, Status.CONVERGED),
        ([1e-5], False, 9, None),  # a small residual alone is not enough
        ([1e-3], True, 9, None),
        (FALLING[:3], True, 2, Status.MAX_CYCLES),
        (FALLING[:6], True, 5, Status.CONVERGED),  # convergence in the last allowed cycle counts
        ([1.0], True, 0, Status.MAX_CYCLES),
        ([1.0, NAN], True, 9, Status.NONFINITE),
        ([1.0, INF], True, 9, Status.NONFINITE),
        ([NAN], False, 0, Status.NONFINITE),
        ([1.0, 2e3], False, 9, Status.DIVERGED),
        ([1.0, 9e2], False, 9, None),
        ([2e3, 1.0], False, 9, None),  # a poor start is not divergence,
        ([9e3, 8e3, 7e3], False, 9, None),  # however slowly it falls,
        ([9e3, 8e3, 8.1e3], False, 9, Status.DIVERGED),
        ([2e3], False, 9, None),  # nor before anything has been tried
        ([1.0] * 13, False, 40, None),
        ([1.0] * 14, False, 40, Status.STAGNATED),
        ([1.0] * 14, True, 40, Status.STAGNATED),
        ([1.0] * 8 + [0.6] * 6, False, 40, None),
        ([0.9**k for k in range(14)], False, 40, None),
        ([0.97**k for k in range(14)], False, 40, Status.STAGNATED),
        ([1.0] * 14 + [1e-5], True, 40, Status.CONVERGED),
    ],
)
def test_classify(residuals, settled, most, expected):
    assert classify(residuals, goal(most=most), settled) is expected


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ([0.1] * 14, Status.STAGNATED),
        ([0.8**k for k in range(14)], None),
        ([0.97**k for k in range(14)], Status.STAGNATED),
        ([1.0] * 8 + [0.6] * 6, None),
    ],
)
def test_stagnation_is_judged_by_the_pressure(changes, expected):
    """Where its changes are known, and whatever the residuals do."""
    assert classify(FALLING[:14], goal(tol=1e-30, most=40), False, changes) is expected
    assert classify([1.0] * 14, goal(most=40), False, changes) is expected


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ([], INF),
        ([0.3], 0.3),  # nothing to compare with
        ([0.4, 0.2], 0.2),  # 0.1 + 0.05 + ...
        ([0.9, 0.3, 0.15], 0.15),  # the worse of the last two factors, here the last
        ([0.2, 0.1, 0.01], 0.01),  # and here the one before
        ([9.0, 9.0, 0.9, 0.09], 0.09 / 4.0),  # older ones are forgotten; never less than a fifth
        ([1.0, 1e-9], 1e-9 / 4.0),
        ([0.1, 0.1], INF),
        ([0.1, 0.2, 0.01], INF),
        ([0.2, 0.0, 0.0], 0.0),
        ([0.0, 0.0], 0.0),
    ],
)
def test_pressure_error(changes, expected):
    """The rest of a geometric series."""
    assert pressure_error(changes) == pytest.approx(expected, rel=1e-12)
    track = IterationHistory()
    track.pressure_changes.extend(changes)
    assert track.pressure_error == pressure_error(changes)


def test_pressure_error_is_the_rest_of_the_series():
    changes = [0.5**k for k in range(60)]
    assert pressure_error(changes[:4]) == pytest.approx(sum(changes[4:]), rel=1e-12)


def test_scale_is_what_counts():
    assert classify([1e-3], goal(scale=100.0), True) is Status.CONVERGED
    assert classify([1e-4, 1e-3], goal(scale=1e-8), True) is Status.DIVERGED


@pytest.fixture
def film():
    """Full multigrid of a circular contact, and its scale."""
    multigrid = Multigrid(MoesPoint(20, 8, 1.0), Mesh(32, Domain(), 1.0))
    scale = multigrid.finest.dry_residual()
    multigrid.full_multigrid(LOAD)
    return multigrid, scale


def test_cycles_until_both_residuals_hold(film):
    multigrid, scale = film
    track, seen = IterationHistory(), []
    status = iterate(multigrid, LOAD, multigrid.cycle, goal(scale, most=40), track, lambda *at: seen.append(at))
    assert status is Status.CONVERGED
    assert track.residuals[-1] <= 1e-4 * scale
    assert abs(track.balance_residuals[-1]) < 1e-7 and track.approach_changes[-1] < 1e-7
    assert (
        len(track.residuals)
        == len(track.balance_residuals)
        == track.iterations + 1
        == len(track.approach_changes) + 1
    )
    assert len(track.pressure_changes) == len(track.approach_changes)
    assert seen == [(k, r / scale) for k, r in enumerate(track.residuals) if k > 0]


def test_a_force_that_still_changes_is_not_settled(film):
    multigrid, scale = film
    loose, tight = IterationHistory(), IterationHistory()
    iterate(multigrid, LOAD, multigrid.cycle, goal(scale, 1.0, 40, 1.0, 1.0), loose)
    iterate(multigrid, LOAD, multigrid.cycle, goal(scale, 1.0, 40, 1.0, 1.0, force=1e-10), tight)
    assert loose.iterations == 1 and tight.iterations > 1


def test_a_pressure_that_still_changes_is_not_settled(film):
    """And is, once what is still to come is small: the distance to the solution, as cycles to the end tell."""
    multigrid, scale = film
    loose, tight = IterationHistory(), IterationHistory()
    assert iterate(multigrid, LOAD, multigrid.cycle, goal(scale, 1.0, 40, 1.0, 1.0, pressure=INF), loose).ok
    assert iterate(multigrid, LOAD, multigrid.cycle, goal(scale, 1.0, 40, 1.0, 1.0, pressure=1e-6), tight).ok
    assert loose.iterations == 1 < tight.iterations
    assert tight.pressure_error <= 1e-6 < pressure_error(tight.pressure_changes[:-1])
    P = multigrid.finest.P.copy()
    for _ in range(15):
        multigrid.cycle(LOAD)
    assert np.abs(multigrid.finest.P - P).max() <= 1e-6


class Scripted:
    """Iterations whose changes of the pressure are given; notes the sweep factor of each."""

    def __init__(self, film, changes):
        self.film, self.changes, self.sweep_factors = film, changes, []

    def __call__(self, balance):
        self.sweep_factors.append(self.film.sweep_factor)
        return self.changes[len(self.sweep_factors) - 1]


@pytest.mark.parametrize(
    ("least", "changes", "sweep_factors"),
    [
        (1, [1.0, 0.6, 0.2, 0.12, 0.05], [1, 1, 1, 1, 1]),  # never twice in a row
        (1, [1.0, 0.5, 0.3, 0.1, 0.01], [1, 1, 1, 2, 2]),  # it does not go back
        (1, [1.0, 0.95, 0.94, 0.93, 0.92, 0.91], [1, 1, 1, 2, 4, 4]),
        (1, [1.0, 2.0, 0.1, 0.2, 0.1, 0.1], [1, 1, 1, 1, 1, 2]),
        (2, [1.0, 0.5, 0.6, 0.3], [2, 2, 2, 4]),
    ],
)
def test_slow_iterations_are_given_more_sweeps(film, least, changes, sweep_factors):
    """Twice as many, up to four times; the next solve begins with the least again."""
    multigrid, scale = film
    multigrid.least_sweep_factor = least
    for _ in range(2):
        advance = Scripted(multigrid, changes)
        status = iterate(multigrid, LOAD, advance, goal(scale, 0.0, len(changes)), IterationHistory())
        assert status is Status.MAX_CYCLES
        assert advance.sweep_factors == sweep_factors
        assert max(sweep_factors) <= LARGEST_SWEEP_FACTOR


def test_nan_ends_it(film):
    multigrid, scale = film

    def spoil(balance):
        multigrid.finest.P[3, 3] = np.nan
        multigrid.finest.update(multigrid.u)
        return np.nan

    track = IterationHistory()
    assert iterate(multigrid, LOAD, spoil, goal(scale, 1e-12), track) is Status.NONFINITE
    assert track.iterations == 1


def test_a_film_that_is_none_has_not_converged(film):
    multigrid, scale = film
    multigrid.finest.H[0, 16] = -1e-3

    def nothing(balance):
        return 0.0

    assert (
        iterate(multigrid, LOAD, nothing, goal(scale, 1e9, 9, 1e9, 1e9), IterationHistory()) is Status.UNRESOLVED
    )


def test_interrupted_it_keeps_what_it_has(film):
    multigrid, scale = film

    def stop(balance):
        raise KeyboardInterrupt

    track = IterationHistory()
    with pytest.raises(KeyboardInterrupt):
        iterate(multigrid, LOAD, stop, goal(scale, 1e-12), track)
    assert len(track.residuals) == 1
