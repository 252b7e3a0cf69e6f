"""Leaving out one coefficient of the seven-term polynomial at a time (Table 2)."""

import json
from dataclasses import replace

import numpy as np
import pytest

from ehlcontact.errors import InputError
from reduced_models import fit
from reduced_models.fitting.sensitivity import sensitivity


@pytest.fixture
def noisy(record):
    return replace(record, force=record.force + 1e-4 * np.random.default_rng(5).standard_normal(len(record)))


def test_a_row_is_the_fit_without_that_column(noisy):
    table = sensitivity(noisy)
    assert [row.removed for row in table.rows] == [None, "K1", "C1", "K2", "C2", "K3", "C3", "B4"]
    cut = noisy.window(*noisy.default_window)
    u, v, f = cut.approach, cut.rate, cut.force
    A = np.column_stack([u, v, v**2, u**3, v**3, u * v])  # without K2
    misfit = f - A @ np.linalg.lstsq(A, f)[0]
    row = table.rows[3]
    assert row.rms == pytest.approx(np.sqrt(np.mean(misfit**2)) / np.std(f), rel=1e-6)
    assert row.e_f == pytest.approx(np.sum(misfit) / np.sum(f), abs=1e-12)
    assert row.e_acc is not None


def test_the_full_row_is_the_polynomial_fit(noisy):
    full = sensitivity(noisy).rows[0]
    result = fit(noisy, "polynomial")
    assert (full.rms, full.e_f, full.e_acc) == pytest.approx((result.rms, result.e_f, result.e_acc), rel=1e-9)
    assert full.aic == full.bic == 0.0 and full.rms_without_refit == full.rms


def test_terms_that_the_truth_has_are_missed_and_the_others_are_not(noisy):
    """The record holds K1, K2, K3 and C1: a part of C1 that B4 can stand in for, as u hardly changes."""
    table = sensitivity(noisy)
    rows = {row.removed: row for row in table.rows}
    assert table.ranking[:2] == ("K1", "K2")
    assert all(rows[name].bic < 0.0 for name in ("C2", "C3"))
    assert rows["K1"].bic > 10.0 and rows["K2"].bic > 10.0
    assert rows["C1"].rms < 0.1 * rows["C1"].rms_without_refit
    assert all(row.rms >= table.rows[0].rms for row in table.rows)


def test_correlated_residuals_warn_and_are_counted(record):
    wave = replace(record, force=record.force + 1e-3 * np.sin(40.0 * record.t))
    table = sensitivity(wave)
    assert table.lag_one > 0.8 and table.independent_samples < 0.3 * table.samples
    assert "hang together" in table.warning
    assert json.loads(json.dumps(table.to_dict()))["rows"][0]["removed"] is None


def test_white_residuals_need_no_warning(noisy):
    assert sensitivity(noisy).warning is None


def test_bad_records_are_refused_as_by_fit(record):
    with pytest.raises(InputError, match="derivative"):
        sensitivity(replace(record, rate=-record.rate))
    with pytest.raises(InputError, match="columns"):
        sensitivity(replace(record, approach=np.full(301, 0.9), rate=np.zeros(301)))
