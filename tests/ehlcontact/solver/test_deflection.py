"""Deflection: coefficients, three engines of one sum, Hertz's pressure, and the engine of every solve."""

import tracemalloc
from functools import cache
from itertools import pairwise

import numpy as np
import oracles
import pytest

from ehlcontact import (
    Domain,
    FreeVibration,
    Grid,
    InputError,
    MoesPoint,
    TimeSteps,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.hertz import shape_factor
from ehlcontact.solver.deflection import ENGINES, make_deflection
from ehlcontact.solver.deflection.coefficients import influence_coefficients, injected_coefficients
from ehlcontact.solver.deflection.direct import DirectSum
from ehlcontact.solver.deflection.fft import FastFourier
from ehlcontact.solver.deflection.mlmi import Grid as CoarseGrid
from ehlcontact.solver.deflection.mlmi import Mlmi, correction_kernel
from ehlcontact.solver.kernels import mlmi as kernels
from ehlcontact.solver.level import Level

KAPPAS = [0.1, 0.5, 1.0, 3.0]
FINEST = 1024


def nodes(n):
    """Nodes of the default domain, n intervals along X."""
    return np.linspace(-4.5, 1.5, n + 1), np.linspace(0.0, 3.0, n // 2 + 1)[:, None]


def hertz(X, Y):
    return np.sqrt(np.maximum(0.0, 1.0 - X**2 - Y**2))


def bell(X, Y):
    """Smooth, so that the discretisation error is small and of second order in the maximum norm."""
    return np.exp(-3.0 * (X**2 + Y**2))


def film(X, Y):
    """Like an EHL pressure: inlet tail, Hertz's middle, spike, steep fall to cavitation."""
    inside = 1.0 - X**2 - Y**2
    body = np.sqrt(0.5 * (inside + np.sqrt(inside**2 + 0.02)))
    chord = np.sqrt(np.maximum(1.02 - Y**2, 0.0))
    fall = np.clip((chord - X) / 0.12, 0.0, 1.0)
    tail = (1.0 + (np.maximum(-X, 0.0) / 1.2) ** 4 + (Y / 1.2) ** 4) ** -2
    border = (1.0 - ((X + 1.5) / 3.0) ** 20) * (1.0 - (Y / 3.0) ** 20)
    across = np.maximum(1.0 - Y**2, 0.0)
    spike = 0.45 * np.exp(-(((X - 0.85 * np.sqrt(across)) / 0.05) ** 2)) * across**1.5
    return body * fall**2 * (3.0 - 2.0 * fall) * tail * border + spike


def make(engine, n, kappa):
    return make_deflection(n, n // 2, 6.0 / n, 6.0 / n, kappa, engine)


@cache
def finest(pressure, kappa):
    """FastFourier on the finest grid."""
    return make("fft", FINEST, kappa)(pressure(*nodes(FINEST)))


def discretisation_error(pressure, n, kappa, W):
    """Error of the deflection W of the exact sum: inside Hertz's ellipse, or against the finest grid."""
    X, Y = nodes(n)
    if pressure is hertz:
        S = shape_factor(kappa)
        return (W - (1.0 - S * X**2 - (1.0 - S) * Y**2))[X**2 + Y**2 < 1.0]
    every = FINEST // n
    return W - finest(pressure, kappa)[::every, ::every]


def random_pressure(nx, ny, seed=3):
    P = np.random.default_rng(seed).uniform(size=(ny + 1, nx + 1))
    P[-1] = 0.0
    P[:, [0, -1]] = 0.0
    return P


def rms(a):
    return np.sqrt(np.mean(a**2))


SHAPES = [(8, 4), (16, 8), (48, 12), (64, 32), (32, 80)]


@pytest.mark.parametrize("kappa", KAPPAS)
@pytest.mark.parametrize(("nx", "ny"), SHAPES)
def test_engines_agree_to_rounding(nx, ny, kappa):
    """Transforms always; multi-integration with the corrections over the whole grid."""
    mesh = (nx, ny, 6.0 / nx, 2.7 / ny, kappa)
    P = random_pressure(nx, ny)
    expected = DirectSum(*mesh)(P)
    tolerance = {"rtol": 0.0, "atol": 1e-12 * expected.max()}
    np.testing.assert_allclose(FastFourier(*mesh)(P), expected, **tolerance)
    np.testing.assert_allclose(Mlmi(*mesh, radius=1e3)(P), expected, **tolerance)


@pytest.mark.parametrize("kappa", KAPPAS)
def test_direct_sum(kappa):
    P = random_pressure(16, 12)
    expected = oracles.deflection(P, 0.3, 0.2, kappa)
    np.testing.assert_allclose(DirectSum(16, 12, 0.3, 0.2, kappa)(P), expected, rtol=1e-12)


@pytest.mark.parametrize("kappa", KAPPAS)
@pytest.mark.parametrize("n", [32, 64, 128, 256, 512])
def test_multi_integration_is_below_the_discretisation_error(n, kappa):
    fft, mlmi = make("fft", n, kappa), make("mlmi", n, kappa)
    for pressure in (hertz, film, bell):
        P = pressure(*nodes(n))
        W = fft(P)
        error = mlmi(P) - W
        discrete = discretisation_error(pressure, n, kappa, W)
        assert np.abs(error).max() < 0.3 * np.abs(discrete).max(), pressure.__name__
        assert rms(error) < rms(discrete), pressure.__name__


@pytest.mark.parametrize("engine", ["fft", "mlmi"])
@pytest.mark.parametrize("kappa", KAPPAS)
def test_second_order(kappa, engine):
    """Largest error of the bell's deflection from 32 to 256 intervals."""
    error = {n: np.abs(make(engine, n, kappa)(bell(*nodes(n))) - exact(n, kappa)).max() for n in (32, 256)}
    assert np.log(error[32] / error[256]) / np.log(8) > 1.75


def exact(n, kappa):
    """FastFourier of the bell, extrapolated from the two finest grids."""
    coarse = make("fft", FINEST // 2, kappa)(bell(*nodes(FINEST // 2)))
    limit = finest(bell, kappa)[::2, ::2] + (finest(bell, kappa)[::2, ::2] - coarse) / 3.0
    every = FINEST // 2 // n
    return limit[::every, ::every]


@pytest.mark.parametrize("kappa", [0.1, 1.0])
def test_wider_corrections_are_more_accurate(kappa):
    n = 128
    P = film(*nodes(n))
    W = make("fft", n, kappa)(P)
    error = [np.abs(Mlmi(n, n // 2, 6.0 / n, 6.0 / n, kappa, radius=m)(P) - W).max() for m in (6, 9, 13, 19)]
    assert all(wide < 0.25 * narrow for narrow, wide in pairwise(error))


@pytest.mark.parametrize("kappa", KAPPAS)
@pytest.mark.parametrize("engine", ENGINES)
def test_symmetries(engine, kappa):
    """Reversing X reverses the deflection; the influence of one node on another is mutual."""
    nx, ny = 64, 24
    W = make_deflection(nx, ny, 0.1, 0.1, kappa, engine)
    P, Q = random_pressure(nx, ny, 1), random_pressure(nx, ny, 2)
    WP, WQ = W(P), W(Q)
    np.testing.assert_allclose(W(np.ascontiguousarray(P[:, ::-1])), WP[:, ::-1], rtol=0, atol=1e-13 * WP.max())
    both_sides = np.where(np.arange(ny + 1) == 0, 1.0, 2.0)[:, None]
    work, virtual = np.vdot(both_sides * P, WQ), np.vdot(both_sides * Q, WP)
    assert work == pytest.approx(virtual, rel=1e-5 if engine == "mlmi" else 1e-13)


@pytest.mark.parametrize("engine", ENGINES)
def test_x_and_y_change_places_on_a_circle(engine):
    n = 32
    P = np.zeros((n + 1, 2 * n + 1))
    quarter = np.random.default_rng(0).uniform(size=(n, n))
    P[:n, n:-1] = quarter + quarter.T
    P[:, :n] = P[:, :n:-1]
    W = make_deflection(2 * n, n, 0.1, 0.1, 1.0, engine)(P)[:, n:]
    np.testing.assert_allclose(W, W.T, rtol=1e-4 if engine == "mlmi" else 1e-13)


@pytest.mark.parametrize("kappa", KAPPAS)
def test_coarse_kernel_is_injected(kappa):
    table = influence_coefficients(41, 25, 0.1, 0.15, kappa)
    injected = injected_coefficients(3 * np.arange(9), 4 * np.arange(11), 0.1, 0.15, kappa)
    np.testing.assert_allclose(injected, table[::3, ::4], rtol=1e-11)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("kappa", KAPPAS)
def test_correction_kernel(axis, kappa):
    """Zero outside the ellipse, inside it the error of interpolating the kernel."""
    hx, hy, radius = 0.1, 0.13, 7.0
    grid = CoarseGrid((2, 4), (64, 32), (2, 4))
    D, width = correction_kernel(grid, axis, radius, (hx, hy, kappa))
    steps = (hy * 2, kappa * hx * 4)
    k, lag = np.indices(D.shape)
    inside = np.hypot(k * steps[axis], lag * steps[1 - axis]) <= radius * steps[axis]
    assert (D[~inside] == 0.0).all()
    assert (width == inside.sum(axis=1)).all()
    row, column = min(2, len(D) - 1), min(1, width[2] - 1)
    weights = np.array([3, -25, 150, 150, -25, 3]) / 256

    def K(k, lag):
        lags = (2 * k, 4 * lag) if axis == 0 else (2 * lag, 4 * k)
        return injected_coefficients(np.array([lags[0]]), np.array([lags[1]]), hx, hy, kappa)[0, 0]

    interpolated = sum(w * K(row + q, column) for w, q in zip(weights, range(-5, 6, 2), strict=True))
    assert D[row, column] == pytest.approx(K(row, column) - interpolated, rel=1e-9, abs=0.0)


def halfway(values):
    """Interpolation at the node in the middle of six, by the kernel."""
    out = np.zeros(1)
    f, d, a, b, e, g = (np.array([v]) for v in values)
    kernels.add_halfway(a, b, d, e, f, g, out)
    return out[0]


@pytest.mark.parametrize("degree", range(6))
def test_interpolation_is_exact_to_degree_five(degree):
    assert halfway(np.arange(-4.0, 7.0, 2.0) ** degree) == pytest.approx(1.0, rel=1e-13)


def test_interpolation_is_of_sixth_order():
    h = np.array([0.1, 0.05])
    error = np.abs([halfway(np.exp(step * np.arange(-5, 6, 2))) - 1.0 for step in h])
    assert np.log2(error[0] / error[1]) == pytest.approx(6.0, abs=0.05)


@pytest.mark.parametrize("kappa", [0.2, 3.0])
def test_lifting_is_the_transpose_of_interpolation(kappa):
    """Moments to degree five of the pressure on both sides of Y = 0 are kept."""
    c = Mlmi(64, 32, 0.1, 0.1, kappa)._coarsenings[0]
    P = random_pressure(64, 32)
    c.P[...] = P
    kernels.lift(c.arrays)
    coarse = c.coarse_P.copy()
    both_sides = np.where(np.arange(33) == 0, 1.0, 2.0)[:, None]
    along_y = c.arrays.along_y
    for degree in (0, 2, 4) if along_y else range(6):
        if along_y:
            y = np.arange(coarse.shape[0])
            got = (both_sides[:1] * np.where(y == 0, 1.0, 2.0) * (2.0 * y) ** degree) @ coarse
            expected = (both_sides.T * np.arange(33.0) ** degree) @ P
        else:
            x = 2.0 * np.arange(-2, coarse.shape[1] - 2) - 32.0
            got, expected = coarse @ x**degree, P @ (np.arange(65.0) - 32.0) ** degree
        scale = np.abs(expected).max() + 32.0**degree
        np.testing.assert_allclose(got.ravel() / scale, expected.ravel() / scale, rtol=0, atol=1e-12)


@pytest.mark.parametrize("kappa", [0.1, 1.0, 3.0])
@pytest.mark.parametrize("engine", ENGINES)
def test_calls_do_not_depend_on_earlier_ones(engine, kappa):
    P, Q = random_pressure(32, 16, 1), random_pressure(32, 16, 2)
    W = make_deflection(32, 16, 0.2, 0.2, kappa, engine)
    first, kept = W(P), P.copy()
    copy = first.copy()
    W(1e9 * Q)
    assert (W(P) == first).all()
    assert (first == copy).all()
    assert (P == kept).all()
    assert first.flags.c_contiguous
    assert first.flags.owndata


def test_multi_integration_allocates_its_result_only():
    n = 128
    W, P = make("mlmi", n, 0.5), bell(*nodes(n))
    W(P)
    tracemalloc.start()
    result = W(P)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < result.nbytes + 20_000


def test_factory():
    kinds = {"direct": DirectSum, "fft": FastFourier, "mlmi": Mlmi}
    assert set(kinds) == set(ENGINES)
    for name, kind in kinds.items():
        engine = make_deflection(32, 16, 0.2, 0.25, 0.7, name)
        assert type(engine) is kind
        assert (engine.nx, engine.ny) == (32, 16)
        assert (engine.kernel == influence_coefficients(33, 33, 0.2, 0.25, 0.7)).all()
    assert type(make_deflection(32, 16, 0.2, 0.25, 0.7)) is FastFourier


@pytest.mark.parametrize("name", ["", "FFT", None, 3])
def test_unknown_engine(name):
    with pytest.raises(InputError, match=r"deflection = .* must be one of fft, mlmi, direct"):
        make_deflection(32, 16, 0.2, 0.2, 1.0, name)


@pytest.mark.parametrize("kappa", [0.08, 0.5, 1.0, 3.0])
def test_influence_coefficients(kappa):
    hx, hy = 0.11, 0.17
    table = influence_coefficients(6, 5, hx, hy, kappa)
    for k in range(5):
        for i in range(6):
            expected = oracles.influence(i * hx, k * hy, hx, hy, kappa)
            assert table[k, i] == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize(("i", "k"), [(1, 0), (0, 1), (3, 2)])
def test_influence_is_the_integral_over_the_cell(i, k):
    value = influence_coefficients(5, 5, 0.1, 0.2, 0.4)[k, i]
    assert value == pytest.approx(oracles.influence_by_quadrature(0.1 * i, 0.2 * k, 0.1, 0.2, 0.4), rel=1e-9)


@pytest.mark.parametrize(("nx", "ny"), [(12, 4), (16, 4), (24, 10), (48, 5), (33, 7), (44, 9)])
def test_transforms_of_any_length(nx, ny):
    P = random_pressure(nx, ny, nx)
    expected = oracles.deflection(P, 0.1, 0.07, 0.3)
    found = FastFourier(nx, ny, 0.1, 0.07, 0.3)(P)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * expected.max())


@pytest.mark.parametrize("nx", [48, 95, 96, 110])
def test_the_order_of_blocks_changes_no_bit(nx):
    """As with threads, of which any may be the last."""

    class Backwards:
        def run(self, kernel, count, *args, least):
            for k in reversed(range(count)):
                kernel(k, k + 1, *args)

    engine, P = FastFourier(nx, 24, 0.1, 0.1, 0.5), random_pressure(nx, 24)
    expected = engine(P)
    engine.team = Backwards()
    np.testing.assert_array_equal(engine(P), expected)


@pytest.mark.parametrize("nx", [16, 64])
def test_deflection_leaves_its_argument(nx):
    level = Level(MoesPoint(20, 5, 0.5), Domain(), nx, nx // 2)
    level.set_dry_hertz()
    P = level.P.copy()
    level.deflection(level.P)
    assert (P == level.P).all()


@pytest.mark.parametrize("kappa", [0.1, 0.5, 1.0, 2.0])
def test_hertz_pressure_closes_the_gap(kappa):
    """S X^2 + (1-S) Y^2 + W = 1 inside the ellipse and > 1 outside, where the surfaces part."""
    level = Level(MoesPoint(20, 5, kappa), Domain(-1.6, 1.6, 1.6), 128, 64)
    level.set_dry_hertz()
    level.update_film(1.0)
    r = np.hypot(*np.meshgrid(level.X, level.Y))
    assert np.abs(level.H[r < 0.9]).max() < 2e-3
    assert (level.H[r > 1.1] > 0.0).all()
    assert level.force() == pytest.approx(1.0, abs=1e-3)


POINT = MoesPoint(200, 10, 0.5)


def steady_film(engine):
    return solve_steady(POINT, grid=Grid(n=64, deflection=engine), tol=1e-9).h


def run(engine):
    time = TimeSteps(until=0.2, tol=1e-6)
    return simulate(POINT, FreeVibration(Omega_n=5.13), grid=Grid(n=32, deflection=engine), time=time).force


def response(engine):
    return impedance(POINT, Omega=[0.0, 3.0], grid=Grid(n=32, deflection=engine)).stiffness


def contact(engine):
    full = TransientContact(POINT, grid=Grid(n=32, deflection=engine), tol=1e-6)
    return np.array([full.advance(0.1, 0.9), full.advance(0.1, 0.88)])


@pytest.mark.parametrize("solve", [steady_film, run, response, contact])
@pytest.mark.parametrize(("engine", "error"), [("direct", 1e-7), ("mlmi", 1e-3)])
def test_solves_with_each_engine_find_the_same(solve, engine, error):
    """By the direct sum to the tolerance of the solves, by multi-integration below the error of these grids."""
    expected, got = solve("fft"), solve(engine)
    np.testing.assert_allclose(got, expected, rtol=error, atol=error)
    assert (got != expected).any()
