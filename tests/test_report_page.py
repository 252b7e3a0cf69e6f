"""The walker over the numbers of a page, on a page of its own."""

import pytest
from report.page import PageNumbers, is_shown

PAGE = """<html><head><title>Study 7</title><style>p { margin: 3px }</style></head><body><h1>Two of 5</h1>
<p>A ball of 7.94&nbsp;mm, K1 = 4.622e+07 N/m,
   u<sub>1</sub> in 3 &mu;m.</p>
<table><tr><td>film</td><td>0.19 um</td><td>-</td></tr><tr><td>film</td><td>12 %</td></tr></table>
<img src="data:image/png;base64,99" alt="88"></body></html>"""


def test_claims_and_what_is_left():
    page = PageNumbers(PAGE)
    page.claim("ball of # mm", 7.94)
    page.claim("K1 = # N/m", 46222098.1)
    page.claim("film | # um | #", 0.1897, None)
    assert [left.split(" in ")[0] for left in page.left] == ["5", "3", "12"]
    page.claim("Two of 5")
    page.claim("u1 in # um", 3)
    with pytest.raises(AssertionError, match=r"12 on the page, 13\.1 computed"):
        page.claim("film | # %", 13.1)
    with pytest.raises(AssertionError, match="'Two of 5' stands 0 times"):
        page.claim("Two of 5")  # once claimed it is somebody's
    with pytest.raises(AssertionError, match="' of ' stands 0 times"):
        page.claim(" of ")  # a part of what is
    page.claim("film | # %", 12.3)
    assert page.left == []


@pytest.mark.parametrize(
    ("shown", "value"),
    [
        ("0.19", 0.1897),
        ("0.19", 0.18951),
        ("25", 24.99),
        ("10", 9.745),
        ("3000", 3000.0),
        ("1e+03", 1026.8),
        ("-1.975", -1.97481),
        ("8.3e-05", 8.298e-05),
        ("150", 146.0),
        ("0", 0.0),
        ("-", None),
    ],
)
def test_rounded_numbers_are_recognised(shown, value):
    assert is_shown(shown, value)


@pytest.mark.parametrize(
    ("shown", "value"),
    [
        ("0.19", 0.1965),
        ("48.7", 4.87),
        ("0.5", 0.52),
        ("8.3e-05", 8.464e-05),
        ("144", 145.0),
        ("1.975", -1.975),
        ("3", 0.0),
        ("0", 0.3),
        ("-", 0.0),
        ("5", None),
    ],
)
def test_others_are_not(shown, value):
    assert not is_shown(shown, value)


def test_figures_that_have_to_be_there():
    """A short number may be a long one without its zeros, or a short one: `least` says which."""
    assert is_shown("0.5", 0.47, least=1) and not is_shown("0.5", 0.47)
    assert is_shown("0.5", 0.5003, least=3) and not is_shown("0.5", 0.503, least=3)
