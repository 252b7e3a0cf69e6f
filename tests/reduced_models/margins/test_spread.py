"""`spread` and `draws`: what an input may be given as, and quasi-random values of several."""

import numpy as np
import pytest
import scipy.stats

from ehlcontact import InputError
from reduced_models import spread
from reduced_models.margins.spread import draws, spread_of


def test_a_pair_is_a_range():
    found = spread_of("clearance", (5.0, 15.0))
    assert found.support() == (5.0, 15.0) and found.ppf(0.25) == pytest.approx(7.5, rel=1e-12)


def test_distributions_by_the_numbers_that_people_have():
    normal = spread(normal=(70.0, 4.0))
    assert (normal.mean(), normal.std()) == pytest.approx((70.0, 4.0), rel=1e-12)
    cut = spread(normal=(70.0, 4.0), within=(66.0, 82.0))
    assert cut.support() == pytest.approx((66.0, 82.0), rel=1e-12)
    assert cut.cdf(70.0) == pytest.approx(
        (0.5 - normal.cdf(66.0)) / (normal.cdf(82.0) - normal.cdf(66.0)), rel=1e-9
    )
    peak = spread(triangular=(1.0, 2.5, 6.3))
    assert peak.support() == pytest.approx((1.0, 6.3), rel=1e-12)
    assert peak.mean() == pytest.approx((1.0 + 2.5 + 6.3) / 3.0, rel=1e-12)
    own = scipy.stats.lognorm(0.2)
    assert spread_of("any", own) is own


def test_draws_are_even_and_further_ones_leave_the_first():
    spreads = [spread_of("a", (0.0, 1.0)), spread(normal=(0.0, 1.0)), spread(triangular=(0.0, 1.0, 2.0))]
    few, many = draws(spreads, 64, 3), draws(spreads, 200, 3)
    assert few.shape == (64, 3) and many.shape == (200, 3)
    np.testing.assert_array_equal(many[:64], few)
    assert not np.array_equal(draws(spreads, 64, 4), few)
    for k, one in enumerate(spreads):  # one in each of 64 strips of the same share
        strips = np.sort(np.floor(64.0 * one.cdf(few[:, k])))
        np.testing.assert_array_equal(strips, np.arange(64.0))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((15.0, 5.0), "a low end below the high one"),
        ((5.0, 5.0), "a low end below the high one"),
        ((5.0, float("nan")), "finite numbers: low, high"),
        (5.0, "a range"),
        ("5 to 15", "a range"),
        ((1.0, 2.0, 3.0), "a range"),
        ({"normal": (70.0, -4.0)}, "a standard deviation above 0"),
        ({"normal": (70.0, 4.0), "within": (80.0, 60.0)}, "a low end below the high one"),
        ({"uniform": (1.0, 2.0), "within": (0.0, 1.0)}, "left out beside uniform"),
        ({"triangular": (1.0, 7.0, 6.3)}, "a mode between its ends, 1 and 6.3"),
        ({"gauss": (70.0, 4.0)}, "a range"),
        ({}, "a range"),
        ({"normal": (True, 4.0)}, "finite numbers: mean, standard deviation"),
        (scipy.stats.norm(70.0, -4.0), "a distribution with a length"),
    ],
)
def test_what_is_none(given, words):
    with pytest.raises(InputError, match=words):
        spread_of("clearance", given)
