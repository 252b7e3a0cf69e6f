"""Grid transfer against nine-point stencils and interpolation on the whole domain."""

import numpy as np
import oracles
import pytest

from ehlcontact.solver.kernels import transfer


def jit_and_python(kernel):
    return pytest.mark.parametrize("kernel", [kernel, kernel.py_func], ids=["jit", "python"])


@pytest.fixture
def rng():
    return np.random.default_rng(11)


@jit_and_python(transfer.full_weighting)
def test_full_weighting(rng, kernel):
    fine = rng.normal(size=(13, 17))
    coarse = np.full((7, 9), np.nan)
    kernel(fine, coarse)
    np.testing.assert_allclose(coarse, oracles.full_weighting(fine), rtol=1e-13, atol=1e-15)


@jit_and_python(transfer.restrict_pressure)
def test_restrict_pressure(rng, kernel):
    fine = np.maximum(rng.uniform(-0.05, 1.0, (13, 17)), 0.0)
    weighted = oracles.full_weighting(fine)
    full = oracles.mirrored(fine)
    coarse = np.zeros((7, 9))
    kernel(fine, coarse)
    kinds = set()
    for j in range(6):
        for i in range(1, 8):
            wet = (full[12 + 2 * j - 1 : 12 + 2 * j + 2, 2 * i - 1 : 2 * i + 2] > 0.0).all()
            kinds.add(bool(wet))
            expected = weighted[j, i] if wet else fine[2 * j, 2 * i]
            assert coarse[j, i] == pytest.approx(expected, rel=1e-13)
    assert kinds == {True, False}
    assert (coarse[-1] == 0.0).all()
    assert (coarse[:, [0, -1]] == 0.0).all()


@jit_and_python(transfer.add_correction)
def test_add_correction(rng, kernel):
    old = np.maximum(rng.uniform(-0.03, 1.0, (7, 9)), 0.0)
    new = np.maximum(old + 0.1 * rng.normal(size=old.shape), 0.0)
    for field in (old, new):
        field[-1] = 0.0
        field[:, [0, -1]] = 0.0
    fine = np.maximum(rng.uniform(-0.1, 0.5, (13, 17)), 0.0)
    start = fine.copy()
    kernel(new, old, fine)
    corrected = 0
    for j in range(12):
        for i in range(1, 16):
            nodes = {(jc, ic) for jc in (j // 2, (j + 1) // 2) for ic in (i // 2, (i + 1) // 2)}
            inner = [k for k in nodes if k[0] < 6 and 0 < k[1] < 8]
            if start[j, i] > 0.0 and all(new[k] > 0.0 and old[k] > 0.0 for k in inner):
                corrected += 1
                expected = max(start[j, i] + oracles.bilinear(new - old, j, i), 0.0)
                assert fine[j, i] == pytest.approx(expected, rel=1e-12, abs=1e-15)
            else:
                assert fine[j, i] == start[j, i]
    assert 0.4 * 12 * 15 < corrected < 12 * 15
    assert (fine[-1] == start[-1]).all()


def test_correction_of_a_plane_is_exact():
    Y, X = np.mgrid[0:7, 0:9]
    fine = np.ones((13, 17))
    transfer.add_correction(1.0 + 0.1 * X + 0.05 * Y, np.ones((7, 9)), fine)
    y, x = np.mgrid[0:13, 0:17]
    expected = 1.0 + 0.05 * x + 0.025 * y
    np.testing.assert_allclose(fine[:-1, 1:-1], expected[:-1, 1:-1], rtol=1e-14)


def test_weighting_and_interpolation_are_adjoint(rng):
    """``(FW r, e)_coarse = (r, I e)_fine/4``, with the symmetry line counted half: one balance on both grids."""
    r = rng.normal(size=(13, 17))
    r[-1] = 0.0
    r[:, [0, -1]] = 0.0
    e = rng.uniform(0.1, 1.0, (7, 9))
    e[-1] = 0.0
    e[:, [0, -1]] = 0.0
    coarse = np.zeros((7, 9))
    transfer.full_weighting(r, coarse)
    base, fine = np.ones((7, 9)), np.full((13, 17), 5.0)
    transfer.add_correction(base + e, base, fine)
    half = np.ones(13)
    half[0] = 0.5
    left = np.sum(half[:7, None] * coarse * e)
    right = 0.25 * np.sum(half[:, None] * r * (fine - 5.0))
    assert left == pytest.approx(right, rel=1e-12)
