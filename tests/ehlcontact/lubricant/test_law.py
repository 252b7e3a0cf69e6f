"""Compiled lubricant laws against the SI formulas, and their slopes against differences."""

import numpy as np
import oracles
import pytest

from ehlcontact import Lubricant, MoesPoint
from ehlcontact import lubricant as laws

PRESSURES = [0.0, 1e-6, 0.01, 0.3, 1.0, 1.7]
DENSITIES = ["dowson-higginson", "incompressible"]


def compiled_and_python(name):
    kernel = getattr(laws, name)
    return [kernel, kernel.py_func]


@pytest.mark.parametrize("viscosity", ["roelands", "barus"])
def test_viscosity(viscosity):
    point = MoesPoint(200, 10, 0.5, viscosity=viscosity, alpha=1.7e-8, eta0=0.11)
    for kernel in compiled_and_python("log_viscosity"):
        for P in PRESSURES:
            expected = oracles.viscosity(P * point.p_hertz, 1.7e-8, 0.11, viscosity) / 0.11
            assert np.exp(kernel(P, point.law)[0]) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("density", DENSITIES)
def test_density(density):
    point = MoesPoint(200, 10, 0.5, density=density)
    for kernel in compiled_and_python("density"):
        for P in PRESSURES:
            expected = oracles.density(P * point.p_hertz, density)
            assert kernel(P, point.law)[0] == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("name", ["log_viscosity", "density"])
@pytest.mark.parametrize(("viscosity", "density"), [("roelands", DENSITIES[0]), ("barus", DENSITIES[1])])
def test_slopes(name, viscosity, density):
    law = MoesPoint(200, 10, 0.5, viscosity=viscosity, density=density).law
    h = 1e-5
    for kernel in compiled_and_python(name):
        for P in PRESSURES[2:]:
            difference = (kernel(P + h, law)[0] - kernel(P - h, law)[0]) / (2.0 * h)
            assert kernel(P, law)[1] == pytest.approx(difference, rel=1e-7, abs=1e-12)


def test_roelands_slope_at_ambient_pressure_is_alpha():
    point = MoesPoint(200, 10, 0.5)
    assert laws.log_viscosity(0.0, point.law)[1] == pytest.approx(point.alpha_bar, rel=1e-13)


def test_isoviscous_oil_has_no_pressure_effect():
    law = MoesPoint(200, 0, 0.5, density="incompressible").law
    assert laws.log_viscosity(1.3, law) == (0.0, 0.0)
    assert laws.density(1.3, law) == (1.0, 0.0)


def test_thin_oil_is_fine_with_barus():
    assert Lubricant(eta0=5e-5, viscosity="barus").eta0 == 5e-5
