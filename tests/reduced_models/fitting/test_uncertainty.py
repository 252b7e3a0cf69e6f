"""Intervals of coefficients: right for white noise, and still right where residuals hang together."""

from dataclasses import replace

import numpy as np
import pytest

from reduced_models import fit
from reduced_models.fitting.uncertainty import autocorrelation, half_widths, independent_samples

TRUE = {"K1": 0.806, "C1": 0.013}


def coloured(seed, size, rho):
    """AR(1) noise of unit variance."""
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal(size)
    for i in range(1, size):
        noise[i] = rho * noise[i - 1] + np.sqrt(1.0 - rho**2) * noise[i]
    return noise


def test_autocorrelation_of_a_known_sequence():
    np.testing.assert_allclose(autocorrelation(np.array([1.0, -1.0, 1.0, -1.0])), [1.0, -0.75, 0.5, -0.25])
    np.testing.assert_array_equal(autocorrelation(np.zeros(3)), [1.0, 0.0, 0.0])


def test_white_noise_counts_in_full_and_coloured_noise_by_its_correlation_time():
    white = independent_samples([coloured(seed, 2000, 0.0) for seed in range(5)])
    assert white == pytest.approx(10_000, rel=0.05)
    rho = 0.9
    counted = independent_samples([coloured(seed, 4000, rho) for seed in range(5)])
    assert counted == pytest.approx(20_000 * (1 - rho) / (1 + rho), rel=0.25)


def test_samples_of_known_sequences_are_counted_exactly():
    """1 + 2 rho_1 with rho_1 = 1/4, and over two records; what hangs together to the end counts once at least."""
    one, other = np.array([1.0, 1.0, -1.0, -1.0]), np.array([1.0, -1.0, 1.0, -1.0])
    assert independent_samples([one]) == pytest.approx(4.0 / 1.5, rel=1e-14)
    assert independent_samples([one, other]) == pytest.approx(4.0 / 1.5 + 4.0, rel=1e-14)
    assert independent_samples([np.ones(3)]) == 1.0  # rho = 2/3, 1/3


def test_half_width_is_students():
    # Tables: t(0.975, 10) = 2.228; with nothing to spare one degree of freedom, 12.706.
    assert half_widths(np.ones(2), 12.0) == pytest.approx(2.228, abs=1e-3)
    assert half_widths(np.ones(2), 1.0) == pytest.approx(12.706, abs=1e-3)


@pytest.mark.parametrize("rho", [0.0, 0.8])
def test_intervals_cover_the_truth(record, rho):
    """Of 200 intervals at least 92 % in white noise, and 85 % in AR(1) noise, where naive ones hold half."""
    covered, naive = 0, 0
    for seed in range(200):
        result = fit(replace(record, force=record.force + 1e-3 * coloured(seed, len(record), rho)))
        low, high = result.intervals["C1"]
        covered += low <= TRUE["C1"] <= high
        share = np.sqrt(result.independent_samples / result.samples)
        naive += abs(result.parameters["C1"] - TRUE["C1"]) < 1.97 * share * result.std_errors["C1"]
    if rho == 0.0:
        assert covered >= 184 and naive >= 180
    else:
        assert covered >= 170 and naive < 120
