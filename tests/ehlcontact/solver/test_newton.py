"""Newton on the finest grid: its linear algebra term by term, and agreement with the multigrid cycle."""

from math import pi

import numpy as np
import pytest

from ehlcontact import MoesPoint
from ehlcontact.solver import newton as newton_module
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.iterate import IterationHistory, StoppingCriteria, iterate
from ehlcontact.solver.kernels import linearise as lin
from ehlcontact.solver.linear import (
    NEIGHBOUR_OFFSETS,
    CoarseCorrection,
    LinearFilm,
    Preconditioner,
    solve_linear,
    stencil_matrix,
)
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.newton import NewtonKrylov
from ehlcontact.status import Status
from ehlcontact.transient.transient_film import TransientFilm

LOAD = Balance.of_load()
POINTS = [(200, 10, 1.0), (200, 10, 0.5), (500, 15, 0.12), (2900, 19, 0.11), (20, 5, 0.5), (200, 10, 2.0)]
FINE = [pytest.param(*point, 128) for point in POINTS]
FINEST = [pytest.param(*point, 256, marks=pytest.mark.slow) for point in POINTS]


def hierarchy(M, L, kappa, n):
    point = MoesPoint(M, L, kappa)
    multigrid = Multigrid(point, Mesh(n, Domain.for_point(point), point.kappa))
    return multigrid, multigrid.finest.dry_residual()


def started(M, L, kappa, n, balance=LOAD):
    multigrid, scale = hierarchy(M, L, kappa, n)
    multigrid.full_multigrid(balance)
    multigrid.cycle(balance)
    return multigrid, scale


def newton(multigrid, scale, tol, balance=LOAD, most=20, settle=1e-7):
    """Newton steps to `tol`: how they ended, and their track."""
    track = IterationHistory()
    goal = StoppingCriteria(scale, tol, most, settle, settle)
    return iterate(multigrid, balance, NewtonKrylov(multigrid).step, goal, track), track


def system_of(multigrid, balance=LOAD):
    level = multigrid.finest
    level.update_film(multigrid.u)
    r = level.update_residual()
    system = LinearFilm(level, (level.P > 0.0) | (r < 0.0), balance)
    return system, system.right_hand_side(r, balance.residual(multigrid.u, level.force()))


def cycled(M, L, kappa, n, tol):
    """The same start and equations, solved by cycles alone."""
    multigrid, scale = started(M, L, kappa, n)
    for _ in range(60):
        multigrid.finest.update_film(multigrid.u)
        multigrid.finest.update_residual()
        load = LOAD.residual(multigrid.u, multigrid.finest.force())
        if multigrid.finest.residual_norm() < tol * scale and abs(load) < 1e-10:
            break
        multigrid.cycle(LOAD)
    return multigrid


def test_stencil_matrix_reads_the_neighbours_of_the_kernels(make_level, point):
    level = make_level(point)
    shape = level.P.shape
    coefficients = np.zeros((lin.NEIGHBOURS, *shape))
    rng = np.random.default_rng(2)
    coefficients[:, :-1, 2:-1] = rng.normal(size=(lin.NEIGHBOURS, shape[0] - 1, shape[1] - 3))
    field = rng.normal(size=shape)
    expected = np.zeros(shape)
    for j in range(shape[0] - 1):
        for i in range(2, shape[1] - 1):
            for q in range(lin.NEIGHBOURS):
                expected[j, i] += coefficients[q, j, i] * field[lin.neighbour.py_func(q, j, i)]
    got = stencil_matrix(NEIGHBOUR_OFFSETS, coefficients, shape) @ field.ravel()
    np.testing.assert_allclose(got.reshape(shape), expected, atol=1e-13)


def test_linear_film_is_the_dense_bordered_jacobian(make_level, point):
    level = make_level(point)
    balance = Balance(2.0, 3.0, 0.0)
    free = level.P > 0.0
    system = LinearFilm(level, free, balance)
    f, nodes = level.fields, np.flatnonzero(free)
    J = np.empty((nodes.size + 1, nodes.size + 1))
    lin.dense_jacobian(nodes, f.p_coef, f.h_coef, level.deflection.kernel, np.empty(f.P.size, dtype=np.int64), J)
    J[-1, :-1] = balance.weight * level.force_weights.ravel()[nodes]
    J[-1, -1] = balance.stiffness
    y = np.random.default_rng(3).normal(size=nodes.size + 1)
    x = np.zeros(f.P.size + 1)
    x[nodes], x[-1] = y[:-1], y[-1]
    got = system(x)
    expected = J @ y
    np.testing.assert_allclose(got[nodes], expected[:-1], atol=1e-11 * np.abs(expected).max())
    assert got[-1] == pytest.approx(system.scale * expected[-1])
    outside = np.ones(x.size, dtype=bool)
    outside[[*nodes, -1]] = False
    assert (got[outside] == 0.0).all()


def test_right_hand_side_is_the_residual_of_the_equations(make_level, point):
    """A small change along any direction reduces it by what the operator says."""
    level = make_level(point)
    level.P[...] += 0.05 * (level.P > 0.0)
    u, balance = -0.5, Balance(2.0, 3.0, 1.0)
    level.update_film(u)
    r = level.update_residual().copy()
    free = level.P > 0.0
    system = LinearFilm(level, free, balance)
    before = system.right_hand_side(r, balance.residual(u, level.force()))
    P, rng, h = level.P.copy(), np.random.default_rng(4), 1e-6
    x = np.append((rng.normal(size=P.shape) * free).ravel(), 0.7)
    change = np.zeros_like(x)
    for sign in (1.0, -1.0):
        level.P[...] = P + sign * h * x[:-1].reshape(P.shape)
        level.update_film(u + sign * h * x[-1])
        level.update_residual()
        after = system.right_hand_side(level.r, balance.residual(u + sign * h * x[-1], level.force()))
        change += sign * (after - before) / (2.0 * h)
    expected = -system(x)
    np.testing.assert_allclose(change, expected, atol=1e-6 * np.abs(expected).max(), rtol=1e-5)


@pytest.mark.parametrize(
    "ratios", [(4, 4), (8, 2), (2, 8), (4, 1), (1, 4)], ids="along {0[0]}, across {0[1]}".format
)
def test_coarse_correction_moves_between_grids_of_any_ratio(point, make_level, ratios):
    """Up: bilinear. Down: its transpose by areas, so that a constant stays, and no force is lost."""
    fine = make_level(point, nx=96, ny=16)
    coarse = make_level(point, nx=96 // ratios[0], ny=16 // ratios[1])
    inner = np.zeros(coarse.P.shape, dtype=bool)
    inner[:-1, 1:-1] = True
    free = np.zeros(fine.P.shape, dtype=bool)
    free[:-1, 1:-1] = True
    system = LinearFilm(fine, free, LOAD)
    correction = CoarseCorrection(coarse, fine, system)
    np.testing.assert_array_equal(coarse.P, fine.P[:: ratios[1], :: ratios[0]])
    e = np.random.default_rng(6).normal(size=coarse.P.shape) * inner
    up = (correction._up @ e[inner]).reshape(fine.P.shape)
    along = np.array([np.interp(fine.X, coarse.X, line) for line in e])
    expected = np.array([np.interp(fine.Y, coarse.Y, line) for line in along.T]).T
    np.testing.assert_allclose(up, expected, atol=1e-13)
    r = np.random.default_rng(7).normal(size=fine.P.shape)
    down = correction._down @ r.ravel()
    assert np.sum(coarse.force_weights[inner] * down * e[inner]) == pytest.approx(
        np.sum(fine.force_weights * r * up), rel=1e-11, abs=1e-13
    )
    whole = np.zeros(coarse.P.shape)
    whole[inner] = correction._down @ np.ones(fine.P.size)
    np.testing.assert_allclose(whole[:-1, 1:-1], 1.0, rtol=1e-12)


@pytest.mark.parametrize("n", [64, 128])
@pytest.mark.parametrize(("M", "L", "kappa"), [(200, 10, 0.5), (2900, 19, 0.11), (200, 10, 2.0), (500, 15, 0.05)])
def test_preconditioner_makes_the_iterations_few(M, L, kappa, n):
    """Two digits in at most ten iterations at the solution, on either grid."""
    multigrid = cycled(M, L, kappa, n, 1e-4)
    system, b = system_of(multigrid)
    solution = solve_linear(system, Preconditioner(multigrid.levels, system), b, 1e-2)
    assert solution.converged
    assert np.linalg.norm(b - system(solution.x)) <= 1e-2 * np.linalg.norm(b) * (1.0 + 1e-6)
    assert solution.iterations <= 10


@pytest.mark.parametrize(("M", "L", "kappa", "n"), FINE + FINEST)
def test_agrees_with_the_cycle(M, L, kappa, n):
    """Same u and H to 1e-9 at tight tolerance, on the way to which the first tolerance takes few steps."""
    multigrid, scale = started(M, L, kappa, n)
    assert newton(multigrid, scale, 1e-9, settle=1e-10)[0] is Status.CONVERGED
    other = cycled(M, L, kappa, n, 1e-9)
    multigrid.finest.update_film(multigrid.u)
    other.finest.update_film(other.u)
    assert multigrid.u == pytest.approx(other.u, abs=1e-9)
    np.testing.assert_allclose(multigrid.finest.H, other.finest.H, atol=1e-9)
    np.testing.assert_allclose(multigrid.finest.P, other.finest.P, atol=1e-8)


def test_a_step_tells_the_largest_change_of_the_pressure():
    multigrid, _ = started(200, 10, 0.5, 64)
    solver, level = NewtonKrylov(multigrid), multigrid.finest
    for _ in range(2):
        before = level.P.copy()
        change = solver.step(LOAD)
        assert change == np.abs(level.P - before).max() > 0.0
        H, r = level.H.copy(), level.r.copy()
        level.update(multigrid.u)  # what belongs to the state it leaves
        np.testing.assert_array_equal((level.H, level.r), (H, r))


def test_steps_from_full_multigrid():
    """Asked: a median of at most six to the tolerance of a steady solve."""
    steps = []
    for point in POINTS:
        multigrid, scale = started(*point, 64)
        _, track = newton(multigrid, scale, 3e-5)
        assert track.residuals[-1] <= 3e-5 * scale  # the film itself may be too thin for this grid
        assert abs(track.balance_residuals[-1]) < 1e-7
        steps.append(track.iterations)
    assert np.median(steps) <= 6


def test_complementarity():
    multigrid, scale = started(200, 10, 0.5, 64)
    newton(multigrid, scale, 1e-9)
    level = multigrid.finest
    level.update_film(multigrid.u)
    level.update_residual()
    assert (level.P >= 0.0).all()
    assert (level.r[level.P == 0.0] >= 0.0).all()


@pytest.mark.parametrize("balance", [Balance.of_approach(0.7), Balance(3.0, 1.0, 3.2)], ids=["approach", "motion"])
def test_other_balances(balance):
    multigrid, scale = started(20, 8, 0.5, 64, balance)
    assert newton(multigrid, scale, 1e-9, balance)[0] is Status.CONVERGED
    assert balance.residual(multigrid.u, multigrid.finest.force()) == pytest.approx(0.0, abs=1e-7)


def test_nan_is_reported():
    multigrid, scale = started(20, 8, 0.5, 64)
    multigrid.finest.P[3, 3] = np.nan
    multigrid.finest.update(multigrid.u)
    assert newton(multigrid, scale, 1e-6)[0] is Status.NONFINITE


def test_too_few_steps_are_reported():
    multigrid, scale = started(200, 10, 0.5, 64)
    status, track = newton(multigrid, scale, 1e-12, most=2)
    assert status is Status.MAX_CYCLES
    assert track.iterations == 2


@pytest.mark.parametrize(("M", "L", "kappa"), [(200, 10, 0.5), (2900, 19, 0.11)])
def test_transient_steps_agree_and_share_factors(M, L, kappa, monkeypatch):
    """Ten steps under a harmonic load by cycles and by Newton steps; one factorisation serves them all."""
    made = []

    def counted(*of):
        made.append(Preconditioner(*of))
        return made[-1]

    monkeypatch.setattr(newton_module, "Preconditioner", counted)
    point, dT, omega_n = MoesPoint(M, L, kappa), 0.02, 5.13
    results = []
    for by_newton in (False, True):
        film = TransientFilm(point, Mesh(64, Domain.for_point(point), point.kappa), tol=1e-8)
        film.start_steady(LOAD)
        solver = NewtonKrylov(film.multigrid)
        if by_newton:
            film.multigrid.cycle = solver.step
        rest = film.u
        for k in range(1, 11):
            load = 1.0 + 0.1 * np.sin(2.0 * pi * k * dT)
            step = film.advance(dT, Balance.newmark(omega_n, dT, load, rest), film.u)
            assert step.status.ok
        results.append((film.u, film.level.H.copy()))
    assert len(made) == 1
    assert results[1][0] == pytest.approx(results[0][0], abs=1e-10)
    np.testing.assert_allclose(results[1][1], results[0][1], atol=1e-8)
