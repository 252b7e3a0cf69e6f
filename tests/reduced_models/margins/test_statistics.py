"""Intervals and rank correlations: against closed distributions, scipy, and many repetitions."""

import numpy as np
import pytest
import scipy.stats

from reduced_models.margins.statistics import influence_of, interval_of


def test_an_interval_contains_its_share_on_average():
    """Of 1000 sets of 200 normal numbers: mean share .95, and 95 % of the sets in the stated range."""
    x = np.random.default_rng(1).standard_normal((1000, 200))
    found = [interval_of(row) for row in x]
    shares = np.array([scipy.stats.norm.cdf(one.high) - scipy.stats.norm.cdf(one.low) for one in found])
    assert shares.mean() == pytest.approx(0.95, abs=0.002)
    low, high = found[0].contains
    assert (low, high) == pytest.approx((0.9157, 0.9757), abs=1e-3)
    assert np.mean((shares >= low) & (shares <= high)) == pytest.approx(0.95, abs=0.015)


def test_true_ends_are_where_they_are_said_to_be():
    x = np.random.default_rng(2).standard_normal((1000, 200))
    ends = np.array([(*one.low_ends, *one.high_ends) for one in map(interval_of, x)])
    low, high = scipy.stats.norm.ppf((0.025, 0.975))
    assert np.mean((ends[:, 0] <= low) & (low <= ends[:, 1])) >= 0.94  # ranks are whole: at least the confidence
    assert np.mean((ends[:, 2] <= high) & (high <= ends[:, 3])) >= 0.94


def test_few_samples_say_what_they_contain():
    found = interval_of(np.arange(9.0))
    assert (found.low, found.high, found.known) == (0.0, 8.0, 9)
    assert found.share == pytest.approx(0.8, rel=1e-12)
    assert interval_of(np.arange(200.0)).share == pytest.approx(0.95, rel=1e-12)
    assert found.contains == pytest.approx(scipy.stats.beta.ppf((0.025, 0.975), 8, 2), rel=1e-12)
    assert found.low_ends[0] is None and found.high_ends[1] is None
    assert interval_of(np.array([1.0, 2.0, *[np.nan] * 9])) is None


def test_rank_correlation_and_its_error():
    rng = np.random.default_rng(3)
    x = rng.random((1000, 100, 3))
    y = np.exp(2.0 * x[..., 0] - x[..., 1]) + 0.1 * rng.standard_normal((1000, 100))
    found = [influence_of(inputs, values) for inputs, values in zip(x, y, strict=True)]
    own = scipy.stats.spearmanr(x[0, :, 0], y[0]).statistic
    assert found[0].correlation[0] == pytest.approx(own, rel=1e-12)
    r, error = (np.array([getattr(one, name) for one in found]) for name in ("correlation", "error"))
    apart = error.mean(axis=0) / r.std(axis=0)  # a strong correlation is surer than the formula has it
    assert np.all(apart > 0.9) and np.all(apart < 1.7) and apart[1:] == pytest.approx(1.0, abs=0.15)
    assert np.mean([one.explained for one in found]) > 0.9


def test_an_input_that_moves_a_number_both_ways_is_not_explained():
    x = np.random.default_rng(4).random((200, 2))
    found = influence_of(x, (x[:, 0] - 0.5) ** 2)
    assert found.explained < 0.1 and abs(found.correlation[0]) < 3.0 * found.error[0]
    assert influence_of(x, np.ones(200)) is None
