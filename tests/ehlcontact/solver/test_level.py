"""Levels of a hierarchy: fields, transfer between them, and the coarsest one."""

import itertools

import numpy as np
import oracles
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse_newton import CoarseNewton
from ehlcontact.solver.kernels import transfer
from ehlcontact.solver.level import Level, build_hierarchy
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import initial_approach


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
    levels = build_hierarchy(MoesPoint(20, 5, 0.5), Mesh(n, domain, 0.5), coarsest)
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
    levels = build_hierarchy(MoesPoint(20, 5, kappa), Mesh(n, domain, kappa), coarsest)
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
    plain = build_hierarchy(point, Mesh(256, domain, point.kappa), 64)
    levels = build_hierarchy(point, Mesh(256, domain, point.kappa, lines), 64)
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


FINE = (13, 17)


def jit_and_python(kernel):
    return pytest.mark.parametrize("kernel", [kernel, kernel.py_func], ids=["jit", "python"])


@pytest.fixture
def rng():
    return np.random.default_rng(11)


@pytest.fixture(params=[(2, 2), (2, 1), (1, 2)], ids="along {0[0]}, across {0[1]}".format)
def ratios(request):
    """How much coarser the coarse mesh is along X and along Y."""
    return request.param


@pytest.fixture
def shape(ratios):
    """Of the coarse fields."""
    return 12 // ratios[1] + 1, 16 // ratios[0] + 1


def without_border(field):
    field[-1] = 0.0
    field[:, [0, -1]] = 0.0
    return field


@jit_and_python(transfer.full_weighting)
def test_full_weighting(rng, ratios, shape, kernel):
    fine = rng.normal(size=FINE)
    coarse = np.full(shape, np.nan)
    kernel(fine, coarse, *ratios)
    np.testing.assert_allclose(coarse, oracles.full_weighting(fine, *ratios), rtol=1e-13, atol=1e-15)


@jit_and_python(transfer.restrict_pressure)
def test_restrict_pressure(rng, ratios, shape, kernel):
    fine = np.maximum(rng.uniform(-0.05, 1.0, FINE), 0.0)
    weighted = oracles.full_weighting(fine, *ratios)
    full = oracles.mirrored(fine)
    along, across = ratios
    coarse = np.zeros(shape)
    kernel(fine, coarse, *ratios)
    kinds = set()
    for j in range(shape[0] - 1):
        for i in range(1, shape[1] - 1):
            rows = slice(12 + across * j - across + 1, 12 + across * j + across)
            wet = (full[rows, along * i - along + 1 : along * i + along] > 0.0).all()
            kinds.add(bool(wet))
            expected = weighted[j, i] if wet else fine[across * j, along * i]
            assert coarse[j, i] == pytest.approx(expected, rel=1e-13)
    assert kinds == {True, False}
    assert (coarse[-1] == 0.0).all()
    assert (coarse[:, [0, -1]] == 0.0).all()


@jit_and_python(transfer.add_correction)
def test_add_correction(rng, ratios, shape, kernel):
    old = without_border(np.maximum(rng.uniform(-0.03, 1.0, shape), 0.0))
    new = without_border(np.maximum(old + 0.1 * rng.normal(size=shape), 0.0))
    fine = np.maximum(rng.uniform(-0.1, 0.5, FINE), 0.0)
    start = fine.copy()
    kernel(new, old, fine, *ratios)
    corrected = 0
    for j in range(12):
        for i in range(1, 16):
            lines = {int(np.floor(j / ratios[1])), int(np.ceil(j / ratios[1]))}
            columns = {int(np.floor(i / ratios[0])), int(np.ceil(i / ratios[0]))}
            inner = [(jc, ic) for jc in lines for ic in columns if jc < shape[0] - 1 and 0 < ic < shape[1] - 1]
            if start[j, i] > 0.0 and all(new[k] > 0.0 and old[k] > 0.0 for k in inner):
                corrected += 1
                expected = max(start[j, i] + oracles.bilinear(new - old, j, i, *ratios), 0.0)
                assert fine[j, i] == pytest.approx(expected, rel=1e-12, abs=1e-15)
            else:
                assert fine[j, i] == start[j, i]
    assert 0.4 * 12 * 15 < corrected < 12 * 15
    assert (fine[-1] == start[-1]).all()


def test_correction_of_a_plane_is_exact(ratios, shape):
    Y, X = np.indices(shape)
    fine = np.ones(FINE)
    transfer.add_correction(1.0 + 0.1 * X + 0.05 * Y, np.ones(shape), fine, *ratios)
    y, x = np.indices(FINE)
    expected = 1.0 + 0.1 * x / ratios[0] + 0.05 * y / ratios[1]
    np.testing.assert_allclose(fine[:-1, 1:-1], expected[:-1, 1:-1], rtol=1e-14)


def test_weighting_and_interpolation_are_adjoint(rng, ratios, shape):
    """``(FW r, e)_coarse`` is ``(r, I e)_fine`` over the nodes per coarse node: one balance on both grids.

    The symmetry line is counted half.
    """
    r = without_border(rng.normal(size=FINE))
    e = without_border(rng.uniform(0.1, 1.0, shape))
    coarse = np.zeros(shape)
    transfer.full_weighting(r, coarse, *ratios)
    base, fine = np.ones(shape), np.full(FINE, 5.0)
    transfer.add_correction(base + e, base, fine, *ratios)
    half = np.ones(13)
    half[0] = 0.5
    left = np.sum(half[: shape[0], None] * coarse * e)
    right = np.sum(half[:, None] * r * (fine - 5.0)) / (ratios[0] * ratios[1])
    assert left == pytest.approx(right, rel=1e-12)


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
