"""Levels and hierarchies."""

import itertools

import numpy as np
import oracles
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.level import Level, build_hierarchy
from ehlcontact.solver.mesh import Mesh


def test_film_is_equation_3(level, point):
    level.film_shift = 0.25
    level.update_film(0.7)
    S = oracles.hertz_gap_share(point.kappa)
    W = oracles.deflection(level.P, level.hx, level.hy, point.kappa)
    X, Y = np.meshgrid(level.X, level.Y)
    expected = 0.25 - 0.7 + S * X**2 + (1.0 - S) * Y**2 + W
    np.testing.assert_allclose(level.H, expected, rtol=1e-11, atol=1e-12)


def test_force_is_equation_4(level):
    full = oracles.mirrored(level.P)
    assert level.force() == pytest.approx(1.5 / np.pi * full.sum() * level.hx * level.hy, rel=1e-13)


def test_residual_norm_is_a_mean_over_the_whole_wet_domain(level):
    wet, r = oracles.mirrored(level.P) > 0.0, oracles.mirrored(level.r)
    assert level.residual_norm() == pytest.approx(np.abs(r[wet]).mean(), rel=1e-12)
    level.P[...] = 0.0
    assert level.residual_norm() == 0.0


def test_border_of_the_residual_stays_zero(level):
    assert (level.r[-1] == 0.0).all()
    assert (level.r[:, [0, -1]] == 0.0).all()


@pytest.mark.parametrize("n", [16, 32, 48, 64, 96, 128, 160])
@pytest.mark.parametrize("coarsest", [16, 32])
def test_hierarchy(n, coarsest):
    domain = Domain(-5.0, 3.0, 4.0)
    levels = build_hierarchy(MoesPoint(20, 5, 0.5), Mesh(n, domain), coarsest)
    assert levels[-1].nx == n
    assert levels[0].nx < 2 * max(coarsest, 16) or levels[0].nx % 2
    for coarse, fine in itertools.pairwise(levels):
        assert (fine.nx, fine.ny) == (2 * coarse.nx, 2 * coarse.ny)
        np.testing.assert_allclose(fine.X[::2], coarse.X, atol=1e-14)
        np.testing.assert_allclose(fine.Y[::2], coarse.Y, atol=1e-14)
    assert 0.7 < levels[-1].hy / levels[-1].hx < 1.4
    assert (levels[-1].X[0], levels[-1].X[-1], levels[-1].Y[-1]) == (-5.0, 3.0, 4.0)


def apart(level, kappa):
    """Physical distance of lines over that of nodes."""
    return level.hy / (kappa * level.hx)


@pytest.mark.parametrize(
    ("kappa", "n", "coarsest", "alone"),
    [
        (1.0, 128, 16, 0),
        (3.0, 128, 16, 0),
        (0.21, 128, 16, 0),
        (0.19, 128, 16, 1),
        (0.09, 256, 16, 2),
        (0.03, 64, 16, 2),
    ],
)
def test_lines_far_apart_are_coarsened_along_x_first(kappa, n, coarsest, alone):
    """So many halvings along X alone; the coarsest grid is the same as by halving both."""
    domain = Domain(-2.0, 1.35, 1.6)
    levels = build_hierarchy(MoesPoint(20, 5, kappa), Mesh(n, domain), coarsest)
    ratios = [(fine.nx // coarse.nx, fine.ny // coarse.ny) for coarse, fine in itertools.pairwise(levels)][::-1]
    along = int(np.log2(n // coarsest))
    assert ratios == [(2, 1)] * alone + [(2, 2)] * (along - alone) + [(1, 2)] * alone
    for (coarse, fine), (x, y) in zip(itertools.pairwise(levels), ratios[::-1], strict=True):
        np.testing.assert_allclose(fine.X[::x], coarse.X, atol=1e-14)
        np.testing.assert_allclose(fine.Y[::y], coarse.Y, atol=1e-14)
        assert (x, y) == ((2, 1) if apart(fine, kappa) >= 5.0 else (2, 2)) or fine.nx == coarsest
    assert levels[-1].ny == levels[0].ny * n // coarsest
    assert 0.6 < levels[-1].hy / levels[-1].hx / max(1.0, kappa) < 1.25


@pytest.mark.parametrize(("lines", "alone"), [(1, 0), (2, 1), (4, 2)])
def test_close_lines_are_halved_first(lines, alone):
    """So many halvings across alone; nodes along X, and all coarser grids, are those without."""
    point, domain = MoesPoint(5000, 2, 3.7), Domain(-1.5, 1.2, 1.25)
    plain = build_hierarchy(point, Mesh(256, domain), 64)
    levels = build_hierarchy(point, Mesh(256, domain, lines), 64)
    sizes, usual = ([(level.nx, level.ny) for level in some] for some in (levels, plain))
    assert sizes == usual + [(256, usual[-1][1] * 2**k) for k in range(1, alone + 1)]
    assert apart(levels[-1], 3.7) * lines == pytest.approx(apart(plain[-1], 3.7), rel=1e-12)


def test_a_sweep_moves_the_pressure(level):
    """Which stays positive, and zero on the border; the next update needs nothing else of what it leaves."""
    P = level.P.copy()
    level.relax()
    assert (level.P != P).any() and (level.P >= 0.0).all()
    assert (level.P[-1] == 0.0).all() and (level.P[:, [0, -1]] == 0.0).all()
    H, r = level.H.copy(), level.update(0.3).copy()
    assert (level.H != H).any()
    np.testing.assert_array_equal(level.update(0.3), r)


def test_dry_start():
    level = Level(MoesPoint(20, 5, 0.5), Domain(-1.5, 1.5, 1.5), 48, 24)
    level.set_dry_hertz()
    assert level.P[0, 24] == 1.0
    assert level.P[0, 0] == 0.0
    assert level.force() == pytest.approx(1.0, abs=0.01)
