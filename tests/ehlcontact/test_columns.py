"""Relaxation by columns: one column solves its own linear system at frozen film."""

import numpy as np
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact._kernels import columns
from ehlcontact.grid import Level


@pytest.fixture
def level():
    """A thick film of pressure everywhere, where flow dominates."""
    level = Level(MoesPoint(20.0, 5.0, 2.0), Domain(), 16, 8)
    level.P[:-1, 1:-1] = 0.02 + 0.01 * np.random.default_rng(1).uniform(size=(8, 15))
    level.update_film(-1.0)
    level.c_t = 0.4
    level.rhs[...] = 1e-4 * np.random.default_rng(2).normal(size=level.P.shape)
    level.update_residual()
    level.rhs -= 0.999 * level.r  # small residuals, so that no pressure turns negative
    level.update_residual()
    return level


@pytest.mark.parametrize("kernel", [columns.relax_column, columns.relax_column.py_func], ids=["jit", "python"])
@pytest.mark.parametrize("i", [1, 7, 15])
def test_column_solves_its_linear_system(level, kernel, i):
    f, mesh, ny = level.fields, level.mesh, level.ny
    A = np.zeros((ny, ny))
    transport = (1.5 * mesh.inv_hx + level.c_t) * level.near[0, 0]
    for j in range(ny):
        below = 1 if j == 0 else j - 1
        A[j, j] -= 0.5 * mesh.cx * (2.0 * f.eps[j, i] + f.eps[j, i - 1] + f.eps[j, i + 1]) + transport
        for other in (below, j + 1):
            a = 0.5 * mesh.cy * (f.eps[j, i] + f.eps[other, i])
            A[j, j] -= a
            if other < ny:
                A[j, other] += a
    before = f.P.copy()
    change = np.linalg.solve(A, level.r[:ny, i])
    assert np.abs(change).max() > 1e-9
    assert (before[:ny, i] + change > 0.0).all()
    kernel(i, f.P, f.eps, f.mass, level.rhs, mesh, level.c_t, level.near[0, 0], level.column_work)
    np.testing.assert_allclose(f.P[:ny, i] - before[:ny, i], change, rtol=1e-8, atol=1e-15)
    f.P[:, i] = before[:, i]
    assert (f.P == before).all()


def test_stiff_nodes_are_left_alone(level):
    """Where the oil hardly flows, a frozen film would make this diverge."""
    f, before = level.fields, level.P.copy()
    f.eps[...] = 1e-9
    columns.relax_columns(
        f.P, f.eps, f.mass, level.rhs, level.mesh, level.c_t, level.near[0, 0], level.column_work
    )
    assert (f.P == before).all()
