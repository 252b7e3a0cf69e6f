"""The driver loop: verdicts on a residual history, and what ends it."""

import numpy as np
import pytest

from ehlcontact import Domain, MoesPoint, Status
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.iterate import Goal, Track, classify, iterate
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid

NAN, INF = float("nan"), float("inf")
FALLING = [10.0**-k for k in range(20)]
LOAD = Balance.of_load()


def goal(scale=1.0, tol=1e-4, most=9, balance=1e-7, approach=1e-7, **others):
    return Goal(scale, tol, most, balance, approach, **others)


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
        ([2e3, 1.0], False, 9, None),  # a poor start is not divergence
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


def test_scale_is_what_counts():
    assert classify([1e-3], goal(scale=100.0), True) is Status.CONVERGED
    assert classify([1e-3, 1e-3], goal(scale=1e-8), True) is Status.DIVERGED
    assert classify([1e-3], goal(scale=1e-8), True) is None  # a poor start


@pytest.fixture
def film():
    """Full multigrid of a circular contact, and its scale."""
    multigrid = Multigrid(MoesPoint(20, 8, 1.0), Mesh(32, Domain()))
    scale = multigrid.finest.dry_residual()
    multigrid.full_multigrid(LOAD)
    return multigrid, scale


def test_cycles_until_both_residuals_hold(film):
    multigrid, scale = film
    track, seen = Track(), []
    status = iterate(multigrid, LOAD, multigrid.cycle, goal(scale, most=40), track, lambda *at: seen.append(at))
    assert status is Status.CONVERGED
    assert track.residuals[-1] <= 1e-4 * scale
    assert abs(track.balance_residuals[-1]) < 1e-7 and track.changes[-1] < 1e-7
    assert len(track.residuals) == len(track.balance_residuals) == track.iterations + 1 == len(track.changes) + 1
    assert seen == [(k, r / scale) for k, r in enumerate(track.residuals) if k > 0]


def test_a_force_that_still_changes_is_not_settled(film):
    multigrid, scale = film
    loose, tight = Track(), Track()
    iterate(multigrid, LOAD, multigrid.cycle, goal(scale, 1.0, 40, 1.0, 1.0), loose)
    iterate(multigrid, LOAD, multigrid.cycle, goal(scale, 1.0, 40, 1.0, 1.0, force=1e-10), tight)
    assert loose.iterations == 1 and tight.iterations > 1


def test_nan_ends_it(film):
    multigrid, scale = film

    def spoil(balance):
        multigrid.finest.P[3, 3] = np.nan
        multigrid.finest.update(multigrid.u)

    track = Track()
    assert iterate(multigrid, LOAD, spoil, goal(scale, 1e-12), track) is Status.NONFINITE
    assert track.iterations == 1


def test_a_film_that_is_none_has_not_converged(film):
    multigrid, scale = film
    multigrid.finest.H[0, 16] = -1e-3

    def nothing(balance):
        return 0.0

    assert iterate(multigrid, LOAD, nothing, goal(scale, 1e9, 9, 1e9, 1e9), Track()) is Status.UNRESOLVED


def test_interrupted_it_keeps_what_it_has(film):
    multigrid, scale = film

    def stop(balance):
        raise KeyboardInterrupt

    track = Track()
    with pytest.raises(KeyboardInterrupt):
        iterate(multigrid, LOAD, stop, goal(scale, 1e-12), track)
    assert len(track.residuals) == 1
