"""Many points at once: the same answers as one by one, and what is refused."""

from dataclasses import fields

import numpy as np
import pytest

from ehlcontact import InputError, MoesPoint
from reduced_models.atlas.atlas import NUMBERS
from reduced_models.atlas.surface import BLOCK

MANY = BLOCK + 44
NAMES = (*NUMBERS, "stiffness", "damping")


@pytest.fixture(scope="module")
def axes(analytic):
    draw, box = np.random.default_rng(5), analytic.box
    M = np.exp(draw.uniform(np.log(box.M[0]), np.log(500.0), MANY))
    return M, draw.uniform(*box.L, MANY), np.exp(draw.uniform(*np.log(box.kappa), MANY))


@pytest.mark.parametrize("oil", [{}, {"alpha": 1.6e-8, "eta0": 0.02}])
def test_as_one_by_one(analytic, axes, oil):
    many = analytic.over(*axes, **oil)
    assert np.array_equal(many.M, axes[0]) and np.array_equal(many.kappa, axes[2])
    for i in (0, BLOCK - 1, BLOCK, MANY - 1):
        one = analytic.at(MoesPoint(*(float(axis[i]) for axis in axes), **oil))
        for name in NAMES:
            np.testing.assert_allclose(getattr(many, name)[i], getattr(one, name), rtol=1e-9)
            np.testing.assert_allclose(many.error_bars[name][i], one.error_bars[name], rtol=1e-9)
    assert many.stiffness.shape == many.error_bars["damping"].shape == (MANY, many.omega.size)
    assert set(many.error_bars) == {f.name for f in fields(many)} - {"M", "L", "kappa", "omega", "error_bars"}


def test_a_number_stands_for_all(analytic):
    many = analytic.over([20.0, 200.0], 10.0, 0.5)
    assert many.approach[1] == pytest.approx(analytic.at(MoesPoint(200.0, 10.0, 0.5)).approach)
    assert analytic.over(200.0, 10.0, 0.5).approach.shape == (1,)


@pytest.mark.parametrize(
    ("axes", "oil", "words"),
    [
        (([20.0, 0.9], 10.0, 0.5), {}, "M = 0.9"),
        ((20.0, [10.0, 30.1, 40.0], 0.5), {}, "L = 30.1"),
        ((20.0, 10.0, [0.5, np.nan]), {}, r"kappa\[1\] = nan"),
        (([20.0, 20000.0], 25.0, 0.9), {}, "Hertz pressure"),
        (([20.0, 8000.0], 20.0, 0.9), {"alpha": 1e-8}, "Hertz pressure"),
        ((20.0, 10.0, 0.5), {"alpha": 5e-8}, "alpha = 5e-08"),
        ((20.0, 10.0, 0.5), {"eta0": 3.0}, "eta0 = 3"),
        (([1.0, 2.0], [1.0, 2.0, 3.0], 0.5), {}, "M, L, kappa"),
        (([[20.0]], 10.0, 0.5), {}, "M, L, kappa"),
        (([], 10.0, 0.5), {}, "M, L, kappa"),
        (("many", 10.0, 0.5), {}, "M = 'many': must be numbers"),
    ],
)
def test_what_lies_outside_is_named(analytic, axes, oil, words):
    with pytest.raises(InputError, match=f"^{words}"):
        analytic.over(*axes, **oil)
