"""Grid transfer against stencils and interpolation on the whole domain, for each way of coarsening."""

import numpy as np
import oracles
import pytest

from ehlcontact.solver.kernels import transfer

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
