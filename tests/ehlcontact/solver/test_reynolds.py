"""Reynolds kernels: mean flow, operator, residual and their derivatives, against loops and differences."""

from math import exp, log

import numpy as np
import oracles
import pytest

from ehlcontact.solver.kernels import linearise as lin
from ehlcontact.solver.kernels import reynolds
from ehlcontact.solver.kernels import reynolds as mean

PAIRS = [(1.0, 1.0), (2.0, 3.0), (1e-12, 40.0), (1e-200, 1e-3), (5.0, 1e-300)]


@pytest.mark.parametrize(("a", "b"), PAIRS)
def test_against_the_log_ratio(a, b):
    value, skew = mean.flow_mean(a, b)
    assert value == pytest.approx(oracles.flow_mean(a, b), rel=1e-10)
    assert mean.flow_mean(b, a) == (value, -skew)


def test_underflow_gives_nothing():
    value, skew = mean.flow_mean(0.0, 0.0)
    assert value < 1e-200
    assert skew == 0.0


@pytest.mark.parametrize(("a", "b"), PAIRS[:3])
def test_slopes_against_differences(a, b):
    h = 1e-5

    def f(a, b):
        return mean.flow_mean(a, b)[0]

    expected = (
        (f(a * exp(h), b) - f(a * exp(-h), b)) / (2.0 * h),
        (f(a, b * exp(h)) - f(a, b * exp(-h))) / (2.0 * h),
    )
    value, skew = mean.flow_mean(a, b)
    assert (0.5 * value + skew, 0.5 * value - skew) == pytest.approx(expected, rel=1e-7, abs=1e-9 * value)


def test_flow_follows_both_pressures():
    """Down a slope of any steepness, eps = exp(-alpha P): more flow for more pressure upstream."""
    alpha = 20.0
    drop = np.linspace(0.01, 3.0, 400)
    flow = np.array([mean.flow_mean(exp(-alpha * d), 1.0)[0] * d for d in drop])
    assert (np.diff(flow) > 0.0).all()
    geometric = np.exp(-0.5 * alpha * drop) * drop
    assert (np.diff(geometric) < 0.0).any()  # what the geometric mean would do


def test_nearly_geometric_for_neighbours_alike():
    x = 0.5 * log(2.0)
    assert mean.flow_mean(1.0, 2.0)[0] / 2.0**0.5 - 1.0 == pytest.approx(x**4 / 8.0, rel=0.1)


def test_flow_factor_and_mass(level, point):
    level.H[2, 5] = -0.02  # overlapping bodies: eps floored, mass not
    flow = reynolds.Flow(*(np.full_like(level.P, np.nan) for _ in reynolds.Flow._fields))
    flow.open[...], flow.aside[...], flow.heat[...] = 1.0, 0.7, 0.0  # inputs
    reynolds.update_flow(level.P, level.H, level.law, level.stencil, flow)
    expected_eps, expected_mass = oracles.flow_and_mass(level.P, level.H, point)
    np.testing.assert_allclose(flow.eps, expected_eps, rtol=1e-11)
    np.testing.assert_allclose(flow.mass, expected_mass, rtol=1e-13)
    np.testing.assert_allclose(flow.rho * level.H, expected_mass, rtol=1e-13)
    assert (flow.eps > 0.0).all()
    mean = np.vectorize(oracles.flow_mean)
    np.testing.assert_allclose(flow.along[:, :-1], mean(flow.eps[:, :-1], flow.eps[:, 1:]), rtol=1e-10)
    np.testing.assert_allclose(flow.across[:-1], 0.7 * mean(flow.eps[:-1], flow.eps[1:]), rtol=1e-10)


def test_slopes_of_the_flow(level):
    """Derivatives of ln(eps) and rho H to P and H, against differences."""
    f, h = level.fields, 1e-6
    f.P[...] += 0.05
    level.update_residual()

    def flow(dP, dH):
        trial = reynolds.new_flow(f.P.shape)
        reynolds.update_flow(f.P + dP, f.H + dH, level.law, level.stencil, trial)
        return trial

    for slope, mass_slope, d in (
        (f.flow.eps_slope, f.flow.mass_slope, (h, 0)),
        (f.flow.film_slope, f.flow.rho, (0, h)),
    ):
        plus, minus = flow(*d), flow(*(-step for step in d))
        np.testing.assert_allclose(slope, np.log(plus.eps / minus.eps) / (2 * h), rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(mass_slope, (plus.mass - minus.mass) / (2 * h), rtol=1e-6, atol=1e-8)


def test_residual(level, point):
    f, out = level.fields, np.full_like(level.P, 7.0)
    reynolds.residual(f.P, f.flow, level.stencil, level.c_t, level.rhs, out)
    N = oracles.operator(f.P, f.flow.eps, f.flow.mass, level.hx, level.hy, point.kappa, level.c_t)
    inner = (slice(0, -1), slice(1, -1))  # the symmetry line is interior
    np.testing.assert_allclose(out[inner], (level.rhs - N)[inner], rtol=1e-11, atol=1e-11)
    assert (out[-1] == 7.0).all()
    assert (out[:, [0, -1]] == 7.0).all()


def test_symmetry_line_sees_its_image(level):
    """What line 1 carries must reach line 0 from both sides."""
    f = level.fields
    before = reynolds.operator_at(0, 6, f.P, f.flow, level.stencil, level.c_t)
    f.P[1, 6] += 0.1
    after = reynolds.operator_at(0, 6, f.P, f.flow, level.stencil, level.c_t)
    coupling = oracles.flow_mean(f.flow.eps[0, 6], f.flow.eps[1, 6])
    assert after - before == pytest.approx(0.2 * level.stencil.cy * coupling, rel=1e-10)


def test_wedge_is_exact_for_cubics_beyond_the_first_line(level):
    f = level.fields
    f.P[...] = 0.0
    f.flow.mass[...] = 0.3 + 0.2 * level.X + 0.1 * level.X**2 + 0.05 * level.X**3
    for i in range(2, level.nx):
        N = reynolds.operator_at(3, i, f.P, f.flow, level.stencil, 0.0)
        assert -N == pytest.approx(0.2 + 0.2 * level.X[i] + 0.15 * level.X[i] ** 2, abs=1e-12)


KERNELS = [pytest.param(lin.linearise, id="jit"), pytest.param(lin.linearise.py_func, id="python")]


def operator(level, P, H, eps=None):
    """N at all interior nodes; with `eps` given, at that Poiseuille coefficient."""
    flow, out = reynolds.new_flow(P.shape), np.zeros_like(P)
    reynolds.update_flow(P, H, level.law, level.stencil, flow)
    if eps is not None:
        flow.along[:, :-1] = np.vectorize(oracles.flow_mean)(eps[:, :-1], eps[:, 1:])
        flow.across[:-1] = np.vectorize(oracles.flow_mean)(eps[:-1], eps[1:])
    reynolds.residual(P, flow, level.stencil, level.c_t, np.zeros_like(P), out)
    return -out


def difference(level, dP, dH, eps, h=1e-5):
    f = level.fields
    plus = operator(level, f.P + h * dP, f.H + h * dH, eps)
    minus = operator(level, f.P - h * dP, f.H - h * dH, eps)
    return (plus - minus) / (2.0 * h)


def linear(p_coef, h_coef, dP, dH):
    """Sum over neighbours, in plain loops."""
    out = np.zeros_like(dP)
    ny, nx = dP.shape[0] - 1, dP.shape[1] - 1
    for j in range(ny):
        for i in range(1, nx):
            for q in range(lin.NEIGHBOURS):
                if q == 5 and i == 1:
                    continue  # no second upstream neighbour on the first line
                jq, iq = lin.neighbour.py_func(q, j, i)
                out[j, i] += p_coef[q, j, i] * dP[jq, iq] + h_coef[q, j, i] * dH[jq, iq]
    return out


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("flow_slope", [1.0, 0.0, 0.75])
@pytest.mark.parametrize("what", ["P", "H"])
def test_against_differences(level, kernel, flow_slope, what):
    f = level.fields
    f.P[...] += 0.05  # off zero, so that both differences exist
    level.update_residual()
    p_coef, h_coef = (np.full((6, *f.P.shape), np.nan) for _ in range(2))
    kernel(f.P, f.flow, level.stencil, level.c_t, flow_slope, p_coef, h_coef)
    rng = np.random.default_rng(3)
    change = rng.normal(size=f.P.shape)
    none = np.zeros_like(change)
    dP, dH = (change, none) if what == "P" else (none, change * f.H)
    full, frozen = (difference(level, dP, dH, eps) for eps in (None, f.flow.eps.copy()))
    expected = flow_slope * full + (1.0 - flow_slope) * frozen
    got = linear(p_coef, h_coef, dP, dH)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(got[:-1, 1:-1], expected[:-1, 1:-1], atol=1e-7 * scale, rtol=1e-6)


def test_first_line_has_no_second_upstream_neighbour(level):
    f = level.fields
    lin.linearise(f.P, f.flow, level.stencil, level.c_t, 1.0, f.p_coef, f.h_coef)
    assert (f.p_coef[5, :-1, 1] == 0.0).all()
    assert (f.h_coef[5, :-1, 1] == 0.0).all()


@pytest.mark.parametrize(
    "kernel", [pytest.param(lin.dense_jacobian, id="jit"), pytest.param(lin.dense_jacobian.py_func, id="python")]
)
def test_dense_jacobian(level, kernel):
    """Columns are the response of N to one pressure, or to u, through the whole film."""
    f = level.fields
    level.update_film(-0.5)  # H > 0 everywhere, consistent with P
    level.update_residual()
    P, size = f.P.copy(), f.P.size
    free = np.flatnonzero(P > 0.0)
    lin.linearise(f.P, f.flow, level.stencil, level.c_t, 1.0, f.p_coef, f.h_coef)
    J = np.full((free.size + 1, free.size + 1), np.nan)
    kernel(free, f.p_coef, f.h_coef, level.deflection.kernel, np.empty(size, dtype=np.int64), J)

    def N(dP, du):
        f.P[...] = P + dP
        level.update_film(-0.5 + du)
        return operator(level, f.P, f.H).ravel()[free]

    h = 1e-5
    unit = np.zeros(size)
    for column in range(0, free.size, 7):
        unit[:] = 0.0
        unit[free[column]] = h
        dP = unit.reshape(P.shape)
        expected = (N(dP, 0.0) - N(-dP, 0.0)) / (2.0 * h)
        atol = 1e-7 * np.abs(expected).max()
        np.testing.assert_allclose(J[:-1, column], expected, atol=atol, rtol=1e-6)
    expected = (N(0.0, h) - N(0.0, -h)) / (2.0 * h)
    np.testing.assert_allclose(J[:-1, -1], expected, atol=1e-7 * np.abs(expected).max(), rtol=1e-6)
