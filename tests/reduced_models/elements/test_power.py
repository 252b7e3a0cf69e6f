"""The power-law element, and its fit by variable projection."""

from dataclasses import replace

import numpy as np
import pytest

from ehlcontact.errors import InputError
from reduced_models import ContactRecord, PowerLawContact, fit

LAW = {"K": 0.95, "n": 1.7, "u0": 0.15, "F0": -0.05, "C": 0.013}


@pytest.fixture
def element():
    return PowerLawContact(**LAW, low=0.4, high=1.6)


@pytest.fixture
def swing():
    """A record of large motion that obeys LAW exactly."""
    T = np.linspace(0.0, 3.0, 301)
    u, v = 1.0 + 0.6 * np.sin(6.0 * T), 3.6 * np.cos(6.0 * T)
    f = LAW["K"] * (u + LAW["u0"]) ** LAW["n"] + LAW["F0"] + LAW["C"] * v
    return ContactRecord(T, u, v, f)


def test_inside_it_is_the_power_law(element):
    u, v = np.meshgrid(np.linspace(0.4, 1.6, 25), np.linspace(-20.0, 20.0, 9))
    expected = np.maximum(0.0, 0.95 * (u + 0.15) ** 1.7 - 0.05 + 0.013 * v)
    np.testing.assert_allclose(element.force(u, v), expected, rtol=1e-13)


def test_exact_record_gives_its_law_back(swing):
    result = fit(swing, "power", window=(0.0, 3.0))
    assert result.parameters == pytest.approx(LAW, rel=1e-3)
    assert result.rms < 1e-6 and result.root == pytest.approx(result.element.approach_at(1.0))


def test_jacobian_covariance_is_the_scatter_over_many_records(swing):
    def exponent(seed):
        noise = 3e-3 * np.random.default_rng(seed).standard_normal(len(swing))
        return fit(replace(swing, force=swing.force + noise), "power")

    results = [exponent(seed) for seed in range(40)]
    scatter = np.std([r.parameters["C"] for r in results])
    assert results[0].std_errors["C"] == pytest.approx(scatter, rel=0.35)
    covered = [r.intervals["C"][0] <= LAW["C"] <= r.intervals["C"][1] for r in results]
    assert np.mean(covered) >= 0.85


def test_where_the_exponent_cannot_be_told_it_is_that_of_hertz(record):
    """A cubic record of a tenth of the approach: n = 3/2 fits it as well as any other."""
    noise = 1e-3 * np.random.default_rng(3).standard_normal(len(record))
    result = fit(replace(record, force=record.force + noise), "power")
    assert result.parameters["n"] == 1.5
    low, high = result.intervals["n"]
    assert high - low > 1.0
    cubic = fit(replace(record, force=record.force + noise))
    assert result.rms <= 1.02 * cubic.rms and result.tangent == pytest.approx(cubic.tangent, rel=0.01)


def test_record_without_curvature_names_its_columns(record):
    still = replace(record, approach=np.full(301, 0.87), rate=np.zeros(301))
    with pytest.raises(InputError, match="columns"):
        fit(still, "power")


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"K": -1.0}, "K"),
        ({"n": 0.0}, "n"),
        ({"C": -1.0}, "C"),
        ({"u0": -0.5}, "low + u0"),
        ({"F0": -3.0}, "spring"),
    ],
)
def test_bad_parameters_are_named(changes, field):
    with pytest.raises(InputError) as caught:
        PowerLawContact(**(LAW | {"low": 0.4, "high": 1.6} | changes))
    assert caught.value.field.startswith(field)
