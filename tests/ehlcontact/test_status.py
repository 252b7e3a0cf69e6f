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


def test_files_of_rotors_from_before_there_was_one_vocabulary_read_back():
    assert Status("not converged") is Status.FAILED and str(Status.FAILED) == "failed"
    with pytest.raises(ValueError, match="asleep"):
        Status("asleep")
