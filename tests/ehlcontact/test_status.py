"""Verdicts on a residual history."""

import pytest

from ehlcontact import Status
from ehlcontact.status import classify

NAN, INF = float("nan"), float("inf")
FALLING = [10.0**-k for k in range(20)]


@pytest.mark.parametrize(
    ("residuals", "settled", "max_cycles", "expected"),
    [
        ([1.0], False, 9, None),
        ([1e-5], True, 9, Status.CONVERGED),
        ([1e-5], False, 9, None),  # a small residual alone is not enough
        ([1e-3], True, 9, None),
        (FALLING[:3], True, 2, Status.MAX_CYCLES),
        (FALLING[:6], True, 5, Status.CONVERGED),  # convergence in the last allowed cycle counts
        ([1.0], True, 0, Status.MAX_CYCLES),
        ([1.0, NAN], True, 9, Status.NONFINITE),
        ([1.0, INF], True, 9, Status.NONFINITE),
        ([NAN], False, 0, Status.NONFINITE),
        ([1.0, 2e3], False, 9, Status.DIVERGED),
        ([1.0, 9e2], False, 9, None),
        ([2e3, 1.0], False, 9, None),  # a poor start is not divergence
        ([1.0] * 13, False, 40, None),
        ([1.0] * 14, False, 40, Status.STAGNATED),
        ([1.0] * 14, True, 40, Status.STAGNATED),
        ([1.0] * 8 + [0.6] * 6, False, 40, None),
        ([0.9**k for k in range(14)], False, 40, None),
        ([0.97**k for k in range(14)], False, 40, Status.STAGNATED),
        ([1.0] * 14 + [1e-5], True, 40, Status.CONVERGED),
    ],
)
def test_classify(residuals, settled, max_cycles, expected):
    assert classify(residuals, 1.0, 1e-4, settled, max_cycles) is expected


def test_scale_is_what_counts():
    assert classify([1e-3], 100.0, 1e-4, True, 9) is Status.CONVERGED
    assert classify([1e-3], 1e-8, 1e-4, True, 9) is Status.DIVERGED


@pytest.mark.parametrize("status", list(Status))
def test_each_status_has_advice_in_one_sentence(status):
    assert status.advice.endswith(".")
    assert "\n" not in status.advice
    assert status.ok == (status is Status.CONVERGED)


def test_status_reads_back_from_text():
    assert Status(str(Status.STAGNATED)) is Status.STAGNATED
    assert f"{Status.MAX_CYCLES}" == "max_cycles"


def test_files_of_rotors_from_before_there_was_one_vocabulary_read_back():
    assert Status("not converged") is Status.FAILED and str(Status.FAILED) == "failed"
    with pytest.raises(ValueError, match="asleep"):
        Status("asleep")
