"""Flow factor, operator and residual against loops over the whole domain."""

import numpy as np
import oracles
import pytest

from ehlcontact._kernels import reynolds


@pytest.mark.parametrize("kernel", [reynolds.update_flow, reynolds.update_flow.py_func], ids=["jit", "python"])
def test_flow_factor_and_mass(level, point, kernel):
    level.H[2, 5] = -0.02  # overlapping bodies: eps floored, mass not
    eps, mass = np.full_like(level.P, np.nan), np.full_like(level.P, np.nan)
    kernel(level.P, level.H, level.law, level.mesh, eps, mass)
    expected_eps, expected_mass = oracles.flow_and_mass(level.P, level.H, point)
    np.testing.assert_allclose(eps, expected_eps, rtol=1e-11)
    np.testing.assert_allclose(mass, expected_mass, rtol=1e-13)
    assert (eps > 0.0).all()


@pytest.mark.parametrize("kernel", [reynolds.residual, reynolds.residual.py_func], ids=["jit", "python"])
def test_residual(level, point, kernel):
    f, out = level.fields, np.full_like(level.P, 7.0)
    kernel(f.P, f.eps, f.mass, level.mesh, level.c_t, level.rhs, out)
    N = oracles.operator(f.P, f.eps, f.mass, level.hx, level.hy, point.kappa, level.c_t)
    inner = (slice(0, -1), slice(1, -1))  # the symmetry line is interior
    np.testing.assert_allclose(out[inner], (level.rhs - N)[inner], rtol=1e-11, atol=1e-11)
    assert (out[-1] == 7.0).all()
    assert (out[:, [0, -1]] == 7.0).all()


def test_symmetry_line_sees_its_image(level):
    """What line 1 carries must reach line 0 from both sides."""
    f = level.fields
    before = reynolds.operator_at(0, 6, f.P, f.eps, f.mass, level.mesh, level.c_t)
    f.P[1, 6] += 0.1
    after = reynolds.operator_at(0, 6, f.P, f.eps, f.mass, level.mesh, level.c_t)
    coupling = oracles.flow_mean(f.eps[0, 6], f.eps[1, 6])
    assert after - before == pytest.approx(0.2 * level.mesh.cy * coupling, rel=1e-10)


def test_wedge_is_exact_for_cubics_beyond_the_first_line(level):
    f = level.fields
    f.P[...] = 0.0
    f.mass[...] = 0.3 + 0.2 * level.X + 0.1 * level.X**2 + 0.05 * level.X**3
    for i in range(2, level.nx):
        N = reynolds.operator_at.py_func(3, i, f.P, f.eps, f.mass, level.mesh, 0.0)
        assert -N == pytest.approx(0.2 + 0.2 * level.X[i] + 0.15 * level.X[i] ** 2, abs=1e-12)
