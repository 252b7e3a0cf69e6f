"""Deflection: coefficients, both ways of summing them, and Hertz's pressure."""

import numpy as np
import oracles
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.solver.deflection.coefficients import influence_coefficients
from ehlcontact.solver.deflection.fft import FastFourier, FastTransforms, MatrixTransforms
from ehlcontact.solver.level import Level


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


@pytest.mark.parametrize(("nx", "ny"), [(8, 6), (16, 8), (32, 12), (48, 32), (64, 32)])
@pytest.mark.parametrize("kappa", [0.3, 1.0])
def test_deflection_is_the_direct_sum(nx, ny, kappa):
    """To rounding, on small grids and on one beyond `MATRICES_UP_TO`."""
    hx, hy = 6.0 / nx, 3.0 / ny
    P = np.random.default_rng(nx).uniform(size=(ny + 1, nx + 1))
    P[-1] = 0.0
    P[:, [0, -1]] = 0.0
    got = FastFourier(nx, ny, hx, hy, kappa)(P)
    expected = oracles.deflection(P, hx, hy, kappa)
    np.testing.assert_allclose(got, expected, rtol=1e-12, atol=1e-12 * expected.max())


@pytest.mark.parametrize("transforms", [FastTransforms, MatrixTransforms])
@pytest.mark.parametrize(("nx", "ny"), [(16, 4), (24, 10), (48, 5)])
def test_both_kinds_of_transforms(transforms, nx, ny):
    kernel = influence_coefficients(nx + 1, 2 * ny + 1, 0.1, 0.07, 0.3)
    P = np.random.default_rng(nx).uniform(size=(ny + 1, nx + 1))
    P[-1] = 0.0
    P[:, [0, -1]] = 0.0
    expected = oracles.deflection(P, 0.1, 0.07, 0.3)
    np.testing.assert_allclose(transforms(kernel)(P), expected, rtol=1e-12, atol=1e-12 * expected.max())


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
