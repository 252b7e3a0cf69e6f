"""Bad input that is refused in one line."""

import pytest

from ehlcontact.errors import InputError


def refused(match, call):
    """The one line of the error that a call ends in."""
    with pytest.raises(InputError, match=match) as caught:
        call()
    line = str(caught.value)
    assert "\n" not in line
    return line


def refusals(*cases):
    """A test that every call is refused in one line that matches words: cases are (call, words)."""

    @pytest.mark.parametrize(("call", "words"), cases)
    def test(call, words):
        refused(words, call)

    return test
