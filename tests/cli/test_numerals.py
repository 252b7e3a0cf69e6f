"""Numbers for people: figures, exponents, and terminals of few characters."""

import io
import sys

import numpy as np
import pytest

from ehlcontact.cli.numerals import numeral, percent, spelled
from ehlcontact.cli.output import show_table


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (None, 4, "-"),
        (0.0, 4, "0"),
        (-0.5, 4, "-0.5"),
        (10000.0, 4, "10000"),  # the revolutions per minute that were 1e+04
        (12345.0, 4, "12345"),
        (99999.6, 4, "1e5"),
        (99999.4, 6, "99999.4"),
        (123456.0, 4, "1.235e5"),
        (3000, 2, "3000"),
        (0.001, 4, "0.001"),
        (0.00099996, 4, "0.001"),
        (0.00012345, 4, "1.234e-4"),
        (1.2e-8, 4, "1.2e-8"),
        (0.870912, 5, "0.87091"),
        (9.9996, 4, "10"),
        (np.float64(2.0), 4, "2"),
        (float("nan"), 4, "nan"),
        (float("-inf"), 4, "-inf"),
    ],
)
def test_numeral(value, digits, text):
    assert numeral(value, digits) == text


def test_numbers_come_back_as_exactly_as_they_are_written():
    values = np.random.default_rng(1).normal(size=400) * 10.0 ** np.random.default_rng(2).integers(-9, 9, 400)
    for value in values:
        text = numeral(value)
        assert float(text) == pytest.approx(value, rel=0.5e-3)
        assert ("e" in text) == (not 1e-3 <= abs(float(text)) < 1e5), text


def test_percent():
    assert (percent(0.00282), percent(None), percent(1.0)) == ("0.282 %", "-", "100 %")


class Stream(io.StringIO):
    def __init__(self, encoding):
        super().__init__()
        self._encoding = encoding

    @property
    def encoding(self):
        return self._encoding


@pytest.mark.parametrize(
    ("encoding", "text"),
    [("utf-8", "Ω = 2.5, ± 3 µm²"), ("ascii", "Omega = 2.5, +- 3 um^2"), ("latin-1", "Omega = 2.5, +- 3 um^2")],
)
def test_a_terminal_of_few_characters(monkeypatch, encoding, text):
    stream = Stream(encoding)
    assert spelled("Ω = 2.5, ± 3 µm²", stream) == text
    monkeypatch.setattr(sys, "stdout", stream)
    show_table("µ", [("film", "3", "µm")], None)
    assert ("um" if encoding == "ascii" else "µm") in stream.getvalue()
