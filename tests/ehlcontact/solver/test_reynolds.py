"""Flow factor, operator and residual against loops over the whole domain."""

import numpy as np
import oracles
import pytest

from ehlcontact.solver.kernels import reynolds


@pytest.mark.parametrize("kernel", [reynolds.update_flow, reynolds.update_flow.py_func], ids=["jit", "python"])
def test_flow_factor_and_mass(level, point, kernel):
    level.H[2, 5] = -0.02  # overlapping bodies: eps floored, mass not
    flow = reynolds.Flow(*(np.full_like(level.P, np.nan) for _ in reynolds.Flow._fields))
    kernel(level.P, level.H, level.law, level.stencil, flow)
    expected_eps, expected_mass = oracles.flow_and_mass(level.P, level.H, point)
    np.testing.assert_allclose(flow.eps, expected_eps, rtol=1e-11)
    np.testing.assert_allclose(flow.mass, expected_mass, rtol=1e-13)
    np.testing.assert_allclose(flow.rho * level.H, expected_mass, rtol=1e-13)
    assert (flow.eps > 0.0).all()
    mean = np.vectorize(oracles.flow_mean)
    np.testing.assert_allclose(flow.along[:, :-1], mean(flow.eps[:, :-1], flow.eps[:, 1:]), rtol=1e-10)
    np.testing.assert_allclose(flow.across[:-1], mean(flow.eps[:-1], flow.eps[1:]), rtol=1e-10)


def test_slopes_of_the_flow(level):
    """Derivatives of ln(eps) and rho H to P and H, against differences."""
    f, h = level.fields, 1e-6
    f.P[...] += 0.05
    level.update_residual()

    def flow(dP, dH):
        trial = reynolds.Flow(*(np.zeros_like(f.P) for _ in reynolds.Flow._fields))
        reynolds.update_flow(f.P + dP, f.H + dH, level.law, level.stencil, trial)
        return trial

    for slope, mass_slope, d in (
        (f.flow.eps_slope, f.flow.mass_slope, (h, 0)),
        (f.flow.film_slope, f.flow.rho, (0, h)),
    ):
        plus, minus = flow(*d), flow(*(-step for step in d))
        np.testing.assert_allclose(slope, np.log(plus.eps / minus.eps) / (2 * h), rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(mass_slope, (plus.mass - minus.mass) / (2 * h), rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("kernel", [reynolds.residual, reynolds.residual.py_func], ids=["jit", "python"])
def test_residual(level, point, kernel):
    f, out = level.fields, np.full_like(level.P, 7.0)
    kernel(f.P, f.flow, level.stencil, level.c_t, level.rhs, out)
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
        N = reynolds.operator_at.py_func(3, i, f.P, f.flow, level.stencil, 0.0)
        assert -N == pytest.approx(0.2 + 0.2 * level.X[i] + 0.15 * level.X[i] ** 2, abs=1e-12)
