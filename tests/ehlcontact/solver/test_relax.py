"""Line relaxation: band solver, distribution, the linear system of a line, and what a sweep does."""

import numpy as np
import oracles
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.kernels import relax
from ehlcontact.solver.kernels.linearise import linearise, neighbour
from ehlcontact.solver.level import Level

LOWER, UPPER, NEAR, SHARE = relax.BAND_LOWER, relax.BAND_UPPER, relax.NEAR, relax.SHARE


def jit_and_python(kernel):
    return pytest.mark.parametrize("kernel", [kernel, kernel.py_func], ids=["jit", "python"])


@jit_and_python(relax.solve_band)
@pytest.mark.parametrize("m", [1, 2, 3, 4, 5, 17, 60])
def test_solve_band(kernel, m):
    rng = np.random.default_rng(m)
    A = np.zeros((m, m))
    band, b = np.full((LOWER + UPPER + 1, m + relax.PAD), np.nan), np.full(m + relax.PAD, np.nan)
    b[:m] = rng.normal(size=m)
    for r in range(m):
        for c in range(max(0, r - LOWER), min(m, r + UPPER + 1)):
            A[r, c] = rng.normal() + (8.0 if r == c else 0.0)
            band[LOWER + c - r, r] = A[r, c]
    for r in range(m):  # entries beyond the last column meet the zeros there; those before the first are not read
        band[LOWER + m - r :, r] = 7.0
    expected = np.linalg.solve(A, b[:m])
    kernel(band, b, m)
    np.testing.assert_allclose(b[:m], expected, rtol=1e-11, atol=1e-13)


@jit_and_python(relax.distribution_weights)
@pytest.mark.parametrize("c_t", [0.0, 1.3])
def test_distribution_weights(level, point, kernel, c_t):
    f, theta = level.fields, np.full_like(level.P, np.nan)
    exponent = np.random.default_rng(2).uniform(-2, 2, f.P.shape)  # both sides of the switch
    eps = f.flow.eps
    eps[...] = level.hx**2 * 10.0**exponent
    f.flow.along[:, :-1] = np.vectorize(oracles.flow_mean)(eps[:, :-1], eps[:, 1:])
    f.flow.across[:-1] = np.vectorize(oracles.flow_mean)(eps[:-1], eps[1:])
    kernel(f.P, f.flow, level.stencil, c_t, theta)
    inner = [(j, i) for j in range(level.ny) for i in range(1, level.nx)]
    expected = [
        oracles.distribution_weight(f.P, eps, j, i, level.hx, level.hy, point.kappa, c_t) for j, i in inner
    ]
    np.testing.assert_allclose([theta[k] for k in inner], expected, rtol=1e-10, atol=1e-300)
    assert min(expected) == 0.0
    assert min(e for e in expected if e > 0.0) < 0.1
    assert max(expected) > 0.9


@jit_and_python(relax.apply_line)
@pytest.mark.parametrize("j", [0, 1, 2, 6, 7])
def test_apply_line(level, kernel, j):
    """Against the same change made on the whole domain, where line j and its image move together."""
    P = level.P.copy()
    assert P[P > 0.0].min() > 4e-3  # no cell runs dry while the line is worked through
    rng = np.random.default_rng(5)
    theta = np.where(P > 0.0, rng.uniform(size=P.shape), 0.0)
    w = np.where(P > 0.0, 1e-3 * rng.normal(size=P.shape), 0.0)
    full, wet, ny = oracles.mirrored(P), oracles.mirrored(P) > 0.0, level.ny
    for row in {ny + j, ny - j}:
        for i in range(1, level.nx):
            full[row, i] += w[j, i]
            for r, c in ((row, i - 1), (row, i + 1), (row - 1, i), (row + 1, i)):
                if wet[r, c]:
                    full[r, c] -= SHARE * theta[j, i] * w[j, i]
    kernel(j, P, theta, w)
    np.testing.assert_allclose(P, full[ny:], rtol=0, atol=1e-14)


@jit_and_python(relax.near_film)
@pytest.mark.parametrize("j", [1, 3])
def test_near_film(level, kernel, j):
    H, expected = level.H.copy(), level.H.copy()
    rng = np.random.default_rng(6)
    theta, w = rng.uniform(size=H.shape), rng.normal(size=H.shape)
    w[:, [0, -1]] = 0.0
    for i in range(1, level.nx):
        for jj in (j - 1, j + 1):
            for ii in range(max(1, i - NEAR), min(level.nx - 1, i + NEAR) + 1):
                d = abs(i - ii)
                expected[j, i] += w[jj, ii] * (level.near[1, d] - theta[jj, ii] * level.spread[1, d])
    kernel(j, H, theta, w, level.near, level.spread)
    np.testing.assert_allclose(H, expected, rtol=1e-13)


def line_matrix(level, j):
    """Response of N on line j to each distributed change of that line: exact in P, truncated in H."""
    f, nx = level.fields, level.nx
    A = np.zeros((nx - 1, nx - 1))
    for c in range(1, nx):
        dP = np.zeros((2 * level.ny + 1, nx + 1))
        row = level.ny + j
        for r in {row, 2 * level.ny - row}:
            dP[r, c] += 1.0
            for rr, cc in ((r, c - 1), (r, c + 1), (r - 1, c), (r + 1, c)):
                dP[rr, cc] -= SHARE * f.theta[j, c]
        for i in range(1, nx):
            for q in range(6):
                jq, iq = neighbour.py_func(q, j, i)
                iq = max(iq, 0)
                r = row - 1 if q == 3 else row + 1 if q == 4 else row
                A[i - 1, c - 1] += f.p_coef[q, j, i] * dP[r, iq]
                if jq == j and abs(iq - c) <= NEAR:
                    d = abs(iq - c)
                    A[i - 1, c - 1] += f.h_coef[q, j, i] * (level.near[0, d] - f.theta[j, c] * level.spread[0, d])
    return A


@pytest.mark.parametrize("j", [0, 1, 2, 5])
def test_line_solves_its_linear_system(point, j):
    """On a line under pressure all along, w solves ``A w = residual`` within the limit on changes."""
    level = Level(point, Domain(), 16, 8)
    f = level.fields
    f.P[:-1, 1:-1] = 0.5 + 0.02 * np.random.default_rng(7).uniform(size=(8, 15))
    level.update_film(0.4)
    level.rhs[...] = 0.0
    level.c_t = 0.5
    level.update_residual()
    relax.distribution_weights(f.P, f.flow, level.stencil, level.c_t, f.theta)
    f.theta[:, [1, -2]] = 0.0  # the border takes no share
    linearise(f.P, f.flow, level.stencil, level.c_t, relax.FLOW_SLOPE, f.p_coef, f.h_coef)
    # a small right-hand side, so that no change is limited
    level.rhs += 1e-3 * np.random.default_rng(8).normal(size=f.P.shape) - level.r
    level.update_residual()
    relax.relax_line(j, f, level.rhs, level.stencil, level.c_t, level.near, level.spread)
    A = line_matrix(level, j)
    below = np.subtract.outer(np.arange(15), np.arange(15))
    A[(below > LOWER) | (-below > UPPER)] = 0.0
    expected = np.linalg.solve(A, level.r[j, 1:-1])
    assert np.abs(expected).max() < relax.LARGEST_CHANGE
    np.testing.assert_allclose(f.w[j, 1:-1], expected, rtol=1e-8, atol=1e-12)


def test_damping_cuts_distributed_changes_alone(level):
    f, undamped = level.fields, level.stencil
    f.theta[:, 1:-1] = np.random.default_rng(4).uniform(size=(level.ny + 1, level.nx - 1))
    w = []
    for mesh in (undamped, undamped._replace(damping=0.3)):
        relax.relax_line(2, f, 0.01 * level.rhs, mesh, level.c_t, level.near, level.spread)
        w.append(f.w[2].copy())
    free = np.abs(w[0]) < relax.LARGEST_CHANGE
    assert np.count_nonzero(w[0][free]) > 5
    np.testing.assert_allclose(w[1][free], ((1.0 - 0.3 * f.theta[2]) * w[0])[free], rtol=1e-12)


def test_far_from_the_solution_changes_are_limited(level):
    """To the same size up and down; nodes that ask for less get what they ask for."""
    f, w = level.fields, []
    for size in (1e-4, 1e3):
        relax.relax_line(2, f, size * level.rhs, level.stencil, level.c_t, level.near, level.spread)
        w.append(f.w[2, 1:-1].copy())
    assert w[1].max() == relax.LARGEST_CHANGE and w[1].min() == -relax.LARGEST_CHANGE
    assert 0.0 < np.abs(w[0]).max() <= relax.LARGEST_CHANGE


def test_dry_node_joins_only_if_its_residual_asks_for_pressure(level):
    f = level.fields
    level.rhs *= 30.0  # both signs of the residual
    level.update_residual()
    linearise(f.P, f.flow, level.stencil, level.c_t, relax.FLOW_SLOPE, f.p_coef, f.h_coef)
    for j in range(level.ny):
        relax.relax_line(j, f, level.rhs, level.stencil, level.c_t, level.near, level.spread)
    inner = (slice(0, -1), slice(1, -1))
    dry, pushed_down = (f.P == 0.0)[inner], (level.r >= 0.0)[inner]
    assert (dry & pushed_down).any()
    assert (dry & ~pushed_down).any()
    assert (f.w[inner][dry & pushed_down] == 0.0).all()
    assert (f.w[inner][dry & ~pushed_down] != 0.0).all()


@pytest.mark.parametrize("kappa", [0.2, 1.0])
def test_converged_film_is_a_fixed_point(solve_by_newton, kappa):
    """Relaxation must stand still on a solution: no term may differ between it and the residual."""
    level, u = solve_by_newton(MoesPoint(20, 8, kappa))
    P = level.P.copy()
    for _ in range(3):
        level.update(u)
        level.relax()
    assert np.abs(level.P - P).max() < 1e-9


def test_sweeps_smooth_a_rough_error(solve_by_newton):
    """Three sweeps take a checkerboard error of 1 % out of a converged film by more than 10x."""
    level, u = solve_by_newton(MoesPoint(20, 8, 0.5))
    P = level.P.copy()
    j, i = np.indices(P.shape)
    level.P[...] = P * (1.0 + 0.01 * (-1.0) ** (i + j))
    level.update_film(u)
    level.update_residual()
    before = level.residual_norm()
    for _ in range(3):
        level.update(u)
        level.relax()
    level.update_film(u)
    level.update_residual()
    assert level.residual_norm() < 0.1 * before
    assert (level.P >= 0.0).all()
