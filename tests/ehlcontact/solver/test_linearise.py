"""Analytic derivatives against differences of the discrete equations themselves."""

import numpy as np
import oracles
import pytest

from ehlcontact.solver.kernels import linearise as lin
from ehlcontact.solver.kernels import reynolds

KERNELS = [pytest.param(lin.linearise, id="jit"), pytest.param(lin.linearise.py_func, id="python")]


def operator(level, P, H, eps=None):
    """N at all interior nodes; with `eps` given, at that flow factor."""
    flow, out = reynolds.Flow(*(np.zeros_like(P) for _ in reynolds.Flow._fields)), np.zeros_like(P)
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
