"""How a solve ended, in words."""

import pytest

from ehlcontact import Status


@pytest.mark.parametrize("status", list(Status))
def test_each_status_has_advice_in_one_sentence(status):
    assert status.advice.endswith(".")
    assert "\n" not in status.advice
    assert status.ok == (status is Status.CONVERGED)


def test_status_reads_back_from_text():
    assert Status(str(Status.STAGNATED)) is Status.STAGNATED
    assert f"{Status.MAX_CYCLES}" == "max_cycles"
